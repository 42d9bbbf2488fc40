//! How the response network learns.

use egui::{ComboBox, Grid, Ui};

use crate::app::command::Command;
use crate::app::network::Network;
use crate::app::panels::model_row::save_model_ui;
use crate::app::panels::training_parts::{
    RunState, loss_choice_ui, run_buttons_ui, run_problems_ui, run_progress_ui, settings_rows_ui,
};
use crate::app::panes::PaneContext;
use crate::app::response::{Course, ResponsePhase, ResponseTrainingForm, ResponseTrainingStatus};
use crate::app::source::{Source, open_datasets};
use crate::app::state::View;
use crate::app::widgets::{dataset_choice, figure_frame, no_dataset_ui, value_row};
use crate::data::DatasetKind;
use crate::figure::{Figure, LossCurve, balance_figure, loss_figure};
use crate::render::FigureOptions;
use crate::response::{ResponseEpoch, ResponseLossTerms};
use crate::units::significant;

/// Smallest height of the plot, points.
const MIN_PLOT_HEIGHT: f32 = 200.0;
/// Height of what stands below it and of its title, points.
const BELOW_PLOT: f32 = 190.0;

/// Draws the form, the progress, losses and balance.
pub fn response_training_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { project, view, session, commands } = pane;
    let has_data = form_ui(ui, &mut project.response.training, &session.sources);
    if !has_data {
        no_dataset_ui(ui, DatasetKind::Trajectory);
    }
    let status = &session.response.training;
    let run = RunState {
        network: Network::Response,
        can_start: has_data,
        is_running: status.run.is_running(),
        is_paused: status.run.is_paused(),
        is_cancelled: status.run.is_cancelled(),
    };
    run_buttons_ui(ui, run, commands);
    progress_ui(ui, status);
    save_model_ui(ui, &mut session.response.model, commands);
    ui.separator();
    let status = &session.response.training;
    let (name, history) = match &session.response.model.current {
        _ if !status.history.is_empty() => (status.data.clone(), &status.history[..]),
        Some(current) => {
            let record = current.model.record();
            (format!("{} (model {})", record.data, current.name), &record.history[..])
        }
        None => (String::new(), &[][..]),
    };
    if history.is_empty() {
        ui.weak("The losses of every epoch are drawn here, and how they balance with physics.");
        return;
    }
    losses_ui(ui, (&name, history), (view, session.fit_plots), commands);
}

/// Whether there is something to train on.
fn form_ui(ui: &mut Ui, form: &mut ResponseTrainingForm, sources: &[Source]) -> bool {
    let datasets = open_datasets(sources, DatasetKind::Trajectory);
    Grid::new("response training form").num_columns(2).show(ui, |ui| {
        let name = ui.label("Course");
        ComboBox::from_id_salt("course")
            .selected_text(form.course.label())
            .width(320.0)
            .show_ui(ui, |ui| {
                for course in Course::ALL {
                    ui.selectable_value(&mut form.course, course, course.label());
                }
            })
            .response
            .labelled_by(name.id)
            .on_hover_text("A pre-trained network keeps its first layers");
        ui.end_row();
        let hint = "A quarter of its cases is kept for the test, chosen by the seed of the split";
        let name = ui.label("Trajectory data set").on_hover_text(hint);
        dataset_choice(ui, "trajectories", &datasets, &mut form.dataset)
            .labelled_by(name.id)
            .on_hover_text(hint);
        ui.end_row();
        numbers_ui(ui, form);
    });
    !datasets.is_empty()
}

fn numbers_ui(ui: &mut Ui, form: &mut ResponseTrainingForm) {
    let is_fine_tuning = form.course != Course::Pretrain;
    let name = ui.label("Trajectories");
    let of_all = |n: f64, _| if n < 1.0 { "all".to_owned() } else { format!("{n:.0}") };
    let n = egui::DragValue::new(&mut form.n_trajectories).range(0..=10_000).speed(0.1);
    ui.add_enabled(is_fine_tuning, n.custom_formatter(of_all))
        .labelled_by(name.id)
        .on_hover_text("To learn from, spinning and others as they occur; 0 for all");
    ui.end_row();
    let name = ui.label("Seed of the split");
    ui.add(egui::DragValue::new(&mut form.seed).speed(0.2))
        .labelled_by(name.id)
        .on_hover_text("Which cases are kept for the test");
    ui.end_row();
    let name = ui.label("Seed of the choice");
    ui.add(egui::DragValue::new(&mut form.choice).speed(0.2))
        .labelled_by(name.id)
        .on_hover_text("Which trajectories are learned from, and every other random number");
    ui.end_row();
    settings_rows_ui(
        ui,
        "network, single_steps, rollouts, physics, …",
        (&mut form.config, &mut form.resume),
    );
}

fn progress_ui(ui: &mut Ui, status: &ResponseTrainingStatus) {
    let what = match status.phase {
        _ if status.run.is_cancelled() => "ending".to_owned(),
        ResponsePhase::Preparing => "preparing".to_owned(),
        ResponsePhase::Epochs { done, n_epochs, training_idx: 0, .. } => {
            let stage = status.history.last().map_or(String::new(), |last| last.stage.to_string());
            format!("{stage}, epoch {done} of {n_epochs}")
        }
        ResponsePhase::Epochs { done, n_epochs, training_idx, n_trainings } => {
            let others = n_trainings - 1;
            format!("calibration {training_idx} of {others}, epoch {done} of {n_epochs}")
        }
        ResponsePhase::Ended => "over".to_owned(),
    };
    if status.run.is_running() {
        let what = if status.run.is_paused() { format!("paused: {what}") } else { what };
        run_progress_ui(ui, &what, status.progress());
    }
    run_problems_ui(ui, status.problem.as_deref(), &status.left_out);
}

fn losses_ui(
    ui: &mut Ui,
    (name, history): (&str, &[ResponseEpoch]),
    (view, reset): (&mut View, bool),
    commands: &mut Vec<Command>,
) {
    let view = &mut view.response;
    let names = ResponseLossTerms::default().named().map(|(name, _)| name);
    loss_choice_ui(ui, &names, (&mut view.loss_terms, &mut view.log_losses));
    let curves: Vec<LossCurve> = names
        .iter()
        .enumerate()
        .filter(|(_, name)| view.loss_terms.iter().any(|selected| selected == *name))
        .map(|(i, name)| LossCurve {
            name: (*name).to_owned(),
            train: history.iter().map(|record| record.loss.named()[i].1).collect(),
            validation: Vec::new(),
        })
        .collect();
    let first_epoch = history.first().map_or(1, |record| record.epoch);
    let title = format!("Losses while training on {name}");
    let losses = loss_figure(&title, &curves, (first_epoch, None), view.log_losses);
    if view.log_losses && !losses.log_y {
        ui.weak("A shown loss is zero or less, as a likelihood may be: the axis is linear.");
    }
    let balances: Vec<[f64; 2]> =
        history.iter().map(|record| [record.epoch as f64, record.balance]).collect();
    let weights: Vec<[f64; 2]> =
        history.iter().map(|record| [record.epoch as f64, record.physics_weight]).collect();
    let balance = balance_figure(balances, weights);
    let height = (ui.available_height() - BELOW_PLOT).max(MIN_PLOT_HEIGHT);
    ui.columns(2, |columns| {
        let mut plot = |ui: &mut Ui, figure: &Figure, id: &str| {
            let options = FigureOptions {
                id: id.to_owned(),
                link: Some(egui::Id::unique("epochs")),
                height: Some(height),
                reset,
                ..FigureOptions::default()
            };
            figure_frame(ui, (&figure.title, figure), &options, commands);
        };
        plot(&mut columns[0], &losses, "response losses");
        plot(&mut columns[1], &balance, "balance");
    });
    if let Some(last) = history.last() {
        Grid::new("last response epoch").num_columns(2).show(ui, |ui| {
            value_row(ui, "Last epoch", &format!("{}, {}", last.epoch, last.stage));
            value_row(ui, "Loss", &significant(last.loss.total));
            let balance = format!("{:.2}, {}", last.balance, significant(last.physics_weight));
            value_row(ui, "Balance, weight of physics", &balance);
            value_row(ui, "Learning rate", &format!("{:.2e}", last.learning_rate));
            value_row(ui, "Longest gradient", &significant(last.gradient_norm));
            value_row(ui, "Time per epoch", &format!("{:.2} s", last.seconds));
        });
    }
}
