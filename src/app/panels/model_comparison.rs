//! The response network beside other models, on trajectories that none has seen.

use egui::{DragValue, Grid, ProgressBar, ScrollArea, Ui};

use crate::app::command::{Command, ComparisonCommand};
use crate::app::dialogs::Purpose;
use crate::app::panels::model_comparison_plots::{browser_ui, overview_ui};
use crate::app::panes::PaneContext;
use crate::app::response::{ComparisonForm, ComparisonStatus};
use crate::app::source::{Source, open_datasets};
use crate::app::widgets::{dataset_choice, duration_text, no_dataset_ui};
use crate::data::{DatasetKind, Severity};
use crate::figure::model_name;
use crate::render::theme;
use crate::response::comparison::{
    Comparison, ComparisonTable, all_tables, paper_metrics, to_markdown,
};

/// Draws the form, the figures, the case browser and the tables.
pub fn model_comparison_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { project, view, session, commands } = pane;
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        let has_data = form_ui(ui, &mut project.response.comparison, &session.sources);
        let status = &mut session.response.comparison;
        buttons_ui(ui, status, has_data, commands);
        match &status.result {
            None => {
                ui.weak("The 4DOF model by the data sheet and tuned by particle swarm, a plain network, and the response network: fitted to the same trajectories, asked about the same others. Takes some minutes a choice; or open a comparison.json that `impactlab compare --out` has written.");
            }
            Some(Err(problem)) => {
                let color = theme::severity_color(Severity::Error, ui.visuals().dark_mode);
                ui.colored_label(color, format!("Not compared: {problem}"));
            }
            Some(Ok(comparison)) => {
                ui.separator();
                heading_ui(ui, comparison);
                overview_ui(ui, comparison, (view.units, session.fit_plots), commands);
                ui.separator();
                browser_ui(ui, comparison, (view, session.fit_plots), commands);
                ui.separator();
                tables_ui(ui, comparison);
            }
        }
    });
}

/// Whether there is something to compare on.
fn form_ui(ui: &mut Ui, form: &mut ComparisonForm, sources: &[Source]) -> bool {
    let datasets = open_datasets(sources, DatasetKind::Trajectory);
    if datasets.is_empty() {
        no_dataset_ui(ui, DatasetKind::Trajectory);
    }
    ui.horizontal_wrapped(|ui| {
        let name = ui.label("On");
        dataset_choice(ui, "compared data", &datasets, &mut form.dataset).labelled_by(name.id);
        let name = ui.label("trajectories");
        ui.add(egui::TextEdit::singleline(&mut form.trajectories).desired_width(70.0))
            .labelled_by(name.id)
            .on_hover_text("Numbers to fine-tune on, with commas between them");
        let name = ui.label("choices");
        ui.add(DragValue::new(&mut form.n_choices).range(1..=20).speed(0.05))
            .labelled_by(name.id)
            .on_hover_text("Of the trajectories, for each number: how much the choice matters");
        let name = ui.label("seed");
        ui.add(DragValue::new(&mut form.seed).speed(0.2))
            .labelled_by(name.id)
            .on_hover_text("Of the split into training and test, and of the first choice");
        let name = ui.label("settings");
        let field = egui::TextEdit::singleline(&mut form.config).desired_width(160.0);
        ui.add(field.hint_text("TOML, optional")).labelled_by(name.id);
    });
    !datasets.is_empty()
}

fn buttons_ui(
    ui: &mut Ui,
    status: &mut ComparisonStatus,
    has_data: bool,
    commands: &mut Vec<Command>,
) {
    ui.horizontal_wrapped(|ui| {
        let can_start = has_data && status.job.is_none();
        if ui.add_enabled(can_start, egui::Button::new("Compare")).clicked() {
            commands.push(Command::Compare(ComparisonCommand::Start));
        }
        if ui.button("Open…").on_hover_text("A comparison.json").clicked() {
            commands.push(Command::Ask(Purpose::OpenComparison));
        }
        let has_result = status.comparison().is_some();
        ui.add_enabled_ui(has_result, |ui| {
            let hint = "JSON, Markdown and tables into a folder";
            if ui.button("Save…").on_hover_text(hint).clicked() {
                commands.push(Command::Ask(Purpose::SaveComparison));
            }
            let field = egui::TextEdit::singleline(&mut status.typed_path).desired_width(200.0);
            let typed = ui.add(field.hint_text("or type a folder and press Enter"));
            if typed.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter)) {
                let folder = std::mem::take(&mut status.typed_path);
                if !folder.trim().is_empty() {
                    commands.push(Command::Compare(ComparisonCommand::Save(folder.trim().into())));
                }
            }
        });
    });
    let Some(job) = &status.job else { return };
    ui.horizontal(|ui| {
        if ui.button("Cancel").clicked() {
            commands.push(Command::Compare(ComparisonCommand::Cancel));
        }
        let progress = job.progress();
        let left = progress.time_left(job.elapsed());
        let left = left.map_or(String::new(), |t| format!(", {} left", duration_text(t)));
        match progress.fraction() {
            Some(fraction) => {
                let text = format!("{}{left}", progress.message);
                ui.add(ProgressBar::new(fraction).desired_width(520.0).text(text));
            }
            None => drop((ui.spinner(), ui.label("preparing"))),
        }
    });
}

fn heading_ui(ui: &mut Ui, comparison: &Comparison) {
    ui.horizontal_wrapped(|ui| {
        ui.strong(format!(
            "{}: {} trajectories that no model has seen; choices of those to learn from: {}",
            comparison.data,
            comparison.test.len(),
            comparison.n_choices
        ));
        if ui.button("Copy as Markdown").clicked() {
            ui.ctx().copy_text(to_markdown(comparison));
        }
    });
    let of_paper = comparison.models.iter().filter_map(|model| {
        let paper = paper_metrics(model.kind, model.trajectories)?;
        let name = model_name(&model.name, paper.trajectories.unwrap_or(0));
        Some(format!("{name}: {:.2} m", paper.average_error_m))
    });
    let mut of_paper: Vec<String> = of_paper.collect();
    of_paper.sort();
    of_paper.dedup(); // one figure of the paper stands for several models here
    if !of_paper.is_empty() {
        let text = of_paper.join("; ");
        ui.weak(format!("The paper printed, for other data that are not comparable: {text}"));
    }
}

fn tables_ui(ui: &mut Ui, comparison: &Comparison) {
    for (title, _, table) in all_tables(comparison) {
        if table.rows.is_empty() {
            continue;
        }
        ui.collapsing(title, |ui| table_ui(ui, title, &table));
    }
}

fn table_ui(ui: &mut Ui, id: &str, table: &ComparisonTable) {
    if ui.small_button("Copy table").on_hover_text("As CSV").clicked() {
        ui.ctx().copy_text(table.to_csv());
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
