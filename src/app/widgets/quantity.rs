//! Controls that show and edit a physical quantity in the unit system that the user has chosen.
//!
//! The values that they edit are in SI units; they are converted only for display.

use std::ops::RangeInclusive;
use std::time::Duration;

use egui::emath::Numeric;
use egui::{DragValue, Response, Slider, SliderClamping, Ui};

use crate::ranges::Range;
use crate::units::{Quantity, Unit, UnitSystem};

/// Draws a row of a two-column grid: a label and a number field that edits `value_si`.
///
/// A number that is typed or dragged beyond the range is held at its limit, which the field then
/// shows; the range stands in the hint of the field.
///
/// - `value_si`: the value in SI units; it is written only when the user changes the field.
/// - `range`: the admissible values.
/// - `units`: the unit system in which the value is shown and typed.
/// - returns whether the user changed the value in this frame.
pub fn quantity_field(
    ui: &mut Ui,
    label: &str,
    value_si: &mut f64,
    (range, units): (&Range, UnitSystem),
) -> bool {
    let unit = range.quantity.display_unit(units);
    let name = ui.label(label);
    let mut shown = unit.from_si(*value_si);
    let [low, high] = [range.low, range.high].map(|limit| unit.from_si(limit));
    let field = DragValue::new(&mut shown)
        .range(low..=high)
        .clamp_existing_to_range(false)
        .speed(drag_speed(range, &unit))
        .max_decimals(3)
        .suffix(suffix(&unit));
    let response = ui.add(field).labelled_by(name.id);
    let changed = response.changed();
    response.on_hover_text(hint(range, &unit));
    if changed {
        *value_si = unit.to_si(shown).clamp(range.low, range.high);
    }
    ui.end_row();
    changed
}

/// Change of a number per point that the mouse is dragged, in the shown unit. It also decides how
/// many decimals the field shows.
fn drag_speed(range: &Range, unit: &Unit) -> f64 {
    let ordinary = match range.quantity {
        Quantity::Speed => 0.08,
        Quantity::Length => 0.02,
        Quantity::Mass => 50.0,
        Quantity::MomentOfInertia => 500.0,
        Quantity::Angle => 0.006,
        Quantity::AngularVelocity => 0.02,
        Quantity::Time => 0.03,
        _ => 0.002,
    };
    unit.from_si(f64::min(ordinary, (range.high - range.low) / 1000.0))
}

fn suffix(unit: &Unit) -> String {
    if unit.symbol.is_empty() { String::new() } else { format!(" {}", unit.symbol) }
}

/// The range and the meaning of a number, as the hint of its field.
fn hint(range: &Range, unit: &Unit) -> String {
    format!("{}: {}", range.meaning, range.expected(unit))
}

/// Draws a number field that counts something, and returns its response. A number that is typed or
/// dragged beyond the range is held at its limit, which the field then shows.
pub fn count_field<N: Numeric>(ui: &mut Ui, value: &mut N, range: &Range, speed: f64) -> Response {
    let limits = N::from_f64(range.low)..=N::from_f64(range.high);
    let field = DragValue::new(value).range(limits).clamp_existing_to_range(false).speed(speed);
    ui.add(field)
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

/// Labels and ranges of a slider.
pub struct SliderRange<'a> {
    /// Label in front of the slider.
    pub label: &'a str,
    /// Explanation of the value, shown on hover.
    pub hint: &'a str,
    /// Values at the two ends of the slider, SI units. A typed number may lie outside of them.
    pub usual: RangeInclusive<f64>,
    /// Admissible values. A number beyond them is held at the limit, which the field then shows.
    pub possible: Range,
}

/// Draws a row of a two-column grid: a label and a slider with a number field.
///
/// - `value_si`: the present value, SI units.
/// - `units`: the unit system in which the value is shown and typed.
/// - returns the new value in SI units, held in `range.possible`, or `None` if the user has not
///   changed it in this frame or has typed a number that is not finite.
pub fn quantity_slider(
    ui: &mut Ui,
    range: &SliderRange<'_>,
    value_si: f64,
    units: UnitSystem,
) -> Option<f64> {
    let unit = range.possible.quantity.display_unit(units);
    let hint = format!("{}\n{}", range.hint, hint(&range.possible, &unit));
    let name = ui.label(range.label).on_hover_text(&hint);
    let mut shown = unit.from_si(value_si);
    let [low, high] = [range.usual.start(), range.usual.end()].map(|end| unit.from_si(*end));
    let slider = Slider::new(&mut shown, low..=high)
        .clamping(SliderClamping::Never)
        .max_decimals(if high - low > 200.0 { 0 } else { 2 })
        .suffix(suffix(&unit));
    let changed = ui.add(slider).labelled_by(name.id).on_hover_text(hint).changed();
    ui.end_row();
    let Range { low, high, .. } = range.possible;
    (changed && shown.is_finite()).then(|| unit.to_si(shown).clamp(low, high))
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

#[cfg(test)]
mod tests {
    use egui::{Event, Grid, Key};
    use egui_kittest::Harness;

    use super::*;
    use crate::ranges::BODY_MASS;

    #[test]
    fn a_number_beyond_the_range_is_held_at_its_limit() {
        let mut harness = Harness::new_ui_state(
            |ui, mass_kg: &mut f64| {
                Grid::new("grid").num_columns(2).show(ui, |ui| {
                    quantity_field(ui, "Mass", mass_kg, (&BODY_MASS, UnitSystem::Si));
                });
            },
            4.5e6,
        );
        harness.run();
        assert_eq!(*harness.state(), 4.5e6, "a barrier keeps its mass");
        for (typed, held) in [("-3", 1.0), ("1e99", 1e8), ("1800", 1800.0)] {
            harness.key_press(Key::Tab);
            harness.run();
            harness.event(Event::Text(typed.to_owned()));
            harness.run();
            harness.key_press(Key::Enter);
            harness.run();
            assert_eq!(*harness.state(), held, "{typed}");
        }
    }
}
