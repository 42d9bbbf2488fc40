//! Writes evidence as files.

use toml::{Table, Value};

use crate::evidence::{
    Bounds, Choice, Evidence, Field, Fields, Item, Items, PointsMut, Section, Sigma, Word, ends,
};

impl Evidence {
    /// Returns the text of a file from which [`Evidence::from_toml`] reads the same evidence. Numbers
    /// are in SI units with all their digits; what nobody stated, such as a standard deviation, is not
    /// written. What such a file cannot say, as a mark of a single point, is written too, but the file is
    /// then refused on reading.
    pub fn to_toml(&self) -> String {
        let mut top = Writer(Table::new());
        top.set("case", Some(self.case.as_str()));
        top.set("kind", Some(self.kind.word()).filter(|_| self.is_single_car()));
        self.clone().items(&mut top);
        top.0.to_string()
    }
}

/// A table that is being written.
struct Writer(Table);

impl Writer {
    fn set(&mut self, key: &str, value: Option<impl Into<Value>>) {
        if let Some(value) = value {
            self.0.insert(key.to_owned(), value.into());
        }
    }

    fn table_of(item: &mut impl Item) -> Table {
        let mut table = Self(Table::new());
        item.fields(&mut table);
        table.0
    }
}

impl Items for Writer {
    fn item(&mut self, section: &'static Section, _: Option<usize>, item: &mut impl Item) {
        let table = Self::table_of(item);
        self.set(section.key, Some(table).filter(|table| section.is_required || !table.is_empty()));
    }

    fn many<T: Item>(&mut self, section: &'static Section, items: &mut Vec<T>) {
        let tables: Vec<Table> = items.iter_mut().map(Self::table_of).collect();
        self.set(section.key, Some(tables).filter(|tables| !tables.is_empty()));
    }
}

impl Fields for Writer {
    fn number(&mut self, field: &Field, value: &mut Option<f64>) {
        self.set(&field.si_key(), *value);
    }

    fn points(&mut self, field: &Field, sigma: &Sigma, points: PointsMut<'_>) {
        let values = points.points_m.iter().map(|point| Value::from(point.to_vec()));
        self.set(&field.si_key(), Some(values.collect::<Vec<_>>()));
        self.number(&sigma.field, points.sigma_m);
    }

    fn bounds(&mut self, field: &Field, bounds: &mut Option<Bounds>) {
        let [low, high] = bounds.unwrap_or_default();
        self.set(&field.si_key_with("_min"), low);
        self.set(&field.si_key_with("_max"), high);
    }

    fn interval(&mut self, field: &Field, interval: &mut Option<Bounds>) {
        self.set(&field.si_key(), ends(*interval).map(Vec::from));
    }

    fn choice<W: Word>(&mut self, choice: &Choice, word: &mut W) {
        self.set(choice.key, Some(word.word()));
    }

    fn optional_choice<W: Word>(&mut self, choice: &Choice, word: &mut Option<W>) {
        self.set(choice.key, word.map(W::word));
    }

    fn choices<W: Word>(&mut self, choice: &Choice, words: &mut Option<Vec<W>>) {
        let words = words.as_ref().map(|words| words.iter().map(|word| word.word()));
        self.set(choice.key, words.map(Iterator::collect::<Vec<_>>));
    }
}

#[cfg(test)]
mod tests {
    use std::path::{Path, PathBuf};

    use super::*;
    use crate::evidence::SkidBefore;
    use crate::evidence::examples::read;
    use impactlab_core::vehicle::Wheel;

    fn shipped() -> Vec<PathBuf> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let folder = std::fs::read_dir(root.join("datasets/staged/evidence")).unwrap();
        let staged = folder.map(|entry| entry.unwrap().path());
        let others = [
            "docs/guide/examples/position_alone.toml",
            "docs/guide/examples/contradictory.toml",
            "docs/guide/examples/single_car.toml",
            "assets/examples/reconstruction.toml",
            "tests/data/evidence/spin.toml",
        ];
        staged.chain(others.map(|file| root.join(file))).collect()
    }

    #[test]
    fn what_is_written_is_read_as_the_same() {
        for path in shipped() {
            let evidence = Evidence::load(&path).unwrap();
            assert_eq!(evidence.missing(), None, "{}", path.display());
            let text = evidence.to_toml();
            assert_eq!(read(&text), evidence, "{}\n{text}", path.display());
            let mirror = evidence.mirrored();
            assert_eq!(read(&mirror.to_toml()), mirror, "{}", path.display());
            let json = serde_json::to_string(&evidence).unwrap();
            assert_eq!(serde_json::from_str::<Evidence>(&json).unwrap(), evidence, "{json}");
        }
    }

    #[test]
    fn a_standard_deviation_that_nobody_stated_is_not_written() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let evidence = Evidence::load(&root.join("tests/data/evidence/spin.toml")).unwrap();
        let text = evidence.to_toml();
        let sigmas: Vec<&str> = text.lines().filter(|line| line.contains("sigma")).collect();
        assert_eq!(sigmas, ["speed_before_sigma_m_s = 0.8"], "{text}");
        assert!(!text.contains("sensor"), "{text}");
    }

    #[test]
    fn every_key_survives() {
        let all = r#"
            case = "a \"quoted\" name"
            road = { friction = 0.7, drag_factor = 0.6, grade_percent = -4, cross_slope = 0.025 }
            struck_car = { mass_kg = 1500, length_m = 4.4, width_m = 1.8, yaw_inertia_kg_m2 = 2400 }
            striking_car = { cg_to_front_axle_m = 1.2, cg_to_rear_axle_m = 1.5, cg_height_m = 0.5 }
            weighing = { shared_scale_sigma = 0.01 }
            damage = { side = "rear", y_m = 0.2, x_m = -2.1, angle_deg = 4 }
            skid_before = { length_m = 12.5, locked_wheels = ["FL", "FR"], grade = -0.02 }
            striking_skid_before = { length_ft = 60, length_sigma_m = 1, drag_factor = 0.7 }
            rest = { x_m = 30.25, y_m = -4, heading_deg = 190 }
            striking_rest = { x_m = 60, y_m = 2 }
            after = { driver_braked = "yes", anti_lock = "no" }
            striking_after = { blocked_wheels = [], dragging_wheels = ["FR"], anti_lock = "yes" }
            [edr]
            delta_v_x_min_m_s = 1
            delta_v_x_max_m_s = 2
            sensor_y_m = 0.1
            ends_s = 0.2
            [[mark]]
            wheel = "FL"
            points_m = [[1, 2], [3, 4]]
            [[striking_mark]]
            wheel = "FL"
            kind = "side-slip"
            points_m = [[1, 3], [3, 5]]
            sigma_m = 0.2
            [striking_edr]
            speed_before_m_s = 21
            delta_v_y_min_m_s = -2
            delta_v_y_max_m_s = -1
            [[position]]
            time_s = 1.1
            x_m = 20
            y_m = 0
            [prior]
            target_speed_m_s = [5, 45]
            bullet_speed_m_s = [5, 46]
            heading_difference_rad = [-0.5, 0.5]
            bullet_sideslip_rad = [-0.2, 0.1]
            restitution = [0.1, 0.2]
            contact_friction = [0.1, 0.3]
            brake_start_s = [0.5, 1]
            brake_share = [0.5, 1]
            bullet_brake_start_s = [0, 0.1]
            bullet_brake_share = [1, 1.5]
        "#;
        let evidence = read(all);
        assert_eq!(read(&evidence.to_toml()), evidence, "{}", evidence.to_toml());
        let json = serde_json::to_string(&evidence).unwrap();
        assert_eq!(serde_json::from_str::<Evidence>(&json).unwrap(), evidence, "{json}");
        let mirror = evidence.mirrored();
        let [mark] = &mirror.striking_marks[..] else { panic!("one mark: {mirror:?}") };
        assert_eq!((mark.wheel, &mark.points_m[1]), (Wheel::FrontRight, &[3.0, -5.0]));
        let edr = mirror.striking_edr.unwrap();
        assert_eq!(edr.delta_v_y(), Some([1.0, 2.0]));
        assert_eq!(edr.speed_before().unwrap().value, 21.0);
        let [cross, mirrored] = [&evidence, &mirror].map(|of| of.slope().cross_slope);
        assert_eq!((cross, mirrored, mirror.slope().grade), (0.025, -0.025, -0.04));
        let locked = evidence.skid_before.as_ref().map(SkidBefore::locked_shares);
        assert_eq!(locked, Some([1.0, 0.0]));
        assert_eq!(mirror.mirrored(), evidence);
    }
}
