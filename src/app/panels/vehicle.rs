//! The “Vehicle” pane: the struck and the striking vehicle, the settings of the simulation, and the
//! speed and contact point for files that contain only a force.

use egui::{ComboBox, Grid, ScrollArea, Ui};

use crate::app::model::file_name;
use crate::app::panes::PaneContext;
use crate::app::state::{FileStart, Project};
use crate::app::widgets::{quantity_field, value_row};
use crate::ranges::{CONTACT_HEIGHT, CONTACT_X, CONTACT_Y, SIMULATED_DURATION, SPEED};
use crate::study::{
    ASSUMED_CONTACT, ASSUMED_SPEED_M_S, DEFAULT_BULLET, DEFAULT_VEHICLE, VehicleChoice,
};
use crate::units::{Quantity, UnitSystem};
use crate::vehicle::{
    ContactPoint, Equations, Integrator, LibraryVehicle, Preset, VehicleParameters,
    built_in_vehicle,
};

/// Draws the choice of the vehicles, the equations and the integrator, the start of single force
/// files, and, if the struck vehicle is a preset, its parameters.
pub fn vehicle_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { project, view, .. } = pane;
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        Grid::new("vehicle choice").num_columns(2).show(ui, |ui| {
            choice_ui(ui, project);
            let equations = [None, Some(Equations::Corrected), Some(Equations::Paper)];
            list_ui(ui, "Equations", &mut project.equations, (&equations, equations_label));
            let integrators = [Integrator::Rk4, Integrator::Euler];
            list_ui(ui, "Integration", &mut project.integrator, (&integrators, integrator_label));
            let range = (&SIMULATED_DURATION, view.units);
            quantity_field(ui, "Duration", &mut project.duration_s, range);
            let hint = "The simulation ends where the vehicle has come to rest, at the latest \
                        after the duration";
            ui.checkbox(&mut project.until_rest, "Until rest").on_hover_text(hint);
            ui.end_row();
        });
        ui.separator();
        ui.strong("For single force files");
        Grid::new("file start").num_columns(2).show(ui, |ui| {
            speed_ui(ui, &mut project.file_start, view.units);
            contact_ui(ui, &mut project.file_start, view.units);
        });
        if let VehicleChoice::Preset(id) = &project.vehicle
            && let Some(vehicle) = built_in_vehicle(id)
        {
            ui.separator();
            parameters_ui(ui, &vehicle);
        }
    });
}

/// Draws the choice of the struck and of the striking vehicle.
fn choice_ui(ui: &mut Ui, project: &mut Project) {
    let open = format!("as the data set says, else {}", DEFAULT_VEHICLE.id());
    let hint = "A vehicle file of your own: open it, or drop it here";
    vehicle_choice_ui(ui, ("Struck vehicle", hint), (&mut project.vehicle, &open));
    let open = format!("not known, assumed to be {}", DEFAULT_BULLET.id());
    let hint = "With the mass and yaw inertia of the case or the scenario";
    vehicle_choice_ui(ui, ("Striking vehicle", hint), (&mut project.bullet, &open));
}

/// Draws a row of a two-column grid with the choice of a vehicle among those that come with the
/// program.
///
/// - `open`: text that tells which vehicle is used if the user chooses none.
fn vehicle_choice_ui(
    ui: &mut Ui,
    (title, hint): (&str, &str),
    (choice, open): (&mut VehicleChoice, &str),
) {
    let name = ui.label(title);
    let label = match choice {
        VehicleChoice::Automatic => open.to_owned(),
        VehicleChoice::Preset(id) => id.clone(),
        VehicleChoice::File(path) => file_name(path),
    };
    ComboBox::from_id_salt(title)
        .selected_text(label)
        .show_ui(ui, |ui| {
            ui.selectable_value(choice, VehicleChoice::Automatic, open);
            let presets = Preset::ALL.iter().map(|preset| preset.id());
            for id in presets.chain(LibraryVehicle::ALL.iter().map(|vehicle| vehicle.id())) {
                ui.selectable_value(choice, VehicleChoice::Preset(id.to_owned()), id);
            }
        })
        .response
        .labelled_by(name.id)
        .on_hover_text(hint);
    ui.end_row();
}

/// Draws a row of a two-column grid: a label and a drop-down list of a few values.
///
/// - `options`, `label`: the values, and the function that gives the text of a value.
fn list_ui<T: Copy + PartialEq>(
    ui: &mut Ui,
    title: &str,
    value: &mut T,
    (options, label): (&[T], fn(T) -> &'static str),
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

/// Draws the speed before the impact if the user has set it, otherwise the value that is assumed.
fn speed_ui(ui: &mut Ui, start: &mut FileStart, units: UnitSystem) {
    let label = "Speed before impact";
    let Some(speed_m_s) = &mut start.speed_m_s else {
        let assumed = Quantity::Speed.shown(ASSUMED_SPEED_M_S, units);
        if assumed_ui(ui, label, &assumed) {
            start.speed_m_s = Some(ASSUMED_SPEED_M_S);
        }
        return;
    };
    quantity_field(ui, label, speed_m_s, (&SPEED, units));
    if leave_open_ui(ui, "Speed not known") {
        start.speed_m_s = None;
    }
}

/// Draws the contact point, at which the force acts, if the user has set it, otherwise the point
/// that is assumed.
fn contact_ui(ui: &mut Ui, start: &mut FileStart, units: UnitSystem) {
    let Some(ContactPoint { x_m, y_m, height_m }) = &mut start.contact else {
        let ContactPoint { x_m, y_m, height_m } = ASSUMED_CONTACT;
        let [x, y, z] = [x_m, y_m, height_m].map(|m| Quantity::Length.shown(m, units));
        let assumed =
            format!("{x} ahead, {y} left, {z} high; a yaw moment in the file counts first");
        if assumed_ui(ui, "Contact point", &assumed) {
            start.contact = Some(ASSUMED_CONTACT);
        }
        return;
    };
    for (label, value, range) in [
        ("Contact ahead of CG", x_m, CONTACT_X),
        ("Contact left of CG", y_m, CONTACT_Y),
        ("Contact above ground", height_m, CONTACT_HEIGHT),
    ] {
        quantity_field(ui, label, value, (&range, units));
    }
    if leave_open_ui(ui, "Contact point not known") {
        start.contact = None;
    }
}

/// Draws a row of a two-column grid with the value that is assumed, and returns whether the user
/// clicked the button to set the value instead.
fn assumed_ui(ui: &mut Ui, label: &str, assumed: &str) -> bool {
    ui.label(label);
    let is_clicked = ui
        .horizontal_wrapped(|ui| {
            let button = ui.small_button("Set").on_hover_text("Say it instead of assuming it");
            ui.weak(format!("assumed: {assumed}"));
            button.clicked()
        })
        .inner;
    ui.end_row();
    is_clicked
}

/// Draws a row of a two-column grid with a button, and returns whether the user clicked it to have
/// the value assumed.
fn leave_open_ui(ui: &mut Ui, label: &str) -> bool {
    ui.label("");
    let is_clicked = ui.small_button(label).on_hover_text("Assume a value").clicked();
    ui.end_row();
    is_clicked
}

/// Draws the parameters of a vehicle with the names and SI units of its file, marks the estimates,
/// and lists the rule by which each estimate was made.
fn parameters_ui(ui: &mut Ui, vehicle: &VehicleParameters) {
    ui.strong(&vehicle.name);
    ui.weak(&vehicle.source);
    let Ok(tables) = toml::Table::try_from(vehicle) else { return };
    Grid::new("parameters").striped(true).num_columns(2).show(ui, |ui| {
        for (table, values) in &tables {
            let Some(values) = values.as_table().filter(|_| table != "estimates") else { continue };
            for (key, value) in values {
                let is_estimate = vehicle.estimates.contains_key(&format!("{table}.{key}"));
                let mark = if is_estimate { " (estimate)" } else { "" };
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
