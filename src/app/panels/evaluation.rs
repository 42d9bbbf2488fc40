//! How well the force network does on a data set.

use egui::{ProgressBar, ScrollArea, Ui};

use crate::app::command::Command;
use crate::app::force::{FinishedEvaluation, ForceSession, ForceView};
use crate::app::panels::evaluation_plots::plots_ui;
use crate::app::panels::evaluation_tables::tables_ui;
use crate::app::panes::PaneContext;
use crate::app::source::{Source, open_datasets};
use crate::app::widgets::{dataset_choice, no_dataset_ui};
use crate::data::{DatasetKind, Severity};
use crate::render::theme;

/// Draws the choice of data, the tables and the plots.
pub fn evaluation_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { view, session, commands, .. } = pane;
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        let force = &session.force;
        start_ui(ui, (&mut view.force, force), &session.sources, commands);
        let finished = match &force.evaluation.result {
            None => {
                ui.weak("Errors of the model on cases that it has not seen, beside a classic pulse, the nearest training case and Gaussian processes; how honest its bands are.");
                return;
            }
            Some(Err(problem)) => {
                let color = theme::severity_color(Severity::Error, ui.visuals().dark_mode);
                ui.colored_label(color, format!("Not evaluated: {problem}"));
                return;
            }
            Some(Ok(finished)) => finished,
        };
        ui.separator();
        heading_ui(ui, finished);
        tables_ui(ui, finished, (&mut view.force, view.units));
        ui.separator();
        plots_ui(ui, finished, (view, session.fit_plots), commands);
    });
}

fn start_ui(
    ui: &mut Ui,
    (view, force): (&mut ForceView, &ForceSession),
    sources: &[Source],
    commands: &mut Vec<Command>,
) {
    let datasets = open_datasets(sources, DatasetKind::Force);
    let Some(current) = &force.model.current else {
        ui.label("There is no force model to evaluate: open or train one in the Training pane.");
        return;
    };
    if datasets.is_empty() {
        no_dataset_ui(ui, DatasetKind::Force);
        return;
    }
    ui.horizontal_wrapped(|ui| {
        ui.strong("Model");
        ui.label(&current.name);
        let name = ui.label("on");
        dataset_choice(ui, "evaluated data", &datasets, &mut view.evaluated).labelled_by(name.id);
        ui.radio_value(&mut view.evaluate_all, false, "cases it has not seen")
            .on_hover_text("By content: a training case under another name is recognised");
        ui.radio_value(&mut view.evaluate_all, true, "all cases")
            .on_hover_text("Those that it has learned from too: flatters the model");
        let idle = force.evaluation.job.is_none();
        if ui.add_enabled(idle, egui::Button::new("Evaluate")).clicked() {
            commands.push(Command::Evaluate);
        }
    });
    if let Some(job) = &force.evaluation.job {
        ui.horizontal(|ui| {
            if ui.button("Cancel").clicked() {
                commands.push(Command::CancelEvaluation);
            }
            let progress = job.progress();
            match progress.fraction() {
                Some(fraction) => {
                    drop(ui.add(
                        ProgressBar::new(fraction).desired_width(420.0).text(&*progress.message),
                    ))
                }
                None => drop((ui.spinner(), ui.label("reading the cases"))),
            }
        });
    }
}

fn heading_ui(ui: &mut Ui, finished: &FinishedEvaluation) {
    let [model, data] = &finished.names;
    let evaluation = &finished.evaluation;
    ui.horizontal_wrapped(|ui| {
        let n_cases = evaluation.figures.overall.n_cases;
        ui.strong(format!("{model} on {n_cases} cases of {data}"));
        ui.weak(format!("baselines fitted to its {} training cases", evaluation.n_train));
        if ui.button("Copy as text").clicked() {
            ui.ctx().copy_text(evaluation.to_text());
        }
        if ui.button("Copy as Markdown").clicked() {
            ui.ctx().copy_text(evaluation.to_markdown());
        }
    });
    let color = theme::severity_color(Severity::Warning, ui.visuals().dark_mode);
    if finished.n_known > 0 {
        let text = format!("{} of these cases were learned from", finished.n_known);
        ui.colored_label(color, text);
    }
    for problem in evaluation.problems.iter().chain(&finished.left_out) {
        ui.colored_label(color, problem);
    }
}
