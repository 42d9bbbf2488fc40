//! A column whose numbers are refused as it was read, and that may be meant in another way.

use crate::data::columns::open_question;
use crate::data::{Channel, ColumnMap, ColumnSource, ColumnUse, DataError, Table};
use crate::ranges::Range;
use crate::units::Unit;

/// The column, and how its table was read.
pub(super) struct Refused<'a> {
    pub table: &'a Table,
    pub column: &'a ColumnUse,
    pub map: Option<&'a ColumnMap>,
    /// What would let the record begin at 0, if that has to be said as well, s.
    pub shift_s: Option<f64>,
}

impl Refused<'_> {
    /// Whether all of its numbers are in a range if they are in a unit.
    pub(super) fn is_within(&self, range: &Range, unit: Unit) -> bool {
        let idx = self.column.number.saturating_sub(1);
        let fits = |row_idx| {
            let number = self.table.number(row_idx, idx);
            number.is_some_and(|number| range.contains(unit.to_si(number)))
        };
        (0..self.table.n_rows()).all(fits)
    }

    /// Asks what it is.
    ///
    /// - `what`: is open, in words;
    /// - `channel`, `unit`: what it may be.
    pub(super) fn asked(&self, what: String, channel: Channel, unit: Unit) -> DataError {
        let mut map = self.map.cloned().unwrap_or_default();
        map.settings.time_shift_s = self.shift_s.or(map.settings.time_shift_s);
        let answer = ColumnSource { unit: Some(unit), ..self.column.source() };
        open_question(self.table, Some(&map), what, [(channel, answer)])
    }
}
