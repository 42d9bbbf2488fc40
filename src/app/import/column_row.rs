//! A row of the import dialog: a column with its channel and its unit.

use egui::{ComboBox, RichText, Ui};

use crate::app::import::choices::{ColumnChoice, Held};
use crate::app::widgets::severity_color;
use impactlab_core::data::{Channel, FormulaPart, Severity};
use impactlab_core::units::Quantity;

/// What can be assigned to a column, in the order of the dialog's lists, with what it is.
const CHOICES: [(Held, &str); 24] = [
    (Held::Channel(Channel::Time), "Time"),
    (Held::Channel(Channel::Fx), "F_x, force along the road"),
    (Held::Channel(Channel::Fy), "F_y, force to the left of the road"),
    (Held::Channel(Channel::FxBody), "F_x body, force along the heading"),
    (Held::Channel(Channel::FyBody), "F_y body, force to the left of the heading"),
    (Held::Channel(Channel::Mz), "M_z, yaw moment of the force"),
    (Held::Channel(Channel::X), "X, position along the road"),
    (Held::Channel(Channel::Y), "Y, position to the left of the road"),
    (Held::Channel(Channel::Yaw), "Yaw ψ, heading"),
    (Held::Channel(Channel::Vx), "v_x, velocity"),
    (Held::Channel(Channel::Vy), "v_y, velocity"),
    (Held::Channel(Channel::Speed), "Speed along the path"),
    (Held::Channel(Channel::YawRate), "Yaw rate r"),
    (Held::Channel(Channel::Roll), "Roll φ"),
    (Held::Channel(Channel::RollRate), "Roll rate"),
    (Held::Channel(Channel::Steer), "Steer δ, angle of the road wheels"),
    (Held::Channel(Channel::SteeringWheel), "Steering wheel, its angle"),
    (Held::Part(FormulaPart::Latitude), "Latitude, degrees to the north"),
    (Held::Part(FormulaPart::Longitude), "Longitude, degrees to the east"),
    (Held::Part(FormulaPart::QuaternionW), "Quaternion w, real part"),
    (Held::Part(FormulaPart::QuaternionX), "Quaternion x"),
    (Held::Part(FormulaPart::QuaternionY), "Quaternion y"),
    (Held::Part(FormulaPart::QuaternionZ), "Quaternion z"),
    (Held::Part(FormulaPart::Course), "Course, degrees clockwise from north"),
];

/// Text of a unit that nobody has said.
const NO_UNIT: &str = "not stated: choose";

/// Number of characters of a header and of a value that a row shows.
const SHOWN_NAME: usize = 24;
const SHOWN_VALUE: usize = 7;

/// Draws the row of one column.
pub(super) fn column_ui(ui: &mut Ui, column: &mut ColumnChoice) {
    let number = column.proposal.number;
    let shown: String = column.proposal.name.chars().take(SHOWN_NAME).collect();
    let name = ui.label(format!("{number}: {shown}")).on_hover_text(&column.proposal.name);
    let samples = column.proposal.samples.iter().take(3);
    let samples: Vec<String> =
        samples.map(|sample| sample.chars().take(SHOWN_VALUE).collect()).collect();
    ui.weak(samples.join("  ")).on_hover_text(column.proposal.samples.join("\n"));
    let text = |choice: Option<Held>| choice.map_or("not used", described);
    let combo = ComboBox::from_id_salt(("channel", number)).width(170.0);
    let selected = column.held.map_or("not used", label);
    let shown = combo.selected_text(selected).height(400.0).show_ui(ui, |ui| {
        let all = CHOICES.iter().map(|(held, _)| Some(*held));
        for option in std::iter::once(None).chain(all) {
            if ui.selectable_label(column.held == option, text(option)).clicked() {
                column.choose(option);
            }
        }
    });
    shown.response.labelled_by(name.id);
    let Some(channel) = column.channel() else { return };
    // A column of a force may hold its impulse up to each instant.
    let impulses = match channel.quantity() {
        Quantity::Force => Quantity::Impulse.units(),
        _ => &[],
    };
    let units = channel.quantity().units().iter().chain(impulses);
    ui.horizontal(|ui| {
        let warning = severity_color(ui, Severity::Warning);
        let selected = match column.unit {
            Some(unit) => RichText::new(unit.symbol),
            None => RichText::new(NO_UNIT).color(warning),
        };
        let combo = ComboBox::from_id_salt(("unit", number)).selected_text(selected).width(64.0);
        let shown = combo.show_ui(ui, |ui| {
            for unit in units {
                ui.selectable_value(&mut column.unit, Some(*unit), unit.symbol);
            }
        });
        shown.response.labelled_by(name.id);
        if channel != Channel::Time {
            let hint = match channel.quantity() {
                Quantity::Force | Quantity::Moment => {
                    "Change the sign: the file has the force on the other vehicle"
                }
                _ => "Change the sign: the axis of the file points the other way",
            };
            ui.checkbox(&mut column.is_negated, "−").on_hover_text(hint);
        }
    });
}

fn described(held: Held) -> &'static str {
    let known = CHOICES.iter().find(|(of, _)| *of == held);
    known.map_or(label(held), |(_, text)| text)
}

fn label(held: Held) -> &'static str {
    match held {
        Held::Channel(channel) => channel.label(),
        Held::Part(FormulaPart::Latitude) => "Latitude",
        Held::Part(FormulaPart::Longitude) => "Longitude",
        Held::Part(FormulaPart::QuaternionW) => "Quaternion w",
        Held::Part(FormulaPart::QuaternionX) => "Quaternion x",
        Held::Part(FormulaPart::QuaternionY) => "Quaternion y",
        Held::Part(FormulaPart::QuaternionZ) => "Quaternion z",
        Held::Part(FormulaPart::Course) => "Course",
    }
}
