//! Controls that show and edit a physical quantity in the unit system that the user has chosen.
//!
//! The values that they edit are in SI units; they are converted only for display.

use std::ops::RangeInclusive;
use std::time::Duration;

use egui::{DragValue, Slider, SliderClamping, Ui};

use crate::units::{Quantity, UnitSystem};

/// Draws a row of a two-column grid: a label and a number field that edits `value_si`.
///
/// - `value_si`: the value in SI units; it is written only when the user changes the field.
/// - `range_si`: the admissible values in SI units, to which the field is limited.
/// - `units`: the unit system in which the value is shown and typed.
/// - returns whether the user changed the value in this frame.
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

/// Formats a duration as “42 s”, “3 min 20 s” or “2 h 5 min”, rounded up to whole seconds. From one
/// hour on, the seconds are dropped.
pub fn duration_text(duration: Duration) -> String {
    let s = duration.as_secs_f64().ceil() as u64;
    match (s / 3600, s / 60 % 60, s % 60) {
        (0, 0, s) => format!("{s} s"),
        (0, min, s) => format!("{min} min {s} s"),
        (h, min, _) => format!("{h} h {min} min"),
    }
}

/// Labels, quantity and ranges of a slider.
pub struct SliderRange<'a> {
    /// Label in front of the slider.
    pub label: &'a str,
    /// Explanation of the value, shown on hover.
    pub hint: &'a str,
    /// Physical quantity, which determines the unit that is shown.
    pub quantity: Quantity,
    /// Values at the two ends of the slider, SI units. A typed number may lie outside of them.
    pub usual: RangeInclusive<f64>,
    /// Admissible values, SI units; a changed value is clamped to them.
    pub possible: RangeInclusive<f64>,
}

/// Draws a row of a two-column grid: a label and a slider with a number field.
///
/// - `value_si`: the present value, SI units.
/// - `units`: the unit system in which the value is shown and typed.
/// - returns the new value in SI units, clamped to `range.possible`, or `None` if the user has not
///   changed it in this frame or has typed a number that is not finite.
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

/// Draws a row of a two-column grid: a label and a text that is copied to the clipboard on a click.
pub fn value_row(ui: &mut Ui, label: &str, text: &str) {
    ui.label(label);
    let value = egui::Label::new(egui::RichText::new(text).monospace()).sense(egui::Sense::click());
    let response = ui.add(value).on_hover_text("Click to copy");
    if response.clicked() {
        ui.ctx().copy_text(text.to_owned());
    }
    ui.end_row();
}
