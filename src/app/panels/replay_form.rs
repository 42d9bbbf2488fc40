//! The settings of the replay of a recorder.

use egui::{ComboBox, Grid, Ui};

use crate::app::widgets::{
    EmptyField, VehiclePicker, count_field, optional_quantity, quantity_field, seed_field,
    vehicle_name,
};
use impactlab_core::ranges::{
    HEADING, POSITION, RECORDED_SPEED_SIGMA, REPLAY_DRAWS, REPLAY_START, ROAD_FRICTION,
    ROAD_FRICTION_SIGMA, Range, STEERING_RATIO, STEERING_RATIO_SIGMA,
};
use impactlab_core::units::UnitSystem;
use impactlab_core::vehicle::{DrivenAxle, USUAL_STEERING_RATIO};
use impactlab_study::{DEFAULT_VEHICLE, ReplayRequest, VehicleChoice};

/// Draws everything that can be said of a replay but its file.
///
/// - `own`: vehicles of the user that can be chosen.
pub(super) fn settings_ui(
    ui: &mut Ui,
    request: &mut ReplayRequest,
    own: &[VehicleChoice],
    units: UnitSystem,
) {
    Grid::new("replay settings").num_columns(2).show(ui, |ui| {
        let name = ui.label("Vehicle");
        let open = format!("left open (else {})", vehicle_name(DEFAULT_VEHICLE.id()));
        let hint = "The car in which the recorder was";
        let picker = VehiclePicker {
            salt: "vehicle of a replay",
            name: &name,
            hint,
            open: &open,
            own,
            units,
        };
        picker.show(ui, &mut request.vehicle);
        ui.end_row();
        let axles = [DrivenAxle::Front, DrivenAxle::Rear, DrivenAxle::All];
        choice_ui(ui, "Driven axle", &mut request.driven_axle, &axles, |axle| match axle {
            DrivenAxle::Front => "front",
            DrivenAxle::Rear => "rear",
            DrivenAxle::All => "all",
        });
        numbers_ui(ui, request, units);
        let side = |is_left: bool| if is_left { "left" } else { "right" };
        let right = &mut request.steering_right;
        choice_ui(ui, "Steering wheel is positive to the", right, &[false, true], |is_right| {
            side(!is_right)
        });
        let left = &mut request.yaw_rate_left;
        choice_ui(ui, "Yaw rate is positive to the", left, &[false, true], side);
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

/// Draws the numbers that may be left open.
fn numbers_ui(ui: &mut Ui, request: &mut ReplayRequest, units: UnitSystem) {
    let usual_ratio = format!("{USUAL_STEERING_RATIO} is assumed");
    let (usual_sigma, start_sigma) = match request.steering_ratio {
        Some(ratio) => ("3 % of it", 0.03 * ratio),
        None => ("2", 2.0),
    };
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
            usual_sigma,
            start_sigma,
            &STEERING_RATIO_SIGMA,
        ),
        (
            "± speed, as a share of it",
            &mut request.speed_sigma,
            "0.04",
            0.04,
            &RECORDED_SPEED_SIGMA,
        ),
        (
            "Peak friction of the road",
            &mut request.friction,
            "that of the vehicle",
            0.8,
            &ROAD_FRICTION,
        ),
        (
            "± friction",
            &mut request.friction_sigma,
            "by the data sheet, else 7.5 % of it",
            0.06,
            &ROAD_FRICTION_SIGMA,
        ),
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

/// Draws a row with the choice of one of several values.
fn choice_ui<T: Copy + PartialEq>(
    ui: &mut Ui,
    label: &str,
    chosen: &mut T,
    values: &[T],
    text: impl Fn(T) -> &'static str,
) {
    let name = ui.label(label);
    let list = ComboBox::from_id_salt(("replay", label)).selected_text(text(*chosen));
    let list = list.show_ui(ui, |ui| {
        for value in values {
            ui.selectable_value(chosen, *value, text(*value));
        }
    });
    list.response.labelled_by(name.id);
    ui.end_row();
}
