//! The badges of an answer as coloured chips.

use egui::{Frame, Label, RichText, Sense, Ui};

use crate::data::Severity;
use crate::render::theme;
use crate::uncertainty::Badge;
use crate::units::significant;

/// Opacity of the fill of a chip, 0 to 1.
const FILL: f32 = 0.16;

/// Draws each badge as a chip; hovering over it shows what it says in full. Badges that stand for
/// assumptions are left to [`assumptions_ui`](crate::app::widgets::assumptions_ui), beside which
/// the chips are drawn. An empty list draws nothing.
pub fn badges_ui<'a>(ui: &mut Ui, badges: impl IntoIterator<Item = &'a Badge>) {
    let shown: Vec<&Badge> =
        badges.into_iter().filter(|badge| !badge.kind.is_assumption()).collect();
    if shown.is_empty() {
        return;
    }
    ui.horizontal_wrapped(|ui| {
        for badge in shown {
            chip_ui(ui, badge);
        }
    });
}

fn chip_ui(ui: &mut Ui, badge: &Badge) {
    let severity = if badge.kind.is_warning() { Severity::Warning } else { Severity::Info };
    let color = theme::severity_color(severity, ui.visuals().dark_mode);
    let frame = Frame::new()
        .fill(color.gamma_multiply(FILL))
        .stroke((1.0, color))
        .corner_radius(8.0)
        .inner_margin(egui::Margin::symmetric(7, 2));
    let chip = frame.show(ui, |ui| {
        // Not selectable, so that the pointer over the text is over the chip.
        ui.add(Label::new(RichText::new(chip_text(badge)).color(color)).selectable(false))
    });
    chip.response.interact(Sense::hover()).on_hover_text(&badge.text);
}

/// What a chip says: kind, quantity and value.
fn chip_text(badge: &Badge) -> String {
    let label = badge.kind.label();
    match (&badge.quantity, badge.value) {
        (Some(quantity), Some(value)) => format!("{label}: {quantity} {}", significant(value)),
        _ => label.to_owned(),
    }
}
