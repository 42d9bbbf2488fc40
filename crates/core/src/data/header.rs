//! Finds the header of a table among its first lines: the names of the columns, a row of units
//! beneath or above them, and the line at which the rows begin.

use std::collections::BTreeMap;
use std::path::Path;

use crate::data::budget::{MAX_CELL_BYTES, MAX_COLUMNS, MAX_LINE_BYTES};
use crate::data::dialect::{Dialect, Separator, comment, split};
use crate::data::spelling::{self, Meaning};
use crate::data::table::CASE_COLUMN;
use crate::data::{DataError, HeaderLine, ReadSettings};

/// Number of lines that are examined to find separator, header and units.
const SNIFFED_LINES: usize = 256;

/// Number of bytes after which no further line is examined: enough for header, units and first row of
/// the widest table.
const SNIFFED_BYTES: usize = 4 * MAX_LINE_BYTES;

/// The names of the columns and where they come from.
#[derive(Debug, Clone, Default)]
pub(super) struct Header {
    /// Line of the header, or of the first row if there is no header.
    pub line: u64,
    /// Whether the file names its columns.
    pub is_written: bool,
    pub names: Vec<String>,
    /// The cells of a row of units beneath or above the names; empty if there is no such row.
    pub units: Vec<String>,
    /// Line of this row.
    pub units_line: Option<u64>,
}

/// A line of the file, without the sign of a comment.
#[derive(Clone, Copy)]
pub(super) struct Line<'a> {
    /// Number of the line in the file, counted from 1.
    pub number: u64,
    /// Offset of its first byte in the text.
    pub start: usize,
    pub text: &'a str,
    pub is_comment: bool,
}

/// A line that is split into its fields.
struct SplitLine<'a> {
    line: Line<'a>,
    cells: Vec<String>,
    /// Whether no field is a number, or more fields name channels than are numbers.
    is_text: bool,
}

impl<'a> SplitLine<'a> {
    fn new(line: Line<'a>, dialect: Dialect) -> Self {
        let cells = split(line.text, dialect.separator);
        let cells: Vec<String> = cells.into_iter().map(std::borrow::Cow::into_owned).collect();
        Self::from_cells(line, cells, dialect)
    }

    fn from_cells(line: Line<'a>, cells: Vec<String>, dialect: Dialect) -> Self {
        let n_numbers = cells.iter().filter(|cell| dialect.number(cell).is_some()).count();
        let n_names = || cells.iter().filter(|cell| is_name(cell)).count();
        // Names are looked up where there may be more of them than numbers: not in rows of numbers.
        let is_text = n_numbers == 0 || (n_numbers < cells.len() && n_names() > n_numbers);
        Self { line, cells, is_text }
    }

    /// Whether the line is a row of the table that contains a number: no comment, and `width`
    /// fields.
    fn has_numbers(&self, width: usize) -> bool {
        !self.line.is_comment && !self.is_text && n_named(&self.cells) == width
    }
}

/// The first lines of a text that are not blank: at most [`SNIFFED_LINES`], and none after the first
/// [`SNIFFED_BYTES`].
pub(super) fn first_lines(text: &str) -> Vec<Line<'_>> {
    let mut start = 0;
    let mut number = 0;
    let all = text.split_inclusive('\n').map(|line| {
        number += 1;
        let (at, comment) = (start, comment(line));
        start += line.len();
        Line {
            number,
            start: at,
            text: comment.unwrap_or(line.trim_end_matches('\n')),
            is_comment: comment.is_some(),
        }
    });
    let mut examined = 0;
    let is_within = |line: &Line<'_>| {
        let is_within = examined < SNIFFED_BYTES;
        examined += line.text.len();
        is_within
    };
    all.filter(|line| !line.text.trim().is_empty())
        .take(SNIFFED_LINES)
        .take_while(is_within)
        .collect()
}

/// Checks the number and the length of the fields of the first lines.
///
/// # Errors
/// [`DataError::TooManyColumns`] and [`DataError::LongCell`] at the first place beyond a limit.
pub(super) fn check_fields(
    path: &Path,
    lines: &[Line<'_>],
    separator: Separator,
) -> Result<(), DataError> {
    for line in lines.iter().filter(|line| !line.is_comment) {
        let got = separator.fields(line.text).count();
        if got > MAX_COLUMNS {
            let (path, line, limit) = (path.to_owned(), line.number, MAX_COLUMNS);
            return Err(DataError::TooManyColumns { path, line, got, limit });
        }
        check_cells(path, line.number, separator.fields(line.text))?;
    }
    Ok(())
}

/// Checks the length of the cells of a line.
///
/// # Errors
/// [`DataError::LongCell`] at the first cell beyond the limit.
pub(super) fn check_cells<'a>(
    path: &Path,
    line: u64,
    cells: impl Iterator<Item = &'a str>,
) -> Result<(), DataError> {
    for (column, cell) in (1..).zip(cells) {
        let (bytes, limit) = (cell.len(), MAX_CELL_BYTES);
        if bytes > limit {
            return Err(DataError::LongCell { path: path.to_owned(), line, column, bytes, limit });
        }
    }
    Ok(())
}

/// Finds the header, the row of units and the first line of the rows; the latter is `None` if there
/// is no row.
///
/// - `settings`: the lines of header and units, as far as the user has said them.
///
/// # Errors
/// [`DataError::NoSuchLine`] if a line that the user has said is not among the first lines, or is
/// blank; [`DataError::Contradiction`] if a name in quotation marks goes on in the next line.
pub(super) fn find_header<'a>(
    path: &Path,
    lines: &[Line<'a>],
    dialect: Dialect,
    settings: &ReadSettings,
) -> Result<(Header, Option<Line<'a>>), DataError> {
    let mut split: Vec<SplitLine<'a>> =
        lines.iter().map(|line| SplitLine::new(*line, dialect)).collect();
    let n_columns = width(&split);
    for line in split.iter_mut().filter(|line| line.line.is_comment) {
        if let Some(cells) = labelled(line.line.text, &line.cells, n_columns) {
            *line = SplitLine::from_cells(line.line, cells, dialect);
        }
    }
    let at_line = |wanted: u64, what: &'static str| {
        let found = split.iter().find(|line| line.line.number == wanted);
        found.ok_or_else(|| DataError::NoSuchLine { path: path.to_owned(), line: wanted, what })
    };
    let units = settings.units_line.map(|line| at_line(line, "units")).transpose()?;
    let width = width(&split);
    let first_number = split.iter().position(|line| line.has_numbers(width));
    let names = match settings.header {
        None => header_line(&split, width, first_number),
        Some(HeaderLine::Line(line)) => Some(at_line(line, "the header")?),
        Some(HeaderLine::None) => None,
    };
    if let Some(line) = names.map(|names| names.line).filter(|line| goes_on(line.text, dialect)) {
        let what = format!(
            "a name in quotation marks goes on in the line after {}: write the header in one line",
            line.number
        );
        return Err(DataError::Contradiction { path: path.to_owned(), what });
    }
    Ok(match names {
        Some(names) => below_names(&split, names, units, width),
        None => without_names(&split, width, first_number, units),
    })
}

/// Whether the quotation marks of a field are not closed in a line; a mark within a name may be that of inches.
fn goes_on(text: &str, dialect: Dialect) -> bool {
    let fields: Vec<&str> =
        text.split(char::from(dialect.separator.byte())).map(str::trim).collect();
    let is_opened =
        |field: &str| field.starts_with('"') && (field.len() == 1 || !field.ends_with('"'));
    let is_closed = |field: &str| field.ends_with('"') && !field.starts_with('"');
    let is_odd = text.matches('"').count() % 2 == 1;
    // A line amid such a header closes a name and opens another.
    is_odd && fields.iter().any(|field| is_opened(field))
        || fields.first().is_some_and(|field| is_closed(field))
            && fields.last().is_some_and(|field| is_opened(field))
}

/// The cells of a comment that is labelled, such as `columns: time fx fy` or `name: time  name: fx`, without
/// its labels; `None` if it has none.
fn labelled(text: &str, cells: &[String], n_columns: usize) -> Option<Vec<String>> {
    let label = text.split_whitespace().next().filter(|label| label.ends_with(':'))?;
    let repeated: Vec<String> =
        text.split(label).skip(1).map(|cell| cell.trim().to_owned()).collect();
    match () {
        () if repeated.len() == n_columns && n_columns > 1 => Some(repeated),
        () if cells.first().is_some_and(|cell| cell == label) && cells.len() == n_columns + 1 => {
            cells.get(1..).map(<[String]>::to_vec)
        }
        () => None,
    }
}

/// The header of a table whose columns have no names, and the first line of its rows.
fn without_names<'a>(
    split: &[SplitLine<'a>],
    width: usize,
    first_number: Option<usize>,
    units: Option<&SplitLine<'a>>,
) -> (Header, Option<Line<'a>>) {
    let mut plain = split.iter().filter(|line| !line.line.is_comment);
    let first_number = first_number.and_then(|at| split.get(at));
    let body = first_number.or_else(|| plain.next()).map(|line| line.line);
    let line = body.map_or(1, |line| line.number);
    let header = Header {
        units: units.map(|line| line.cells.clone()).unwrap_or_default(),
        units_line: units.map(|line| line.line.number),
        ..Header::unwritten(line, width)
    };
    (header, body)
}

/// The header in the line of the names, and the first line of the rows below it.
///
/// - `units`: the line of the units, if the user has said it; otherwise it is the line beneath the
///   names, or else the one above them, if that looks like one;
/// - `width`: number of columns of the rows.
fn below_names<'s, 'a>(
    split: &'s [SplitLine<'a>],
    names: &SplitLine<'a>,
    mut units: Option<&'s SplitLine<'a>>,
    width: usize,
) -> (Header, Option<Line<'a>>) {
    let last = units.map_or(0, |line| line.line.number).max(names.line.number);
    let mut below = split
        .iter()
        .filter(|line| line.line.number > last)
        .filter(|line| !line.line.is_comment || names.line.is_comment);
    let mut body = below.next();
    if units.is_none()
        && let Some(line) = body.filter(|line| is_row_of_units(line))
    {
        units = Some(line);
        body = below.next();
    }
    units = units.or_else(|| units_above(split, names));
    let header = Header {
        line: names.line.number,
        is_written: true,
        names: named(&names.cells, width),
        units: units.map(|line| line.cells.clone()).unwrap_or_default(),
        units_line: units.map(|line| line.line.number),
    };
    (header, body.map(|line| line.line))
}

fn is_row_of_units(line: &SplitLine<'_>) -> bool {
    line.is_text && spelling::is_unit_row(line.cells.iter().map(String::as_str))
}

/// The line right above the names if it has their units: as many fields, and at least one unit that is known among
/// them, which the numbers of columns in brackets are not.
fn units_above<'s, 'a>(
    split: &'s [SplitLine<'a>],
    names: &SplitLine<'a>,
) -> Option<&'s SplitLine<'a>> {
    let above = split.iter().rfind(|line| line.line.number < names.line.number)?;
    let is_alike = above.line.is_comment == names.line.is_comment
        && n_named(&above.cells) == n_named(&names.cells);
    let has_units = || above.cells.iter().any(|cell| spelling::is_known_unit(cell));
    (is_alike && is_row_of_units(above) && has_units()).then_some(above)
}

/// Chooses the header among lines that contain no number. The first rule that finds a line applies:
///
/// 1. the first line with the width of the table in which a field names a channel or is `case`;
/// 2. the first line with the width of the table above the first row of numbers, one of units only where there is
///    no other;
///
/// (in both, a line of which one field alone is written is none of a table of several columns, and a
/// last column without values counts)
///
/// 3. the last line with several fields above the first row of numbers, whose width differs from
///    that of the rows, so that the rows are then refused.
///
/// If no line is found, the same rules are applied to comments.
fn header_line<'s, 'a>(
    split: &'s [SplitLine<'a>],
    width: usize,
    first_number: Option<usize>,
) -> Option<&'s SplitLine<'a>> {
    let above = || split.iter().take(first_number.unwrap_or(split.len()));
    [false, true].into_iter().find_map(|is_comment| {
        let is_candidate =
            move |line: &&SplitLine<'_>| line.is_text && line.line.is_comment == is_comment;
        let all = full_width(split);
        let fits = move |line: &&SplitLine<'_>| {
            let n_written = line.cells.iter().filter(|cell| !cell.trim().is_empty()).count();
            let has_width = n_named(&line.cells) == width || line.cells.len() == all;
            has_width && (n_written > 1 || width < 2)
        };
        let mut fitting = split.iter().filter(is_candidate).filter(fits);
        let has_several = |line: &&SplitLine<'_>| first_number.is_some() && line.cells.len() > 1;
        fitting
            .find(|line| line.cells.iter().any(|cell| is_name(cell)))
            .or_else(|| {
                above().filter(is_candidate).filter(fits).find(|line| !is_row_of_units(line))
            })
            .or_else(|| above().filter(is_candidate).find(fits))
            .or_else(|| above().filter(is_candidate).rfind(has_several))
    })
}

/// The most frequent number of fields among lines that contain a number, those without a value counted;
/// 0 if there is no such line.
fn full_width(split: &[SplitLine<'_>]) -> usize {
    let mut counts: BTreeMap<usize, usize> = BTreeMap::new();
    for line in split.iter().filter(|line| !line.line.is_comment && !line.is_text) {
        *counts.entry(line.cells.len()).or_default() += 1;
    }
    counts.iter().max_by_key(|(_, count)| **count).map_or(0, |(width, _)| *width)
}

/// The width of the table: the most frequent number of fields among lines that contain a number,
/// the larger one at equal frequency. If no line contains a number, it is the number of fields of
/// the first line.
fn width(split: &[SplitLine<'_>]) -> usize {
    let mut counts: BTreeMap<usize, usize> = BTreeMap::new();
    let plain = || split.iter().filter(|line| !line.line.is_comment);
    for line in plain().filter(|line| !line.is_text) {
        *counts.entry(n_named(&line.cells)).or_default() += 1;
    }
    let most_frequent = counts.iter().max_by_key(|(_, count)| **count);
    let first_width = || plain().next().map_or(0, |line| n_named(&line.cells));
    most_frequent.map_or_else(first_width, |(width, _)| *width)
}

/// Number of fields, without an empty last field that a separator at the end of the line leaves.
fn n_named(cells: &[String]) -> usize {
    match cells.last() {
        Some(last) if last.is_empty() => cells.len() - 1,
        _ => cells.len(),
    }
}

fn is_name(cell: &str) -> bool {
    cell.eq_ignore_ascii_case(CASE_COLUMN) || spelling::meaning(cell) != Meaning::Unknown
}

/// The names of the columns in a header line; a column without a name is called `column` and its
/// number. Blank cells at the end are columns as far as the rows reach.
fn named(cells: &[String], width: usize) -> Vec<String> {
    let n_written = cells.iter().rposition(|cell| !cell.is_empty()).map_or(0, |last| last + 1);
    let cells = cells.iter().take(n_written.max(width));
    let name = |(i, cell): (usize, &String)| match cell.as_str() {
        "" => format!("column {}", i + 1),
        _ => cell.clone(),
    };
    cells.enumerate().map(name).collect()
}

impl Header {
    fn unwritten(line: u64, width: usize) -> Self {
        Self {
            line,
            is_written: false,
            names: named(&vec![String::new(); width], width),
            ..Self::default()
        }
    }
}
