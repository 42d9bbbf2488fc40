//! Scenarios that are part of the program, compiled in from `assets/scenarios/*.toml`.

use std::path::Path;

use crate::collision::Scenario;
use crate::data::TomlError;

const PIT_RIGHT_REAR: &str = include_str!("../../../../assets/scenarios/pit_right_rear.toml");
const CARPENTER_WELCHER_BARRIER: &str =
    include_str!("../../../../assets/scenarios/carpenter_welcher_barrier.toml");

/// The scenarios that come with the program: for each the name on the command line and the text of
/// its file.
pub const SCENARIO_PRESETS: &[(&str, &str)] =
    &[("pit-right-rear", PIT_RIGHT_REAR), ("carpenter-welcher-barrier", CARPENTER_WELCHER_BARRIER)];

impl Scenario {
    /// Reads a scenario that comes with the program if the argument is its name, or else a scenario
    /// file. A file that has the name of such a scenario can be read as `./NAME`.
    ///
    /// # Errors
    /// The errors of [`Scenario::load`].
    pub fn preset_or_file(name_or_file: &Path) -> Result<Self, TomlError> {
        match SCENARIO_PRESETS.iter().find(|(name, _)| Path::new(name) == name_or_file) {
            Some((_, text)) => Self::from_toml(text, name_or_file),
            None => Self::load(name_or_file),
        }
    }

    /// The example scenario with which the window starts: a PIT manoeuvre in which the striking
    /// vehicle hits the right rear quarter of the struck vehicle.
    pub fn example() -> Self {
        match Self::from_toml(PIT_RIGHT_REAR, Path::new("pit-right-rear")) {
            Ok(scenario) => scenario,
            Err(error) => unreachable!("a shipped scenario is bad (a test reads it): {error}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_is_the_scenario_of_its_file() {
        for (name, _) in SCENARIO_PRESETS {
            let file = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/scenarios"))
                .join(name.replace('-', "_"));
            let of_file = Scenario::load(&file.with_extension("toml")).unwrap();
            assert_eq!(Scenario::preset_or_file(Path::new(name)).unwrap(), of_file, "{name}");
        }
        assert!(Scenario::preset_or_file(Path::new("no-such-scenario")).is_err());
    }
}
