//! A delimited text file as a table: header, units and rows of cells, with the line of the file
//! from which each row comes.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use crate::data::budget::{MAX_CASES_BYTES, MAX_LINE_BYTES, MAX_TABLE_BYTES};
use crate::data::dialect::{Dialect, Separator, has_unit};
use crate::data::error::or_recorder;
use crate::data::foreign::refuse_known_text;
use crate::data::formats::{self, Converted, Said};
use crate::data::header::{Header, Line, check_fields, find_header, first_lines};
use crate::data::rows::Rows;
use crate::data::spelling;
use crate::data::text::{Text, read_text};
use crate::data::vbo;
use crate::data::workbook::{Sheet, is_archive, read_sheet};
use crate::data::{DataError, DeckUnits, ModelStart, Note, ReadSettings, marks};

/// The column that holds the names in a table of cases; a header with it is recognised by this
/// name.
pub(crate) const CASE_COLUMN: &str = "case";

/// Number of lines of which a dialog shows the beginning.
const SHOWN_LINES: usize = 40;

/// Number of characters of a line that a dialog shows.
const SHOWN_CHARS: usize = 120;

/// Number of other sheets or parts of a file that are named.
const SHOWN_PARTS: usize = 4;

/// Number of columns that are not read which an error names.
const SHOWN_LEFT_OUT: usize = 6;

/// A delimited text file that was read as a table.
#[derive(Debug, Clone)]
pub struct Table {
    path: PathBuf,
    encoding: &'static str,
    dialect: Dialect,
    /// Whether one of its numbers may mean two things, such as `1.860`.
    is_ambiguous: bool,
    header: Header,
    rows: Rows,
    /// Numbers of columns that count before those of their cells, one in each row.
    numbers: BTreeMap<usize, Vec<f64>>,
    /// The numbers and the beginnings of the first lines.
    beginning: Vec<(u64, String)>,
    /// The sheet of a workbook.
    sheet: Option<Sheet>,
    /// What is said of the file, if it is of a format of its own.
    said: Option<Said>,
}

impl Table {
    /// Reads a file as a table: a text file or a sheet of an Excel workbook. Its encoding is UTF-8, UTF-16 or Windows-1252, its separator comma,
    /// semicolon, tab, vertical bar or blanks, its decimal sign a point or a comma. Comments, text above the
    /// header and a row of units are recognised.
    ///
    /// # Errors
    /// [`DataError`] if the file cannot be read, is not text or is empty, or if a row does not have
    /// the number of fields of the header.
    pub fn read(path: &Path) -> Result<Self, DataError> {
        Self::read_as(path, &ReadSettings::default())
    }

    /// Reads a file as a table, with the header, the units and the sheet where the settings say.
    ///
    /// # Errors
    /// The same as for [`Table::read`], and [`DataError::NoSuchLine`] if there is nothing in a line
    /// that the settings name.
    pub fn read_as(path: &Path, settings: &ReadSettings) -> Result<Self, DataError> {
        if let Some(converted) = formats::from_binary(path, settings)? {
            return Self::of_format(path, converted, "binary", settings);
        }
        let text = match read_text(path, MAX_TABLE_BYTES) {
            Err(DataError::NotText { .. }) if is_archive(path)? => {
                if let Some(converted) = formats::from_archive(path, settings)? {
                    return Self::of_format(path, converted, "archive", settings);
                }
                let (text, sheet) = read_sheet(path, settings.sheet.as_ref())?;
                let table = Self::parse(path, text, Some(Separator::Tab), settings);
                let table = table.map_err(|error| in_sheet(path, &sheet.name, error))?;
                return Ok(Self { sheet: Some(sheet), ..table });
            }
            text => text?,
        };
        if let Some(converted) = formats::from_text(path, &text.text, settings)? {
            return Self::of_format(path, converted, text.encoding, settings);
        }
        if let Some(sheet) = &settings.sheet {
            let (path, wanted, found) = (path.to_owned(), sheet.to_string(), Vec::new());
            return Err(DataError::NoSheet { path, wanted, found });
        }
        if let Some(converted) = vbo::as_table(&text.text) {
            return Self::of_format(path, converted, text.encoding, settings);
        }
        refuse_known_text(path, &text.text)?;
        Self::parse(path, text, None, settings)
    }

    /// The table of a file of a format of its own.
    fn of_format(
        path: &Path,
        Converted { text, said }: Converted,
        encoding: &'static str,
        settings: &ReadSettings,
    ) -> Result<Self, DataError> {
        let table = Self::parse(path, Text { text, encoding }, Some(Separator::Tab), settings);
        let table = table.map_err(|error| match &said.part {
            Some(part) if !said.keeps_lines => in_sheet(path, &part.name, error),
            _ => error,
        })?;
        Ok(Self { sheet: said.part.clone(), said: Some(said), ..table })
    }

    /// Reads a table of cases. It is held cell by cell, so that its size has a lower limit.
    ///
    /// # Errors
    /// The same as for [`Table::read`].
    pub(crate) fn read_cases(path: &Path) -> Result<Self, DataError> {
        Self::parse(path, read_text(path, MAX_CASES_BYTES)?, None, &ReadSettings::default())
    }

    fn parse(
        path: &Path,
        Text { mut text, encoding }: Text,
        converted: Option<Separator>,
        settings: &ReadSettings,
    ) -> Result<Self, DataError> {
        check_line_lengths(path, &text)?;
        let dialect = {
            let lines = first_lines(&text);
            let plain = lines.iter().filter(|line| !line.is_comment);
            let texts: Vec<&str> = plain.map(|line| line.text).collect();
            if texts.is_empty() {
                let path = path.to_owned();
                return Err(DataError::Empty { path });
            }
            Dialect::sniff(&texts, converted, settings)
        };
        if dialect.separator == Separator::Blanks && text.contains('\t') {
            text = text.replace('\t', " ");
        }
        let lines = first_lines(&text);
        check_fields(path, &lines, dialect.separator)?;
        let (header, body) = find_header(path, &lines, dialect, settings)?;
        let (body, first_line) = body.map_or((text.len(), 0), |body| (body.start, body.number));
        let beginning = lines.iter().take(SHOWN_LINES).map(|line| shown_line(line)).collect();
        let rows = Rows::read(path, text, body, first_line, dialect, header.names.len())?;
        let (separator, is_converted) = (dialect.separator, converted.is_some());
        let (dialect, is_ambiguous) =
            Dialect::with_marks(separator, rows.marks(), is_converted, settings);
        let (path, sheet, said) = (path.to_owned(), None, None);
        let numbers = BTreeMap::new();
        Ok(Self {
            path,
            encoding,
            dialect,
            is_ambiguous,
            header,
            rows,
            numbers,
            beginning,
            sheet,
            said,
        })
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

    /// The names of all columns, with those that hold no numbers first, and that they are not read.
    pub(super) fn found_columns(&self) -> Vec<String> {
        let left_out = self.said.iter().flat_map(|said| &said.left_out).take(SHOWN_LEFT_OUT);
        let left_out = left_out.map(|name| format!("{name}, not read"));
        left_out.chain(self.header.names.iter().cloned()).collect()
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

    /// The sheet, or the part of a file of several, from which the table was read; `None` for a file of
    /// one table.
    pub fn sheet(&self) -> Option<&Sheet> {
        self.sheet.as_ref()
    }

    /// Whether the table is of results of a finite-element model, whose units the settings can say.
    pub fn is_of_model(&self) -> bool {
        self.said.as_ref().is_some_and(|said| said.is_model)
    }

    /// The units that are proposed for such a model, with the reason, if nobody has said them.
    pub fn proposed_deck(&self) -> Option<(DeckUnits, &str)> {
        let open = self.said.as_ref()?.open_units.as_ref()?;
        Some((open.proposed, &open.why))
    }

    /// With which velocities the cars of such a model begin, if that is known.
    pub(super) fn model_start(&self) -> Option<&ModelStart> {
        self.said.as_ref()?.model_start.as_ref()
    }

    /// The other sheets or parts of the file, which are not read; `None` if there are none, or if the results of a
    /// model say themselves which is read.
    fn other_parts(&self) -> Option<Note> {
        let sheet =
            self.sheet.as_ref().filter(|sheet| sheet.all.len() > 1 && !self.is_of_model())?;
        let others = sheet.all.iter().enumerate().filter(|(_, name)| **name != sheet.name);
        let shown =
            others.take(SHOWN_PARTS).map(|(idx, name)| format!("sheet={} {name:?}", idx + 1));
        let shown: Vec<String> = shown.collect();
        let text = format!(
            "read is {:?}, one of {} parts of the file; not read are {}{}",
            sheet.name,
            sheet.all.len(),
            shown.join(", "),
            if sheet.all.len() - 1 > shown.len() { " and more" } else { "" }
        );
        Some(Note::Format { text })
    }

    /// What is said of the file if it is of a format of its own or has several parts.
    pub(super) fn format_notes(&self) -> Vec<Note> {
        let parts = self.other_parts().into_iter();
        let Some(said) = &self.said else { return parts.collect() };
        let format = Note::Format { text: said.description.clone() };
        let doubts = said.doubts.iter().map(|text| Note::Doubt { text: text.clone() });
        std::iter::once(format).chain(parts).chain(doubts).collect()
    }

    /// An error in this table. In a sheet its place is the cell.
    pub(crate) fn placed(&self, error: DataError) -> DataError {
        let keeps_lines = self.said.as_ref().is_some_and(|said| said.keeps_lines);
        match &self.sheet {
            Some(sheet) if !keeps_lines => in_sheet(&self.path, &sheet.name, error),
            _ => error,
        }
    }

    /// Line of the row of units; `None` if there is none.
    pub fn units_line(&self) -> Option<u64> {
        self.header.units_line
    }

    /// The first lines of the file that are not blank: their numbers, counted from 1, and what they
    /// begin with.
    pub fn beginning(&self) -> &[(u64, String)] {
        &self.beginning
    }

    /// Number of rows with text to the right of the last column, which is not read.
    pub(crate) fn n_rows_with_text_beyond(&self) -> usize {
        self.rows.n_with_text_beyond()
    }

    /// A digest of the names and units of the columns, the same for every file with this header and of
    /// this device. In
    /// a file without a header it is of the path and the number of columns.
    pub fn fingerprint(&self) -> String {
        let mut digest = Sha256::new();
        let mut add = |text: &str| {
            digest.update(text.as_bytes());
            digest.update([0]);
        };
        if let Some(said) = self.said.as_ref().filter(|said| !said.device.is_empty()) {
            add(&said.device);
        }
        match self.header.is_written {
            true => self.header.names.iter().chain(&self.header.units).for_each(|name| add(name)),
            false => {
                add(&self.path.to_string_lossy());
                add(&self.header.names.len().to_string());
            }
        }
        digest.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
    }

    /// Number of rows below the header.
    pub fn n_rows(&self) -> usize {
        self.rows.len()
    }

    /// Line of a row in the file, counted from 1; 0 if there is no such row.
    pub fn line(&self, row_idx: usize) -> u64 {
        self.rows.line(row_idx)
    }

    /// Text of a cell without surrounding blanks; empty if there is no such cell. Both indices are
    /// counted from 0.
    pub fn cell(&self, row_idx: usize, column_idx: usize) -> Cow<'_, str> {
        self.rows.cell(row_idx, column_idx)
    }

    /// The line and the cells of every row, in the order of the file; the cells are without
    /// surrounding blanks.
    pub(crate) fn rows(&self) -> impl Iterator<Item = (u64, Vec<Cow<'_, str>>)> {
        self.rows.iter()
    }

    /// The number in a cell; `None` if the cell does not hold a finite number.
    pub fn number(&self, row_idx: usize, column_idx: usize) -> Option<f64> {
        match self.numbers.get(&column_idx) {
            Some(numbers) => numbers.get(row_idx).copied(),
            None => self.dialect.number(&self.cell(row_idx, column_idx)),
        }
    }

    /// Some rows of the table, with other numbers in some columns.
    ///
    /// - `numbers`: by the index of the column, one in each of these rows.
    pub(super) fn with_numbers(
        &self,
        numbers: BTreeMap<usize, Vec<f64>>,
        rows: Range<usize>,
    ) -> Self {
        let mut table = Self { numbers, ..self.clone() };
        table.rows.keep(rows);
        table
    }

    /// Row and column of the first number that may mean two things, where nothing in the table says which.
    ///
    /// - `columns`: indices of the columns that are read.
    pub(super) fn ambiguous_number(&self, columns: &[usize]) -> Option<(usize, usize)> {
        let is_open = |(row_idx, column_idx): &(usize, usize)| {
            marks::is_open(&self.cell(*row_idx, *column_idx))
        };
        let n_rows = if self.is_ambiguous { self.n_rows() } else { 0 };
        (0..n_rows)
            .flat_map(|row_idx| columns.iter().map(move |column_idx| (row_idx, *column_idx)))
            .find(is_open)
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
            let number = self.number(row_idx, column_idx);
            let expected = || match unit {
                "" => "a finite number".to_owned(),
                _ => format!("a finite number in {unit}"),
            };
            number.ok_or_else(|| self.cell_error(row_idx, column_idx, &expected()))
        };
        let mut numbers = Vec::with_capacity(self.n_rows());
        for row_idx in 0..self.n_rows() {
            numbers.push(number(row_idx)?);
        }
        Ok(numbers)
    }

    /// The error for a cell that does not hold what is expected. A recorder leaves cells blank where it has no sample.
    pub(super) fn cell_error(
        &self,
        row_idx: usize,
        column_idx: usize,
        expected: &str,
    ) -> DataError {
        let cell = self.cell(row_idx, column_idx);
        let is_header = self.header.names.get(column_idx).is_some_and(|name| *name == cell);
        let has_no_number =
            || (0..self.header.names.len()).all(|idx| self.number(row_idx, idx).is_none());
        let is_second_header = || row_idx == 0 && self.n_rows() > 1 && has_no_number();
        let hint = match (cell.trim().is_empty(), is_header) {
            (true, _) => or_recorder(&self.header.names),
            (false, true) => {
                "; the header stands here again: put the table below it into a file of its own"
            }
            (false, false) if has_unit(&cell) => {
                "; write the unit into the header, as in \"speed [m/s]\", and numbers alone into the cells"
            }
            (false, false) if is_second_header() => {
                "; if this is a second line of the header, remove it"
            }
            (false, false) => "",
        };
        DataError::Cell {
            path: self.path.clone(),
            line: self.line(row_idx),
            column: column_idx + 1,
            name: self.header.names.get(column_idx).cloned().unwrap_or_default(),
            text: self.cell(row_idx, column_idx).into_owned(),
            expected: format!("{expected}{hint}").into(),
        }
    }
}

fn in_sheet(path: &Path, sheet: &str, error: DataError) -> DataError {
    let (path, sheet, error) = (path.to_owned(), sheet.to_owned(), Box::new(error));
    DataError::InSheet { path, sheet, error }
}

/// The number of a line and as much of it as is shown.
fn shown_line(line: &Line<'_>) -> (u64, String) {
    (line.number, line.text.trim_end().replace('\t', "  ").chars().take(SHOWN_CHARS).collect())
}

/// Refuses a text with a line that is longer than any line of a table.
///
/// # Errors
/// [`DataError::LongLine`] at the first such line.
fn check_line_lengths(path: &Path, text: &str) -> Result<(), DataError> {
    let limit = MAX_LINE_BYTES;
    match (1..).zip(text.split('\n')).find(|(_, line)| line.len() > limit) {
        None => Ok(()),
        Some((line, text)) => {
            Err(DataError::LongLine { path: path.to_owned(), line, bytes: text.len(), limit })
        }
    }
}
