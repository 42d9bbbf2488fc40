//! The parts of the training pane that both networks share: buttons, progress, the resulting model
//! and common settings.

use egui::Ui;
use impactlab_core::uncertainty::Caveats;

use crate::app::command::{Command, TrainingCommand};
use crate::app::model::ModelStatus;
use crate::app::network::TrainedModel;
use crate::app::panels::model_row::save_model_ui;
use crate::app::panels::training_losses::{LossView, losses_ui};
use crate::app::training_status::TrainingStatus;
use crate::app::widgets::{assumptions_ui, bad_cases_ui, config_field, notice_ui, run_progress_ui};
use impactlab_core::data::Severity;
use impactlab_core::units::UnitSystem;
use impactlab_study::TrainingOptions;

/// Draws the buttons and the progress of a training, the current model, and the losses. The losses
/// are those of the latest training of this session, while it runs of nothing else; or, if there is
/// none, those of the training from which the current model came.
///
/// - `can_start`: whether there are data to train on;
/// - `cost`: draws how long a training takes.
pub fn network_training_ui<M: TrainedModel>(
    ui: &mut Ui,
    can_start: bool,
    status: &TrainingStatus<M>,
    model: &mut ModelStatus<M>,
    cost: impl FnOnce(&mut Ui),
    view: LossView<'_>,
    commands: &mut Vec<Command>,
) {
    run_buttons_ui(ui, can_start, status, commands);
    // One row below the buttons, which keep their place when a training begins or ends.
    if status.run.is_running() {
        let (fraction, left) = status.progress();
        run_progress_ui(ui, &status.doing(), fraction, left);
    } else if can_start {
        cost(ui);
    }
    let notes = status.report.as_ref().map(M::notes);
    run_record_ui(ui, status.problem.as_deref(), notes, view.units, commands);
    save_model_ui(ui, model, commands);
    ui.separator();
    match &model.current {
        _ if !status.history.is_empty() => {
            let title = format!("Losses while training on {}", status.data);
            losses_ui(ui, M::NETWORK, &title, &status.history, status.best_epoch, view, commands);
        }
        _ if status.run.is_running() => {
            drop(ui.weak("The losses of this training are drawn here from its first epoch on."));
        }
        _ if status.report.is_some() => drop(ui.weak("The training had no epochs, so no losses.")),
        Some(current) => {
            let (of, data) = (&current.model, current.model.data());
            let title = format!("Losses while training on {data} (model {})", current.name);
            losses_ui(ui, M::NETWORK, &title, &of.history(), of.best_epoch(), view, commands);
        }
        None => drop(ui.weak("The losses of every epoch are drawn here.")),
    }
}

/// Draws two rows of a two-column grid: the settings file, and whether unusable cases are left out.
///
/// - `parts`: the sections that the settings file may have, shown as a hint.
pub fn settings_rows_ui(ui: &mut Ui, parts: &str, training: &mut TrainingOptions) {
    let name = ui.label("Settings file");
    let hint = format!("TOML, optional: {parts}");
    config_field(ui, &mut training.config, |field| field.desired_width(320.0).hint_text(hint))
        .labelled_by(name.id)
        .on_hover_text("What it leaves out keeps its default; `--print-config` prints them all");
    ui.end_row();
    ui.label("");
    bad_cases_ui(ui, &mut training.bad_cases);
    ui.end_row();
}

/// Draws the buttons that start, pause or resume, and cancel a training.
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
        if cancel
            .on_hover_text("Ends the training; what it has reached is kept and not put into use")
            .clicked()
        {
            commands.push(Command::Train(network, TrainingCommand::Cancel));
        }
    });
}

/// Draws the messages of the latest training: the reason why it gave no model, the cases that were
/// left out, and the assumptions.
///
/// - `problem`: the reason for the failure; `None` if the training did not fail.
/// - `notes`: one reason for each case that was left out, and the caveats of the training.
fn run_record_ui(
    ui: &mut Ui,
    problem: Option<&str>,
    notes: Option<(&[String], &Caveats)>,
    units: UnitSystem,
    commands: &mut Vec<Command>,
) {
    if let Some(problem) = problem {
        notice_ui(ui, Severity::Error, format!("Not trained: {problem}"));
    }
    let Some((left_out, caveats)) = notes else { return };
    for why in left_out {
        notice_ui(ui, Severity::Warning, format!("Left out: {why}"));
    }
    assumptions_ui(ui, caveats, units, commands);
}
