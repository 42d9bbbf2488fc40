//! A control for a number that keeps what was typed where that is not possible, and says why.

use std::cell::RefCell;
use std::ops::RangeInclusive;

use egui::{Event, Id, Key, Response, Ui};

use crate::app::widgets::refusal::refusal_ui;
use crate::app::widgets::severity_color;
use impactlab_core::data::Severity;
use impactlab_core::units::{Quantity, Unit, is_converted, significant};

/// Most decimals that a field shows.
const MOST_DECIMALS: usize = 3;

/// A number as a control shows it, in the unit in which it is shown and typed.
pub(super) struct Number<'a> {
    /// What it is a number of.
    pub(super) quantity: Quantity,
    /// The unit in which it is shown, and that of what is typed without one.
    pub(super) unit: Unit,
    /// Smallest and largest that are taken.
    pub(super) limits: [f64; 2],
    /// The same in words.
    pub(super) expected: String,
    /// Whether it counts something.
    pub(super) is_whole: bool,
    /// Its value; `None` if it is not known.
    pub(super) value: Option<f64>,
    /// What the control shows of one that is not known, and from where that is dragged; `None` for a number
    /// that is always known.
    pub(super) empty: Option<(&'a str, f64)>,
}

/// What a user did with a control.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Edit {
    /// Nothing, or nothing that is possible.
    None,
    /// Another number.
    Value(f64),
    /// No number any more.
    Cleared,
}

/// How a control shows and reads its number.
pub(super) struct Editing<'a> {
    /// The number that is dragged.
    pub(super) value: &'a mut f64,
    /// What stands after it.
    pub(super) suffix: String,
    /// Reads a text.
    pub(super) parse: &'a dyn Fn(&str) -> Option<f64>,
    /// Writes a number.
    pub(super) format: &'a dyn Fn(f64, RangeInclusive<usize>) -> String,
}

/// What was typed and is not possible.
#[derive(Debug, Clone, PartialEq)]
struct Refused {
    text: String,
    why: String,
    /// The value that stays in its place.
    stays: Option<f64>,
    /// The frame in which it was typed, until the user does something else.
    new_since: Option<u64>,
}

/// What a field without a number said when its text was selected.
#[derive(Debug, Clone)]
struct Held {
    text: String,
    start: f64,
}

/// What has been typed in this frame.
#[derive(Debug, Clone, PartialEq)]
enum Typed {
    Nothing,
    Value(f64),
    Cleared,
    Refused { text: String, why: String },
}

impl Typed {
    fn value(&self) -> Option<f64> {
        match self {
            Self::Value(value) => Some(*value),
            Self::Nothing | Self::Cleared | Self::Refused { .. } => None,
        }
    }
}

impl Number<'_> {
    /// The number in words.
    fn in_words(&self) -> String {
        match (self.value, self.empty) {
            (Some(value), _) => significant(value),
            (None, Some((text, _))) => text.to_owned(),
            (None, None) => String::new(),
        }
    }

    /// What a text says.
    fn typed(&self, text: &str) -> Typed {
        let refused = |why: String| Typed::Refused { text: text.trim().to_owned(), why };
        if text.trim().is_empty() {
            return match self.empty {
                Some(_) => Typed::Cleared,
                None => Typed::Nothing,
            };
        }
        let value = match self.quantity.parse(text, &self.unit) {
            Ok(value_si) => self.unit.from_si(value_si),
            Err(error) => return refused(error.to_string()),
        };
        let [low, high] = self.limits;
        if !(low..=high).contains(&value) || (self.is_whole && value.fract() != 0.0) {
            return refused(format!("expected {}", self.expected));
        }
        Typed::Value(value)
    }
}

/// Draws a control for a number. What was typed and is not possible stays in it with a mark; why, is said over
/// what stands below, until the user goes on and whenever the field has the focus or the pointer. Escape brings
/// the value back.
///
/// - `control`: draws it;
/// - returns the response of the control, and what the user did with it in this frame.
pub(super) fn number_ui(
    ui: &mut Ui,
    number: &Number<'_>,
    control: impl FnOnce(&mut Ui, Editing<'_>) -> Response,
) -> (Response, Edit) {
    let id = ui.next_auto_id().with("refused");
    let refused = refused_before(ui, id, number);
    // Another field may change what this one says while its text is selected: keys would leave the end of it.
    let held_id = id.with("held");
    let held = ui.data(|data| data.get_temp::<Held>(held_id));
    let empty = match (&held, number.empty) {
        (Some(Held { text, start }), Some(_)) => Some((text.as_str(), *start)),
        (_, empty) => empty,
    };
    let start = number.value.or(empty.map(|(_, start)| start)).unwrap_or_default();
    let typed = RefCell::new(Typed::Nothing);
    // What the field says of its number, which is no other number when it is left as it was.
    let written = RefCell::new(String::new());
    let format = |value: f64, decimals: RangeInclusive<usize>| {
        let text = match (&refused, number.value, empty) {
            (Some(refused), ..) if value == start => refused.text.clone(),
            (None, None, Some((text, _))) if value == start => text.to_owned(),
            _ => egui::emath::format_with_decimals_in_range(value, decimals),
        };
        written.borrow_mut().clone_from(&text);
        text
    };
    let left_id = id.with("left");
    let left = ui.data(|data| data.get_temp::<String>(left_id));
    let parse = |text: &str| {
        if text == *written.borrow() || left.as_deref() == Some(text) {
            return None;
        }
        let found = number.typed(text);
        let value = found.value();
        typed.replace(found);
        value
    };
    let suffix = suffix(number, empty, refused.is_some());
    let mut shown = start;
    let response = ui.vertical(|ui| {
        let response = ui.scope(|ui| {
            if refused.is_some() {
                ui.visuals_mut().override_text_color = Some(severity_color(ui, Severity::Error));
            }
            control(ui, Editing { value: &mut shown, suffix, parse: &parse, format: &format })
        });
        let response = response.inner;
        let Some(Refused { why, new_since, .. }) = &refused else { return response };
        let why = format!("not possible, {} stays; {why}", number.in_words());
        let is_open = new_since.is_some() || response.has_focus();
        refusal_ui(ui, response, &why, is_open)
    });
    let response = response.inner;
    let is_left = refused.is_some()
        && response.lost_focus()
        && ui.input(|input| input.key_pressed(Key::Escape));
    // A field that is left with Escape gives what stood in it once more, a frame later.
    if let (true, Some(refused)) = (is_left, &refused) {
        ui.data_mut(|data| data.insert_temp(left_id, refused.text.clone()));
    } else if response.has_focus() {
        ui.data_mut(|data| data.remove::<String>(left_id));
    }
    match empty {
        Some((text, start)) if number.value.is_none() && response.has_focus() => {
            let held = Held { text: text.to_owned(), start };
            ui.data_mut(|data| data.insert_temp(held_id, held));
        }
        _ => ui.data_mut(|data| data.remove::<Held>(held_id)),
    }
    let edit = match typed.into_inner() {
        Typed::Nothing if is_left => {
            forget(ui, id);
            Edit::None
        }
        Typed::Nothing if response.changed() => {
            forget(ui, id);
            let value = if number.is_whole { shown.round() } else { shown };
            Edit::Value(value.clamp(number.limits[0], number.limits[1]))
        }
        typed => edit_of(ui, id, number, typed),
    };
    (response, edit)
}

/// Most decimals that a field shows: those that a number was stated with, but of one that was computed, or
/// stated in another unit, those of four digits and of the step by which it is dragged.
pub(super) fn most_decimals(value: f64, speed: f64) -> usize {
    if !is_converted(value) {
        return MOST_DECIMALS;
    }
    let of_digits = 3 - value.abs().log10().floor() as i32;
    let of_step = -speed.log10().floor() as i32;
    of_digits.max(of_step).clamp(0, MOST_DECIMALS as i32) as usize
}

/// What was typed before and is not possible, unless the number has changed since.
fn refused_before(ui: &Ui, id: Id, number: &Number<'_>) -> Option<Refused> {
    let refused = ui.data(|data| data.get_temp::<Refused>(id));
    let mut refused = refused.filter(|refused| refused.stays == number.value)?;
    let is_earlier = |since| since != ui.ctx().cumulative_frame_nr();
    if refused.new_since.is_some_and(is_earlier) && goes_on(ui) {
        refused.new_since = None;
        ui.data_mut(|data| data.insert_temp(id, refused.clone()));
    }
    Some(refused)
}

fn forget(ui: &Ui, id: Id) {
    ui.data_mut(|data| data.remove::<Refused>(id));
}

/// What stands behind the number: its unit, unless the text has one.
fn suffix(number: &Number<'_>, empty: Option<(&str, f64)>, is_refused: bool) -> String {
    let symbol = number.unit.symbol;
    match (number.value, empty) {
        _ if is_refused || symbol.is_empty() => String::new(),
        (Some(_), _) => format!(" {symbol}"),
        // In which unit a number is taken that is typed without one.
        (None, Some((text, _))) if !says_unit(text, symbol) => format!(" [{symbol}]"),
        (None, _) => String::new(),
    }
}

/// What follows from what was typed in this frame. What is not possible is kept.
fn edit_of(ui: &Ui, id: Id, number: &Number<'_>, typed: Typed) -> Edit {
    match typed {
        Typed::Nothing => Edit::None,
        Typed::Refused { text, why } => {
            let (stays, new_since) = (number.value, Some(ui.ctx().cumulative_frame_nr()));
            ui.data_mut(|data| data.insert_temp(id, Refused { text, why, stays, new_since }));
            ui.ctx().request_repaint();
            Edit::None
        }
        Typed::Cleared => {
            forget(ui, id);
            if number.value.is_some() { Edit::Cleared } else { Edit::None }
        }
        Typed::Value(value) => {
            forget(ui, id);
            if number.value == Some(value) { Edit::None } else { Edit::Value(value) }
        }
    }
}

/// Whether a text has the symbol of a unit as a word of its own.
fn says_unit(text: &str, symbol: &str) -> bool {
    format!(" {text} ").replace(['(', ')', ','], " ").contains(&format!(" {symbol} "))
}

/// Whether the user does something in this frame: what was said of what was typed before has been seen.
fn goes_on(ui: &Ui) -> bool {
    let is_begun = |event: &Event| {
        matches!(
            event,
            Event::Key { pressed: true, .. }
                | Event::PointerButton { pressed: true, .. }
                | Event::Text(_)
        )
    };
    ui.input(|input| input.events.iter().any(is_begun))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 3400 lb stood as “1542.214 kg” in the form of a car, and a place of 123.45 m as “405.020 ft”.
    #[test]
    fn a_number_from_another_unit_has_no_more_digits_than_it_is_worth() {
        for (value, step, expected) in [
            (3400.0 * 0.453_592_37, 50.0, 0),
            (1542.21, 50.0, 3),
            (123.45 / 0.3048, 0.066, 2),
            (0.1 / 0.3048, 0.066, 3),
            (17.0_f64.to_degrees(), 1.1, 1),
        ] {
            assert_eq!(most_decimals(value, step), expected, "{value}");
        }
    }
}
