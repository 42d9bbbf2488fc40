//! The errors of reading and writing files. Their texts start with the place as `file:line:column`,
//! with line and column counted from 1, as far as it is known.
//!
//! The file is long because it is a list: one variant for each way in which a file can be wrong, with its
//! text beside its values, so that all texts can be read in one place.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use crate::data::write::WriteError;
use crate::data::{Channel, ColumnMap, Correction, SeriesError, spelling};
use crate::ranges::{OutOfRange, Range};
use crate::units::Quantity;

/// The reason why a file could not be read or written.
#[derive(Debug, thiserror::Error)]
pub enum DataError {
    /// The operating system reports an error other than a missing file or a folder.
    #[error("{}: cannot be read or written", path.display())]
    Io {
        /// The file or folder that was to be read or written.
        path: PathBuf,
        /// The error that the operating system reports.
        source: io::Error,
    },
    /// A file or folder is not written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// There is no file or folder at the path.
    #[error("{}: does not exist; check the name", path.display())]
    NotFound {
        /// The path as it was given.
        path: PathBuf,
    },
    /// The path leads to a folder where a file was expected.
    #[error("{}: is a folder, expected a file", path.display())]
    IsDirectory {
        /// The folder.
        path: PathBuf,
    },
    /// The path leads to a pipe, a socket or a device where a file was expected.
    #[error("{}: is {kind}, expected a file", path.display())]
    NotRegular {
        /// The path as it was given.
        path: PathBuf,
        /// The kind of the file, in words.
        kind: &'static str,
    },
    /// A folder has more entries than are listed.
    #[error("{}: has more than {limit} entries; is it the right folder?", path.display())]
    TooManyEntries {
        /// The folder.
        path: PathBuf,
        /// The largest number of entries.
        limit: usize,
    },
    /// The file has no bytes, or only blank lines and comments.
    #[error("{}: is empty, expected a header line and rows of numbers", path.display())]
    Empty {
        /// The file that was read or written.
        path: PathBuf,
    },
    /// The file is larger than the largest size that is read.
    #[error("{}: has {bytes} bytes, at most {limit} are read; split it or thin it out", path.display())]
    TooLarge {
        /// The file that was read or written.
        path: PathBuf,
        /// The size of the file, bytes.
        bytes: u64,
        /// The largest size that is read, bytes.
        limit: u64,
    },
    /// A line is longer than any that is read.
    #[error("{}:{line}: the line has {bytes} bytes, at most {limit} are read; is it the right file?", path.display())]
    LongLine {
        /// The file that was read or written.
        path: PathBuf,
        /// The line.
        line: u64,
        /// Its length, bytes.
        bytes: usize,
        /// The largest length that is read, bytes.
        limit: usize,
    },
    /// A cell is longer than any that is read.
    #[error("{}:{line}:{column}: the cell has {bytes} bytes, at most {limit} are read; shorten it", path.display())]
    LongCell {
        /// The file that was read or written.
        path: PathBuf,
        /// Line of the cell.
        line: u64,
        /// Number of the column.
        column: usize,
        /// The length of the cell, bytes.
        bytes: usize,
        /// The largest length that is read, bytes.
        limit: usize,
    },
    /// A line has more fields than a table has columns at most.
    #[error("{}:{line}: has {got} columns, at most {limit} are read; remove some", path.display())]
    TooManyColumns {
        /// The file that was read or written.
        path: PathBuf,
        /// The line.
        line: u64,
        /// Number of its fields.
        got: usize,
        /// The largest number of columns.
        limit: usize,
    },
    /// A table of cases has more rows than are read, or more cells.
    #[error("{}: has {got} {what}, at most {limit} are read; split the data set", path.display())]
    TooManyCases {
        /// Path of the table of cases.
        path: PathBuf,
        /// Cases, or cells.
        what: &'static str,
        /// Their number in the table.
        got: usize,
        /// The largest number that is read.
        limit: usize,
    },
    /// The file is of a known format that is not read.
    #[error("{}: is {format}; {remedy}", path.display())]
    OtherFormat {
        /// The file.
        path: PathBuf,
        /// What it is, in words.
        format: &'static str,
        /// What to do, in words.
        remedy: &'static str,
    },
    /// Nothing of a record of an event data recorder can be used.
    #[error("{}: is no record of an event data recorder that can be used{}; it has columns such as Time [s], Speed [km/h], Steering Wheel Angle [deg], Delta-V, Longitudinal [km/h], with times that increase",
        path.display(), in_brackets(doubts))]
    NoRecord {
        /// The file.
        path: PathBuf,
        /// What is wrong with what was found; none if nothing was.
        doubts: Vec<String>,
    },
    /// A workbook is damaged, or protected by a password.
    #[error("{}: the workbook cannot be read ({why}); save it again as .xlsx or as CSV", path.display())]
    Workbook {
        /// The file.
        path: PathBuf,
        /// The reason, in words of the library that reads it.
        why: String,
    },
    /// A file of a format of its own is damaged.
    #[error("{}: {format} cannot be read ({why}); write it again, or export it as CSV", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What it is, within a sentence.
        format: &'static str,
        /// The reason, in words of the library that reads it.
        why: String,
    },
    /// A file of another program does not follow its format.
    #[error("{}{place}: {why}", path.display())]
    DamagedAt {
        /// The file.
        path: PathBuf,
        /// Where it does not.
        place: Place,
        /// What is wrong, in words.
        why: String,
    },
    /// A workbook has no such sheet, or the file is no workbook.
    #[error("{}: there is no sheet {}; found {}", path.display(), quoted(wanted), list(found))]
    NoSheet {
        /// The file.
        path: PathBuf,
        /// Name or number of the sheet.
        wanted: String,
        /// The names of all sheets; none if the file is no workbook.
        found: Vec<String>,
    },
    /// An error in a sheet of a workbook.
    #[error("{}", in_sheet(path, sheet, error))]
    InSheet {
        /// The workbook.
        path: PathBuf,
        /// The name of the sheet.
        sheet: String,
        /// The error, whose line and column are those of the sheet.
        error: Box<DataError>,
    },
    /// An error in a file whose map is given by an option of its own.
    #[error("{}", error.to_string().replace("--map ", &format!("{option} ")))]
    OfOption {
        /// The option with its dashes, such as `--steer-map`.
        option: &'static str,
        /// The error.
        error: Box<DataError>,
    },
    /// The file contains control characters that do not occur in text.
    #[error("{}: is not text (byte {byte:#04x} at offset {offset}); export it as CSV", path.display())]
    NotText {
        /// The file that was read or written.
        path: PathBuf,
        /// Offset of the first such byte, counted from 0.
        offset: usize,
        /// The byte at this offset.
        byte: u8,
    },
    /// No line above the numbers names the columns, and no mapping was given.
    #[error("{}:{line}: no header line names the columns; say which is which, e.g. --map {example}, or in the mapping dialog", path.display())]
    NoHeader {
        /// The file that was read or written.
        path: PathBuf,
        /// Line of the first row of numbers.
        line: u64,
        /// An example of a mapping, in the syntax of `--map`.
        example: &'static str,
    },
    /// No column holds a channel that is needed.
    #[error("{}:{line}: no column for {needed}; found {}; say which it is, e.g. --map {}=COLUMN, or in the mapping dialog{}",
        path.display(), list(found), channel.short_name(), or_recorder(found))]
    MissingColumn {
        /// The file that was read or written.
        path: PathBuf,
        /// Line of the header.
        line: u64,
        /// The first missing channel.
        channel: Channel,
        /// All channels that are needed, with their alternatives, in words.
        needed: &'static str,
        /// The headers of all columns.
        found: Vec<String>,
    },
    /// The mapping of the user names a column that the file does not have.
    #[error("{}:{line}: the mapping takes {} from column {column}, which is not in the file; found {}",
        path.display(), channel.short_name(), list(found))]
    NoSuchColumn {
        /// The file that was read or written.
        path: PathBuf,
        /// Line of the header.
        line: u64,
        /// The channel that is mapped.
        channel: Channel,
        /// Number or header of the column as the mapping states it.
        column: String,
        /// The headers of all columns.
        found: Vec<String>,
    },
    /// The headers of two columns name the same channel.
    #[error("{}:{line}:{column}: {name} and {other} in column {other_column} both look like {1}; choose one, e.g. --map {1}={other_column}, or in the mapping dialog",
        path.display(), channel.short_name(), name = quoted(name), other = quoted(other))]
    AmbiguousColumn {
        /// The file that was read or written.
        path: PathBuf,
        /// Line of the header.
        line: u64,
        /// Number of the later column.
        column: usize,
        /// The channel that both headers name.
        channel: Channel,
        /// Header of the later column.
        name: String,
        /// Number of the earlier column.
        other_column: usize,
        /// Header of the earlier column.
        other: String,
    },
    /// Something has to be said before the file can be read.
    #[error("{}:{line}: {what}; e.g. --map \"{map}\", or in the mapping dialog", path.display())]
    Open {
        /// The file that was read.
        path: PathBuf,
        /// Line of the header.
        line: u64,
        /// What is open, in words.
        what: String,
        /// A mapping that answers it.
        map: Box<ColumnMap>,
    },
    /// A number may mean two things, since its mark may be a decimal sign or stand between thousands.
    #[error("{}:{line}:{column}: {} is {}, with a decimal sign or with thousands, and nothing in the file says which; --map \"{}\" or --map \"{}\", or in the mapping dialog",
        path.display(), quoted(name), quoted(text), maps[0], maps[1])]
    AmbiguousNumber {
        /// The file that was read.
        path: PathBuf,
        /// Line of the number.
        line: u64,
        /// Number of its column.
        column: usize,
        /// Header of the column.
        name: String,
        /// The number, as written in the file.
        text: String,
        /// Mappings that read a decimal sign, and thousands.
        maps: Box<[ColumnMap; 2]>,
    },
    /// The unit of a column does not measure the channel that the column holds.
    #[error("{}:{line}:{column}: {name} is in {unit}, expected a unit of {} ({}); correct the header or map the column with its unit, e.g. --map {}={column}:{}",
        path.display(), spelling::quantity_name(*quantity), spelling::symbols(*quantity), channel.short_name(), quantity.si_unit().symbol, name = quoted(name), unit = quoted(unit))]
    UnknownUnit {
        /// The file that was read or written.
        path: PathBuf,
        /// Line of the header.
        line: u64,
        /// Number of the column.
        column: usize,
        /// Header of the column.
        name: String,
        /// The channel that the header or the mapping names.
        channel: Channel,
        /// The unit as written in the file.
        unit: String,
        /// The quantity that the channel measures.
        quantity: Quantity,
    },
    /// A cell does not hold a number, or not such a one.
    #[error("{}:{line}:{column}: {name} is {text}, expected {expected}", path.display(), name = quoted(name), text = quoted(text))]
    Cell {
        /// The file that was read or written.
        path: PathBuf,
        /// Line of the cell.
        line: u64,
        /// Number of the column.
        column: usize,
        /// Header of the column.
        name: String,
        /// The text of the cell.
        text: String,
        /// What is expected, in words.
        expected: Box<str>,
    },
    /// The line that is to hold the header or the units is blank, or too far down.
    #[error("{}:{line}: nothing is found here, expected {what} in one of the first lines", path.display())]
    NoSuchLine {
        /// The file that was read.
        path: PathBuf,
        /// The line.
        line: u64,
        /// What it is to hold, in words.
        what: &'static str,
    },
    /// A row has more or fewer fields than the header.
    #[error("{}:{line}: has {got} fields, the header has {expected}; complete the row or remove it{hint}", path.display())]
    RaggedRow {
        /// The file that was read or written.
        path: PathBuf,
        /// Line of the row.
        line: u64,
        /// Number of fields in the header.
        expected: usize,
        /// Number of fields in the row.
        got: usize,
        /// What else helps, of fields between blanks; empty for others.
        hint: &'static str,
    },
    /// There are too few rows for a time series.
    #[error("{}:{line}: rows of numbers below the header: {got}, expected at least {expected}", path.display())]
    TooFewRows {
        /// The file that was read or written.
        path: PathBuf,
        /// Line of the header.
        line: u64,
        /// Smallest number of rows of a time series.
        expected: usize,
        /// Number of rows in the file.
        got: usize,
    },
    /// Columns of a motion contradict each other.
    #[error("{}: {what}", path.display())]
    Contradiction {
        /// The file that was read.
        path: PathBuf,
        /// What contradicts what, and what would mend it.
        what: String,
    },
    /// The time of a row is not later than that of the row before it.
    #[error("{}:{line}:{column}: time is {after_s} s after {before_s} s in the row before, expected a later time; sort the rows and remove doubles{}", path.display(), or_go_on(*before_s, *after_s))]
    TimeOrder {
        /// The file that was read or written.
        path: PathBuf,
        /// Line of the row that is not later.
        line: u64,
        /// Number of the time column.
        column: usize,
        /// Time in the row before, s.
        before_s: f64,
        /// Time in this row, s.
        after_s: f64,
    },
    /// Two samples follow each other faster than any instrument or simulation records, or after a
    /// gap longer than any record.
    #[error("{}:{line}:{column}: {}; check the times and the unit of the column", path.display(), step)]
    TimeStep {
        /// The file that was read or written.
        path: PathBuf,
        /// Line of the later sample.
        line: u64,
        /// Number of the time column.
        column: usize,
        /// The step and its range.
        step: OutOfRange,
    },
    /// A value is beyond what a vehicle reaches, so that its unit is probably wrong.
    #[error("{}:{line}:{column}: {} is {}, expected {}; check the unit of the column", path.display(), quoted(name), range.shown(*value), range.explained())]
    ImplausibleValue {
        /// The file that was read or written.
        path: PathBuf,
        /// Line of the cell.
        line: u64,
        /// Number of the column.
        column: usize,
        /// Header of the column.
        name: String,
        /// The value, SI units.
        value: f64,
        /// The values that are accepted.
        range: Box<Range>,
    },
    /// The columns do not form a time series. When a file is read, a wrong order of time is
    /// reported as [`DataError::TimeOrder`] instead.
    #[error("{}: is not a time series", path.display())]
    Series {
        /// The file that was read or written.
        path: PathBuf,
        /// The reason why the columns do not form a time series.
        source: SeriesError,
    },
    /// A table of cases lacks a column.
    #[error("{}:{line}: {name:?} is missing; add it, without it {consequence}", path.display())]
    MissingAttribute {
        /// Path of the table of cases.
        path: PathBuf,
        /// Line of the header, or of the case that is asked about.
        line: u64,
        /// Name of the column.
        name: String,
        /// What cannot be computed without it, in words.
        consequence: &'static str,
    },
    /// A cell of the table of cases is blank though the physics needs it, or holds text or a number
    /// out of range.
    #[error("{}:{line}:{column}: {name} is {got}, expected {expected}", path.display(), name = quoted(name))]
    Attribute {
        /// Path of the table of cases.
        path: PathBuf,
        /// Line of the case.
        line: u64,
        /// Number of the column.
        column: usize,
        /// Name of the column.
        name: String,
        /// What the cell holds, in words.
        got: String,
        /// The range, and what the number means, in words.
        expected: String,
    },
    /// Two rows of the table of cases have the same case name.
    #[error("{}:{line}:{column}: case {case} stands in line {first_line} already; rename or remove one", path.display(), case = quoted(case))]
    DuplicateCase {
        /// Path of the table of cases.
        path: PathBuf,
        /// Line of the later row.
        line: u64,
        /// Number of the column `case`.
        column: usize,
        /// Name of the case.
        case: String,
        /// Line of the earlier row.
        first_line: u64,
    },
    /// The name of a case cannot be the name of a file.
    #[error("{}:{line}:{column}: case {case} cannot name a file; use letters, digits, blanks and -_.+()", path.display(), case = quoted(case))]
    CaseName {
        /// Path of the table of cases.
        path: PathBuf,
        /// Line of the row.
        line: u64,
        /// Number of the column `case`.
        column: usize,
        /// Name of the case.
        case: String,
    },
    /// Two files are named after the same case, such as `c001.csv` and `c001.CSV`.
    #[error("{}: is there beside {}; keep the file that belongs to the case", path.display(), other.display())]
    TwoFilesOfCase {
        /// Path of one file.
        path: PathBuf,
        /// Path of the other file.
        other: PathBuf,
    },
    /// The table of cases has a row whose file does not exist.
    #[error("{}:{line}:{column}: case {case} has no file {}; add the file or remove the row", path.display(), file.display(), case = quoted(case))]
    CaseWithoutFile {
        /// Path of the table of cases.
        path: PathBuf,
        /// Line of the row.
        line: u64,
        /// Number of the column `case`.
        column: usize,
        /// Name of the case.
        case: String,
        /// The path at which the file was expected.
        file: PathBuf,
    },
    /// The folder has a file without a row in the table of cases.
    #[error("{}: has no row in {}; add the row or remove the file", path.display(), table.display())]
    FileWithoutCase {
        /// The file without a row.
        path: PathBuf,
        /// Path of the table of cases.
        table: PathBuf,
    },
    /// A folder or file that is of none of the kinds that can be opened.
    #[error("{}: is neither a data set (a folder with cases.csv and forces/ or trajectories/), nor a folder of data sets, nor a force, trajectory or steer file", path.display())]
    NotRecognised {
        /// The path as it was given.
        path: PathBuf,
    },
}

/// A place in a file of another program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// The file as a whole.
    Whole,
    /// A line, counted from 1.
    Line(u64),
    /// A byte, counted from 0.
    Byte(u64),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Whole => Ok(()),
            Self::Line(line) => write!(f, ":{line}"),
            Self::Byte(byte) => write!(f, ": at byte {byte}"),
        }
    }
}

impl DataError {
    /// The same error where the map of the file is given by another option than `--map`.
    ///
    /// - `option`: with its dashes.
    pub fn of_option(self, option: &'static str) -> Self {
        Self::OfOption { option, error: Box::new(self) }
    }

    /// A mapping that answers what is open about a file.
    pub fn answer(&self) -> Option<&ColumnMap> {
        match self {
            Self::InSheet { error, .. } | Self::OfOption { error, .. } => error.answer(),
            Self::Open { map, .. } => Some(map),
            Self::AmbiguousNumber { maps, .. } => Some(&maps[0]),
            _ => None,
        }
    }

    /// The changes of a map of which each answers what is open about a file.
    ///
    /// - `map`: the map with which it was read.
    pub fn corrections(&self, map: Option<&ColumnMap>) -> Vec<Correction> {
        let answers: Vec<&ColumnMap> = match self {
            Self::InSheet { error, .. } | Self::OfOption { error, .. } => {
                return error.corrections(map);
            }
            Self::AmbiguousNumber { maps, .. } => maps.iter().collect(),
            _ => self.answer().into_iter().collect(),
        };
        answers.into_iter().filter_map(|answer| Correction::from_answer(map, answer)).collect()
    }

    /// Whether a cell is blank that should hold a number.
    pub(super) fn is_of_blank_cell(&self) -> bool {
        matches!(self, Self::Cell { text, .. } if text.is_empty())
    }

    /// Whether a mapping of columns to channels and units by the user may solve the problem.
    pub fn needs_mapping(&self) -> bool {
        if let Self::InSheet { error, .. } | Self::OfOption { error, .. } = self {
            return error.needs_mapping();
        }
        matches!(
            self,
            Self::NoHeader { .. }
                | Self::MissingColumn { .. }
                | Self::AmbiguousColumn { .. }
                | Self::Open { .. }
                | Self::AmbiguousNumber { .. }
                | Self::UnknownUnit { .. }
                | Self::ImplausibleValue { .. }
                | Self::NoSuchLine { .. }
        )
    }

    /// Converts an error of the operating system at `path`: a missing file and a folder have
    /// variants of their own.
    pub fn io(path: &Path, source: io::Error) -> Self {
        let path = path.to_owned();
        match source.kind() {
            io::ErrorKind::NotFound => Self::NotFound { path },
            io::ErrorKind::IsADirectory => Self::IsDirectory { path },
            _ => Self::Io { path, source },
        }
    }
}

/// What helps where a time goes back, as that of a clock that begins again.
fn or_go_on(before_s: f64, after_s: f64) -> &'static str {
    if after_s < before_s { ", or let a clock go on that begins again there" } else { "" }
}

/// What a recorder keeps of a driver beside the speed.
const OF_DRIVER: [&str; 6] = ["brake", "brems", "accelerator", "throttle", "steering", "lenkrad"];

/// What helps where columns may be those of a recorder: a change of velocity, which no channel is, or the speed beside
/// what the driver did, without places, which a log has.
pub(super) fn or_recorder(found: &[String]) -> &'static str {
    let keys: Vec<String> = found.iter().map(|name| spelling::letters_and_digits(name)).collect();
    let has = |words: &[&str]| keys.iter().any(|key| words.iter().any(|word| key.contains(word)));
    let is_place = |name: &String| {
        matches!(spelling::meaning(name), spelling::Meaning::Channel(Channel::X | Channel::Y, _))
    };
    let is_log = has(&["latitude", "longitude"]) || found.iter().any(is_place);
    let is_of_recorder = keys.iter().any(|key| spelling::is_delta_v(key))
        || has(&["speed", "geschwindigkeit"]) && has(&OF_DRIVER) && !is_log;
    match is_of_recorder {
        true => "; a table of an event data recorder is read by: impactlab import --recorder",
        false => "",
    }
}

/// The text of an error in a sheet: instead of `file:line:column`, it names file, sheet and cell.
fn in_sheet(path: &Path, sheet: &str, error: &DataError) -> String {
    let (text, file) = (error.to_string(), path.display().to_string());
    let Some(rest) = text.strip_prefix(&file).and_then(|rest| rest.strip_prefix(':')) else {
        return format!("{file}, sheet {}: {text}", quoted(sheet));
    };
    let number = |text: &str| text.parse::<usize>().ok();
    let mut parts = rest.splitn(3, ':');
    let [first, second, third] = [parts.next(), parts.next(), parts.next()];
    let row = first.and_then(number);
    let place = match (row, second.and_then(number), second, third) {
        (Some(row), Some(column), _, Some(text)) => {
            format!(", cell {}{row}:{text}", column_letters(column))
        }
        (Some(row), None, Some(text), third) => {
            let rest = third.map(|text| format!(":{text}")).unwrap_or_default();
            format!(", row {row}:{text}{rest}")
        }
        _ => format!(":{rest}"),
    };
    format!("{file}, sheet {}{place}", quoted(sheet))
}

/// The letters by which a spreadsheet names a column, such as `AB` for 28.
fn column_letters(mut number: usize) -> String {
    let mut letters = Vec::new();
    while number > 0 {
        number -= 1;
        letters.push(char::from(b'A' + (number % 26) as u8));
        number /= 26;
    }
    letters.iter().rev().collect()
}

/// Number of names that a message lists; of further names it states the count.
const LISTED: usize = 12;

/// Number of sentences that a message has in brackets.
const SENTENCES: usize = 4;

/// The first sentences of several, after the end of another one.
fn in_brackets(sentences: &[String]) -> String {
    match sentences.get(..SENTENCES).unwrap_or(sentences) {
        [] => String::new(),
        first => format!(" ({})", first.join("; ")),
    }
}

fn list(names: &[String]) -> String {
    if names.is_empty() {
        return "nothing".to_owned();
    }
    let mut text: Vec<String> = names.iter().take(LISTED).map(|name| quoted(name)).collect();
    if names.len() > LISTED {
        text.push(format!("{} more", names.len() - LISTED));
    }
    text.join(", ")
}

/// Number of characters of a name or a text from a file that a message quotes.
const QUOTED_CHARS: usize = 60;

/// A text in quotation marks, with its control characters escaped; a long one is cut.
pub(crate) fn quoted(text: &str) -> String {
    match text.char_indices().nth(QUOTED_CHARS) {
        None => format!("{text:?}"),
        Some((at, _)) => format!("{:?}…", text.get(..at).unwrap_or_default()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_in_a_sheet_names_the_cell() {
        let path = PathBuf::from("a:b/test.xlsx");
        let cell = DataError::Cell {
            path: path.clone(),
            line: 12,
            column: 28,
            name: "Kraft: X".to_owned(),
            text: "n/a".to_owned(),
            expected: "a finite number in kN".into(),
        };
        let empty = DataError::Empty { path: path.clone() };
        let row =
            DataError::RaggedRow { path: path.clone(), line: 3, expected: 2, got: 4, hint: "" };
        for (error, text) in [
            (
                cell,
                r#"a:b/test.xlsx, sheet "Blatt 1", cell AB12: "Kraft: X" is "n/a", expected a finite number in kN"#,
            ),
            (
                row,
                r#"a:b/test.xlsx, sheet "Blatt 1", row 3: has 4 fields, the header has 2; complete the row or remove it"#,
            ),
            (
                empty,
                r#"a:b/test.xlsx, sheet "Blatt 1": is empty, expected a header line and rows of numbers"#,
            ),
        ] {
            let (path, sheet, error) = (path.clone(), "Blatt 1".to_owned(), Box::new(error));
            assert_eq!(DataError::InSheet { path, sheet, error }.to_string(), text);
        }
        assert_eq!([1, 26, 27, 702, 703].map(column_letters), ["A", "Z", "AA", "ZZ", "AAA"]);
    }
}
