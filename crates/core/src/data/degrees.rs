//! Angles whose unit nobody states and which are too large for radians.

use crate::data::columns::open_question;
use crate::data::{ColumnMap, ColumnSource, ColumnUse, DataError, Table};
use crate::units::{Quantity, Unit};

/// Asks for the unit of an angle that is refused in radians and may be in degrees; any other error stays as
/// it is.
///
/// - `shift_s`: what would let the record begin at 0, if that has to be said as well, s.
/// - `error`: why the column is refused.
pub(super) fn asked(
    table: &Table,
    column: &ColumnUse,
    map: Option<&ColumnMap>,
    shift_s: Option<f64>,
    error: DataError,
) -> DataError {
    let (DataError::ImplausibleValue { value, range, .. }, Some(unit), [_]) =
        (&error, in_degrees(column), &column.terms[..])
    else {
        return error;
    };
    let idx = column.number.saturating_sub(1);
    let fits = |row_idx| {
        table.number(row_idx, idx).is_some_and(|number| range.contains(unit.to_si(number)))
    };
    if !(0..table.n_rows()).all(fits) {
        return error;
    }
    let what = format!(
        "column {} {:?} names no unit and would be {}, expected {}; name its unit",
        column.number,
        column.name,
        range.shown(*value),
        range.explained(),
    );
    let mut map = map.cloned().unwrap_or_default();
    map.settings.time_shift_s = shift_s.or(map.settings.time_shift_s);
    let answer = ColumnSource { unit: Some(unit), ..column.source() };
    open_question(table, Some(&map), what, [(column.channel, answer)])
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
