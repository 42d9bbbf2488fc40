//! The form with the data and the settings of a training of the force network.

use std::path::Path;

use egui::{Grid, Ui};

use crate::app::network::NetworkQuestions;
use crate::app::panels::training_parts::settings_rows_ui;
use crate::app::source::{Source, open_datasets};
use crate::app::widgets::{dataset_choice, optional_count, seed_field};
use impactlab_core::data::DatasetKind;
use impactlab_core::ranges::EPOCHS;

/// Draws the form and returns whether a force data set is open to train on.
///
/// - `in_use`: path of the data set whose cases are listed.
pub fn force_form_ui(
    ui: &mut Ui,
    questions: &mut NetworkQuestions,
    sources: &[Source],
    in_use: Option<&Path>,
) -> bool {
    let NetworkQuestions { train_force: form, use_others, .. } = questions;
    let datasets = open_datasets(sources, &[DatasetKind::Force]);
    Grid::new("training form").num_columns(2).show(ui, |ui| {
        let hint = "Some of its cases are kept for the test, chosen by the seed";
        let name = ui.label("Force data set").on_hover_text(hint);
        dataset_choice(ui, "training data", &datasets, in_use, &mut form.data)
            .labelled_by(name.id)
            .on_hover_text(hint);
        ui.end_row();
        ui.label("");
        ui.add_enabled_ui(datasets.len() > 1, |ui| {
            ui.checkbox(use_others, "learn from the other open force data too")
                .on_hover_text("From all their cases, except those that are kept for the test");
        });
        ui.end_row();
        let name = ui.label("Epochs");
        optional_count(ui, &mut form.epochs, "as configured", &EPOCHS)
            .labelled_by(name.id)
            .on_hover_text("At most; 0 for what the settings say. Training stops before when the validation loss stops falling");
        ui.end_row();
        let name = ui.label("Seed");
        seed_field(ui, &mut form.training.seed)
            .labelled_by(name.id)
            .on_hover_text("Of the split and of every random number: same seed, same weights");
        ui.end_row();
        settings_rows_ui(ui, "network, loss, training, crush", &mut form.training);
    });
    !datasets.is_empty()
}
