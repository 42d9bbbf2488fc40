//! The choice of one of the open data sets, and a hint where none of the needed kind is open.

use std::path::{Path, PathBuf};

use egui::{ComboBox, Response, Ui};

use crate::app::command::Command;
use crate::app::shipped_datasets;
use crate::app::source::{OpenDataset, chosen_dataset};
use impactlab_core::data::DatasetKind;

/// Draws a drop-down list of the data sets and returns the response of its button.
///
/// The list shows the data set in use, or else the first, as selected as long as `chosen` names none
/// of them; `chosen` is only written when the user selects an entry, which the response tells.
///
/// - `id`: distinguishes this list from others in the same panel.
/// - `datasets`: the data sets to choose from;
/// - `in_use`: path of the data set whose cases are listed.
/// - `chosen`: path of the chosen data set.
pub fn dataset_choice(
    ui: &mut Ui,
    id: &str,
    datasets: &[OpenDataset<'_>],
    in_use: Option<&Path>,
    chosen: &mut PathBuf,
) -> Response {
    let label =
        |of: &OpenDataset<'_>| format!("{}, {} cases", of.name(), of.checked.dataset.cases.len());
    let current = chosen_dataset(datasets, chosen, in_use);
    let text = current.as_ref().map_or("none is open".to_owned(), label);
    let mut is_selected = false;
    let list = ComboBox::from_id_salt(id).selected_text(text).width(220.0).show_ui(ui, |ui| {
        for of in datasets {
            is_selected |= ui.selectable_value(chosen, of.path.to_owned(), label(of)).changed();
        }
    });
    let mut response = list.response;
    if is_selected {
        response.mark_changed();
    }
    response
}

/// Tells the user that no data set of this kind is open, and which folder to open, and offers the shipped
/// one.
pub fn no_dataset_ui(ui: &mut Ui, kind: DatasetKind, commands: &mut Vec<Command>) {
    ui.label(match kind {
        DatasetKind::Force => "No force data set is open. Open a folder with cases.csv and forces/, e.g. the shipped datasets/fea.",
        DatasetKind::Trajectory => "No trajectory data set is open. Open a folder with cases.csv, trajectories/ and vehicle.toml, e.g. the shipped datasets/trajectories-fea, or a log of one impact as a file.",
    });
    let name = match kind {
        DatasetKind::Force => "fea",
        DatasetKind::Trajectory => "trajectories-fea",
    };
    if let Some(folder) = shipped_datasets()
        && ui.button(format!("Open the shipped {name}")).clicked()
    {
        commands.push(Command::Open(vec![folder.join(name)]));
    }
}
