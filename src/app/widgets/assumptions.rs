//! The list of the values that the program assumed because the question left them open.

use egui::{CollapsingHeader, Label, RichText, Sense, Ui};
use impactlab_core::uncertainty::{Caveat, CaveatSubject, Caveats};
use impactlab_core::units::UnitSystem;

use crate::app::command::Command;
use crate::app::looks;
use crate::app::panes::Pane;

/// Largest number of assumptions that are listed without a click.
const MAX_OPEN: usize = 6;

/// Lists the assumptions, one beside the other. Hovering over one shows the reason; a click shows
/// the panel in which the user can set the value. An empty list draws nothing; a long one only their number, until it is opened.
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
    let place = |_| Some(("Click to say it in the Evidence pane", Pane::Evidence));
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
    let assumptions: Vec<&Caveat> = caveats.assumptions().collect();
    let list_ui = |ui: &mut Ui, commands: &mut Vec<Command>| {
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing.x = looks::PART * 2.0;
            for assumption in &assumptions {
                let place = assumption.subject.and_then(place);
                assumption_ui(ui, &assumption.in_units(units), place, commands);
            }
        });
    };
    match assumptions.len() {
        0 => return,
        1..=MAX_OPEN => return list_ui(ui, commands),
        _ => {}
    }
    let title = RichText::new(format!("{} assumptions", assumptions.len())).italics();
    let header = CollapsingHeader::new(title).id_salt("assumptions");
    header.show(ui, |ui| list_ui(ui, commands));
}

fn assumption_ui(ui: &mut Ui, assumption: &Caveat, place: Place, commands: &mut Vec<Command>) {
    let text = format!("{}: {}", assumption.kind.label(), assumption.statement());
    let (hint, pane) = match place {
        Some((hint, pane)) => (format!("\n{hint}"), Some(pane)),
        None => (String::new(), None),
    };
    let sense = if pane.is_some() { Sense::click() } else { Sense::hover() };
    let label = Label::new(RichText::new(text).italics()).wrap().sense(sense);
    let reason = assumption.reason.as_deref().unwrap_or_default();
    let line = ui.add(label).on_hover_text(format!("{reason}{hint}"));
    if line.clicked() {
        commands.extend(pane.map(Command::Show));
    }
}

/// How the user sets the subject instead of having it assumed, and the panel in which; `None` for
/// what only a file says.
fn place(subject: CaveatSubject) -> Place {
    Some(match subject {
        CaveatSubject::Vehicle
        | CaveatSubject::Striking
        | CaveatSubject::Speed
        | CaveatSubject::ContactPoint => ("Click to set it in the Vehicle pane", Pane::Vehicle),
        CaveatSubject::FirstTouch
        | CaveatSubject::Restitution
        | CaveatSubject::ContactHeight
        | CaveatSubject::Pulse => ("Click to set it: Contact in the Scenario pane", Pane::Scenario),
        CaveatSubject::VehicleParameter
        | CaveatSubject::StrikingParameter
        | CaveatSubject::RoadFriction => {
            ("Click, and state it in a copy of the vehicle: Edit a copy", Pane::Vehicle)
        }
        CaveatSubject::StartOfRecord | CaveatSubject::Steer => return None,
    })
}
