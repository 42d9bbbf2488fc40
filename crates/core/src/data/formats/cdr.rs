//! The export of a Bosch CDR tool as CSV.
//!
//! ```text
//! CDR FILE INFORMATION                                  a section: one cell, in capitals
//! User Entered VIN/Frame Number,1HG…                    keys and values
//! EDR Device Type,Airbag Control Module
//! Complete File Recorded,Yes
//! SYSTEM STATUS AT EVENT (EVENT RECORD 1)
//! "Maximum Delta-V, Longitudinal (MPH [km/h])",-14.9 [-24.0]
//! PRE-CRASH DATA -5 TO 0 SEC [2 SAMPLES/SEC] (EVENT RECORD 1)
//! Times (sec),"Speed, Vehicle Indicated (MPH [km/h])","Steering Input (deg)",Service Brake
//! -5.0,31 [50],0,Off                                    a header, then rows
//! "DELTA-V, LONGITUDINAL (EVENT RECORD 1)"
//! Time (msec),"Delta-V, Longitudinal (MPH [km/h])"
//! EVENT RECORD 2 contains no recorded data
//! ```
//!
//! Which columns there are differs from module to module. A number in brackets is the same in another unit.
//! A spreadsheet of a country with decimal commas saves such a file with semicolons between its cells and commas in
//! its numbers; both are found by the cells that are numbers. Older modules have their times in a row:
//!
//! ```text
//! Time (sec),-2.0,-1.0                                  or  Parameter,-2.0 sec,-1.0 sec
//! "Vehicle Speed (MPH [km/h])",40 [64],36 [58]
//! ```
//!
//! Such a table is stood up where nothing else can be meant. The `.CDRX` of which the export was made is not read.

use std::borrow::Cow;
use std::path::Path;

use crate::data::dialect::{Dialect, Separator, split};
use crate::data::formats::upright::upright;
use crate::data::formats::{Converted, Said, number_text};
use crate::data::marks::Marks;
use crate::data::spelling::{letters_and_digits, unit};
use crate::data::{DataError, ReadSettings, Sheet, SheetRef, Thousands};
use crate::units::Quantity;

/// Bytes of a report. Those of modules with many events have some hundred kilobytes.
pub(crate) const MAX_BYTES: usize = 8 << 20;

/// Lines within which a report says what it is.
const EXAMINED_LINES: usize = 60;

/// Lines by which the separator of a report is found.
const SNIFFED_LINES: usize = 500;

/// Characters of a name of a section that are kept.
const SHOWN_CHARS: usize = 120;

/// Beginnings of the names of sections, as the tools write them, without capitals.
const TITLES: [&str; 12] = [
    "cdr file information",
    "system status at",
    "deployment command data",
    "dtcs present",
    "faults present",
    "pre-crash",
    "pre_crash",
    "longitudinal",
    "lateral crash pulse",
    "rollover",
    "vertical crash pulse",
    "delta-v",
];

/// A section of a report.
#[derive(Debug, Clone)]
pub(crate) struct Section {
    /// Its name, with the event in parentheses.
    pub title: String,
    /// Line and cells of its rows that are not blank, without blank cells at their ends; the decimal sign of numbers
    /// is a point.
    pub rows: Vec<Row>,
    /// Whether it is a table whose times stood in a row; its lines are then counted from 1.
    pub is_turned: bool,
}

/// Line and cells of a row.
pub(crate) type Row = (u64, Vec<String>);

/// A report with all of its sections.
#[derive(Debug, Clone)]
pub(crate) struct Report {
    pub sections: Vec<Section>,
}

/// Whether a text is such a report.
pub(crate) fn is_report(text: &str) -> bool {
    let marks = ["cdr file information", "user entered vin", "imaged with c"];
    let is_mark = |line: &str| {
        let line = line.trim_start_matches(['"', ' ']);
        marks.iter().any(|mark| {
            line.get(..mark.len()).is_some_and(|start| start.eq_ignore_ascii_case(mark))
        })
    };
    text.lines().take(EXAMINED_LINES).any(is_mark)
}

impl Report {
    /// Divides a report into its sections.
    ///
    /// # Errors
    /// [`DataError::TooLarge`].
    pub(crate) fn parse(path: &Path, text: &str) -> Result<Self, DataError> {
        if text.len() > MAX_BYTES {
            let (bytes, limit) = (text.len() as u64, MAX_BYTES as u64);
            return Err(DataError::TooLarge { path: path.to_owned(), bytes, limit });
        }
        let mut sections: Vec<Section> = Vec::new();
        for (number, cells) in rows_of(text) {
            if let Some(title) = title(&cells) {
                sections.push(Section { title, rows: Vec::new(), is_turned: false });
            } else if let Some(section) = sections.last_mut() {
                section.rows.push((number, cells));
            } else {
                let (title, rows) = ("FILE".to_owned(), vec![(number, cells)]);
                sections.push(Section { title, rows, is_turned: false });
            }
        }
        let sections = sections.into_iter().flat_map(Section::stood_up).collect();
        Ok(Self { sections })
    }

    /// The value beside a key that begins so, in letters and digits; the first that is not blank.
    pub(crate) fn value(&self, key: &str) -> Option<&str> {
        self.sections.iter().find_map(|section| section.value(key))
    }

    /// What a person has to know of the file: its device, and whether it is complete.
    pub(crate) fn description(&self) -> String {
        let mut text = "a Bosch CDR report".to_owned();
        for (key, name) in [
            ("edrdevicetype", "device"),
            ("imagedwith", "imaged with"),
            ("eventsrecovered", "events"),
            ("completefilerecorded", "complete file recorded"),
        ] {
            if let Some(value) = self.value(key) {
                text += &format!("; {name}: {}", shortened(value));
            }
        }
        text
    }

    /// What the report says against itself.
    pub(crate) fn doubts(&self) -> Vec<String> {
        // Each event says it of itself.
        let sections = self.sections.iter();
        let complete: Vec<(&String, &str)> = sections
            .filter_map(|section| Some((&section.title, section.value("completefilerecorded")?)))
            .collect();
        let mut doubts = Vec::new();
        if complete.is_empty() {
            doubts.push(
                "the report does not say whether the complete file was recorded; look it up in the PDF"
                    .to_owned(),
            );
        }
        let is_yes = |value: &str| letters_and_digits(value).starts_with("yes");
        doubts.extend(complete.iter().filter(|(_, value)| !is_yes(value)).map(|(title, value)| {
            format!(
                "the record is not complete (complete file recorded: {}, in {title:?}): values may be those of another \
                 event or be missing",
                shortened(value)
            )
        }));
        let empty = self.sections.iter().flat_map(|section| &section.rows);
        let empty = empty.filter(|(_, cells)| is_no_data(cells)).count();
        if empty > 0 {
            doubts.push(format!("events and tables without recorded data: {empty}"));
        }
        doubts
    }

    fn tables(&self) -> impl Iterator<Item = &Section> {
        self.sections.iter().filter(|section| section.is_table())
    }
}

impl Section {
    /// The section; a table whose times are in a row is stood up, and what stands above it is a section of its own.
    fn stood_up(mut self) -> Vec<Self> {
        let Some((at, rows)) = upright(&self.rows) else { return vec![self] };
        let table = Self { title: self.title.clone(), rows, is_turned: true };
        self.rows.truncate(at);
        match self.rows.is_empty() {
            true => vec![table],
            false => vec![self, table],
        }
    }

    /// The values beside keys that begin so.
    fn value(&self, key: &str) -> Option<&str> {
        let is_key = |cells: &[String]| {
            cells.first().is_some_and(|cell| letters_and_digits(cell).starts_with(key))
        };
        self.rows.iter().filter(|(_, cells)| is_key(cells)).find_map(|(_, cells)| {
            cells.get(1).map(String::as_str).filter(|value| !value.is_empty())
        })
    }

    /// A row of keys whose value is a number, with its line: the first that begins so.
    pub(crate) fn number(&self, key: &str) -> Option<(&str, f64)> {
        let is_key = |cells: &&(u64, Vec<String>)| {
            cells.1.first().is_some_and(|cell| letters_and_digits(cell).starts_with(key))
        };
        let (_, cells) = self.rows.iter().find(is_key)?;
        Some((cells.first()?.as_str(), number(cells.get(1)?)?))
    }

    /// Whether it has a header and below it a row of numbers.
    pub(crate) fn is_table(&self) -> bool {
        let n_numbers =
            |cells: &[String]| cells.iter().filter(|cell| number(cell).is_some()).count();
        let [(_, header), below @ ..] = self.rows.as_slice() else { return false };
        let is_header = header.len() > 1 && n_numbers(header) == 0;
        is_header && below.iter().any(|(_, cells)| cells.len() > 1 && n_numbers(cells) > 0)
    }

    /// Names of the columns, as a header with the unit in brackets.
    pub(crate) fn header(&self) -> Vec<String> {
        let header = self.rows.first().map_or(&[][..], |(_, cells)| cells);
        header.iter().map(|name| column_name(name)).collect()
    }

    /// The numbers of a column; `None` where a cell is blank or says that nothing was recorded.
    pub(crate) fn column(&self, idx: usize) -> Vec<Option<f64>> {
        let rows = self.rows.iter().skip(1).filter(|(_, cells)| !is_no_data(cells));
        rows.map(|(_, cells)| cells.get(idx).and_then(|cell| number(cell))).collect()
    }

    /// The texts of a column, in the same rows.
    pub(crate) fn texts(&self, idx: usize) -> Vec<String> {
        let rows = self.rows.iter().skip(1).filter(|(_, cells)| !is_no_data(cells));
        rows.map(|(_, cells)| cells.get(idx).cloned().unwrap_or_default()).collect()
    }

    /// Both tables as one, if they are of the seconds before the crash, have the same times and no other column in common.
    fn beside(&self, first: &Self) -> Option<Self> {
        let time_idx = |of: &Self| {
            is_before_crash(of)
                .then(|| of.header().iter().position(|name| name.starts_with("time")))
        };
        let [of_first, of_second] = [time_idx(first)??, time_idx(self)??];
        let (names, others) = (first.header(), self.header());
        let is_common = |(idx, name): (usize, &String)| (idx == of_second) == names.contains(name);
        let is_one = others.iter().enumerate().all(is_common);
        if !is_one || first.column(of_first) != self.column(of_second) {
            return None;
        }
        let rows = |of: &Self| -> Vec<Row> {
            of.rows.iter().filter(|(_, cells)| !is_no_data(cells)).cloned().collect()
        };
        let both = |((line, mut cells), (_, others)): (Row, Row)| -> Row {
            cells.resize(cells.len().max(names.len()), String::new());
            let others = others.into_iter().enumerate().filter(|(idx, _)| *idx != of_second);
            cells.extend(others.map(|(_, cell)| cell));
            (line, cells)
        };
        let rows = rows(first).into_iter().zip(rows(self)).map(both).collect();
        Some(Self { title: first.title.clone(), rows, is_turned: first.is_turned })
    }

    /// The section as text: tabs between the cells, each row in its line.
    fn as_table(&self) -> String {
        let mut text = String::new();
        let mut line = 1;
        let width = self.rows.first().map_or(0, |(_, cells)| cells.len());
        for (row_idx, (number_of_line, cells)) in self.rows.iter().enumerate() {
            if is_no_data(cells) {
                continue;
            }
            while line < *number_of_line {
                text.push('\n');
                line += 1;
            }
            let cell = |idx: usize| {
                let cell = cells.get(idx).map_or("", String::as_str);
                match (row_idx, number(cell)) {
                    (0, _) => column_name(cell),
                    (_, Some(number)) => number_text(number),
                    (_, None) => cell.replace(['\t', '"'], " "),
                }
            };
            let cells: Vec<String> = (0..width.max(cells.len())).map(cell).collect();
            text.push_str(&cells.join("\t"));
        }
        text.push('\n');
        text
    }
}

/// A table of a report as text.
///
/// # Errors
/// [`DataError::NoSheet`] without such a table, [`DataError::OtherFormat`] without any.
pub(super) fn as_table(
    path: &Path,
    text: &str,
    settings: &ReadSettings,
) -> Result<Option<Converted>, DataError> {
    if !is_report(text) {
        return Ok(None);
    }
    let report = Report::parse(path, text)?;
    let tables: Vec<&Section> = report.tables().collect();
    let all: Vec<String> = tables.iter().map(|section| section.title.clone()).collect();
    let first = tables.iter().position(|section| is_before_crash(section));
    let first = first.or((!tables.is_empty()).then_some(0));
    let Some(first) = first else {
        let remedy = "it holds no table of recorded data: export it again, or enter its values as [edr] in \
                      the evidence of a reconstruction";
        let format = "the report of a Bosch CDR tool";
        return Err(DataError::OtherFormat { path: path.to_owned(), format, remedy });
    };
    let chosen = match &settings.sheet {
        None => Some(first),
        Some(SheetRef::Number(number)) => number.checked_sub(1),
        Some(SheetRef::Name(name)) => all.iter().position(|title| title == name),
    };
    let Some((section, name)) = chosen.and_then(|idx| Some((*tables.get(idx)?, all.get(idx)?)))
    else {
        let wanted = settings.sheet.as_ref().map_or_else(String::new, SheetRef::to_string);
        return Err(DataError::NoSheet { path: path.to_owned(), wanted, found: all });
    };
    let in_row = if section.is_turned { ", whose times stand in a row" } else { "" };
    let said = Said {
        description: format!("{}; read is {name:?}{in_row}", report.description()),
        doubts: report.doubts(),
        part: Some(Sheet { name: name.clone(), all: all.clone() }),
        device: report.value("edrdevicetype").unwrap_or("CDR").to_owned(),
        keeps_lines: !section.is_turned,
        ..Said::default()
    };
    Ok(Some(Converted { text: section.as_table(), said }))
}

/// Whether a section is a table of the seconds before the crash.
pub(crate) fn is_before_crash(section: &Section) -> bool {
    letters_and_digits(&section.title).starts_with("precrash") && section.is_table()
}

/// Whether a section is named as a table over time: of the seconds before the crash, or of a change of velocity.
pub(crate) fn is_over_time(section: &Section) -> bool {
    let title = letters_and_digits(&section.title);
    let words = ["precrash", "longitudinal", "lateral", "deltav"];
    words.iter().any(|word| title.starts_with(word))
}

/// Whether a section has a table over time that is not read: one without a header, and without times in a row.
pub(crate) fn is_unread(section: &Section) -> bool {
    let is_row = |cells: &[String]| cells.len() > 2 && !is_no_data(cells);
    is_over_time(section)
        && !section.is_table()
        && section.rows.iter().any(|(_, cells)| is_row(cells))
}

/// The tables among sections of one event. A tool divides a wide table of the seconds before the crash into several,
/// which have the same times and other columns; they are made one again.
pub(crate) fn joined<'a>(sections: &[&'a Section]) -> Vec<Cow<'a, Section>> {
    let mut tables: Vec<Cow<'a, Section>> = Vec::new();
    for section in sections.iter().copied().filter(|section| section.is_table()) {
        let mut earlier = tables.iter().enumerate();
        match earlier.find_map(|(at, first)| Some((at, section.beside(first)?))) {
            Some((at, both)) => tables[at] = Cow::Owned(both),
            None => tables.push(Cow::Borrowed(section)),
        }
    }
    tables
}

/// The number at the beginning of a cell: `31 [50]` is 31.
pub(crate) fn number(cell: &str) -> Option<f64> {
    number_in(cell, false)
}

/// - `decimal_comma`: whether the decimal sign may be a comma.
fn number_in(cell: &str, decimal_comma: bool) -> Option<f64> {
    let first = match cell.split_once('[') {
        Some((first, rest)) if rest.trim_end().ends_with(']') => first.trim(),
        _ => cell.trim(),
    };
    Dialect { separator: Separator::Tab, decimal_comma, thousands: None }.number(first)
}

/// Line and cells of the rows of a report that are not blank, without blank cells at their ends. Where numbers have
/// decimal commas, those become points.
fn rows_of(text: &str) -> Vec<Row> {
    let separator = separator(text);
    let cells = |line: &str| -> Vec<String> {
        let cells = split(line, separator);
        let n_cells = cells.iter().rposition(|cell| !cell.trim().is_empty()).map_or(0, |at| at + 1);
        cells.iter().take(n_cells).map(|cell| cell.trim().to_owned()).collect()
    };
    let rows = (1..).zip(text.lines().map(cells));
    let mut rows: Vec<Row> = rows.filter(|(_, cells)| !cells.is_empty()).collect();
    let mut marks = Marks::default();
    let all = rows.iter().flat_map(|(_, cells)| cells);
    all.flat_map(|cell| cell.split(['[', ']'])).for_each(|part| marks.add(part));
    if marks.is_decimal(Thousands::Comma) {
        let has_comma = |cell: &&mut String| cell.contains(',') && number_in(cell, true).is_some();
        let cells = rows.iter_mut().flat_map(|(_, cells)| cells).filter(has_comma);
        cells.for_each(|cell| *cell = cell.replace(',', "."));
    }
    rows
}

/// The name of a section, if a line is one: one cell, or one that its commas have divided.
fn title(cells: &[String]) -> Option<String> {
    let is_capital =
        |cell: &String| cell.chars().any(char::is_alphabetic) && cell.to_uppercase() == *cell;
    let joined = cells.join(" ");
    let lower = joined.to_lowercase();
    let is_known = TITLES.iter().any(|title| lower.starts_with(title));
    let is_title = match cells {
        [cell] => is_known || (is_capital(cell) && cell.contains(' ')),
        _ => is_known && cells.iter().all(is_capital),
    };
    // A comma would end the name in the text of a map.
    (is_title && !is_no_data(cells)).then(|| shortened(&joined).replace(',', ""))
}

fn is_no_data(cells: &[String]) -> bool {
    cells.first().is_some_and(|cell| cell.to_lowercase().contains("no recorded data"))
}

/// A header as the columns of a table are named: the first of two units in brackets, and the words of
/// recorders by those of this program. Columns whose sign differs from report to report keep their names.
pub(crate) fn column_name(name: &str) -> String {
    let name = name.replace(['\t', '"'], " ");
    let name = name.trim();
    let in_parentheses = || {
        let (bare, rest) = name.rsplit_once('(')?;
        let symbol = rest.split(['[', ')', ',']).next().unwrap_or_default();
        Some((bare.trim(), symbol.trim()))
    };
    let (bare, symbol) = two_units(name).or_else(in_parentheses).unwrap_or((name, ""));
    let key = letters_and_digits(bare);
    let has = |word: &str| key.contains(word);
    let is = |quantity| unit(quantity, symbol).is_some();
    let of = |name: &str| format!("{name} [{symbol}]");
    match () {
        () if is(Quantity::Time) && has("time") && !has("maximum") => of("time"),
        () if is(Quantity::Speed) && has("speed") && !has("wheelspeed") => of("speed"),
        () if is(Quantity::Angle) && has("steering") => of("steering wheel"),
        () if symbol.is_empty() => bare.to_owned(),
        () => format!("{bare} [{symbol}]"),
    }
}

/// The name and the first of two units that have no parentheses around them: `Speed vehicle indicated MPH [km/h]`.
fn two_units(name: &str) -> Option<(&str, &str)> {
    let (first, second) = name.strip_suffix(']')?.rsplit_once('[')?;
    let first = first.trim_end();
    let (bare, symbol) = first.rsplit_once([' ', ',']).unwrap_or(("", first));
    let are_of = |of: &Quantity| unit(*of, symbol).is_some() && unit(*of, second).is_some();
    Quantity::ALL.iter().any(are_of).then_some((bare.trim_end(), symbol.trim_matches(['(', ')'])))
}

/// The one of comma, semicolon and tab by which most cells are numbers, with either decimal sign; of those by which as
/// many are, the one that a report has most of.
fn separator(text: &str) -> Separator {
    let separators = [Separator::Tab, Separator::Semicolon, Separator::Comma];
    let lines = || text.lines().take(SNIFFED_LINES);
    let count = |separator: &Separator| {
        let cells = lines().flat_map(|line| split(line, *separator));
        let n_numbers = cells.filter(|cell| number_in(cell, true).is_some()).count();
        let n_signs = lines().flat_map(str::bytes).filter(|byte| *byte == separator.byte()).count();
        (n_numbers, n_signs)
    };
    separators.into_iter().max_by_key(count).unwrap_or(Separator::Comma)
}

fn shortened(text: &str) -> String {
    text.chars().filter(|c| !c.is_control()).take(SHOWN_CHARS).collect()
}

#[cfg(test)]
#[path = "cdr_tests.rs"]
mod tests;
