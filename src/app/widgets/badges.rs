//! The badges of an answer as coloured chips.

use egui::{Color32, Frame, Label, Margin, RichText, Sense, TextStyle, Ui};

use crate::app::looks::{self, Icon};
use impactlab_core::data::Severity;
use impactlab_core::uncertainty::Badge;
use impactlab_core::units::significant;
use impactlab_draw::theme;

/// Opacity of the fill of a chip, 0 to 1.
const FILL: f32 = 0.16;
/// Room between the text of a chip and its frame, points.
const MARGIN: Margin = Margin::symmetric(8, 2);

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
        for (i, badge) in shown.into_iter().enumerate() {
            // A chip that does not fit beside the others begins a row, instead of breaking its words.
            if i > 0 && chip_width(ui, badge) > ui.available_size_before_wrap().x {
                ui.end_row();
            }
            chip_ui(ui, badge);
        }
    });
}

/// Width of a chip on a row of its own, points.
fn chip_width(ui: &Ui, badge: &Badge) -> f32 {
    let font = TextStyle::Body.resolve(ui.style());
    let text = ui.painter().layout_no_wrap(chip_text(badge), font, Color32::PLACEHOLDER);
    let icon = looks::icon_size(ui) + looks::GRID;
    icon + text.size().x + 2.0 * f32::from(MARGIN.left) + 2.0
}

fn chip_ui(ui: &mut Ui, badge: &Badge) {
    let (severity, icon) = match badge.kind.is_warning() {
        true => (Severity::Warning, Icon::TriangleAlert),
        false => (Severity::Info, Icon::Info),
    };
    let color = theme::severity_color(severity, ui.visuals().dark_mode);
    let frame = Frame::new()
        .fill(color.gamma_multiply(FILL))
        .stroke((1.0, color))
        .corner_radius(8.0)
        .inner_margin(MARGIN);
    let chip = frame.show(ui, |ui| {
        ui.spacing_mut().item_spacing.x = looks::GRID;
        ui.horizontal(|ui| {
            looks::icon_ui(ui, icon, color);
            // Not selectable, so that the pointer over the text is over the chip.
            ui.add(Label::new(RichText::new(chip_text(badge)).color(color)).selectable(false));
        });
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

#[cfg(test)]
mod tests {
    use egui::{Context, RawInput};

    use super::*;
    use impactlab_core::uncertainty::BadgeKind;

    #[test]
    fn a_chip_that_does_not_fit_begins_a_row() {
        let badges = [
            (BadgeKind::OutsideDomain, "duration of the motion [s]"),
            (BadgeKind::NotAtRest, "share of the draws at rest"),
        ];
        let badges = badges.map(|(kind, quantity)| Badge {
            kind,
            text: String::new(),
            quantity: Some(quantity.to_owned()),
            value: Some(120.0),
            range: None,
        });
        let mut height = 0.0;
        let _ = Context::default().run_ui(RawInput::default(), |ui| {
            ui.set_max_width(340.0);
            height = ui.scope(|ui| badges_ui(ui, &badges)).response.rect.height();
        });
        // Two rows, and not one letter of the second chip in each.
        assert!((30.0..80.0).contains(&height), "{height}");
    }
}
