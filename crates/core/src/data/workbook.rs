//! Reads a sheet of an Excel workbook (`.xlsx`, `.xlsm`) as the text of a table: one line for each
//! row of the sheet, its cells separated by tabs, so that line and column of an error are row and
//! column of the sheet.
//!
//! A workbook is an archive, and a small one may unpack to any size. It is unpacked once and counted
//! before anything in it is read, what it says of its own size is checked before anything is allocated by
//! it, and the text is limited as that of any table.

use std::io::{BufReader, Cursor, Read};
use std::path::Path;

use calamine::{CellErrorType, DataRef, Reader, Xlsx};
use quick_xml::events::{BytesStart, Event};
use zip::ZipArchive;

use crate::data::budget::{
    MAX_COLUMNS, MAX_SHEET_ROWS, MAX_STYLE_ELEMENTS, MAX_TABLE_BYTES, MAX_TEXT_ELEMENTS,
    MAX_WORKBOOK_BYTES, MAX_WORKBOOK_TEXTS,
};
use crate::data::foreign::other;
use crate::data::text::Text;
use crate::data::{DataError, SheetRef, open_file, read_bytes};

/// The first bytes of an archive.
pub const ARCHIVE_START: &[u8] = b"PK\x03\x04";

/// Most sheets that are listed.
const MAX_SHEETS: usize = 1000;

/// A sheet of a workbook.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    /// The name of the sheet.
    pub name: String,
    /// The names of all sheets of the workbook, in their order.
    pub all: Vec<String>,
}

/// Whether a file is an archive, as a workbook is.
///
/// # Errors
/// [`DataError`] if the file cannot be read.
pub(super) fn is_archive(path: &Path) -> Result<bool, DataError> {
    let (file, _) = open_file(path, u64::MAX)?;
    let mut first = Vec::new();
    let read = file.take(ARCHIVE_START.len() as u64).read_to_end(&mut first);
    read.map_err(|source| DataError::io(path, source))?;
    Ok(first == ARCHIVE_START)
}

/// Reads a sheet of a workbook as text.
///
/// - `wanted`: the sheet; `None` is the first one that has cells.
///
/// # Errors
/// [`DataError::OtherFormat`] for another archive, [`DataError::TooLarge`] and
/// [`DataError::TooManyColumns`] beyond the limits, [`DataError::NoSheet`] without such a sheet, and
/// [`DataError::Workbook`] if the workbook is damaged.
pub(super) fn read_sheet(
    path: &Path,
    wanted: Option<&SheetRef>,
) -> Result<(Text, Sheet), DataError> {
    let bytes = read_bytes(path, MAX_WORKBOOK_BYTES)?;
    check_archive(path, &bytes)?;
    let damaged = |why: &dyn std::fmt::Display| DataError::Workbook {
        path: path.to_owned(),
        why: why.to_string(),
    };
    let mut workbook = Xlsx::new(Cursor::new(bytes)).map_err(|error| damaged(&error))?;
    let all: Vec<String> = workbook.sheet_names().into_iter().take(MAX_SHEETS).collect();
    let named = |name: &&String| match wanted {
        Some(SheetRef::Name(wanted)) => *name == wanted,
        _ => true,
    };
    let chosen: Vec<&String> = match wanted {
        Some(SheetRef::Number(number)) => {
            all.iter().skip(number.saturating_sub(1)).take(1).collect()
        }
        _ => all.iter().filter(named).collect(),
    };
    for name in &chosen {
        let text = sheet_text(path, &mut workbook, name)?;
        if !text.text.is_empty() || wanted.is_some() {
            return Ok((text, Sheet { name: (*name).clone(), all: all.clone() }));
        }
    }
    let wanted = wanted.map_or("one with cells".to_owned(), SheetRef::to_string);
    Err(DataError::NoSheet { path: path.to_owned(), wanted, found: all })
}

/// Unpacks every part of an archive, counts it, and checks that it is a workbook.
fn check_archive(path: &Path, bytes: &[u8]) -> Result<(), DataError> {
    let damaged = |why: String| DataError::Workbook { path: path.to_owned(), why };
    let mut archive =
        ZipArchive::new(Cursor::new(bytes)).map_err(|error| damaged(error.to_string()))?;
    let has = |name: &str| archive.file_names().any(|part| part.is_ok_and(|part| part == name));
    match () {
        () if has("xl/workbook.xml") => {}
        () if has("xl/workbook.bin") => {
            return Err(other(path, "a binary workbook (.xlsb)", "save it as .xlsx or as CSV"));
        }
        () if has("content.xml") && has("mimetype") => {
            let remedy = "save the sheet as .xlsx or as CSV";
            return Err(other(path, "an OpenDocument file (.ods)", remedy));
        }
        () if has("word/document.xml") => {
            return Err(other(path, "a text document (.docx)", "save the table as CSV"));
        }
        () => {
            let remedy = "unpack it and open the files in it";
            return Err(other(path, "an archive (zip)", remedy));
        }
    }
    let mut left = MAX_TABLE_BYTES;
    for idx in 0..archive.len() {
        let part = archive.by_index(idx).map_err(|error| damaged(error.to_string()))?;
        let name = part.name().map_err(|error| damaged(error.to_string()))?.to_ascii_lowercase();
        let mut part = part.take(left + 1);
        if let Some(limit) = max_elements(&name) {
            check_elements(&mut part, limit).map_err(damaged)?;
        }
        std::io::copy(&mut part, &mut std::io::sink())
            .map_err(|error| damaged(error.to_string()))?;
        left = part.limit().checked_sub(1).ok_or_else(|| too_large(path))?;
    }
    Ok(())
}

/// The most elements of a part of a workbook that is held in memory, element by element.
///
/// - `name`: of the part, in small letters.
fn max_elements(name: &str) -> Option<u64> {
    match () {
        () if name.ends_with("sharedstrings.xml") => Some(MAX_TEXT_ELEMENTS),
        () if name.ends_with("styles.xml") => Some(MAX_STYLE_ELEMENTS),
        () => None,
    }
}

/// Counts the elements of a part, and checks the number of texts for which memory is set aside at once.
/// Whatever else is wrong with it is found when it is read.
fn check_elements(part: &mut impl Read, limit: u64) -> Result<(), String> {
    let mut xml = quick_xml::Reader::from_reader(BufReader::new(part));
    xml.config_mut().check_end_names = false;
    let (mut n, mut buffer) = (0, Vec::new());
    loop {
        buffer.clear();
        match xml.read_event_into(&mut buffer) {
            Ok(Event::Start(element) | Event::Empty(element)) => {
                n += 1;
                let n_texts = stated_texts(&element);
                if n_texts > MAX_WORKBOOK_TEXTS {
                    return Err(format!(
                        "it says that it has {n_texts} texts, expected {MAX_WORKBOOK_TEXTS} at the most"
                    ));
                }
                if n > limit {
                    return Err(format!(
                        "its texts or styles have more than {limit} elements, expected fewer"
                    ));
                }
            }
            Ok(Event::Eof) | Err(_) => return Ok(()),
            Ok(_) => {}
        }
    }
}

/// How many texts an element says that there are, the largest number if it says several.
fn stated_texts(element: &BytesStart<'_>) -> u64 {
    let is_digit = |c: char| c.is_ascii_digit();
    let stated = element.attributes_raw().split("uniqueCount").skip(1);
    let number = |text: &str| {
        let digits = &text[text.find(is_digit)?..];
        let end = digits.find(|c| !is_digit(c)).unwrap_or(digits.len());
        // More digits than a number can have are too many texts, too.
        Some(digits[..end].parse().unwrap_or(u64::MAX))
    };
    stated.filter_map(number).max().unwrap_or(0)
}

/// The error for a workbook that unpacks to more than is read; how much more is not found out.
fn too_large(path: &Path) -> DataError {
    let limit = MAX_TABLE_BYTES;
    DataError::TooLarge { path: path.to_owned(), bytes: limit + 1, limit }
}

/// The rows of a sheet as lines, all of the same number of cells; empty if the sheet has no cell.
fn sheet_text(
    path: &Path,
    workbook: &mut Xlsx<Cursor<Vec<u8>>>,
    name: &str,
) -> Result<Text, DataError> {
    let damaged = |error: calamine::XlsxError| DataError::Workbook {
        path: path.to_owned(),
        why: error.to_string(),
    };
    let mut cells = workbook.worksheet_cells_reader(name).map_err(damaged)?;
    let (mut text, mut row, mut column, mut width) = (String::new(), 0, 0, 0);
    let mut widths = Vec::new();
    let mut before = None;
    while let Some(cell) = cells.next_cell().map_err(damaged)? {
        let (at_row, at_column) = cell.get_position();
        let shown = shown(cell.get_value());
        if shown.is_empty() {
            continue;
        }
        if before.is_some_and(|before| before >= (at_row, at_column)) {
            let why = format!("row {} of sheet {name:?} has cells out of order", at_row + 1);
            return Err(DataError::Workbook { path: path.to_owned(), why });
        }
        if at_row >= MAX_SHEET_ROWS {
            let got = u64::from(at_row) + 1;
            let why =
                format!("sheet {name:?} has a row {got}, expected {MAX_SHEET_ROWS} at the most");
            return Err(DataError::Workbook { path: path.to_owned(), why });
        }
        before = Some((at_row, at_column));
        if at_column as usize >= MAX_COLUMNS {
            let (path, line) = (path.to_owned(), u64::from(at_row) + 1);
            let (got, limit) = (at_column as usize + 1, MAX_COLUMNS);
            return Err(DataError::TooManyColumns { path, line, got, limit });
        }
        while row < at_row {
            text.push('\n');
            widths.push(column);
            (row, column) = (row + 1, 0);
        }
        while column < at_column {
            text.push('\t');
            column += 1;
        }
        text.push_str(&shown);
        width = width.max(column + 1);
        if text.len() as u64 > MAX_TABLE_BYTES {
            return Err(too_large(path));
        }
    }
    widths.push(column);
    let n_cells = widths.len() as u64 * u64::from(width);
    if text.len() as u64 + n_cells > MAX_TABLE_BYTES {
        return Err(too_large(path));
    }
    let padded = text.split('\n').zip(widths).map(|(line, last)| {
        let missing = if width == 0 || line.is_empty() { 0 } else { width - 1 - last };
        line.to_owned() + &"\t".repeat(missing as usize) + "\n"
    });
    let text = if width == 0 { String::new() } else { padded.collect() };
    Ok(Text { text, encoding: "Excel workbook" })
}

/// What the text of a cell with a date or a time of day begins with.
const DATE: &str = "date or time of day";

/// The days in the text of a cell with a date or a time of day; `None` of any other.
pub(super) fn days_of(cell: &str) -> Option<f64> {
    let days = cell.strip_prefix(DATE)?.strip_prefix(" (")?.strip_suffix(" days)")?;
    days.parse().ok().filter(|days: &f64| days.is_finite())
}

/// The text of a cell in one line. What is no number must not look like one: a date is a number of
/// days in the file.
fn shown(value: &DataRef<'_>) -> String {
    match value {
        DataRef::Empty => String::new(),
        DataRef::Int(number) => number.to_string(),
        DataRef::Float(number) => number.to_string(),
        DataRef::String(text) => quoted(text),
        DataRef::SharedString(text) => quoted(text),
        DataRef::Bool(value) => value.to_string(),
        DataRef::DateTime(days) => format!("{DATE} ({} days)", days.as_f64()),
        DataRef::DateTimeIso(text) | DataRef::DurationIso(text) => quoted(text),
        DataRef::Error(error) => error_text(error),
    }
}

/// The text of a cell, in quotation marks if it contains one.
fn quoted(text: &str) -> String {
    let line = text.replace(['\t', '\n', '\r'], " ");
    match line.contains('"') {
        true => format!("\"{}\"", line.replace('"', "\"\"")),
        false => line,
    }
}

/// An error of a formula. Its own text begins with the sign of a comment.
fn error_text(error: &CellErrorType) -> String {
    format!("error {error}")
}
