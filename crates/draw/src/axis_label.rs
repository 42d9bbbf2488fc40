//! The texts of the axes of a plot, as long as there is room for them.

use egui::{Color32, TextStyle, Ui};

use impactlab_document::figure::Axis;

/// The text beside an upright axis; where it is longer than the plot is high, its unit alone, as the
/// heading above the plot names the quantity.
pub(crate) fn label_that_fits(ui: &Ui, axis: &Axis, room: f32) -> String {
    match fits(ui, &axis.text(), room) || axis.unit.symbol.is_empty() {
        true => shortened(ui, axis, room),
        false => format!("[{}]", axis.unit.symbol),
    }
}

/// The text of an axis; where it is longer than its room, with its end cut off before the unit.
pub(crate) fn shortened(ui: &Ui, axis: &Axis, room: f32) -> String {
    let text = axis.text();
    if fits(ui, &text, room) {
        return text;
    }
    let unit = match axis.unit.symbol {
        "" => String::new(),
        symbol => format!(" [{symbol}]"),
    };
    let cut = |n: usize| {
        let kept: String = axis.label.chars().take(n).collect();
        format!("{}…{unit}", kept.trim_end())
    };
    let mut shorter = (1..axis.label.chars().count()).rev().map(cut);
    shorter.find(|text| fits(ui, text, room)).unwrap_or_default()
}

fn fits(ui: &Ui, text: &str, room: f32) -> bool {
    let font = TextStyle::Body.resolve(ui.style());
    let galley = ui.painter().layout_no_wrap(text.to_owned(), font, Color32::PLACEHOLDER);
    galley.size().x <= room
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Canvas;
    use crate::offscreen::shapes_offscreen;
    use impactlab_core::units::{Quantity, UnitSystem};

    const CANVAS: Canvas = Canvas { size_px: [1200, 300], scale: 1.0, dark: false };

    /// “± Geschwindigkeit des gestoßenen F” stood below a narrow picture of a report, cut at its edge.
    #[test]
    fn a_text_that_is_too_long_is_cut_and_keeps_its_unit() {
        let axis = |quantity| Axis::shown("speed of the struck car", quantity, UnitSystem::Si);
        let (speed, pure) = (axis(Quantity::Speed), axis(Quantity::Ratio));
        shapes_offscreen(CANVAS, |ui| {
            assert_eq!(shortened(ui, &speed, 1000.0), "speed of the struck car [km/h]");
            let cut = shortened(ui, &speed, 120.0);
            assert!(cut.starts_with("speed") && cut.ends_with("… [km/h]"), "{cut}");
            assert!(fits(ui, &cut, 120.0), "{cut}");
            assert_eq!(label_that_fits(ui, &speed, 120.0), "[km/h]");
            let cut = label_that_fits(ui, &pure, 120.0);
            assert!(cut.starts_with("speed") && cut.ends_with('…'), "{cut}");
        })
        .unwrap();
    }
}
