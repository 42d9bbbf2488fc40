//! Checks of numbers that a model file holds and that a prediction divides by, takes the root of or
//! counts with. A file whose checksum was computed anew after a change passes every other check.

use crate::nn::NnError;

/// The values that a stored number may have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Expected {
    /// Above zero: divisors, deviations, variances.
    Positive,
    /// Zero or above.
    NotNegative,
    /// 0 to 1: probabilities and shares.
    Share,
    /// At most this magnitude: logarithms and exponents.
    Magnitude(f64),
}

impl Expected {
    fn accepts(self, value: f64) -> bool {
        match self {
            Self::Positive => value > 0.0 && value.is_finite(),
            Self::NotNegative => value >= 0.0 && value.is_finite(),
            Self::Share => (0.0..=1.0).contains(&value),
            Self::Magnitude(most) => value.abs() <= most,
        }
    }

    fn text(self) -> String {
        match self {
            Self::Positive => "a number above 0".to_owned(),
            Self::NotNegative => "0 or more".to_owned(),
            Self::Share => "0 to 1".to_owned(),
            Self::Magnitude(most) => format!("-{most} to {most}"),
        }
    }
}

/// Checks one number.
///
/// # Errors
/// [`NnError::StoredNumber`].
pub(crate) fn check_number(name: &str, value: f64, expected: Expected) -> Result<(), NnError> {
    if expected.accepts(value) {
        return Ok(());
    }
    Err(NnError::StoredNumber { name: name.to_owned(), value, expected: expected.text() })
}

/// Checks every number of a list.
///
/// # Errors
/// [`NnError::StoredNumber`] with the index of the first that is refused.
pub(crate) fn check_numbers<'a>(
    name: &str,
    values: impl IntoIterator<Item = &'a f64>,
    expected: Expected,
) -> Result<(), NnError> {
    match values.into_iter().enumerate().find(|(_, value)| !expected.accepts(**value)) {
        None => Ok(()),
        Some((idx, value)) => check_number(&format!("{name}[{idx}]"), *value, expected),
    }
}

/// Checks the number of entries of a list.
///
/// # Errors
/// [`NnError::StoredLength`].
pub(crate) fn check_length(name: &str, got: usize, expected: usize) -> Result<(), NnError> {
    if got == expected {
        return Ok(());
    }
    Err(NnError::StoredLength { name: name.to_owned(), expected, got })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_refused_with_their_place() {
        let error = check_numbers("a.std", &[1.0, 0.0], Expected::Positive).unwrap_err();
        assert_eq!(error.to_string(), "a.std[1] is 0, expected a number above 0");
        for (value, expected, is_good) in [
            (f64::NAN, Expected::Positive, false),
            (f64::INFINITY, Expected::NotNegative, false),
            (-1e-300, Expected::NotNegative, false),
            (0.0, Expected::NotNegative, true),
            (1.000_001, Expected::Share, false),
            (f64::NAN, Expected::Share, false),
            (-50.0, Expected::Magnitude(50.0), true),
            (f64::NAN, Expected::Magnitude(50.0), false),
        ] {
            assert_eq!(check_number("x", value, expected).is_ok(), is_good, "{value} {expected:?}");
        }
        let error = check_length("mean", 2, 3).unwrap_err();
        assert_eq!(error.to_string(), "mean has 2 entries, expected 3");
    }
}
