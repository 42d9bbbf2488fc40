//! The cards of the evidence: one for each item, with its numbers and their standard deviations.

use egui::{CollapsingHeader, ComboBox, Grid, Ui};

use crate::app::looks::{self, Icon, icon_button};
use crate::app::panels::reconstruction::fields::{
    N_COLUMNS, interval_row, measured_row, optional_measured_row, optional_row, value_row,
};
use crate::app::panels::vehicle::{chosen_label, evidence_vehicle_ui};
use crate::app::reconstruction::{ReconstructionCommand, stand_ins};
use impactlab_core::collision::Side;
use impactlab_core::ranges::{
    ANGLE_SIGMA, CG_HEIGHT, CG_TO_AXLE, CONTACT_X, CONTACT_Y, EVIDENCE_HEADING, EVIDENCE_POSITION,
    EVIDENCE_SPEED, EVIDENCE_TIME, FRICTION_SIGMA, MASS_SIGMA, OUTER_LENGTH, OUTER_WIDTH,
    POSITION_SIGMA, PULSE_END, ROAD_FRICTION, SPEED, SPEED_SIGMA, TRACK_WIDTH, VEHICLE_MASS,
    VEHICLE_YAW_INERTIA,
};
use impactlab_core::units::UnitSystem;
use impactlab_core::vehicle::Wheel;
use impactlab_reconstruct::evidence::{
    After, CarEvidence, DEFAULT_DAMAGE_SIGMA_M, DEFAULT_FRICTION, DEFAULT_FRICTION_SIGMA,
    DEFAULT_HEADING_SIGMA_RAD, Damage, DriverBraked, Edr, Evidence, Mark, MarkKind, Measured,
    RestPose, VideoPosition,
};
use impactlab_study::VehicleChoice;

/// Standard deviation of an angle that is read off the damage, rad.
const USUAL_ANGLE_SIGMA_RAD: f64 = 0.17;
/// Mass that stands in a field until it is typed, kg, with a standard deviation that covers most cars.
const USUAL_MASS: Measured = Measured { value: 1500.0, sigma: 300.0 };

/// The data sheets of the cars that the user can choose.
pub struct SheetChoices<'a> {
    /// The choice for the struck and for the striking car.
    pub chosen: [&'a mut VehicleChoice; 2],
    /// Vehicles of the user.
    pub own: &'a [VehicleChoice],
}

/// Draws the cards of all items, and the menu that adds another.
///
/// - `adds_to`: the mark to which clicks in the scene add points;
/// - returns what the user asks for beside the edits.
pub fn cards_ui(
    ui: &mut Ui,
    (evidence, sheets): (&mut Evidence, SheetChoices<'_>),
    (adds_to, units): (Option<usize>, UnitSystem),
) -> Option<ReconstructionCommand> {
    add_ui(ui, evidence);
    let mut action = None;
    removable(ui, (Icon::Flag, "Struck car at rest"), &mut evidence.rest, |ui, rest| {
        rest_fields(ui, rest, units);
    });
    removable(ui, (Icon::Flag, "Striking car at rest"), &mut evidence.striking_rest, |ui, rest| {
        rest_fields(ui, rest, units);
    });
    let mut removed = None;
    for (idx, mark) in evidence.marks.iter_mut().enumerate() {
        let title = format!("Tire mark {}", idx + 1);
        let is_removed = card(ui, (Icon::Route, &title), true, |ui| {
            action = mark_fields(ui, (idx, mark), (adds_to, units)).or(action.take());
        });
        removed = is_removed.then_some(idx).or(removed);
    }
    if let Some(idx) = removed {
        evidence.marks.remove(idx);
        action = Some(ReconstructionCommand::AddPoints(None));
    }
    card(ui, (Icon::Hammer, "Damage of the struck car"), false, |ui| {
        damage_fields(ui, &mut evidence.damage, units);
    });
    let has_edr = evidence.edr != Edr::default();
    if has_edr
        && card(ui, (Icon::Cpu, "Event data recorder"), true, |ui| {
            edr_fields(ui, &mut evidence.edr, units);
        })
    {
        evidence.edr = Edr::default();
    }
    positions_card(ui, &mut evidence.positions, units);
    removable(ui, (Icon::Ruler, "Friction of the road"), &mut evidence.friction, |ui, friction| {
        measured_row(ui, "Peak", friction, ([&ROAD_FRICTION, &FRICTION_SIGMA], units));
    });
    let [struck, striking] = sheets.chosen;
    for (title, car, sheet) in [
        ("Struck car", &mut evidence.struck_car, struck),
        ("Striking car", &mut evidence.striking_car, striking),
    ] {
        card(ui, (Icon::Car, title), false, |ui| {
            car_fields(ui, (title, car), (sheet, sheets.own), units);
        });
    }
    card(ui, (Icon::CarFront, "After the impact"), false, |ui| {
        after_fields(ui, &mut evidence.after)
    });
    action
}

/// Draws a card with a grid of its numbers.
///
/// - returns whether the user removes it.
fn card(
    ui: &mut Ui,
    (of, title): (Icon, &str),
    is_removable: bool,
    draw: impl FnOnce(&mut Ui),
) -> bool {
    let mut is_removed = false;
    egui::Frame::group(ui.style()).show(ui, |ui| {
        ui.set_width(ui.available_width());
        ui.horizontal(|ui| {
            looks::icon_ui(ui, of, ui.visuals().hyperlink_color);
            ui.strong(title);
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                let hint = format!("Remove: {title}");
                let button = is_removable.then(|| ui.small_button("Remove").on_hover_text(hint));
                is_removed = button.is_some_and(|button| button.clicked());
            });
        });
        Grid::new(title).num_columns(N_COLUMNS).min_col_width(10.0).show(ui, draw);
    });
    is_removed
}

/// Draws the card of an item that may not be there.
fn removable<T>(
    ui: &mut Ui,
    heading: (Icon, &str),
    item: &mut Option<T>,
    draw: impl FnOnce(&mut Ui, &mut T),
) {
    let Some(of) = item else { return };
    if card(ui, heading, true, |ui| draw(ui, of)) {
        *item = None;
    }
}

/// Draws the menu of what can be added.
fn add_ui(ui: &mut Ui, evidence: &mut Evidence) {
    ui.menu_button((looks::icon(Icon::Plus), "Add evidence"), |ui| {
        let mut item = |is_there: bool, of: Icon, label: &str| {
            !is_there && ui.add(icon_button(of, label)).clicked()
        };
        if item(evidence.rest.is_some(), Icon::Flag, "Struck car at rest") {
            evidence.rest = Some(stand_ins::rest_pose());
        }
        if item(evidence.striking_rest.is_some(), Icon::Flag, "Striking car at rest") {
            evidence.striking_rest = Some(stand_ins::rest_pose());
        }
        if item(false, Icon::Route, "Tire mark") {
            evidence.marks.push(stand_ins::mark());
        }
        if item(evidence.edr != Edr::default(), Icon::Cpu, "Event data recorder") {
            evidence.edr.speed_before_m_s = Some(stand_ins::recorded_speed());
        }
        if item(false, Icon::Video, "Position in a video") {
            evidence.positions.push(stand_ins::video_position());
        }
        if item(evidence.friction.is_some(), Icon::Ruler, "Friction of the road") {
            let (value, sigma) = (DEFAULT_FRICTION, DEFAULT_FRICTION_SIGMA);
            evidence.friction = Some(Measured { value, sigma });
        }
    });
}

fn rest_fields(ui: &mut Ui, rest: &mut RestPose, units: UnitSystem) {
    value_row(ui, "X of the CG", &mut rest.x_m, (&EVIDENCE_POSITION, units));
    value_row(ui, "Y of the CG", &mut rest.y_m, (&EVIDENCE_POSITION, units));
    value_row(ui, "± along each axis", &mut rest.position_sigma_m, (&POSITION_SIGMA, units));
    let usual = Measured { value: 0.0, sigma: DEFAULT_HEADING_SIGMA_RAD };
    let ranges = ([&EVIDENCE_HEADING, &ANGLE_SIGMA], units);
    optional_measured_row(ui, "Heading", (&mut rest.heading_rad, usual), ranges);
}

fn mark_fields(
    ui: &mut Ui,
    (idx, mark): (usize, &mut Mark),
    (adds_to, units): (Option<usize>, UnitSystem),
) -> Option<ReconstructionCommand> {
    let name = ui.label("Wheel");
    ComboBox::from_id_salt(("wheel of mark", idx))
        .selected_text(mark.wheel.label())
        .width(84.0)
        .show_ui(ui, |ui| {
            for wheel in Wheel::ALL {
                ui.selectable_value(&mut mark.wheel, wheel, wheel.label());
            }
        })
        .response
        .labelled_by(name.id);
    ui.end_row();
    let name = ui.label("Left by");
    let kinds = [
        (None, "cannot be told"),
        (Some(MarkKind::SideSlip), "sliding sideways"),
        (Some(MarkKind::Locked), "a locked wheel"),
    ];
    let shown = kinds.iter().find(|(kind, _)| *kind == mark.kind).map_or("", |(_, label)| label);
    ComboBox::from_id_salt(("kind of mark", idx))
        .selected_text(shown)
        .width(84.0)
        .show_ui(ui, |ui| {
            for (kind, label) in kinds {
                ui.selectable_value(&mut mark.kind, kind, label);
            }
        })
        .response
        .labelled_by(name.id);
    ui.end_row();
    value_row(ui, "± of a point", &mut mark.sigma_m, (&POSITION_SIGMA, units));
    ui.label(format!("{} points", mark.points_m.len()));
    let is_adding = adds_to == Some(idx);
    let hint = "Then click along the mark in the scene, from where it starts";
    let adds = ui.selectable_label(is_adding, "Add points").on_hover_text(hint);
    ui.label("");
    let last = egui::Button::new("Undo last").small();
    if ui.add_enabled(!mark.points_m.is_empty(), last).clicked() {
        mark.points_m.pop();
    }
    ui.end_row();
    adds.clicked().then(|| ReconstructionCommand::AddPoints((!is_adding).then_some(idx)))
}

fn damage_fields(ui: &mut Ui, damage: &mut Damage, units: UnitSystem) {
    let sides = [
        (Side::Left, "left"),
        (Side::Right, "right"),
        (Side::Front, "front"),
        (Side::Rear, "rear"),
    ];
    let name = ui.label("Side");
    let shown = sides.iter().find(|(side, _)| *side == damage.side).map_or("", |(_, label)| label);
    let before = damage.side;
    ComboBox::from_id_salt("struck side")
        .selected_text(shown)
        .width(84.0)
        .show_ui(ui, |ui| {
            for (side, label) in sides {
                ui.selectable_value(&mut damage.side, side, label);
            }
        })
        .response
        .labelled_by(name.id);
    ui.end_row();
    let is_flank = matches!(damage.side, Side::Left | Side::Right);
    if damage.side != before {
        // Its place is of that side.
        damage.depth_m = None;
        if is_flank != matches!(before, Side::Left | Side::Right) {
            damage.along_m = Measured { value: 0.0, sigma: DEFAULT_DAMAGE_SIGMA_M };
        }
    }
    let (label, range) = match is_flank {
        true => ("Ahead of the CG", &CONTACT_X),
        false => ("Left of the CG", &CONTACT_Y),
    };
    measured_row(ui, label, &mut damage.along_m, ([range, &POSITION_SIGMA], units));
    let usual = Measured { value: 0.0, sigma: USUAL_ANGLE_SIGMA_RAD };
    let ranges = ([&EVIDENCE_HEADING, &ANGLE_SIGMA], units);
    optional_measured_row(ui, "Angle of the cars", (&mut damage.angle_rad, usual), ranges);
    let range = match damage.side {
        Side::Left => CONTACT_Y.within([0.0, f64::INFINITY]),
        Side::Right => CONTACT_Y.within([f64::NEG_INFINITY, 0.0]),
        Side::Front => CONTACT_X.within([0.0, f64::INFINITY]),
        Side::Rear => CONTACT_X.within([f64::NEG_INFINITY, 0.0]),
    };
    let usual = if range.low < 0.0 { -0.9 } else { 0.9 };
    let label = if is_flank { "Left of the CG" } else { "Ahead of the CG" };
    optional_row(ui, label, (&mut damage.depth_m, usual), (&range, units));
}

fn edr_fields(ui: &mut Ui, edr: &mut Edr, units: UnitSystem) {
    let ranges = ([&EVIDENCE_SPEED, &SPEED_SIGMA], units);
    let speed = (&mut edr.speed_before_m_s, stand_ins::recorded_speed());
    optional_measured_row(ui, "Speed before", speed, ranges);
    let usual = stand_ins::RECORDED_DELTA_V_M_S;
    interval_row(ui, "Δv ahead", (&mut edr.delta_v_x_m_s, usual), (&SPEED, units));
    interval_row(ui, "Δv to the left", (&mut edr.delta_v_y_m_s, usual), (&SPEED, units));
    let [x_m, y_m] = &mut edr.sensor_m;
    value_row(ui, "Sensor ahead of CG", x_m, (&CONTACT_X, units));
    value_row(ui, "Sensor left of CG", y_m, (&CONTACT_Y, units));
    optional_row(ui, "Record ends", (&mut edr.ends_s, 0.25), (&PULSE_END, units));
}

fn positions_card(ui: &mut Ui, positions: &mut Vec<VideoPosition>, units: UnitSystem) {
    let mut removed = None;
    for (idx, at) in positions.iter_mut().enumerate() {
        let title = format!("Position {} in a video", idx + 1);
        let is_removed = card(ui, (Icon::Video, &title), true, |ui| {
            value_row(ui, "Time", &mut at.time_s, (&EVIDENCE_TIME, units));
            value_row(ui, "X of the CG", &mut at.x_m, (&EVIDENCE_POSITION, units));
            value_row(ui, "Y of the CG", &mut at.y_m, (&EVIDENCE_POSITION, units));
            value_row(ui, "± along each axis", &mut at.sigma_m, (&POSITION_SIGMA, units));
        });
        removed = is_removed.then_some(idx).or(removed);
    }
    if let Some(idx) = removed {
        positions.remove(idx);
    }
}

fn car_fields(
    ui: &mut Ui,
    (title, car): (&str, &mut CarEvidence),
    (sheet, own): (&mut VehicleChoice, &[VehicleChoice]),
    units: UnitSystem,
) {
    let ranges = ([&VEHICLE_MASS, &MASS_SIGMA], units);
    optional_measured_row(ui, "Mass", (&mut car.mass_kg, USUAL_MASS), ranges);
    let header = match &*sheet {
        VehicleChoice::Automatic => "Data sheet, dimensions".to_owned(),
        chosen => format!("Else as {}", chosen_label(chosen, "")),
    };
    CollapsingHeader::new(header).id_salt(("dimensions", title)).show(ui, |ui| {
        Grid::new(("dimensions of", title)).num_columns(2).show(ui, |ui| {
            evidence_vehicle_ui(ui, title, (sheet, own));
            dimension_fields(ui, car, units);
        });
    });
    ui.end_row();
}

fn dimension_fields(ui: &mut Ui, car: &mut CarEvidence, units: UnitSystem) {
    let before = [car.cg_to_front_axle_m, car.cg_to_rear_axle_m];
    for (label, value, usual, range) in [
        ("CG to front axle", &mut car.cg_to_front_axle_m, 1.2, CG_TO_AXLE),
        ("CG to rear axle", &mut car.cg_to_rear_axle_m, 1.5, CG_TO_AXLE),
        ("Track width", &mut car.track_m, 1.5, TRACK_WIDTH),
        ("CG height", &mut car.cg_height_m, 0.55, CG_HEIGHT),
        ("Length", &mut car.length_m, 4.5, OUTER_LENGTH),
        ("Width", &mut car.width_m, 1.8, OUTER_WIDTH),
        ("Yaw inertia", &mut car.yaw_inertia_kg_m2, 2500.0, VEHICLE_YAW_INERTIA),
    ] {
        optional_row(ui, label, (value, usual), (&range, units));
    }
    // The places of the axles are known together.
    match (before, [car.cg_to_front_axle_m, car.cg_to_rear_axle_m]) {
        ([None, None], [Some(_), None]) => car.cg_to_rear_axle_m = Some(1.5),
        ([None, None], [None, Some(_)]) => car.cg_to_front_axle_m = Some(1.2),
        (_, [None, Some(_)] | [Some(_), None]) => {
            (car.cg_to_front_axle_m, car.cg_to_rear_axle_m) = (None, None);
        }
        _ => {}
    }
}

fn after_fields(ui: &mut Ui, after: &mut After) {
    ui.label("Driver braked");
    ui.horizontal(|ui| {
        for (braked, label) in [
            (DriverBraked::Yes, "yes"),
            (DriverBraked::No, "no"),
            (DriverBraked::Unknown, "not known"),
        ] {
            ui.radio_value(&mut after.driver_braked, braked, label);
        }
    });
    ui.end_row();
    let mut was_looked = after.blocked_wheels.is_some();
    let hint = "Whether the wheels were tried after the collision; otherwise each near the damage may be blocked";
    if ui.checkbox(&mut was_looked, "Wheels tried").on_hover_text(hint).changed() {
        after.blocked_wheels = was_looked.then(Vec::new);
    }
    if let Some(blocked) = &mut after.blocked_wheels {
        ui.vertical(|ui| {
            ui.weak("blocked:");
            for wheel in Wheel::ALL {
                let mut is_blocked = blocked.contains(&wheel);
                if ui.checkbox(&mut is_blocked, wheel.label()).changed() {
                    blocked.retain(|other| *other != wheel);
                    blocked.extend(is_blocked.then_some(wheel));
                }
            }
        });
    }
    ui.end_row();
}
