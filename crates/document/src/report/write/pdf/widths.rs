//! Widths of the columns of a table: those with which it takes the fewest lines.

use crate::report::column_widths;
use crate::report::write::pdf::fonts::Fonts;
use crate::report::write::pdf::lines::{n_lines, words};
use crate::report::{Column, Table};

/// Room that is moved from one column to another in search of fewer lines, points: from coarse to fine.
const STEPS_PT: [f32; 4] = [24.0, 12.0, 6.0, 3.0];
/// Rounds of such moves at one step.
const MOST_ROUNDS: usize = 12;
/// The widest that a column is for the sake of its longest word, as a share of the table.
const WIDEST_WORD: f32 = 0.34;

/// How the cells of a table are set.
#[derive(Debug, Clone, Copy)]
pub(super) struct CellStyle {
    /// Size of the text, points.
    pub size_pt: f32,
    /// Distance of the text from the sides of its cell, points.
    pub padding_pt: f32,
}

/// The words of a cell by their widths, points.
struct Cell {
    words_pt: Vec<f32>,
    /// Of all of them in one line.
    line_pt: f32,
}

/// Whether the longest words of the columns stand beside each other, all but those for which no column is wide
/// enough.
pub(super) fn fits_words(table: &Table, style: CellStyle, fonts: &Fonts, width_pt: f32) -> bool {
    let rows = rows_of(table, style, fonts);
    least_widths(&rows, table.columns.len(), style, width_pt).iter().sum::<f32>() <= width_pt
}

/// The cells of the titles and of all rows.
fn rows_of(table: &Table, style: CellStyle, fonts: &Fonts) -> Vec<Vec<Cell>> {
    let space_pt = style.size_pt * fonts.width(" ");
    let cell = |text: &str| {
        let words_pt: Vec<f32> =
            words(text).iter().map(|word| style.size_pt * fonts.width(word)).collect();
        let gaps_pt = space_pt * words_pt.len().saturating_sub(1) as f32;
        let line_pt = words_pt.iter().sum::<f32>() + gaps_pt;
        Cell { words_pt, line_pt }
    };
    let n = table.columns.len();
    let titles = table.columns.iter().map(|Column { title, .. }| cell(title)).collect();
    let rows = table.rows.iter().map(|row| row.iter().take(n).map(|text| cell(text)).collect());
    std::iter::once(titles).chain(rows).collect()
}

/// Width of a column by the widest of its cells, points.
fn column_pt(rows: &[Vec<Cell>], idx: usize, style: CellStyle, size: &dyn Fn(&Cell) -> f32) -> f32 {
    let widest = rows.iter().filter_map(|row| row.get(idx)).map(size).fold(8.0, f32::max);
    widest + 2.0 * style.padding_pt + 0.5
}

/// Widths of the columns for their longest words, points.
fn least_widths(rows: &[Vec<Cell>], n: usize, style: CellStyle, width_pt: f32) -> Vec<f32> {
    let widest_word = |cell: &Cell| cell.words_pt.iter().copied().fold(0.0, f32::max);
    let least = |idx: usize| column_pt(rows, idx, style, &widest_word).min(WIDEST_WORD * width_pt);
    (0..n).map(least).collect()
}

/// Widths of the columns that are together the width of the table, points.
pub(super) fn widths_of(table: &Table, style: CellStyle, fonts: &Fonts, width_pt: f32) -> Vec<f32> {
    let n = table.columns.len();
    let space_pt = style.size_pt * fonts.width(" ");
    let rows = rows_of(table, style, fonts);
    let wanted: Vec<f32> =
        (0..n).map(|idx| column_pt(&rows, idx, style, &|cell| cell.line_pt)).collect();
    let least = least_widths(&rows, n, style, width_pt);
    let widths = column_widths(&wanted, &least, width_pt);
    let (all_wanted, all_least): (f32, f32) = (wanted.iter().sum(), least.iter().sum());
    if all_wanted <= width_pt || all_least >= width_pt {
        return widths;
    }
    let n_of_row = |row: &Vec<Cell>, widths: &[f32]| {
        let of_cell = |(cell, width): (&Cell, &f32)| {
            n_lines(&cell.words_pt, space_pt, width - 2.0 * style.padding_pt)
        };
        row.iter().zip(widths).map(of_cell).max().unwrap_or(0)
    };
    let all_lines = |widths: &[f32]| rows.iter().map(|row| n_of_row(row, widths)).sum::<usize>();
    with_fewest_lines(widths, &least, &all_lines)
}

/// Moves room between columns as long as that saves lines.
fn with_fewest_lines(
    mut widths: Vec<f32>,
    least: &[f32],
    all_lines: &dyn Fn(&[f32]) -> usize,
) -> Vec<f32> {
    let mut fewest = all_lines(&widths);
    for step_pt in STEPS_PT {
        for _ in 0..MOST_ROUNDS {
            let before = fewest;
            for (from, least_pt) in least.iter().enumerate() {
                for to in (0..widths.len()).filter(|to| *to != from) {
                    let moved = with_moved(&widths, [from, to], step_pt);
                    let is_possible = moved.get(from).is_some_and(|width| width >= least_pt);
                    let n = if is_possible { all_lines(&moved) } else { fewest };
                    if n < fewest {
                        (widths, fewest) = (moved, n);
                    }
                }
            }
            if fewest == before {
                break;
            }
        }
    }
    widths
}

/// The widths after some room went from one column to another.
fn with_moved(widths: &[f32], [from, to]: [usize; 2], step_pt: f32) -> Vec<f32> {
    let moved = |(idx, width): (usize, &f32)| match idx {
        _ if idx == from => width - step_pt,
        _ if idx == to => width + step_pt,
        _ => *width,
    };
    widths.iter().enumerate().map(moved).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// “Medianfe hler” stood in the table of eleven columns of a reconstruction.
    #[test]
    fn words_that_are_too_wide_for_their_columns_fit_in_smaller_letters() {
        let fonts = Fonts::load().unwrap();
        let fits = |size_pt| {
            let style = CellStyle { size_pt, padding_pt: 3.5 };
            let words = ["Annäherungsgeschwindigkeit", "Rechnungen", "(84–100)", "Medianfehler"];
            let row = [words; 2].concat();
            let columns =
                row.iter().map(|title| Column { title: (*title).to_owned(), is_numeric: false });
            let table =
                Table { caption: String::new(), columns: columns.collect(), rows: Vec::new() };
            fits_words(&table, style, &fonts, 499.0)
        };
        assert!(!fits(9.5) && fits(6.5));
    }

    /// A short column had as much room as it liked, and long ones took three lines for two.
    #[test]
    fn columns_have_the_widths_with_which_the_table_is_low() {
        let fonts = Fonts::load().unwrap();
        let style = CellStyle { size_pt: 9.5, padding_pt: 3.5 };
        let cells = |text: &str| [text.to_owned(), "a b c d e f g h i".to_owned(), text.repeat(3)];
        let rows = (0..6).map(|_| cells("a few words of a cell ")).collect();
        let table = Table::new("", ["first", "second", "third"], rows);
        let widths = widths_of(&table, style, &fonts, 300.0);
        let sum: f32 = widths.iter().sum();
        assert!((sum - 300.0).abs() < 0.1, "{widths:?}");
        assert!(widths.iter().all(|width| *width > 15.0), "{widths:?}");
        let n = |widths: &[f32]| -> usize {
            let of_cell = |(text, width): (&String, &f32)| {
                crate::report::write::pdf::lines::lines(text, &fonts, 9.5, width - 7.0).len()
            };
            let of_row = |row: &Vec<String>| row.iter().zip(widths).map(of_cell).max().unwrap_or(0);
            table.rows.iter().map(of_row).sum()
        };
        assert!(n(&widths) < n(&[100.0; 3]), "{widths:?}");
    }
}
