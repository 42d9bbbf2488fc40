//! Fields of evidence: numbers with their standard deviations, numbers that may be unknown, and ranges.
//!
//! Each draws a row of a grid of four columns.

use egui::{Response, Ui};

use crate::app::widgets::quantity_value;
use impactlab_core::ranges::Range;
use impactlab_core::units::UnitSystem;
use impactlab_reconstruct::evidence::Measured;

/// Number of columns of the grid.
pub const N_COLUMNS: usize = 4;

/// A number with its standard deviation.
pub fn measured_row(
    ui: &mut Ui,
    label: &str,
    measured: &mut Measured,
    (ranges, units): ([&Range; 2], UnitSystem),
) {
    let name = ui.label(label);
    measured_fields(ui, &name, measured, (ranges, units));
}

/// The same for a number that may be unknown, behind a box to check.
///
/// - `usual`: what stands there once the box is checked.
pub fn optional_measured_row(
    ui: &mut Ui,
    label: &str,
    (measured, usual): (&mut Option<Measured>, Measured),
    (ranges, units): ([&Range; 2], UnitSystem),
) {
    let name = switch(ui, label, measured, usual);
    match measured {
        Some(measured) => measured_fields(ui, &name, measured, (ranges, units)),
        None => unknown(ui),
    }
}

/// A number that may be unknown, without a standard deviation.
pub fn optional_row(
    ui: &mut Ui,
    label: &str,
    (value, usual): (&mut Option<f64>, f64),
    (range, units): (&Range, UnitSystem),
) {
    let name = switch(ui, label, value, usual);
    match value {
        Some(value) => {
            quantity_value(ui, value, (range, units)).0.labelled_by(name.id);
            ui.end_row();
        }
        None => unknown(ui),
    }
}

/// A range that may not be given. Neither end goes beyond the other.
pub fn interval_row(
    ui: &mut Ui,
    label: &str,
    (interval, usual): (&mut Option<[f64; 2]>, [f64; 2]),
    (range, units): (&Range, UnitSystem),
) {
    let name = switch(ui, label, interval, usual);
    let Some([low, high]) = interval else { return unknown(ui) };
    let up_to = range.within([range.low, *high]);
    quantity_value(ui, low, (&up_to, units)).0.labelled_by(name.id);
    ui.label("to");
    let from = range.within([*low, range.high]);
    quantity_value(ui, high, (&from, units)).0.labelled_by(name.id);
    ui.end_row();
}

/// A number without a standard deviation that is always there.
pub fn value_row(ui: &mut Ui, label: &str, value: &mut f64, (range, units): (&Range, UnitSystem)) {
    let name = ui.label(label);
    quantity_value(ui, value, (range, units)).0.labelled_by(name.id);
    ui.end_row();
}

fn measured_fields(
    ui: &mut Ui,
    name: &Response,
    Measured { value, sigma }: &mut Measured,
    ([range, of_sigma], units): ([&Range; 2], UnitSystem),
) {
    quantity_value(ui, value, (range, units)).0.labelled_by(name.id);
    let sign = ui.label("±").on_hover_text("One standard deviation");
    quantity_value(ui, sigma, (of_sigma, units)).0.labelled_by(sign.id);
    ui.end_row();
}

fn switch<T>(ui: &mut Ui, label: &str, part: &mut Option<T>, usual: T) -> Response {
    let mut is_known = part.is_some();
    let response = ui.checkbox(&mut is_known, label);
    if response.changed() {
        *part = is_known.then_some(usual);
    }
    response
}

fn unknown(ui: &mut Ui) {
    ui.weak("not known");
    ui.end_row();
}
