//! The numbers of a predicted force, with intervals.

use egui::{Grid, Ui};

use crate::analysis::{ForceForecast, Spread};
use crate::app::force::Forecast;
use crate::app::widgets::value_row;
use crate::collision::PrincipalDirectionOfForce;
use crate::units::{Quantity, Unit, UnitSystem, significant};

/// Digits of a number beside its interval.
const DIGITS: i32 = 3;

/// Components of a mixture that are spelled out.
const SHOWN_MODES: usize = 4;
/// Weight below which a component is not.
const LEAST_WEIGHT: f64 = 0.01;

/// A number, its unit, and what it is.
struct Row {
    label: &'static str,
    unit: Unit,
    spread: Spread,
    hint: &'static str,
}

/// Draws the numbers and a button that copies them.
pub fn numbers_ui(ui: &mut Ui, forecast: &Forecast, (name, units): (&str, UnitSystem)) {
    let rows = rows(&forecast.force, units);
    ui.horizontal(|ui| {
        ui.strong("Numbers");
        let hint = "As a table for a spreadsheet, separated by tabs";
        if ui.small_button("Copy table").on_hover_text(hint).clicked() {
            ui.ctx().copy_text(table(name, &rows));
        }
    });
    Grid::new("force numbers").striped(true).num_columns(4).show(ui, |ui| {
        for (title, hint) in [
            ("", ""),
            ("median", "As likely exceeded as not"),
            ("50 %", "Interval that holds half of what may happen"),
            ("90 %", "Interval that holds nine tenths of what may happen"),
        ] {
            ui.strong(title).on_hover_text(hint);
        }
        ui.end_row();
        for row in &rows {
            ui.label(format!("{} [{}]", row.label, row.unit.symbol)).on_hover_text(row.hint);
            let [median, half, ninety] = texts(row);
            for text in [median, half, ninety] {
                ui.monospace(text);
            }
            ui.end_row();
        }
    });
    Grid::new("force momentum").num_columns(2).show(ui, |ui| {
        let momentum = Quantity::Impulse.shown_vector(forecast.momentum_impulse_n_s, units);
        value_row(ui, "Momentum solution", &momentum);
        let angle_rad = forecast.force.pdof_rad.median;
        let clock = PrincipalDirectionOfForce { angle_rad }.clock();
        value_row(ui, "PDOF, clock direction", &format!("{clock} o'clock"));
        if let Some(probability) = forecast.hooking_probability {
            let text = format!("{:.1} %", probability * 100.0);
            value_row(ui, "Hooking probability", &text);
        }
    });
    modes_ui(ui, &forecast.force, units);
}

fn rows(force: &ForceForecast, units: UnitSystem) -> Vec<Row> {
    let unit = |quantity: Quantity| quantity.display_unit(units);
    let milliseconds = || {
        let times = Quantity::Time.units();
        *times.iter().find(|unit| unit.symbol == "ms").unwrap_or(&times[0])
    };
    let [px, py] = force.impulse_n_s;
    let row = |label, unit, spread, hint| Row { label, unit, spread, hint };
    vec![
        row("P_x", unit(Quantity::Impulse), px, "Impulse on the target along its heading"),
        row("P_y", unit(Quantity::Impulse), py, "Impulse on the target to its left"),
        row("|P|", unit(Quantity::Impulse), force.impulse_magnitude_n_s, "Size of the impulse"),
        row("Peak |F|", unit(Quantity::Force), force.peak_n, "Largest force, a mean over 1 ms"),
        row("at", milliseconds(), force.peak_time_s, "When the largest force is reached"),
        row("Duration", milliseconds(), force.duration_s, "From first touch to last separation"),
        row(
            "PDOF",
            unit(Quantity::Angle),
            force.pdof_rad,
            "Principal direction of force on the target: clockwise from straight ahead, where the force comes from",
        ),
    ]
}

fn texts(row: &Row) -> [String; 3] {
    let text = |value| rounded(row.unit.from_si(value));
    let interval = |[low, high]: [f64; 2]| format!("{} … {}", text(low), text(high));
    [text(row.spread.median), interval(row.spread.half), interval(row.spread.ninety)]
}

/// A number with [`DIGITS`] digits, those before the point in any case.
fn rounded(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let decimals = (DIGITS - 1 - value.abs().log10().floor() as i32).clamp(0, 6) as usize;
    format!("{value:.decimals$}")
}

/// Tab-separated, with both ends of the intervals.
fn table(name: &str, rows: &[Row]) -> String {
    let head = format!("{name}\tunit\tmedian\t50 % low\t50 % high\t90 % low\t90 % high");
    let line = |row: &Row| {
        let Spread { median, half: [a, b], ninety: [c, d] } = row.spread;
        let values = [median, a, b, c, d].map(|value| significant(row.unit.from_si(value)));
        format!("{}\t{}\t{}", row.label, row.unit.symbol, values.join("\t"))
    };
    std::iter::once(head).chain(rows.iter().map(line)).collect::<Vec<_>>().join("\n")
}

/// The ways in which it may go, the likeliest first.
fn modes_ui(ui: &mut Ui, force: &ForceForecast, units: UnitSystem) {
    let likely: Vec<_> = force.modes.iter().filter(|mode| mode.weight >= LEAST_WEIGHT).collect();
    if likely.len() < 2 {
        return;
    }
    ui.strong("Ways in which it may go")
        .on_hover_text("Components of the mixture, each with its mean curve");
    Grid::new("force modes").striped(true).num_columns(4).show(ui, |ui| {
        for title in ["weight", "impulse", "peak |F|", "duration"] {
            ui.strong(title);
        }
        ui.end_row();
        for mode in likely.iter().take(SHOWN_MODES) {
            ui.monospace(format!("{:.1} %", mode.weight * 100.0));
            ui.monospace(Quantity::Impulse.shown_vector(mode.impulse_n_s, units));
            ui.monospace(Quantity::Force.shown(mode.peak_n, units));
            ui.monospace(format!("{:.0} ms", mode.duration_s * 1e3));
            ui.end_row();
        }
    });
    if likely.len() > SHOWN_MODES {
        ui.weak(format!("and {} more", likely.len() - SHOWN_MODES));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_copied_table_has_a_row_a_number() {
        let spread = Spread { median: 3000.0, half: [2900.0, 3100.0], ninety: [2500.0, 3500.0] };
        let unit = Quantity::Impulse.display_unit(UnitSystem::Si);
        let rows = [Row { label: "|P|", unit, spread, hint: "" }];
        let expected = "c001\tunit\tmedian\t50 % low\t50 % high\t90 % low\t90 % high\n|P|\tkN s\t3.000\t2.900\t3.100\t2.500\t3.500";
        assert_eq!(table("c001", &rows), expected);
    }
}
