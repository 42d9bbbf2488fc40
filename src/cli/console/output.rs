//! Text tables and JSON.

use std::io::{self, Write};

use serde::Serialize;

use crate::cli::CliError;
use crate::cli::console::within_line;

/// Number of characters of a cell that are printed if another stands beside it.
const MAX_CELL_CHARS: usize = 200;

/// Prints a value as indented JSON and a line end, or nothing of it if JSON cannot hold it.
pub(in crate::cli) fn print_json(
    out: &mut dyn Write,
    value: &impl Serialize,
) -> Result<(), CliError> {
    let mut json = serde_json::to_vec_pretty(value).map_err(CliError::NotUnicode)?;
    json.push(b'\n');
    Ok(out.write_all(&json)?)
}

/// Prints rows as aligned columns, two blanks apart; a column of numbers only is set to the right.
pub(in crate::cli) fn print_table(
    out: &mut dyn Write,
    header: &[&str],
    rows: &[Vec<String>],
) -> io::Result<()> {
    let header: Vec<String> = header.iter().map(|&name| name.to_owned()).collect();
    let rows: Vec<Vec<String>> = rows.iter().map(|row| shown_row(row)).collect();
    let rows = rows.as_slice();
    let columns: Vec<TextColumn> =
        (0..header.len()).map(|idx| TextColumn::new(&header, rows, idx)).collect();
    let titled = header.iter().any(|name| !name.is_empty());
    for row in titled.then_some(&header).into_iter().chain(rows) {
        let cells = row.iter().zip(&columns);
        let line: Vec<String> = cells.map(|(cell, column)| column.pad(cell)).collect();
        writeln!(out, "{}", line.join("  ").trim_end())?;
    }
    Ok(())
}

/// The texts of a row within their line; a long one with another beside it, or of digits, is cut.
fn shown_row(row: &[String]) -> Vec<String> {
    let last = row.iter().rposition(|cell| !cell.is_empty());
    let shown = |(idx, cell): (usize, &String)| {
        let is_whole = Some(idx) == last && cell.parse::<f64>().is_err();
        let cell = within_line(cell);
        match cell.char_indices().nth(MAX_CELL_CHARS) {
            Some((at, _)) if !is_whole => format!("{}…", cell.get(..at).unwrap_or_default()),
            _ => cell.into_owned(),
        }
    };
    row.iter().enumerate().map(shown).collect()
}

struct TextColumn {
    width: usize,
    is_numeric: bool,
}

impl TextColumn {
    fn new(header: &[String], rows: &[Vec<String>], idx: usize) -> Self {
        let cells = || rows.iter().filter_map(|row| Some((row.get(idx)?, row.get(idx + 1..)?)));
        let is_number = |cell: &String| cell.is_empty() || cell.parse::<f64>().is_ok();
        let is_numeric = cells().all(|(cell, _)| is_number(cell));
        // A text with nothing beside it does not push the columns apart.
        let has_room = |beside: &[String]| !is_numeric && beside.iter().all(String::is_empty);
        let cells = cells().filter(|(_, beside)| !has_room(beside)).map(|(cell, _)| cell);
        let widths = cells.chain(header.get(idx)).map(|cell| cell.chars().count());
        Self { width: widths.max().unwrap_or(0), is_numeric }
    }

    fn pad(&self, cell: &str) -> String {
        let width = self.width;
        if self.is_numeric { format!("{cell:>width$}") } else { format!("{cell:<width$}") }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stand_right_and_text_left() {
        let rows = [["a", "1.5"], ["bcd", "-10"]].map(|row| row.map(str::to_owned).to_vec());
        let mut text = Vec::new();
        print_table(&mut text, &["name", "m"], &rows).unwrap();
        let expected = "name    m\na     1.5\nbcd   -10\n";
        assert_eq!(String::from_utf8(text).unwrap(), expected);
    }

    #[test]
    fn a_text_with_nothing_beside_it_does_not_push_the_columns_apart() {
        let rows = [["a", "1 m", "0 to 2 m"], ["b", "some long text", ""]];
        let rows = rows.map(|row| row.map(str::to_owned).to_vec());
        let mut text = Vec::new();
        print_table(&mut text, &["", "median", "90 %"], &rows).unwrap();
        let expected = "   median  90 %\na  1 m     0 to 2 m\nb  some long text\n";
        assert_eq!(String::from_utf8(text).unwrap(), expected);
    }

    #[test]
    fn a_cell_of_any_length_is_cut_to_what_fits() {
        // Wider columns than 65535 characters cannot be formatted.
        let long = "a".repeat(70_000);
        let rows = [[&*long, "b\n"], [&*long, ""], ["", &*long]];
        let rows = rows.map(|row| row.map(str::to_owned).to_vec());
        let mut text = Vec::new();
        print_table(&mut text, &["name", ""], &rows).unwrap();
        let text = String::from_utf8(text).unwrap();
        let beside = format!("{}…  b\\u000a", "a".repeat(200));
        let last = format!("{}{long}", " ".repeat(203));
        assert!(text.lines().skip(1).eq([&*beside, &*long, &*last]));
    }
}
