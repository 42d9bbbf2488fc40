//! The “Scenario” pane: the form of a collision of two vehicles, with its momentum solution.

use egui::{Grid, ScrollArea, Ui};

use crate::app::command::Command;
use crate::app::dialog::Purpose;
use crate::app::ground::{ABOUT_SITES, GroundCommand, GroundSession, OPEN_SITE, REMOVE_SITE, SITE};
use crate::app::output::Output;
use crate::app::panels::ending::ending_form;
use crate::app::panels::scenario_plan::scenario_plan_ui;
use crate::app::panes::PaneContext;
use crate::app::project::{Beside, Project};
use crate::app::state::{Session, Subject};
use crate::app::vehicles::{ChosenVehicles, vehicle_title};
use crate::app::widgets::{
    EmptyField, caveats_ui, choice_row, facts_ui, optional_quantity, problem_line_ui,
    quantity_field, quantity_value, within_view,
};
use impactlab_core::collision::{
    ContactLocation, DEFAULT_FRICTION_LIMIT, PulseShape, RestitutionForm, Role, Scenario,
    ScenarioContact, ScenarioSkid, ScenarioVehicle, SharedNumber, Side,
    default_restitution_in_words,
};
use impactlab_core::ranges::{
    BODY_CG, BODY_LENGTH, BODY_MASS, BODY_WIDTH, BODY_YAW_INERTIA, CONTACT_COORDINATE,
    CONTACT_HEIGHT, CONTACT_OFFSET, FRICTION_LIMIT, FRICTION_OF_CRITICAL, HEADING, POSITION,
    PULSE_DURATION, RESTITUTION, ROAD_CROSS_SLOPE, ROAD_FRICTION, ROAD_FRICTION_SIGMA, ROAD_GRADE,
    Range, SKID_LENGTH, SPEED, YAW_RATE,
};
use impactlab_core::units::{NumberFormat, UnitSystem};
use impactlab_core::vehicle::{
    BuiltInVehicle, FixedObject, RoadSlope, VehicleParameters, usual_road_sigma,
};
use impactlab_study::DEFAULT_VEHICLE;
use impactlab_study::analysis::PulseSetup;

/// Drag factor with which a skid begins in the form: locked wheels on dry asphalt.
const USUAL_DRAG_FACTOR: f64 = 0.7;

/// Draws the plan view of the vehicles at first contact, the forms that edit the scenario, and the momentum
/// solution.
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
        // The line is always there, so that the fields do not move while numbers are entered.
        problem_line_ui(ui, answer.and_then(|answer| answer.as_ref().err()).map(String::as_str));
        let mut pulse = *project.pulse_mut();
        let Project { impact, beside, .. } = &mut **project;
        if let Some(scenario) = impact.scenario.inline_mut() {
            forms_ui(ui, scenario, &mut pulse, beside, session, view.units);
        }
        *project.pulse_mut() = pulse;
        let vehicle = session.chosen_vehicles.get(Role::Struck);
        road_form(ui, project.road_mut(), vehicle, (&session.ground, view.units), commands);
        ui.separator();
        match answer {
            Some(Ok(answer)) => {
                let report = &answer.report;
                super::faded_if(ui, session.impact.is_late(), |ui| {
                    facts_ui(ui, &report.name, &report.facts(), view.units);
                    caveats_ui(ui, &report.caveats, view.units, commands);
                });
            }
            Some(Err(_)) => {}
            None => drop(ui.spinner()),
        }
    });
}

/// Draws what is entered of a scenario.
fn forms_ui(
    ui: &mut Ui,
    scenario: &mut Scenario,
    pulse: &mut PulseSetup,
    beside: &mut Beside,
    session: &Session,
    units: UnitSystem,
) {
    vehicles_form(ui, scenario, &session.chosen_vehicles, units);
    approach_form(ui, scenario, units);
    contact_form(ui, &mut scenario.contact, pulse, units);
    let Scenario { ending, striking_ending, .. } = scenario;
    for (role, ending) in Role::ALL.into_iter().zip([ending, striking_ending]) {
        let whose = format!("After the impact: the {}", role.label());
        ending_form(ui, &whose, ending, &mut beside.steering_ratio, units);
    }
    slope_form(ui, &mut scenario.road, units);
}

/// Draws the fields of the slope of the road. A level road is not said.
fn slope_form(ui: &mut Ui, road: &mut Option<RoadSlope>, units: UnitSystem) {
    egui::CollapsingHeader::new("Slope of the road").show(ui, |ui| {
        Grid::new("slope").num_columns(2).show(ui, |ui| {
            let before = road.unwrap_or_default();
            let mut slope = before;
            quantity_field(ui, "Grade along X, uphill", &mut slope.grade, &ROAD_GRADE, units);
            let cross = &mut slope.cross_slope;
            quantity_field(ui, "Cross slope, up to the left", cross, &ROAD_CROSS_SLOPE, units);
            if slope != before {
                *road = (!slope.is_level()).then_some(slope);
            }
        });
    });
}

fn vehicles_form(ui: &mut Ui, scenario: &mut Scenario, chosen: &ChosenVehicles, units: UnitSystem) {
    for role in Role::ALL {
        let title = vehicle_title(role);
        egui::CollapsingHeader::new(title).default_open(true).show(ui, |ui| {
            let of = chosen.get(role);
            if let Some(of) = of {
                ui.add(egui::Label::new(&of.name).wrap());
            }
            let vehicle = scenario.vehicle_mut(role);
            Grid::new(title).num_columns(2).show(ui, |ui| vehicle_form(ui, vehicle, of, units));
        });
    }
}

/// Draws the fields of one vehicle in a two-column grid. The velocity is edited as speed and course
/// in world axes.
///
/// - `of`: the vehicle that it is; what the scenario says otherwise can be set back to its value.
fn vehicle_form(
    ui: &mut Ui,
    vehicle: &mut ScenarioVehicle,
    of: Option<&VehicleParameters>,
    units: UnitSystem,
) {
    if let Some(object) = vehicle.fixed {
        return fixed_form(ui, object, vehicle, units);
    }
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
    quantity_field(ui, "Heading", &mut vehicle.heading_rad, &HEADING, units);
    quantity_field(ui, "Yaw rate", &mut vehicle.yaw_rate_rad_s, &YAW_RATE, units);
    skid_form(ui, &mut vehicle.skid, units);
    let shared = of.map(|of| vehicle.beside(of));
    let mass_before_kg = vehicle.mass_kg;
    let cg_range = BODY_CG.at_most(vehicle.length_m);
    let fields = [
        ("Mass", &mut vehicle.mass_kg, BODY_MASS),
        ("Yaw inertia", &mut vehicle.yaw_inertia_kg_m2, BODY_YAW_INERTIA),
        ("Length", &mut vehicle.length_m, BODY_LENGTH),
        ("Width", &mut vehicle.width_m, BODY_WIDTH),
        ("CG behind front", &mut vehicle.cg_from_front_m, cg_range),
    ];
    for (i, (label, value, range)) in fields.into_iter().enumerate() {
        let name = ui.label(label);
        ui.horizontal(|ui| {
            let (field, _) = quantity_value(ui, value, &range, units);
            field.labelled_by(name.id);
            if let Some(other) = shared.map(|shared| shared[i]).filter(SharedNumber::differs) {
                reset_ui(ui, value, &other, &range, units);
            }
        });
        ui.end_row();
    }
    // An inertia that is that of the car goes with the mass where it is estimated by it.
    if let (Some(of), Some([_, inertia, ..])) = (of, shared)
        && vehicle.mass_kg != mass_before_kg
        && !inertia.differs()
    {
        let loaded = of.clone().with_mass(vehicle.mass_kg, None);
        vehicle.yaw_inertia_kg_m2 = loaded.mass.yaw_inertia_kg_m2;
    }
}

/// Draws the fields of a skid that ends at the first contact.
fn skid_form(ui: &mut Ui, skid: &mut Option<ScenarioSkid>, units: UnitSystem) {
    let mut length_m = skid.map(|skid| skid.length_m);
    let name = ui.label("Skid before contact");
    let empty = EmptyField { text: "none", start_si: 10.0 };
    let field = optional_quantity(ui, &mut length_m, empty, &SKID_LENGTH, units);
    let hint = "The velocity above is that after it; the speed before it is told below";
    field.labelled_by(name.id).on_hover_text(hint);
    ui.end_row();
    let drag_factor = skid.map_or(USUAL_DRAG_FACTOR, |skid| skid.drag_factor);
    *skid = length_m.map(|length_m| ScenarioSkid { length_m, drag_factor });
    if let Some(skid) = skid {
        quantity_field(ui, "Drag factor of the skid", &mut skid.drag_factor, &ROAD_FRICTION, units);
    }
}

/// Draws the fields of an object that does not move.
fn fixed_form(ui: &mut Ui, object: FixedObject, vehicle: &mut ScenarioVehicle, units: UnitSystem) {
    ui.label("Fixed object");
    ui.label(object.word());
    ui.end_row();
    match object {
        FixedObject::Wall => {
            quantity_field(ui, "Direction along it", &mut vehicle.heading_rad, &HEADING, units);
            quantity_field(ui, "Length", &mut vehicle.length_m, &BODY_LENGTH, units);
            quantity_field(ui, "Thickness", &mut vehicle.width_m, &BODY_WIDTH, units);
        }
        FixedObject::Pole => {
            let range = BODY_LENGTH.at_most(BODY_WIDTH.high);
            quantity_field(ui, "Diameter", &mut vehicle.length_m, &range, units);
            vehicle.width_m = vehicle.length_m;
        }
    }
    vehicle.cg_from_front_m = vehicle.length_m / 2.0;
}

/// Draws the button that sets a number of the scenario back to that of its vehicle.
fn reset_ui(ui: &mut Ui, value: &mut f64, other: &SharedNumber, range: &Range, units: UnitSystem) {
    let own = NumberFormat::english(units).rounded(other.quantity, other.in_vehicle);
    let hint = format!("The vehicle has {own}. Click to take that over");
    if ui.small_button(format!("back to {own}")).on_hover_text(hint).clicked() {
        *value = other.in_vehicle.clamp(range.low, range.high);
    }
}

/// Draws the fields of restitution and friction.
fn surface_form(ui: &mut Ui, contact: &mut ScenarioContact, units: UnitSystem) {
    let by_default = default_restitution_in_words().say(&NumberFormat::english(units));
    let hint = format!("empty: by the speed at which they close, {by_default}");
    stated_field(ui, "Restitution e", &hint, &mut contact.restitution, &RESTITUTION, units);
    let (form, forms) = (&mut contact.restitution_form, RestitutionForm::ALL);
    choice_row(ui, "Restitution acts", form, &forms, RestitutionForm::label);
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

/// Draws the fields of the road, and the site on which it is.
///
/// - `vehicle`: the struck vehicle, whose friction counts where none is said.
fn road_form(
    ui: &mut Ui,
    [friction, sigma]: [&mut Option<f64>; 2],
    vehicle: Option<&VehicleParameters>,
    (ground, units): (&GroundSession, UnitSystem),
    commands: &mut Vec<Command>,
) {
    let default = || BuiltInVehicle::from_id(DEFAULT_VEHICLE.id()).map(|of| &of.parameters);
    let usual = vehicle.or_else(default).map_or(0.8, |of| of.tires.friction);
    let spread = usual_road_sigma(friction.unwrap_or(usual));
    let shown = |value| NumberFormat::english(units).rounded(ROAD_FRICTION.quantity, value);
    egui::CollapsingHeader::new("Road").default_open(true).show(ui, |ui| {
        Grid::new("road").num_columns(2).show(ui, |ui| {
            let name = ui.label("Friction μ");
            let text = format!("{} (vehicle)", shown(usual));
            let empty = EmptyField { text: &text, start_si: usual };
            let field = optional_quantity(ui, friction, empty, &ROAD_FRICTION, units);
            field.labelled_by(name.id);
            ui.end_row();
            let name = ui.label("± (standard deviation)");
            let text = format!("{} (usual)", shown(spread));
            let empty = EmptyField { text: &text, start_si: spread };
            let field = optional_quantity(ui, sigma, empty, &ROAD_FRICTION_SIGMA, units);
            let hint = "How well the friction is known; it is drawn in the forecast. 0: exactly";
            field.labelled_by(name.id).on_hover_text(hint);
            ui.end_row();
            site_row_ui(ui, ground, commands);
        });
    });
}

/// Draws a row of a two-column grid with the site and what opens and removes it.
fn site_row_ui(ui: &mut Ui, ground: &GroundSession, commands: &mut Vec<Command>) {
    ui.label(SITE).on_hover_text(ABOUT_SITES);
    within_view(ui, |ui| {
        ui.horizontal_wrapped(|ui| {
            match (ground.shown(), &ground.problem) {
                (Some(loaded), _) => drop(ui.label(&loaded.site.name)),
                (None, Some(problem)) => drop(ui.label("not read").on_hover_text(problem)),
                (None, None) if ground.is_loading() => drop(ui.weak("loading…")),
                (None, None) => drop(ui.weak("none, lanes are not counted")),
            }
            if ui.small_button(OPEN_SITE).on_hover_text(ABOUT_SITES).clicked() {
                commands.push(Command::Ask(Purpose::Ground));
            }
            let has_one = ground.shown().is_some() || ground.problem.is_some();
            if has_one && ui.small_button(REMOVE_SITE).clicked() {
                commands.push(Command::Ground(GroundCommand::Remove));
            }
        });
    });
    ui.end_row();
}

/// Draws the place and the speeds of a blow into a side as a driver would tell them: other names for the
/// offset of the contact and the velocity of the striking vehicle.
fn approach_form(ui: &mut Ui, scenario: &mut Scenario, units: UnitSystem) {
    let Some(mut approach) = scenario.side_approach() else { return };
    let heading = egui::CollapsingHeader::new("Approach").default_open(true);
    let shown = heading.show(ui, |ui| {
        let half_m = scenario.struck.length_m / 2.0;
        let rear = CONTACT_OFFSET.within([CONTACT_OFFSET.low + half_m, CONTACT_OFFSET.high]);
        let fields = [
            ("Contact ahead of rear bumper", &mut approach.ahead_of_rear_m, rear),
            ("Striking vehicle faster by", &mut approach.faster_m_s, SPEED),
            ("Closing speed across", &mut approach.closing_m_s, SPEED),
        ];
        let grid = Grid::new("approach").num_columns(2);
        let moved = grid.show(ui, |ui| {
            fields.into_iter().fold(false, |moved, (label, value, range)| {
                quantity_field(ui, label, value, &range, units) | moved
            })
        });
        moved.inner
    });
    let hint = "Along and across the heading of the struck vehicle. Changes the offset of the contact and \
                the velocity of the striking vehicle; its heading stays";
    shown.header_response.on_hover_text(hint);
    if shown.body_returned == Some(true) {
        scenario.approach_beside(approach);
    }
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
            let (shape, shapes) = (&mut pulse.shape, PulseShape::ALL);
            choice_row(ui, "Pulse shape", shape, &shapes, PulseShape::label);
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
            choice_row(ui, "Struck side", side, &Side::ALL, Side::name);
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
