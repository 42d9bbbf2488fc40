//! Writes evidence as files.

use toml::{Table, Value};

use crate::evidence::file::{MARK_KINDS, SIDES, WHEELS};
use crate::evidence::{
    After, CarEvidence, Damage, DriverBraked, Edr, Evidence, Mark, Measured, PriorRanges, RestPose,
    VideoPosition,
};
use impactlab_core::collision::Side;
use impactlab_core::vehicle::Wheel;

impl Evidence {
    /// Returns the text of a file from which [`Evidence::from_toml`] reads the same evidence. Numbers
    /// are in SI units with all their digits. What such a file cannot say, as a mark of a single
    /// point, is written too, but the file is then refused on reading.
    pub fn to_toml(&self) -> String {
        let mut top = Table::new();
        set(&mut top, "case", Some(self.case.as_str()));
        let mut road = Table::new();
        measured(&mut road, "friction", "", self.friction);
        let scale = self.shared_scale_sigma;
        let weighing =
            scale.map(|sigma| Table::from_iter([("shared_scale_sigma".to_owned(), sigma.into())]));
        for (name, table) in [
            ("road", Some(road).filter(|road| !road.is_empty())),
            ("struck_car", Some(car_table(&self.struck_car))),
            ("striking_car", Some(car_table(&self.striking_car))),
            ("weighing", weighing),
            ("damage", Some(damage_table(&self.damage))),
            ("rest", self.rest.as_ref().map(rest_table)),
            ("striking_rest", self.striking_rest.as_ref().map(rest_table)),
            ("after", Some(after_table(&self.after))),
            ("edr", (self.edr != Edr::default()).then(|| edr_table(&self.edr))),
            ("prior", (self.prior != PriorRanges::default()).then(|| prior_table(&self.prior))),
        ] {
            set(&mut top, name, table);
        }
        for (name, tables) in [
            ("mark", self.marks.iter().map(mark_table).collect::<Vec<_>>()),
            ("position", self.positions.iter().map(position_table).collect()),
        ] {
            set(&mut top, name, Some(tables).filter(|tables| !tables.is_empty()));
        }
        top.to_string()
    }
}

fn set(table: &mut Table, key: &str, value: Option<impl Into<Value>>) {
    if let Some(value) = value {
        table.insert(key.to_owned(), value.into());
    }
}

/// A number with its standard deviation.
///
/// - `unit`: with its underscore; empty for a pure number.
fn measured(table: &mut Table, base: &str, unit: &str, of: Option<Measured>) {
    set(table, &format!("{base}{unit}"), of.map(|of| of.value));
    set(table, &format!("{base}_sigma{unit}"), of.map(|of| of.sigma));
}

fn car_table(car: &CarEvidence) -> Table {
    let mut table = Table::new();
    measured(&mut table, "mass", "_kg", car.mass_kg);
    for (key, value) in [
        ("cg_to_front_axle_m", car.cg_to_front_axle_m),
        ("cg_to_rear_axle_m", car.cg_to_rear_axle_m),
        ("track_m", car.track_m),
        ("cg_height_m", car.cg_height_m),
        ("length_m", car.length_m),
        ("width_m", car.width_m),
        ("yaw_inertia_kg_m2", car.yaw_inertia_kg_m2),
    ] {
        set(&mut table, key, value);
    }
    table
}

fn damage_table(damage: &Damage) -> Table {
    let mut table = Table::new();
    let side = SIDES.iter().find(|(_, side)| *side == damage.side).map(|(word, _)| *word);
    set(&mut table, "side", side);
    let (along, across) = match damage.side {
        Side::Left | Side::Right => ("x", "y_m"),
        Side::Front | Side::Rear => ("y", "x_m"),
    };
    measured(&mut table, along, "_m", Some(damage.along_m));
    set(&mut table, across, damage.depth_m);
    measured(&mut table, "angle", "_rad", damage.angle_rad);
    table
}

fn rest_table(rest: &RestPose) -> Table {
    let mut table = Table::new();
    set(&mut table, "x_m", Some(rest.x_m));
    set(&mut table, "y_m", Some(rest.y_m));
    set(&mut table, "position_sigma_m", Some(rest.position_sigma_m));
    measured(&mut table, "heading", "_rad", rest.heading_rad);
    table
}

fn after_table(after: &After) -> Table {
    let mut table = Table::new();
    let name = |wheel: &Wheel| WHEELS[wheel.index()];
    let blocked = after.blocked_wheels.as_ref();
    set(
        &mut table,
        "blocked_wheels",
        blocked.map(|wheels| wheels.iter().map(name).collect::<Vec<_>>()),
    );
    let braked = match after.driver_braked {
        DriverBraked::Yes => "yes",
        DriverBraked::No => "no",
        DriverBraked::Unknown => "unknown",
    };
    set(&mut table, "driver_braked", Some(braked));
    table
}

fn mark_table(mark: &Mark) -> Table {
    let mut table = Table::new();
    set(&mut table, "wheel", Some(WHEELS[mark.wheel.index()]));
    let kind = MARK_KINDS.iter().find(|(_, kind)| Some(*kind) == mark.kind).map(|(word, _)| *word);
    set(&mut table, "kind", kind);
    let points = mark.points_m.iter().map(|point| Value::from(point.to_vec()));
    set(&mut table, "points_m", Some(points.collect::<Vec<_>>()));
    set(&mut table, "sigma_m", Some(mark.sigma_m));
    table
}

fn edr_table(edr: &Edr) -> Table {
    let mut table = Table::new();
    for (base, bounds) in [("delta_v_x", edr.delta_v_x_m_s), ("delta_v_y", edr.delta_v_y_m_s)] {
        set(&mut table, &format!("{base}_min_m_s"), bounds.map(|[low, _]| low));
        set(&mut table, &format!("{base}_max_m_s"), bounds.map(|[_, high]| high));
    }
    measured(&mut table, "speed_before", "_m_s", edr.speed_before_m_s);
    let [x_m, y_m] = edr.sensor_m;
    set(&mut table, "sensor_x_m", Some(x_m));
    set(&mut table, "sensor_y_m", Some(y_m));
    set(&mut table, "ends_s", edr.ends_s);
    table
}

fn position_table(at: &VideoPosition) -> Table {
    let mut table = Table::new();
    for (key, value) in
        [("time_s", at.time_s), ("x_m", at.x_m), ("y_m", at.y_m), ("sigma_m", at.sigma_m)]
    {
        set(&mut table, key, Some(value));
    }
    table
}

fn prior_table(prior: &PriorRanges) -> Table {
    let mut table = Table::new();
    for (key, range) in [
        ("target_speed_m_s", prior.struck_speed_m_s),
        ("bullet_speed_m_s", prior.striking_speed_m_s),
        ("heading_difference_rad", prior.heading_difference_rad),
        ("bullet_sideslip_rad", prior.striking_sideslip_rad),
        ("restitution", prior.restitution),
        ("contact_friction", prior.contact_friction),
        ("brake_start_s", prior.brake_start_s),
        ("brake_share", prior.brake_share),
    ] {
        set(&mut table, key, range.map(Vec::from));
    }
    table
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::evidence::examples::read;

    #[test]
    fn what_is_written_is_read_as_the_same() {
        let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
            .join("datasets/staged/evidence");
        let mut files: Vec<_> =
            std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
        let guide =
            Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join("docs/guide/examples");
        files.extend(["position_alone.toml", "contradictory.toml"].map(|name| guide.join(name)));
        for path in files {
            let evidence = Evidence::load(&path).unwrap();
            let text = evidence.to_toml();
            assert_eq!(read(&text), evidence, "{}\n{text}", path.display());
            let mirror = evidence.mirrored();
            assert_eq!(read(&mirror.to_toml()), mirror, "{}", path.display());
        }
    }

    #[test]
    fn every_key_survives() {
        let all = r#"
            case = "a \"quoted\" name"
            road = { friction = 0.7 }
            struck_car = { mass_kg = 1500, length_m = 4.4, width_m = 1.8, yaw_inertia_kg_m2 = 2400 }
            striking_car = { cg_to_front_axle_m = 1.2, cg_to_rear_axle_m = 1.5, cg_height_m = 0.5 }
            weighing = { shared_scale_sigma = 0.01 }
            damage = { side = "rear", y_m = 0.2, x_m = -2.1, angle_deg = 4 }
            rest = { x_m = 30.25, y_m = -4, heading_deg = 190 }
            striking_rest = { x_m = 60, y_m = 2 }
            after = { driver_braked = "yes" }
            [edr]
            delta_v_x_min_m_s = 1
            delta_v_x_max_m_s = 2
            sensor_y_m = 0.1
            ends_s = 0.2
            [[mark]]
            wheel = "FL"
            points_m = [[1, 2], [3, 4]]
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
        "#;
        let evidence = read(all);
        assert_eq!(read(&evidence.to_toml()), evidence, "{}", evidence.to_toml());
    }
}
