//! What an answer rests on that nobody said.

use egui::{RichText, Ui};

use crate::study::{AssumedQuantity, Assumption};

/// Lists what was assumed in a line; the reason is told on hover. Draws nothing without assumptions.
pub fn assumptions_ui(ui: &mut Ui, assumptions: &[Assumption]) {
    for Assumption { quantity, value, reason } in assumptions {
        let text = format!("assumed: {}: {value}", quantity.label());
        let label = egui::Label::new(RichText::new(text).italics()).wrap();
        ui.add(label).on_hover_text(format!("{reason}\n{}", place(*quantity)));
    }
}

/// Where the user says it.
fn place(quantity: AssumedQuantity) -> &'static str {
    match quantity {
        AssumedQuantity::Vehicle
        | AssumedQuantity::Bullet
        | AssumedQuantity::Speed
        | AssumedQuantity::ContactPoint => "In this window: the Vehicle pane",
        AssumedQuantity::ContactHeight | AssumedQuantity::Pulse => {
            "In this window: Contact in the Scenario pane"
        }
    }
}
