//! Controls that show and edit a physical quantity in the unit system that the user has chosen.
//!
//! The values that they edit are in SI units; they are converted only for display.

use std::cell::Cell;
use std::ops::RangeInclusive;
use std::time::Duration;

use egui::emath::Numeric;
use egui::{DragValue, Response, RichText, Slider, SliderClamping, Ui};

use impactlab_core::data::Severity;
use impactlab_core::ranges::Range;
use impactlab_core::units::{Quantity, Unit, UnitSystem, significant};
use impactlab_draw::theme;

/// Smallest width of a cell that ends at the edge of what can be seen, points.
const LEAST_CELL_WIDTH: f32 = 80.0;

/// Draws a row of a two-column grid: a label and a number field that edits `value_si`.
///
/// A number that is typed beyond the range is not taken: the field keeps it and says what is possible
/// and which value stays. Dragging stops at the limit. The range stands in the hint of the field.
///
/// - `value_si`: the value in SI units; it is written only when the user changes the field.
/// - `range`: the admissible values.
/// - `units`: the unit system in which the value is shown and typed.
/// - returns whether the user changed the value in this frame.
pub fn quantity_field(
    ui: &mut Ui,
    label: &str,
    value_si: &mut f64,
    range: &Range,
    units: UnitSystem,
) -> bool {
    let name = ui.label(label);
    let (response, is_changed) = quantity_value(ui, value_si, range, units);
    response.labelled_by(name.id);
    ui.end_row();
    is_changed
}

/// Draws a number field as [`quantity_field`] does, without a label and a row of its own.
///
/// - returns the response of the field and whether the user changed the value in this frame.
pub fn quantity_value(
    ui: &mut Ui,
    value_si: &mut f64,
    range: &Range,
    units: UnitSystem,
) -> (Response, bool) {
    let unit = range.quantity.display_unit(units);
    let limits = [range.low, range.high].map(|limit| unit.from_si(limit));
    let expected = range.expected(&unit);
    let value = unit.from_si(*value_si);
    let (response, taken) =
        bounded(ui, value, &significant(value), limits, &expected, |ui, shown| {
            let field = DragValue::new(shown)
                .update_while_editing(false)
                .speed(drag_speed(range, &unit))
                .max_decimals(3)
                .suffix(suffix(&unit));
            ui.add(field)
        });
    let response = response.on_hover_text(hint(range, &unit));
    if let Some(shown) = taken {
        // So that a limit in another unit is the limit.
        *value_si = unit.to_si(shown).clamp(range.low, range.high);
    }
    (response, taken.is_some())
}

/// What a field shows while it has no value.
#[derive(Debug, Clone, Copy)]
pub struct EmptyField<'a> {
    /// What it says.
    pub text: &'a str,
    /// From where it is dragged, SI units.
    pub start_si: f64,
}

/// Draws a number field as [`quantity_value`] does, for a number that may not be known: who empties the field
/// says so.
pub fn optional_quantity(
    ui: &mut Ui,
    value_si: &mut Option<f64>,
    empty: EmptyField<'_>,
    range: &Range,
    units: UnitSystem,
) -> Response {
    let unit = range.quantity.display_unit(units);
    let limits = [range.low, range.high].map(|limit| unit.from_si(limit));
    let expected = range.expected(&unit);
    let start = unit.from_si(value_si.unwrap_or(empty.start_si.clamp(range.low, range.high)));
    let is_empty = value_si.is_none();
    let stays = if is_empty { empty.text.to_owned() } else { significant(start) };
    let is_cleared = Cell::new(false);
    let (response, taken) = bounded(ui, start, &stays, limits, &expected, |ui, shown| {
        let mut is_entered = false;
        let get_set = |entered: Option<f64>| {
            if let Some(entered) = entered {
                (*shown, is_entered) = (entered, true);
            }
            *shown
        };
        let format = |value: f64, decimals: RangeInclusive<usize>| match is_empty && value == start
        {
            true => empty.text.to_owned(),
            false => egui::emath::format_with_decimals_in_range(value, decimals),
        };
        let parse = |text: &str| {
            is_cleared.set(text.trim().is_empty());
            text.trim().replace('−', "-").parse().ok()
        };
        let field = DragValue::from_get_set(get_set)
            .update_while_editing(false)
            .speed(drag_speed(range, &unit))
            .max_decimals(3)
            .suffix(if is_empty { String::new() } else { suffix(&unit) })
            .custom_formatter(format)
            .custom_parser(parse);
        let mut response = ui.add(field);
        // A value that is typed is a value, also where it is that from which the field is dragged.
        if is_entered {
            response.mark_changed();
        }
        response
    });
    if let Some(shown) = taken {
        *value_si = Some(unit.to_si(shown).clamp(range.low, range.high));
    } else if is_cleared.get() {
        *value_si = None;
    }
    let hint = format!("{}. Empty: {}", hint(range, &unit), empty.text);
    response.on_hover_text(hint)
}

/// A number that was typed and is not possible, and the value that stays in its place.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Refused {
    typed: f64,
    stays: f64,
}

/// Draws a control for a number, which keeps what was typed where that is not possible, and says so.
///
/// - `value`: the value that stays unless another is taken; `stays`: the same in words;
/// - `limits`: smallest and largest that are taken; `expected`: the same in words;
/// - returns the response of the control and the number that the user has changed it to in this frame.
fn bounded(
    ui: &mut Ui,
    value: f64,
    stays: &str,
    [low, high]: [f64; 2],
    expected: &str,
    control: impl FnOnce(&mut Ui, &mut f64) -> Response,
) -> (Response, Option<f64>) {
    let id = ui.next_auto_id().with("refused");
    let refused = ui.data(|data| data.get_temp::<Refused>(id));
    let refused = refused.filter(|refused| refused.stays == value);
    let mut shown = refused.map_or(value, |refused| refused.typed);
    let response = ui.vertical(|ui| {
        let color = theme::severity_color(Severity::Error, ui.visuals().dark_mode);
        let response = ui.scope(|ui| {
            if refused.is_some() {
                ui.visuals_mut().override_text_color = Some(color);
            }
            control(ui, &mut shown)
        });
        if refused.is_some() {
            let why = format!("not possible, {stays} stays; expected {expected}");
            ui.label(RichText::new(why).color(color).small());
        }
        response.inner
    });
    let response = response.inner;
    if !response.changed() {
        return (response, None);
    }
    let taken = if response.dragged() { shown.clamp(low, high) } else { shown };
    if (low..=high).contains(&taken) {
        ui.data_mut(|data| data.remove::<Refused>(id));
        return (response, Some(taken));
    }
    ui.data_mut(|data| data.insert_temp(id, Refused { typed: shown, stays: value }));
    (response, None)
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
        Quantity::ForcePerLength => 200.0,
        Quantity::ForcePerArea => 2000.0,
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

/// Draws a number field that counts something, and returns its response. A number beyond the range is
/// treated as by [`quantity_field`].
pub fn count_field<N: Numeric>(ui: &mut Ui, value: &mut N, range: &Range, speed: f64) -> Response {
    let unit = range.quantity.display_unit(UnitSystem::Si);
    let (limits, expected) = ([range.low, range.high], range.expected(&unit));
    let (response, taken) = bounded(
        ui,
        value.to_f64(),
        &significant(value.to_f64()),
        limits,
        &expected,
        |ui, shown| {
            let field = DragValue::new(shown).update_while_editing(false).speed(speed);
            ui.add(field.fixed_decimals(0))
        },
    );
    if let Some(taken) = taken {
        *value = N::from_f64(taken.round());
    }
    response
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
    /// Admissible values. A number beyond them is treated as by [`quantity_field`].
    pub possible: Range,
}

/// Draws a row of a two-column grid: a label and a slider with a number field.
///
/// - `value_si`: the present value, SI units.
/// - `units`: the unit system in which the value is shown and typed.
/// - returns the new value in SI units, or `None` if the user has not changed it in this frame or has
///   typed a number that is not possible.
pub fn quantity_slider(
    ui: &mut Ui,
    range: &SliderRange<'_>,
    value_si: f64,
    units: UnitSystem,
) -> Option<f64> {
    let unit = range.possible.quantity.display_unit(units);
    let hint = format!("{}\n{}", range.hint, hint(&range.possible, &unit));
    let name = ui.label(range.label).on_hover_text(&hint);
    let [low, high] = [range.usual.start(), range.usual.end()].map(|end| unit.from_si(*end));
    let limits = [range.possible.low, range.possible.high];
    let expected = range.possible.expected(&unit);
    let possible = limits.map(|limit| unit.from_si(limit));
    let value = unit.from_si(value_si);
    let stays = significant(value);
    let (response, taken) = bounded(ui, value, &stays, possible, &expected, |ui, shown| {
        let slider = Slider::new(shown, low..=high)
            .clamping(SliderClamping::Never)
            .max_decimals(if high - low > 200.0 { 0 } else { 2 })
            .suffix(suffix(&unit));
        ui.add(slider)
    });
    response.labelled_by(name.id).on_hover_text(hint);
    ui.end_row();
    let [low, high] = limits;
    taken.map(|shown| unit.to_si(shown).clamp(low, high))
}

/// Draws into a cell of a grid what must not go beyond the edge of the part that can be seen, as a grid
/// gives its last column any width.
pub fn within_view<R>(ui: &mut Ui, draw: impl FnOnce(&mut Ui) -> R) -> R {
    let room = ui.clip_rect().right() - ui.cursor().left() - ui.spacing().item_spacing.x;
    ui.scope(|ui| {
        ui.set_max_width(room.max(LEAST_CELL_WIDTH));
        draw(ui)
    })
    .inner
}

/// Draws a row of a two-column grid: a label and a text that is copied to the clipboard on a click.
pub fn value_row(ui: &mut Ui, label: &str, text: &str) {
    ui.label(label);
    value_ui(ui, text);
    ui.end_row();
}

/// Draws a text that is copied to the clipboard on a click.
pub fn value_ui(ui: &mut Ui, text: &str) {
    let value = egui::Label::new(egui::RichText::new(text).monospace()).sense(egui::Sense::click());
    let response = within_view(ui, |ui| ui.add(value.wrap())).on_hover_text("Click to copy");
    if response.clicked() {
        ui.ctx().copy_text(text.to_owned());
    }
}

#[cfg(test)]
mod tests {
    use egui::{Event, Grid, Key};
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    use super::*;
    use impactlab_core::ranges::BODY_MASS;

    #[test]
    fn a_number_beyond_the_range_is_kept_and_not_taken() {
        let mut harness = Harness::new_ui_state(
            |ui, mass_kg: &mut f64| {
                Grid::new("grid").num_columns(2).show(ui, |ui| {
                    quantity_field(ui, "Mass", mass_kg, &BODY_MASS, UnitSystem::Si);
                });
            },
            4.5e6,
        );
        harness.run();
        assert_eq!(*harness.state(), 4.5e6, "a barrier keeps its mass");
        for (typed, stays, is_taken) in [
            ("-3", 4.5e6, false),
            ("1e99", 4.5e6, false),
            ("1800", 1800.0, true),
            ("0", 1800.0, false),
        ] {
            harness.key_press(Key::Tab);
            harness.run();
            harness.event(Event::Text(typed.to_owned()));
            harness.run();
            harness.key_press(Key::Enter);
            harness.run();
            assert_eq!(*harness.state(), stays, "{typed}");
            let says = harness.query_by_label_contains("not possible").is_some();
            assert_eq!(says, !is_taken, "{typed}");
        }
        // A value from elsewhere, such as by undo, takes the place of what was typed.
        *harness.state_mut() = 1500.0;
        harness.run();
        assert!(harness.query_by_label_contains("not possible").is_none());
    }
}
