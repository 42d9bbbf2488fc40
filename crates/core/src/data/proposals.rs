//! What a mapping dialog is offered: the columns of a file, each with the channel that its header suggests.

use std::collections::BTreeMap;
use std::path::Path;

use crate::data::columns::{is_summed, meanings, stated_unit, sum};
use crate::data::spelling::{self, Meaning};
use crate::data::{
    Channel, ColumnMap, ColumnRef, ColumnSource, DataError, FormulaPart, ReadSettings,
    RecordedSide, SignedColumn, Table, clock, computed, stated_side,
};
use crate::units::{Quantity, Unit};

/// Number of sample values of a column that a mapping dialog shows.
const SHOWN_SAMPLES: usize = 5;

/// A column of a file as a mapping dialog shows it.
#[derive(Debug, Clone, PartialEq)]
pub struct ColumnProposal {
    /// The number of the column, counted from 1.
    pub number: usize,
    /// The header of the column; `column 1` and so on if the file has no header.
    pub name: String,
    /// The first values of the column, as written in the file.
    pub samples: Vec<String>,
    /// The channel and unit that the header suggests; the unit is `None` if the file states none.
    pub guess: Option<(Channel, Option<Unit>)>,
    /// What the header says that the column holds of what channels are computed from.
    pub part: Option<FormulaPart>,
    /// The cell of the column in the row of units.
    units_cell: Option<String>,
}

impl ColumnProposal {
    /// The unit that header or row of units state for a channel of `quantity`; `None` if they state
    /// none.
    ///
    /// # Errors
    /// The text of a unit that does not measure `quantity`.
    pub fn stated_unit(&self, quantity: Quantity) -> Result<Option<Unit>, String> {
        stated_unit(&self.name, self.units_cell.as_deref(), quantity)
    }

    /// The unit of a time: the one that the file states, or else that in which its numbers count the time since
    /// 1970.
    pub fn time_unit(&self) -> Option<Unit> {
        let first: Option<f64> = self.samples.first().and_then(|text| text.trim().parse().ok());
        let stated = self.stated_unit(Quantity::Time).ok().flatten();
        let guessed =
            || self.guess.and_then(|(channel, unit)| unit.filter(|_| channel == Channel::Time));
        stated.or_else(|| first.and_then(clock::unit_since_1970)).or_else(guessed)
    }

    /// Whether the header says that its numbers are positive to the other side than those of this program.
    ///
    /// - `channel`: what the column holds.
    pub fn is_turned(&self, channel: Channel) -> bool {
        stated_side::side_of(&self.name, channel) == Some(RecordedSide::Right)
    }

    /// The channel that is worth a proposal in a dialog: the guess, or what words in the header
    /// suggest, such as a force without a direction. The user has to look at it.
    pub fn suggestion(&self) -> Option<Channel> {
        let guessed = self.guess.map(|(channel, _)| channel);
        guessed.or_else(|| spelling::suggestion(&self.name))
    }
}

/// Reads a file and returns its columns, with the channel that each header suggests.
///
/// - `settings`: where its columns stand, such as in which sheet.
///
/// # Errors
/// [`DataError`] if the file cannot be read as a table.
pub fn propose_columns(
    path: &Path,
    settings: &ReadSettings,
) -> Result<Vec<ColumnProposal>, DataError> {
    Ok(proposals(&Table::read_as(path, settings)?))
}

/// The columns of a table, with the channel that each header suggests.
pub fn proposals(table: &Table) -> Vec<ColumnProposal> {
    let rows: Vec<_> = table.rows().take(SHOWN_SAMPLES).map(|(_, cells)| cells).collect();
    let computed = computed::columns(table);
    let part = |number: usize| {
        computed.iter().find_map(|column| {
            let at = column.terms.iter().position(|term| term.number == number)?;
            column.formula?.parts().get(at).copied()
        })
    };
    let columns = table.header().iter().zip(meanings(table)).enumerate();
    let proposal = |(column_idx, (name, meaning)): (usize, (&String, Meaning))| ColumnProposal {
        number: column_idx + 1,
        name: name.clone(),
        samples: rows.iter().filter_map(|cells| Some(cells.get(column_idx)?.to_string())).collect(),
        guess: match meaning {
            Meaning::Channel(channel, unit) => Some((channel, unit)),
            Meaning::WrongUnit(..) | Meaning::Unknown => None,
        },
        part: part(column_idx + 1),
        units_cell: table.unit_text(column_idx).map(str::to_owned),
    };
    columns.map(proposal).collect()
}

/// The mapping that accepts the suggested channel and unit of every column. Forces that several columns
/// hold are added up; any other channel that several columns may hold is left to be chosen.
pub fn map_from_proposals(proposals: &[ColumnProposal]) -> ColumnMap {
    let mut by_channel: BTreeMap<Channel, Vec<(usize, Option<Unit>)>> = BTreeMap::new();
    let mut turned = Vec::new();
    for proposal in proposals {
        if let Some((channel, unit)) = proposal.guess {
            turned.extend(proposal.is_turned(channel).then_some(proposal.number));
            by_channel.entry(channel).or_default().push((proposal.number, unit));
        }
    }
    let choice = |(channel, columns): (Channel, Vec<(usize, Option<Unit>)>)| match columns[..] {
        [(number, unit)] if turned.contains(&number) => {
            let term = SignedColumn { number, is_negated: true, unit: None };
            Some((channel, ColumnSource { column: ColumnRef::Sum(vec![term]), unit }))
        }
        [(number, unit)] => {
            Some((channel, ColumnSource { column: ColumnRef::Number(number), unit }))
        }
        _ if is_summed(channel) => Some((channel, sum(&columns))),
        _ => None,
    };
    by_channel.into_iter().filter_map(choice).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stated_unit_of_a_time_counts_before_that_of_a_clock() {
        let unit = |name: &str, first: &str| {
            let column = ColumnProposal {
                number: 1,
                name: name.to_owned(),
                samples: vec![first.to_owned()],
                guess: None,
                part: None,
                units_cell: None,
            };
            column.time_unit().map(|unit| unit.symbol)
        };
        assert_eq!(unit("uptime [ms]", "1700000000"), Some("ms"));
        assert_eq!(unit("stamp", "1700000000000000000"), Some("ns"));
        assert_eq!(unit("stamp", "12.5"), None);
    }
}
