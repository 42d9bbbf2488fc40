//! The settings of the replay of a recorder.

use egui::{Grid, Ui};

use crate::app::widgets::{
    EmptyField, VehiclePicker, choice_row, count_field, optional_count, optional_quantity,
    quantity_field, seed_field, vehicle_name,
};
use impactlab_core::collision::Role;
use impactlab_core::ranges::{
    HEADING, POSITION, RECORDED_SPEED_SIGMA, REPLAY_DRAWS, REPLAY_START, ROAD_FRICTION,
    ROAD_FRICTION_SIGMA, Range, STEERING_RATIO, STEERING_RATIO_SIGMA,
};
use impactlab_core::units::{NumberFormat, UnitSystem, percent};
use impactlab_core::vehicle::{
    DrivenAxle, LEAST_ROAD_FRICTION_SIGMA, ROAD_FRICTION_SPREAD, USUAL_STEERING_RATIO,
};
use impactlab_reconstruct::evidence::RECORDED_SPEED_SHARE;
use impactlab_study::{DEFAULT_VEHICLE, ReplayRequest, VehicleChoice};

/// Which event of a file is replayed.
const EVENT: Range =
    Range::whole("event", [1, 1000], "number of the event among those of the recorder's file");

/// Draws everything that can be said of a replay but its file.
///
/// - `of_pane`: the vehicles of the Vehicle pane.
pub(super) fn settings_ui(
    ui: &mut Ui,
    request: &mut ReplayRequest,
    of_pane: &[(Role, VehicleChoice)],
    units: UnitSystem,
) {
    let is_own =
        |of: &&VehicleChoice| matches!(of, VehicleChoice::File(_) | VehicleChoice::Sheet(_));
    let own: Vec<VehicleChoice> =
        of_pane.iter().map(|(_, choice)| choice).filter(is_own).cloned().collect();
    Grid::new("replay settings").num_columns(2).show(ui, |ui| {
        let name = ui.label("Event");
        optional_count(ui, &mut request.event, "the first", &EVENT).labelled_by(name.id);
        ui.end_row();
        let name = ui.label("Vehicle");
        let open = format!("left open (else {})", vehicle_name(DEFAULT_VEHICLE.id(), units));
        let hint = "The car in which the recorder was";
        let picker = VehiclePicker {
            salt: "vehicle of a replay",
            name: &name,
            hint,
            open: &open,
            own: &own,
            units,
        };
        picker.show(ui, &mut request.vehicle);
        ui.end_row();
        of_pane_ui(ui, &mut request.vehicle, of_pane);
        let axle = &mut request.driven_axle;
        choice_row(ui, "Driven axle", axle, DrivenAxle::ALL, DrivenAxle::word);
        numbers_ui(ui, request, units);
        let side = |is_left: bool| if is_left { "left" } else { "right" };
        let right = &mut request.steering_right;
        choice_row(ui, "Steering wheel is positive to the", right, &[false, true], |is_right| {
            side(!is_right)
        });
        let left = &mut request.yaw_rate_left;
        choice_row(ui, "Yaw rate is positive to the", left, &[false, true], side);
        let contact = &mut request.contact;
        quantity_field(ui, "X at the first contact", &mut contact.x_m, &POSITION, units);
        quantity_field(ui, "Y at the first contact", &mut contact.y_m, &POSITION, units);
        quantity_field(ui, "Heading at the first contact", &mut contact.yaw_rad, &HEADING, units);
        let name = ui.label("Draws");
        count_field(ui, &mut request.draws, &REPLAY_DRAWS, 10.0).labelled_by(name.id);
        ui.end_row();
        let name = ui.label("Seed");
        seed_field(ui, &mut request.seed).labelled_by(name.id);
        ui.end_row();
    });
}

/// Draws a row that says whether the vehicle is one of the Vehicle pane, and offers those that are chosen there.
fn of_pane_ui(ui: &mut Ui, vehicle: &mut VehicleChoice, of_pane: &[(Role, VehicleChoice)]) {
    ui.label("");
    ui.vertical(|ui| {
        match of_pane.iter().find(|(_, choice)| *choice == *vehicle) {
            Some((role, _)) => ui.weak(format!("As the {} of the Vehicle pane", role.label())),
            None => {
                ui.weak("Of the replay alone: what is changed in the Vehicle pane is not in it")
            }
        };
        for (role, choice) in of_pane {
            if *choice == VehicleChoice::Automatic || *choice == *vehicle {
                continue;
            }
            let take = ui.small_button(format!("Take the {}", role.label()));
            let hint = "As it is in the Vehicle pane now; what is changed there later is not taken";
            if take.on_hover_text(hint).clicked() {
                vehicle.clone_from(choice);
            }
        }
    });
    ui.end_row();
}

/// Draws the numbers that may be left open.
fn numbers_ui(ui: &mut Ui, request: &mut ReplayRequest, units: UnitSystem) {
    let format = NumberFormat::english(units);
    let usual_ratio = format!("{USUAL_STEERING_RATIO} is assumed");
    let ratio_sigma = request.usual_steering_ratio_sigma();
    let usual_sigma = format.rounded(STEERING_RATIO_SIGMA.quantity, ratio_sigma);
    let usual_share = format.rounded(RECORDED_SPEED_SIGMA.quantity, RECORDED_SPEED_SHARE);
    let usual_spread = format!(
        "by the data sheet, else {} of it, {LEAST_ROAD_FRICTION_SIGMA} at least",
        percent(ROAD_FRICTION_SPREAD)
    );
    let numbers: [(&str, &mut Option<f64>, &str, f64, &Range); 6] = [
        (
            "Steering ratio",
            &mut request.steering_ratio,
            &usual_ratio,
            USUAL_STEERING_RATIO,
            &STEERING_RATIO,
        ),
        (
            "± steering ratio",
            &mut request.steering_ratio_sigma,
            &usual_sigma,
            ratio_sigma,
            &STEERING_RATIO_SIGMA,
        ),
        (
            "± speed, as a share of it",
            &mut request.speed_sigma,
            &usual_share,
            RECORDED_SPEED_SHARE,
            &RECORDED_SPEED_SIGMA,
        ),
        (
            "Peak friction of the road",
            &mut request.friction,
            "that of the vehicle",
            0.8,
            &ROAD_FRICTION,
        ),
        ("± friction", &mut request.friction_sigma, &usual_spread, 0.06, &ROAD_FRICTION_SIGMA),
        (
            "From, on the clock of the recorder",
            &mut request.from_s,
            "all of the last 30 s",
            -5.0,
            &REPLAY_START,
        ),
    ];
    for (label, value, text, start_si, range) in numbers {
        let name = ui.label(label);
        let empty = EmptyField { text, start_si };
        optional_quantity(ui, value, empty, range, units).labelled_by(name.id);
        ui.end_row();
    }
}
