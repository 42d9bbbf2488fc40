//! Numbers with units.

use std::ops::RangeInclusive;

use egui::{DragValue, Ui};

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
