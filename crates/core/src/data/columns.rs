//! Decides which column of a table holds which channel and in which unit, from the mapping of the
//! user, the headers and a row of units.

use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

use crate::data::spelling::{self, Meaning};
use crate::data::{
    Channel, ColumnMap, ColumnRef, ColumnSource, Contradiction, DataError, Formula,
    RESTRICTIONS_COLUMN, SignedColumn, Table, VelocityAxes, VelocityFit, clock, computed, letters,
};
use crate::units::{Quantity, Unit};

/// Number of sample values of a column that a mapping dialog shows.
const SHOWN_SAMPLES: usize = 5;

/// Number of columns without a channel that a remark names.
const SHOWN_IGNORED: usize = 100;

/// Components of one vector, or of one kind at all wheels, which have one unit.
const SIBLINGS: [&[Channel]; 8] = [
    &[Channel::Fx, Channel::Fy],
    &[Channel::FxBody, Channel::FyBody],
    &[Channel::X, Channel::Y],
    &[Channel::Vx, Channel::Vy],
    &[Channel::Ax, Channel::Ay],
    &[Channel::SteerFl, Channel::SteerFr],
    &[Channel::BrakeFl, Channel::BrakeFr, Channel::BrakeRl, Channel::BrakeRr],
    &[Channel::DriveFl, Channel::DriveFr, Channel::DriveRl, Channel::DriveRr],
];

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
    /// The columns that are added up; for most channels there is one, with its sign. A channel that
    /// is zero throughout has none.
    pub terms: Vec<Term>,
    /// What is computed from the terms instead of their sum.
    pub formula: Option<Formula>,
}

/// A column whose numbers are a part of a channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Term {
    /// The number of the column, counted from 1.
    pub number: usize,
    /// The sign with which its numbers count, 1 or −1.
    pub sign: f64,
    /// The unit of the numbers.
    pub unit: Unit,
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
    /// What the file says restricts its numbers: it was written by this program.
    Restrictions {
        /// The text of the column [`RESTRICTIONS_COLUMN`].
        text: String,
    },
    /// Text to the right of the last column was left out.
    TextBeyond {
        /// The number of rows with such text.
        n_rows: usize,
    },
    /// The two components of a vector are stated in different units.
    MixedUnits {
        /// The component along x.
        x: ColumnUse,
        /// The component along y.
        y: ColumnUse,
    },
    /// The velocities do not fit the path in the axes in which they were read.
    Velocities {
        /// How they fit.
        fit: VelocityFit,
        /// The axes in which they were read.
        read_as: VelocityAxes,
    },
    /// Columns of a motion contradict each other.
    Contradiction(Contradiction),
    /// The file is of a format of its own.
    Format {
        /// What it is and how it is read, in words.
        text: &'static str,
    },
    /// The record begins at another instant than zero.
    Begins {
        /// Its first instant, s.
        first_s: f64,
    },
}

impl Note {
    /// Whether numbers that were read may be wrong, so that the user should be asked.
    pub fn is_doubt(&self) -> bool {
        matches!(self, Self::UnitAssumed(_) | Self::MixedUnits { .. }) || self.is_contradiction()
    }

    /// Whether numbers that were read contradict each other, so that nothing can be made of them.
    pub fn is_contradiction(&self) -> bool {
        matches!(self, Self::Velocities { .. } | Self::Contradiction(_))
    }
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
            Self::MixedUnits { x, y } => write!(
                f,
                "column {} {:?} is read in {} and column {} {:?} in {}: two components of one \
                 vector are rarely recorded in different units; check the header",
                x.number, x.name, x.unit.symbol, y.number, y.name, y.unit.symbol
            ),
            Self::Restrictions { text } => write!(f, "the file says of itself: {text}"),
            Self::TextBeyond { n_rows } => {
                write!(f, "{n_rows} rows have text to the right of the last column; it is not read")
            }
            Self::Velocities { fit, read_as } => fit.explain(*read_as, f),
            Self::Contradiction(contradiction) => contradiction.fmt(f),
            Self::Format { text } => f.write_str(text),
            Self::Begins { first_s } => f.write_str(&clock::shift_text(*first_s)),
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

    /// The channel that is worth a proposal in a dialog: the guess, or what words in the header
    /// suggest, such as a force without a direction. The user has to look at it.
    pub fn suggestion(&self) -> Option<Channel> {
        let guessed = self.guess.map(|(channel, _)| channel);
        guessed.or_else(|| spelling::suggestion(&self.name))
    }
}

/// Reads a file and returns its columns, with the channel that each header suggests.
///
/// # Errors
/// [`DataError`] if the file cannot be read as a table.
pub fn propose_columns(path: &Path) -> Result<Vec<ColumnProposal>, DataError> {
    Ok(proposals(&Table::read(path)?))
}

/// The columns of a table, with the channel that each header suggests.
pub fn proposals(table: &Table) -> Vec<ColumnProposal> {
    let rows: Vec<_> = table.rows().take(SHOWN_SAMPLES).map(|(_, cells)| cells).collect();
    let columns = table.header().iter().zip(meanings(table)).enumerate();
    let proposal = |(column_idx, (name, meaning)): (usize, (&String, Meaning))| ColumnProposal {
        number: column_idx + 1,
        name: name.clone(),
        samples: rows.iter().filter_map(|cells| Some(cells.get(column_idx)?.to_string())).collect(),
        guess: match meaning {
            Meaning::Channel(channel, unit) => Some((channel, unit)),
            Meaning::WrongUnit(..) | Meaning::Unknown => None,
        },
        units_cell: table.unit_text(column_idx).map(str::to_owned),
    };
    columns.map(proposal).collect()
}

/// The mapping that accepts the suggested channel and unit of every column. Forces that several columns
/// hold are added up; any other channel that several columns may hold is left to be chosen.
pub fn map_from_proposals(proposals: &[ColumnProposal]) -> ColumnMap {
    let mut by_channel: BTreeMap<Channel, Vec<(usize, Option<Unit>)>> = BTreeMap::new();
    for proposal in proposals {
        if let Some((channel, unit)) = proposal.guess {
            by_channel.entry(channel).or_default().push((proposal.number, unit));
        }
    }
    let choice = |(channel, columns): (Channel, Vec<(usize, Option<Unit>)>)| match columns[..] {
        [(number, unit)] => {
            Some((channel, ColumnSource { column: ColumnRef::Number(number), unit }))
        }
        _ if is_summed(channel) => Some((channel, sum(&columns))),
        _ => None,
    };
    by_channel.into_iter().filter_map(choice).collect()
}

/// Whether several columns of a channel may be parts of one sum: what several contacts exert.
fn is_summed(channel: Channel) -> bool {
    matches!(channel.quantity(), Quantity::Force | Quantity::Moment)
}

/// The sum of columns with their units.
fn sum(columns: &[(usize, Option<Unit>)]) -> ColumnSource {
    let common = columns.first().and_then(|(_, unit)| *unit);
    let is_common = columns.iter().all(|(_, unit)| *unit == common);
    let term = |(number, unit): &(usize, Option<Unit>)| SignedColumn {
        number: *number,
        is_negated: false,
        unit: unit.filter(|_| !is_common),
    };
    let column = ColumnRef::Sum(columns.iter().map(term).collect());
    ColumnSource { column, unit: common.filter(|_| is_common) }
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
    /// [`DataError::AmbiguousColumn`] if two headers name the same channel, and
    /// [`DataError::Open`] if something else has to be said before the columns can be read.
    pub(crate) fn from_table(table: &Table, map: Option<&ColumnMap>) -> Result<Self, DataError> {
        let mut columns = Self::default();
        for (channel, source) in map.iter().flat_map(|map| map.iter()) {
            let column = mapped_column(table, channel, source)?;
            columns.by_channel.insert(channel, column);
        }
        columns.guess_others(table, map)?;
        columns.check_siblings(table, map)?;
        let assumed = columns.by_channel.values().filter(|column| !column.unit_is_stated);
        let assumed: Vec<Note> = assumed.cloned().map(Note::UnitAssumed).collect();
        columns.notes.splice(0..0, assumed);
        columns.notes.extend(columns.mixed_units());
        if let n_rows @ 1.. = table.n_rows_with_text_beyond() {
            columns.notes.push(Note::TextBeyond { n_rows });
        }
        Ok(columns)
    }

    /// Pairs of components that are read in different units. A channel that is zero has no unit.
    fn mixed_units(&self) -> Vec<Note> {
        let stated = |channel| {
            let column: &ColumnUse = self.by_channel.get(&channel)?;
            (column.unit_is_stated && !column.terms.is_empty()).then(|| column.clone())
        };
        let pair = |siblings: &&[Channel]| {
            let &[x, y] = *siblings else { return None };
            let (x, y) = stated(x).zip(stated(y))?;
            (x.unit != y.unit).then_some(Note::MixedUnits { x, y })
        };
        SIBLINGS.iter().filter_map(pair).collect()
    }

    /// Asks for a unit that the file states for one component of a vector and not for the other.
    fn check_siblings(&self, table: &Table, map: Option<&ColumnMap>) -> Result<(), DataError> {
        for siblings in SIBLINGS {
            let columns = || siblings.iter().filter_map(|channel| self.by_channel.get(channel));
            let is_stated = |column: &&ColumnUse| column.unit_is_stated && column.number > 0;
            let Some(stated) = columns().find(is_stated) else { continue };
            let is_open =
                |column: &&ColumnUse| !column.unit_is_stated && column.unit != stated.unit;
            if !columns().any(|column| is_open(&column)) {
                continue;
            }
            let open: Vec<&ColumnUse> = columns().filter(is_open).collect();
            let names: Vec<String> = open
                .iter()
                .map(|column| format!("column {} {:?}", column.number, column.name))
                .collect();
            let [symbol, si] = [stated.unit.symbol, open[0].unit.symbol];
            let what = format!(
                "column {} {:?} is in {symbol} and {} names no unit; say in which it is, {symbol} or {si}",
                stated.number,
                stated.name,
                names.join(", "),
            );
            let answers = open.iter().map(|column| {
                let column_ref = column.column_ref();
                (column.channel, ColumnSource { column: column_ref, unit: Some(stated.unit) })
            });
            return Err(open_question(table, map, what, answers));
        }
        Ok(())
    }

    fn guess_others(&mut self, table: &Table, map: Option<&ColumnMap>) -> Result<(), DataError> {
        let terms = self.by_channel.values().flat_map(|column| &column.terms);
        let mapped: Vec<usize> = terms.map(|term| term.number).collect();
        let is_mapped = |channel| map.is_some_and(|map| map.get(channel).is_some());
        let mut ignored = Vec::new();
        let mut found: BTreeMap<Channel, Vec<ColumnUse>> = BTreeMap::new();
        for ((column_idx, name), meaning) in table.header().iter().enumerate().zip(meanings(table))
        {
            let number = column_idx + 1;
            if mapped.contains(&number) {
                continue;
            }
            if name == RESTRICTIONS_COLUMN {
                let first = table.rows().next();
                let cell = first.and_then(|(_, cells)| Some(cells.get(column_idx)?.to_string()));
                let text = cell.filter(|text| !text.is_empty());
                self.notes.extend(text.map(|text| Note::Restrictions { text }));
                continue;
            }
            let name = name.clone();
            match meaning {
                Meaning::Channel(channel, unit) if !is_mapped(channel) => {
                    let column = column_use(channel, number, name, unit);
                    found.entry(channel).or_default().push(column);
                }
                Meaning::WrongUnit(channel, unit) if !is_mapped(channel) => {
                    self.notes.push(Note::WrongUnit { channel, number, name, unit });
                }
                _ => ignored.push((number, name)),
            }
        }
        if !is_mapped(Channel::Time)
            && let Some(time) = clock::two_columns(table)
        {
            let is_part = |number| time.terms.iter().any(|term| term.number == number);
            ignored.retain(|(number, _)| !is_part(*number));
            found.insert(Channel::Time, vec![time]);
        }
        for column in computed::columns(table) {
            if is_mapped(column.channel) || found.contains_key(&column.channel) {
                continue;
            }
            let is_part = |number| column.terms.iter().any(|term| term.number == number);
            ignored.retain(|(number, _)| !is_part(*number));
            found.insert(column.channel, vec![column]);
        }
        ignored.extend(same_again(table, &mut found));
        ignored.sort_unstable();
        self.check_repeated(table, map, &found)?;
        let single = found
            .into_iter()
            .filter_map(|(channel, columns)| Some((channel, columns.into_iter().next()?)));
        self.by_channel.extend(single);
        if !ignored.is_empty() {
            let names = ignored.into_iter().map(|(_, name)| name).collect();
            self.notes.push(Note::Ignored { names });
        }
        Ok(())
    }

    /// Asks which of several columns holds a channel, or whether they are added up.
    fn check_repeated(
        &self,
        table: &Table,
        map: Option<&ColumnMap>,
        found: &BTreeMap<Channel, Vec<ColumnUse>>,
    ) -> Result<(), DataError> {
        let repeated = || found.iter().filter(|(_, columns)| columns.len() > 1);
        if let Some([first, second, ..]) = found.get(&Channel::Time).map(Vec::as_slice) {
            let what = format!(
                "columns {} and {} are two times that differ: bring all columns to one time, or say \
                 which of them is that of all",
                first.number, second.number
            );
            let answer = (Channel::Time, first.source());
            return Err(open_question(table, map, what, [answer]));
        }
        let is_one_name = |columns: &[ColumnUse]| {
            let mut stems = columns.iter().map(|column| spelling::stem(&column.name));
            let first = stems.next();
            stems.all(|stem| Some(stem) == first)
        };
        for (channel, columns) in repeated() {
            if !is_summed(*channel) || !is_one_name(columns) {
                let [first, second, ..] = columns.as_slice() else { continue };
                return Err(ambiguous(table, second.clone(), first));
            }
        }
        let Some((_, columns)) = repeated().next() else { return Ok(()) };
        let numbers: Vec<String> = columns.iter().map(|column| column.number.to_string()).collect();
        let what = format!(
            "columns {} are all called {:?}; if they are the forces of several contacts, they are added \
             up, otherwise choose one",
            numbers.join(" and "),
            columns[0].name
        );
        let answers = repeated().map(|(channel, columns)| {
            let stated = |column: &ColumnUse| column.unit_is_stated.then_some(column.unit);
            let terms: Vec<_> =
                columns.iter().map(|column| (column.number, stated(column))).collect();
            (*channel, sum(&terms))
        });
        Err(open_question(table, map, what, answers))
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
            Note::WrongUnit { channel: wrong, number, name, unit } if *wrong == channel => {
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

fn column_use(channel: Channel, number: usize, name: String, stated: Option<Unit>) -> ColumnUse {
    let unit = stated.unwrap_or_else(|| channel.quantity().si_unit());
    let terms = vec![Term { number, sign: 1.0, unit }];
    let unit_is_stated = stated.is_some();
    ColumnUse { channel, number, name, unit, unit_is_stated, terms, formula: None }
}

impl ColumnUse {
    /// The column as a map names it.
    fn column_ref(&self) -> ColumnRef {
        match self.terms[..] {
            [Term { number, sign, .. }] if sign > 0.0 => ColumnRef::Number(number),
            _ => {
                let term = |term: &Term| SignedColumn {
                    number: term.number,
                    is_negated: term.sign < 0.0,
                    unit: None,
                };
                ColumnRef::Sum(self.terms.iter().map(term).collect())
            }
        }
    }

    /// The column with its unit, if it is stated, as a map names it.
    pub(super) fn source(&self) -> ColumnSource {
        let unit = self.unit_is_stated.then_some(self.unit);
        ColumnSource { column: self.column_ref(), unit }
    }
}

/// Takes out of the columns of each channel those that have the numbers of the first, and returns their
/// numbers and names.
fn same_again(
    table: &Table,
    found: &mut BTreeMap<Channel, Vec<ColumnUse>>,
) -> Vec<(usize, String)> {
    let mut left_out = Vec::new();
    for columns in found.values_mut().filter(|columns| columns.len() > 1) {
        let first = columns[0].clone();
        // Two contacts whose forces are both zero are the same too, whatever is made of them.
        columns.retain(|column| {
            let is_kept = column.number == first.number || !has_same_numbers(table, &first, column);
            if !is_kept {
                left_out.push((column.number, column.name.clone()));
            }
            is_kept
        });
    }
    left_out
}

fn has_same_numbers(table: &Table, first: &ColumnUse, second: &ColumnUse) -> bool {
    if is_summed(first.channel) {
        return false;
    }
    let value = |row_idx, column: &ColumnUse| {
        let number = table.number(row_idx, column.number.checked_sub(1)?)?;
        Some(column.unit.to_si(number))
    };
    (0..table.n_rows()).all(|row_idx| match (value(row_idx, first), value(row_idx, second)) {
        (Some(a), Some(b)) => (a - b).abs() <= 1e-9 * a.abs().max(1e-3),
        _ => false,
    })
}

/// The error for something that has to be said before a file can be read.
///
/// - `map`: what the user has said;
/// - `answers`: what would answer the question, in addition.
pub(super) fn open_question(
    table: &Table,
    map: Option<&ColumnMap>,
    what: String,
    answers: impl IntoIterator<Item = (Channel, ColumnSource)>,
) -> DataError {
    let mut map = map.cloned().unwrap_or_default();
    answers.into_iter().for_each(|(channel, source)| map.insert(channel, source));
    DataError::Open {
        path: table.path().to_owned(),
        line: table.header_line(),
        what,
        map: Box::new(map),
    }
}

/// The channel and unit of every column.
fn meanings(table: &Table) -> Vec<Meaning> {
    let letters = letters::channels(table.header());
    let columns = letters.into_iter().enumerate();
    let meaning = |(column_idx, letter): (usize, Option<Option<Channel>>)| match letter {
        None => column_meaning(table, column_idx),
        Some(None) => Meaning::Unknown,
        Some(Some(channel)) => {
            let name = table.header().get(column_idx).map_or("", String::as_str);
            match stated_unit(name, table.unit_text(column_idx), channel.quantity()) {
                Ok(unit) => Meaning::Channel(channel, unit),
                Err(text) => Meaning::WrongUnit(channel, text),
            }
        }
    };
    columns.map(meaning).collect()
}

/// The channel and unit that the header of a column names, with the unit from the row of units if
/// the header has none.
fn column_meaning(table: &Table, column_idx: usize) -> Meaning {
    let name = table.header().get(column_idx).map_or("", String::as_str);
    let meaning = match spelling::meaning(name) {
        Meaning::Unknown => spelling::numbered_force(name).unwrap_or(Meaning::Unknown),
        meaning => meaning,
    };
    match (meaning, table.unit_text(column_idx)) {
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

/// The unit that the file states for a column, in the row of units or in the header. The error is
/// the text of a unit that does not measure `quantity`.
fn stated_unit(
    name: &str,
    units_cell: Option<&str>,
    quantity: Quantity,
) -> Result<Option<Unit>, String> {
    if let Some(text) = units_cell {
        return match spelling::unit(quantity, text) {
            Some(unit) => Ok(Some(unit)),
            None => Err(text.to_owned()),
        };
    }
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
