//! The form with the collision whose force is predicted: masses, velocities, heading of the
//! striking vehicle, struck side, contact point and bodies of both vehicles.

use std::f64::consts::FRAC_PI_2;

use egui::{ComboBox, Grid, Ui};

use crate::app::command::Command;
use crate::app::force::{
    ForceSession, NamedCollision, collision_of, forget_contact, know_contact, set_contact_x,
    set_mass, set_side, set_striking_heading,
};
use crate::app::project::Project;
use crate::app::state::{Session, View};
use crate::app::widgets::{SliderRange, quantity_slider};
use impactlab_core::data::StruckSide;
use impactlab_core::ranges::{BODY_MASS, CONTACT_X, HEADING, SPEED, YAW_RATE};
use impactlab_core::units::UnitSystem;
use impactlab_networks::force::ForceScenario;

/// Width of a slider without its number field, points.
const SLIDER_WIDTH: f32 = 110.0;

/// What stands in the place of the numbers of a collision that has none.
pub const COLLISION_NOT_KNOWN: &str = "There is no collision to predict: the vehicles of the scenario do \
     not meet, or the data set of the case is not open. Change the scenario, or open the data set.";

/// Draws the origin of the collision, its numbers, and which of them are open.
pub fn form_ui(
    ui: &mut Ui,
    project: &mut Project,
    view: &mut View,
    session: &Session,
    commands: &mut Vec<Command>,
) {
    let force = &session.force;
    let collision = collision_of(&project.predict_force, &session.sources);
    start_ui(ui, collision.as_ref(), view, force, commands);
    let Some(collision) = collision else {
        ui.weak(COLLISION_NOT_KNOWN);
        return;
    };
    ui.spacing_mut().slider_width = SLIDER_WIDTH;
    let model = force.model.current.as_ref().map(|current| &current.model);
    let bodies = model.map(|model| [model.bodies(), model.struck_bodies()]).unwrap_or_default();
    let mut edited = collision.clone();
    Grid::new("force scenario").num_columns(2).show(ui, |ui| {
        let numbers = &mut edited.numbers;
        motion_ui(ui, numbers, view.units);
        side_ui(ui, numbers);
        contact_ui(ui, numbers, view.units);
        let [striking, struck] = &bodies;
        body_ui(ui, "Striking body", &mut numbers.striking_body, striking);
        // A body that the data name or a case asks for is seen, and can be taken back.
        if !struck.is_empty() || numbers.struck_body.is_some() {
            body_ui(ui, "Struck body", &mut numbers.struck_body, struck);
        }
    });
    if edited != collision {
        edited.put_into(&mut project.predict_force);
    }
    if let Some(answer) = force.forecast.ok() {
        let report = &answer.report;
        let open = [
            (report.is_contact_open, "the contact point"),
            (report.is_body_open, "the striking vehicle's body"),
            (report.is_struck_body_open, "the struck vehicle's body"),
        ];
        let open: Vec<&str> =
            open.into_iter().filter_map(|(is_open, what)| is_open.then_some(what)).collect();
        if !open.is_empty() {
            ui.weak(format!("Averaged over what is unknown: {}.", open.join(", ")));
        }
    }
}

/// Draws the buttons that take the collision from the selected case or from the scenario, and tells
/// whether the model was trained on the recorded case.
fn start_ui(
    ui: &mut Ui,
    collision: Option<&NamedCollision>,
    view: &mut View,
    force: &ForceSession,
    commands: &mut Vec<Command>,
) {
    ui.horizontal_wrapped(|ui| {
        let case = force.recorded.as_ref();
        let label = case.map_or("From the case".to_owned(), |case| format!("From {}", case.case));
        let button = ui.add_enabled(case.is_some(), egui::Button::new(label));
        let hint = "Take the selected case of a force data set";
        if button.on_hover_text(hint).on_disabled_hover_text(hint).clicked() {
            commands.push(Command::PredictCase);
        }
        let hint = "Take the two vehicles of the Scenario pane";
        if ui.button("From the scenario").on_hover_text(hint).clicked() {
            commands.push(Command::PredictScenario);
        }
        ui.checkbox(&mut view.force.follow_case, "Follow")
            .on_hover_text("Predict every case of a force data set that is selected");
    });
    let Some(NamedCollision { name, numbers }) = collision else { return };
    let recorded = force.recorded.as_ref().filter(|recorded| recorded.scenario == *numbers);
    let model = force.model.current.as_ref();
    ui.weak(match recorded.zip(model) {
        None => format!("{name}, edited or without a recording"),
        Some((recorded, current)) if current.model.is_trained_on(&recorded.canonical) => {
            format!("{name}, as recorded; the model has learned from it")
        }
        Some(_) => format!("{name}, as recorded; the model has not seen it"),
    });
}

/// Draws the masses, the velocities along and across the heading of the struck vehicle, the heading of
/// the striking vehicle relative to it, and how both turn.
fn motion_ui(ui: &mut Ui, scenario: &mut ForceScenario, units: UnitSystem) {
    for (vehicle, label, hint) in [
        (0, "Struck mass m_t", "Mass of the struck vehicle"),
        (1, "Striking mass m_b", "Mass of the striking vehicle"),
    ] {
        let range = SliderRange { label, hint, usual: 500.0..=5000.0, possible: BODY_MASS };
        if let Some(mass_kg) = quantity_slider(ui, &range, scenario.mass_kg[vehicle], units) {
            set_mass(scenario, vehicle, mass_kg);
        }
    }
    let [v_tx, v_ty] = &mut scenario.struck_velocity_m_s;
    let [v_bx, v_by] = &mut scenario.striking_velocity_m_s;
    for (value, label, hint, most) in [
        (v_tx, "Struck v_tx", "Speed of the struck vehicle along its heading", 50.0),
        (v_ty, "Struck v_ty", "Speed of the struck vehicle to its left", 10.0),
        (v_bx, "Striking v_bx", "Speed of the striking along the struck vehicle's heading", 50.0),
        (v_by, "Striking v_by", "Speed of the striking to the struck vehicle's left", 10.0),
    ] {
        let usual = if most > 20.0 { 0.0..=most } else { -most..=most };
        let range = SliderRange { label, hint, usual, possible: SPEED };
        if let Some(speed_m_s) = quantity_slider(ui, &range, *value, units) {
            *value = speed_m_s;
        }
    }
    let range = SliderRange {
        label: "Striking heading θ_b",
        hint: "Heading of the striking against the struck vehicle's, to the left positive",
        usual: -FRAC_PI_2..=FRAC_PI_2,
        possible: HEADING,
    };
    if let Some(theta_b_rad) = quantity_slider(ui, &range, scenario.theta_b_rad, units) {
        set_striking_heading(scenario, theta_b_rad);
    }
    let [struck, striking] = &mut scenario.yaw_rate_rad_s;
    for (value, label, hint) in [
        (
            struck,
            "Struck yaw rate",
            "How fast the struck vehicle turns before the impact, to the left positive",
        ),
        (
            striking,
            "Striking yaw rate",
            "How fast the striking vehicle turns before the impact, to the left positive",
        ),
    ] {
        let range = SliderRange { label, hint, usual: -1.0..=1.0, possible: YAW_RATE };
        if let Some(yaw_rate_rad_s) = quantity_slider(ui, &range, *value, units) {
            *value = yaw_rate_rad_s;
        }
    }
}

/// Draws the choice of the struck side. A change of the side mirrors the whole scenario.
fn side_ui(ui: &mut Ui, scenario: &mut ForceScenario) {
    let hint = "The side on which the vehicle is struck; the other side is the mirror image";
    let name = ui.label("Struck side").on_hover_text(hint);
    ui.horizontal(|ui| {
        let mut side = scenario.side;
        for (value, label) in [(StruckSide::Left, "left"), (StruckSide::Right, "right")] {
            let radio = ui.radio_value(&mut side, value, label).labelled_by(name.id);
            radio.on_hover_text(hint);
        }
        set_side(scenario, side);
    });
    ui.end_row();
}

/// Draws the longitudinal position of the first contact, or the checkbox that leaves it open.
fn contact_ui(ui: &mut Ui, scenario: &mut ForceScenario, units: UnitSystem) {
    if let Some([x_m, _]) = scenario.contact_m {
        let range = SliderRange {
            label: "First contact x",
            hint: "Where they first touch, along the struck vehicle from its CG; rear negative",
            usual: -3.0..=1.0,
            possible: CONTACT_X,
        };
        if let Some(x_m) = quantity_slider(ui, &range, x_m, units) {
            set_contact_x(scenario, x_m);
        }
    }
    ui.label(if scenario.contact_m.is_some() { "" } else { "First contact x" });
    let mut is_unknown = scenario.contact_m.is_none();
    let hint = "Average over the contact points of the cases that the model was trained on";
    if ui.checkbox(&mut is_unknown, "contact unknown").on_hover_text(hint).changed() {
        if is_unknown {
            forget_contact(scenario);
        } else {
            know_contact(scenario);
        }
    }
    ui.end_row();
}

/// Draws the choice of the body of a vehicle among those that the model was trained on, or unknown.
fn body_ui(ui: &mut Ui, title: &str, body: &mut Option<String>, bodies: &[String]) {
    let hint = "Kind of the vehicle's body, as the data set calls it";
    let name = ui.label(title).on_hover_text(hint);
    let label = |body: &Option<String>| body.clone().unwrap_or_else(|| "unknown".to_owned());
    let known = bodies.iter().filter(|body| !body.is_empty());
    ComboBox::from_id_salt(title)
        .selected_text(label(body))
        .show_ui(ui, |ui| {
            for option in std::iter::once(None).chain(known.map(|body| Some(body.clone()))) {
                let text = label(&option);
                ui.selectable_value(body, option, text);
            }
        })
        .response
        .labelled_by(name.id)
        .on_hover_text(hint);
    ui.end_row();
}
