//! The columns that the mapping of the user names.

use crate::data::columns::{column_use, stated_unit};
use crate::data::{
    Channel, ColumnRef, ColumnSource, ColumnUse, DataError, SignedColumn, Table, Term, computed,
    spelling,
};
use crate::units::Unit;

/// The column that a mapping gives a channel.
///
/// # Errors
/// [`DataError::NoSuchColumn`], [`DataError::UnknownUnit`].
pub(super) fn mapped_column(
    table: &Table,
    channel: Channel,
    source: &ColumnSource,
) -> Result<ColumnUse, DataError> {
    let signed = |number| SignedColumn { number, is_negated: false, unit: None };
    let columns = match &source.column {
        ColumnRef::Number(number) => vec![signed(*number)],
        ColumnRef::Name(wanted) => {
            let names = table.header();
            let exact = names.iter().position(|name| name == wanted);
            let fits = |name: &String| spelling::same_name(name, wanted);
            let found = exact.or_else(|| names.iter().position(fits));
            vec![signed(found.map_or(0, |idx| idx + 1))]
        }
        ColumnRef::Sum(columns) => columns.clone(),
        ColumnRef::Computed(formula, numbers) => {
            let is_column = |number: &usize| (1..=table.header().len()).contains(number);
            let fits = computed::is_of(*formula, channel) && numbers.iter().all(is_column);
            let column = fits.then(|| computed::column(table, channel, *formula, numbers));
            return column.ok_or_else(|| no_such_column(table, channel, source));
        }
        ColumnRef::Zero => {
            let unit = channel.quantity().si_unit();
            let (number, name) = (0, "zero throughout".to_owned());
            let terms = Vec::new();
            let (unit_is_stated, formula) = (true, None);
            return Ok(ColumnUse { channel, number, name, unit, unit_is_stated, terms, formula });
        }
    };
    let mut used: Option<ColumnUse> = None;
    for SignedColumn { number, is_negated, unit } in columns {
        let (name, stated) = unit_of_mapped(table, channel, source, number, unit)?;
        let unit = stated.unwrap_or_else(|| channel.quantity().si_unit());
        let term = Term { number, sign: if is_negated { -1.0 } else { 1.0 }, unit };
        let sign = if is_negated { "−" } else { "+" };
        match &mut used {
            None if is_negated => {
                let column = column_use(channel, number, format!("{sign}{name}"), stated);
                used = Some(ColumnUse { terms: vec![term], ..column });
            }
            None => used = Some(column_use(channel, number, name, stated)),
            Some(sum) => {
                sum.name = format!("{} {sign} {name}", sum.name);
                sum.unit_is_stated &= stated.is_some();
                sum.terms.push(term);
            }
        }
    }
    used.ok_or_else(|| no_such_column(table, channel, source))
}

fn no_such_column(table: &Table, channel: Channel, source: &ColumnSource) -> DataError {
    DataError::NoSuchColumn {
        path: table.path().to_owned(),
        line: table.header_line(),
        channel,
        column: source.column.to_string(),
        found: table.header().to_vec(),
    }
}

/// The header of a mapped column, and the unit that the user or the file states.
fn unit_of_mapped(
    table: &Table,
    channel: Channel,
    source: &ColumnSource,
    number: usize,
    of_term: Option<Unit>,
) -> Result<(String, Option<Unit>), DataError> {
    let idx = number.checked_sub(1);
    let found = idx.and_then(|idx| Some((idx, table.header().get(idx)?.clone())));
    let (idx, name) = found.ok_or_else(|| no_such_column(table, channel, source))?;
    if let Some(unit) = of_term.or(source.unit) {
        return Ok((name, Some(unit)));
    }
    match stated_unit(&name, table.unit_text(idx), channel.quantity()) {
        Ok(unit) => Ok((name, unit)),
        Err(unit) => Err(DataError::UnknownUnit {
            path: table.path().to_owned(),
            line: table.header_line(),
            column: number,
            name,
            channel,
            unit,
            quantity: channel.quantity(),
        }),
    }
}
