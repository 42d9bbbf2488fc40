//! The work on models that is under way, with its progress and the buttons that stop it.

use std::time::Duration;

use egui::Ui;

use crate::app::command::{Command, ComparisonCommand, TrainingCommand};
use crate::app::network::{Network, TrainedModel};
use crate::app::panes::{Pane, PaneContext};
use crate::app::training_status::TrainingStatus;
use crate::app::widgets::run_progress_ui;
use impactlab_core::jobs::Progress;

/// Draws what is running; if nothing is, buttons that lead to the forms.
pub fn running_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { session, commands, .. } = pane;
    let mut is_idle = !training_ui(ui, &session.force.training, commands);
    is_idle &= !training_ui(ui, &session.response.training, commands);
    if let Some(job) = session.force.evaluation.job() {
        is_idle = false;
        let what = "Evaluation of the force model";
        work_ui(
            ui,
            what,
            job.progress(),
            job.time_left(),
            Command::CancelEvaluation,
            Pane::Evaluation,
            commands,
        );
    }
    if let Some((what, progress, left)) = session.response.comparison.progress() {
        is_idle = false;
        let what = format!("{what} response models");
        let cancel = Command::Compare(ComparisonCommand::Cancel);
        work_ui(ui, &what, progress, left, cancel, Pane::ModelComparison, commands);
    }
    if is_idle {
        ui.horizontal_wrapped(|ui| {
            ui.weak("Nothing is running.");
            for network in Network::ALL {
                if ui.button(format!("Train a {}…", network.model())).clicked() {
                    commands.push(Command::ShowTraining(network));
                }
            }
            if ui.button("Evaluate the force model…").clicked() {
                commands.push(Command::Show(Pane::Evaluation));
            }
            if ui.button("Compare response models…").clicked() {
                commands.push(Command::Show(Pane::ModelComparison));
            }
        });
    }
}

/// Draws a training and returns whether one is running.
fn training_ui<M: TrainedModel>(
    ui: &mut Ui,
    status: &TrainingStatus<M>,
    commands: &mut Vec<Command>,
) -> bool {
    let run = &status.run;
    if !run.is_running() {
        return false;
    }
    ui.horizontal(|ui| {
        ui.strong(format!("Training of the {} on {}", M::NETWORK.model(), status.data));
        let label = if run.is_paused() { "Resume" } else { "Pause" };
        if ui.small_button(label).clicked() {
            let command = TrainingCommand::Pause(!run.is_paused());
            commands.push(Command::Train(M::NETWORK, command));
        }
        let cancel = ui.add_enabled(!run.is_cancelled(), egui::Button::new("Cancel").small());
        let hint = "Ends the training; what it has reached is kept and not put into use";
        if cancel.on_hover_text(hint).clicked() {
            commands.push(Command::Train(M::NETWORK, TrainingCommand::Cancel));
        }
        if ui.small_button("Show").clicked() {
            commands.push(Command::ShowTraining(M::NETWORK));
        }
    });
    let (fraction, left) = status.progress();
    run_progress_ui(ui, &status.doing(), fraction, left);
    true
}

/// Draws an evaluation or a comparison.
fn work_ui(
    ui: &mut Ui,
    what: &str,
    progress: &Progress,
    left: Option<Duration>,
    cancel: Command,
    pane: Pane,
    commands: &mut Vec<Command>,
) {
    ui.horizontal(|ui| {
        ui.strong(what);
        if ui.small_button("Cancel").clicked() {
            commands.push(cancel);
        }
        if ui.small_button("Show").clicked() {
            commands.push(Command::Show(pane));
        }
    });
    let message = if progress.message.is_empty() { "preparing" } else { &progress.message };
    run_progress_ui(ui, message, progress.fraction(), left);
}
