//! The characteristic numbers of a predicted force with their intervals, and the components of the
//! predicted mixture.

use egui::{Grid, Ui};

use crate::app::command::Command;
use crate::app::widgets::{SpreadRow, caveats_ui, spread_table_ui, value_row};
use impactlab_core::units::{Quantity, UnitSystem, percent, significant};
use impactlab_study::PredictForceReport;
use impactlab_study::analysis::Estimate;

/// Largest number of mixture components that are listed; of further ones the number is shown.
const SHOWN_MODES: usize = 4;
/// Weight below which a mixture component is not listed.
const LEAST_WEIGHT: f64 = 0.01;

/// Draws the badges and what is not used, the table of the numbers, which can be copied, the impulse of the momentum solution, the
/// clock direction, the probability of hooking, and the components of the mixture.
pub fn numbers_ui(
    ui: &mut Ui,
    report: &PredictForceReport,
    units: UnitSystem,
    commands: &mut Vec<Command>,
) {
    caveats_ui(ui, &report.caveats, commands);
    spread_table_ui(ui, &report.scenario, &rows(report, units));
    Grid::new("force momentum").num_columns(2).show(ui, |ui| {
        let momentum = Quantity::Impulse.shown_vector(report.momentum_impulse_n_s, units);
        value_row(ui, "Momentum solution", &momentum);
        if let Some(implied) = &report.implied_contact {
            let shown = |of: &Estimate| {
                let [low, high] = of.spread().ninety.map(significant);
                format!("{} ({low} to {high})", significant(of.median))
            };
            value_row(ui, "Implied restitution e", &shown(&implied.restitution));
            value_row(ui, "Implied P_τ/P_n", &shown(&implied.impulse_ratio));
            let used = &implied.momentum;
            let own = format!("e {}, μ_c {}", used.restitution, significant(used.friction_limit));
            value_row(ui, "Solver uses", &own);
        }
        value_row(ui, "PDOF, clock direction", &format!("{} o'clock", report.pdof_clock));
        if let Some(probability) = report.hooking_probability {
            value_row(ui, "Hooking probability", &percent(probability));
        }
    });
    modes_ui(ui, report, units);
}

/// The rows of the table: impulse, peak, duration and principal direction of force (PDOF).
fn rows(report: &PredictForceReport, units: UnitSystem) -> Vec<SpreadRow> {
    let unit = |quantity: Quantity| quantity.display_unit(units);
    let milliseconds = || {
        let times = Quantity::Time.units();
        *times.iter().find(|unit| unit.symbol == "ms").unwrap_or(&times[0])
    };
    let impulse = &report.impulse_n_s;
    let pdof_rad = report.pdof_interval_deg.scaled(1.0_f64.to_radians());
    let row = |label, unit, estimate: &Estimate, hint| {
        let spread = estimate.spread();
        SpreadRow { label, unit, spread, ninety_five: None, hint }
    };
    vec![
        row("P_x", unit(Quantity::Impulse), &impulse.x, "Impulse on the target along its heading"),
        row("P_y", unit(Quantity::Impulse), &impulse.y, "Impulse on the target to its left"),
        row("|P|", unit(Quantity::Impulse), &impulse.magnitude, "Size of the impulse"),
        row("Peak |F|", unit(Quantity::Force), &report.peak_n, "Largest force, a mean over 1 ms"),
        row("at", milliseconds(), &report.peak_time_s, "When the largest force is reached"),
        row("Duration", milliseconds(), &report.duration_s, "From first touch to last separation"),
        row(
            "PDOF",
            unit(Quantity::Angle),
            &pdof_rad,
            "Principal direction of force on the target: clockwise from straight ahead, where the force comes from",
        ),
    ]
}

/// Draws the components of the mixture, each with its weight and the numbers of its mean curve, in
/// order of falling weight. A mixture with fewer than two components of notable weight draws
/// nothing.
fn modes_ui(ui: &mut Ui, report: &PredictForceReport, units: UnitSystem) {
    let likely: Vec<_> = report.modes.iter().filter(|mode| mode.weight >= LEAST_WEIGHT).collect();
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
            ui.monospace(percent(mode.weight));
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
