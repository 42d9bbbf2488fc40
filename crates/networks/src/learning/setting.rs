//! The check of the settings of a network and its training against the table of ranges.

use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;
use toml::Value;

use crate::learning::LearningError;
use impactlab_core::data::{TomlError, TomlFile};
use impactlab_core::ranges::RangeGroup;

/// Behind the name of a setting: how many numbers it has.
const NUMBER_OF: &str = " (number)";

/// Checks that every number in the settings is finite and lies in its range.
///
/// - `ranges`: the ranges of these settings, by section and name as in the file. A setting with a
///   list of numbers has a range for each number and, if the length of the list is free, another
///   one for the length.
///
/// # Errors
/// [`LearningError::Setting`] with the first number that is out of range or has none.
pub fn check_settings(settings: &impl Serialize, ranges: &RangeGroup) -> Result<(), LearningError> {
    let all = Value::try_from(settings).map_err(|error| LearningError::Setting {
        name: ranges.title.to_owned(),
        value: error.to_string(),
        expected: "numbers that TOML can write".to_owned(),
    })?;
    check_value("", &all, ranges)
}

/// Checks what several settings must satisfy together.
///
/// - `name`: the setting that is named if they do not; section and name, as in the file.
/// - `expected`: the condition, in words.
///
/// # Errors
/// [`LearningError::Setting`] unless `is_valid`.
pub fn check_relation(
    name: &str,
    value: impl ToString,
    is_valid: bool,
    expected: &str,
) -> Result<(), LearningError> {
    if is_valid {
        return Ok(());
    }
    let (value, expected) = (value.to_string(), expected.to_owned());
    Err(LearningError::Setting { name: name.to_owned(), value, expected })
}

/// Reads settings from a TOML file and checks them. What the file leaves out keeps its default.
///
/// # Errors
/// [`LearningError::Toml`] with line and column, also for a value that `check` refuses.
pub fn load_settings<C: DeserializeOwned>(
    path: &Path,
    check: impl FnOnce(&C) -> Result<(), LearningError>,
) -> Result<C, LearningError> {
    let text = TomlFile::read(path)?;
    let file = TomlFile { path, text: &text };
    let settings = file.to()?;
    match check(&settings) {
        Ok(()) => Ok(settings),
        Err(LearningError::Setting { name, value, expected }) => {
            Err(located(file, &name, &value, &expected).into())
        }
        Err(error) => Err(error),
    }
}

fn located(file: TomlFile<'_>, name: &str, value: &str, expected: &str) -> TomlError {
    match name.strip_suffix(NUMBER_OF) {
        Some(list) => file.wrong_value(list, value, &format!("{expected} of them")),
        None => file.wrong_value(name, value, expected),
    }
}

fn check_value(name: &str, value: &Value, ranges: &RangeGroup) -> Result<(), LearningError> {
    match value {
        Value::Table(table) => table.iter().try_for_each(|(key, value)| {
            let name = if name.is_empty() { key.clone() } else { format!("{name}.{key}") };
            if let (Value::Array(list), Some(range)) =
                (value, ranges.get(&(name.clone() + NUMBER_OF)))
            {
                let is_valid = range.contains(list.len() as f64);
                check_relation(range.name, list.len(), is_valid, &range.expected_si())?;
            }
            check_value(&name, value, ranges)
        }),
        Value::Array(list) => list.iter().try_for_each(|value| check_value(name, value, ranges)),
        Value::Integer(number) => check_number(name, *number as f64, ranges),
        Value::Float(number) => check_number(name, *number, ranges),
        Value::String(_) | Value::Boolean(_) | Value::Datetime(_) => Ok(()),
    }
}

fn check_number(name: &str, number: f64, ranges: &RangeGroup) -> Result<(), LearningError> {
    let range = ranges.get(name);
    let is_valid = range.is_some_and(|range| range.contains(number));
    let expected = range.map_or("a setting with a range".to_owned(), |range| range.expected_si());
    check_relation(name, number, is_valid, &expected)
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::ranges::Range;

    #[derive(Serialize)]
    struct Layers {
        widths: Vec<usize>,
    }

    #[test]
    fn a_list_has_as_many_numbers_as_it_may_and_each_has_a_range() {
        const RANGES: RangeGroup = RangeGroup {
            title: "layers",
            ranges: &[
                Range::whole("widths", [1, 64], "width of a layer"),
                Range::whole("widths (number)", [1, 2], "layers"),
            ],
        };
        let check = |widths: &[usize]| {
            let checked = check_settings(&Layers { widths: widths.to_vec() }, &RANGES);
            checked.map_err(|error| error.to_string())
        };
        assert_eq!(check(&[1, 64]), Ok(()));
        assert_eq!(check(&[]), Err("widths (number) is 0, expected 1 to 2".to_owned()));
        assert_eq!(check(&[8, 65]), Err("widths is 65, expected 1 to 64".to_owned()));
        let none = RangeGroup { ranges: &[], ..RANGES };
        assert!(check_settings(&Layers { widths: vec![1] }, &none).is_err());
    }
}
