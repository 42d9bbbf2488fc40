//! Data that were opened while the variant asks about something else: they lie beside it until the user
//! takes them into it.

use egui::{Panel, Ui};

use crate::app::command::Command;
use crate::app::looks::{self, Icon};
use crate::app::model::file_name;
use crate::app::state::{State, Subject};

impl State {
    /// Offers what was opened to the variant; a variant that asks about nothing takes it at once.
    pub(super) fn offer(&mut self, offered: Subject) {
        if let Subject::Case { dataset, .. } = &offered {
            self.view.listed = Some(dataset.clone());
        }
        match self.project.subject() {
            None => self.select(offered),
            Some(now) if now.source() == offered.source() => {}
            Some(_) => self.session.offered = Some(offered),
        }
    }
}

impl Subject {
    /// The folder or file that it is from; `None` for what stands in the variant itself.
    fn source(&self) -> Option<&std::path::Path> {
        match self {
            Self::Case { dataset, .. } => Some(dataset),
            Self::File(path) => Some(path),
            Self::Manoeuvre | Self::Scenario => None,
        }
    }
}

/// Draws what is open beside the variant, and how to take it into the variant.
pub fn offer_ui(ui: &mut Ui, state: &State, commands: &mut Vec<Command>) {
    let (Some(offered), Some(now)) = (&state.session.offered, state.project.subject()) else {
        return;
    };
    let [offered_name, now_name] = [offered, &now].map(|subject| state.name_of(subject));
    let said = match offered {
        Subject::File(path) => state.session.said_of_files.get(path),
        _ => None,
    };
    Panel::top("offer").show(ui, |ui| {
        ui.horizontal_wrapped(|ui| {
            looks::icon_ui(ui, Icon::Info, ui.visuals().hyperlink_color);
            ui.label(format!("{offered_name} is open beside this variant, which asks about {now_name}."));
            if let Some(said) = said {
                let said = said.text(state.view.units);
                ui.label(format!("With it come the struck vehicle and its start as said: {said}."));
            }
            let hint = format!(
                "The variant then asks about {offered_name} in place of {now_name}. Undo brings that back"
            );
            if ui.button("Use in this variant").on_hover_text(hint).clicked() {
                commands.push(Command::Select(offered.clone()));
            }
            if ui.button("Leave it beside").clicked() {
                commands.push(Command::DeclineOffer);
            }
        });
    });
}

impl State {
    /// What a subject is called.
    pub(super) fn name_of(&self, subject: &Subject) -> String {
        match subject {
            Subject::Case { dataset, case } => format!("{case} of {}", file_name(dataset)),
            Subject::File(path) => file_name(path),
            Subject::Manoeuvre => "a manoeuvre".to_owned(),
            Subject::Scenario => {
                let name = self.project.scenario().map(|scenario| scenario.name.as_str());
                match name.filter(|name| !name.is_empty()) {
                    Some(name) => format!("the scenario {name}"),
                    None => "its scenario".to_owned(),
                }
            }
        }
    }
}
