//! Angles whose unit nobody states and which are too large for radians.

use crate::data::refused::Refused;
use crate::data::{ColumnUse, DataError};
use crate::units::{Quantity, Unit};

/// Asks for the unit of an angle that is refused in radians and may be in degrees; any other error stays as
/// it is.
///
/// - `error`: why the column is refused.
pub(super) fn asked(refused: &Refused<'_>, error: DataError) -> DataError {
    let column = refused.column;
    let (DataError::ImplausibleValue { value, range, .. }, Some(unit), [_]) =
        (&error, in_degrees(column), &column.terms[..])
    else {
        return error;
    };
    if !refused.is_within(range, unit) {
        return error;
    }
    let what = format!(
        "column {} {:?} names no unit and would be {}, expected {}; name its unit",
        column.number,
        column.name,
        range.shown(*value),
        range.explained(),
    );
    refused.asked(what, column.channel, unit)
}

/// The unit with degrees of a column that states none.
fn in_degrees(column: &ColumnUse) -> Option<Unit> {
    let symbol = match column.channel.quantity() {
        Quantity::Angle => "deg",
        Quantity::AngularVelocity => "deg/s",
        _ => return None,
    };
    let units = column.channel.quantity().units();
    units.iter().find(|unit| unit.symbol == symbol && !column.unit_is_stated).copied()
}
