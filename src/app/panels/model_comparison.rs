//! The “Compare models” pane: the response network beside the other motion models on trajectories
//! that none of them was trained on, or an evaluation of the current model alone.

use std::path::Path;

use egui::{Grid, ScrollArea, Ui};

use crate::app::command::{Command, ComparisonCommand};
use crate::app::cost::CostPlace;
use crate::app::dialog::Purpose;
use crate::app::network::NetworkQuestions;
use crate::app::output::Output;
use crate::app::panels::model_comparison_plots::{browser_ui, overview_ui};
use crate::app::panes::PaneContext;
use crate::app::response::ComparisonStatus;
use crate::app::source::{Source, open_datasets};
use crate::app::widgets::{
    bad_cases_ui, caveats_ui, config_field, cost_ui, count_field, dataset_choice, no_dataset_ui,
    notice_ui, run_progress_ui, seed_field, written_field,
};
use impactlab_core::data::{DatasetKind, Severity};
use impactlab_core::ranges::CHOICES;
use impactlab_core::units::UnitSystem;
use impactlab_document::figure::model_name;
use impactlab_networks::response::evaluate::{ComparisonTable, all_tables, paper_metrics};
use impactlab_study::facts::FactWriter;
use impactlab_study::{Answer, CompareReport, EvaluatedCases};

/// Draws the settings and buttons, and of the last comparison the figures, the case browser and the
/// tables.
pub fn model_comparison_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { project, view, session, commands, .. } = pane;
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        let in_use = view.listed.as_deref();
        let [can_compare, has_data] =
            form_ui(ui, &mut project.networks, &session.sources, in_use, commands);
        let response = &mut session.response;
        let can_start = [can_compare, has_data && response.model.current.is_some()];
        buttons_ui(ui, &mut response.comparison, can_start, commands);
        if !response.comparison.is_running() {
            for (can, place, label) in [
                (can_start[0], CostPlace::Comparison, "Comparison"),
                (can_start[1], CostPlace::ResponseEvaluation, "Evaluation"),
            ] {
                if can {
                    cost_ui(ui, &mut session.costs, place, label);
                }
            }
        }
        match &response.comparison.shown {
            None => {
                ui.weak("The 4DOF model by the data sheet and tuned by particle swarm, a plain network, and the response network: fitted to the same trajectories, asked about the same others. Takes some minutes a choice; or open a comparison.json that `impactlab compare --out` has written.");
            }
            Some(Err(problem)) => {
                notice_ui(ui, Severity::Error, format!("Not compared: {problem}"));
            }
            Some(Ok(answer)) => {
                let report = &answer.report;
                ui.separator();
                heading_ui(ui, report, view.units, commands);
                overview_ui(ui, report, view.units, session.fit_plots, commands);
                ui.separator();
                browser_ui(ui, report, view, session.fit_plots, commands);
                ui.separator();
                tables_ui(ui, report);
            }
        }
    });
}

/// Draws the settings of a comparison. Returns whether it can be asked for as it stands in the form, and
/// whether a trajectory data set is open.
///
/// - `in_use`: path of the data set whose cases are listed.
fn form_ui(
    ui: &mut Ui,
    questions: &mut NetworkQuestions,
    sources: &[Source],
    in_use: Option<&Path>,
    commands: &mut Vec<Command>,
) -> [bool; 2] {
    let NetworkQuestions { compare: form, response_cases: cases, .. } = questions;
    let datasets = open_datasets(sources, &[DatasetKind::Trajectory]);
    if datasets.is_empty() {
        no_dataset_ui(ui, DatasetKind::Trajectory, commands);
    }
    let is_read = ui.horizontal_wrapped(|ui| {
        let name = ui.label("On");
        dataset_choice(ui, "compared data", &datasets, in_use, &mut form.data).labelled_by(name.id);
        let name = ui.label("trajectories");
        let write = |numbers: &Vec<usize>| {
            numbers.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")
        };
        let numbers = &mut form.trajectories;
        let (field, is_read) =
            written_field(ui, numbers, write, read_numbers, |field| field.desired_width(70.0));
        let hint = "Numbers to fine-tune on, with commas between them";
        field.labelled_by(name.id).on_hover_text(hint);
        let name = ui.label("choices");
        count_field(ui, &mut form.choices, &CHOICES, 0.05)
            .labelled_by(name.id)
            .on_hover_text("Of the trajectories, for each number: how much the choice matters");
        let name = ui.label("seed");
        seed_field(ui, &mut form.seed)
            .labelled_by(name.id)
            .on_hover_text("Of the split into training and test, and of the first choice");
        let name = ui.label("settings");
        config_field(ui, &mut form.config, |field| {
            field.desired_width(160.0).hint_text("TOML, optional")
        })
        .labelled_by(name.id);
        bad_cases_ui(ui, &mut form.bad_cases);
        is_read
    });
    ui.horizontal_wrapped(|ui| {
        ui.label("The current model alone is evaluated on");
        ui.radio_value(cases, EvaluatedCases::Test, "cases it has not seen").on_hover_text(
            "Those that were kept for its test; of other data, all that it was not trained on",
        );
        ui.radio_value(cases, EvaluatedCases::All, "all cases")
            .on_hover_text("Those that it has learned from too: flatters the model");
    });
    let has_data = !datasets.is_empty();
    [has_data && is_read.inner, has_data]
}

/// Reads a list of positive numbers separated by commas, such as `5, 20`.
fn read_numbers(text: &str) -> Result<Vec<usize>, String> {
    let number = |part: &str| match part.trim().parse::<usize>() {
        Ok(n) if n > 0 => Ok(n),
        _ => Err(format!("{part:?} is no number of trajectories, expected such as 5, 20")),
    };
    text.split(',').map(number).collect()
}

/// Draws the buttons that start, open and save a comparison, and the progress while one runs.
///
/// - `can_compare`: whether there are data to compare the models on.
/// - `can_evaluate`: whether there are data and a current model to evaluate on them.
fn buttons_ui(
    ui: &mut Ui,
    status: &mut ComparisonStatus,
    [can_compare, can_evaluate]: [bool; 2],
    commands: &mut Vec<Command>,
) {
    let is_idle = !status.is_running();
    ui.horizontal_wrapped(|ui| {
        if ui.add_enabled(is_idle && can_compare, egui::Button::new("Compare")).clicked() {
            commands.push(Command::Compare(ComparisonCommand::Start));
        }
        let evaluate =
            ui.add_enabled(is_idle && can_evaluate, egui::Button::new("Evaluate current model"));
        if evaluate.on_hover_text("Without training any model").clicked() {
            commands.push(Command::Compare(ComparisonCommand::Evaluate));
        }
        if ui.button("Open…").on_hover_text("A comparison.json").clicked() {
            commands.push(Command::Ask(Purpose::OpenComparison));
        }
        let has_result = status.report().is_some();
        ui.add_enabled_ui(has_result, |ui| {
            let hint = "JSON, Markdown and tables into a folder";
            if ui.button("Save…").on_hover_text(hint).clicked() {
                commands.push(Command::Ask(Purpose::Save(Output::Comparison)));
            }
            let field = egui::TextEdit::singleline(&mut status.typed_path).desired_width(200.0);
            let typed = ui.add(field.hint_text("or type a folder and press Enter"));
            if typed.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter)) {
                let folder = std::mem::take(&mut status.typed_path);
                if !folder.trim().is_empty() {
                    commands.push(Command::Write(Output::Comparison, folder.trim().into()));
                }
            }
        });
    });
    let Some((what, progress, left)) = status.progress() else { return };
    ui.horizontal(|ui| {
        if ui.button("Cancel").clicked() {
            commands.push(Command::Compare(ComparisonCommand::Cancel));
        }
        let what = if progress.fraction().is_none() { what } else { &*progress.message };
        run_progress_ui(ui, what, progress.fraction(), left);
    });
}

/// Draws the title, what was assumed, the cases that were left out, and the errors that the paper
/// prints for the models that it has.
fn heading_ui(
    ui: &mut Ui,
    report: &Answer<CompareReport>,
    units: UnitSystem,
    commands: &mut Vec<Command>,
) {
    let comparison = &report.comparison;
    ui.horizontal_wrapped(|ui| {
        let n_test = comparison.test.len();
        ui.strong(match comparison.models.len() {
            1 => format!("{}: one model on {n_test} trajectories", comparison.data),
            _ => format!(
                "{}: {n_test} trajectories that no model has seen; choices of those to learn from: {}",
                comparison.data, comparison.n_choices
            ),
        });
        if ui.button("Copy as Markdown").clicked() {
            let text = FactWriter::english(units).markdown(&report.facts());
            ui.ctx().copy_text(report.caveats.in_units(units).appended_to(text));
        }
    });
    caveats_ui(ui, &report.caveats, units, commands);
    for why in &report.left_out {
        notice_ui(ui, Severity::Warning, format!("Left out: {why}"));
    }
    let of_paper = comparison.models.iter().filter_map(|model| {
        let paper = paper_metrics(model.kind, model.trajectories)?;
        let name = model_name(&model.name, paper.trajectories.unwrap_or(0));
        Some(format!("{name}: {:.2} m", paper.average_error_m))
    });
    let mut of_paper: Vec<String> = of_paper.collect();
    of_paper.sort();
    of_paper.dedup(); // One number of the paper stands for several models here.
    if !of_paper.is_empty() {
        let text = of_paper.join("; ");
        ui.weak(format!("The paper printed, for other data that are not comparable: {text}"));
    }
}

fn tables_ui(ui: &mut Ui, report: &Answer<CompareReport>) {
    let restrictions = report.caveats.text();
    for (title, _, table) in all_tables(&report.comparison) {
        if table.rows.is_empty() {
            continue;
        }
        ui.collapsing(title, |ui| table_ui(ui, title, &table, restrictions.as_deref()));
    }
}

fn table_ui(ui: &mut Ui, id: &str, table: &ComparisonTable, restrictions: Option<&str>) {
    if ui.small_button("Copy table").on_hover_text("As CSV").clicked() {
        ui.ctx().copy_text(table.to_csv(restrictions));
    }
    ScrollArea::horizontal().id_salt(id).show(ui, |ui| {
        Grid::new(id).striped(true).show(ui, |ui| {
            for title in &table.header {
                ui.strong(title);
            }
            ui.end_row();
            for row in &table.rows {
                for cell in row {
                    ui.monospace(cell);
                }
                ui.end_row();
            }
        });
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_trajectories_are_read_or_refused() {
        assert_eq!(read_numbers("5, 20"), Ok(vec![5, 20]));
        assert!(read_numbers("5, x").unwrap_err().contains("\" x\""));
        assert!(read_numbers("0").is_err() && read_numbers("").is_err());
    }
}
