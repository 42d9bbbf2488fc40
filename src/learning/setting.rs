//! The ranges of the settings of a network and its training.

use crate::learning::LearningError;

/// The check of one setting.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    name: &'static str,
    value: String,
    is_valid: bool,
    expected: &'static str,
}

impl Setting {
    /// A setting with a range of its own.
    ///
    /// - `name`: section and name, as in the file;
    /// - `expected`: the range, in words.
    pub fn new(
        name: &'static str,
        value: impl ToString,
        is_valid: bool,
        expected: &'static str,
    ) -> Self {
        Self { name, value: value.to_string(), is_valid, expected }
    }

    /// A number of things of which there must be one or more.
    pub fn count(name: &'static str, value: usize) -> Self {
        Self::new(name, value, value > 0, "1 or more")
    }

    /// A finite number above zero.
    pub fn positive(name: &'static str, value: f64) -> Self {
        Self::new(name, value, value > 0.0 && value.is_finite(), "a number above 0")
    }

    /// A number from zero to a largest value.
    pub fn up_to(name: &'static str, value: f64, most: f64, expected: &'static str) -> Self {
        Self::new(name, value, (0.0..=most).contains(&value), expected)
    }
}

/// Checks every range.
///
/// # Errors
/// [`LearningError::Setting`] with the first setting out of range.
pub fn check_settings(settings: impl IntoIterator<Item = Setting>) -> Result<(), LearningError> {
    match settings.into_iter().find(|setting| !setting.is_valid) {
        None => Ok(()),
        Some(Setting { name, value, expected, .. }) => {
            Err(LearningError::Setting { name, value, expected })
        }
    }
}
