//! A table of predicted quantities: the median with the intervals that hold 50 % and 90 %.

use egui::{Grid, Ui};

use impactlab_core::units::{Unit, significant};
use impactlab_study::analysis::Spread;

/// Significant digits of the numbers in the table.
const DIGITS: i32 = 3;

/// One predicted quantity of the table.
pub struct SpreadRow {
    /// Name of the quantity.
    pub label: &'static str,
    /// Unit in which the quantity is shown.
    pub unit: Unit,
    /// Median and ends of the intervals, SI units.
    pub spread: Spread,
    /// Ends of the interval that holds 95 %, if the table shows it: in all of its rows or in none.
    pub ninety_five: Option<[f64; 2]>,
    /// Explanation of the quantity, shown on hover.
    pub hint: &'static str,
}

/// Draws the table with a button that copies it to the clipboard, separated by tabs.
///
/// The identifier of the grid is fixed, so a panel should hold only one such table.
///
/// - `name`: the case or scenario to which the numbers belong; first cell of the copied table.
pub fn spread_table_ui(ui: &mut Ui, name: &str, rows: &[SpreadRow]) {
    ui.horizontal(|ui| {
        ui.strong("Numbers");
        let hint = "As a table for a spreadsheet, separated by tabs";
        if ui.small_button("Copy table").on_hover_text(hint).clicked() {
            ui.ctx().copy_text(table(name, rows));
        }
    });
    let titles = [
        ("", ""),
        ("median", "As likely exceeded as not"),
        ("50 %", "Interval that holds half of what may happen"),
        ("90 %", "Interval that holds nine tenths of what may happen"),
        ("95 %", "Interval that leaves out one case of twenty"),
    ];
    let n_columns = titles.len() - usize::from(rows.iter().all(|row| row.ninety_five.is_none()));
    Grid::new("spread table").striped(true).num_columns(n_columns).show(ui, |ui| {
        for (title, hint) in titles.into_iter().take(n_columns) {
            ui.strong(title).on_hover_text(hint);
        }
        ui.end_row();
        for row in rows {
            let label = match row.unit.symbol {
                "" => row.label.to_owned(),
                symbol => format!("{} [{symbol}]", row.label),
            };
            ui.label(label).on_hover_text(row.hint);
            for text in texts(row) {
                ui.label(text);
            }
            ui.end_row();
        }
    });
}

/// Median and intervals in the unit of the row, as they are shown.
fn texts(row: &SpreadRow) -> Vec<String> {
    let text = |value| rounded(row.unit.from_si(value));
    let interval = |[low, high]: [f64; 2]| format!("{} … {}", text(low), text(high));
    let usual = [text(row.spread.median), interval(row.spread.half), interval(row.spread.ninety)];
    usual.into_iter().chain(row.ninety_five.map(interval)).collect()
}

/// Formats a number with [`DIGITS`] significant digits and at most 6 decimals. Digits before the
/// decimal point are never rounded away.
fn rounded(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let decimals = (DIGITS - 1 - value.abs().log10().floor() as i32).clamp(0, 6) as usize;
    format!("{value:.decimals$}")
}

/// The table as tab-separated text: one line per quantity, with the lower and the upper end of each
/// interval in columns of their own.
fn table(name: &str, rows: &[SpreadRow]) -> String {
    let has_wider = rows.iter().any(|row| row.ninety_five.is_some());
    let wider = if has_wider { "\t95 % low\t95 % high" } else { "" };
    let head = format!("{name}\tunit\tmedian\t50 % low\t50 % high\t90 % low\t90 % high{wider}");
    let line = |row: &SpreadRow| {
        let Spread { median, half: [a, b], ninety: [c, d] } = row.spread;
        let wider = row.ninety_five.into_iter().flatten();
        let values = [median, a, b, c, d].into_iter().chain(wider);
        let texts: Vec<_> = values.map(|value| significant(row.unit.from_si(value))).collect();
        format!("{}\t{}\t{}", row.label, row.unit.symbol, texts.join("\t"))
    };
    std::iter::once(head).chain(rows.iter().map(line)).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::units::{Quantity, UnitSystem};

    #[test]
    fn the_copied_table_has_a_row_a_number() {
        let spread = Spread { median: 3000.0, half: [2900.0, 3100.0], ninety: [2500.0, 3500.0] };
        let unit = Quantity::Impulse.display_unit(UnitSystem::Si);
        let rows = [SpreadRow { label: "|P|", unit, spread, ninety_five: None, hint: "" }];
        let expected = "c001\tunit\tmedian\t50 % low\t50 % high\t90 % low\t90 % high\n|P|\tkN s\t3.000\t2.900\t3.100\t2.500\t3.500";
        assert_eq!(table("c001", &rows), expected);
    }
}
