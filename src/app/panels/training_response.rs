//! The form with the data and the settings of a training of the response network.

use std::path::Path;

use egui::{ComboBox, Grid, Ui};

use crate::app::network::{NetworkQuestions, TrainingMode};
use crate::app::panels::file_start::{file_list_ui, open_files};
use crate::app::panels::training_parts::settings_rows_ui;
use crate::app::source::{Source, open_datasets};
use crate::app::widgets::{
    EmptyField, dataset_choice, optional_count, optional_quantity, seed_field,
};
use impactlab_core::data::FileKind;
use impactlab_core::ranges::{STEERING_RATIO, TRAJECTORIES};
use impactlab_core::units::UnitSystem;
use impactlab_core::vehicle::USUAL_STEERING_RATIO;

/// Draws the form and returns whether a data set or a log that suits the training mode is open.
///
/// - `in_use`: path of the data set whose cases are listed.
pub fn response_form_ui(
    ui: &mut Ui,
    form: &mut NetworkQuestions,
    sources: &[Source],
    in_use: Option<&Path>,
) -> bool {
    let datasets = open_datasets(sources, form.mode.data_kinds());
    Grid::new("response training form")
        .num_columns(2)
        .show(ui, |ui| {
            let name = ui.label("Training mode");
            ComboBox::from_id_salt("training mode")
                .selected_text(form.mode.label())
                .width(320.0)
                .show_ui(ui, |ui| {
                    for &mode in TrainingMode::ALL {
                        ui.selectable_value(&mut form.mode, mode, mode.label());
                    }
                })
                .response
                .labelled_by(name.id)
                .on_hover_text("A pre-trained network keeps its first layers");
            ui.end_row();
            let is_of_log = log_ui(ui, form, sources);
            let hint =
                "A quarter of its cases is kept for the test, chosen by the seed of the split";
            let name = ui.label("Data set").on_hover_text(hint);
            ui.add_enabled_ui(!is_of_log, |ui| {
                let mut data = form.fine_tune.data.first().cloned().unwrap_or_default();
                let list = dataset_choice(ui, "trajectories", &datasets, in_use, &mut data);
                if list.labelled_by(name.id).on_hover_text(hint).changed() {
                    form.fine_tune.data = vec![data];
                }
            });
            ui.end_row();
            numbers_ui(ui, form, is_of_log);
            !datasets.is_empty() || is_of_log
        })
        .inner
}

/// Draws the choice of a log among the open files and returns whether the network learns from one.
fn log_ui(ui: &mut Ui, form: &mut NetworkQuestions, sources: &[Source]) -> bool {
    let logs = open_files(sources, FileKind::Trajectory);
    if !form.mode.takes_log() || logs.is_empty() {
        return false;
    }
    let hint = "Learn from a log of one impact instead of a data set: a file that is open, with \
                time, x, y, yaw. The vehicle is that of the Vehicle pane";
    let before = form.log.clone();
    file_list_ui(ui, "Log", "none, from a data set", hint, &mut form.log, &logs);
    ui.end_row();
    if form.log != before {
        // What was said of one log is not known of another.
        (form.log_force, form.log_is_without_impact, form.log_steering_ratio) = (None, false, None);
    }
    let is_of_log = form.log.as_ref().is_some_and(|log| logs.contains(log));
    if is_of_log {
        log_rows_ui(ui, form);
    }
    if is_of_log && !form.log_is_without_impact {
        let forces = open_files(sources, FileKind::Force);
        let hint = "On the clock of the log, at the contact point of the Vehicle pane";
        let open = "estimated from the motion";
        file_list_ui(ui, "Force of the log", open, hint, &mut form.log_force, &forces);
        ui.end_row();
    }
    is_of_log
}

/// Draws what a log does not say itself: whether anything was struck, and how far the wheels turn.
fn log_rows_ui(ui: &mut Ui, form: &mut NetworkQuestions) {
    let name = ui.label("Impact in the log");
    let hint = "Without one, as in a test drive, no force is looked for in the motion";
    let tick = ui.checkbox(&mut form.log_is_without_impact, "none, a test drive");
    tick.labelled_by(name.id).on_hover_text(hint);
    ui.end_row();
    let name = ui.label("Steering ratio of the log");
    let empty = EmptyField { text: "road wheels", start_si: USUAL_STEERING_RATIO };
    let ratio = &mut form.log_steering_ratio;
    optional_quantity(ui, ratio, empty, &STEERING_RATIO, UnitSystem::default())
        .labelled_by(name.id)
        .on_hover_text("For a log with the angle of the steering wheel");
    ui.end_row();
}

/// Draws the number of trajectories, the seeds and the settings in a two-column grid. Pre-training
/// on simulations and learning from a log use neither the number of trajectories nor the seed of their choice.
fn numbers_ui(ui: &mut Ui, questions: &mut NetworkQuestions, is_of_log: bool) {
    let NetworkQuestions { fine_tune: form, mode, .. } = questions;
    let is_fine_tuning = *mode != TrainingMode::Pretrain && !is_of_log;
    let name = ui.label("Trajectories");
    let hint = "To learn from, spinning and others as they occur; 0 for all that are not kept for the test";
    ui.add_enabled_ui(is_fine_tuning, |ui| {
        optional_count(ui, &mut form.trajectories, "all", &TRAJECTORIES)
            .labelled_by(name.id)
            .on_hover_text(hint);
    });
    ui.end_row();
    let name = ui.label("Seed of the split");
    let hint = match is_fine_tuning {
        true => "Which cases are kept for the test",
        false => "Which cases are kept for the test, and every other random number",
    };
    seed_field(ui, &mut form.training.seed).labelled_by(name.id).on_hover_text(hint);
    ui.end_row();
    let name = ui.label("Seed of the choice");
    let before = form.choice.unwrap_or(form.training.seed);
    let mut choice = before;
    let hint = "Which trajectories are learned from, and every other random number; the seed of the split unless it is changed";
    ui.add_enabled_ui(is_fine_tuning, |ui| {
        seed_field(ui, &mut choice).labelled_by(name.id).on_hover_text(hint);
    });
    if choice != before {
        form.choice = Some(choice);
    }
    ui.end_row();
    let parts = "network, single_steps, rollouts, physics, …";
    settings_rows_ui(ui, parts, &mut form.training);
}
