//! The list of the values that the program assumed because the question left them open.

use egui::{RichText, Ui};

use crate::study::{AssumedQuantity, Assumption};

/// Lists the assumptions, one wrapped line each. Hovering over a line shows the reason and the
/// place in the window where the user can set the value. An empty list draws nothing.
pub fn assumptions_ui(ui: &mut Ui, assumptions: &[Assumption]) {
    for Assumption { quantity, value, reason } in assumptions {
        let text = format!("assumed: {}: {value}", quantity.label());
        let label = egui::Label::new(RichText::new(text).italics()).wrap();
        ui.add(label).on_hover_text(format!("{reason}\n{}", place(*quantity)));
    }
}

/// The place in the window where the user sets the quantity instead of having it assumed.
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
