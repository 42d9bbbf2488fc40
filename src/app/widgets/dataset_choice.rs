//! The choice of one of the open data sets.

use std::path::PathBuf;

use egui::{ComboBox, Response, Ui};

use crate::app::source::{OpenDataset, chosen_dataset};
use crate::data::DatasetKind;

/// Chooses one of the data sets; the first one where none of them is chosen.
pub fn dataset_choice(
    ui: &mut Ui,
    id: &str,
    datasets: &[OpenDataset<'_>],
    chosen: &mut Option<PathBuf>,
) -> Response {
    let label =
        |of: &OpenDataset<'_>| format!("{}, {} cases", of.name(), of.checked.dataset.cases.len());
    let current = chosen_dataset(datasets, chosen.as_deref());
    let text = current.as_ref().map_or("none is open".to_owned(), label);
    ComboBox::from_id_salt(id)
        .selected_text(text)
        .width(220.0)
        .show_ui(ui, |ui| {
            for of in datasets {
                ui.selectable_value(chosen, Some(of.path.to_owned()), label(of));
            }
        })
        .response
}

/// Says how to open a data set where none is.
pub fn no_dataset_ui(ui: &mut Ui, kind: DatasetKind) {
    ui.label(match kind {
        DatasetKind::Force => "No force data set is open. Open a folder with cases.csv and forces/, e.g. the shipped datasets/fea.",
        DatasetKind::Trajectory => "No trajectory data set is open. Open a folder with cases.csv, trajectories/ and vehicle.toml, e.g. the shipped datasets/trajectories-fea.",
    });
}
