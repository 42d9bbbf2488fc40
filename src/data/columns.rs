//! Decides which column of a table holds which channel and in which unit, from the mapping of the
//! user, the headers and a row of units.

use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

use crate::data::spelling::{self, Meaning};
use crate::data::{Channel, ColumnMap, ColumnRef, ColumnSource, DataError, Table};
use crate::units::{Quantity, Unit};

/// Number of sample values of a column that a mapping dialog shows.
const SHOWN_SAMPLES: usize = 5;

/// Number of columns without a channel that a remark names.
const SHOWN_IGNORED: usize = 100;

/// Number of characters of a header that a remark shows.
const SHOWN_CHARS: usize = 60;

/// A column that was read, with the channel and the unit that it was read as.
#[derive(Debug, Clone, PartialEq)]
pub struct ColumnUse {
    /// The channel that the column holds.
    pub channel: Channel,
    /// The number of the column, counted from 1.
    pub number: usize,
    /// The header of the column.
    pub name: String,
    /// The unit of the numbers in the column.
    pub unit: Unit,
    /// Whether the file or the user states the unit; otherwise the SI unit was assumed.
    pub unit_is_stated: bool,
}

/// A remark on a file that was read, shown to the user.
#[derive(Debug, Clone, PartialEq)]
pub enum Note {
    /// The unit of a column is not stated, so that the SI unit was assumed.
    UnitAssumed(ColumnUse),
    /// A column was left out because its unit does not measure the channel. The channel is not
    /// needed; otherwise the file is refused.
    WrongUnit {
        /// The channel that the header names.
        channel: Channel,
        /// The number of the column, counted from 1.
        number: usize,
        /// The header of the column.
        name: String,
        /// The unit as written in the file.
        unit: String,
    },
    /// Columns whose headers name no channel were left out.
    Ignored {
        /// The headers of these columns.
        names: Vec<String>,
    },
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnitAssumed(column) => write!(
                f,
                "column {} {:?} names no unit; taken as {}",
                column.number, column.name, column.unit.symbol
            ),
            Self::WrongUnit { channel, number, name, unit } => write!(
                f,
                "column {number} {name:?} is left out: {unit:?} is no unit of {}",
                spelling::quantity_name(channel.quantity())
            ),
            Self::Ignored { names } => {
                let shown: Vec<&str> =
                    names.iter().take(SHOWN_IGNORED).map(|name| beginning(name)).collect();
                write!(f, "not recognised: {}", shown.join(", "))?;
                match names.len().saturating_sub(SHOWN_IGNORED) {
                    0 => Ok(()),
                    more => write!(f, " and {more} more"),
                }
            }
        }
    }
}

/// The beginning of a header, as long as a remark shows it.
fn beginning(name: &str) -> &str {
    let end = name.char_indices().nth(SHOWN_CHARS).map(|(at, _)| at);
    end.and_then(|end| name.get(..end)).unwrap_or(name)
}

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
}

/// Reads a file and returns its columns, with the channel that each header suggests.
///
/// # Errors
/// [`DataError`] if the file cannot be read as a table.
pub fn propose_columns(path: &Path) -> Result<Vec<ColumnProposal>, DataError> {
    let table = Table::read(path)?;
    let rows: Vec<_> = table.rows().take(SHOWN_SAMPLES).map(|(_, cells)| cells).collect();
    let proposal = |(column_idx, name): (usize, &String)| ColumnProposal {
        number: column_idx + 1,
        name: name.clone(),
        samples: rows.iter().filter_map(|cells| Some(cells.get(column_idx)?.to_string())).collect(),
        guess: match column_meaning(&table, column_idx) {
            Meaning::Channel(channel, unit) => Some((channel, unit)),
            Meaning::WrongUnit(..) | Meaning::Unknown => None,
        },
    };
    Ok(table.header().iter().enumerate().map(proposal).collect())
}

/// The mapping that accepts the suggested channel and unit of every column.
pub fn map_from_proposals(proposals: &[ColumnProposal]) -> ColumnMap {
    let choice = |proposal: &ColumnProposal| {
        let (channel, unit) = proposal.guess?;
        let column = ColumnRef::Number(proposal.number);
        Some((channel, ColumnSource { column, unit }))
    };
    proposals.iter().filter_map(choice).collect()
}

/// The columns of a table by channel, and the remarks on them.
#[derive(Debug, Default)]
pub(crate) struct Columns {
    pub by_channel: BTreeMap<Channel, ColumnUse>,
    pub notes: Vec<Note>,
}

impl Columns {
    /// Assigns the columns of the mapping first and then the others by their headers.
    ///
    /// # Errors
    /// [`DataError::NoSuchColumn`] if the mapping names a column that the table does not have,
    /// [`DataError::UnknownUnit`] if the unit of a mapped column does not measure its channel, and
    /// [`DataError::AmbiguousColumn`] if two headers name the same channel.
    pub(crate) fn of(table: &Table, map: Option<&ColumnMap>) -> Result<Self, DataError> {
        let mut columns = Self::default();
        for (channel, source) in map.iter().flat_map(|map| map.iter()) {
            let column = mapped_column(table, channel, source)?;
            columns.by_channel.insert(channel, column);
        }
        columns.guess_others(table, map)?;
        let assumed = columns.by_channel.values().filter(|column| !column.unit_is_stated);
        let assumed: Vec<Note> = assumed.cloned().map(Note::UnitAssumed).collect();
        columns.notes.splice(0..0, assumed);
        Ok(columns)
    }

    fn guess_others(&mut self, table: &Table, map: Option<&ColumnMap>) -> Result<(), DataError> {
        let mapped: Vec<usize> = self.by_channel.values().map(|column| column.number).collect();
        let is_mapped = |channel| map.is_some_and(|map| map.get(channel).is_some());
        let mut ignored = Vec::new();
        for (column_idx, name) in table.header().iter().enumerate() {
            let number = column_idx + 1;
            if mapped.contains(&number) {
                continue;
            }
            let name = name.clone();
            match column_meaning(table, column_idx) {
                Meaning::Channel(channel, unit) if !is_mapped(channel) => {
                    let column = column_use(channel, number, name, unit);
                    if let Some(earlier) = self.by_channel.get(&channel) {
                        return Err(ambiguous(table, column, earlier));
                    }
                    self.by_channel.insert(channel, column);
                }
                Meaning::WrongUnit(channel, unit) if !is_mapped(channel) => {
                    self.notes.push(Note::WrongUnit { channel, number, name, unit });
                }
                _ => ignored.push(name),
            }
        }
        if !ignored.is_empty() {
            self.notes.push(Note::Ignored { names: ignored });
        }
        Ok(())
    }

    /// Builds the error for a needed channel that no column holds: [`DataError::UnknownUnit`] if
    /// its column was left out for its unit, and [`DataError::MissingColumn`] otherwise.
    ///
    /// - `needed`: all channels that are needed, in words.
    pub(crate) fn missing(
        &self,
        table: &Table,
        channel: Channel,
        needed: &'static str,
    ) -> DataError {
        let (path, line) = (table.path().to_owned(), table.header_line());
        let wrong = self.notes.iter().find_map(|note| match note {
            Note::WrongUnit { channel: of, number, name, unit } if *of == channel => {
                Some((*number, name.clone(), unit.clone()))
            }
            _ => None,
        });
        match wrong {
            Some((column, name, unit)) => DataError::UnknownUnit {
                path,
                line,
                column,
                name,
                channel,
                unit,
                quantity: channel.quantity(),
            },
            None => DataError::MissingColumn {
                path,
                line,
                channel,
                needed,
                found: table.header().to_vec(),
            },
        }
    }
}

fn column_use(channel: Channel, number: usize, name: String, unit: Option<Unit>) -> ColumnUse {
    ColumnUse {
        channel,
        number,
        name,
        unit: unit.unwrap_or_else(|| channel.quantity().si_unit()),
        unit_is_stated: unit.is_some(),
    }
}

/// The channel and unit that the header of a column names, with the unit from the row of units if
/// the header has none.
fn column_meaning(table: &Table, column_idx: usize) -> Meaning {
    let name = table.header().get(column_idx).map_or("", String::as_str);
    match (spelling::meaning(name), table.unit_text(column_idx)) {
        (Meaning::Channel(channel, None), Some(text)) => {
            match spelling::unit(channel.quantity(), text) {
                Some(unit) => Meaning::Channel(channel, Some(unit)),
                None => Meaning::WrongUnit(channel, text.to_owned()),
            }
        }
        (meaning, _) => meaning,
    }
}

fn mapped_column(
    table: &Table,
    channel: Channel,
    source: &ColumnSource,
) -> Result<ColumnUse, DataError> {
    let fits = |name: &String| match &source.column {
        ColumnRef::Number(_) => false,
        ColumnRef::Name(wanted) => spelling::same_name(name, wanted),
    };
    let column_idx = match &source.column {
        ColumnRef::Number(number) => number.checked_sub(1),
        ColumnRef::Name(wanted) => {
            let exact = table.header().iter().position(|name| name == wanted);
            exact.or_else(|| table.header().iter().position(fits))
        }
    };
    let found = column_idx.and_then(|idx| Some((idx, table.header().get(idx)?.clone())));
    let (column_idx, name) = found.ok_or_else(|| DataError::NoSuchColumn {
        path: table.path().to_owned(),
        line: table.header_line(),
        channel,
        column: source.column.to_string(),
        found: table.header().to_vec(),
    })?;
    let number = column_idx + 1;
    let unit = match source.unit {
        Some(unit) => Some(unit),
        None => stated_unit(table, column_idx, channel.quantity()).map_err(|unit| {
            DataError::UnknownUnit {
                path: table.path().to_owned(),
                line: table.header_line(),
                column: number,
                name: name.clone(),
                channel,
                unit,
                quantity: channel.quantity(),
            }
        })?,
    };
    Ok(column_use(channel, number, name, unit))
}

/// The unit that the file states for a column, in the row of units or in the header. The error is
/// the text of a unit that does not measure `quantity`.
fn stated_unit(table: &Table, idx: usize, quantity: Quantity) -> Result<Option<Unit>, String> {
    if let Some(text) = table.unit_text(idx) {
        return match spelling::unit(quantity, text) {
            Some(unit) => Ok(Some(unit)),
            None => Err(text.to_owned()),
        };
    }
    let name = table.header().get(idx).map_or("", String::as_str);
    spelling::trailing_unit(name, quantity)
}

fn ambiguous(table: &Table, later: ColumnUse, earlier: &ColumnUse) -> DataError {
    DataError::AmbiguousColumn {
        path: table.path().to_owned(),
        line: table.header_line(),
        column: later.number,
        channel: later.channel,
        name: later.name,
        other_column: earlier.number,
        other: earlier.name.clone(),
    }
}
