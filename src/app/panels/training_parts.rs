//! What the trainings of both networks show alike.

use std::time::Duration;

use egui::{ProgressBar, Ui};

use crate::app::command::{Command, TrainingCommand};
use crate::app::model::ModelStatus;
use crate::app::network::TrainedModel;
use crate::app::panels::model_row::save_model_ui;
use crate::app::panels::training_losses::{LossView, losses_ui};
use crate::app::training_status::TrainingStatus;
use crate::app::widgets::duration_text;
use crate::data::Severity;
use crate::render::theme;

/// Draws the buttons and the progress of a training, the model, and the losses: of the training under
/// way, else of the model's own training.
///
/// - `can_start`: whether there is something to train on.
pub fn network_training_ui<M: TrainedModel>(
    ui: &mut Ui,
    can_start: bool,
    (status, model): (&TrainingStatus<M>, &mut ModelStatus<M>),
    (view, commands): (LossView<'_>, &mut Vec<Command>),
) {
    run_buttons_ui(ui, can_start, status, commands);
    if status.run.is_running() {
        run_progress_ui(ui, &status.doing(), status.progress());
    }
    run_problems_ui(ui, status.problem.as_deref(), &status.left_out);
    save_model_ui(ui, model, commands);
    ui.separator();
    match &model.current {
        _ if !status.history.is_empty() => {
            let title = format!("Losses while training on {}", status.data);
            losses_ui(
                ui,
                M::NETWORK,
                (&title, &status.history, status.best_epoch),
                (view, commands),
            );
        }
        Some(current) => {
            let (of, data) = (&current.model, current.model.data());
            let title = format!("Losses while training on {data} (model {})", current.name);
            losses_ui(ui, M::NETWORK, (&title, &of.history(), of.best_epoch()), (view, commands));
        }
        None => drop(ui.weak("The losses of every epoch are drawn here.")),
    }
}

/// Rows of a two-column grid: a file with settings, and whether to go on from a checkpoint.
pub fn settings_rows_ui(ui: &mut Ui, parts: &str, (config, resume): (&mut String, &mut bool)) {
    let name = ui.label("Settings file");
    let field = egui::TextEdit::singleline(config).desired_width(320.0);
    ui.add(field.hint_text(format!("TOML, optional: {parts}")))
        .labelled_by(name.id)
        .on_hover_text("What it leaves out keeps its default; `--print-config` prints them all");
    ui.end_row();
    ui.label("");
    ui.checkbox(resume, "go on where a training of these settings was interrupted")
        .on_hover_text("To the same weights as if it had not been");
    ui.end_row();
}

/// Train, pause, cancel.
fn run_buttons_ui<M: TrainedModel>(
    ui: &mut Ui,
    can_start: bool,
    status: &TrainingStatus<M>,
    commands: &mut Vec<Command>,
) {
    let (network, run) = (M::NETWORK, &status.run);
    let is_running = run.is_running();
    ui.horizontal(|ui| {
        if ui.add_enabled(can_start && !is_running, egui::Button::new("Train")).clicked() {
            commands.push(Command::Train(network, TrainingCommand::Start));
        }
        let label = if run.is_paused() { "Resume" } else { "Pause" };
        if ui.add_enabled(is_running, egui::Button::new(label)).clicked() {
            commands.push(Command::Train(network, TrainingCommand::Pause(!run.is_paused())));
        }
        let cancel = ui.add_enabled(is_running && !run.is_cancelled(), egui::Button::new("Cancel"));
        if cancel.on_hover_text("Ends the training; the weights so far are kept").clicked() {
            commands.push(Command::Train(network, TrainingCommand::Cancel));
        }
    });
}

/// How far it is, with the time left.
fn run_progress_ui(ui: &mut Ui, what: &str, (fraction, left): (Option<f32>, Option<Duration>)) {
    let left = left.map_or(String::new(), |left| format!(", {} left", duration_text(left)));
    match fraction {
        Some(fraction) => {
            let bar = ProgressBar::new(fraction).desired_width(420.0);
            ui.add(bar.text(format!("{what}{left}")));
        }
        None => drop(ui.horizontal(|ui| (ui.spinner(), ui.label(what)))),
    }
}

/// Why there is no model, and which cases it has not seen.
fn run_problems_ui(ui: &mut Ui, problem: Option<&str>, left_out: &[String]) {
    let dark = ui.visuals().dark_mode;
    if let Some(problem) = problem {
        let color = theme::severity_color(Severity::Error, dark);
        ui.colored_label(color, format!("Not trained: {problem}"));
    }
    for why in left_out {
        let color = theme::severity_color(Severity::Warning, dark);
        ui.colored_label(color, format!("Left out: {why}"));
    }
}
