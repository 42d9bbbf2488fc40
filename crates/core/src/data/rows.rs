//! The rows of a table. The text of the file is kept as it is, with the place at which each row
//! starts; a row is split into its cells when they are asked for. A table of short rows would
//! otherwise take a hundred times the memory of its file.

use std::borrow::Cow;
use std::ops::Range;
use std::path::Path;

use csv::{Reader, ReaderBuilder, StringRecord};

use crate::data::DataError;
use crate::data::dialect::{Dialect, Separator, comment};
use crate::data::header::check_cells;
use crate::data::marks::{Marks, Thousands};

/// What helps where a name or a cell of a table of fixed widths has blanks, or none but them.
const BETWEEN_BLANKS: &str = "; blanks divide the fields: names must not contain any nor cells be empty, or write the \
                              table with semicolons";

/// The rows of a table.
#[derive(Debug, Clone)]
pub(super) struct Rows {
    /// The whole file. If blanks separate its fields, it contains no tabs.
    text: String,
    separator: Separator,
    n_columns: usize,
    /// Offset in the text at which each row starts. The largest file that is read has fewer than
    /// 2³² bytes in UTF-8 too.
    starts: Vec<u32>,
    /// Number of rows with text to the right of the last column.
    n_with_text_beyond: usize,
}

impl Rows {
    /// Finds the rows in the text of a file. Blank lines and comments are omitted.
    ///
    /// - `body`, `first_line`: the offset at which the rows begin, and the number of this line.
    ///
    /// # Errors
    /// [`DataError::RaggedRow`] if a row does not have `n_columns` fields, except for text to the
    /// right of them, and
    /// [`DataError::LongCell`] if a cell is too long.
    pub(super) fn read(
        path: &Path,
        text: String,
        body: usize,
        first_line: u64,
        dialect: Dialect,
        n_columns: usize,
    ) -> Result<Self, DataError> {
        let source = text.get(body..).unwrap_or_default();
        let separator = dialect.separator;
        let mut reader = reader(separator, source);
        let (mut starts, mut cells) = (Vec::new(), StringRecord::new());
        let mut n_with_text_beyond = 0;
        while reader.read_record(&mut cells).map_err(|error| DataError::io(path, error.into()))? {
            if cells.iter().all(|cell| cell.trim().is_empty())
                || cells.get(0).is_some_and(|cell| comment(cell).is_some())
            {
                continue;
            }
            let (start, blank_lines) = start_of(&cells, source);
            let line = || {
                let above = cells.position().map_or(1, csv::Position::line);
                first_line - 1 + above + blank_lines
            };
            check_cells(path, line(), cells.iter())?;
            let got = n_fields(&cells, separator, n_columns);
            if got > n_columns && is_text_beyond(&cells, dialect, n_columns) {
                n_with_text_beyond += 1;
            } else if got != n_columns {
                let (path, line) = (path.to_owned(), line());
                let hint = if separator == Separator::Blanks { BETWEEN_BLANKS } else { "" };
                return Err(DataError::RaggedRow { path, line, expected: n_columns, got, hint });
            }
            starts.push((body + start) as u32);
        }
        Ok(Self { text, separator, n_columns, starts, n_with_text_beyond })
    }

    /// Number of rows with text to the right of the last column.
    pub(super) fn n_with_text_beyond(&self) -> usize {
        self.n_with_text_beyond
    }

    pub(super) fn len(&self) -> usize {
        self.starts.len()
    }

    /// Leaves out all rows but these.
    pub(super) fn keep(&mut self, rows: Range<usize>) {
        self.starts = self.starts.get(rows).unwrap_or_default().to_vec();
    }

    /// Line of a row in the file, counted from 1; 0 if there is no such row.
    pub(super) fn line(&self, row_idx: usize) -> u64 {
        let start = self.starts.get(row_idx);
        start.map_or(0, |start| 1 + count_lines(self.text.as_bytes(), 0, *start as usize))
    }

    /// Text of a cell without surrounding blanks; empty if there is no such cell.
    pub(super) fn cell(&self, row_idx: usize, column_idx: usize) -> Cow<'_, str> {
        let cell = |start: &u32| match self.plain_cells(*start) {
            Some(mut cells) => cells.nth(column_idx).map(Cow::Borrowed),
            None => self.quoted_cells(*start).into_iter().nth(column_idx),
        };
        self.starts.get(row_idx).and_then(cell).unwrap_or_default()
    }

    /// The line and the cells of every row.
    pub(super) fn iter(&self) -> impl Iterator<Item = (u64, Vec<Cow<'_, str>>)> {
        let (mut line, mut counted) = (1, 0);
        self.starts.iter().map(move |start| {
            line += count_lines(self.text.as_bytes(), counted, *start as usize);
            counted = *start as usize;
            let cells = match self.plain_cells(*start) {
                Some(cells) => cells.map(Cow::Borrowed).collect(),
                None => self.quoted_cells(*start),
            };
            (line, cells)
        })
    }

    /// What the numbers of all rows say of their marks.
    pub(super) fn marks(&self) -> Marks {
        let mut marks = Marks::default();
        let text = self.starts.first().map_or("", |start| self.from(*start));
        let is_quoted = || text.contains('"');
        let has_comma = text.contains(',') && (self.separator != Separator::Comma || is_quoted());
        let has_point = text.contains('.');
        let has_other = text.contains(['\'', '\u{2019}', '\u{a0}', '\u{202f}'])
            || (self.separator != Separator::Blanks && has_inner_space(text));
        // Where all numbers have the same mark, one of them is enough.
        let only = match (has_point, has_comma, has_other) {
            (false, false, false) => return marks,
            (true, false, false) => Some(Thousands::Point),
            (false, true, false) => Some(Thousands::Comma),
            _ => None,
        };
        for (_, cells) in self.iter() {
            cells.iter().for_each(|cell| marks.add(cell));
            if only.is_some_and(|mark| marks.is_decimal(mark)) {
                break;
            }
        }
        marks
    }

    /// The cells of the row at an offset, as many as the table has columns; `None` if its first line
    /// contains quotation marks.
    fn plain_cells(&self, start: u32) -> Option<impl Iterator<Item = &str>> {
        let line = self.from(start).split('\n').next()?;
        if line.contains('"') {
            return None;
        }
        let is_blanks = self.separator == Separator::Blanks;
        let cells = line.split(char::from(self.separator.byte()));
        let cells = cells.filter(move |cell| !is_blanks || !cell.is_empty());
        Some(cells.take(self.n_columns).map(str::trim))
    }

    /// The cells of the row at an offset, as many as the table has columns. A separator or a line
    /// end inside quotation marks is part of a cell.
    fn quoted_cells(&self, start: u32) -> Vec<Cow<'_, str>> {
        let mut record = StringRecord::new();
        // Reading from memory fails for invalid UTF-8 only, which a `str` cannot contain.
        let _ = reader(self.separator, self.from(start)).read_record(&mut record);
        let is_blanks = self.separator == Separator::Blanks;
        let cells = record.iter().filter(|cell| !is_blanks || !cell.is_empty());
        cells.take(self.n_columns).map(|cell| Cow::Owned(cell.trim().to_owned())).collect()
    }

    fn from(&self, start: u32) -> &str {
        self.text.get(start as usize..).unwrap_or_default()
    }
}

/// Whether a space stands between two digits.
fn has_inner_space(text: &str) -> bool {
    let is_inner = |bytes: &[u8]| match *bytes {
        [before, b' ', after] => before.is_ascii_digit() && after.is_ascii_digit(),
        _ => false,
    };
    text.as_bytes().windows(3).any(is_inner)
}

fn reader(separator: Separator, source: &str) -> Reader<&[u8]> {
    ReaderBuilder::new()
        .delimiter(separator.byte())
        .has_headers(false)
        .flexible(true)
        .from_reader(source.as_bytes())
}

/// Number of fields of a row, without the empty fields that repeated blanks or one separator at the
/// end of the line leave.
fn n_fields(cells: &StringRecord, separator: Separator, expected: usize) -> usize {
    match separator {
        Separator::Blanks => cells.iter().filter(|cell| !cell.is_empty()).count(),
        _ if ends_in_separator(cells, expected) => expected,
        _ => cells.len(),
    }
}

/// Whether there are only text and blank fields to the right of the last column, and no number that
/// could belong to a column.
fn is_text_beyond(cells: &StringRecord, dialect: Dialect, n_columns: usize) -> bool {
    let is_cell = |cell: &&str| dialect.separator != Separator::Blanks || !cell.is_empty();
    let mut beyond = cells.iter().filter(is_cell).skip(n_columns).map(str::trim);
    let is_text = |cell: &str| {
        dialect.number(cell).is_none() && !cell.starts_with(|c: char| c.is_ascii_digit())
    };
    beyond.all(is_text)
}

/// Whether the row has exactly one field too many, which is empty and comes last.
fn ends_in_separator(cells: &StringRecord, expected: usize) -> bool {
    cells.len() == expected + 1
        && cells.iter().next_back().is_some_and(|cell| cell.trim().is_empty())
}

/// The offset in `source` at which a record starts, and the number of blank lines before it. The
/// crate `csv` states the place before any blank lines above the record.
fn start_of(record: &StringRecord, source: &str) -> (usize, u64) {
    let byte = record.position().map_or(0, csv::Position::byte);
    let start = usize::try_from(byte).unwrap_or(usize::MAX);
    let above = source.as_bytes().get(start..).unwrap_or_default();
    let n_blank = above.iter().take_while(|byte| **byte == b'\n').count();
    (start + n_blank, n_blank as u64)
}

/// Number of line ends from one offset to another.
fn count_lines(text: &[u8], from: usize, to: usize) -> u64 {
    let part = text.get(from..to).unwrap_or_default();
    part.iter().filter(|byte| **byte == b'\n').count() as u64
}
