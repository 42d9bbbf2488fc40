//! Numbers with units.

use std::ops::RangeInclusive;
use std::time::Duration;

use egui::{DragValue, Slider, SliderClamping, Ui};

use crate::units::{Quantity, UnitSystem};

/// A labelled field in a two-column grid that edits an SI value in the shown unit.
pub fn quantity_field(
    ui: &mut Ui,
    label: &str,
    value_si: &mut f64,
    quantity: Quantity,
    (range_si, units): (RangeInclusive<f64>, UnitSystem),
) -> bool {
    let unit = quantity.display_unit(units);
    let name = ui.label(label);
    let mut shown = unit.from_si(*value_si);
    let range = unit.from_si(*range_si.start())..=unit.from_si(*range_si.end());
    let span = range.end() - range.start();
    let field =
        DragValue::new(&mut shown).range(range).speed(span / 1000.0).max_decimals(3).suffix(
            if unit.symbol.is_empty() { String::new() } else { format!(" {}", unit.symbol) },
        );
    let changed = ui.add(field).labelled_by(name.id).changed();
    if changed {
        *value_si = unit.to_si(shown);
    }
    ui.end_row();
    changed
}

/// A duration for a person: “42 s”, “3 min 20 s”, “2 h 5 min”.
pub fn duration_text(duration: Duration) -> String {
    let s = duration.as_secs_f64().ceil() as u64;
    match (s / 3600, s / 60 % 60, s % 60) {
        (0, 0, s) => format!("{s} s"),
        (0, min, s) => format!("{min} min {s} s"),
        (h, min, _) => format!("{h} h {min} min"),
    }
}

/// What a slider edits and how.
pub struct SliderRange<'a> {
    /// The number's name.
    pub label: &'a str,
    /// What it is, in a sentence.
    pub hint: &'a str,
    /// What it measures.
    pub quantity: Quantity,
    /// Ends of the slider, SI. Typed numbers may go beyond.
    pub usual: RangeInclusive<f64>,
    /// The numbers that make sense, SI.
    pub possible: RangeInclusive<f64>,
}

/// A labelled slider with a number field in a two-column grid, for an SI value in the shown unit.
/// The new value once it is changed.
pub fn quantity_slider(
    ui: &mut Ui,
    range: &SliderRange<'_>,
    value_si: f64,
    units: UnitSystem,
) -> Option<f64> {
    let unit = range.quantity.display_unit(units);
    let name = ui.label(range.label).on_hover_text(range.hint);
    let mut shown = unit.from_si(value_si);
    let [low, high] = [range.usual.start(), range.usual.end()].map(|end| unit.from_si(*end));
    let slider = Slider::new(&mut shown, low..=high)
        .clamping(SliderClamping::Never)
        .max_decimals(if high - low > 200.0 { 0 } else { 2 })
        .suffix(if unit.symbol.is_empty() { String::new() } else { format!(" {}", unit.symbol) });
    let changed = ui.add(slider).labelled_by(name.id).on_hover_text(range.hint).changed();
    ui.end_row();
    let (least, most) = (*range.possible.start(), *range.possible.end());
    (changed && shown.is_finite()).then(|| unit.to_si(shown).clamp(least, most))
}

/// A labelled value in a two-column grid; clicking copies it.
pub fn value_row(ui: &mut Ui, label: &str, text: &str) {
    ui.label(label);
    let value = egui::Label::new(egui::RichText::new(text).monospace()).sense(egui::Sense::click());
    let response = ui.add(value).on_hover_text("Click to copy");
    if response.clicked() {
        ui.ctx().copy_text(text.to_owned());
    }
    ui.end_row();
}
