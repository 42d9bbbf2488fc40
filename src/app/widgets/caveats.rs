//! What restricts an answer as coloured chips.

use egui::{Color32, Frame, Label, Margin, RichText, Sense, TextStyle, Ui};

use crate::app::command::Command;
use crate::app::looks::{self, Icon};
use crate::app::widgets::{assumptions_ui, severity_color};
use impactlab_core::uncertainty::{Caveat, CaveatQuantity, Caveats};
use impactlab_core::units::{NumberFormat, UnitSystem, three_digits};
use impactlab_document::report::without_options;

/// Opacity of the fill of a chip, 0 to 1.
const FILL: f32 = 0.16;
/// Room between the text of a chip and its frame, points.
const MARGIN: Margin = Margin::symmetric(8, 2);

/// Draws what restricts an answer as chips, and lists what it rests on.
pub fn caveats_ui(ui: &mut Ui, caveats: &Caveats, units: UnitSystem, commands: &mut Vec<Command>) {
    restrictions_ui(ui, caveats, units);
    assumptions_ui(ui, caveats, units, commands);
}

/// Draws what restricts an answer as chips; hovering over one shows what it says in full. Where
/// nothing restricts it, this draws nothing.
pub fn restrictions_ui(ui: &mut Ui, caveats: &Caveats, units: UnitSystem) {
    let shown = caveats.restrictions();
    if shown.is_empty() {
        return;
    }
    ui.horizontal_wrapped(|ui| {
        for (i, caveat) in shown.into_iter().enumerate() {
            // A chip that does not fit beside the others begins a row, instead of breaking its words.
            if i > 0 && chip_width(ui, caveat, units) > ui.available_size_before_wrap().x {
                ui.end_row();
            }
            chip_ui(ui, caveat, units);
        }
    });
}

/// Width of a chip on a row of its own, points.
fn chip_width(ui: &Ui, caveat: &Caveat, units: UnitSystem) -> f32 {
    let font = TextStyle::Body.resolve(ui.style());
    let text = ui.painter().layout_no_wrap(chip_text(caveat, units), font, Color32::PLACEHOLDER);
    let icon = looks::icon_size(ui) + looks::GRID;
    icon + text.size().x + 2.0 * f32::from(MARGIN.left) + 2.0
}

fn chip_ui(ui: &mut Ui, caveat: &Caveat, units: UnitSystem) {
    let (severity, icon) = match caveat.is_warning() {
        true => (caveat.severity, Icon::TriangleAlert),
        false => (caveat.severity, Icon::Info),
    };
    let color = severity_color(ui, severity);
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
            let text = RichText::new(chip_text(caveat, units)).color(color);
            ui.add(Label::new(text).selectable(false).truncate());
        });
    });
    let text = without_options(&caveat.in_units(units).text);
    chip.response.interact(Sense::hover()).on_hover_text(text);
}

/// What a chip says: kind, quantity and value.
fn chip_text(caveat: &Caveat, units: UnitSystem) -> String {
    let label = caveat.kind.label();
    let format = NumberFormat::english(units);
    match caveat.quantity_in(&format) {
        Some(CaveatQuantity { name, unit, value, .. }) => {
            let symbol = unit.trim_matches([' ', '[', ']']);
            format!("{label}: {name} {}", format.with_unit(&three_digits(value), symbol))
        }
        None => label.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use egui::{Context, RawInput};

    use super::*;
    use impactlab_core::uncertainty::CaveatKind;

    #[test]
    fn a_chip_has_the_units_of_the_case() {
        let caveat =
            Caveat::new(CaveatKind::NotAtRest, "").with_value("speed at the end [m/s]", 10.0);
        let text = |units| chip_text(&caveat, units);
        assert_eq!(text(UnitSystem::Si), "not at rest: speed at the end 36 km/h");
        assert_eq!(text(UnitSystem::Us), "not at rest: speed at the end 22.4 mph");
        let caveat =
            Caveat::new(CaveatKind::SeveralCourses, "").with_value("courses of events", 7.0);
        let text = chip_text(&caveat, UnitSystem::Si);
        assert_eq!(text, "several courses of events: courses of events 7");
    }

    #[test]
    fn a_chip_that_does_not_fit_begins_a_row() {
        let caveats = [
            (CaveatKind::OutsideDomain, "duration of the motion [s]"),
            (CaveatKind::NotAtRest, "share of the draws at rest"),
        ];
        let caveats = caveats.map(|(kind, what)| Caveat::new(kind, "").with_value(what, 120.0));
        let caveats = Caveats::from_iter(caveats);
        let mut height = 0.0;
        let _ = Context::default().run_ui(RawInput::default(), |ui| {
            ui.set_max_width(340.0);
            height =
                ui.scope(|ui| restrictions_ui(ui, &caveats, UnitSystem::Si)).response.rect.height();
        });
        // Two rows, and not one letter of the second chip in each.
        assert!((30.0..80.0).contains(&height), "{height}");
    }
}
