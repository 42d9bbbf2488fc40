//! The “Scenario” pane: the form of a collision of two vehicles, with its momentum solution.

use egui::{ComboBox, Grid, ScrollArea, Ui};

use crate::app::command::Command;
use crate::app::dialog::Purpose;
use crate::app::output::Output;
use crate::app::panels::ending::ending_form;
use crate::app::panels::scenario_plan::scenario_plan_ui;
use crate::app::panes::PaneContext;
use crate::app::project::Project;
use crate::app::state::Subject;
use crate::app::widgets::{EmptyField, caveats_ui, facts_ui, optional_quantity, quantity_field};
use impactlab_core::collision::{
    ContactLocation, DEFAULT_FRICTION_LIMIT, PulseShape, RestitutionForm, Scenario,
    ScenarioContact, ScenarioVehicle, Side, default_restitution_in_words,
};
use impactlab_core::data::Severity;
use impactlab_core::ranges::{
    BODY_CG, BODY_LENGTH, BODY_MASS, BODY_WIDTH, BODY_YAW_INERTIA, CONTACT_COORDINATE,
    CONTACT_HEIGHT, CONTACT_OFFSET, FRICTION_LIMIT, FRICTION_OF_CRITICAL, HEADING, POSITION,
    PULSE_DURATION, RESTITUTION, Range, SPEED, YAW_RATE,
};
use impactlab_core::units::UnitSystem;
use impactlab_draw::theme;
use impactlab_study::analysis::PulseSetup;

/// Draws the plan view of the vehicles at first contact, the momentum solution, and the form that
/// edits the scenario.
pub fn scenario_ui(ui: &mut Ui, pane: &mut PaneContext<'_>) {
    let PaneContext { project, view, session, commands, .. } = pane;
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        ui.horizontal_wrapped(|ui| {
            ui.strong(project.impact.scenario.name());
            if ui.button("Open…").clicked() {
                commands.push(Command::Ask(Purpose::Files));
            }
            if ui.button("Save…").clicked() {
                commands.push(Command::Ask(Purpose::Save(Output::Scenario)));
            }
            let shown = project.subject() == Some(Subject::Scenario);
            let hint = "Spread the impulse over a pulse and simulate both vehicles";
            if !shown && ui.button("Simulate in the scene").on_hover_text(hint).clicked() {
                commands.push(Command::Select(Subject::Scenario));
            }
        });
        let answer = session.impact.answer.as_ref();
        let solved = answer.and_then(|answer| answer.as_deref().ok());
        if let Some(scenario) = project.scenario_mut() {
            scenario_plan_ui(ui, scenario, solved, view.units, session.fit_plots, commands);
        }
        match answer {
            Some(Ok(answer)) => {
                let report = &answer.report;
                facts_ui(ui, &report.name, &report.facts(), view.units);
                caveats_ui(ui, &report.caveats, commands);
            }
            Some(Err(problem)) => {
                let color = theme::severity_color(Severity::Error, ui.visuals().dark_mode);
                ui.colored_label(color, problem);
            }
            None => drop(ui.spinner()),
        }
        ui.separator();
        let mut pulse = *project.pulse_mut();
        let Project { impact, beside, .. } = &mut **project;
        let Some(scenario) = impact.scenario.inline_mut() else { return };
        contact_form(ui, &mut scenario.contact, &mut pulse, view.units);
        let Scenario { ending, striking_ending, .. } = scenario;
        for (vehicle, ending) in [("struck vehicle", ending), ("striking vehicle", striking_ending)]
        {
            ending_form(ui, vehicle, ending, &mut beside.steering_ratio, view.units);
        }
        vehicles_form(ui, scenario, view.units);
        *project.pulse_mut() = pulse;
    });
}

fn vehicles_form(ui: &mut Ui, scenario: &mut Scenario, units: UnitSystem) {
    let Scenario { struck, striking, .. } = scenario;
    for (title, vehicle) in [("Struck vehicle", struck), ("Striking vehicle", striking)] {
        egui::CollapsingHeader::new(title).default_open(true).show(ui, |ui| {
            Grid::new(title).num_columns(2).show(ui, |ui| vehicle_form(ui, vehicle, units));
        });
    }
}

/// Draws the fields of one vehicle in a two-column grid. The velocity is edited as speed and course
/// in world axes.
fn vehicle_form(ui: &mut Ui, vehicle: &mut ScenarioVehicle, units: UnitSystem) {
    let mut speed_m_s = vehicle.vx_world_m_s.hypot(vehicle.vy_world_m_s);
    let mut course_rad = vehicle.vy_world_m_s.atan2(vehicle.vx_world_m_s);
    // The course says which way.
    let forwards = SPEED.within([0.0, f64::INFINITY]);
    let mut moved = quantity_field(ui, "Speed", &mut speed_m_s, &forwards, units);
    moved |= quantity_field(ui, "Course (of velocity)", &mut course_rad, &HEADING, units);
    if moved {
        vehicle.vx_world_m_s = speed_m_s * course_rad.cos();
        vehicle.vy_world_m_s = speed_m_s * course_rad.sin();
    }
    let fields = [
        ("Heading", &mut vehicle.heading_rad, HEADING),
        ("Yaw rate", &mut vehicle.yaw_rate_rad_s, YAW_RATE),
        ("Mass", &mut vehicle.mass_kg, BODY_MASS),
        ("Yaw inertia", &mut vehicle.yaw_inertia_kg_m2, BODY_YAW_INERTIA),
        ("Length", &mut vehicle.length_m, BODY_LENGTH),
        ("Width", &mut vehicle.width_m, BODY_WIDTH),
    ];
    for (label, value, range) in fields {
        quantity_field(ui, label, value, &range, units);
    }
    let range = BODY_CG.at_most(vehicle.length_m);
    quantity_field(ui, "CG behind front", &mut vehicle.cg_from_front_m, &range, units);
}

/// Draws the fields of restitution and friction.
fn surface_form(ui: &mut Ui, contact: &mut ScenarioContact, units: UnitSystem) {
    let hint =
        format!("empty: by the speed at which they close, {}", default_restitution_in_words());
    stated_field(ui, "Restitution e", &hint, &mut contact.restitution, &RESTITUTION, units);
    let name = ui.label("Restitution acts");
    ComboBox::from_id_salt("restitution form")
        .selected_text(contact.restitution_form.label())
        .show_ui(ui, |ui| {
            for form in RestitutionForm::ALL {
                ui.selectable_value(&mut contact.restitution_form, form, form.label());
            }
        })
        .response
        .labelled_by(name.id);
    ui.end_row();
    let mut is_of_critical = contact.friction_of_critical.is_some();
    ui.label("");
    let hint = "The friction limit as a share of the impulse ratio at which the vehicles just stop \
                sliding";
    let chosen = ui.checkbox(&mut is_of_critical, "Friction by the critical ratio");
    if chosen.on_hover_text(hint).changed() {
        contact.friction_of_critical = is_of_critical.then_some(1.0);
    }
    ui.end_row();
    match &mut contact.friction_of_critical {
        Some(share) => {
            quantity_field(ui, "Share of critical ratio", share, &FRICTION_OF_CRITICAL, units);
        }
        None => {
            let hint = format!("empty: {DEFAULT_FRICTION_LIMIT}");
            let limit = &mut contact.friction_limit;
            stated_field(ui, "Friction limit μ_c", &hint, limit, &FRICTION_LIMIT, units);
        }
    }
}

/// Draws a row for a number that the program chooses where the user does not state it.
///
/// - `hint`: what holds while the field is empty.
fn stated_field(
    ui: &mut Ui,
    label: &str,
    hint: &str,
    value: &mut Option<f64>,
    range: &Range,
    units: UnitSystem,
) {
    let name = ui.label(label);
    let empty = EmptyField { text: "by default", start_si: DEFAULT_FRICTION_LIMIT };
    let field = optional_quantity(ui, value, empty, range, units);
    field.labelled_by(name.id).on_hover_text(hint);
    ui.end_row();
}

/// Draws the fields of the contact location, restitution and friction, and of the pulse over which
/// the impulse is spread in the simulation.
fn contact_form(
    ui: &mut Ui,
    contact: &mut ScenarioContact,
    pulse: &mut PulseSetup,
    units: UnitSystem,
) {
    egui::CollapsingHeader::new("Contact").default_open(true).show(ui, |ui| {
        Grid::new("contact").num_columns(2).show(ui, |ui| {
            location_form(ui, &mut contact.location, units);
            surface_form(ui, contact, units);
            let fields = [
                ("Pulse duration", &mut pulse.duration_s, PULSE_DURATION),
                ("Height above ground", &mut pulse.contact_height_m, CONTACT_HEIGHT),
            ];
            for (label, value, range) in fields {
                quantity_field(ui, label, value, &range, units);
            }
            let name = ui.label("Pulse shape");
            ComboBox::from_id_salt("pulse shape")
                .selected_text(pulse.shape.label())
                .show_ui(ui, |ui| {
                    for shape in PulseShape::ALL {
                        ui.selectable_value(&mut pulse.shape, shape, shape.label());
                    }
                })
                .response
                .labelled_by(name.id);
            ui.end_row();
        });
    });
}

/// Draws the fields of the contact location, in the way in which the scenario specifies it.
fn location_form(ui: &mut Ui, location: &mut ContactLocation, units: UnitSystem) {
    let length = |ui: &mut Ui, label: &str, value: &mut f64, range: &Range| {
        quantity_field(ui, label, value, range, units);
    };
    match location {
        ContactLocation::Side { side, offset_m } => {
            let name = ui.label("Struck side");
            ComboBox::from_id_salt("side")
                .selected_text(side.name())
                .show_ui(ui, |ui| {
                    for option in Side::ALL {
                        ui.selectable_value(side, option, option.name());
                    }
                })
                .response
                .labelled_by(name.id);
            ui.end_row();
            length(ui, "Offset from its middle", offset_m, &CONTACT_OFFSET);
        }
        ContactLocation::Footprints { striking_x_world_m, striking_y_world_m } => {
            length(ui, "Striking CG, X", striking_x_world_m, &POSITION);
            length(ui, "Striking CG, Y", striking_y_world_m, &POSITION);
        }
        ContactLocation::Point {
            x_body_m,
            y_body_m,
            normal_body_rad,
            striking_x_world_m,
            striking_y_world_m,
        } => {
            length(ui, "Contact ahead of CG", x_body_m, &CONTACT_COORDINATE);
            length(ui, "Contact left of CG", y_body_m, &CONTACT_COORDINATE);
            quantity_field(ui, "Normal", normal_body_rad, &HEADING, units);
            length(ui, "Striking CG, X", striking_x_world_m, &POSITION);
            length(ui, "Striking CG, Y", striking_y_world_m, &POSITION);
        }
    }
}
