//! The numbers of a predicted force, with intervals.

use egui::{Grid, Ui};

use crate::analysis::ForceForecast;
use crate::app::force::Forecast;
use crate::app::widgets::{SpreadRow, spread_table_ui, value_row};
use crate::collision::PrincipalDirectionOfForce;
use crate::units::{Quantity, UnitSystem};

/// Components of a mixture that are spelled out.
const SHOWN_MODES: usize = 4;
/// Weight below which a component is not.
const LEAST_WEIGHT: f64 = 0.01;

/// Draws the numbers and a button that copies them.
pub fn numbers_ui(ui: &mut Ui, forecast: &Forecast, (name, units): (&str, UnitSystem)) {
    spread_table_ui(ui, name, &rows(&forecast.force, units));
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

fn rows(force: &ForceForecast, units: UnitSystem) -> Vec<SpreadRow> {
    let unit = |quantity: Quantity| quantity.display_unit(units);
    let milliseconds = || {
        let times = Quantity::Time.units();
        *times.iter().find(|unit| unit.symbol == "ms").unwrap_or(&times[0])
    };
    let [px, py] = force.impulse_n_s;
    let row = |label, unit, spread, hint| SpreadRow { label, unit, spread, hint };
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
