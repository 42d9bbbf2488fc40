//! Parameters of the 4DOF vehicle: TOML files with units in the key names, range-checked on load.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::data::{TomlError, TomlFile};
use crate::vehicle::tire::TireParameters;
use crate::vehicle::{Equations, MultibodyRecord};

/// One vehicle. SI units; every value lies in a range that is checked on load.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VehicleParameters {
    /// What a list calls it.
    pub name: String,
    /// Where the values come from.
    pub source: String,
    /// Which equations of motion; the corrected ones unless the file says `equations = "paper"`.
    #[serde(default, skip_serializing_if = "is_corrected")]
    pub equations: Equations,
    /// Mass and inertia.
    pub mass: MassParameters,
    /// Lengths.
    pub geometry: GeometryParameters,
    /// Roll of the sprung mass.
    pub suspension: SuspensionParameters,
    /// Tyres and road.
    pub tires: TireParameters,
    /// Keys whose values are estimates, with the rule that gave them.
    #[serde(default)]
    pub estimates: BTreeMap<String, String>,
}

/// Mass and inertia of one vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MassParameters {
    /// Whole mass m, kg.
    pub mass_kg: f64,
    /// Sprung mass m_s, kg.
    pub sprung_mass_kg: f64,
    /// Yaw moment of inertia I_zz about the CG, kg m².
    pub yaw_inertia_kg_m2: f64,
    /// Roll moment of inertia I_xx about the roll axis, kg m².
    pub roll_inertia_kg_m2: f64,
    /// Roll–yaw product of inertia I_xz, kg m².
    pub roll_yaw_product_kg_m2: f64,
}

/// Lengths of one vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GeometryParameters {
    /// CG to front axle l_f, m.
    pub cg_to_front_axle_m: f64,
    /// CG to rear axle l_r, m.
    pub cg_to_rear_axle_m: f64,
    /// Track width w, m.
    pub track_width_m: f64,
    /// Height of the CG above the ground, m.
    pub cg_height_m: f64,
    /// Outer length, m.
    pub outer_length_m: f64,
    /// Outer width, m.
    pub outer_width_m: f64,
    /// CG to the front end of the body, m.
    pub cg_to_front_end_m: f64,
}

/// Roll of the sprung mass of one vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SuspensionParameters {
    /// Height of the roll axis below the CG, above the ground, m.
    pub roll_axis_height_m: f64,
    /// Arm h from the roll axis to the CG of the sprung mass, m.
    pub roll_arm_m: f64,
    /// Roll stiffness K_φ of both axles, N m/rad.
    pub roll_stiffness_n_m_rad: f64,
    /// Roll damping B, N m s/rad.
    pub roll_damping_n_m_s_rad: f64,
    /// Share of the front axle in the roll stiffness.
    pub front_roll_stiffness_share: f64,
}

impl GeometryParameters {
    /// Wheelbase l_f + l_r, m.
    pub fn wheelbase_m(&self) -> f64 {
        self.cg_to_front_axle_m + self.cg_to_rear_axle_m
    }
}

impl VehicleParameters {
    /// Reads a vehicle: our own format, or the record of a multibody model that comes with a
    /// trajectory dataset (see [`MultibodyRecord`]).
    ///
    /// # Errors
    /// [`TomlError`], naming file, line, key, value and range.
    pub fn load(path: &Path) -> Result<Self, TomlError> {
        Self::parse(&TomlFile::read(path)?, path)
    }

    /// Reads a vehicle from the text of a file; `path` is for messages.
    ///
    /// # Errors
    /// As [`VehicleParameters::load`].
    pub fn parse(text: &str, path: &Path) -> Result<Self, TomlError> {
        let file = TomlFile { path, text };
        let table: toml::Table = file.to()?;
        let is_multibody = table.get("mass").is_some_and(|mass| mass.get("total").is_some());
        let vehicle: Self =
            if is_multibody { file.to::<MultibodyRecord>()?.parameters() } else { file.to()? };
        vehicle.check(file)?;
        Ok(vehicle)
    }

    /// The same vehicle on a road of this peak friction.
    pub fn with_friction(mut self, friction: f64) -> Self {
        self.tires.friction = friction;
        self
    }

    /// The same vehicle under these equations of motion; an explicit choice overrides its file's.
    pub fn with_equations(mut self, equations: Equations) -> Self {
        self.equations = equations;
        self
    }

    /// The same kind of vehicle with another mass: what belongs to the mass (sprung mass, roll
    /// inertia, product of inertia, roll stiffness and damping) scales with it. Yaw inertia scales
    /// too unless it is given.
    pub fn with_mass(mut self, mass_kg: f64, yaw_inertia_kg_m2: Option<f64>) -> Self {
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

    /// Checks every value against its range.
    fn check(&self, file: TomlFile<'_>) -> Result<(), TomlError> {
        let is_outside = |(_, value, [low, high]): &(_, f64, [f64; 2])| {
            !(*low..=*high).contains(value) // also for NaN
        };
        match self.ranges().into_iter().find(is_outside) {
            Some((key, value, range)) => Err(file.out_of_range(key, value, range)),
            None => Ok(()),
        }
    }

    /// Every value with its `[lowest, highest]`, wide enough for a 1:10 model and a heavy truck.
    fn ranges(&self) -> Vec<(&'static str, f64, [f64; 2])> {
        let Self { mass, geometry, suspension, tires, .. } = self;
        let coupling = (mass.yaw_inertia_kg_m2 * mass.roll_inertia_kg_m2).max(0.0).sqrt() * 0.95;
        vec![
            ("mass.mass_kg", mass.mass_kg, [1.0, 50_000.0]),
            ("mass.sprung_mass_kg", mass.sprung_mass_kg, [0.5, mass.mass_kg]),
            ("mass.yaw_inertia_kg_m2", mass.yaw_inertia_kg_m2, [1e-3, 1e6]),
            ("mass.roll_inertia_kg_m2", mass.roll_inertia_kg_m2, [1e-3, 1e5]),
            ("mass.roll_yaw_product_kg_m2", mass.roll_yaw_product_kg_m2, [-coupling, coupling]),
            ("geometry.cg_to_front_axle_m", geometry.cg_to_front_axle_m, [0.05, 10.0]),
            ("geometry.cg_to_rear_axle_m", geometry.cg_to_rear_axle_m, [0.05, 10.0]),
            ("geometry.track_width_m", geometry.track_width_m, [0.05, 4.0]),
            ("geometry.cg_height_m", geometry.cg_height_m, [0.01, 3.0]),
            ("geometry.outer_length_m", geometry.outer_length_m, [0.1, 25.0]),
            ("geometry.outer_width_m", geometry.outer_width_m, [0.05, 4.0]),
            (
                "geometry.cg_to_front_end_m",
                geometry.cg_to_front_end_m,
                [0.0, geometry.outer_length_m],
            ),
            ("suspension.roll_axis_height_m", suspension.roll_axis_height_m, [-1.0, 2.0]),
            ("suspension.roll_arm_m", suspension.roll_arm_m, [0.0, 3.0]),
            ("suspension.roll_stiffness_n_m_rad", suspension.roll_stiffness_n_m_rad, [1.0, 1e7]),
            ("suspension.roll_damping_n_m_s_rad", suspension.roll_damping_n_m_s_rad, [0.0, 1e6]),
            (
                "suspension.front_roll_stiffness_share",
                suspension.front_roll_stiffness_share,
                [0.0, 1.0],
            ),
            (
                "tires.cornering_coefficient_front_per_rad",
                tires.cornering_coefficient_front_per_rad,
                [1.0, 60.0],
            ),
            (
                "tires.cornering_coefficient_rear_per_rad",
                tires.cornering_coefficient_rear_per_rad,
                [1.0, 60.0],
            ),
            ("tires.friction", tires.friction, [0.01, 2.0]),
            ("tires.sliding_friction_ratio", tires.sliding_friction_ratio, [0.1, 1.0]),
            ("tires.rolling_resistance", tires.rolling_resistance, [0.0, 0.5]),
            ("tires.rolling_resistance_s_m", tires.rolling_resistance_s_m, [0.0, 0.01]),
            ("tires.rolling_resistance_s2_m2", tires.rolling_resistance_s2_m2, [0.0, 0.001]),
        ]
    }
}

fn is_corrected(equations: &Equations) -> bool {
    *equations == Equations::Corrected
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vehicle::Preset;

    fn reference_with(old: &str, new: &str) -> Result<VehicleParameters, TomlError> {
        let text = Preset::Reference.text();
        assert!(text.contains(old), "{old} not in {text}");
        VehicleParameters::parse(&text.replace(old, new), Path::new("car.toml"))
    }

    #[test]
    fn a_value_out_of_range_names_file_line_key_value_and_range() {
        let error = reference_with("mass_kg = 2000.0", "mass_kg = -3.0").unwrap_err();
        assert_eq!(error.to_string(), "car.toml:5:11: mass.mass_kg is -3.0, expected 1 to 50000");
        assert!(reference_with("mass_kg = 2000.0", "mass_kg = nan").is_err());
    }

    #[test]
    fn text_an_unknown_key_and_a_missing_key_are_found() {
        let text =
            reference_with("mass_kg = 2000.0", "mass_kg = \"heavy\"").unwrap_err().to_string();
        assert!(text.starts_with("car.toml:5:11: ") && text.contains("string"), "{text}");
        let text = reference_with("mass_kg = 2000.0", "mas_kg = 2000.0").unwrap_err().to_string();
        assert!(text.starts_with("car.toml:5:1: ") && text.contains("mas_kg"), "{text}");
        let text = reference_with("mass_kg = 2000.0\n", "").unwrap_err().to_string();
        assert!(text.starts_with("car.toml:4:1: ") && text.contains("mass_kg"), "{text}");
    }

    #[test]
    fn a_missing_file_is_said_to_be_missing() {
        let error = VehicleParameters::load(Path::new("no/such.toml")).unwrap_err();
        assert_eq!(error.to_string(), "no/such.toml: cannot be read");
    }
}
