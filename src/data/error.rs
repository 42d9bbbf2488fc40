//! What is wrong with a file, and where: `file:line:column`, both from 1.

use std::io;
use std::path::{Path, PathBuf};

use crate::data::{Channel, SeriesError, spelling};
use crate::units::Quantity;

/// Why a file could not be read or written.
#[derive(Debug, thiserror::Error)]
pub enum DataError {
    /// The operating system refused.
    #[error("{}: cannot be read or written", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// There is nothing at this path.
    #[error("{}: does not exist; check the name", path.display())]
    NotFound {
        /// The path.
        path: PathBuf,
    },
    /// A folder stands where a file was expected.
    #[error("{}: is a folder, expected a file", path.display())]
    IsDirectory {
        /// The folder.
        path: PathBuf,
    },
    /// The file has no bytes, or only blank lines and comments.
    #[error("{}: is empty, expected a header line and rows of numbers", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// The file is larger than the program reads.
    #[error("{}: has {bytes} bytes, at most {limit} are read; split it or thin it out", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Its size.
        bytes: u64,
        /// The largest size that is read.
        limit: u64,
    },
    /// The file holds bytes that no text has.
    #[error("{}: is not text (byte {byte:#04x} at offset {offset}); export it as CSV", path.display())]
    NotText {
        /// The file.
        path: PathBuf,
        /// Where the byte stands, from 0.
        offset: usize,
        /// The byte.
        byte: u8,
    },
    /// The numbers start without a line that names the columns.
    #[error("{}:{line}: no header line names the columns; say which is which, e.g. --map {example}, or in the mapping dialog", path.display())]
    NoHeader {
        /// The file.
        path: PathBuf,
        /// Line of the first numbers.
        line: u64,
        /// A mapping in the right syntax.
        example: &'static str,
    },
    /// No column is recognised as one that is needed.
    #[error("{}:{line}: no column for {needed}; found {}; say which it is, e.g. --map {}=COLUMN, or in the mapping dialog",
        path.display(), list(found), channel.short_name())]
    MissingColumn {
        /// The file.
        path: PathBuf,
        /// Line of the header.
        line: u64,
        /// The first missing column.
        channel: Channel,
        /// What is needed, alternatives included.
        needed: &'static str,
        /// The header.
        found: Vec<String>,
    },
    /// A mapping names a column that the file does not have.
    #[error("{}:{line}: the mapping takes {} from column {column}, which is not in the file; found {}",
        path.display(), channel.short_name(), list(found))]
    NoSuchColumn {
        /// The file.
        path: PathBuf,
        /// Line of the header.
        line: u64,
        /// The mapped channel.
        channel: Channel,
        /// The column as the mapping names it.
        column: String,
        /// The header.
        found: Vec<String>,
    },
    /// Two columns claim to be the same channel.
    #[error("{}:{line}:{column}: {name:?} and {other:?} in column {other_column} both look like {1}; choose one, e.g. --map {1}={other_column}, or in the mapping dialog",
        path.display(), channel.short_name())]
    AmbiguousColumn {
        /// The file.
        path: PathBuf,
        /// Line of the header.
        line: u64,
        /// The later column's number.
        column: usize,
        /// What both look like.
        channel: Channel,
        /// The later column's header.
        name: String,
        /// The earlier column's number.
        other_column: usize,
        /// The earlier column's header.
        other: String,
    },
    /// A header carries a unit that does not measure what the column holds.
    #[error("{}:{line}:{column}: {name:?} is in {unit:?}, expected a unit of {} ({}); correct the header or map the column with its unit, e.g. --map {}={column}:{}",
        path.display(), spelling::quantity_name(*quantity), spelling::symbols(*quantity), channel.short_name(), quantity.si_unit().symbol)]
    UnknownUnit {
        /// The file.
        path: PathBuf,
        /// Line of the header.
        line: u64,
        /// The column's number.
        column: usize,
        /// The column's header.
        name: String,
        /// What the column was taken for.
        channel: Channel,
        /// The unit as written.
        unit: String,
        /// What the column should hold.
        quantity: Quantity,
    },
    /// A cell is not a finite number.
    #[error("{}:{line}:{column}: {name:?} is {text:?}, expected a finite number{}", path.display(), in_unit(unit))]
    Cell {
        /// The file.
        path: PathBuf,
        /// Line of the cell.
        line: u64,
        /// The column's number.
        column: usize,
        /// The column's header.
        name: String,
        /// What stands there.
        text: String,
        /// The unit of the column, empty if none is known.
        unit: &'static str,
    },
    /// A row has more or fewer fields than the header.
    #[error("{}:{line}: has {got} fields, the header has {expected}; complete the row or remove it", path.display())]
    RaggedRow {
        /// The file.
        path: PathBuf,
        /// Line of the row.
        line: u64,
        /// Fields in the header.
        expected: usize,
        /// Fields in the row.
        got: usize,
    },
    /// There are too few rows to make a time series.
    #[error("{}:{line}: rows of numbers below the header: {got}, expected at least {expected}", path.display())]
    TooFewRows {
        /// The file.
        path: PathBuf,
        /// Line of the header.
        line: u64,
        /// Rows that are needed.
        expected: usize,
        /// Rows that are there.
        got: usize,
    },
    /// A row is not later than the one before it.
    #[error("{}:{line}:{column}: time is {after_s} s after {before_s} s in the row before, expected a later time; sort the rows and remove doubles", path.display())]
    TimeOrder {
        /// The file.
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
    /// A value that no vehicle reaches.
    #[error("{}:{line}:{column}: {name:?} is {value:e} {unit}, beyond {limit:e} {unit}; check the unit of the column", path.display())]
    ImplausibleValue {
        /// The file.
        path: PathBuf,
        /// Line of the cell.
        line: u64,
        /// The column's number.
        column: usize,
        /// The column's header.
        name: String,
        /// The value in SI units.
        value: f64,
        /// The largest magnitude accepted, in SI units.
        limit: f64,
        /// The SI unit.
        unit: &'static str,
    },
    /// Columns that do not make a series; the readers check before, the writers' callers may not.
    #[error("{}: is not a time series", path.display())]
    Series {
        /// The file.
        path: PathBuf,
        /// What does not fit.
        source: SeriesError,
    },
    /// A table of cases lacks a column.
    #[error("{}:{line}: {name:?} is missing; add it, without it {consequence}", path.display())]
    MissingAttribute {
        /// The table of cases.
        path: PathBuf,
        /// Line of the header, or of the case whose cell is empty.
        line: u64,
        /// The column.
        name: String,
        /// What cannot be done.
        consequence: &'static str,
    },
    /// Two rows have the same case name.
    #[error("{}:{line}:{column}: case {case:?} stands in line {first_line} already; rename or remove one", path.display())]
    DuplicateCase {
        /// The table of cases.
        path: PathBuf,
        /// Line of the later row.
        line: u64,
        /// Number of the column `case`.
        column: usize,
        /// The name.
        case: String,
        /// Line of the earlier row.
        first_line: u64,
    },
    /// A case name that cannot name a file.
    #[error("{}:{line}:{column}: case {case:?} cannot name a file; use letters, digits, '-', '_' and '.'", path.display())]
    CaseName {
        /// The table of cases.
        path: PathBuf,
        /// Line of the row.
        line: u64,
        /// Number of the column `case`.
        column: usize,
        /// The name.
        case: String,
    },
    /// A row without its file.
    #[error("{}:{line}:{column}: case {case:?} has no file {}; add the file or remove the row", path.display(), file.display())]
    CaseWithoutFile {
        /// The table of cases.
        path: PathBuf,
        /// Line of the row.
        line: u64,
        /// Number of the column `case`.
        column: usize,
        /// The name.
        case: String,
        /// The file that was looked for.
        file: PathBuf,
    },
    /// A file without a row.
    #[error("{}: has no row in {}; add the row or remove the file", path.display(), table.display())]
    FileWithoutCase {
        /// The file.
        path: PathBuf,
        /// The table of cases.
        table: PathBuf,
    },
    /// A folder or file that is none of the kinds the program knows.
    #[error("{}: is neither a data set (a folder with cases.csv and forces/ or trajectories/), nor a folder of data sets, nor a force, trajectory or steer file", path.display())]
    NotRecognised {
        /// The path.
        path: PathBuf,
    },
}

impl DataError {
    /// Whether saying which column is which, and in which unit, may help.
    pub fn needs_mapping(&self) -> bool {
        matches!(
            self,
            Self::NoHeader { .. }
                | Self::MissingColumn { .. }
                | Self::AmbiguousColumn { .. }
                | Self::UnknownUnit { .. }
                | Self::ImplausibleValue { .. }
        )
    }

    /// Wraps an error of the operating system.
    pub(crate) fn io(path: &Path, source: io::Error) -> Self {
        let path = path.to_owned();
        match source.kind() {
            io::ErrorKind::NotFound => Self::NotFound { path },
            io::ErrorKind::IsADirectory => Self::IsDirectory { path },
            _ => Self::Io { path, source },
        }
    }
}

/// Longest header list that a message spells out.
const LISTED: usize = 12;

fn list(names: &[String]) -> String {
    let mut text: Vec<String> =
        names.iter().take(LISTED).map(|name| format!("{name:.40?}")).collect();
    if names.len() > LISTED {
        text.push(format!("{} more", names.len() - LISTED));
    }
    text.join(", ")
}

fn in_unit(unit: &str) -> String {
    match unit {
        "" => String::new(),
        _ => format!(" in {unit}"),
    }
}
