//! A vehicle with another mass than its file says, and what is noted of that.

use crate::units::NumberFormat;
use crate::vehicle::sheet::SheetQuantity;
use crate::vehicle::{DataSheet, MassParameters, VehicleParameters};

/// Keys of the values that are scaled with the mass, without the yaw inertia, which may be said itself.
const SCALED_KEYS: [&str; 5] = [
    "mass.sprung_mass_kg",
    "mass.roll_inertia_kg_m2",
    "mass.roll_yaw_product_kg_m2",
    "suspension.roll_stiffness_n_m_rad",
    "suspension.roll_damping_n_m_s_rad",
];

/// Key of the mass.
const MASS_KEY: &str = "mass.mass_kg";
/// Key of the yaw inertia.
const YAW_INERTIA_KEY: &str = "mass.yaw_inertia_kg_m2";

impl VehicleParameters {
    /// The same vehicle with the mass that a scenario, a case or the evidence says, as
    /// [`VehicleParameters::scaled_to_mass`]; [`VehicleParameters::estimates`] and
    /// [`VehicleParameters::stated`] say which values are not those of the source any more.
    pub fn with_mass(self, mass_kg: f64, yaw_inertia_kg_m2: Option<f64>) -> Self {
        let before = self.mass;
        let mut scaled = self.scaled_to_mass(mass_kg, yaw_inertia_kg_m2);
        if scaled.sheet.is_none() {
            scaled.note_mass(&before);
        }
        scaled
    }

    /// Whether its mass is that of a collision, and not that of the vehicle after which it is named.
    pub fn has_mass_of_collision(&self) -> bool {
        self.stated.get(MASS_KEY).is_some_and(|note| note.starts_with("said with the collision"))
    }

    /// Notes what of a vehicle without a data sheet was changed with its mass.
    fn note_mass(&mut self, before: &MassParameters) {
        let ratio = self.mass.mass_kg / before.mass_kg;
        let yaw_inertia = self.mass.yaw_inertia_kg_m2;
        let differs = |a: f64, b: f64| (a - b).abs() > 1e-9 * b.abs();
        let is_scaled = !differs(yaw_inertia, before.yaw_inertia_kg_m2 * ratio);
        if !is_scaled && differs(yaw_inertia, before.yaw_inertia_kg_m2) {
            let text =
                format!("said with the collision, instead of {} kg m²", before.yaw_inertia_kg_m2);
            self.stated.insert(YAW_INERTIA_KEY.to_owned(), text);
            self.estimates.remove(YAW_INERTIA_KEY);
        }
        if !differs(self.mass.mass_kg, before.mass_kg) {
            return;
        }
        let text = format!("said with the collision, instead of {} kg", before.mass_kg);
        self.stated.insert(MASS_KEY.to_owned(), text);
        self.estimates.remove(MASS_KEY);
        let masses = [before.mass_kg, self.mass.mass_kg];
        let [from, to] = masses.map(|kg| NumberFormat::default().stated_number(kg));
        let rule = format!("scaled in proportion to the mass, from {from} to {to} kg");
        for key in SCALED_KEYS.into_iter().chain(is_scaled.then_some(YAW_INERTIA_KEY)) {
            let own = self.estimates.entry(key.to_owned()).or_default();
            *own = if own.is_empty() { rule.clone() } else { format!("{own}; {rule}") };
            self.stated.remove(key);
        }
    }

    /// The same vehicle with another mass, without a note of it. Where the parameters follow from a data
    /// sheet, those that were estimated from the mass follow it. Otherwise sprung mass, roll inertia,
    /// product of inertia, roll stiffness and roll damping are scaled in proportion to the mass. The
    /// values are not checked.
    ///
    /// - `mass_kg`: total mass, kg.
    /// - `yaw_inertia_kg_m2`: yaw moment of inertia, kg m²; with `None` it is scaled in proportion
    ///   to the mass too, unless a data sheet states it.
    pub fn scaled_to_mass(mut self, mass_kg: f64, yaw_inertia_kg_m2: Option<f64>) -> Self {
        if let Some(sheet) = &self.sheet {
            let mut sheet = DataSheet::clone(sheet);
            sheet.state(SheetQuantity::Mass, mass_kg);
            if let Some(inertia) = yaw_inertia_kg_m2 {
                sheet.state(SheetQuantity::YawInertia, inertia);
            }
            return sheet.vehicle().with_equations(self.equations).on_slope(self.slope);
        }
        let ratio = mass_kg / self.mass.mass_kg;
        let mass = &mut self.mass;
        mass.yaw_inertia_kg_m2 = yaw_inertia_kg_m2.unwrap_or(mass.yaw_inertia_kg_m2 * ratio);
        let suspension = &mut self.suspension;
        for value in [
            &mut mass.mass_kg,
            &mut mass.sprung_mass_kg,
            &mut mass.roll_inertia_kg_m2,
            &mut mass.roll_yaw_product_kg_m2,
            &mut suspension.roll_stiffness_n_m_rad,
            &mut suspension.roll_damping_n_m_s_rad,
        ] {
            *value *= ratio;
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vehicle::Preset;

    #[test]
    fn another_mass_says_which_values_are_not_of_the_file_any_more() {
        let car = || Preset::Reference.parameters();
        let (mass_kg, inertia) = (car().mass.mass_kg, car().mass.yaw_inertia_kg_m2);
        assert_eq!(car().with_mass(mass_kg, Some(inertia)), car(), "nothing differs");
        let lighter = car().with_mass(1500.0, None);
        let source = &lighter.stated["mass.mass_kg"];
        assert_eq!(source, "said with the collision, instead of 2000 kg");
        assert_eq!(lighter.stated.len(), 1);
        assert!(lighter.has_mass_of_collision() && !car().has_mass_of_collision());
        for key in SCALED_KEYS.into_iter().chain([YAW_INERTIA_KEY]) {
            let rule = &lighter.estimates[key];
            assert!(
                rule.ends_with("scaled in proportion to the mass, from 2000 to 1500 kg"),
                "{rule}"
            );
        }
        // A mass that was stated in pounds had thirteen digits.
        let of_pounds = car().with_mass(3400.0 * 0.453_592_37, None);
        let rule = &of_pounds.estimates[YAW_INERTIA_KEY];
        assert!(rule.ends_with("from 2000 to 1542 kg"), "{rule}");
        let other = car().with_mass(1500.0, Some(2500.0));
        assert!(other.stated.contains_key(YAW_INERTIA_KEY), "{:?}", other.stated);
        assert!(!other.estimates.contains_key(YAW_INERTIA_KEY));
        let scaled = car().scaled_to_mass(1500.0, None);
        assert_eq!((scaled.mass, scaled.suspension), (lighter.mass, lighter.suspension));
        assert_eq!(scaled.estimates, car().estimates);
    }
}
