//! How the force network learns.

use egui::{Grid, Ui};

use crate::app::command::Command;
use crate::app::force::{Phase, TrainingForm, TrainingStatus};
use crate::app::network::Network;
use crate::app::panels::model_row::save_model_ui;
use crate::app::panels::training_parts::{
    RunState, loss_choice_ui, run_buttons_ui, run_problems_ui, run_progress_ui, settings_rows_ui,
};
use crate::app::panes::PaneContext;
use crate::app::source::{Source, open_datasets};
use crate::app::state::View;
use crate::app::widgets::{dataset_choice, figure_frame, no_dataset_ui, value_row};
use crate::data::DatasetKind;
use crate::figure::{LossCurve, loss_figure};
use crate::force::{EpochRecord, LossTerms};
use crate::render::FigureOptions;
use crate::units::significant;

/// Smallest height of the plot, points.
const MIN_PLOT_HEIGHT: f32 = 220.0;
/// Height of what stands below it and of its title, points.
const BELOW_PLOT: f32 = 170.0;

/// Draws the form, the progress and the losses.
pub fn force_training_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { project, view, session, commands } = pane;
    let has_data = data_form_ui(ui, &mut project.force.training, &session.sources);
    if !has_data {
        no_dataset_ui(ui, DatasetKind::Force);
    }
    let status = &session.force.training;
    let run = RunState {
        network: Network::Force,
        can_start: has_data,
        is_running: status.run.is_running(),
        is_paused: status.run.is_paused(),
        is_cancelled: status.run.is_cancelled(),
    };
    run_buttons_ui(ui, run, commands);
    progress_ui(ui, status);
    save_model_ui(ui, &mut session.force.model, commands);
    ui.separator();
    let status = &session.force.training;
    let current = session.force.model.current.as_ref();
    let (name, history, best_epoch) = match current {
        _ if !status.history.is_empty() => {
            (status.data.clone(), status.history.as_slice(), status.best_epoch)
        }
        Some(current) => {
            let record = current.model.record();
            let name = format!("{} (model {})", record.data, current.name);
            (name, record.history.as_slice(), Some(record.best_epoch))
        }
        None => (String::new(), &[][..], None),
    };
    if history.is_empty() {
        ui.weak("The losses of every epoch are drawn here.");
        return;
    }
    losses_ui(ui, (&name, history, best_epoch), (view, session.fit_plots), commands);
}

/// Whether there is something to train on.
fn data_form_ui(ui: &mut Ui, form: &mut TrainingForm, sources: &[Source]) -> bool {
    let datasets = open_datasets(sources, DatasetKind::Force);
    Grid::new("training form").num_columns(2).show(ui, |ui| {
        let hint = "Some of its cases are kept for the test, chosen by the seed";
        let name = ui.label("Force data set").on_hover_text(hint);
        dataset_choice(ui, "training data", &datasets, &mut form.dataset)
            .labelled_by(name.id)
            .on_hover_text(hint);
        ui.end_row();
        ui.label("");
        ui.add_enabled_ui(datasets.len() > 1, |ui| {
            ui.checkbox(&mut form.use_others, "learn from the other open force data too")
                .on_hover_text("From all their cases, except those that are kept for the test");
        });
        ui.end_row();
        let name = ui.label("Epochs");
        ui.add(egui::DragValue::new(&mut form.epochs).range(1..=100_000).speed(1.0))
            .labelled_by(name.id)
            .on_hover_text("At most; training stops before when the validation loss stops falling");
        ui.end_row();
        let name = ui.label("Seed");
        ui.add(egui::DragValue::new(&mut form.seed).speed(0.2))
            .labelled_by(name.id)
            .on_hover_text("Of the split and of every random number: same seed, same weights");
        ui.end_row();
        settings_rows_ui(
            ui,
            "network, loss, training, crush",
            (&mut form.config, &mut form.resume),
        );
    });
    !datasets.is_empty()
}

fn progress_ui(ui: &mut Ui, status: &TrainingStatus) {
    let (fraction, left) = status.progress();
    let what = match status.phase {
        _ if status.run.is_cancelled() => "ending".to_owned(),
        Phase::Preparing => "preparing".to_owned(),
        Phase::Centre(fit) => fit.to_string(),
        Phase::Epochs(done, n_epochs) => format!("epoch {done} of {n_epochs}"),
        Phase::Ended => "over".to_owned(),
    };
    if status.run.is_running() {
        let what = if status.run.is_paused() { format!("paused: {what}") } else { what };
        run_progress_ui(ui, &what, (fraction, left));
    }
    run_problems_ui(ui, status.problem.as_deref(), &status.left_out);
}

fn losses_ui(
    ui: &mut Ui,
    (name, history, best_epoch): (&str, &[EpochRecord], Option<usize>),
    (view, reset): (&mut View, bool),
    commands: &mut Vec<Command>,
) {
    let names = LossTerms::default().named().map(|(name, _)| name);
    loss_choice_ui(ui, &names, (&mut view.force.loss_terms, &mut view.force.log_losses));
    let curves: Vec<LossCurve> = names
        .iter()
        .enumerate()
        .filter(|(_, name)| view.force.loss_terms.iter().any(|selected| selected == *name))
        .map(|(i, name)| LossCurve {
            name: (*name).to_owned(),
            train: history.iter().map(|record| record.train.named()[i].1).collect(),
            validation: history.iter().map(|record| record.validation.named()[i].1).collect(),
        })
        .collect();
    let first_epoch = history.first().map_or(1, |record| record.epoch);
    let title = format!("Losses while training on {name}");
    let figure = loss_figure(&title, &curves, (first_epoch, best_epoch), view.force.log_losses);
    let height = (ui.available_height() - BELOW_PLOT).max(MIN_PLOT_HEIGHT);
    if view.force.log_losses && !figure.log_y {
        ui.weak("A shown loss is zero or less, as a likelihood may be: the axis is linear.");
    }
    let options = FigureOptions {
        id: "losses".to_owned(),
        height: Some(height),
        reset,
        ..FigureOptions::default()
    };
    figure_frame(ui, (&figure.title, &figure), &options, commands);
    if let Some(last) = history.last() {
        Grid::new("last epoch").num_columns(2).show(ui, |ui| {
            let best = best_epoch.map_or("none".to_owned(), |epoch| epoch.to_string());
            value_row(ui, "Best epoch, last epoch", &format!("{best}, {}", last.epoch));
            let losses = [last.train.total, last.validation.total].map(significant);
            value_row(ui, "Loss, train and validation", &losses.join(", "));
            value_row(ui, "Learning rate", &format!("{:.2e}", last.learning_rate));
            value_row(ui, "Longest gradient", &significant(last.gradient_norm));
            value_row(ui, "Time per epoch", &format!("{:.2} s", last.seconds));
        });
    }
}
