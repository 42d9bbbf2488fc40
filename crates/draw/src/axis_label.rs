//! The texts of the axes of a plot, as long as there is room for them.

use std::f32::consts::FRAC_PI_2;

use egui::epaint::TextShape;
use egui::{Color32, Rangef, TextStyle, TextWrapMode, Ui, WidgetText, pos2};

use impactlab_document::figure::Axis;

/// By how much of its height a text stands further away from its axis, as egui_plot has it.
pub(crate) const GAP: f32 = 0.25;

/// The text beside an upright axis, or what stands before its comma; where that is longer than the plot is
/// high, its unit alone, as the heading above the plot or the caption below it names the quantity.
pub(crate) fn label_that_fits(ui: &Ui, axis: &Axis, room: f32) -> String {
    match whole(ui, axis, room) {
        Some(text) => text,
        None if axis.unit.symbol.is_empty() => shortened(ui, axis, room),
        None => format!("[{}]", axis.unit.symbol),
    }
}

/// The text of an axis, or what stands before its comma; where that is longer than its room, with its end cut
/// off before the unit.
pub(crate) fn shortened(ui: &Ui, axis: &Axis, room: f32) -> String {
    if let Some(text) = whole(ui, axis, room) {
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

/// The text of an axis, or its first words, such as “Y [m]” for “Y, to the left [m]”; `None` if there is no room
/// for either.
fn whole(ui: &Ui, axis: &Axis, room: f32) -> Option<String> {
    let brief = axis.label.split_once(", ").map(|(brief, _)| brief.to_owned());
    let brief = brief.map(|label| Axis { label, ..axis.clone() }.text());
    std::iter::once(axis.text()).chain(brief).find(|text| fits(ui, text, room))
}

/// The part of an upright axis that is seen where a scroll area ends within it; `None` of an axis that is
/// seen whole.
///
/// - `height`: of the axis, which begins at the cursor.
pub(crate) fn seen_part(ui: &Ui, height: f32) -> Option<Rangef> {
    let top = ui.cursor().top();
    let whole = Rangef::new(top, top + height);
    let seen = whole.intersection(ui.clip_rect().y_range());
    (seen.span() < whole.span()).then_some(seen)
}

/// Draws the text beside an upright axis in the middle of the part that is seen, if there is room for it.
///
/// - `left`: left end of the labels of the axis.
pub(crate) fn label_in_part(ui: &Ui, axis: &Axis, left: f32, seen: Rangef) {
    let text = label_that_fits(ui, axis, seen.span());
    if !fits(ui, &text, seen.span()) {
        return;
    }
    let (text, wrap) = (WidgetText::from(text), Some(TextWrapMode::Extend));
    let galley = text.into_galley(ui, wrap, f32::INFINITY, TextStyle::Body);
    let at = pos2(left - GAP * galley.size().y, seen.center() + 0.5 * galley.size().x);
    let text = TextShape::new(at, galley, ui.visuals().text_color());
    ui.painter().add(text.with_angle(-FRAC_PI_2));
}

fn fits(ui: &Ui, text: &str, room: f32) -> bool {
    let font = TextStyle::Body.resolve(ui.style());
    let galley = ui.painter().layout_no_wrap(text.to_owned(), font, Color32::PLACEHOLDER);
    galley.size().x <= room
}

#[cfg(test)]
mod tests {
    use egui::{Rect, Shape};

    use super::*;
    use crate::offscreen::shapes_offscreen;
    use crate::{Canvas, FigureOptions, figure_ui};
    use impactlab_core::units::{Quantity, UnitSystem};
    use impactlab_document::figure::{Figure, FigureElement, Role};

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
            // “[m]” alone stood beside the plan of a reconstruction.
            let place = Axis::shown("Y, to the left", Quantity::Length, UnitSystem::Si);
            assert_eq!(label_that_fits(ui, &place, 1000.0), "Y, to the left [m]");
            assert_eq!([label_that_fits, shortened].map(|of| of(ui, &place, 60.0)), ["Y [m]"; 2]);
        })
        .unwrap();
    }

    /// “Force [kN]” was cut to “orce [kN]” where a pane showed the upper part of a plot.
    #[test]
    fn a_text_stands_in_the_part_of_the_axis_that_is_seen() {
        let axes = [("Time", Quantity::Time), ("Force", Quantity::Force)];
        let axes = axes.map(|(name, quantity)| Axis::shown(name, quantity, UnitSystem::Si));
        let curve = FigureElement::line("F", Role::Resultant, vec![[0.0, 1.0], [0.1, 2.0]]);
        let figure = Figure::new("force", axes, vec![curve]);
        let texts = |seen: Rangef| -> Vec<String> {
            let shapes = shapes_offscreen(CANVAS, |ui| {
                ui.set_clip_rect(Rect::from_x_y_ranges(0.0_f32..=600.0, seen));
                let height = Some(200.0);
                let options = FigureOptions { height, legend: false, ..FigureOptions::default() };
                figure_ui(ui, &figure, &options);
            });
            let shapes = shapes.unwrap().into_iter().map(|clipped| clipped.shape);
            let texts = shapes.filter_map(|shape| match shape {
                Shape::Text(text) if text.galley.text().contains("kN") => Some(text),
                _ => None,
            });
            texts
                .map(|text| {
                    let (name, at) = (text.galley.text(), text.visual_bounding_rect());
                    let is_seen = seen.contains(at.top()) && seen.contains(at.bottom());
                    assert!(is_seen, "{name} at {at:?} of {seen:?}");
                    name.to_owned()
                })
                .collect()
        };
        for seen in [Rangef::new(0.0, 300.0), Rangef::new(0.0, 90.0), Rangef::new(75.0, 300.0)] {
            assert_eq!(texts(seen), ["Force [kN]"], "{seen:?}");
        }
        assert_eq!(texts(Rangef::new(0.0, 45.0)), ["[kN]"]);
        assert_eq!(texts(Rangef::new(0.0, 10.0)), [""; 0]);
    }
}
