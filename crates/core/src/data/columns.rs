//! Decides which column of a table holds which channel and in which unit, from the mapping of the
//! user, the headers and a row of units.

use std::collections::BTreeMap;

use crate::data::mapped_column::mapped_column;
use crate::data::si_values::compass_quantity;
use crate::data::spelling::{self, Meaning};
use crate::data::{
    Channel, ColumnMap, ColumnRef, ColumnSource, DataError, Formula, Note, RESTRICTIONS_COLUMN,
    RecordedSide, SignedColumn, Table, computed, letters, stated_side, time_columns,
};
use crate::units::{Quantity, Unit};

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

/// Whether several columns of a channel may be parts of one sum: what several contacts exert.
pub(super) fn is_summed(channel: Channel) -> bool {
    matches!(channel.quantity(), Quantity::Force | Quantity::Moment)
}

/// The sum of columns with their units.
pub(super) fn sum(columns: &[(usize, Option<Unit>)]) -> ColumnSource {
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
#[derive(Debug, Clone, Default)]
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
        let is_assumed =
            |column: &&ColumnUse| !column.unit_is_stated && !time_columns::is_of_day(table, column);
        let assumed = columns.by_channel.values().filter(is_assumed);
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
                    let mut column = column_use(channel, number, name, unit);
                    self.notes.extend(column.turn_by_side(map));
                    found.entry(channel).or_default().push(column);
                }
                Meaning::WrongUnit(channel, unit) if !is_mapped(channel) => {
                    self.notes.push(Note::WrongUnit { channel, number, name, unit });
                }
                _ => ignored.push((number, name)),
            }
        }
        let has_time = found.contains_key(&Channel::Time);
        if !is_mapped(Channel::Time)
            && let Some((time, note)) = time_columns::found(table, has_time)
        {
            let is_part = |number| time.terms.iter().any(|term| term.number == number);
            ignored.retain(|(number, _)| !is_part(*number));
            let is_read =
                |note: &Note| matches!(note, Note::WrongUnit { number, .. } if is_part(*number));
            self.notes.retain(|note| !is_read(note));
            self.notes.extend(note);
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
                found: table.found_columns(),
            },
        }
    }
}

pub(super) fn column_use(
    channel: Channel,
    number: usize,
    name: String,
    stated: Option<Unit>,
) -> ColumnUse {
    let unit = stated.unwrap_or_else(|| channel.quantity().si_unit());
    let terms = vec![Term { number, sign: 1.0, unit }];
    let unit_is_stated = stated.is_some();
    ColumnUse { channel, number, name, unit, unit_is_stated, terms, formula: None }
}

impl ColumnUse {
    /// Gives the numbers the sign that brings them to this program's side, if the header says to which they are positive,
    /// and says so.
    fn turn_by_side(&mut self, map: Option<&ColumnMap>) -> Option<Note> {
        let side = stated_side::side_of(&self.name, self.channel)?;
        let settings = map.map(|map| &map.settings);
        let is_heading = compass_quantity(self.channel).is_some();
        // What the map turns of all columns is not turned twice.
        let is_turned = settings.is_some_and(|settings| settings.y_to_right)
            != settings.is_some_and(|settings| settings.compass_headings && is_heading);
        if (side == RecordedSide::Right) != is_turned {
            self.terms.iter_mut().for_each(|term| term.sign = -1.0);
        }
        let (number, side) = (self.number, side.word());
        let text = format!("column {number} {:?} is positive to the {side}, as it says", self.name);
        Some(Note::Format { text })
    }

    /// The column as a map names it, with the units of its terms where these differ.
    fn column_ref(&self) -> ColumnRef {
        let numbers = || self.terms.iter().map(|term| term.number).collect();
        let is_common = self.has_one_unit();
        match (self.formula, &self.terms[..]) {
            (Some(formula), _) => ColumnRef::Computed(formula, numbers()),
            (None, []) => ColumnRef::Zero,
            (None, [Term { number, sign, .. }]) if *sign > 0.0 => ColumnRef::Number(*number),
            (None, terms) => {
                let term = |term: &Term| SignedColumn {
                    number: term.number,
                    is_negated: term.sign < 0.0,
                    unit: (!is_common).then_some(term.unit),
                };
                ColumnRef::Sum(terms.iter().map(term).collect())
            }
        }
    }

    fn has_one_unit(&self) -> bool {
        self.terms.iter().all(|term| term.unit == self.unit)
    }

    /// The column with its unit, if it is stated, as a map names it.
    pub(super) fn source(&self) -> ColumnSource {
        let has_unit = self.unit_is_stated && self.formula.is_none() && !self.terms.is_empty();
        let unit = (has_unit && self.has_one_unit()).then_some(self.unit);
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
pub(super) fn meanings(table: &Table) -> Vec<Meaning> {
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
/// the header has none. Where both say one and they differ, it is none that is known.
fn column_meaning(table: &Table, column_idx: usize) -> Meaning {
    let name = table.header().get(column_idx).map_or("", String::as_str);
    let bare = stated_side::bare_header(name);
    let name = bare.as_deref().unwrap_or(name);
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
        (Meaning::Channel(channel, Some(in_header)), Some(text)) => {
            match spelling::unit(channel.quantity(), text) {
                Some(unit) if unit != in_header => {
                    Meaning::WrongUnit(channel, both_units(in_header, unit))
                }
                _ => Meaning::Channel(channel, Some(in_header)),
            }
        }
        (meaning, _) => meaning,
    }
}

/// Two units that a file states for one column.
fn both_units(in_header: Unit, in_row: Unit) -> String {
    format!("{} by its header and {} by the row of units", in_header.symbol, in_row.symbol)
}

/// The unit that the file states for a column, in the row of units or in the header. The error is
/// the text of a unit that does not measure `quantity`, or of both where they differ.
pub(super) fn stated_unit(
    name: &str,
    units_cell: Option<&str>,
    quantity: Quantity,
) -> Result<Option<Unit>, String> {
    let in_header = spelling::trailing_unit(name, quantity);
    let Some(text) = units_cell else { return in_header };
    match (spelling::unit(quantity, text), in_header) {
        (None, _) => Err(text.to_owned()),
        (Some(unit), Ok(Some(in_header))) if unit != in_header => Err(both_units(in_header, unit)),
        (Some(unit), _) => Ok(Some(unit)),
    }
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
