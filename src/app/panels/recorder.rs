//! The form that asks what of an event data recorder becomes evidence.

use egui::{Button, ComboBox, Grid, Ui};

use crate::app::command::Command;
use crate::app::panels::replay::REPLAY;
use crate::app::recorder::{RecorderCommand, RecorderForm, title};
use crate::app::widgets::{choice_row, notice_ui, value_row};
use impactlab_core::collision::Role;
use impactlab_core::data::{RecordedDeltaV, RecordedSpeed, RecorderRecord, Severity};
use impactlab_core::units::{NumberFormat, Quantity, UnitSystem};

/// Width of the form, points.
const WIDTH: f32 = 640.0;

/// Draws the form and adds a command when the user has answered.
pub fn recorder_ui(
    ui: &mut Ui,
    form: &mut RecorderForm,
    units: UnitSystem,
    commands: &mut Vec<Command>,
) {
    ui.set_width(WIDTH);
    ui.heading(title(form));
    let Some(record) = form.record() else { return };
    ui.label(&record.description);
    Grid::new("recorder").num_columns(2).show(ui, |ui| {
        choices_ui(ui, form);
        for (name, value) in recorded(&record, units) {
            value_row(ui, name, &value);
        }
    });
    for doubt in &record.doubts {
        notice_ui(ui, Severity::Warning, doubt);
    }
    ui.separator();
    ui.horizontal_wrapped(|ui| {
        let hint = "Δv within 10 %, the last speed before within 4 %, as a new edit of the evidence. Undo takes \
                    it back";
        if ui.button("Make evidence of it").on_hover_text(hint).clicked() {
            let (record, car) = (Box::new(record.clone()), form.car);
            commands.push(Command::Recorder(RecorderCommand::MakeEvidence { record, car }));
        }
        let hint = "Follow speed and steering up to the first contact with the car that is chosen above";
        let can_replay = !record.before.steering_wheel_rad.is_empty();
        let replay = ui.add_enabled(can_replay, Button::new(REPLAY)).on_hover_text(hint);
        let lacks = "The angle of the steering wheel was not recorded at every sample";
        if replay.on_disabled_hover_text(lacks).clicked() {
            let (path, event, car) = (form.path.clone(), form.event_number(), form.car);
            commands.push(Command::Recorder(RecorderCommand::Replay { path, event, car }));
        }
        let controls = ui.button("Controls as a series");
        if controls.on_hover_text("Speed and steering before the crash, as a table").clicked() {
            let path = form.path.clone();
            commands.push(Command::Recorder(RecorderCommand::OpenControls(path)));
        }
        if ui.button("Cancel").clicked() {
            commands.push(Command::CloseDialog);
        }
    });
}

/// Draws the event, the car and the side of lateral values.
fn choices_ui(ui: &mut Ui, form: &mut RecorderForm) {
    let event = |record: &RecorderRecord| match record.event.as_str() {
        "" => "the only one".to_owned(),
        event => event.to_owned(),
    };
    let name = ui.label("Event");
    let shown = form.records.get(form.event).map(event).unwrap_or_default();
    let list = ComboBox::from_id_salt("event of a recorder").selected_text(shown);
    let list = list.show_ui(ui, |ui| {
        for (idx, record) in form.records.iter().enumerate() {
            ui.selectable_value(&mut form.event, idx, event(record));
        }
    });
    list.response.labelled_by(name.id);
    ui.end_row();
    choice_row(ui, "It was in the", &mut form.car, &Role::ALL, Role::label);
    let side = |is_left: bool| if is_left { "left" } else { "right (SAE J1698)" };
    let is_left = &mut form.is_lateral_to_left;
    choice_row(ui, "Lateral Δv is positive to the", is_left, &[false, true], side);
}

/// What was recorded, by its names.
fn recorded(record: &RecorderRecord, units: UnitSystem) -> Vec<(&'static str, String)> {
    let time = |time_s| NumberFormat::english(units).given(Quantity::Time, time_s);
    let delta_v = |delta_v: RecordedDeltaV| {
        let until =
            delta_v.ends_s.map_or_else(String::new, |ends_s| format!(" up to {}", time(ends_s)));
        let cut = if delta_v.is_cut { ", where the record is cut off" } else { "" };
        format!("{}{until}{cut}", Quantity::Speed.shown(delta_v.delta_v_m_s, units))
    };
    let speed = record.speed_before;
    let speed = speed.map(|RecordedSpeed { speed_m_s, at_s }| {
        let braked = match record.before.is_braked_at(at_s) {
            true => ", under the brake, which reads low by up to 18 %",
            false => "",
        };
        format!("{} at {}{braked}", Quantity::Speed.shown(speed_m_s, units), time(at_s))
    });
    let rows = [
        ("Δv ahead", record.delta_v_ahead.map(delta_v)),
        ("Δv to the right", record.delta_v_right.map(delta_v)),
        ("Speed before", speed),
    ];
    let missing = || "not recorded".to_owned();
    rows.into_iter().map(|(name, value)| (name, value.unwrap_or_else(missing))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 144 ms times 0.001 stood as “0.14400000000000002 s”, as the file counts in ms.
    #[test]
    fn times_of_a_record_have_the_digits_that_it_gives() {
        let ends_s = Some(144.0 * 0.001);
        let delta_v = RecordedDeltaV { delta_v_m_s: 5.0, ends_s, is_cut: false };
        let record = RecorderRecord { delta_v_ahead: Some(delta_v), ..RecorderRecord::default() };
        let [(_, ahead), ..] = &recorded(&record, UnitSystem::Si)[..] else { panic!("rows") };
        assert_eq!(ahead, "18.00 km/h up to 0.144 s");
    }
}
