//! Writes a data sheet as a vehicle file, and makes one of a vehicle whose parameters are all given.

use std::borrow::Cow;
use std::path::Path;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de, ser};
use serde_json::{Value, json};

use crate::data::{TomlError, TomlFile, key_with_unit};
use crate::ranges::Range;
use crate::units::{Quantity, STANDARD_GRAVITY_M_S2};
use crate::vehicle::sheet::derive::AIR_DENSITY_KG_M3;
use crate::vehicle::sheet::{DataSheet, SheetQuantity as Q, VehicleClass};
use crate::vehicle::{DrivenAxle, Equations, VehicleParameters};

/// Name of a sheet that has no file, in errors.
const NO_FILE: &str = "data sheet";

/// Largest relative difference between a parameter and the same one by way of a data sheet: files round
/// to four digits, and the radius of a wheel that a file leaves open moves the roll arm by 0.2 %.
const SAME: f64 = 3e-3;

impl Q {
    /// Whether the key of a vehicle file ends in the unit, which can then be chosen.
    pub(super) fn has_units(self) -> bool {
        self.range().quantity != Quantity::Ratio || self.unit().is_empty()
    }

    /// The key of a vehicle file with the SI unit.
    fn si_key(self) -> String {
        match self.has_units() {
            true => key_with_unit(self.key(), &self.range().quantity.si_unit()),
            false => self.key().to_owned(),
        }
    }
}

impl DataSheet {
    /// The sheet as a vehicle file, SI units.
    pub fn to_toml(&self) -> String {
        self.to_table().to_string()
    }

    fn to_table(&self) -> toml::Table {
        let mut sheet = toml::Table::new();
        sheet.insert("class".to_owned(), self.class.word().into());
        if let Some(drive) = self.drive {
            sheet.insert("drive".to_owned(), drive.word().into());
        }
        sheet.extend(
            self.known.iter().map(|(quantity, value)| (quantity.si_key(), (*value).into())),
        );
        let others = [
            ("roll_stiffness_n_m_rad", self.roll_stiffness_n_m_rad),
            ("roll_damping_n_m_s_rad", self.roll_damping_n_m_s_rad),
        ];
        let others = others.into_iter().filter_map(|(key, value)| Some((key, value?)));
        sheet.extend(others.map(|(key, value)| (key.to_owned(), value.into())));
        let mut table = toml::Table::new();
        table.insert("name".to_owned(), self.name.as_str().into());
        table.insert("source".to_owned(), self.source.as_str().into());
        if self.equations == Equations::Paper {
            table.insert("equations".to_owned(), "paper".into());
        }
        table.insert("data_sheet".to_owned(), sheet.into());
        if !self.crush.is_empty() {
            table.insert("crush".to_owned(), self.crush.to_table().into());
        }
        table
    }

    /// The vehicle of the sheet, whose values are checked as those of a file.
    ///
    /// # Errors
    /// [`TomlError`], as for [`VehicleParameters::load`].
    pub fn checked_vehicle(&self) -> Result<VehicleParameters, TomlError> {
        VehicleParameters::parse(&self.to_toml(), Path::new(NO_FILE))
    }

    /// The data sheet of a vehicle: its own, or one in which everything is known that its parameters say.
    ///
    /// - returns `None` if there is no sheet that leads to these parameters.
    pub fn from_parameters(vehicle: &VehicleParameters) -> Option<Self> {
        if let Some(sheet) = &vehicle.sheet {
            return Some(Self { equations: vehicle.equations, ..Self::clone(sheet) });
        }
        let VehicleParameters { mass, geometry, suspension, tires, .. } = vehicle;
        let weight_n = mass.mass_kg * STANDARD_GRAVITY_M_S2;
        let arm_m = suspension.roll_arm_m;
        let mut sheet = Self {
            name: vehicle.name.clone(),
            source: vehicle.source.clone(),
            equations: vehicle.equations,
            class: VehicleClass::Car,
            roll_stiffness_n_m_rad: Some(suspension.roll_stiffness_n_m_rad),
            roll_damping_n_m_s_rad: Some(suspension.roll_damping_n_m_s_rad),
            crush: vehicle.crush,
            ..Self::default()
        };
        for (quantity, value) in [
            (Q::Length, geometry.outer_length_m),
            (Q::Width, geometry.outer_width_m),
            (Q::Mass, mass.mass_kg),
            (Q::Wheelbase, geometry.wheelbase_m()),
            (Q::Track, geometry.track_width_m),
            (Q::FrontOverhang, geometry.cg_to_front_end_m - geometry.cg_to_front_axle_m),
            (Q::FrontShare, geometry.cg_to_rear_axle_m / geometry.wheelbase_m()),
            (Q::CgHeight, geometry.cg_height_m),
            (Q::YawInertia, mass.yaw_inertia_kg_m2),
            (Q::RollInertia, mass.roll_inertia_kg_m2 - mass.sprung_mass_kg * arm_m * arm_m),
            (Q::RollYawProduct, mass.roll_yaw_product_kg_m2),
            (Q::SprungMass, mass.sprung_mass_kg),
            (Q::WheelRadius, tires.rolling_radius_m),
            (Q::WheelInertia, tires.wheel_inertia_kg_m2),
            (Q::RollAxisHeight, suspension.roll_axis_height_m),
            (Q::FrontRollShare, suspension.front_roll_stiffness_share),
            (Q::RearCornering, tires.cornering_coefficient_rear_per_rad),
            (Q::FrontCornering, tires.cornering_coefficient_front_per_rad),
            (Q::Friction, tires.friction),
            (Q::SlidingRatio, tires.sliding_friction_ratio),
            (Q::RollingResistance, tires.rolling_resistance),
            (Q::DragArea, tires.rolling_resistance_s2_m2 * 2.0 * weight_n / AIR_DENSITY_KG_M3),
        ] {
            sheet.set(quantity, value);
        }
        let same = sheet.checked_vehicle().ok()?;
        let pairs = same.ranges().into_iter().zip(vehicle.ranges());
        let is_same = |((_, a, _), (_, b, _)): (Parameter, Parameter)| {
            (a - b).abs() <= SAME * b.abs().max(1e-3)
        };
        pairs.into_iter().all(is_same).then_some(sheet)
    }
}

/// A parameter by its key, with its value and range.
type Parameter = (&'static str, f64, Range);

/// As the table of a vehicle file.
impl Serialize for DataSheet {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let is_finite = self.known.values().all(|value| value.is_finite());
        if !is_finite {
            return Err(ser::Error::custom("a number that is not finite"));
        }
        self.to_table().serialize(serializer)
    }
}

/// From the table of a vehicle file.
impl<'de> Deserialize<'de> for DataSheet {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = toml::Table::deserialize(deserializer)?.to_string();
        let file = TomlFile { path: Path::new(NO_FILE), text: &text };
        Self::from_toml(file).map_err(de::Error::custom)
    }
}

/// As the table of a vehicle file: every quantity with its range.
impl JsonSchema for DataSheet {
    fn schema_name() -> Cow<'static, str> {
        "DataSheet".into()
    }

    fn json_schema(_generator: &mut SchemaGenerator) -> Schema {
        let number = |meaning: String| json!({ "type": "number", "description": meaning });
        let described = |quantity: &Q| {
            let meaning = format!("{}: {}", quantity.label(), quantity.range().expected_si());
            (quantity.si_key(), number(meaning))
        };
        let mut properties: serde_json::Map<String, Value> = Q::ALL.iter().map(described).collect();
        let words =
            |words: &[&str], meaning: &str| json!({ "enum": words, "description": meaning });
        let classes = VehicleClass::ALL.map(VehicleClass::word);
        let instead =
            |replaced: &str| number(format!("where it is known instead of the {replaced}"));
        properties.extend([
            ("class".to_owned(), words(&classes, "Kind of vehicle.")),
            ("drive".to_owned(), words(DrivenAxle::WORDS, "Driven axle, if it is known.")),
            ("roll_stiffness_n_m_rad".to_owned(), instead("roll gradient")),
            ("roll_damping_n_m_s_rad".to_owned(), instead("damping ratio")),
        ]);
        json_schema!({
            "type": "object",
            "description": "What is known of one car, as in a vehicle file: a key may end in another \
                            unit of its quantity. Everything else is estimated by rule.",
            "properties": {
                "name": { "type": "string", "description": "Name of the vehicle." },
                "source": { "type": "string", "description": "Source of the values." },
                "equations": { "type": "string", "description": "Form of the equations of motion." },
                "data_sheet": {
                    "type": "object",
                    "description": "What is known.",
                    "properties": properties,
                },
            },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vehicle::{LibraryVehicle, Preset};

    #[test]
    fn a_sheet_is_the_same_after_it_was_written_and_read() {
        for vehicle in LibraryVehicle::ALL {
            let sheet = DataSheet::from_parameters(&vehicle.parameters()).unwrap();
            let text = serde_json::to_string(&sheet).unwrap();
            let read: DataSheet = serde_json::from_str(&text).unwrap();
            assert_eq!(read, sheet, "{text}");
            assert_eq!(read.checked_vehicle().unwrap(), vehicle.parameters());
        }
    }

    #[test]
    fn every_car_of_the_program_has_a_sheet_that_leads_to_it() {
        for preset in Preset::ALL {
            let vehicle = preset.parameters();
            // The scaled models have roll arms that do not follow from CG and wheels.
            let is_car = vehicle.mass.mass_kg > 1000.0;
            assert_eq!(DataSheet::from_parameters(&vehicle).is_some(), is_car, "{}", preset.id());
        }
    }
}
