//! The form that asks what of a crash test a vehicle gets.

use egui::{ComboBox, Grid, Ui};

use crate::app::command::Command;
use crate::app::crash_test::{CrashTestCommand, CrashTestForm};
use impactlab_core::collision::Role;

/// Width of the form, points.
const WIDTH: f32 = 560.0;

/// Draws the form and adds a command when the user has answered.
pub fn crash_test_ui(ui: &mut Ui, form: &mut CrashTestForm, commands: &mut Vec<Command>) {
    ui.set_width(WIDTH);
    ui.heading("Crash test against a rigid barrier");
    ui.label(&form.title);
    Grid::new("crash test").num_columns(2).show(ui, |ui| {
        let rows = [
            ("Mass", format!("{:.0} kg", form.test.mass_kg)),
            ("Speed", format!("{:.2} m/s", form.test.speed_m_s)),
            ("Mean crush", format!("{:.3} m", form.test.mean_crush_m())),
            ("A, onset", format!("{:.0} N/m", form.found.onset_n_per_m)),
            ("B, growth", format!("{:.0} N/m²", form.found.stiffness_n_per_m2)),
        ];
        for (name, value) in rows {
            ui.label(name);
            ui.label(value);
            ui.end_row();
        }
        let name = ui.label("It is the");
        let list = ComboBox::from_id_salt("vehicle of a test").selected_text(form.role.label());
        let list = list.show_ui(ui, |ui| {
            for role in Role::ALL {
                ui.selectable_value(&mut form.role, role, role.label());
            }
        });
        list.response.labelled_by(name.id);
        ui.end_row();
    });
    ui.separator();
    ui.horizontal(|ui| {
        let hint = "A and B of its front, as an edit of its data. Undo takes it back";
        if ui.button("Stiffness into the vehicle").on_hover_text(hint).clicked() {
            let form = Box::new(form.clone());
            commands.push(Command::CrashTest(CrashTestCommand::TakeStiffness(form)));
        }
        if ui.button("Barrier force as a series").clicked() {
            let path = form.path.clone();
            commands.push(Command::CrashTest(CrashTestCommand::OpenForce(path)));
        }
        if ui.button("Cancel").clicked() {
            commands.push(Command::CloseDialog);
        }
    });
}
