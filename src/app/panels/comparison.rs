//! The “Comparison” pane: the errors of the 4DOF simulation against the recorded motion, for the
//! selected subject and for all cases of the listed trajectory data set.

use egui::{Grid, ScrollArea, Ui};

use crate::app::case_table::listed_in;
use crate::app::command::Command;
use crate::app::panels::analysis_or_hint;
use crate::app::panes::PaneContext;
use crate::app::source::{Source, open_datasets};
use crate::app::widgets::{
    caveats_ui, facts_ui, no_dataset_ui, notice_ui, value_row, value_ui, working_ui,
};
use impactlab_core::compare::{ErrorSummary, HORIZONS_S, MotionError};
use impactlab_core::data::{DatasetKind, Severity};
use impactlab_core::numerics::Summary;
use impactlab_core::units::{Quantity, UnitSystem, significant};
use impactlab_study::{Answer, SimulateDatasetReport, SimulateReport};

/// What is said of errors that were found with another vehicle.
const OUTDATED: &str = "The vehicle was changed since these cases were simulated: Simulate again";

/// Draws the errors of the selected subject, and below them those of the whole data set with the
/// button that starts its simulation.
pub fn comparison_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { project, view, session, commands, .. } = pane;
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        if let Some(answer) = analysis_or_hint(ui, session, project, commands) {
            case_ui(ui, &answer.report, view.units, commands);
        }
        ui.separator();
        let (Some(path), Some(checked)) = (&view.listed, listed_in(&session.sources, view)) else {
            return no_data_ui(ui, &session.sources, commands);
        };
        if checked.dataset.kind != DatasetKind::Trajectory {
            ui.weak("The listed data set has no recorded motions to compare with.");
            return no_data_ui(ui, &session.sources, commands);
        }
        let replay = session.replays.get(path);
        let report = replay.and_then(|replay| replay.report());
        let is_running = replay.is_some_and(|replay| replay.question.is_running());
        if let Some(report) = report {
            let is_outdated = replay.is_some_and(|replay| replay.is_outdated(&project.simulate));
            if is_outdated && !is_running {
                notice_ui(ui, Severity::Warning, OUTDATED);
            }
            super::faded_if(ui, is_outdated, |ui| dataset_ui(ui, report, view.units, commands));
        }
        if is_running {
            return working_ui(ui, "Simulating…");
        }
        let label = match report {
            Some(_) => "Simulate again".to_owned(),
            None => format!("Simulate all {} cases", checked.dataset.cases.len()),
        };
        if ui.button(label).on_hover_text("4DOF against every recorded motion").clicked() {
            commands.push(Command::ReplayDataset(path.clone()));
        }
    });
}

/// Draws how all cases of a data set come to be compared, where none with recorded motions is listed.
fn no_data_ui(ui: &mut Ui, sources: &[Source], commands: &mut Vec<Command>) {
    if !sources.iter().all(Source::is_settled) {
        return;
    }
    match open_datasets(sources, &[DatasetKind::Trajectory]).is_empty() {
        true => no_dataset_ui(ui, DatasetKind::Trajectory, commands),
        false => drop(ui.weak(
            "Click a trajectory data set in the Data pane: all its cases can be compared here.",
        )),
    }
}

fn case_ui(
    ui: &mut Ui,
    report: &Answer<SimulateReport>,
    units: UnitSystem,
    commands: &mut Vec<Command>,
) {
    ui.strong(format!("{} with {}", report.name, report.vehicle));
    caveats_ui(ui, &report.caveats, units, commands);
    for note in report.caveats.in_units(units).notes() {
        ui.weak(note);
    }
    if let Some(rival) = &report.rival {
        facts_ui(ui, &report.name, &[rival.table()], units);
    }
    match &report.error {
        None if report.end.is_none() => {
            drop(ui.weak("There is no simulation that could be compared with what was recorded."));
        }
        Some(error) => drop(Grid::new("case error").striped(true).show(ui, |ui| {
            for (label, text) in error_rows(error, units) {
                value_row(ui, &label, &text);
            }
        })),
        None => drop(ui.weak(
            "No recorded motion to compare with: cases of a trajectory data set and trajectory files have one.",
        )),
    }
}

/// Labels and values of the error metrics of one motion. Metrics of channels that were not recorded
/// are left out.
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
        ("RMSE v_x", error.rmse_vx_body_m_s, Quantity::Speed),
        ("RMSE v_y", error.rmse_vy_body_m_s, Quantity::Speed),
        ("RMSE yaw rate", error.rmse_yaw_rate_rad_s, Quantity::AngularVelocity),
    ];
    for (label, value, quantity) in optional {
        rows.extend(value.map(|value| (label.to_owned(), quantity.shown(value, units))));
    }
    let reached = HORIZONS_S.iter().zip(error.horizon_error_m).filter(|(_, error)| !error.is_nan());
    for (horizon, value) in reached {
        rows.push((format!("Position error at {horizon} s"), length(value)));
    }
    rows
}

/// Draws the average position error over all cases, and separately over the cases that spin and
/// those that do not.
fn dataset_ui(
    ui: &mut Ui,
    report: &Answer<SimulateDatasetReport>,
    units: UnitSystem,
    commands: &mut Vec<Command>,
) {
    let violations: usize = report.cases.iter().filter_map(|case| case.violations).sum();
    ui.strong(format!("All {} cases, average position error", report.cases.len()));
    caveats_ui(ui, &report.caveats, units, commands);
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
        let groups: [(&str, &Option<ErrorSummary>); 3] = [
            ("all", &report.overall),
            ("spinning", &report.spinning),
            ("not spinning", &report.not_spinning),
        ];
        for (name, summary) in groups {
            if let Some(summary) = summary {
                summary_row(ui, name, &summary.average_error_m, |v| significant(unit.from_si(v)));
            }
        }
    });
    ui.label(format!("Steps in which energy grows without a force: {violations}"));
    if !report.failures.is_empty() {
        let text = format!("{} cases cannot be simulated", report.failures.len());
        ui.label(text).on_hover_text(report.failures.join("\n"));
    }
}

fn summary_row(ui: &mut Ui, name: &str, summary: &Summary, text: impl Fn(f64) -> String) {
    ui.label(name);
    ui.label(summary.n.to_string());
    for value in [summary.mean, summary.std, summary.median, summary.p90] {
        value_ui(ui, &text(value));
    }
    ui.end_row();
}
