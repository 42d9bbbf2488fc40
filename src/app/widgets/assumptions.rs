//! The list of the values that the program assumed because the question left them open.

use egui::{CollapsingHeader, Grid, Label, Response, RichText, Ui};
use impactlab_core::uncertainty::{Caveat, CaveatSubject, Caveats};
use impactlab_core::units::UnitSystem;
use impactlab_document::report::without_options;

use crate::app::command::Command;
use crate::app::panes::Pane;

/// Largest number of assumptions that are listed without a click.
const MAX_OPEN: usize = 3;
/// Width of what an assumption is about and of the button beside it, points.
const NAME_WIDTH: f32 = 120.0;
const CHANGE_WIDTH: f32 = 80.0;
/// Least width of a value or a reason, points.
const LEAST_TEXT_WIDTH: f32 = 150.0;
/// Share of the value in the room that it has with the reason.
const VALUE_SHARE: f32 = 0.45;

/// Draws the assumptions as a table of what, value, reason, and the button that shows the panel in which the
/// user can set the value. An empty list draws nothing; a long one only their number, until it is opened.
pub fn assumptions_ui(
    ui: &mut Ui,
    caveats: &Caveats,
    units: UnitSystem,
    commands: &mut Vec<Command>,
) {
    assumptions_at_ui(ui, (caveats, units), place, commands);
}

/// The same for a reconstruction, whose evidence says all of them.
pub fn evidence_assumptions_ui(
    ui: &mut Ui,
    caveats: &Caveats,
    units: UnitSystem,
    commands: &mut Vec<Command>,
) {
    let place = |_| Some(("Say it in the Evidence pane", Pane::Evidence));
    assumptions_at_ui(ui, (caveats, units), place, commands);
}

/// The same for the replay of a recorder, whose own pane says all but the vehicle.
pub fn replay_assumptions_ui(
    ui: &mut Ui,
    caveats: &Caveats,
    units: UnitSystem,
    commands: &mut Vec<Command>,
) {
    let place = |subject: CaveatSubject| match subject {
        CaveatSubject::VehicleParameter => place(subject),
        _ => None,
    };
    assumptions_at_ui(ui, (caveats, units), place, commands);
}

/// Where a subject is set, as [`place`] says it.
type Place = Option<(&'static str, Pane)>;

fn assumptions_at_ui(
    ui: &mut Ui,
    (caveats, units): (&Caveats, UnitSystem),
    place: fn(CaveatSubject) -> Place,
    commands: &mut Vec<Command>,
) {
    let assumptions: Vec<Caveat> =
        caveats.assumptions().map(|assumption| assumption.in_units(units)).collect();
    match assumptions.len() {
        0 => return,
        1..=MAX_OPEN => return table_ui(ui, &assumptions, place, commands),
        _ => {}
    }
    let title = RichText::new(format!("{} assumptions", assumptions.len())).italics();
    let header = CollapsingHeader::new(title).id_salt("assumptions");
    header.show(ui, |ui| table_ui(ui, &assumptions, place, commands));
}

/// Draws a row for each assumption: of what, its value, why, and the button that leads to where it is set.
/// Where the pane is narrow the reason is shown on hovering alone.
fn table_ui(
    ui: &mut Ui,
    assumptions: &[Caveat],
    place: fn(CaveatSubject) -> Place,
    commands: &mut Vec<Command>,
) {
    let room = (ui.available_width() - CHANGE_WIDTH - NAME_WIDTH).max(LEAST_TEXT_WIDTH);
    let has_reasons = room > 2.0 * LEAST_TEXT_WIDTH;
    let width = if has_reasons { room * VALUE_SHARE } else { room };
    let id = ("assumptions", ui.next_auto_id());
    Grid::new(id).num_columns(4).striped(true).show(ui, |ui| {
        for assumption in assumptions {
            let reason = &reason(assumption);
            cell_ui(ui, NAME_WIDTH, RichText::new(name(assumption)).italics());
            let value = cell_ui(ui, width, RichText::new(&assumption.text));
            if has_reasons {
                cell_ui(ui, room - width, RichText::new(reason).weak());
            } else if !reason.is_empty() {
                value.on_hover_text(reason);
            }
            if let Some((hint, pane)) = assumption.subject.and_then(place)
                && ui.small_button("Change").on_hover_text(hint).clicked()
            {
                commands.push(Command::Show(pane));
            }
            ui.end_row();
        }
    });
}

/// What an assumption is about.
fn name(assumption: &Caveat) -> String {
    let kind = assumption.kind.label();
    assumption.subject.map_or(kind.to_owned(), |subject| format!("{kind}: {}", subject.label()))
}

/// Why it is assumed. How another value is given, the button beside it says; an option of the command line does
/// not.
fn reason(assumption: &Caveat) -> String {
    without_options(assumption.reason.as_deref().unwrap_or_default())
}

/// Draws a text in a cell of a grid, which it does not widen.
fn cell_ui(ui: &mut Ui, width: f32, text: RichText) -> Response {
    let cell = ui.vertical(|ui| {
        ui.set_max_width(width);
        ui.add(Label::new(text).wrap())
    });
    cell.inner
}

/// How the user sets the subject instead of having it assumed, and the panel in which; `None` for
/// what only a file says.
fn place(subject: CaveatSubject) -> Place {
    Some(match subject {
        CaveatSubject::Vehicle
        | CaveatSubject::Driven
        | CaveatSubject::Striking
        | CaveatSubject::Speed
        | CaveatSubject::ContactPoint => ("Set it in the Vehicle pane", Pane::Vehicle),
        CaveatSubject::FirstTouch
        | CaveatSubject::Restitution
        | CaveatSubject::ContactHeight
        | CaveatSubject::Pulse => ("Set it: Contact in the Scenario pane", Pane::Scenario),
        CaveatSubject::VehicleParameter
        | CaveatSubject::StrikingParameter
        | CaveatSubject::RoadFriction => {
            ("State it in a copy of the vehicle: Edit a copy", Pane::Vehicle)
        }
        CaveatSubject::StartOfRecord
        | CaveatSubject::Steer
        | CaveatSubject::Start
        | CaveatSubject::Wheels => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// “another one: --vehicle” stood beside the button that sets it.
    #[test]
    fn no_option_of_the_command_line_stands_in_the_window() {
        let why = "no vehicle was named; another one: --vehicle";
        let assumption = Caveat::assumed(CaveatSubject::Vehicle, "reference-2000", why);
        assert_eq!(reason(&assumption), "no vehicle was named");
    }
}
