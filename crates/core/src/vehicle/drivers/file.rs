//! The part of the section `[ending]` of a scenario file that says how drivers and systems act.
//!
//! ```toml
//! esc = true                      # stability control, and with it an anti-lock system
//! esc_threshold_deg_s = 6         # optional, as is every other number of StabilityControl: esc_…
//! brake_abs = true                # anti-lock system alone; numbers of AntiLock: brake_abs_…
//! countersteer = true             # the driver countersteers; numbers of Countersteer: countersteer_…
//! countersteer_delay_s = 0.8      # optional
//! pit = "brake"                   # the driver turns into another car; in the end "brake",
//!                                 # "straighten" or "keep_pushing", or it is "unknown"; numbers of
//!                                 # PitDriver: pit_…
//! pit_steering_wheel_deg = 135    # optional, positive to the left
//! pit_side = "right"              # optional, without the angle; "left"; else where the other car is
//! pit_axle = "rear"               # optional; "front", "all"
//! pit_longest_s = 1.5             # optional
//! ```

use strum::VariantNames;

use crate::data::{TomlError, TomlTable};
use crate::ranges::CONTROL_TIME;
use crate::vehicle::drivers::numbers::Number;
use crate::vehicle::{
    AntiLock, Countersteer, DrivenAxle, Ending, PitDriver, PitEnd, StabilityControl, TurnSide,
};

/// Keys with their values.
type Entries = Vec<(String, toml::Value)>;

/// Word for the end of a pushing of which nobody says how it ends.
const UNKNOWN_END: &str = "unknown";

/// Reads the numbers whose keys begin with the name of a part.
///
/// - returns the key of one that is given.
fn read_numbers<const N: usize>(
    section: &mut TomlTable<'_>,
    part: &str,
    numbers: [Number<'_>; N],
) -> Result<Option<String>, TomlError> {
    let mut given = None;
    for (base, place, range) in numbers {
        *place = section.number(&format!("{part}_{base}"), &range)?;
        if place.is_some() {
            given = Some(section.last_key());
        }
    }
    Ok(given)
}

/// Reads a part that is there if its key is `true`.
fn read_part<T: Default, const N: usize>(
    section: &mut TomlTable<'_>,
    part: &str,
    numbers: fn(&mut T) -> [Number<'_>; N],
) -> Result<Option<T>, TomlError> {
    let is_there = section.flag(part)?;
    let mut read = T::default();
    let given = read_numbers(section, part, numbers(&mut read))?;
    match (is_there, given) {
        (Some(true), _) => Ok(Some(read)),
        (None, Some(_)) => Err(section.missing(part)),
        (Some(false), Some(_)) => Err(section.conflict(part)),
        (_, None) => Ok(None),
    }
}

/// Reads the anti-lock system of the brake.
pub(in crate::vehicle) fn read_abs(
    section: &mut TomlTable<'_>,
) -> Result<Option<AntiLock>, TomlError> {
    read_part(section, "brake_abs", AntiLock::numbers)
}

/// Reads the stability control.
pub(in crate::vehicle) fn read_esc(
    section: &mut TomlTable<'_>,
) -> Result<Option<StabilityControl>, TomlError> {
    read_part(section, "esc", StabilityControl::numbers)
}

/// Reads the driver who countersteers.
pub(in crate::vehicle) fn read_countersteer(
    section: &mut TomlTable<'_>,
) -> Result<Option<Countersteer>, TomlError> {
    read_part(section, "countersteer", Countersteer::numbers)
}

/// Reads the driver of a PIT.
pub(in crate::vehicle) fn read_pit(
    section: &mut TomlTable<'_>,
) -> Result<Option<PitDriver>, TomlError> {
    let ends = [PitEnd::VARIANTS, &[UNKNOWN_END]].concat();
    let end = section.choice("pit", &ends)?;
    let mut driver = PitDriver::default();
    let mut given = read_numbers(section, "pit", driver.numbers())?;
    if let Some(idx) = section.choice("pit_side", TurnSide::VARIANTS)? {
        driver.side = TurnSide::ALL.get(idx).copied();
        given = Some(section.last_key());
        if driver.steering_wheel_rad.is_some() {
            return Err(section.conflict("pit_steering_wheel"));
        }
    }
    if let Some(idx) = section.choice("pit_axle", DrivenAxle::VARIANTS)? {
        driver.axle = DrivenAxle::ALL.get(idx).copied().unwrap_or_default();
        given = Some(section.last_key());
    }
    driver.longest_s = section.number("pit_longest", &CONTROL_TIME)?;
    if driver.longest_s.is_some() {
        given = Some(section.last_key());
    }
    match end {
        Some(idx) => Ok(Some(PitDriver { end: PitEnd::ALL.get(idx).copied(), ..driver })),
        None if given.is_some() => Err(section.missing("pit")),
        None => Ok(None),
    }
}

/// The keys and values from which the same drivers and systems are read.
pub(in crate::vehicle) fn entries(ending: &Ending) -> Entries {
    let mut entries = Entries::new();
    let mut add = |part: &str, word: toml::Value, numbers: Vec<(String, f64)>| {
        entries.push((part.to_owned(), word));
        let of_part = |(name, value): (String, f64)| (format!("{part}_{name}"), value.into());
        entries.extend(numbers.into_iter().map(of_part));
    };
    let values = |ranges: Vec<(String, f64, _)>| {
        ranges.into_iter().map(|(name, value, _)| (name, value)).collect()
    };
    if let Some(abs) = ending.brake.and_then(|brake| brake.abs) {
        add("brake_abs", true.into(), values(abs.ranges()));
    }
    if let Some(esc) = &ending.esc {
        add("esc", true.into(), values(esc.ranges()));
    }
    if let Some(driver) = &ending.countersteer {
        add("countersteer", true.into(), values(driver.ranges()));
    }
    if let Some(driver) = &ending.pit {
        let end = driver.end.map_or(UNKNOWN_END, PitEnd::word);
        add("pit", end.into(), values(driver.ranges()));
        if let (None, Some(side)) = (driver.steering_wheel_rad, driver.side) {
            entries.push(("pit_side".to_owned(), side.word().into()));
        }
        entries.push(("pit_axle".to_owned(), driver.axle.word().into()));
    }
    entries
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
    fn drivers_and_systems_are_read_and_written_back() {
        let text = "esc = true\nesc_threshold_deg_s = 5\nesc_gives_up_sideslip_deg = 90\n\
                    countersteer = true\ncountersteer_delay_s = 0.6\n\
                    countersteer_largest_steering_wheel_deg = 270\n\
                    pit = \"keep_pushing\"\npit_steering_wheel_deg = -120\npit_axle = \"rear\"\n\
                    pit_longest_s = 2\nbrake_start_s = 1\nbrake_share = 1.5\nbrake_abs = true\n\
                    brake_abs_share_of_peak = 0.9";
        let ending = read(text).unwrap();
        let esc = ending.esc.unwrap();
        assert!((esc.threshold_rad_s.unwrap() - 5_f64.to_radians()).abs() < 1e-12);
        assert_eq!(esc.rise_s, None, "nobody states it");
        assert_eq!(ending.countersteer.unwrap().delay_s, Some(0.6));
        let pit = ending.pit.unwrap();
        assert!((pit.steering_wheel_rad.unwrap() + 120_f64.to_radians()).abs() < 1e-12);
        assert_eq!((pit.end, pit.axle), (Some(PitEnd::KeepPushing), DrivenAxle::Rear));
        assert_eq!(pit.longest_s, Some(2.0));
        assert_eq!(ending.anti_lock().unwrap().share_of_peak, Some(0.9));
        let written: String =
            ending.entries().iter().map(|(key, value)| format!("{key} = {value}\n")).collect();
        assert_eq!(read(&written).unwrap(), ending, "{written}");
        assert!(read("esc = false\ncountersteer = false").unwrap().is_coasting());
    }

    /// A usual value that somebody states is another thing than one that nobody states, and stays so.
    #[test]
    fn what_is_stated_and_what_is_not_are_written_back() {
        let written = |ending: &Ending| -> String {
            ending.entries().iter().map(|(key, value)| format!("{key} = {value}\n")).collect()
        };
        let nothing = read("esc = true\ncountersteer = true\npit = \"unknown\"").unwrap();
        assert_eq!(nothing.esc, Some(StabilityControl::default()));
        assert_eq!(nothing.countersteer, Some(Countersteer::default()));
        assert_eq!(nothing.pit, Some(PitDriver::default()));
        let text = "esc = true\nesc_rise_s = 0.2\ncountersteer = true\ncountersteer_delay_s = 0.8\n\
                    pit = \"brake\"\npit_side = \"right\"";
        let usual = read(text).unwrap();
        assert_eq!(usual.esc.unwrap().rise_s, Some(0.2));
        let pit = usual.pit.unwrap();
        assert_eq!((pit.end, pit.side), (Some(PitEnd::Brake), Some(TurnSide::Right)));
        for ending in [&nothing, &usual] {
            assert_eq!(&read(&written(ending)).unwrap(), ending, "{}", written(ending));
            let json = serde_json::to_string(ending).unwrap();
            assert_eq!(&serde_json::from_str::<Ending>(&json).unwrap(), ending, "{json}");
        }
        assert_ne!(nothing, usual);
        assert!(!written(&nothing).contains("rise"), "{}", written(&nothing));
    }

    #[test]
    fn half_a_driver_is_refused_by_the_key_that_is_missing() {
        for (text, expected) in [
            ("esc = 1", "true or false"),
            ("esc_rise_s = 0.2", "esc is missing"),
            ("esc = false\nesc_rise_s = 0.2", "say the same thing"),
            ("esc = true\nesc_slip_ratio = 0.9", "esc_slip_ratio is 0.9, expected 0.02 to 0.5"),
            ("brake_abs = true", "brake_start_s is missing"),
            ("countersteer_delay_s = 1", "countersteer is missing"),
            ("countersteer = true\ncountersteer_steering_ratio = 0", "expected 1 to 40"),
            ("pit_turn_s = 0.3", "pit is missing"),
            ("pit_axle = \"rear\"", "pit is missing"),
            ("pit = \"stop\"", "\"brake\" or \"keep_pushing\" or \"unknown\""),
            ("pit_side = \"left\"", "pit is missing"),
            ("pit = \"brake\"\npit_side = \"left\"\npit_steering_wheel_deg = 90", "say the same"),
            ("pit = \"brake\"\nsteer_deg = 3", "say the same thing"),
        ] {
            let error = read(text).unwrap_err().to_string();
            assert!(error.contains(expected), "{text}: {error}");
        }
    }
}
