//! A row of the import dialog: a column with its channel and its unit.

use egui::{ComboBox, RichText, Ui};

use crate::app::import::choices::ColumnChoice;
use impactlab_core::data::{Channel, Severity};
use impactlab_core::units::Quantity;
use impactlab_draw::theme;

/// The channels that can be assigned to a column, in the order of the dialog's lists, with what they
/// are.
const CHOICES: [(Channel, &str); 16] = [
    (Channel::Time, "Time"),
    (Channel::Fx, "F_x, force along the road"),
    (Channel::Fy, "F_y, force to the left of the road"),
    (Channel::FxBody, "F_x body, force along the heading"),
    (Channel::FyBody, "F_y body, force to the left of the heading"),
    (Channel::Mz, "M_z, yaw moment of the force"),
    (Channel::X, "X, position along the road"),
    (Channel::Y, "Y, position to the left of the road"),
    (Channel::Yaw, "Yaw ψ, heading"),
    (Channel::Vx, "v_x, velocity"),
    (Channel::Vy, "v_y, velocity"),
    (Channel::YawRate, "Yaw rate r"),
    (Channel::Roll, "Roll φ"),
    (Channel::RollRate, "Roll rate"),
    (Channel::Steer, "Steer δ, angle of the road wheels"),
    (Channel::SteeringWheel, "Steering wheel, its angle"),
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
    let text = |choice: Option<Channel>| choice.map_or("not used", described);
    let combo = ComboBox::from_id_salt(("channel", number)).width(170.0);
    let selected = column.channel.map_or("not used", Channel::label);
    let shown = combo.selected_text(selected).height(400.0).show_ui(ui, |ui| {
        let all = CHOICES.iter().map(|(channel, _)| Some(*channel));
        for option in std::iter::once(None).chain(all) {
            if ui.selectable_label(column.channel == option, text(option)).clicked() {
                column.choose(option);
            }
        }
    });
    shown.response.labelled_by(name.id);
    let Some(channel) = column.channel else { return };
    // A column of a force may hold its impulse up to each instant.
    let impulses = match channel.quantity() {
        Quantity::Force => Quantity::Impulse.units(),
        _ => &[],
    };
    let units = channel.quantity().units().iter().chain(impulses);
    ui.horizontal(|ui| {
        let warning = theme::severity_color(Severity::Warning, ui.visuals().dark_mode);
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
        if matches!(channel.quantity(), Quantity::Force | Quantity::Moment) {
            let hint = "Change the sign: the file has the force on the other vehicle";
            ui.checkbox(&mut column.is_negated, "−").on_hover_text(hint);
        }
    });
}

fn described(channel: Channel) -> &'static str {
    let known = CHOICES.iter().find(|(of, _)| *of == channel);
    known.map_or(channel.label(), |(_, text)| text)
}
