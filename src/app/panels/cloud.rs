//! The form that asks how a point cloud becomes a site.

use egui::{Grid, TextEdit, Ui};

use crate::app::command::Command;
use crate::app::ground::{CloudForm, GroundCommand};
use crate::app::widgets::{choice_row, quantity_field, run_progress_ui};
use impactlab_core::jobs::Progress;
use impactlab_core::ranges::PIXEL_SIZE;
use impactlab_core::site::LengthUnit;
use impactlab_core::units::UnitSystem;

/// Units that are offered.
const UNITS: [LengthUnit; 3] = [LengthUnit::Metre, LengthUnit::Foot, LengthUnit::SurveyFoot];

/// Draws the form, or how far the work is, and adds a command when the user has answered.
pub fn cloud_ui(
    ui: &mut Ui,
    form: &mut CloudForm,
    units: UnitSystem,
    progress: Option<&Progress>,
    commands: &mut Vec<Command>,
) {
    ui.heading("Site of a point cloud");
    ui.weak(form.path.display().to_string());
    if let Some(progress) = progress {
        run_progress_ui(ui, &progress.message, progress.fraction(), None);
        if ui.button("Stop").clicked() {
            commands.push(Command::Ground(GroundCommand::StopCloud));
        }
        return;
    }
    ui.label("It becomes a picture from above with its place, in a folder of its own.");
    Grid::new("cloud").num_columns(2).show(ui, |ui| {
        quantity_field(ui, "Pixel", &mut form.pixel_m, &PIXEL_SIZE, units);
        if let Some(unit) = &mut form.unit {
            choice_row(ui, "Unit of its coordinates", unit, &UNITS, LengthUnit::word);
        }
        let name = ui.label("New folder");
        let field = TextEdit::singleline(&mut form.folder).desired_width(420.0);
        ui.add(field).labelled_by(name.id);
        ui.end_row();
    });
    ui.separator();
    ui.horizontal(|ui| {
        let is_possible = !form.folder.trim().is_empty();
        if ui.add_enabled(is_possible, egui::Button::new("Make site")).clicked() {
            commands.push(Command::Ground(GroundCommand::MakeOfCloud(form.clone())));
        }
        if ui.button("Cancel").clicked() {
            commands.push(Command::CloseDialog);
        }
    });
}
