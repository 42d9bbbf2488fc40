//! What is asked before the window closes, or another case takes the place of the one that is open.

use egui::{Context, Ui, ViewportCommand};

use crate::app::case::{CaseCommand, Leaving};
use crate::app::command::Command;
use crate::app::dialog::Dialog;
use crate::app::state::{Session, State};
use crate::app::tasks::TaskKey;
use impactlab_core::data::Existing;

impl Leaving {
    /// What the button says that goes there without saving.
    fn label(&self) -> &'static str {
        match self {
            Self::Quit => "Quit",
            Self::New | Self::Pit | Self::Reconstruction | Self::Example | Self::Open(_) => {
                "Go on without saving"
            }
        }
    }
}

impl State {
    /// Goes where the user wants, or asks first if something would be lost.
    pub(in crate::app) fn leave(&mut self, to: Leaving, context: &Context) {
        let reasons = self.reasons_to_stay(&to);
        if reasons.is_empty() {
            self.go(to, context);
        } else {
            self.ask_before_leaving(to);
        }
    }

    /// Asks before something is lost.
    pub(in crate::app) fn ask_before_leaving(&mut self, to: Leaving) {
        self.session.dialogs.open(Dialog::Leave { to, once_saved: false });
    }

    /// Closes that question.
    pub(in crate::app) fn stay(&mut self) {
        self.session.dialogs.close_if(|dialog| matches!(dialog, Dialog::Leave { .. }));
    }

    /// Goes where the user wants.
    pub(in crate::app) fn go(&mut self, to: Leaving, context: &Context) {
        self.stay();
        match to {
            Leaving::Quit => {
                self.session.may_close = true;
                context.send_viewport_cmd(ViewportCommand::Close);
            }
            Leaving::New => self.new_case(),
            Leaving::Pit => self.open_pit(),
            Leaving::Reconstruction => self.begin_reconstruction(),
            Leaving::Example => self.open_example(),
            Leaving::Open(path) => self.open_case(&path),
        }
    }

    /// What would be lost or stopped, one sentence each. A case without a file is kept over a restart, by the
    /// window that keeps its state.
    pub fn reasons_to_stay(&self, to: &Leaving) -> Vec<String> {
        let mut reasons = Vec::new();
        let is_quit = *to == Leaving::Quit;
        let has_file = self.case.path.is_some();
        let is_kept = is_quit && !has_file && self.session.keeps_state;
        if self.is_case_changed() && !is_kept {
            let name = &self.case.file.name;
            reasons.push(match is_quit && !has_file {
                true => format!(
                    "The case {name:?} is in no file, and this window keeps nothing for the next start."
                ),
                false => format!("The case {name:?} has changes that are not in its file."),
            });
        }
        if !is_quit {
            return reasons;
        }
        let Session { force, response, replays, tasks, reconstruction, report, .. } = &self.session;
        let is_replaying = self.session.recorder_replay.is_running();
        for (is_running, what) in [
            (force.training.run.is_running(), "The training of the force network"),
            (response.training.run.is_running(), "The training of the response network"),
        ] {
            if is_running {
                reasons.push(format!(
                    "{what} is stopped; it can be resumed from its last checkpoint."
                ));
            }
        }
        for (is_running, what) in [
            (response.comparison.progress().is_some(), "A comparison or evaluation"),
            (force.evaluation.is_running(), "The evaluation of the force network"),
            (reconstruction.run.is_running(), "The reconstruction"),
            (is_replaying, "The replay of a recorder"),
            (report.is_running, "The report that is being made"),
            (
                replays.values().any(|replay| replay.question.is_running()),
                "The simulation of a data set",
            ),
        ] {
            if is_running {
                reasons.push(format!("{what} is stopped, and what it has found is lost."));
            }
        }
        for (is_keeping, unsaved, what) in [
            (force.model.is_keeping(), force.model.unsaved(), "force model"),
            (response.model.is_keeping(), response.model.unsaved(), "response model"),
        ] {
            if is_keeping {
                reasons.push(format!("A {what} that was trained is still being written."));
            } else if let Some(name) = unsaved {
                reasons.push(format!("The {what} {name:?} is in no file and is lost."));
            }
        }
        if tasks.is_running(&TaskKey::Sweep) {
            reasons.push(
                "The sweep is stopped; its finished chunks stay, and it goes on from them."
                    .to_owned(),
            );
        }
        if tasks.film().is_some() {
            reasons.push("A film that is being made is stopped and not written.".to_owned());
        }
        if tasks.is_writing() || tasks.is_running(&TaskKey::SaveCase) {
            reasons.push("A file is still being written; the window closes once it is.".to_owned());
        }
        reasons
    }

    /// Saves the case to its own file and goes on once that is done; asks for a file if it has none.
    pub(in crate::app) fn save_and_leave(&mut self) {
        let own = self.case.path.clone().filter(|_| !self.is_case_file_foreign());
        let Some(path) = own else {
            self.stay();
            return self.save_to_own_file();
        };
        let open = self.session.dialogs.iter().find_map(|dialog| match dialog {
            Dialog::Leave { to, .. } => Some(to.clone()),
            _ => None,
        });
        if let Some(to) = open {
            self.session.dialogs.open(Dialog::Leave { to, once_saved: true });
        }
        self.save_case(path, Existing::Replace);
    }

    /// Goes on where a case was to be saved first and now is.
    pub(in crate::app) fn leave_if_saved(&mut self, context: &Context) {
        if self.session.tasks.is_running(&TaskKey::SaveCase) {
            return;
        }
        let waiting = self.session.dialogs.iter().find_map(|dialog| match dialog {
            Dialog::Leave { to, once_saved: true } => Some(to.clone()),
            _ => None,
        });
        if let Some(to) = waiting {
            self.stay();
            self.leave(to, context);
        }
    }
}

/// Draws the question before the user leaves, and adds a command with the answer.
pub fn leaving_ui(ui: &mut Ui, to: &Leaving, state: &State, commands: &mut Vec<Command>) {
    ui.heading(match to {
        Leaving::Quit => "Quit impactlab?",
        Leaving::New
        | Leaving::Pit
        | Leaving::Reconstruction
        | Leaving::Example
        | Leaving::Open(_) => "Leave this case?",
    });
    for reason in state.reasons_to_stay(to) {
        ui.label(reason);
    }
    ui.separator();
    ui.horizontal(|ui| {
        if state.is_case_changed() && ui.button("Save the case").clicked() {
            commands.push(Command::Case(CaseCommand::SaveAndLeave));
        }
        if ui.button(to.label()).clicked() {
            commands.push(Command::Case(CaseCommand::LeaveUnasked(to.clone())));
        }
        if ui.button("Stay").clicked() {
            commands.push(Command::CloseDialog);
        }
    });
}
