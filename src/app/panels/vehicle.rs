//! The “Vehicle” pane: the struck and the striking vehicle, the settings of the simulation, and the
//! speed and contact point for files that contain only a force.

use egui::{ComboBox, Grid, Response, ScrollArea, Ui};

use crate::app::command::Command;
use crate::app::model::file_name;
use crate::app::panels::file_start::file_start_ui;
use crate::app::panels::vehicle_form::vehicle_form_ui;
use crate::app::panes::PaneContext;
use crate::app::project::Project;
use crate::app::widgets::{facts_ui, quantity_field, value_row, within_view};
use impactlab_core::data::Severity;
use impactlab_core::error_chain;
use impactlab_core::ranges::{REST_LIMIT, SIMULATED_DURATION};
use impactlab_core::vehicle::{
    DataSheet, Equations, Integrator, LibraryVehicle, Preset, VehicleParameters, built_in_vehicle,
};
use impactlab_study::{
    DEFAULT_DURATION_S, DEFAULT_STRIKING, DEFAULT_VEHICLE, MotionSource, VehicleChoice,
};

/// Largest width of the lists of vehicles, points.
const LIST_WIDTH: f32 = 240.0;

/// Largest width of those lists that stand among narrow fields, points.
const NARROW_LIST_WIDTH: f32 = 150.0;

/// Largest height of the lists of vehicles, points.
const LIST_HEIGHT: f32 = 480.0;

/// Draws the choice of the vehicles, the equations and the integrator, the start of single force
/// files, and, if the struck vehicle is a preset, its parameters.
pub fn vehicle_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    ScrollArea::both().auto_shrink(false).show(ui, |ui| {
        let PaneContext { project, view, commands, .. } = &mut *pane;
        Grid::new("vehicle choice").num_columns(2).show(ui, |ui| {
            choice_ui(ui, project, commands);
            let equations = [None, Some(Equations::Corrected), Some(Equations::Paper)];
            list_ui(ui, "Equations", &mut project.simulate.equations, &equations, equations_label);
            let integrators = [Integrator::Rk4, Integrator::Euler];
            list_ui(
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
            until_rest_ui(ui, project);
            ui.end_row();
            one_contact_ui(ui, project);
            ui.end_row();
        });
        for (title, choice) in [
            ("Struck vehicle", &mut project.simulate.vehicle),
            ("Striking vehicle", &mut project.simulate.striking),
        ] {
            if let VehicleChoice::Sheet(sheet) = choice {
                ui.separator();
                vehicle_form_ui(ui, title, sheet, view.units, commands);
            }
        }
        ui.separator();
        file_start_ui(ui, pane);
        uncertainty_ui(ui, pane);
        let project = &pane.project;
        if let VehicleChoice::Preset(id) = &project.simulate.vehicle
            && let Some(vehicle) = built_in_vehicle(id)
        {
            ui.separator();
            parameters_ui(ui, &vehicle);
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
    facts_ui(ui, &answer.report.name, &uncertainty.facts(), pane.view.units);
}

/// Draws the choice whether motions are followed to rest. The duration is then the time after which they
/// are followed no further: where it was the usual one, it becomes the usual one of that.
pub(super) fn until_rest_ui(ui: &mut Ui, project: &mut Project) {
    let hint = "Simulation and forecast end where the vehicle has come to rest, at the latest after \
                the duration";
    let choice = ui.checkbox(&mut project.simulate.until_rest, "Until rest").on_hover_text(hint);
    let (before, after) = match project.simulate.until_rest {
        true => (DEFAULT_DURATION_S, REST_LIMIT.high),
        false => (REST_LIMIT.high, DEFAULT_DURATION_S),
    };
    if choice.changed() && project.simulate.duration_s == before {
        project.simulate.duration_s = after;
    }
}

/// Draws, of a scenario, the choice whether the vehicles are followed through all contacts.
pub(super) fn one_contact_ui(ui: &mut Ui, project: &mut Project) {
    if matches!(project.simulate.source, MotionSource::Scenario { .. }) {
        let hint = "After the first contact each vehicle moves as if it were alone; otherwise both are \
                    followed through all contacts";
        ui.checkbox(&mut project.simulate.one_contact, "One contact only").on_hover_text(hint);
    }
}

/// Draws the choice of the struck and of the striking vehicle.
fn choice_ui(ui: &mut Ui, project: &mut Project, commands: &mut Vec<Command>) {
    let open = format!("as the data set says, else {}", DEFAULT_VEHICLE.id());
    let hint = "A vehicle file of your own: open it, or drop it here";
    let default = DEFAULT_VEHICLE.parameters();
    vehicle_choice_ui(
        ui,
        "Struck vehicle",
        hint,
        &mut project.simulate.vehicle,
        &open,
        &default,
        commands,
    );
    let open = format!("not known, assumed to be {}", DEFAULT_STRIKING.id());
    let hint = "With the mass and yaw inertia of the case or the scenario";
    let default = DEFAULT_STRIKING.parameters();
    vehicle_choice_ui(
        ui,
        "Striking vehicle",
        hint,
        &mut project.simulate.striking,
        &open,
        &default,
        commands,
    );
}

/// Draws a row of a two-column grid with the choice of a vehicle among those that come with the
/// program.
///
/// - `open`, `default`: which vehicle is used if the user chooses none, as text and itself.
fn vehicle_choice_ui(
    ui: &mut Ui,
    title: &str,
    hint: &str,
    choice: &mut VehicleChoice,
    open: &str,
    default: &VehicleParameters,
    commands: &mut Vec<Command>,
) {
    let name = ui.label(title);
    let label = chosen_label(choice, open);
    choice_list_ui(ui, title, &name, hint, choice, open, &[], &label);
    ui.end_row();
    if matches!(choice, VehicleChoice::Sheet(_)) {
        return;
    }
    ui.label("");
    let hint = "A copy with fields for every value: known, or estimated by rule with scatter";
    if ui.small_button("Edit a copy").on_hover_text(hint).clicked() {
        match edited_copy(choice, default) {
            Ok(sheet) => *choice = VehicleChoice::Sheet(Box::new(sheet)),
            Err(why) => commands.push(Command::Say(Severity::Error, why)),
        }
    }
    ui.end_row();
}

/// What a choice is called.
pub(super) fn chosen_label(choice: &VehicleChoice, open: &str) -> String {
    match choice {
        VehicleChoice::Automatic => open.to_owned(),
        VehicleChoice::Preset(id) => id.clone(),
        VehicleChoice::File(path) => file_name(path),
        VehicleChoice::Sheet(sheet) => format!("{} (edited)", sheet.name),
    }
}

/// Draws a row of a two-column grid with the vehicle that a file is about, which it does not say.
pub(in crate::app) fn file_vehicle_ui(ui: &mut Ui, choice: &mut VehicleChoice) {
    let name = ui.label("Struck vehicle");
    let open = format!("{} (assumed)", DEFAULT_VEHICLE.id());
    let label = chosen_label(choice, &open);
    let hint = "Its mass, inertia and tires: the file does not say them";
    choice_list_ui(ui, "vehicle of the file", &name, hint, choice, &open, &[], &label);
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
) {
    let name = ui.label("Data sheet");
    let open = "none: estimated as of any car";
    let label = chosen_label(choice, open);
    let hint = "What the evidence does not say is taken from it; a file of your own is in the list once \
                it is the vehicle of the case: open it, or drop it here";
    ui.scope(|ui| {
        ui.set_max_width(NARROW_LIST_WIDTH);
        choice_list_ui(ui, title, &name, hint, choice, open, own, &label);
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

/// Draws the list of the vehicles that come with the program, after those of the user.
fn choice_list_ui(
    ui: &mut Ui,
    title: &str,
    name: &Response,
    hint: &str,
    choice: &mut VehicleChoice,
    open: &str,
    own: &[VehicleChoice],
    label: &str,
) {
    let list = ComboBox::from_id_salt(title).selected_text(label).truncate().height(LIST_HEIGHT);
    let options_ui = |ui: &mut Ui| {
        ui.selectable_value(choice, VehicleChoice::Automatic, open);
        for vehicle in own {
            ui.selectable_value(choice, vehicle.clone(), chosen_label(vehicle, open));
        }
        let presets = Preset::ALL.iter().map(|preset| preset.id());
        for id in presets.chain(LibraryVehicle::ALL.iter().map(|vehicle| vehicle.id())) {
            ui.selectable_value(choice, VehicleChoice::Preset(id.to_owned()), id);
        }
    };
    within_view(ui, |ui| list.width(ui.available_width().min(LIST_WIDTH)).show_ui(ui, options_ui))
        .response
        .labelled_by(name.id)
        .on_hover_text(hint);
}

/// Draws a row of a two-column grid: a label and a drop-down list of a few values.
///
/// - `options`, `label`: the values, and the function that gives the text of a value.
fn list_ui<T: Copy + PartialEq>(
    ui: &mut Ui,
    title: &str,
    value: &mut T,
    options: &[T],
    label: fn(T) -> &'static str,
) {
    let name = ui.label(title);
    ComboBox::from_id_salt(title)
        .selected_text(label(*value))
        .show_ui(ui, |ui| {
            for &option in options {
                ui.selectable_value(value, option, label(option));
            }
        })
        .response
        .labelled_by(name.id);
    ui.end_row();
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

/// Draws the parameters of a vehicle with the names and SI units of its file, marks the estimates,
/// and lists the rule by which each estimate was made.
fn parameters_ui(ui: &mut Ui, vehicle: &VehicleParameters) {
    ui.strong(&vehicle.name);
    ui.weak(&vehicle.source);
    let Ok(tables) = toml::Table::try_from(vehicle) else { return };
    Grid::new("parameters").striped(true).num_columns(2).show(ui, |ui| {
        for (table, values) in &tables {
            let is_value = table != "estimates" && table != "stated";
            let Some(values) = values.as_table().filter(|_| is_value) else { continue };
            for (key, value) in values {
                let name = format!("{table}.{key}");
                let mark = match vehicle.stated.get(&name) {
                    _ if vehicle.estimates.contains_key(&name) => " (estimate)".to_owned(),
                    Some(note) => format!(" ({note})"),
                    None => String::new(),
                };
                value_row(ui, key, &format!("{value}{mark}"));
            }
        }
    });
    egui::CollapsingHeader::new("Rules of the estimates").show(ui, |ui| {
        for (key, rule) in &vehicle.estimates {
            ui.add(egui::Label::new(format!("{key}: {rule}")).wrap());
        }
    });
}
