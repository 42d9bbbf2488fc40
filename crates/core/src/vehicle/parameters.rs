//! Parameters of the 4DOF vehicle. They are read from TOML files with units in the key names, and
//! every value is checked against a range.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::path::Path;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::data::{TomlError, TomlFile};
use crate::ranges::{
    CG_HEIGHT, CG_TO_AXLE, CG_TO_FRONT_END, CORNERING_COEFFICIENT, FRONT_ROLL_SHARE,
    LONGITUDINAL_FRICTION_RATIO, OUTER_LENGTH, OUTER_WIDTH, ROAD_FRICTION, ROLL_ARM,
    ROLL_AXIS_HEIGHT, ROLL_DAMPING, ROLL_INERTIA, ROLL_STIFFNESS, ROLL_YAW_PRODUCT, ROLLING_RADIUS,
    ROLLING_RESISTANCE, ROLLING_RESISTANCE_PER_SPEED, ROLLING_RESISTANCE_PER_SPEED_2, Range,
    SLIDING_FRICTION_RATIO, SPRUNG_MASS, TRACK_WIDTH, VEHICLE_MASS, VEHICLE_YAW_INERTIA,
    WHEEL_INERTIA,
};
use crate::units::Phrase;
use crate::vehicle::sheet::SheetQuantity;
use crate::vehicle::tire::{TireParameters, WHEEL_MASS_SHARE};
use crate::vehicle::{
    CrushParameters, DataSheet, Equations, FixedObject, MultibodyRecord, RoadSlope,
    VehicleMismatch, Wheel,
};

/// Parameters of one vehicle in SI units. [`VehicleParameters::load`] and
/// [`VehicleParameters::parse`] check every value against its range.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VehicleParameters {
    /// Name of the vehicle in lists and reports.
    pub name: String,
    /// Source of the values, as free text for the user.
    pub source: String,
    /// Form of the equations of motion: the corrected one, unless the file says `equations =
    /// "paper"`.
    #[serde(default, skip_serializing_if = "is_corrected")]
    pub equations: Equations,
    /// Masses and moments of inertia.
    pub mass: MassParameters,
    /// Positions of axles and CG, and outer dimensions.
    pub geometry: GeometryParameters,
    /// Roll axis, roll stiffness and roll damping.
    pub suspension: SuspensionParameters,
    /// Parameters of tires and road.
    pub tires: TireParameters,
    /// How stiff its faces are, as far as it is known; the rest follows by rule.
    #[serde(default, skip_serializing_if = "CrushParameters::is_empty")]
    pub crush: CrushParameters,
    /// Estimated values: for each key of the file, such as `tires.friction`, the rule by which its
    /// value was estimated.
    #[serde(default)]
    pub estimates: BTreeMap<String, String>,
    /// Values that were said elsewhere than by the source: for each key of the file, what they replace.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub stated: BTreeMap<String, String>,
    /// The data sheet from which the parameters follow, if they do: it says how uncertain each
    /// estimate is, and what else changes with the mass. It is not part of a full vehicle file.
    #[serde(skip)]
    pub sheet: Option<Arc<DataSheet>>,
    /// Slope of the road that it is on, which is part of a question and of no vehicle file.
    #[serde(skip)]
    pub slope: RoadSlope,
    /// What it is, if it is no vehicle but an object that does not move; likewise.
    #[serde(skip)]
    pub fixed: Option<FixedObject>,
}

/// Masses and moments of inertia of one vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MassParameters {
    /// Total mass m, kg.
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

/// Positions of axles and CG, and outer dimensions of one vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GeometryParameters {
    /// Longitudinal distance l_f from the CG to the front axle, m.
    pub cg_to_front_axle_m: f64,
    /// Longitudinal distance l_r from the CG to the rear axle, m.
    pub cg_to_rear_axle_m: f64,
    /// Track width w of both axles, m.
    pub track_width_m: f64,
    /// Height h_cog of the CG of the whole vehicle above the ground, m.
    pub cg_height_m: f64,
    /// Outer length of the body, m.
    pub outer_length_m: f64,
    /// Outer width of the body, m.
    pub outer_width_m: f64,
    /// Longitudinal distance from the CG to the front end of the body, m.
    pub cg_to_front_end_m: f64,
}

/// Parameters of the roll motion of the sprung mass of one vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SuspensionParameters {
    /// Height of the roll axis above the ground at the longitudinal position of the CG, m.
    pub roll_axis_height_m: f64,
    /// Vertical distance h from the roll axis to the CG of the sprung mass, m.
    pub roll_arm_m: f64,
    /// Roll stiffness K_φ of both axles together, N m/rad.
    pub roll_stiffness_n_m_rad: f64,
    /// Roll damping coefficient B of both axles together, N m s/rad.
    pub roll_damping_n_m_s_rad: f64,
    /// Share of the front axle in the roll stiffness, 0 to 1.
    pub front_roll_stiffness_share: f64,
}

impl GeometryParameters {
    /// Wheelbase l_f + l_r, m.
    pub fn wheelbase_m(&self) -> f64 {
        self.cg_to_front_axle_m + self.cg_to_rear_axle_m
    }

    /// Place `[x, y]` of the centre of a wheel in body axes, m.
    pub fn wheel_place_m(&self, wheel: Wheel) -> [f64; 2] {
        let half_m = self.track_width_m / 2.0;
        let x_m = match wheel.is_front() {
            true => self.cg_to_front_axle_m,
            false => -self.cg_to_rear_axle_m,
        };
        match wheel {
            Wheel::FrontLeft | Wheel::RearLeft => [x_m, half_m],
            Wheel::FrontRight | Wheel::RearRight => [x_m, -half_m],
        }
    }
}

/// What the path of a file calls a car: the name of the file, or of its folder where the file is called
/// `vehicle.toml`.
fn car_name(path: &Path) -> Option<&str> {
    let stem = path.file_stem().and_then(OsStr::to_str);
    let folder = || path.parent().and_then(Path::file_name).and_then(OsStr::to_str);
    if stem == Some("vehicle") { folder() } else { stem }
}

impl VehicleParameters {
    /// Reads a vehicle file and checks the range of every value. The file has the format of this
    /// type, or it is a data sheet with what is known of a car (see [`DataSheet`]), or the data sheet
    /// of a multibody model that comes with a trajectory data set (see [`MultibodyRecord`]).
    ///
    /// # Errors
    /// [`TomlError`] if the file cannot be read, is not valid TOML, or has a key that is missing,
    /// unknown, of the wrong type or out of range.
    pub fn load(path: &Path) -> Result<Self, TomlError> {
        Self::parse(&TomlFile::read(path)?, path)
    }

    /// Reads a vehicle from the text of a file. The `path` serves only to name the file in errors.
    ///
    /// # Errors
    /// The errors of [`VehicleParameters::load`] except [`TomlError::File`].
    pub fn parse(text: &str, path: &Path) -> Result<Self, TomlError> {
        let file = TomlFile { path, text };
        let table: toml::Table = file.to()?;
        let is_multibody = table.get("mass").is_some_and(|mass| mass.get("total").is_some());
        let (vehicle, origin): (Self, Origin) = if is_multibody {
            (file.to::<MultibodyRecord>()?.parameters(car_name(path)), MultibodyRecord::origin)
        } else if table.contains_key("data_sheet") {
            (DataSheet::from_toml(file)?.vehicle(), DataSheet::origin)
        } else {
            let vehicle: Self = file.to()?;
            let is_known = table["tires"].get("wheel_inertia_kg_m2").is_some();
            (if is_known { vehicle } else { vehicle.with_estimated_wheels() }, |_| None)
        };
        vehicle.check(file, origin)?;
        Ok(vehicle)
    }

    /// The same vehicle with the inertia of its wheels estimated, as of 13 multibody cars.
    fn with_estimated_wheels(mut self) -> Self {
        let radius_m = self.tires.rolling_radius_m;
        self.tires.wheel_inertia_kg_m2 = WHEEL_MASS_SHARE * self.mass.mass_kg * radius_m * radius_m;
        let rule = "0.0115 × mass × radius² (13 multibody cars)".to_owned();
        self.estimates.insert("tires.wheel_inertia_kg_m2".to_owned(), rule);
        self
    }

    /// The same vehicle on a road with another peak friction coefficient. The value is not checked.
    pub fn with_friction(mut self, friction: f64) -> Self {
        self.tires.friction = friction;
        if let Some(sheet) = &mut self.sheet {
            Arc::make_mut(sheet).set(SheetQuantity::Friction, friction);
            self.estimates.remove("tires.friction");
        }
        self
    }

    /// The same vehicle with another form of the equations of motion, which replaces that of its
    /// file.
    pub fn with_equations(mut self, equations: Equations) -> Self {
        self.equations = equations;
        self
    }

    /// The same vehicle on a road with a slope, which is not checked.
    pub fn on_slope(mut self, slope: RoadSlope) -> Self {
        self.slope = slope;
        self
    }

    /// The same vehicle with the estimates of its data sheet away from their medians; unchanged if it
    /// has no data sheet.
    ///
    /// - `latents`: for each estimate, in the order of [`DataSheet::estimated`], by how many standard
    ///   deviations.
    pub fn drawn(&self, latents: &[f64]) -> Self {
        match &self.sheet {
            Some(sheet) => {
                sheet.at(latents).vehicle().with_equations(self.equations).on_slope(self.slope)
            }
            None => self.clone(),
        }
    }

    /// Whether every value lies in its range, and all go together.
    pub(super) fn is_consistent(&self) -> bool {
        self.ranges().iter().all(|(_, value, range)| range.contains(*value))
            && self.check_relations().is_ok()
    }

    /// Checks every value against its range and against the other values.
    fn check(&self, file: TomlFile<'_>, origin: Origin) -> Result<(), TomlError> {
        let refused = |key: &str, value: f64, expected: &str| {
            let is_written = |record_key: &&str| file.contains(record_key);
            match origin(key).filter(is_written) {
                None => match (self.estimates.get(key), origin(key)) {
                    (Some(rule), Some(record_key)) => file.wrong_value(
                        key,
                        &value.to_string(),
                        &format!("{expected}; it was estimated: {rule}; say {record_key}"),
                    ),
                    _ => file.wrong_value(key, &value.to_string(), expected),
                },
                Some(record_key) => file.wrong_value(
                    record_key,
                    &value.to_string(),
                    &format!("a value with which {key} is {expected}; now it is {value}"),
                ),
            }
        };
        let is_outside = |(_, value, range): &(_, f64, Range)| !range.contains(*value);
        if let Some((key, value, range)) = self.ranges().into_iter().find(is_outside) {
            return Err(refused(key, value, &range.expected_si()));
        }
        self.check_relations()
            .map_err(|VehicleMismatch { key, value, expected }| refused(key, value, &expected))
    }

    /// The values that are hardly meant in their unit, in words.
    pub fn odd_numbers(&self) -> Vec<Phrase> {
        let numbers = self.ranges().into_iter();
        numbers.filter_map(|(key, value, range)| range.odd(key, value)).collect()
    }

    /// Every value with its range, which other values of the vehicle may limit further.
    pub(in crate::vehicle) fn ranges(&self) -> Vec<(&'static str, f64, Range)> {
        let Self { mass, geometry, suspension, tires, crush, .. } = self;
        let coupling = (mass.yaw_inertia_kg_m2 * mass.roll_inertia_kg_m2).max(0.0).sqrt() * 0.95;
        let roll_yaw_product = ROLL_YAW_PRODUCT.within([-coupling, coupling]);
        let sprung_mass = SPRUNG_MASS.at_most(mass.mass_kg);
        let cg_to_front_end = CG_TO_FRONT_END.at_most(geometry.outer_length_m);
        let [front, rear] =
            [tires.cornering_coefficient_front_per_rad, tires.cornering_coefficient_rear_per_rad];
        let roll_share = suspension.front_roll_stiffness_share;
        let mut ranges = vec![
            ("mass.mass_kg", mass.mass_kg, VEHICLE_MASS),
            ("mass.sprung_mass_kg", mass.sprung_mass_kg, sprung_mass),
            ("mass.yaw_inertia_kg_m2", mass.yaw_inertia_kg_m2, VEHICLE_YAW_INERTIA),
            ("mass.roll_inertia_kg_m2", mass.roll_inertia_kg_m2, ROLL_INERTIA),
            ("mass.roll_yaw_product_kg_m2", mass.roll_yaw_product_kg_m2, roll_yaw_product),
            ("geometry.cg_to_front_axle_m", geometry.cg_to_front_axle_m, CG_TO_AXLE),
            ("geometry.cg_to_rear_axle_m", geometry.cg_to_rear_axle_m, CG_TO_AXLE),
            ("geometry.track_width_m", geometry.track_width_m, TRACK_WIDTH),
            ("geometry.cg_height_m", geometry.cg_height_m, CG_HEIGHT),
            ("geometry.outer_length_m", geometry.outer_length_m, OUTER_LENGTH),
            ("geometry.outer_width_m", geometry.outer_width_m, OUTER_WIDTH),
            ("geometry.cg_to_front_end_m", geometry.cg_to_front_end_m, cg_to_front_end),
            ("suspension.roll_axis_height_m", suspension.roll_axis_height_m, ROLL_AXIS_HEIGHT),
            ("suspension.roll_arm_m", suspension.roll_arm_m, ROLL_ARM),
            (
                "suspension.roll_stiffness_n_m_rad",
                suspension.roll_stiffness_n_m_rad,
                ROLL_STIFFNESS,
            ),
            ("suspension.roll_damping_n_m_s_rad", suspension.roll_damping_n_m_s_rad, ROLL_DAMPING),
            ("suspension.front_roll_stiffness_share", roll_share, FRONT_ROLL_SHARE),
            ("tires.cornering_coefficient_front_per_rad", front, CORNERING_COEFFICIENT),
            ("tires.cornering_coefficient_rear_per_rad", rear, CORNERING_COEFFICIENT),
            ("tires.friction", tires.friction, ROAD_FRICTION),
            ("tires.sliding_friction_ratio", tires.sliding_friction_ratio, SLIDING_FRICTION_RATIO),
            (
                "tires.longitudinal_friction_ratio",
                tires.longitudinal_friction_ratio,
                LONGITUDINAL_FRICTION_RATIO,
            ),
            ("tires.rolling_resistance", tires.rolling_resistance, ROLLING_RESISTANCE),
            (
                "tires.rolling_resistance_s_m",
                tires.rolling_resistance_s_m,
                ROLLING_RESISTANCE_PER_SPEED,
            ),
            (
                "tires.rolling_resistance_s2_m2",
                tires.rolling_resistance_s2_m2,
                ROLLING_RESISTANCE_PER_SPEED_2,
            ),
            ("tires.rolling_radius_m", tires.rolling_radius_m, ROLLING_RADIUS),
            ("tires.wheel_inertia_kg_m2", tires.wheel_inertia_kg_m2, WHEEL_INERTIA),
        ];
        ranges.extend(crush.ranges());
        ranges
    }
}

/// The key of a file from which a parameter follows; `None` where the parameter is the key.
type Origin = fn(&str) -> Option<&'static str>;

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
        assert_eq!(
            error.to_string(),
            "car.toml:5:11: mass.mass_kg is -3.0, expected 1 to 50000 kg"
        );
        assert!(reference_with("mass_kg = 2000.0", "mass_kg = nan").is_err());
    }

    /// The reference car with its mass in another notation.
    fn reference_with_mass_written(as_text: &str) -> Result<VehicleParameters, TomlError> {
        let text = Preset::Reference.text();
        let (head, rest) = text.split_once("[mass]\n").unwrap();
        let (_, tail) = rest.split_once("\n\n").unwrap();
        VehicleParameters::parse(&format!("{head}{as_text}\n\n{tail}"), Path::new("car.toml"))
    }

    #[test]
    fn a_wrong_value_is_found_in_inline_tables_and_behind_dotted_keys() {
        let others = "sprung_mass_kg = 1642.6, yaw_inertia_kg_m2 = 3961.6, \
                      roll_inertia_kg_m2 = 1126.03, roll_yaw_product_kg_m2 = 134.4";
        let inline = |mass: &str| format!("mass = {{ mass_kg = {mass}, {others} }}");
        let dotted =
            |mass: &str| format!("mass.mass_kg = {mass}\nmass.{}", others.replace(", ", "\nmass."));
        for (written, column) in [(inline("-1"), 20), (dotted("-1"), 16)] {
            let error = reference_with_mass_written(&written).unwrap_err().to_string();
            let place = format!("car.toml:4:{column}: mass.mass_kg is -1, ");
            assert!(error.starts_with(&place), "{error}");
        }
        for (written, column) in [
            (inline("\"heavy\""), 20),
            (dotted("\"heavy\""), 16),
            (inline("[1, 2]"), 20),
            (dotted("{ kg = 1 }"), 16),
        ] {
            let error = reference_with_mass_written(&written).unwrap_err().to_string();
            assert!(error.starts_with(&format!("car.toml:4:{column}: ")), "{error}");
        }
        for written in [
            inline("2000").replace("sprung", "sprang"),
            dotted("2000").replace(".sprung", ".sprang"),
        ] {
            let error = reference_with_mass_written(&written).unwrap_err().to_string();
            let line = if written.contains('\n') { 5 } else { 4 };
            assert!(error.starts_with(&format!("car.toml:{line}:")), "{error}");
            assert!(error.contains("sprang_mass_kg"), "{error}");
        }
        for written in ["mass = [1, 2]", "mass = 3"] {
            let error = reference_with_mass_written(written).unwrap_err().to_string();
            assert!(error.starts_with("car.toml:4:8: "), "{error}");
        }
        let missing = inline("2000").replace("mass_kg = 2000, ", "");
        let error = reference_with_mass_written(&missing).unwrap_err().to_string();
        assert!(error.starts_with("car.toml:4:"), "{error}");
        assert!(reference_with_mass_written(&inline("2000")).is_ok());
        assert!(reference_with_mass_written(&dotted("2000")).is_ok());
    }

    #[test]
    fn a_wrong_value_of_a_multibody_record_is_found_in_the_record() {
        let path = Path::new(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../datasets/trajectories-fea/vehicle.toml"
        ));
        let text = TomlFile::read(path).unwrap();
        let line_of = |key: &str| text.lines().position(|line| line.starts_with(key)).unwrap() + 1;
        for (key, value, parameter) in [
            ("total = ", "-3.0", "mass.mass_kg"),
            ("Izz = ", "nan", "mass.yaw_inertia_kg_m2"),
            ("track_front = ", "90.0", "geometry.track_width_m"),
            ("half_width = ", "0.0", "geometry.outer_width_m"),
            ("cg_height = ", "0.1", "suspension.roll_arm_m"),
            ("roll_damping_fit = ", "-1.0", "suspension.roll_damping_n_m_s_rad"),
            ("sliding_over_peak = ", "3.0", "tires.sliding_friction_ratio"),
        ] {
            let line = text.lines().nth(line_of(key) - 1).unwrap();
            let wrong = text.replace(line, &format!("{key}{value}"));
            let error = VehicleParameters::parse(&wrong, path).unwrap_err().to_string();
            let place = format!("{}:{}:{}: ", path.display(), line_of(key), key.len() + 1);
            assert!(error.starts_with(&place), "{error}, expected {place}");
            assert!(error.contains(parameter) && error.contains(value), "{error}");
        }
    }

    #[test]
    fn parameters_that_do_not_go_together_are_refused_by_both_names() {
        for (old, new, others) in [
            ("yaw_inertia_kg_m2 = 3961.6", "yaw_inertia_kg_m2 = 20.0", "mass.mass_kg"),
            ("roll_inertia_kg_m2 = 1126.03", "roll_inertia_kg_m2 = 300.0", "suspension.roll_arm_m"),
            ("roll_stiffness_n_m_rad = 93268.9", "roll_stiffness_n_m_rad = 7000.0", "roll_arm_m"),
            ("roll_damping_n_m_s_rad = 19000.0", "roll_damping_n_m_s_rad = 1e6", ""),
        ] {
            let result = reference_with(old, new);
            if others.is_empty() {
                assert!(result.is_ok(), "{new}");
                continue;
            }
            let error = result.unwrap_err().to_string();
            let (key, _) = new.split_once(' ').unwrap();
            assert!(error.contains(key) && error.contains(others), "{error}");
            assert!(error.starts_with("car.toml:") && !error.contains(":1:1:"), "{error}");
        }
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
        assert_eq!(error.to_string(), "no/such.toml: does not exist; check the name");
    }
}
