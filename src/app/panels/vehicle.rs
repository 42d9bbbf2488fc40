//! The “Vehicle” pane: the struck and the striking vehicle, the settings of the simulation, and the
//! speed and contact point for files that contain only a force.

use egui::{Grid, ScrollArea, Ui};

use crate::app::command::Command;
use crate::app::panels::file_start::file_start_ui;
use crate::app::panels::until_rest::until_rest_ui;
use crate::app::panels::vehicle_form::vehicle_form_ui;
use crate::app::panes::PaneContext;
use crate::app::project::Project;
use crate::app::state::Subject;
use crate::app::vehicles::vehicle_title;
use crate::app::widgets::{
    VehiclePicker, choice_row, facts_ui, name_in_units, quantity_field, value_ui, vehicle_name,
};
use impactlab_core::collision::Role;
use impactlab_core::data::Severity;
use impactlab_core::error_chain;
use impactlab_core::ranges::SIMULATED_DURATION;
use impactlab_core::units::UnitSystem;
use impactlab_core::vehicle::{DataSheet, Equations, Integrator, VehicleParameters};
use impactlab_document::report::vehicle_parameters;
use impactlab_study::{DEFAULT_STRIKING, DEFAULT_VEHICLE, MotionSource, VehicleChoice};

/// Largest width of the list of vehicles where it stands among narrow fields, points.
const NARROW_LIST_WIDTH: f32 = 150.0;

/// Draws the choice of the vehicles, the equations and the integrator, the start of single force
/// files, and the parameters of the vehicles that are chosen.
pub fn vehicle_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    ScrollArea::both().auto_shrink(false).show(ui, |ui| {
        let PaneContext { project, view, commands, .. } = &mut *pane;
        Grid::new("vehicle choice").num_columns(2).show(ui, |ui| {
            for role in Role::ALL {
                vehicle_choice_ui(ui, role, project, view.units, commands);
            }
            let equations = [None, Some(Equations::Corrected), Some(Equations::Paper)];
            choice_row(
                ui,
                "Equations",
                &mut project.simulate.equations,
                &equations,
                equations_label,
            );
            let integrators = Integrator::ALL;
            choice_row(
                ui,
                "Integration",
                &mut project.simulate.integrator,
                &integrators,
                integrator_label,
            );
            let label =
                if project.simulate.until_rest { "At the latest after" } else { "Duration" };
            quantity_field(
                ui,
                label,
                &mut project.simulate.duration_s,
                &SIMULATED_DURATION,
                view.units,
            );
        });
        // Below the grid, in which the question about the driver would stand beside the fields.
        until_rest_ui(ui, project);
        one_contact_ui(ui, project);
        for role in Role::ALL {
            sheet_ui(ui, role, project, view.units, commands);
        }
        // A scenario says all of it itself.
        if pane.project.subject() != Some(Subject::Scenario) {
            ui.separator();
            file_start_ui(ui, pane);
        }
        uncertainty_ui(ui, pane);
        for role in Role::ALL {
            let chosen = pane.session.chosen_vehicles.get(role);
            let is_sheet = matches!(pane.project.vehicle_mut(role), VehicleChoice::Sheet(_));
            if let Some(vehicle) = chosen.filter(|_| !is_sheet) {
                ui.separator();
                parameters_ui(ui, role, vehicle, pane.view.units);
            }
        }
    });
}

/// Draws how the end of the simulation that is shown varies with what the data sheet of the struck
/// vehicle leaves open, and which estimates it depends on; nothing if it leaves nothing open.
fn uncertainty_ui(ui: &mut Ui, pane: &PaneContext<'_>) {
    let Some(answer) = pane.session.analysis.ok() else { return };
    let Some(uncertainty) = &answer.report.uncertainty else { return };
    ui.separator();
    ui.label("4DOF model:");
    super::faded_if(ui, pane.session.is_simulation_late(), |ui| {
        facts_ui(ui, &answer.report.name, &uncertainty.facts(), pane.view.units);
    });
}

/// Draws, of a scenario, the choice whether the vehicles are followed through all contacts.
pub(super) fn one_contact_ui(ui: &mut Ui, project: &mut Project) {
    if matches!(project.simulate.source, MotionSource::Scenario { .. }) {
        let hint = "After the first contact each vehicle moves as if it were alone; otherwise both are \
                    followed through all contacts";
        ui.checkbox(&mut project.simulate.one_contact, "One contact only").on_hover_text(hint);
    }
}

/// Draws the form of a data sheet that is edited. The scenario follows it.
fn sheet_ui(
    ui: &mut Ui,
    role: Role,
    project: &mut Project,
    units: UnitSystem,
    commands: &mut Vec<Command>,
) {
    let VehicleChoice::Sheet(sheet) = project.vehicle_mut(role) else { return };
    ui.separator();
    let before = sheet.clone();
    vehicle_form_ui(ui, vehicle_title(role), sheet, units, commands);
    if **sheet != *before
        && let Ok(before) = before.checked_vehicle()
    {
        project.follow_vehicle(role, &before);
    }
}

/// Draws two rows of a two-column grid with the choice of a vehicle among those that come with the program.
fn vehicle_choice_ui(
    ui: &mut Ui,
    role: Role,
    project: &mut Project,
    units: UnitSystem,
    commands: &mut Vec<Command>,
) {
    let default = match role {
        Role::Struck => DEFAULT_VEHICLE,
        Role::Striking => DEFAULT_STRIKING,
    };
    let default_name = vehicle_name(default.id(), units);
    let named = project.scenario().and_then(|scenario| scenario.vehicle_name(role));
    let is_of_dataset = matches!(project.simulate.source, MotionSource::Case { .. });
    let open = match (named, role) {
        (Some(name), _) => format!("as the scenario says: {}", vehicle_name(name, units)),
        (None, Role::Struck) if is_of_dataset => {
            format!("as the data set says, else {default_name}")
        }
        (None, _) => format!("not known, assumed to be {default_name}"),
    };
    let hint = "The scenario takes over its mass, yaw inertia and outline. A vehicle file of your own: open \
                it, or drop it here";
    let title = vehicle_title(role);
    let name = ui.label(title);
    let picker = VehiclePicker { salt: title, name: &name, hint, open: &open, own: &[], units };
    let mut choice = project.vehicle_mut(role).clone();
    if picker.show(ui, &mut choice) {
        commands.push(Command::ChooseVehicle(role, Box::new(choice.clone())));
    }
    ui.end_row();
    if matches!(choice, VehicleChoice::Sheet(_)) {
        return;
    }
    ui.label("");
    let hint = "A copy with fields for every value: known, or estimated by rule with scatter";
    if ui.small_button("Edit a copy").on_hover_text(hint).clicked() {
        match edited_copy(&project.chosen_vehicle(role), &default.parameters()) {
            Ok(sheet) => project.edit_vehicle(role, sheet),
            Err(why) => commands.push(Command::Say(Severity::Error, why)),
        }
    }
    ui.end_row();
}

/// Draws a row of a two-column grid with the vehicle that a file is about, which it does not say.
pub(in crate::app) fn file_vehicle_ui(ui: &mut Ui, choice: &mut VehicleChoice, units: UnitSystem) {
    let name = ui.label("Struck vehicle");
    let open = format!("{} (assumed)", vehicle_name(DEFAULT_VEHICLE.id(), units));
    let hint = "Its mass, inertia and tires: the file does not say them";
    let salt = "vehicle of the file";
    let picker = VehiclePicker { salt, name: &name, hint, open: &open, own: &[], units };
    picker.show(ui, choice);
    ui.end_row();
}

/// Draws a row with the vehicle whose data stand in where the evidence of a reconstruction says nothing.
///
/// - `own`: vehicles of the user that can be chosen, too.
pub(super) fn evidence_vehicle_ui(
    ui: &mut Ui,
    title: &str,
    choice: &mut VehicleChoice,
    own: &[VehicleChoice],
    units: UnitSystem,
) {
    let name = ui.label("Data sheet");
    let open = "none: estimated as of any car";
    let hint = "What the evidence does not say is taken from it; a file of your own is in the list once \
                it is the vehicle of the case: open it, or drop it here";
    ui.scope(|ui| {
        ui.set_max_width(NARROW_LIST_WIDTH);
        VehiclePicker { salt: title, name: &name, hint, open, own, units }.show(ui, choice);
    });
    ui.end_row();
}

/// A data sheet that leads to the chosen vehicle, to be edited.
fn edited_copy(choice: &VehicleChoice, default: &VehicleParameters) -> Result<DataSheet, String> {
    let chosen = choice.chosen().map_err(|error| error_chain(&error))?;
    let vehicle = chosen.as_ref().unwrap_or(default);
    DataSheet::from_parameters(vehicle).ok_or_else(|| {
        format!("no data sheet leads to all parameters of {}: edit its file instead", vehicle.name)
    })
}

fn equations_label(equations: Option<Equations>) -> &'static str {
    match equations {
        None => "as the vehicle says",
        Some(Equations::Corrected) => "4DOF, corrected",
        Some(Equations::Paper) => "4DOF as the paper prints it (diverges)",
    }
}

fn integrator_label(integrator: Integrator) -> &'static str {
    match integrator {
        Integrator::Rk4 => "RK4, 1 ms (reference)",
        Integrator::Euler => "Euler, 10 ms (the paper's baseline)",
    }
}

/// Draws the parameters of a vehicle, marks the estimates, and tells in the hint of each where it comes from.
fn parameters_ui(ui: &mut Ui, role: Role, vehicle: &VehicleParameters, units: UnitSystem) {
    ui.weak(vehicle_title(role));
    ui.strong(name_in_units(&vehicle.name, units));
    ui.weak(&vehicle.source);
    Grid::new(("parameters", vehicle_title(role))).striped(true).num_columns(2).show(ui, |ui| {
        for parameter in vehicle_parameters(vehicle, units) {
            let mark = if parameter.is_estimate { " (estimate)" } else { "" };
            ui.label(parameter.label).on_hover_text(parameter.source);
            value_ui(ui, &format!("{}{mark}", parameter.value));
            ui.end_row();
        }
    });
}
