//! A delimited text file as a table: header, units and rows of cells, with the line of the file
//! from which each row comes.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use csv::{ReaderBuilder, StringRecord, Trim};

use crate::data::DataError;
use crate::data::dialect::{Dialect, Separator, comment};
use crate::data::spelling::{self, Meaning};
use crate::data::text::{Text, read_text};

/// Number of lines that are examined to find separator, header and units.
const SNIFFED_LINES: usize = 64;

/// The column that holds the names in a table of cases; a header with it is recognised by this
/// name.
pub(crate) const CASE_COLUMN: &str = "case";

/// A delimited text file that was read as a table.
#[derive(Debug, Clone)]
pub struct Table {
    path: PathBuf,
    encoding: &'static str,
    dialect: Dialect,
    header: Header,
    rows: Vec<Row>,
}

/// The names of the columns and where they come from.
#[derive(Debug, Clone, Default)]
struct Header {
    /// Line of the header, or of the first row if there is no header.
    line: u64,
    /// Whether the file names its columns.
    is_written: bool,
    names: Vec<String>,
    /// The cells of a row of units beneath the names; empty if there is no such row.
    units: Vec<String>,
}

#[derive(Debug, Clone)]
struct Row {
    line: u64,
    cells: StringRecord,
}

/// A line of the file, without the sign of a comment.
#[derive(Clone, Copy)]
struct Line<'a> {
    /// Number of the line in the file, counted from 1.
    number: u64,
    /// Offset of its first byte in the text.
    start: usize,
    text: &'a str,
    is_comment: bool,
}

/// A line that is split into its fields.
struct SplitLine<'a> {
    line: Line<'a>,
    cells: Vec<String>,
    /// Whether no field is a number.
    is_text: bool,
}

impl<'a> SplitLine<'a> {
    fn new(line: Line<'a>, dialect: Dialect) -> Self {
        let cells = split(line.text, dialect.separator);
        let is_text = cells.iter().all(|cell| dialect.number(cell).is_none());
        Self { line, cells, is_text }
    }

    /// Whether the line is a row of the table that contains a number: no comment, and `width`
    /// fields.
    fn has_numbers(&self, width: usize) -> bool {
        !self.line.is_comment && !self.is_text && n_named(&self.cells) == width
    }
}

impl Table {
    /// Reads a file as a table. Its encoding is UTF-8, UTF-16 or Windows-1252, its separator comma,
    /// semicolon, tab or blanks, its decimal sign a point or a comma. Comments, text above the
    /// header and a row of units are recognised.
    ///
    /// # Errors
    /// [`DataError`] if the file cannot be read, is not text or is empty, or if a row does not have
    /// the number of fields of the header.
    pub fn read(path: &Path) -> Result<Self, DataError> {
        Self::parse(path, &read_text(path)?)
    }

    fn parse(path: &Path, text: &Text) -> Result<Self, DataError> {
        let lines = first_lines(&text.text);
        let plain = lines.iter().filter(|line| !line.is_comment);
        let texts: Vec<&str> = plain.map(|line| line.text).collect();
        if texts.is_empty() {
            let path = path.to_owned();
            return Err(DataError::Empty { path });
        }
        let dialect = Dialect::sniff(&texts);
        let (header, body) = find_header(&lines, dialect);
        let mut table = Self {
            path: path.to_owned(),
            encoding: text.encoding,
            dialect,
            header,
            rows: Vec::new(),
        };
        if let Some(body) = body {
            let rows = text.text.get(body.start..).unwrap_or_default();
            table.read_rows(rows, body.number)?;
        }
        Ok(table)
    }

    /// Path of the file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Character encoding of the file, such as `UTF-8`.
    pub fn encoding(&self) -> &'static str {
        self.encoding
    }

    /// Separator and decimal sign of the file.
    pub fn dialect(&self) -> Dialect {
        self.dialect
    }

    /// Names of the columns; `column 1` and so on where the file gives none.
    pub fn header(&self) -> &[String] {
        &self.header.names
    }

    /// Whether the file names its columns.
    pub fn has_header(&self) -> bool {
        self.header.is_written
    }

    /// Line of the header, counted from 1; line of the first row if there is no header.
    pub fn header_line(&self) -> u64 {
        self.header.line
    }

    /// The unit of a column in the row of units beneath the header; `None` if there is no such row
    /// or its cell is blank.
    ///
    /// - `column_idx`: index of the column, counted from 0.
    pub fn unit_text(&self, column_idx: usize) -> Option<&str> {
        let unit = self.header.units.get(column_idx)?;
        spelling::unit_text(unit)
    }

    /// Number of rows below the header.
    pub fn n_rows(&self) -> usize {
        self.rows.len()
    }

    /// Line of a row in the file, counted from 1; 0 if there is no such row.
    pub fn line(&self, row_idx: usize) -> u64 {
        self.rows.get(row_idx).map_or(0, |row| row.line)
    }

    /// Text of a cell without surrounding blanks; empty if there is no such cell. Both indices are
    /// counted from 0.
    pub fn cell(&self, row_idx: usize, column_idx: usize) -> &str {
        let row = self.rows.get(row_idx);
        row.and_then(|row| row.cells.get(column_idx)).unwrap_or("").trim()
    }

    /// The number in a cell; `None` if the cell does not hold a finite number.
    pub fn number(&self, row_idx: usize, column_idx: usize) -> Option<f64> {
        self.dialect.number(self.cell(row_idx, column_idx))
    }

    /// The numbers in all rows of a column.
    ///
    /// - `column_idx`: index of the column, counted from 0.
    /// - `unit`: symbol of the unit for the error message; empty if none is known.
    ///
    /// # Errors
    /// [`DataError::Cell`] at the first cell that does not hold a finite number.
    pub fn numbers(&self, column_idx: usize, unit: &'static str) -> Result<Vec<f64>, DataError> {
        let number = |row_idx| {
            self.number(row_idx, column_idx).ok_or_else(|| DataError::Cell {
                path: self.path.clone(),
                line: self.line(row_idx),
                column: column_idx + 1,
                name: self.header.names.get(column_idx).cloned().unwrap_or_default(),
                text: self.cell(row_idx, column_idx).to_owned(),
                unit,
            })
        };
        (0..self.n_rows()).map(number).collect()
    }

    /// Reads the rows from `body`. Blank lines and comments are omitted.
    ///
    /// - `first_line`: number of the first line of `body` in the file, counted from 1.
    ///
    /// # Errors
    /// [`DataError::RaggedRow`] if a row does not have the number of fields of the header.
    fn read_rows(&mut self, body: &str, first_line: u64) -> Result<(), DataError> {
        let spread;
        let source = match self.dialect.separator {
            Separator::Blanks => {
                spread = body.replace('\t', " ");
                &spread
            }
            _ => body,
        };
        let mut reader = ReaderBuilder::new()
            .delimiter(self.dialect.separator.byte())
            .has_headers(false)
            .flexible(true)
            .from_reader(source.as_bytes());
        let mut cells = StringRecord::new();
        while reader
            .read_record(&mut cells)
            .map_err(|error| DataError::io(&self.path, error.into()))?
        {
            if cells.iter().all(|cell| cell.trim().is_empty()) {
                continue;
            }
            if cells.get(0).is_some_and(|cell| comment(cell).is_some()) {
                continue;
            }
            let line = first_line - 1 + line_of(&cells, source);
            let cells = self.fit(&cells, line)?;
            self.rows.push(Row { line, cells });
        }
        Ok(())
    }

    /// Removes empty fields that a separator at the end of the line or repeated blanks leave.
    ///
    /// # Errors
    /// [`DataError::RaggedRow`] if the row then does not have the number of fields of the header.
    fn fit(&self, cells: &StringRecord, line: u64) -> Result<StringRecord, DataError> {
        let expected = self.header.names.len();
        let fitted: StringRecord = match self.dialect.separator {
            Separator::Blanks => cells.iter().filter(|cell| !cell.is_empty()).collect(),
            _ if ends_in_separator(cells, expected) => cells.iter().take(expected).collect(),
            _ => cells.clone(),
        };
        if fitted.len() == expected {
            return Ok(fitted);
        }
        Err(DataError::RaggedRow { path: self.path.clone(), line, expected, got: fitted.len() })
    }
}

/// Whether the row has exactly one field too many, which is empty and comes last.
fn ends_in_separator(cells: &StringRecord, expected: usize) -> bool {
    cells.len() == expected + 1
        && cells.iter().next_back().is_some_and(|cell| cell.trim().is_empty())
}

/// The line of `source`, counted from 1, in which a record starts. The crate `csv` states the line
/// before any blank lines above the record.
fn line_of(record: &StringRecord, source: &str) -> u64 {
    let Some(position) = record.position() else {
        return 1;
    };
    let start = usize::try_from(position.byte()).unwrap_or(usize::MAX);
    let above = source.as_bytes().get(start..).unwrap_or_default();
    position.line() + above.iter().take_while(|byte| **byte == b'\n').count() as u64
}

/// The first lines of a text that are not blank, at most [`SNIFFED_LINES`].
fn first_lines(text: &str) -> Vec<Line<'_>> {
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
    all.filter(|line| !line.text.trim().is_empty()).take(SNIFFED_LINES).collect()
}

/// Splits a line into its fields. A separator inside quotation marks does not divide a field.
fn split(line: &str, separator: Separator) -> Vec<String> {
    if !line.contains('"') {
        return separator.fields(line).map(str::to_owned).collect();
    }
    let line = match separator {
        Separator::Blanks => line.replace('\t', " "),
        _ => line.to_owned(),
    };
    let mut reader = ReaderBuilder::new()
        .delimiter(separator.byte())
        .has_headers(false)
        .trim(Trim::All)
        .buffer_capacity(line.len() + 1)
        .from_reader(line.as_bytes());
    let mut record = StringRecord::new();
    // Reading from memory fails for invalid UTF-8 only, which a `str` cannot contain.
    let _ = reader.read_record(&mut record);
    let kept = |cell: &&str| separator != Separator::Blanks || !cell.is_empty();
    record.iter().filter(kept).map(str::to_owned).collect()
}

/// Finds the header, the row of units and the first line of the rows; the latter is `None` if there
/// is no row.
fn find_header<'a>(lines: &[Line<'a>], dialect: Dialect) -> (Header, Option<Line<'a>>) {
    let split: Vec<SplitLine<'a>> =
        lines.iter().map(|line| SplitLine::new(*line, dialect)).collect();
    let width = width(&split);
    let first_number = split.iter().position(|line| line.has_numbers(width));
    let Some(names) = header_line(&split, width, first_number) else {
        let mut plain = split.iter().filter(|line| !line.line.is_comment);
        let first_number = first_number.and_then(|at| split.get(at));
        let body = first_number.or_else(|| plain.next()).map(|line| line.line);
        let line = body.map_or(1, |line| line.number);
        return (Header::unwritten(line, width), body);
    };
    let mut below = split
        .iter()
        .filter(|line| line.line.number > names.line.number)
        .filter(|line| !line.line.is_comment || names.line.is_comment);
    let mut body = below.next();
    let mut units = Vec::new();
    if let Some(line) = body
        && line.is_text
        && spelling::is_unit_row(line.cells.iter().map(String::as_str))
    {
        units = line.cells.clone();
        body = below.next();
    }
    let header =
        Header { line: names.line.number, is_written: true, names: named(&names.cells), units };
    (header, body.map(|line| line.line))
}

/// Chooses the header among lines that contain no number. The first rule that finds a line applies:
///
/// 1. the first line with the width of the table in which a field names a channel or is `case`;
/// 2. the first line with the width of the table above the first row of numbers;
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
        let fits = |line: &&SplitLine<'_>| n_named(&line.cells) == width;
        let mut fitting = split.iter().filter(is_candidate).filter(fits);
        let has_several = |line: &&SplitLine<'_>| first_number.is_some() && line.cells.len() > 1;
        fitting
            .find(|line| line.cells.iter().any(|cell| is_name(cell)))
            .or_else(|| above().filter(is_candidate).find(fits))
            .or_else(|| above().filter(is_candidate).rfind(has_several))
    })
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
/// number.
fn named(cells: &[String]) -> Vec<String> {
    let cells = cells.iter().take(n_named(cells));
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
            names: named(&vec![String::new(); width + 1]),
            units: Vec::new(),
        }
    }
}
