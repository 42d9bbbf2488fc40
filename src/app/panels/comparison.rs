//! Simulation against reference: one case and the whole data set.

use egui::{Grid, ScrollArea, Ui};

use crate::analysis::Analysis;
use crate::app::case_table::listed_in;
use crate::app::command::Command;
use crate::app::panels::analysis_or_hint;
use crate::app::panes::PaneContext;
use crate::app::state::ReplayStatus;
use crate::app::widgets::value_row;
use crate::compare::{DatasetReplay, ErrorSummary, HORIZONS_S, MotionError, Replay};
use crate::data::{DatasetKind, Severity};
use crate::numerics::Summary;
use crate::render::theme;
use crate::units::{Quantity, UnitSystem, significant};

/// Draws the error figures.
pub fn comparison_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { view, session, commands, .. } = pane;
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        if let Some(analysis) = analysis_or_hint(ui, session) {
            case_ui(ui, analysis, view.units);
        }
        ui.separator();
        let (Some(path), Some(checked)) = (&view.listed, listed_in(&session.sources, view)) else {
            return;
        };
        if checked.dataset.kind != DatasetKind::Trajectory {
            ui.weak("The listed data set has no recorded motions to compare with.");
            return;
        }
        match session.replays.get(path) {
            None => {
                let label = format!("Simulate all {} cases", checked.dataset.cases.len());
                if ui.button(label).on_hover_text("4DOF against every recorded motion").clicked() {
                    commands.push(Command::ReplayDataset(path.clone()));
                }
            }
            Some(ReplayStatus::Running(_)) => {
                ui.horizontal(|ui| (ui.spinner(), ui.label("Simulating…")));
            }
            Some(ReplayStatus::Done(replay)) => {
                dataset_ui(ui, &replay.replay, view.units);
                if ui.button("Simulate again").clicked() {
                    commands.push(Command::ReplayDataset(path.clone()));
                }
            }
        }
    });
}

fn case_ui(ui: &mut Ui, analysis: &Analysis, units: UnitSystem) {
    ui.strong(format!("{} with {}", analysis.name, analysis.vehicle));
    for note in &analysis.notes {
        ui.weak(note);
    }
    if let Some(motion) = &analysis.simulation {
        for flag in &motion.flags {
            let color = theme::severity_color(Severity::Warning, ui.visuals().dark_mode);
            ui.colored_label(color, flag.to_string());
        }
    }
    match &analysis.error {
        Some(error) => drop(Grid::new("case error").striped(true).show(ui, |ui| {
            for (label, text) in error_rows(error, units) {
                value_row(ui, &label, &text);
            }
        })),
        None => drop(ui.weak("No recorded motion to compare with.")),
    }
}

fn error_rows(error: &MotionError, units: UnitSystem) -> Vec<(String, String)> {
    let length = |value| Quantity::Length.shown(value, units);
    let mut rows = vec![
        ("Average position error".to_owned(), length(error.average_error_m)),
        ("Final position error".to_owned(), length(error.final_error_m)),
        (
            "Final heading error".to_owned(),
            Quantity::Angle.shown(error.final_heading_error_rad, units),
        ),
        ("RMSE X, Y".to_owned(), format!("{}, {}", length(error.rmse_x_m), length(error.rmse_y_m))),
    ];
    let optional = [
        ("RMSE v_x", error.rmse_vx_m_s, Quantity::Speed),
        ("RMSE v_y", error.rmse_vy_m_s, Quantity::Speed),
        ("RMSE yaw rate", error.rmse_yaw_rate_rad_s, Quantity::AngularVelocity),
    ];
    for (label, value, quantity) in optional {
        rows.extend(value.map(|value| (label.to_owned(), quantity.shown(value, units))));
    }
    for (horizon, value) in HORIZONS_S.iter().zip(error.horizon_error_m) {
        rows.push((format!("Position error at {horizon} s"), length(value)));
    }
    rows
}

fn dataset_ui(ui: &mut Ui, replay: &DatasetReplay, units: UnitSystem) {
    let violations: usize = replay.cases.iter().map(|case| case.violations).sum();
    ui.strong(format!("All {} cases, average position error", replay.cases.len()));
    let unit = Quantity::Length.display_unit(units);
    Grid::new("dataset error").striped(true).show(ui, |ui| {
        for title in ["", "n", "mean", "std", "median", "p90"] {
            ui.strong(if title.is_empty() {
                format!("[{}]", unit.symbol)
            } else {
                title.to_owned()
            });
        }
        ui.end_row();
        let groups: [(&str, Choice); 3] = [
            ("all", |_| true),
            ("spinning", |replay| replay.spin),
            ("not spinning", |replay| !replay.spin),
        ];
        for (name, choose) in groups {
            if let Some(summary) = ErrorSummary::of(&replay.cases, choose) {
                summary_row(ui, name, &summary.average_error_m, |v| significant(unit.from_si(v)));
            }
        }
    });
    ui.label(format!("Steps in which energy grows without a force: {violations}"));
    if !replay.failures.is_empty() {
        ui.label(format!("{} cases could not be simulated", replay.failures.len()));
    }
}

/// Whether a case belongs to a group.
type Choice = fn(&Replay) -> bool;

fn summary_row(ui: &mut Ui, name: &str, summary: &Summary, text: impl Fn(f64) -> String) {
    ui.label(name);
    ui.label(summary.n.to_string());
    for value in [summary.mean, summary.std, summary.median, summary.p90] {
        ui.monospace(text(value));
    }
    ui.end_row();
}
