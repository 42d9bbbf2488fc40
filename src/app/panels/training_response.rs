//! What the response network learns from, and how.

use egui::{ComboBox, Grid, Ui};

use crate::app::panels::training_parts::settings_rows_ui;
use crate::app::response::{ResponseTrainingForm, TrainingMode};
use crate::app::source::{Source, open_datasets};
use crate::app::widgets::dataset_choice;
use crate::data::DatasetKind;

/// Draws the form; whether there is something to train on.
pub fn response_form_ui(ui: &mut Ui, form: &mut ResponseTrainingForm, sources: &[Source]) -> bool {
    let datasets = open_datasets(sources, DatasetKind::Trajectory);
    Grid::new("response training form").num_columns(2).show(ui, |ui| {
        let name = ui.label("Training mode");
        ComboBox::from_id_salt("training mode")
            .selected_text(form.mode.label())
            .width(320.0)
            .show_ui(ui, |ui| {
                for mode in TrainingMode::ALL {
                    ui.selectable_value(&mut form.mode, mode, mode.label());
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
    let is_fine_tuning = form.mode != TrainingMode::Pretrain;
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
