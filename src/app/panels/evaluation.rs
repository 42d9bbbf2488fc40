//! The “Force evaluation” pane: the errors and the calibration of the force network on a force data
//! set, beside those of the baselines.

use std::path::Path;

use egui::{ScrollArea, Ui};

use crate::app::command::Command;
use crate::app::cost::CostPlace;
use crate::app::force::{ForceSession, Statistic};
use crate::app::model::file_name;
use crate::app::panels::evaluation_plots::plots_ui;
use crate::app::panels::model_row::no_model_ui;
use crate::app::panes::PaneContext;
use crate::app::source::{Source, open_datasets};
use crate::app::widgets::{
    bad_cases_ui, cost_ui, dataset_choice, facts_text, facts_ui, no_dataset_ui, notice_ui,
    restrictions_ui, run_progress_ui,
};
use impactlab_core::data::{DatasetKind, Severity};
use impactlab_core::uncertainty::Caveats;
use impactlab_core::units::UnitSystem;
use impactlab_study::facts::{Fact, FactWriter, Term, Value};
use impactlab_study::{EvaluateForceReport, EvaluateForceRequest, EvaluatedCases, ForceEvaluation};

/// Draws the choice of the data set and of its cases, and the tables and plots of the last
/// evaluation.
pub fn evaluation_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { project, view, session, commands, .. } = pane;
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        let force = &session.force;
        let in_use = view.listed.as_deref();
        let form = &mut project.networks.evaluate_force;
        start_ui(ui, form, force, (&session.sources, in_use), commands);
        if force.model.current.is_some() && !force.evaluation.is_running() {
            cost_ui(ui, &mut session.costs, CostPlace::ForceEvaluation, "Evaluation");
        }
        if let Some(problem) = force.evaluation.problem() {
            notice_ui(ui, Severity::Error, format!("Not evaluated: {problem}"));
            return;
        }
        let latest = force.evaluation.latest.as_ref();
        let (Some(latest), Some(answer)) = (latest, force.evaluation.ok()) else {
            ui.weak("Errors of the model on cases that it has not seen, beside a classic pulse, the nearest training case and Gaussian processes; how honest its bands are.");
            return;
        };
        let ForceEvaluation::Cases(report) = &answer.report.report else { return };
        ui.separator();
        let name = session.archive.name_of(&latest.question.model);
        let caveats = &answer.report.caveats;
        heading_ui(ui, report, caveats, &name, view.units);
        tables_ui(ui, report, &name, &mut view.force.statistic, view.units);
        ui.separator();
        match &answer.cases {
            Some(cases) => {
                plots_ui(ui, report, caveats, cases, view, session.fit_plots, commands)
            }
            None => drop(ui.weak(
                "The plots of single cases are not kept with an evaluation; Evaluate draws them.",
            )),
        }
    });
}

/// Draws the choice of the data set and of its cases, the button that starts the evaluation, and
/// the progress while it runs.
///
/// - `in_use`: path of the data set whose cases are listed.
fn start_ui(
    ui: &mut Ui,
    form: &mut EvaluateForceRequest,
    force: &ForceSession,
    (sources, in_use): (&[Source], Option<&Path>),
    commands: &mut Vec<Command>,
) {
    let datasets = open_datasets(sources, &[DatasetKind::Force]);
    let Some(current) = &force.model.current else {
        let use_of_it =
            "A force model predicts the contact force of a collision, and how sure that is.";
        return no_model_ui(ui, &force.model, use_of_it, commands);
    };
    if datasets.is_empty() {
        no_dataset_ui(ui, DatasetKind::Force, commands);
        return;
    }
    ui.horizontal_wrapped(|ui| {
        ui.strong("Model");
        ui.label(&current.name);
        let name = ui.label("on");
        dataset_choice(ui, "evaluated data", &datasets, in_use, &mut form.data)
            .labelled_by(name.id);
        let cases = &mut form.split;
        ui.radio_value(cases, EvaluatedCases::Test, "cases it has not seen")
            .on_hover_text("By content: a training case under another name is recognised");
        ui.radio_value(cases, EvaluatedCases::All, "all cases")
            .on_hover_text("Those that it has learned from too: flatters the model");
        bad_cases_ui(ui, &mut form.bad_cases);
        let is_idle = !force.evaluation.is_running();
        if ui.add_enabled(is_idle, egui::Button::new("Evaluate")).clicked() {
            commands.push(Command::Evaluate);
        }
    });
    if let Some(job) = force.evaluation.job() {
        ui.horizontal(|ui| {
            if ui.button("Cancel").clicked() {
                commands.push(Command::CancelEvaluation);
            }
            let progress = job.progress();
            let is_reading = progress.fraction().is_none();
            let what = if is_reading { "reading the cases" } else { &*progress.message };
            run_progress_ui(ui, what, progress.fraction(), job.time_left());
        });
    }
}

/// Names the model and the data, offers the results as text, and warns of training cases among the
/// evaluated ones, of problems and of cases that were left out.
///
/// - `model`: what the user calls the model.
fn heading_ui(
    ui: &mut Ui,
    report: &EvaluateForceReport,
    caveats: &Caveats,
    model: &str,
    units: UnitSystem,
) {
    let (data, evaluation) = (file_name(&report.data), &report.evaluation);
    ui.horizontal_wrapped(|ui| {
        ui.strong(format!("{model} on {} cases of {data}", report.n_test));
        ui.weak(format!("baselines fitted to its {} training cases", evaluation.n_train));
        if ui.button("Copy as text").clicked() {
            let text = facts_text(model, &report.facts(), units);
            ui.ctx().copy_text(caveats.appended_to(text));
        }
        if ui.button("Copy as Markdown").clicked() {
            let text = FactWriter::english(units).markdown(&report.facts());
            ui.ctx().copy_text(caveats.appended_to(text));
        }
    });
    restrictions_ui(ui, caveats, units);
    for problem in &evaluation.problems {
        notice_ui(ui, Severity::Warning, problem);
    }
    for why in &report.left_out {
        notice_ui(ui, Severity::Warning, format!("Left out: {why}"));
    }
}

/// Draws the tables of errors and of coverage, and the choice of the statistic over the cases that is
/// shown.
fn tables_ui(
    ui: &mut Ui,
    report: &EvaluateForceReport,
    model: &str,
    statistic: &mut Statistic,
    units: UnitSystem,
) {
    ui.horizontal(|ui| {
        ui.label("Errors, over cases");
        for of in Statistic::ALL {
            ui.radio_value(statistic, of, of.label());
        }
    });
    let others = Statistic::ALL.into_iter().filter(|of| of != statistic);
    let others: Vec<Value> = others.map(|of| Value::Term(of.term())).collect();
    let is_shown = |fact: &Fact| fact.values.first().is_none_or(|value| !others.contains(value));
    let mut tables = report.tables();
    tables.iter_mut().for_each(|table| table.facts.retain(is_shown));
    facts_ui(ui, model, &tables, units);
}

impl Statistic {
    fn term(self) -> Term {
        match self {
            Self::Median => Term::Median,
            Self::Mean => Term::Mean,
            Self::P90 => Term::Percentile90,
        }
    }
}
