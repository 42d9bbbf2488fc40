//! Checks of the numbers of a question against the table of ranges.

use crate::StudyError;
use impactlab_core::ranges::{CONTACT_HEIGHT, CONTACT_X, CONTACT_Y, Range, WINDOW};
use impactlab_core::vehicle::ContactPoint;

/// Checks a number of a question.
///
/// - `field`: the name of the number in the question.
pub(crate) fn check(field: &str, range: &Range, value: f64) -> Result<(), StudyError> {
    let in_field = |source| StudyError::OutOfRange { field: field.to_owned(), source };
    range.check(value).map(|_| ()).map_err(in_field)
}

/// Checks a number of a question that may be left open.
pub(crate) fn check_given(
    field: &str,
    range: &Range,
    value: Option<f64>,
) -> Result<(), StudyError> {
    value.map_or(Ok(()), |value| check(field, range, value))
}

/// Checks how many of something a question asks for.
pub(crate) fn check_count(field: &str, range: &Range, count: usize) -> Result<(), StudyError> {
    check(field, range, count as f64)
}

/// Checks numbers that come with their names and ranges.
pub(crate) fn check_all(
    numbers: impl IntoIterator<Item = (String, f64, Range)>,
) -> Result<(), StudyError> {
    numbers.into_iter().try_for_each(|(field, value, range)| check(&field, &range, value))
}

/// Checks a contact point that a question gives.
pub(crate) fn check_contact(contact: Option<&ContactPoint>) -> Result<(), StudyError> {
    let Some(ContactPoint { x_body_m, y_body_m, height_m }) = contact else {
        return Ok(());
    };
    check("contact.x_m", &CONTACT_X, *x_body_m)?;
    check("contact.y_m", &CONTACT_Y, *y_body_m)?;
    check("contact.height_m", &CONTACT_HEIGHT, *height_m)
}

/// Checks the window of time over which a density is averaged.
///
/// - `[from_s, to_s]`: start and end, s; the same for an instant.
///
/// # Errors
/// [`StudyError::OutOfRange`] for a time outside [`WINDOW`], [`StudyError::Window`] for a window
/// that ends before it starts.
pub fn check_window([from_s, to_s]: [f64; 2]) -> Result<(), StudyError> {
    check("window", &WINDOW, from_s)?;
    check("window", &WINDOW, to_s)?;
    if from_s <= to_s { Ok(()) } else { Err(StudyError::Window { from_s, to_s }) }
}
