//! The vehicle and how it is simulated.

use egui::{ComboBox, Grid, ScrollArea, Ui};

use crate::app::panes::PaneContext;
use crate::app::state::{Project, VehicleChoice};
use crate::app::widgets::{quantity_field, value_row};
use crate::units::{Quantity, UnitSystem};
use crate::vehicle::{Equations, Integrator, Preset, VehicleParameters};

/// Draws the choice of vehicle and integrator, and the parameters.
pub fn vehicle_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { project, view, .. } = pane;
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        Grid::new("vehicle choice").num_columns(2).show(ui, |ui| {
            choice_ui(ui, project);
            let equations = [Equations::Corrected, Equations::Paper];
            list_ui(ui, "Equations", &mut project.equations, (&equations, equations_label));
            let integrators = [Integrator::Rk4, Integrator::Euler];
            list_ui(ui, "Integration", &mut project.integrator, (&integrators, integrator_label));
            let range = (0.1..=30.0, view.units);
            quantity_field(ui, "Duration", &mut project.duration_s, Quantity::Time, range);
        });
        ui.separator();
        ui.strong("For single force files");
        Grid::new("file setup").num_columns(2).show(ui, |ui| setup_ui(ui, project, view.units));
        if let VehicleChoice::Preset(id) = &project.vehicle
            && let Some(preset) = Preset::from_id(id)
        {
            ui.separator();
            parameters_ui(ui, &preset.parameters());
        }
    });
}

fn choice_ui(ui: &mut Ui, project: &mut Project) {
    let name = ui.label("Struck vehicle");
    let label = match &project.vehicle {
        VehicleChoice::Automatic => "as the data set says".to_owned(),
        VehicleChoice::Preset(id) => id.clone(),
        VehicleChoice::File(path) => {
            path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
        }
    };
    ComboBox::from_id_salt("vehicle")
        .selected_text(label)
        .show_ui(ui, |ui| {
            let choice = &mut project.vehicle;
            ui.selectable_value(choice, VehicleChoice::Automatic, "as the data set says");
            for preset in Preset::ALL {
                let value = VehicleChoice::Preset(preset.id().to_owned());
                ui.selectable_value(choice, value, preset.id());
            }
        })
        .response
        .labelled_by(name.id)
        .on_hover_text("A vehicle file of your own: open it, or drop it here");
    ui.end_row();
    let name = ui.label("Striking vehicle");
    ComboBox::from_id_salt("bullet")
        .selected_text(&project.bullet_preset)
        .show_ui(ui, |ui| {
            for preset in Preset::ALL {
                let id = preset.id().to_owned();
                ui.selectable_value(&mut project.bullet_preset, id, preset.id());
            }
        })
        .response
        .labelled_by(name.id)
        .on_hover_text("With the mass and yaw inertia of the case or the scenario");
    ui.end_row();
}

/// A labelled choice of a few values in a two-column grid.
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

fn equations_label(equations: Equations) -> &'static str {
    match equations {
        Equations::Corrected => "4DOF, corrected",
        Equations::Paper => "4DOF as the paper prints it (diverges)",
    }
}

fn integrator_label(integrator: Integrator) -> &'static str {
    match integrator {
        Integrator::Rk4 => "RK4, 1 ms (reference)",
        Integrator::Euler => "Euler, 10 ms (the paper's baseline)",
    }
}

fn setup_ui(ui: &mut Ui, project: &mut Project, units: UnitSystem) {
    let setup = &mut project.file_setup;
    let [x_m, y_m] = &mut setup.contact_m;
    let fields = [
        ("Speed before impact", &mut setup.speed_m_s, Quantity::Speed, 0.0..=80.0),
        ("Contact ahead of CG", x_m, Quantity::Length, -10.0..=10.0),
        ("Contact left of CG", y_m, Quantity::Length, -3.0..=3.0),
        ("Contact above ground", &mut setup.contact_height_m, Quantity::Length, 0.0..=3.0),
    ];
    for (label, value, quantity, range) in fields {
        quantity_field(ui, label, value, quantity, (range, units));
    }
}

/// The parameters as the file has them, and by which rule the estimates came about.
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
