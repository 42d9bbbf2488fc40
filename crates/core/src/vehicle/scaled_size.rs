//! A vehicle that stands in for a model of one.
//!
//! ```text
//! s      length of the model over that of the vehicle
//! s      distances and heights          s³    masses
//! s⁵     moments of inertia             s⁴    roll stiffness, as weight times roll arm
//! s⁹ᐟ²   roll damping: 2 ζ √(K I)       1/s   drag area over weight
//! ```
//!
//! Density, angles, ratios, friction and the drag coefficient stay what they are.

use crate::vehicle::VehicleParameters;

/// Length over that of the vehicle below which something is a model of it, as for the estimates of data sheets.
const MODEL_SCALE: f64 = 0.5;

/// Keys of the values that follow the scale.
const SCALED_KEYS: [&str; 17] = [
    "mass.mass_kg",
    "mass.sprung_mass_kg",
    "mass.yaw_inertia_kg_m2",
    "mass.roll_inertia_kg_m2",
    "mass.roll_yaw_product_kg_m2",
    "geometry.cg_to_front_axle_m",
    "geometry.cg_to_rear_axle_m",
    "geometry.track_width_m",
    "geometry.cg_height_m",
    "geometry.outer_length_m",
    "geometry.outer_width_m",
    "suspension.roll_axis_height_m",
    "suspension.roll_arm_m",
    "suspension.roll_stiffness_n_m_rad",
    "suspension.roll_damping_n_m_s_rad",
    "tires.rolling_radius_m",
    "tires.wheel_inertia_kg_m2",
];

impl VehicleParameters {
    /// Scale of a model of the vehicle: its length over that of the vehicle, if that is less than half;
    /// otherwise 1, since it is a vehicle of its own size.
    ///
    /// - `length_m`: outer length of what the vehicle stands in for, m.
    pub fn model_scale(&self, length_m: f64) -> f64 {
        let scale = length_m / self.geometry.outer_length_m;
        if scale > 0.0 && scale < MODEL_SCALE { scale } else { 1.0 }
    }

    /// The vehicle in the scale of a model of it, if the length is less than half of its own; otherwise the
    /// same vehicle. What was scaled counts as estimated.
    ///
    /// - `length_m`: outer length of what it stands in for, m.
    pub fn at_model_scale(mut self, length_m: f64) -> Self {
        let scale = self.model_scale(length_m);
        if scale == 1.0 {
            return self;
        }
        let text = format!("in the scale of the length, 1:{:.1}", 1.0 / scale);
        let (mass, geometry) = (&mut self.mass, &mut self.geometry);
        let (suspension, tires) = (&mut self.suspension, &mut self.tires);
        let lengths = [
            &mut geometry.cg_to_front_axle_m,
            &mut geometry.cg_to_rear_axle_m,
            &mut geometry.track_width_m,
            &mut geometry.cg_height_m,
            &mut geometry.outer_length_m,
            &mut geometry.outer_width_m,
            &mut geometry.cg_to_front_end_m,
            &mut suspension.roll_axis_height_m,
            &mut suspension.roll_arm_m,
            &mut tires.rolling_radius_m,
        ];
        let inertias = [
            &mut mass.yaw_inertia_kg_m2,
            &mut mass.roll_inertia_kg_m2,
            &mut mass.roll_yaw_product_kg_m2,
            &mut tires.wheel_inertia_kg_m2,
        ];
        lengths.into_iter().for_each(|length| *length *= scale);
        inertias.into_iter().for_each(|inertia| *inertia *= scale.powi(5));
        mass.mass_kg *= scale.powi(3);
        mass.sprung_mass_kg *= scale.powi(3);
        suspension.roll_stiffness_n_m_rad *= scale.powi(4);
        suspension.roll_damping_n_m_s_rad *= scale.powf(4.5);
        tires.rolling_resistance_s2_m2 /= scale;
        self.sheet = None;
        for key in SCALED_KEYS {
            self.stated.remove(key);
            self.estimates.insert(key.to_owned(), text.clone());
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vehicle::{Preset, VehicleMismatch};

    /// A model of a car rolls faster by the root of the scale, and its weight leans it by the same angle.
    #[test]
    fn a_model_of_a_car_is_a_vehicle_that_can_be_followed() -> Result<(), VehicleMismatch> {
        let car = Preset::Reference.parameters();
        let model = car.clone().at_model_scale(0.1 * car.geometry.outer_length_m);
        let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-12, "{a} {b}");
        near(model.geometry.wheelbase_m(), 0.1 * car.geometry.wheelbase_m());
        near(model.mass.mass_kg, 1e-3 * car.mass.mass_kg);
        let frequency = |of: &VehicleParameters| {
            (of.suspension.roll_stiffness_n_m_rad / of.mass.roll_inertia_kg_m2).sqrt()
        };
        near(frequency(&model), 10.0_f64.sqrt() * frequency(&car));
        let lean = |of: &VehicleParameters| {
            of.mass.sprung_mass_kg * of.suspension.roll_arm_m / of.suspension.roll_stiffness_n_m_rad
        };
        near(lean(&model), lean(&car));
        let decay = |of: &VehicleParameters| {
            of.suspension.roll_damping_n_m_s_rad / of.mass.roll_inertia_kg_m2
        };
        near(decay(&model) / frequency(&model), decay(&car) / frequency(&car));
        assert_eq!(model.estimates["geometry.track_width_m"], "in the scale of the length, 1:10.0");
        model.check_relations()?;
        // A short car is a car.
        let short = car.clone().at_model_scale(0.6 * car.geometry.outer_length_m);
        assert_eq!(short, car);
        Ok(())
    }
}
