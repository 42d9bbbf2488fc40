//! Reads a vehicle file that is a data sheet. Its key names contain the units.
//!
//! ```toml
//! name = "my car"
//! source = "registration, axle scales"       # optional, as everything below
//!
//! [data_sheet]
//! class = "car"                    # car, suv, pickup, van; any if not given
//! drive = "front"                  # front, rear, all: tells where the weight is
//! mass_kg = 1450                   # mass_lb …; with all on board
//! length_m = 4.55                  # every length: _m, _mm, _ft, _in …
//! width_m = 1.78                   # without mirrors
//! wheelbase_m = 2.65
//! track_front_m = 1.53             # and track_rear_…; or track_… of both
//! front_share = 0.6                # front_share_percent; or cg_to_front_axle_…; or
//! # front_axle_load_kg = 870       # front_axle_load_… and rear_axle_load_…, then without mass_…
//! cg_height_m = 0.55               # or static_stability_factor
//! yaw_inertia_kg_m2 = 2400         # yaw_inertia_slug_ft2
//! roll_inertia_kg_m2 = 500         # of the whole car, about its CG
//! roll_gradient_deg_per_g = 5      # or roll_stiffness_n_m_rad
//! tire_size = "205/55R16"          # or wheel_radius_m
//! friction = 0.75                  # peak friction of the road
//! ```
//!
//! and `front_overhang_…`, `roll_yaw_product_kg_m2`, `sprung_mass_…`, `wheel_inertia_kg_m2`,
//! `roll_axis_height_…`, `roll_damping_ratio` or `roll_damping_n_m_s_rad`,
//! `front_roll_stiffness_share`, `cornering_coefficient_front_per_rad`,
//! `cornering_coefficient_rear_per_rad`, `sliding_friction_ratio`, `rolling_resistance`,
//! `drag_area_m2`.
//! The section `[crush]` beside it says how stiff faces are (`vehicle/crush.rs`).
//! A sheet has at least the class, or mass, length and width.

use crate::data::{TomlError, TomlFile, TomlTable};
use crate::ranges::{
    CG_TO_AXLE, ROLL_DAMPING, ROLL_STIFFNESS, STATIC_STABILITY_FACTOR, TRACK_WIDTH, VEHICLE_MASS,
};
use crate::units::INCH_M;
use crate::vehicle::sheet::{DataSheet, SheetQuantity as Q, VehicleClass};
use crate::vehicle::{CrushParameters, DrivenAxle, Equations};

const EQUATIONS: [&str; 2] = ["corrected", "paper"];

impl DataSheet {
    /// Reads a data sheet. Whether its values go together is not checked.
    ///
    /// # Errors
    /// [`TomlError`] if the text is not TOML, or has a key that is missing, unknown, contradictory or
    /// out of range.
    pub fn from_toml(file: TomlFile<'_>) -> Result<Self, TomlError> {
        let root = file.parse()?;
        let mut top = TomlTable::root(file, &root);
        let name = top.string("name")?;
        let source = top.string("source")?;
        let equations = top.choice("equations", &EQUATIONS)?;
        let crush = CrushParameters::read(top.optional_table("crush")?)?;
        let mut table = top.table("data_sheet")?;
        top.finish()?;
        let class = table.choice("class", &VehicleClass::WORDS)?;
        let drive = table.choice("drive", DrivenAxle::WORDS)?;
        let mut sheet = Self {
            name: name.unwrap_or_else(|| file.name()),
            source: source.unwrap_or_default(),
            equations: if equations == Some(1) { Equations::Paper } else { Equations::Corrected },
            class: class.map_or(VehicleClass::Any, |idx| VehicleClass::ALL[idx]),
            drive: drive.map(|idx| DrivenAxle::ALL[idx]),
            crush,
            ..Self::default()
        };
        sheet.read_quantities(&mut table)?;
        sheet.read_others(&mut table)?;
        if class.is_none() {
            for quantity in [Q::Mass, Q::Length, Q::Width] {
                if sheet.known(quantity).is_none() {
                    return Err(table.missing(&format!(
                        "{}_{} (or class)",
                        quantity.key(),
                        quantity.unit()
                    )));
                }
            }
        }
        table.finish()?;
        Ok(sheet)
    }

    /// Reads the quantities under their own keys.
    fn read_quantities(&mut self, table: &mut TomlTable<'_>) -> Result<(), TomlError> {
        for &quantity in Q::ALL {
            let range = quantity.range();
            let value = match quantity.has_units() {
                true => table.number(quantity.key(), &range)?,
                false => table.plain(quantity.key(), &range)?,
            };
            value.into_iter().for_each(|value| self.set(quantity, value));
        }
        Ok(())
    }

    /// Reads what stands for a quantity under another key; each is said once.
    fn read_others(&mut self, table: &mut TomlTable<'_>) -> Result<(), TomlError> {
        self.read_axle_loads(table)?;
        if let Some(front_m) = table.number("cg_to_front_axle", &CG_TO_AXLE)? {
            self.refuse_second(table, Q::FrontShare)?;
            let Some(wheelbase_m) = self.known(Q::Wheelbase) else {
                return Err(table.missing("wheelbase_m"));
            };
            let share = 1.0 - front_m / wheelbase_m;
            if !Q::FrontShare.range().contains(share) {
                return Err(table.refuse_last("0.15 to 0.8 of the wheelbase"));
            }
            self.set(Q::FrontShare, share);
        }
        let front = table.number("track_front", &TRACK_WIDTH)?;
        let rear = table.number("track_rear", &TRACK_WIDTH)?;
        let tracks: Vec<f64> = front.into_iter().chain(rear).collect();
        if !tracks.is_empty() {
            self.refuse_second(table, Q::Track)?;
            self.set(Q::Track, tracks.iter().sum::<f64>() / tracks.len() as f64);
        }
        if let Some(size) = table.string("tire_size")? {
            self.refuse_second(table, Q::WheelRadius)?;
            let radius_m = tire_radius_m(&size).filter(|&m| Q::WheelRadius.range().contains(m));
            let expected = "a size such as \"205/55R16\"";
            self.set(Q::WheelRadius, radius_m.ok_or_else(|| table.refuse_last(expected))?);
        }
        // As files of earlier versions have it.
        if let Some(inertia_kg_m2) = table.plain("wheel_inertia", &Q::WheelInertia.range())? {
            self.refuse_second(table, Q::WheelInertia)?;
            self.set(Q::WheelInertia, inertia_kg_m2);
        }
        if let Some(factor) = table.number("static_stability_factor", &STATIC_STABILITY_FACTOR)? {
            self.refuse_second(table, Q::CgHeight)?;
            let Some(track_m) = self.known(Q::Track) else { return Err(table.missing("track_m")) };
            self.set(Q::CgHeight, track_m / 2.0 / factor);
        }
        self.roll_stiffness_n_m_rad = table.plain("roll_stiffness_n_m_rad", &ROLL_STIFFNESS)?;
        if self.roll_stiffness_n_m_rad.is_some() {
            self.refuse_second(table, Q::RollGradient)?;
        }
        self.roll_damping_n_m_s_rad = table.plain("roll_damping_n_m_s_rad", &ROLL_DAMPING)?;
        if self.roll_damping_n_m_s_rad.is_some() {
            self.refuse_second(table, Q::RollDampingRatio)?;
        }
        Ok(())
    }

    fn read_axle_loads(&mut self, table: &mut TomlTable<'_>) -> Result<(), TomlError> {
        let front = table.number("front_axle_load", &VEHICLE_MASS)?;
        if front.is_some() {
            self.refuse_second(table, Q::FrontShare)?;
        }
        let rear = table.number("rear_axle_load", &VEHICLE_MASS)?;
        match (front, rear, self.known(Q::Mass)) {
            (None, None, _) => Ok(()),
            (Some(front), Some(rear), None) => {
                self.set(Q::Mass, front + rear);
                self.set_front_share(table, front / (front + rear))
            }
            (Some(_), Some(_), Some(_)) => Err(table.conflict("mass")),
            (Some(front), None, Some(mass)) => self.set_front_share(table, front / mass),
            (None, Some(rear), Some(mass)) => self.set_front_share(table, 1.0 - rear / mass),
            (Some(_), None, None) => Err(table.missing("rear_axle_load_kg")),
            (None, Some(_), None) => Err(table.missing("front_axle_load_kg")),
        }
    }

    fn set_front_share(&mut self, table: &TomlTable<'_>, share: f64) -> Result<(), TomlError> {
        let range = Q::FrontShare.range();
        if !range.contains(share) {
            let expected = format!(
                "axle loads with {} of the mass on the front axle; now it is {share:.3}",
                range.expected_si()
            );
            return Err(table.refuse_last(&expected));
        }
        self.set(Q::FrontShare, share);
        Ok(())
    }

    fn refuse_second(&self, table: &TomlTable<'_>, quantity: Q) -> Result<(), TomlError> {
        match self.known(quantity) {
            Some(_) => Err(table.conflict(quantity.key())),
            None => Ok(()),
        }
    }

    /// The key of a sheet from which a parameter of the 4DOF vehicle follows, or the one of several
    /// that a wrong value most likely comes from.
    pub(in crate::vehicle) fn origin(parameter: &str) -> Option<&'static str> {
        Some(match parameter {
            "mass.mass_kg" => "data_sheet.mass_kg",
            "mass.sprung_mass_kg" => "data_sheet.sprung_mass_kg",
            "mass.yaw_inertia_kg_m2" => "data_sheet.yaw_inertia_kg_m2",
            "mass.roll_inertia_kg_m2" => "data_sheet.roll_inertia_kg_m2",
            "mass.roll_yaw_product_kg_m2" => "data_sheet.roll_yaw_product_kg_m2",
            "geometry.cg_to_front_axle_m" | "geometry.cg_to_rear_axle_m" => {
                "data_sheet.wheelbase_m"
            }
            "geometry.track_width_m" => "data_sheet.track_m",
            "geometry.cg_height_m" | "suspension.roll_arm_m" => "data_sheet.cg_height_m",
            "geometry.cg_to_front_end_m" | "geometry.outer_length_m" => "data_sheet.length_m",
            "geometry.outer_width_m" => "data_sheet.width_m",
            "suspension.roll_stiffness_n_m_rad" => "data_sheet.roll_stiffness_n_m_rad",
            "suspension.roll_damping_n_m_s_rad" => "data_sheet.roll_damping_n_m_s_rad",
            _ => return None,
        })
    }
}

/// Rolling radius of a tire by its size, m; `None` if the text is no size.
///
/// A loaded tire rolls on 0.97 of its free radius.
fn tire_radius_m(size: &str) -> Option<f64> {
    let size = size.trim_start_matches(|c: char| c.is_ascii_alphabetic());
    let (width, rest) = size.split_once('/')?;
    let at = rest.find(|c: char| !c.is_ascii_digit())?;
    let (aspect, rest) = rest.split_at(at);
    let rim = rest.trim_start_matches(|c: char| !c.is_ascii_digit());
    let rim: String = rim.chars().take_while(|c| c.is_ascii_digit() || *c == '.').collect();
    let (width, aspect, rim): (f64, f64, f64) =
        (width.trim().parse().ok()?, aspect.parse().ok()?, rim.parse().ok()?);
    Some(0.97 * (rim * INCH_M / 2.0 + width * 1e-3 * aspect / 100.0))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::vehicle::VehicleParameters;

    fn read(sheet: &str) -> Result<VehicleParameters, String> {
        let text = format!("name = \"car\"\n\n[data_sheet]\n{sheet}\n");
        VehicleParameters::parse(&text, Path::new("car.toml")).map_err(|error| error.to_string())
    }

    /// The home folder stood in reports, and in networks that had learned from the car.
    #[test]
    fn a_vehicle_without_a_name_is_called_by_its_file_and_not_by_its_path() {
        let path = Path::new("/home/ann/cars/own.toml");
        let text = "[data_sheet]\nclass = \"car\"\n";
        assert_eq!(VehicleParameters::parse(text, path).unwrap().name, "own.toml");
    }

    #[test]
    fn us_units_give_the_same_vehicle() {
        let si = "class = \"car\"\nmass_kg = 1360.77711\nlength_m = 4.572\nwidth_mm = 1778\n\
                  wheelbase_m = 2.667\nfront_share = 0.6";
        let us = "class = \"car\"\nmass_lb = 3000\nlength_in = 180\nwidth_in = 70\n\
                  wheelbase_ft = 8.75\nfront_share_percent = 60";
        let (si, us) = (read(si).unwrap(), read(us).unwrap());
        assert!((si.mass.yaw_inertia_kg_m2 / us.mass.yaw_inertia_kg_m2 - 1.0).abs() < 1e-9);
        assert!((si.geometry.cg_to_front_end_m - us.geometry.cg_to_front_end_m).abs() < 1e-9);
    }

    #[test]
    fn the_same_thing_may_be_said_in_several_ways() {
        let size = "length_m = 4.5\nwidth_m = 1.8\nwheelbase_m = 2.7\n";
        let loads =
            read(&format!("{size}front_axle_load_kg = 900\nrear_axle_load_kg = 600")).unwrap();
        let share = read(&format!("{size}mass_kg = 1500\nfront_share = 0.6")).unwrap();
        let distance = read(&format!("{size}mass_kg = 1500\ncg_to_front_axle_m = 1.08")).unwrap();
        for other in [&share, &distance] {
            let difference = loads.geometry.cg_to_front_axle_m - other.geometry.cg_to_front_axle_m;
            assert!(difference.abs() < 1e-9, "{other:?}");
            assert_eq!(loads.mass.mass_kg, other.mass.mass_kg);
        }
        let factor = format!("{size}mass_kg = 1500\ntrack_front_in = 60\ntrack_rear_in = 60\n");
        let factor = read(&format!("{factor}static_stability_factor = 1.25")).unwrap();
        assert!((factor.geometry.cg_height_m - 60.0 * 0.0254 / 2.5).abs() < 1e-12);
        let roll = read(&format!("{size}mass_kg = 1500\nroll_stiffness_n_m_rad = 70000")).unwrap();
        assert_eq!(roll.suspension.roll_stiffness_n_m_rad, 70_000.0);
        assert!(!roll.estimates.contains_key("suspension.roll_stiffness_n_m_rad"));
        assert!((tire_radius_m("205/55R16").unwrap() - 0.3064).abs() < 1e-3);
        assert_eq!(tire_radius_m("P205/55 R16 91V"), tire_radius_m("205/55R16"));
    }

    #[test]
    fn the_key_of_the_inertia_of_a_wheel_has_its_unit() {
        let size = "mass_kg = 1500\nlength_m = 4.5\nwidth_m = 1.8\n";
        let vehicle = read(&format!("{size}wheel_inertia_kg_m2 = 1.1")).unwrap();
        assert_eq!(vehicle.tires.wheel_inertia_kg_m2, 1.1);
        assert!(!vehicle.estimates.contains_key("tires.wheel_inertia_kg_m2"));
        let written = DataSheet::from_parameters(&vehicle).unwrap().to_toml();
        assert!(written.contains("\nwheel_inertia_kg_m2 = 1.1\n"), "{written}");
        let earlier = read(&format!("{size}wheel_inertia = 1.1")).unwrap();
        assert_eq!(earlier.tires, vehicle.tires);
    }

    #[test]
    fn a_refusal_names_file_line_key_and_what_is_expected() {
        let size = "mass_kg = 1500\nlength_m = 4.5\nwidth_m = 1.8\n";
        for (sheet, expected) in [
            ("mass_lb = 3000", "3:2: data_sheet.length_m (or class) is missing"),
            (
                "class = \"lorry\"",
                "4:9: data_sheet.class is \"lorry\", expected \"any\" or \"car\"",
            ),
            (
                &format!("{size}wheelbase_in = 1"),
                "7:16: data_sheet.wheelbase_in is 1, expected 3.93",
            ),
            (&format!("{size}height_m = 1.5"), "7:1: data_sheet.height_m is not known here"),
            (
                &format!("{size}front_axle_load_kg = 1450"),
                "7:22: data_sheet.front_axle_load_kg is 1450, expected axle loads with 0.2 to 0.85 of \
                 the mass on the front axle; now it is 0.967",
            ),
            (&format!("{size}tire_size = \"round\""), "7:13: data_sheet.tire_size is \"round\""),
            (&format!("{size}front_axle_load_kg = 900\nrear_axle_load_kg = 600"), "8:1: "),
            (&format!("{size}roll_gradient_deg_per_g = 99"), "7:27: "),
            (
                &format!("{size}track_m = 1.5\ntrack_rear_m = 1.5"),
                "8:1: data_sheet.track_rear_m and track",
            ),
            // Known values that do not go together are found in the sheet.
            (&format!("{size}sprung_mass_kg = 1800"), "7:18: data_sheet.sprung_mass_kg is 1800"),
            (
                &format!("{size}roll_stiffness_n_m_rad = 900"),
                "7:26: data_sheet.roll_stiffness_n_m_rad",
            ),
            (&format!("{size}roll_yaw_product_kg_m2 = 1600"), "7:26: data_sheet.roll_yaw_product"),
            (
                &format!("{size}cg_height_m = 0.2\nroll_axis_height_m = 0.5"),
                "7:15: data_sheet.cg_height_m",
            ),
        ] {
            let error = read(sheet).unwrap_err();
            assert!(error.starts_with(&format!("car.toml:{expected}")), "{error}\n{expected}");
        }
    }
}
