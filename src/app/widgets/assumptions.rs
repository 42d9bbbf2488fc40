//! The list of the values that the program assumed because the question left them open.

use egui::{RichText, Ui};

use crate::study::{AssumedQuantity, Assumption};

/// Lists the assumptions, one wrapped line each. Hovering over a line shows the reason and the
/// place in the window where the user can set the value. An empty list draws nothing.
pub fn assumptions_ui(ui: &mut Ui, assumptions: &[Assumption]) {
    for assumption in assumptions {
        let Assumption { quantity, value, reason } = assumption;
        let text = match quantity {
            AssumedQuantity::NotUsed => format!("not used: {value}"),
            quantity => format!("assumed: {}: {value}", quantity.label()),
        };
        let label = egui::Label::new(RichText::new(text).italics()).wrap();
        let hint = place(*quantity).map_or(String::new(), |place| format!("\n{place}"));
        ui.add(label).on_hover_text(format!("{reason}{hint}"));
    }
}

/// The place in the window where the user sets the quantity instead of having it assumed; `None` for
/// what only a file says.
fn place(quantity: AssumedQuantity) -> Option<&'static str> {
    Some(match quantity {
        AssumedQuantity::Vehicle
        | AssumedQuantity::Bullet
        | AssumedQuantity::Speed
        | AssumedQuantity::ContactPoint => "In this window: the Vehicle pane",
        AssumedQuantity::FirstTouch
        | AssumedQuantity::Restitution
        | AssumedQuantity::ContactHeight
        | AssumedQuantity::Pulse => "In this window: Contact in the Scenario pane",
        AssumedQuantity::VehicleParameter | AssumedQuantity::BulletParameter => {
            "A data sheet that states it: open the file, or drop it here"
        }
        AssumedQuantity::StartOfRecord | AssumedQuantity::Steer | AssumedQuantity::NotUsed => {
            return None;
        }
    })
}
