//! The form that asks what of a crash test a vehicle gets.

use egui::{Button, Grid, Ui};

use crate::app::command::Command;
use crate::app::crash_test::{CrashTestCommand, CrashTestForm};
use crate::app::widgets::{choice_row, notice_ui, value_row};
use impactlab_core::collision::Role;
use impactlab_core::data::Severity;
use impactlab_core::units::{Quantity, UnitSystem};

/// Width of the form, points.
const WIDTH: f32 = 560.0;

/// Draws the form and adds a command when the user has answered.
pub fn crash_test_ui(
    ui: &mut Ui,
    form: &mut CrashTestForm,
    units: UnitSystem,
    commands: &mut Vec<Command>,
) {
    ui.set_width(WIDTH);
    ui.heading("Crash test against a rigid barrier");
    ui.label(&form.title);
    Grid::new("crash test").num_columns(2).show(ui, |ui| {
        for (name, value) in rows(form, units) {
            value_row(ui, name, &value);
        }
        choice_row(ui, "It is the", &mut form.role, &Role::ALL, Role::label);
    });
    let is_editable = form.editable.contains(&form.role);
    for doubt in &form.doubts {
        notice_ui(ui, Severity::Warning, doubt);
    }
    if !is_editable {
        let label = form.role.label();
        let text = format!("no {label} is chosen whose data can be edited");
        notice_ui(ui, Severity::Warning, text);
    }
    ui.separator();
    ui.horizontal(|ui| {
        let hint = "A and B of its front, as an edit of its data. Undo takes it back";
        let take = ui.add_enabled(is_editable, Button::new("Stiffness into the vehicle"));
        let lacks = "Choose it in the Vehicle pane, then open the test again";
        if take.on_hover_text(hint).on_disabled_hover_text(lacks).clicked() {
            let form = Box::new(form.clone());
            commands.push(Command::CrashTest(CrashTestCommand::TakeStiffness(form)));
        }
        let hint = "From A, B, the width and C1 to C6: it should be the energy of the test";
        if ui.button("Crush energy by hand").on_hover_text(hint).clicked() {
            let form = Box::new(form.clone());
            commands.push(Command::CrashTest(CrashTestCommand::CheckByHand(form)));
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

/// What the test says and what follows from it, by their names.
fn rows(form: &CrashTestForm, units: UnitSystem) -> Vec<(&'static str, String)> {
    let CrashTestForm { test, found, momentum, .. } = form;
    let energy_j = test.mass_kg * test.speed_m_s.powi(2) / 2.0;
    let mut rows = vec![
        ("Mass", Quantity::Mass.shown(test.mass_kg, units)),
        ("Speed", Quantity::Speed.shown(test.speed_m_s, units)),
        ("Energy", Quantity::Energy.shown(energy_j, units)),
        ("Mean crush", Quantity::Length.shown(test.mean_crush_m(), units)),
        ("A, onset", Quantity::ForcePerLength.shown(found.onset_n_per_m, units)),
        ("B, growth", Quantity::ForcePerArea.shown(found.stiffness_n_per_m2, units)),
        ("Kv", Quantity::ForcePerArea.shown(test.single_stiffness_n_per_m2(), units)),
        ("Nothing is crushed up to", Quantity::Speed.shown(test.no_damage_speed_m_s, units)),
    ];
    let share =
        momentum.map(|momentum| format!("{:.3} of the momentum of the car", momentum.ratio()));
    rows.extend(share.map(|share| ("Impulse of the barrier", share)));
    rows
}
