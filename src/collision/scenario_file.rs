//! Reads scenario files (`SCENARIO.toml`), whose key names contain the units.
//!
//! ```toml
//! name = "rear-quarter push"
//!
//! [target]                    # and [bullet]
//! mass_kg = 2000              # mass_lb, mass_slug, mass_t
//! yaw_inertia_kg_m2 = 3600    # yaw_inertia_slug_ft2
//! length_m = 4.8              # every length: _m, _mm, _ft, _in …
//! width_m = 1.85
//! cg_from_front_m = 2.3
//! speed_km_h = 54             # along the heading; or vx_… and vy_… in world axes; _m_s, _mph …
//! heading_deg = 0             # optional; heading_rad
//! yaw_rate_deg_s = 0          # optional; yaw_rate_rad_s
//! x_m = 0                     # optional for the target, part of the contact for the bullet
//! y_m = 0
//!
//! [contact]
//! from = "side"               # side and offset: the bullet is placed so that it touches
//! side = "right"              # front, left, rear, right
//! offset_m = -1.5             # from the middle of that side
//! # from = "footprints"       # bullet.x_m and bullet.y_m say where the bullet is
//! # from = "point"            # x_m, y_m, normal_deg in the target's axes; bullet.x_m, bullet.y_m
//! restitution = 0.15          # optional
//! friction_limit = 0.4        # optional
//! friction_model = "limit"    # optional; or "paper"
//!
//! # [ending]                  # optional: what happens to the target's wheels; see Ending::read
//! ```
//!
//! Each quantity is given once, in any unit of
//! [`Quantity::units`](crate::units::Quantity::units). The key ends in the symbol of the unit, with
//! `_` for `/`, `·` and spaces, and with digits for powers.

use std::path::Path;

use crate::collision::{
    ContactLocation, DEFAULT_FRICTION_LIMIT, DEFAULT_RESTITUTION, FrictionModel, Scenario,
    ScenarioContact, ScenarioVehicle, Side,
};
use crate::data::{TomlError, TomlFile, TomlTable};
use crate::ranges::{
    BODY_CG, BODY_LENGTH, BODY_MASS, BODY_WIDTH, BODY_YAW_INERTIA, CONTACT_COORDINATE,
    CONTACT_OFFSET, FRICTION_LIMIT, HEADING, POSITION, RESTITUTION, SPEED, YAW_RATE,
};
use crate::vehicle::Ending;

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
        let (mut target, mut bullet) = (top.table("target")?, top.table("bullet")?);
        let mut contact = top.table("contact")?;
        let ending = top.optional_table("ending")?.map(Ending::read).transpose()?;
        top.finish()?;
        let target_x_m = position(&mut target, "x")?.unwrap_or(0.0);
        let target_y_m = position(&mut target, "y")?.unwrap_or(0.0);
        let location = read_location(&mut contact, &mut bullet)?;
        Ok(Self {
            name,
            notes,
            target_x_m,
            target_y_m,
            target: read_vehicle(target)?,
            bullet: read_vehicle(bullet)?,
            contact: read_contact(contact, location)?,
            ending,
        })
    }
}

fn position(section: &mut TomlTable<'_>, base: &str) -> Result<Option<f64>, TomlError> {
    section.number(base, &POSITION)
}

fn read_vehicle(mut section: TomlTable<'_>) -> Result<ScenarioVehicle, TomlError> {
    let s = &mut section;
    let mass_kg = s.require("mass", &BODY_MASS)?;
    let yaw_inertia_kg_m2 = s.require("yaw_inertia", &BODY_YAW_INERTIA)?;
    let length_m = s.require("length", &BODY_LENGTH)?;
    let width_m = s.require("width", &BODY_WIDTH)?;
    let cg_from_front_m = s.require("cg_from_front", &BODY_CG.at_most(length_m))?;
    let heading = s.number("heading", &HEADING)?;
    let heading_rad = heading.unwrap_or(0.0);
    let yaw_rate_rad_s = s.number("yaw_rate", &YAW_RATE)?.unwrap_or(0.0);
    let speed = s.number("speed", &SPEED)?;
    let first = s.last_key();
    let vx = s.number("vx", &SPEED)?;
    let vy = s.number("vy", &SPEED)?;
    let [vx_m_s, vy_m_s] = match (speed, vx, vy) {
        (Some(speed), None, None) => [speed * heading_rad.cos(), speed * heading_rad.sin()],
        (None, Some(vx), Some(vy)) => [vx, vy],
        (Some(_), _, _) => return Err(s.conflict(&first)),
        (None, None, None) => return Err(s.missing("speed_m_s (or vx_m_s and vy_m_s)")),
        (None, None, _) => return Err(s.missing("vx_m_s")),
        (None, _, None) => return Err(s.missing("vy_m_s")),
    };
    section.finish()?;
    Ok(ScenarioVehicle {
        mass_kg,
        yaw_inertia_kg_m2,
        length_m,
        width_m,
        cg_from_front_m,
        heading_rad,
        vx_m_s,
        vy_m_s,
        yaw_rate_rad_s,
    })
}

fn read_location(
    contact: &mut TomlTable<'_>,
    bullet: &mut TomlTable<'_>,
) -> Result<ContactLocation, TomlError> {
    let mut bullet_at = || -> Result<(f64, f64), TomlError> {
        let x_m = bullet.require("x", &POSITION)?;
        Ok((x_m, bullet.require("y", &POSITION)?))
    };
    match contact.choice("from", &LOCATIONS)?.ok_or_else(|| contact.missing("from"))? {
        0 => {
            let (bullet_x_m, bullet_y_m) = bullet_at()?;
            Ok(ContactLocation::Footprints { bullet_x_m, bullet_y_m })
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
            let (bullet_x_m, bullet_y_m) = bullet_at()?;
            Ok(ContactLocation::Point {
                x_m: contact.require("x", &CONTACT_COORDINATE)?,
                y_m: contact.require("y", &CONTACT_COORDINATE)?,
                normal_rad: contact.require("normal", &HEADING)?,
                bullet_x_m,
                bullet_y_m,
            })
        }
    }
}

fn read_contact(
    mut section: TomlTable<'_>,
    location: ContactLocation,
) -> Result<ScenarioContact, TomlError> {
    let s = &mut section;
    let restitution = s.number("restitution", &RESTITUTION)?;
    let friction_limit = s.number("friction_limit", &FRICTION_LIMIT)?;
    let friction_model = match s.choice("friction_model", &FRICTION_MODELS)? {
        Some(1) => FrictionModel::Paper,
        _ => FrictionModel::Limit,
    };
    section.finish()?;
    Ok(ScenarioContact {
        location,
        restitution: restitution.unwrap_or(DEFAULT_RESTITUTION),
        friction_limit: friction_limit.unwrap_or(DEFAULT_FRICTION_LIMIT),
        friction_model,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const PIT: &str = include_str!("../../assets/scenarios/pit_right_rear.toml");

    fn read(text: &str) -> Result<Scenario, TomlError> {
        Scenario::from_toml(text, Path::new("scenario.toml"))
    }

    /// The error message for the shipped scenario with one line replaced.
    fn refusal(line: &str, instead: &str) -> String {
        assert!(PIT.contains(line), "{line}");
        read(&PIT.replacen(line, instead, 1)).unwrap_err().to_string()
    }

    #[test]
    fn units_are_in_the_keys() {
        let pit = read(PIT).unwrap();
        assert!((pit.target.vx_m_s - 15.0).abs() < 1e-12, "{pit:?}");
        assert!((pit.bullet.heading_rad - 18_f64.to_radians()).abs() < 1e-15, "{pit:?}");
        let speed = pit.bullet.vx_m_s.hypot(pit.bullet.vy_m_s);
        assert!((speed * 3.6 - 62.0).abs() < 1e-9, "{pit:?}");
        for (key, value) in [
            ("speed_m_s", "15"),
            ("speed_mph", "33.554044380816"),
            ("vy_m_s = 0\nvx_km_h", "54.0"),
            ("speed_m_s", "0xF"),
        ] {
            let text = PIT.replacen("speed_km_h = 54", &format!("{key} = {value}"), 1);
            let other = read(&text).unwrap();
            assert!((other.target.vx_m_s - 15.0).abs() < 1e-9, "{key}: {other:?}");
        }
    }

    #[test]
    fn a_refusal_names_file_place_key_value_and_range() {
        for (line, instead, expected) in [
            ("mass_kg = 2000", "mass_kg = -3", "7:11: target.mass_kg is -3, expected 1 to 1e8 kg"),
            (
                "speed_km_h = 54",
                "speed_mph = 1e3",
                "13:13: target.speed_mph is 1e3, expected -335.540444 to 335.540444 mph",
            ),
            (
                "cg_from_front_m = 2.35",
                "cg_from_front_m = 5.0",
                "11:19: target.cg_from_front_m is 5.0, expected 0 to 4.9 m",
            ),
            (
                "width_m = 1.85",
                "width_m = nan",
                "10:11: target.width_m is nan, expected 0.05 to 20 m",
            ),
            (
                "width_m = 1.85",
                "width_m = \"wide\"",
                "10:11: target.width_m is \"wide\", expected 0.05 to 20 m",
            ),
            ("length_m", "lenght_m", "6:2: target.length_m is missing"),
            ("heading_deg", "haeding_deg", "12:1: target.haeding_deg is not known here"),
            (
                "speed_km_h = 54",
                "speed_km_h = 54\nspeed_m_s = 15",
                "13:1: target.speed_km_h and speed_m_s say the same thing, expected one",
            ),
            (
                "speed_km_h = 54",
                "speed_km_h = 54\nvx_m_s = 15",
                "14:1: target.vx_m_s and speed_km_h say the same thing, expected one",
            ),
            ("speed_km_h = 54", "vx_m_s = 15", "6:2: target.vy_m_s is missing"),
            ("[contact]", "[kontact]", "1:1: [contact] is missing"),
            (
                "side = \"right\"",
                "side = \"starboard\"",
                "26:8: contact.side is \"starboard\", expected \"front\" or \"left\" or \"rear\" or \
                 \"right\"",
            ),
            ("mass_kg = 2000", "mass_kg = ", "7:11: "),
        ] {
            let error = refusal(line, instead);
            let expected = format!("scenario.toml:{expected}");
            assert!(error.starts_with(&expected), "{error}\n{expected}");
        }
    }

    #[test]
    fn a_file_that_is_not_there_is_named() {
        let error = Scenario::load(Path::new("no/such/scenario.toml")).unwrap_err();
        assert_eq!(error.to_string(), "no/such/scenario.toml: does not exist; check the name");
    }
}
