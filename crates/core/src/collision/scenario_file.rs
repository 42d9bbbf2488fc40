//! Reads scenario files (`SCENARIO.toml`), whose key names contain the units.
//!
//! ```toml
//! name = "rear-quarter push"
//!
//! [target]                    # and [bullet]
//! vehicle = "ford-explorer-2004"  # optional: gives mass, inertia, size and CG that are not given
//! mass_kg = 2000              # mass_lb, mass_slug, mass_t
//! yaw_inertia_kg_m2 = 3600    # yaw_inertia_slug_ft2
//! length_m = 4.8              # every length: _m, _mm, _ft, _in …
//! width_m = 1.85
//! cg_from_front_m = 2.3
//! speed_km_h = 54             # along the heading; or vx_… and vy_… in world axes; _m_s, _mph …
//! heading_deg = 0             # optional; heading_rad
//! # skid_length_m = 18        # optional: a skid up to the first contact; with skid_drag_factor, and
//! # skid_drag_factor = 0.7    # speed_before_skid_km_h instead of speed_km_h if that is what is known
//! yaw_rate_deg_s = 0          # optional; yaw_rate_rad_s
//! x_m = 0                     # optional here, part of the contact in [bullet]
//! y_m = 0
//!
//! # [bullet]                  # or an object that does not move, instead of all of these:
//! # fixed = "wall"            # length_m along heading_deg, 10; width_m, its thickness, 0.5
//! # fixed = "pole"            # diameter_m
//!
//! [contact]
//! from = "side"               # side and offset: the striking vehicle is placed so that it touches
//! side = "right"              # front, left, rear, right
//! offset_m = -1.5             # from the middle of that side
//! # from = "footprints"       # bullet.x_m and bullet.y_m say where it is
//! # from = "point"            # x_m, y_m, normal_deg in axes of the struck car; bullet.x_m, …
//! restitution = 0.15          # optional; without it that of the closing speed
//! restitution_form = "normal" # optional; or "common_velocity"
//! friction_limit = 0.4        # optional; or friction_of_critical, friction_of_critical_percent
//! friction_model = "limit"    # optional; or "paper"
//!
//! # [road]                    # optional: slope; grade along X, cross_slope along Y, or in _percent
//! # grade = 0.05              # positive uphill, and where the road rises to the left
//!
//! # [ending]                  # optional: wheels of the struck vehicle; see Ending::read
//! # [bullet_ending]           # optional: the same of the striking vehicle
//! ```
//!
//! Each quantity is given once, in any unit of
//! [`Quantity::units`](crate::units::Quantity::units). The key ends in the symbol of the unit, with
//! `_` for `/`, `·` and spaces, and with digits for powers.

use std::f64::consts::FRAC_PI_2;
use std::path::Path;

use crate::collision::{
    ContactLocation, FrictionModel, RestitutionForm, Scenario, ScenarioContact, ScenarioSkid,
    ScenarioVehicle, Side,
};
use crate::data::{TomlError, TomlFile, TomlTable};
use crate::ranges::{
    BODY_CG, BODY_LENGTH, BODY_MASS, BODY_WIDTH, BODY_YAW_INERTIA, CONTACT_COORDINATE,
    CONTACT_OFFSET, EVIDENCE_SPEED, FRICTION_LIMIT, FRICTION_OF_CRITICAL, HEADING, POSITION,
    RESTITUTION, ROAD_FRICTION, Range, SKID_LENGTH, SPEED, YAW_RATE,
};
use crate::vehicle::{
    Ending, FIXED_MASS_KG, FIXED_YAW_INERTIA_KG_M2, FixedObject, RoadSlope, VehicleParameters,
    built_in_vehicle,
};

/// Length and thickness of a wall where nobody says them, m.
const USUAL_WALL_M: [f64; 2] = [10.0, 0.5];

pub(super) const LOCATIONS: [&str; 3] = ["footprints", "side", "point"];
pub(super) const FRICTION_MODELS: [&str; 2] = ["limit", "paper"];

impl Scenario {
    /// Reads a scenario file and checks every key and every range.
    ///
    /// # Errors
    /// [`TomlError`] if the file cannot be read, is not valid TOML, or has a key that is missing,
    /// unknown, contradictory or out of range. Errors in the content name line and column.
    pub fn load(path: &Path) -> Result<Self, TomlError> {
        Self::from_toml(&TomlFile::read(path)?, path)
    }

    /// Reads a scenario from the text of a file. The `path` serves only to name the file in errors.
    ///
    /// # Errors
    /// The errors of [`Scenario::load`] except [`TomlError::File`].
    pub fn from_toml(text: &str, path: &Path) -> Result<Self, TomlError> {
        let file = TomlFile { path, text };
        let root = file.parse()?;
        let mut top = TomlTable::root(file, &root);
        let name = top.string("name")?.unwrap_or_default();
        let notes = top.string("notes")?.unwrap_or_default();
        let (mut struck, mut striking) = (top.table("target")?, top.table("bullet")?);
        let mut contact = top.table("contact")?;
        let ending = top.optional_table("ending")?.map(Ending::read).transpose()?;
        let striking_ending = top.optional_table("bullet_ending")?.map(Ending::read).transpose()?;
        let road = top.optional_table("road")?.map(RoadSlope::read).transpose()?;
        top.finish()?;
        let struck_x_world_m = position(&mut struck, "x")?.unwrap_or(0.0);
        let struck_y_world_m = position(&mut struck, "y")?.unwrap_or(0.0);
        let location = read_location(&mut contact, &mut striking)?;
        let (struck_vehicle, of_struck) = named_vehicle(&mut struck)?;
        let (striking_vehicle, of_striking) = named_vehicle(&mut striking)?;
        let fixed = striking.choice("fixed", FixedObject::WORDS)?;
        if fixed.is_some() && striking_vehicle.is_some() {
            return Err(striking.conflict("vehicle"));
        }
        let fixed = fixed.and_then(|idx| FixedObject::ALL.get(idx)).copied();
        let slope = road.unwrap_or_default();
        let struck = read_vehicle(struck, of_struck, &slope)?;
        Ok(Self {
            name,
            notes,
            struck_x_world_m,
            struck_y_world_m,
            striking: match fixed {
                Some(object) => read_fixed(striking, object, struck.heading_rad)?,
                None => read_vehicle(striking, of_striking, &slope)?,
            },
            struck,
            contact: read_contact(contact, location)?,
            ending,
            striking_ending,
            struck_vehicle,
            striking_vehicle,
            road,
        })
    }
}

/// The vehicle that a scenario names, and its parameters.
fn named_vehicle(
    section: &mut TomlTable<'_>,
) -> Result<(Option<String>, Option<VehicleParameters>), TomlError> {
    let Some(name) = section.string("vehicle")? else { return Ok((None, None)) };
    match built_in_vehicle(&name) {
        Some(vehicle) => Ok((Some(name), Some(vehicle))),
        None => Err(section.refuse_last("a vehicle that impactlab vehicles lists")),
    }
}

/// A number that the scenario gives, else that of the vehicle that it names.
fn number_or(
    section: &mut TomlTable<'_>,
    key: &str,
    range: &Range,
    of_vehicle: Option<f64>,
) -> Result<f64, TomlError> {
    match (section.number(key, range)?, of_vehicle) {
        (Some(value), _) | (None, Some(value)) => Ok(value),
        (None, None) => section.require(key, range),
    }
}

fn position(section: &mut TomlTable<'_>, base: &str) -> Result<Option<f64>, TomlError> {
    section.number(base, &POSITION)
}

fn read_vehicle(
    mut section: TomlTable<'_>,
    vehicle: Option<VehicleParameters>,
    slope: &RoadSlope,
) -> Result<ScenarioVehicle, TomlError> {
    let s = &mut section;
    let mass_kg =
        number_or(s, "mass", &BODY_MASS, vehicle.as_ref().map(|vehicle| vehicle.mass.mass_kg))?;
    // What was estimated from the mass follows the mass of the scenario.
    let vehicle = vehicle.map(|vehicle| vehicle.with_mass(mass_kg, None));
    let from_vehicle = |value: fn(&VehicleParameters) -> f64| vehicle.as_ref().map(value);
    let inertia = from_vehicle(|vehicle| vehicle.mass.yaw_inertia_kg_m2);
    let yaw_inertia_kg_m2 = number_or(s, "yaw_inertia", &BODY_YAW_INERTIA, inertia)?;
    let length_m = number_or(
        s,
        "length",
        &BODY_LENGTH,
        from_vehicle(|vehicle| vehicle.geometry.outer_length_m),
    )?;
    let width_m =
        number_or(s, "width", &BODY_WIDTH, from_vehicle(|vehicle| vehicle.geometry.outer_width_m))?;
    let cg_from_front =
        from_vehicle(|vehicle| vehicle.geometry.cg_to_front_end_m).map(|m| m.min(length_m));
    let cg_range = BODY_CG.at_most(length_m);
    let cg_from_front_m = number_or(s, "cg_from_front", &cg_range, cg_from_front)?;
    let heading = s.number("heading", &HEADING)?;
    let heading_rad = heading.unwrap_or(0.0);
    let yaw_rate_rad_s = s.number("yaw_rate", &YAW_RATE)?.unwrap_or(0.0);
    let skid = read_skid(s)?;
    let of_skid = skid.map(|skid| (skid, slope.along(heading_rad)));
    let [vx_world_m_s, vy_world_m_s] = read_velocity(s, heading_rad, of_skid)?;
    section.finish()?;
    Ok(ScenarioVehicle {
        mass_kg,
        yaw_inertia_kg_m2,
        length_m,
        width_m,
        cg_from_front_m,
        heading_rad,
        vx_world_m_s,
        vy_world_m_s,
        yaw_rate_rad_s,
        fixed: None,
        skid,
    })
}

fn read_skid(s: &mut TomlTable<'_>) -> Result<Option<ScenarioSkid>, TomlError> {
    let length_m = s.number("skid_length", &SKID_LENGTH)?;
    let drag_factor = s.number("skid_drag_factor", &ROAD_FRICTION)?;
    match (length_m, drag_factor) {
        (Some(length_m), Some(drag_factor)) => Ok(Some(ScenarioSkid { length_m, drag_factor })),
        (None, None) => Ok(None),
        (None, Some(_)) => Err(s.missing("skid_length_m")),
        (Some(_), None) => Err(s.missing("skid_drag_factor")),
    }
}

/// Velocity `[v_X, v_Y]` at first contact, m/s.
///
/// - `skid`: that ends there, with the grade along it.
fn read_velocity(
    s: &mut TomlTable<'_>,
    heading_rad: f64,
    skid: Option<(ScenarioSkid, f64)>,
) -> Result<[f64; 2], TomlError> {
    let mut speed = s.number("speed", &SPEED)?;
    let mut first = s.last_key();
    if let Some((skid, grade)) = skid
        && let Some(before) = s.number("speed_before_skid", &EVIDENCE_SPEED)?
    {
        if speed.is_some() {
            return Err(s.conflict(&first));
        }
        let after = skid.speed_after_m_s(before, grade);
        let expected = "a speed with which the vehicle does not stop within its skid";
        speed = Some(after.ok_or_else(|| s.refuse_last(expected))?);
        first = s.last_key();
    }
    let vx = s.number("vx", &SPEED)?;
    let vy = s.number("vy", &SPEED)?;
    match (speed, vx, vy) {
        (Some(speed), None, None) => Ok([speed * heading_rad.cos(), speed * heading_rad.sin()]),
        (None, Some(vx), Some(vy)) => Ok([vx, vy]),
        (Some(_), _, _) => Err(s.conflict(&first)),
        (None, None, None) => Err(s.missing("speed_m_s (or vx_m_s and vy_m_s)")),
        (None, None, _) => Err(s.missing("vx_m_s")),
        (None, _, None) => Err(s.missing("vy_m_s")),
    }
}

fn read_location(
    contact: &mut TomlTable<'_>,
    striking: &mut TomlTable<'_>,
) -> Result<ContactLocation, TomlError> {
    let mut striking_at = || -> Result<(f64, f64), TomlError> {
        let x_m = striking.require("x", &POSITION)?;
        Ok((x_m, striking.require("y", &POSITION)?))
    };
    match contact.choice("from", &LOCATIONS)?.ok_or_else(|| contact.missing("from"))? {
        0 => {
            let (striking_x_world_m, striking_y_world_m) = striking_at()?;
            Ok(ContactLocation::Footprints { striking_x_world_m, striking_y_world_m })
        }
        1 => {
            let names = Side::ALL.map(Side::name);
            let idx = contact.choice("side", &names)?;
            let side = idx.and_then(|idx| Side::ALL.get(idx).copied());
            Ok(ContactLocation::Side {
                side: side.ok_or_else(|| contact.missing("side"))?,
                offset_m: contact.require("offset", &CONTACT_OFFSET)?,
            })
        }
        _ => {
            let (striking_x_world_m, striking_y_world_m) = striking_at()?;
            Ok(ContactLocation::Point {
                x_body_m: contact.require("x", &CONTACT_COORDINATE)?,
                y_body_m: contact.require("y", &CONTACT_COORDINATE)?,
                normal_body_rad: contact.require("normal", &HEADING)?,
                striking_x_world_m,
                striking_y_world_m,
            })
        }
    }
}

/// An object that does not move.
///
/// - `struck_heading_rad`: by which a wall is turned where nobody says its heading, and a pole always.
fn read_fixed(
    mut section: TomlTable<'_>,
    object: FixedObject,
    struck_heading_rad: f64,
) -> Result<ScenarioVehicle, TomlError> {
    let s = &mut section;
    let heading_rad = s.number("heading", &HEADING)?;
    if object == FixedObject::Pole && heading_rad.is_some() {
        return Err(s.refuse_last("no heading, since a pole is round"));
    }
    let (length_m, width_m, usual_rad) = match object {
        FixedObject::Wall => (
            s.number("length", &BODY_LENGTH)?.unwrap_or(USUAL_WALL_M[0]),
            s.number("width", &BODY_WIDTH)?.unwrap_or(USUAL_WALL_M[1]),
            struck_heading_rad + FRAC_PI_2,
        ),
        FixedObject::Pole => {
            let diameter_m = s.require("diameter", &BODY_LENGTH.at_most(BODY_WIDTH.high))?;
            (diameter_m, diameter_m, struck_heading_rad)
        }
    };
    let heading_rad = heading_rad.unwrap_or(usual_rad);
    section.finish()?;
    Ok(ScenarioVehicle {
        mass_kg: FIXED_MASS_KG,
        yaw_inertia_kg_m2: FIXED_YAW_INERTIA_KG_M2,
        length_m,
        width_m,
        cg_from_front_m: length_m / 2.0,
        heading_rad,
        vx_world_m_s: 0.0,
        vy_world_m_s: 0.0,
        yaw_rate_rad_s: 0.0,
        fixed: Some(object),
        skid: None,
    })
}

fn read_contact(
    mut section: TomlTable<'_>,
    location: ContactLocation,
) -> Result<ScenarioContact, TomlError> {
    let s = &mut section;
    let restitution = s.number("restitution", &RESTITUTION)?;
    let forms = RestitutionForm::ALL.map(RestitutionForm::name);
    let form = s.choice("restitution_form", &forms)?;
    let friction_limit = s.number("friction_limit", &FRICTION_LIMIT)?;
    let limit_key = s.last_key();
    let friction_of_critical = s.number("friction_of_critical", &FRICTION_OF_CRITICAL)?;
    if friction_limit.is_some() && friction_of_critical.is_some() {
        return Err(s.conflict(&limit_key));
    }
    let friction_model = match s.choice("friction_model", &FRICTION_MODELS)? {
        Some(1) => FrictionModel::Paper,
        _ => FrictionModel::Limit,
    };
    section.finish()?;
    Ok(ScenarioContact {
        location,
        restitution,
        restitution_form: form
            .and_then(|idx| RestitutionForm::ALL.get(idx).copied())
            .unwrap_or_default(),
        friction_limit,
        friction_of_critical,
        friction_model,
    })
}

#[cfg(test)]
#[path = "scenario_file_tests.rs"]
mod tests;
