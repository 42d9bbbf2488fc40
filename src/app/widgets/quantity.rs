//! Controls that show and edit a physical quantity in the unit system that the user has chosen.
//!
//! The values that they edit are in SI units; they are converted only for display.

use std::ops::RangeInclusive;
use std::time::Duration;

use egui::emath::Numeric;
use egui::{DragValue, Response, Slider, SliderClamping, Ui};

use crate::app::widgets::number::{Edit, Editing, Number, most_decimals, number_ui};
use impactlab_core::ranges::Range;
use impactlab_core::units::{Quantity, Unit, UnitSystem};

/// Smallest width of a cell that ends at the edge of what can be seen, points.
const LEAST_CELL_WIDTH: f32 = 80.0;

/// Draws a row of a two-column grid: a label and a number field that edits `value_si`.
///
/// Any unit of the quantity may be typed. What is typed and cannot be read, or lies beyond the range, is not
/// taken: the field keeps it and says what is possible and which value stays. Dragging stops at the limit. The
/// range stands in the hint of the field.
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
    let number = number(range, Some(*value_si), units);
    let (response, edit) = number_ui(ui, &number, |ui, editing| {
        ui.add(field(editing, drag_speed(range, &number.unit)))
    });
    let response = response.on_hover_text(hint(range, &number.unit));
    if let Edit::Value(shown) = edit {
        *value_si = to_si(&number, range, shown);
    }
    (response, matches!(edit, Edit::Value(_)))
}

/// A number in the unit in which the user reads and types it.
fn number<'a>(range: &Range, value_si: Option<f64>, units: UnitSystem) -> Number<'a> {
    let unit = range.quantity.display_unit(units);
    Number {
        quantity: range.quantity,
        unit,
        limits: [range.low, range.high].map(|limit| unit.from_si(limit)),
        expected: range.expected(&unit),
        is_whole: false,
        value: value_si.map(|value_si| unit.from_si(value_si)),
        empty: None,
    }
}

/// What was taken, in SI units, so that a limit in another unit is the limit.
fn to_si(number: &Number<'_>, range: &Range, shown: f64) -> f64 {
    number.unit.to_si(shown).clamp(range.low, range.high)
}

fn field<'a>(editing: Editing<'a>, speed: f64) -> DragValue<'a> {
    let Editing { value, suffix, parse, format } = editing;
    let most = most_decimals(*value, speed);
    DragValue::new(value)
        .update_while_editing(false)
        .speed(speed)
        .max_decimals(most)
        .suffix(suffix)
        .custom_formatter(format)
        .custom_parser(parse)
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
    let number = number(range, *value_si, units);
    let start = number.unit.from_si(empty.start_si.clamp(range.low, range.high));
    let number = Number { empty: Some((empty.text, start)), ..number };
    let (response, edit) = number_ui(ui, &number, |ui, editing| {
        ui.add(field(editing, drag_speed(range, &number.unit)))
    });
    match edit {
        Edit::Value(shown) => *value_si = Some(to_si(&number, range, shown)),
        Edit::Cleared => *value_si = None,
        Edit::None => {}
    }
    let hint = format!("{}. Empty: {}", hint(range, &number.unit), empty.text);
    response.on_hover_text(hint)
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

/// The range and the meaning of a number, as the hint of its field.
fn hint(range: &Range, unit: &Unit) -> String {
    let expected = range.expected(unit);
    let others = range.quantity.units().len() > 1;
    let units = if others { "; any unit may be typed" } else { "" };
    format!("{}: {expected}{units}", range.meaning)
}

/// Draws a number field that counts something, and returns its response. A number beyond the range is
/// treated as by [`quantity_field`].
pub fn count_field<N: Numeric>(ui: &mut Ui, value: &mut N, range: &Range, speed: f64) -> Response {
    let number = number(range, Some(value.to_f64()), UnitSystem::Si);
    let expected = format!("a whole number, {}", number.expected);
    let hint = format!("{}: {expected}", range.meaning);
    let number = Number { is_whole: true, expected, ..number };
    let (response, edit) =
        number_ui(ui, &number, |ui, editing| ui.add(field(editing, speed).fixed_decimals(0)));
    if let Edit::Value(taken) = edit {
        *value = N::from_f64(taken);
    }
    response.on_hover_text(hint)
}

/// Draws a number field that counts something and may be left open, and returns its response: who empties it,
/// or types 0, leaves it open. A number beyond the range is treated as by [`quantity_field`].
///
/// - `open`: what the field says while it is open.
pub fn optional_count(
    ui: &mut Ui,
    value: &mut Option<usize>,
    open: &str,
    range: &Range,
) -> Response {
    let number = number(range, value.map(|n| n as f64), UnitSystem::Si);
    let expected = format!("a whole number, {}; empty: {open}", number.expected);
    let hint = format!("{}: {expected}", range.meaning);
    let (limits, empty) = ([0.0, number.limits[1]], Some((open, 0.0)));
    let number = Number { is_whole: true, expected, limits, empty, ..number };
    let (response, edit) =
        number_ui(ui, &number, |ui, editing| ui.add(field(editing, 0.2).fixed_decimals(0)));
    match edit {
        Edit::Value(taken) => *value = Some(taken as usize).filter(|n| *n > 0),
        Edit::Cleared => *value = None,
        Edit::None => {}
    }
    response.on_hover_text(hint)
}

/// The seeds that a field takes: whole numbers that it holds exactly.
const SEED: Range = Range::whole(
    "seed",
    [0, 1_000_000_000_000_000],
    "start of the random numbers; the same seed gives the same numbers",
);

/// Draws a field for the seed of random numbers, and returns its response. What is no whole number, or too
/// large, is treated as by [`quantity_field`]; a larger seed from elsewhere stays as it is until another one
/// is entered.
pub fn seed_field(ui: &mut Ui, seed: &mut u64) -> Response {
    let exact = format!("Seed {seed}");
    count_field(ui, seed, &SEED, 0.2).on_hover_text(exact)
}

/// Formats a duration as “42 s”, “3 min 20 s” or “2 h 5 min”, rounded up to whole seconds. From one
/// hour on, the seconds are dropped.
pub fn duration_text(duration: Duration) -> String {
    let s = duration.as_secs_f64().ceil() as u64;
    match (s / 3600, s / 60 % 60, s % 60) {
        (0, 0, s) => format!("{s} s"),
        (0, min, 0) => format!("{min} min"),
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
    let number = number(&range.possible, Some(value_si), units);
    let unit = &number.unit;
    let hint = format!("{}\n{}", range.hint, hint(&range.possible, unit));
    let name = ui.label(range.label).on_hover_text(&hint);
    let [low, high] = [range.usual.start(), range.usual.end()].map(|end| unit.from_si(*end));
    let (response, edit) = number_ui(ui, &number, |ui, editing| {
        let Editing { value, suffix, parse, format } = editing;
        let slider = Slider::new(value, low..=high)
            .clamping(SliderClamping::Never)
            .update_while_editing(false)
            .max_decimals(if high - low > 200.0 { 0 } else { 2 })
            .suffix(suffix)
            .custom_formatter(format)
            .custom_parser(parse);
        ui.add(slider)
    });
    response.labelled_by(name.id).on_hover_text(hint);
    ui.end_row();
    match edit {
        Edit::Value(shown) => Some(to_si(&number, &range.possible, shown)),
        Edit::Cleared | Edit::None => None,
    }
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
    use egui_kittest::kittest::{NodeT, Queryable};

    use super::*;
    use impactlab_core::ranges::BODY_MASS;

    /// Types a text into the next field and leaves it.
    fn type_in<S>(harness: &mut Harness<'_, S>, typed: &str) {
        harness.key_press(Key::Tab);
        harness.run();
        harness.event(Event::Text(typed.to_owned()));
        harness.run();
        harness.key_press(Key::Enter);
        harness.run();
    }

    #[test]
    fn a_duration_of_whole_minutes_has_no_seconds() {
        let text = |seconds| duration_text(Duration::from_secs(seconds));
        assert_eq!([147, 1500, 7500].map(text), ["2 min 27 s", "25 min", "2 h 5 min"]);
    }

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
            ("heavy", 1800.0, false),
            ("1,860", 1800.0, false),
            ("4100 lb", 4100.0 * 0.453_592_37, true),
            ("1,86 t", 1860.0, true),
        ] {
            type_in(&mut harness, typed);
            assert_eq!(*harness.state(), stays, "{typed}");
            let says = harness.query_by_label_contains("not possible").is_some();
            assert_eq!(says, !is_taken, "{typed}");
        }
        // Leaving a field as it is does not round its number, and what was typed stands there again.
        *harness.state_mut() = 1_860.000_4;
        for _ in 0..2 {
            harness.key_press(Key::Tab);
            harness.run();
        }
        assert_eq!(*harness.state(), 1_860.000_4);
        // A value from elsewhere, such as by undo, takes the place of what was typed.
        *harness.state_mut() = 1500.0;
        harness.run();
        assert!(harness.query_by_label_contains("not possible").is_none());
    }

    /// Why a number was not taken stood below it, and moved every field that follows.
    #[test]
    fn a_number_that_is_not_taken_moves_nothing_and_escape_brings_the_value_back() {
        let mut harness = Harness::new_ui_state(
            |ui, mass_kg: &mut f64| {
                Grid::new("grid").num_columns(2).show(ui, |ui| {
                    quantity_field(ui, "Mass", mass_kg, &BODY_MASS, UnitSystem::Si);
                });
                ui.label("below");
            },
            1500.0,
        );
        harness.run();
        let place = |harness: &Harness<'_, f64>| harness.get_by_label("below").rect();
        let before = place(&harness);
        type_in(&mut harness, "-3");
        assert!(harness.query_by_label_contains("not possible").is_some());
        assert_eq!(place(&harness), before);
        // It is said again whenever the field is looked at, and not while another thing is done.
        harness.event(Event::Text("x".to_owned()));
        harness.run();
        assert!(harness.query_by_label_contains("not possible").is_none());
        harness.key_press(Key::Tab);
        harness.run();
        assert!(harness.query_by_label_contains("not possible").is_some());
        harness.key_press(Key::Escape);
        harness.run();
        harness.key_press(Key::Tab);
        harness.run();
        assert!(harness.query_by_label_contains("not possible").is_none());
        assert_eq!(*harness.state(), 1500.0);
    }

    /// The end of the longer text stood behind what was typed.
    #[test]
    fn what_is_usual_may_change_while_a_field_is_selected() {
        let mut harness = Harness::new_ui_state(
            |ui, (mass_kg, usual_kg): &mut (Option<f64>, f64)| {
                let text = format!("{usual_kg} (usual)");
                let empty = EmptyField { text: &text, start_si: *usual_kg };
                optional_quantity(ui, mass_kg, empty, &BODY_MASS, UnitSystem::Si);
            },
            (None, 1500.0),
        );
        harness.run();
        harness.key_press(Key::Tab);
        harness.run();
        harness.state_mut().1 = 1860.25;
        harness.run();
        harness.event(Event::Text("1700".to_owned()));
        harness.run();
        harness.key_press(Key::Enter);
        harness.run();
        assert_eq!(harness.state().0, Some(1700.0));
        assert!(harness.query_by_label_contains("not possible").is_none());
    }

    /// In which unit a number is taken was seen in a field that had one.
    #[test]
    fn an_empty_field_says_the_unit_of_what_is_typed_once() {
        for (text, expected) in [
            ("not known", "not known [lb]"),
            ("(2000 lb)", "(2000 lb)"),
            ("2000 lb, as the file says", "2000 lb, as the file says"),
        ] {
            let mut harness = Harness::new_ui(|ui| {
                let empty = EmptyField { text, start_si: 1500.0 };
                optional_quantity(ui, &mut None, empty, &BODY_MASS, UnitSystem::Us);
            });
            harness.run();
            let field = harness.get_by_role(egui::accesskit::Role::SpinButton);
            assert_eq!(field.accesskit_node().value().as_deref(), Some(expected));
        }
    }

    /// A number of epochs beyond the range became the largest one without a word.
    #[test]
    fn a_count_that_is_left_open_is_emptied_and_not_cut_off() {
        let range = Range::whole("epochs", [1, 100], "passes over the training cases");
        let mut harness = Harness::new_ui_state(
            |ui, count: &mut Option<usize>| {
                optional_count(ui, count, "as configured", &range);
            },
            None,
        );
        harness.run();
        for (typed, stays) in
            [("12", Some(12)), ("1000", Some(12)), ("2.5", Some(12)), ("0", None), ("7", Some(7))]
        {
            type_in(&mut harness, typed);
            assert_eq!(*harness.state(), stays, "{typed}");
        }
        type_in(&mut harness, " ");
        assert_eq!(*harness.state(), None);
    }

    #[test]
    fn a_seed_that_is_no_whole_number_is_kept_and_not_taken() {
        let mut harness = Harness::new_ui_state(
            |ui, seed: &mut u64| {
                seed_field(ui, seed);
            },
            u64::MAX,
        );
        harness.run();
        assert_eq!(*harness.state(), u64::MAX, "a larger one from elsewhere stays");
        for (typed, stays, is_taken) in [
            ("12.5", u64::MAX, false),
            ("-3", u64::MAX, false),
            ("random", u64::MAX, false),
            ("42", 42, true),
            ("2000000000000000", 42, false),
            ("1000", 1000, true),
        ] {
            type_in(&mut harness, typed);
            assert_eq!(*harness.state(), stays, "{typed}");
            let says = harness.query_by_label_contains("not possible").is_some();
            assert_eq!(says, !is_taken, "{typed}");
        }
    }
}
