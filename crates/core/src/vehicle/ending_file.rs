//! The section `[ending]` of a scenario file, whose key names contain the units.
//!
//! ```toml
//! [ending]                        # without it, the vehicle coasts
//! brake_start_s = 0.7             # the driver brakes; times are after the first contact
//! brake_share = 0.8               # of what the road can hold; more than 1 locks all wheels
//! brake_rise_s = 0.3              # optional
//! engine_braking_m_s2 = 0.5       # optional; engine_braking_g
//! driven_axle = "front"           # optional; "rear", "all"
//! drive_torque_n_m = 800          # optional; at the wheels of each driven axle together
//! drive_axle = "rear"             # optional; without it, the driven_axle
//! drive_start_s = 0.5             # optional
//! drive_rise_s = 0.3              # optional
//! rear_left = "locked"            # optional, for each wheel; "dragged" with the next key
//! rear_left_share = 0.5           # of what the road can hold at the static load of the wheel
//! rear_left_start_s = 0           # optional
//! steer_deg = 3                   # the front road wheels turn to the left; steer_rad. Or:
//! # steering_wheel_deg = 48       # angle of the steering wheel, with its ratio
//! # steering_ratio = 16
//! steer_start_s = 0               # optional
//! steer_rise_s = 0.3              # optional
//! ```
//!
//! Drivers who react to the motion, stability control and anti-lock system: see `drivers/file.rs`.

use strum::VariantNames;

use crate::data::{TomlError, TomlTable};
use crate::ranges::{
    BRAKE_RISE, BRAKE_SHARE, CONTROL_TIME, DRAG_SHARE, DRIVE_TORQUE, ENGINE_BRAKING, STEER_ANGLE,
    STEERING_RATIO, STEERING_WHEEL_ANGLE,
};
use crate::vehicle::drivers;
use crate::vehicle::{
    Braking, DEFAULT_BRAKE_RISE_S, DamagedWheel, DrivenAxle, Driving, Ending, EngineBraking,
    HeldSteer, Wheel,
};

const CONDITIONS: [&str; 2] = ["dragged", "locked"];

impl Ending {
    /// Reads a section `[ending]`.
    ///
    /// # Errors
    /// [`TomlError`] if a key is missing, unknown, contradictory or out of range.
    pub fn read(mut section: TomlTable<'_>) -> Result<Self, TomlError> {
        let brake = read_brake(&mut section)?;
        let (engine, drive) = read_engine(&mut section)?;
        let mut damage = Vec::new();
        for wheel in Wheel::ALL {
            damage.extend(read_wheel(&mut section, wheel)?);
        }
        let steer = read_steer(&mut section)?;
        let esc = drivers::read_esc(&mut section)?;
        let countersteer = drivers::read_countersteer(&mut section)?;
        let pit = drivers::read_pit(&mut section)?;
        if pit.is_some() && steer.is_some() {
            return Err(section.conflict("steer"));
        }
        section.finish()?;
        Ok(Self { brake, engine, drive, damage, steer, esc, countersteer, pit })
    }

    /// The keys and values of a section from which [`Ending::read`] reads the same ending.
    pub fn entries(&self) -> Vec<(String, toml::Value)> {
        let mut entries: Vec<(String, toml::Value)> = Vec::new();
        let mut add = |key: String, value: toml::Value| entries.push((key, value));
        if let Some(brake) = &self.brake {
            add("brake_start_s".to_owned(), brake.start_s.into());
            add("brake_share".to_owned(), brake.share_of_friction.into());
            add("brake_rise_s".to_owned(), brake.rise_s.into());
        }
        if let Some(engine) = &self.engine {
            add("engine_braking_m_s2".to_owned(), engine.deceleration_m_s2.into());
            add("driven_axle".to_owned(), engine.axle.word().into());
        }
        if let Some(drive) = &self.drive {
            add("drive_torque_n_m".to_owned(), drive.torque_n_m.into());
            add("drive_axle".to_owned(), drive.axle.word().into());
            add("drive_start_s".to_owned(), drive.start_s.into());
            add("drive_rise_s".to_owned(), drive.rise_s.into());
        }
        for damaged in &self.damage {
            let name = key_of(damaged.wheel);
            let condition = CONDITIONS[usize::from(damaged.drag_share_of_friction.is_none())];
            add(name.clone(), condition.into());
            if let Some(share) = damaged.drag_share_of_friction {
                add(format!("{name}_share"), share.into());
            }
            add(format!("{name}_start_s"), damaged.start_s.into());
        }
        if let Some(steer) = &self.steer {
            add("steer_rad".to_owned(), steer.road_wheel_rad.into());
            add("steer_start_s".to_owned(), steer.start_s.into());
            add("steer_rise_s".to_owned(), steer.rise_s.into());
        }
        entries.extend(drivers::entries(self));
        entries
    }
}

/// The key of a wheel.
fn key_of(wheel: Wheel) -> String {
    wheel.label().replace(' ', "_")
}

fn read_brake(section: &mut TomlTable<'_>) -> Result<Option<Braking>, TomlError> {
    let start_s = section.number("brake_start", &CONTROL_TIME)?;
    let share = section.number("brake_share", &BRAKE_SHARE)?;
    let rise_s = section.number("brake_rise", &BRAKE_RISE)?;
    let abs = drivers::read_abs(section)?;
    match (start_s, share) {
        (Some(start_s), Some(share_of_friction)) => {
            let rise_s = rise_s.unwrap_or(DEFAULT_BRAKE_RISE_S);
            Ok(Some(Braking { abs, ..Braking::new(start_s, share_of_friction, rise_s) }))
        }
        (None, None) if rise_s.is_none() && abs.is_none() => Ok(None),
        (None, _) => Err(section.missing("brake_start_s")),
        (_, None) => Err(section.missing("brake_share")),
    }
}

fn read_engine(
    section: &mut TomlTable<'_>,
) -> Result<(Option<EngineBraking>, Option<Driving>), TomlError> {
    let deceleration = section.number("engine_braking", &ENGINE_BRAKING)?;
    let torque = section.number("drive_torque", &DRIVE_TORQUE)?;
    let start_s = section.number("drive_start", &CONTROL_TIME)?;
    let rise_s = section.number("drive_rise", &BRAKE_RISE)?;
    let mut axle = |key| -> Result<Option<DrivenAxle>, TomlError> {
        let chosen = section.choice(key, DrivenAxle::VARIANTS)?;
        Ok(chosen.and_then(|idx| DrivenAxle::ALL.get(idx)).copied())
    };
    let (axle, drive_axle) = (axle("driven_axle")?, axle("drive_axle")?);
    match (deceleration, torque) {
        (None, None) if axle.is_some() => {
            return Err(section.missing("engine_braking_m_s2 (or drive_torque_n_m)"));
        }
        (_, None) if start_s.is_some() || rise_s.is_some() || drive_axle.is_some() => {
            return Err(section.missing("drive_torque_n_m"));
        }
        _ => {}
    }
    let axle = axle.unwrap_or_default();
    let engine = deceleration.map(|deceleration_m_s2| EngineBraking { deceleration_m_s2, axle });
    let drive = torque.map(|torque_n_m| Driving {
        torque_n_m,
        axle: drive_axle.unwrap_or(axle),
        start_s: start_s.unwrap_or(0.0),
        rise_s: rise_s.unwrap_or(DEFAULT_BRAKE_RISE_S),
    });
    Ok((engine, drive))
}

fn read_wheel(
    section: &mut TomlTable<'_>,
    wheel: Wheel,
) -> Result<Option<DamagedWheel>, TomlError> {
    let name = &key_of(wheel);
    let condition = section.choice(name, &CONDITIONS)?;
    let share = section.number(&format!("{name}_share"), &DRAG_SHARE)?;
    let start_s = section.number(&format!("{name}_start"), &CONTROL_TIME)?;
    let is_dragged = match (condition, share) {
        (None, None) if start_s.is_none() => return Ok(None),
        (None, _) => return Err(section.missing(name)),
        (Some(0), None) => return Err(section.missing(&format!("{name}_share"))),
        (Some(0), Some(_)) => true,
        (Some(_), Some(_)) => return Err(section.conflict(name)),
        (Some(_), None) => false,
    };
    Ok(Some(DamagedWheel {
        wheel,
        start_s: start_s.unwrap_or(0.0),
        drag_share_of_friction: share.filter(|_| is_dragged),
    }))
}

fn read_steer(section: &mut TomlTable<'_>) -> Result<Option<HeldSteer>, TomlError> {
    let road_wheel = section.number("steer", &STEER_ANGLE)?;
    let first = section.last_key();
    let start_s = section.number("steer_start", &CONTROL_TIME)?;
    let rise_s = section.number("steer_rise", &BRAKE_RISE)?;
    let steering_wheel = section.number("steering_wheel", &STEERING_WHEEL_ANGLE)?;
    let ratio = section.number("steering_ratio", &STEERING_RATIO)?;
    let road_wheel_rad = match (road_wheel, steering_wheel, ratio) {
        (Some(road_wheel), None, None) => road_wheel,
        (None, Some(steering_wheel), Some(ratio)) => {
            let road_wheel = steering_wheel / ratio;
            if STEER_ANGLE.check(road_wheel).is_err() {
                let expected = "a ratio by which the road wheels turn by at most 0.9 rad; 12 to 20 \
                                in cars";
                return Err(section.refuse_last(expected));
            }
            road_wheel
        }
        (Some(_), _, _) => return Err(section.conflict(&first)),
        (None, Some(_), None) => return Err(section.missing("steering_ratio")),
        (None, None, None) if start_s.is_none() && rise_s.is_none() => return Ok(None),
        (None, None, _) => return Err(section.missing("steer_rad (or steering_wheel_rad)")),
    };
    Ok(Some(HeldSteer {
        start_s: start_s.unwrap_or(0.0),
        rise_s: rise_s.unwrap_or(DEFAULT_BRAKE_RISE_S),
        road_wheel_rad,
    }))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::data::TomlFile;

    fn read(text: &str) -> Result<Ending, TomlError> {
        let file = TomlFile { path: Path::new("s.toml"), text };
        let root = file.parse()?;
        Ending::read(TomlTable::root(file, &root))
    }

    #[test]
    fn everyday_endings_are_read_and_written_back() {
        let text = "brake_start_s = 0.7\nbrake_share = 0.8\nengine_braking_g = 0.05\n\
                    driven_axle = \"rear\"\nrear_left = \"locked\"\nfront_right = \"dragged\"\n\
                    front_right_share = 0.5\ndrive_torque_n_m = 900\nsteering_wheel_deg = 48\nsteering_ratio = 16";
        let ending = read(text).unwrap();
        assert_eq!(ending.brake.unwrap().rise_s, DEFAULT_BRAKE_RISE_S);
        assert!((ending.engine.unwrap().deceleration_m_s2 - 0.490_332_5).abs() < 1e-9);
        let steer = ending.steer.unwrap();
        assert!((steer.road_wheel_rad - 3_f64.to_radians()).abs() < 1e-12);
        assert_eq!(ending.damage.len(), 2);
        let drive = ending.drive.unwrap();
        assert_eq!((drive.torque_n_m, drive.axle), (900.0, DrivenAxle::Rear));
        let written: String =
            ending.entries().iter().map(|(key, value)| format!("{key} = {value}\n")).collect();
        assert_eq!(read(&written).unwrap(), ending, "{written}");
        assert!(read("").unwrap().is_coasting());
    }

    #[test]
    fn half_an_ending_is_refused_by_the_key_that_is_missing() {
        for (text, expected) in [
            ("brake_share = 0.5", "brake_start_s is missing"),
            ("brake_start_s = 0.5", "brake_share is missing"),
            ("brake_start_s = 0.5\nbrake_share = 5", "brake_share is 5, expected 0 to 3"),
            ("rear_left = \"dragged\"", "rear_left_share is missing"),
            ("rear_left = \"locked\"\nrear_left_share = 1", "say the same thing"),
            ("rear_left_start_s = 1", "rear_left is missing"),
            ("rear_left = \"flat\"", "\"dragged\" or \"locked\""),
            ("driven_axle = \"rear\"", "engine_braking_m_s2 (or drive_torque_n_m) is missing"),
            ("drive_axle = \"rear\"", "drive_torque_n_m is missing"),
            ("drive_start_s = 1", "drive_torque_n_m is missing"),
            ("drive_torque_n_m = -5", "drive_torque_n_m is -5, expected 0 to 20000"),
            ("steer_deg = 120", "steer_deg is 120"),
            ("steering_wheel_deg = 90", "steering_ratio is missing"),
            (
                "steering_wheel_deg = 720\nsteering_ratio = 2",
                "steering_ratio is 2, expected a ratio",
            ),
            ("steer_deg = 3\nsteering_wheel_deg = 90", "say the same thing"),
            ("steer_start_s = 3", "steer_rad (or steering_wheel_rad) is missing"),
            ("brakes = 1", "brakes is not known here"),
        ] {
            let error = read(text).unwrap_err().to_string();
            assert!(error.contains(expected), "{text}: {error}");
        }
    }
}
