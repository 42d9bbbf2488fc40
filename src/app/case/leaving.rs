//! What is asked before the window closes, or another case takes the place of the one that is open.

use egui::{Context, Ui, ViewportCommand};

use crate::app::case::{CaseCommand, Leaving, LeavingStage};
use crate::app::command::Command;
use crate::app::dialog::Dialog;
use crate::app::state::{Session, State};
use crate::app::tasks::TaskKey;
use impactlab_core::data::{Existing, Severity};

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
    /// Goes where the user wants, or asks first if something would be lost. The window closes once what is
    /// being written is in its file.
    pub(in crate::app) fn leave(&mut self, to: Leaving, context: &Context) {
        if to == Leaving::Quit && self.session.tasks.has_writes() {
            self.wait_for_writes(to);
        } else if self.reasons_to_stay(&to).is_empty() {
            self.go(to, context);
        } else {
            self.ask_before_leaving(to, Vec::new());
        }
    }

    /// Asks before something is lost.
    fn ask_before_leaving(&mut self, to: Leaving, failures: Vec<String>) {
        self.session.dialogs.open(Dialog::Leave { to, stage: LeavingStage::Asked { failures } });
    }

    /// Leaves once what is being written is in its file.
    fn wait_for_writes(&mut self, to: Leaving) {
        // Who asks once more waits for the same.
        let before = self.waits_for_writes().map(|(_, n_messages)| n_messages);
        let n_messages = before.unwrap_or(self.session.log.len());
        let stage = LeavingStage::Written { n_messages };
        self.session.dialogs.open(Dialog::Leave { to, stage });
    }

    /// Closes that question.
    fn stay(&mut self) {
        self.session.dialogs.close_if(|dialog| matches!(dialog, Dialog::Leave { .. }));
    }

    /// Goes where the user wants. Who quits though the window waits for what is being written gives it up.
    pub(in crate::app) fn go(&mut self, to: Leaving, context: &Context) {
        let is_given_up = self.waits_for_writes().is_some();
        self.stay();
        match to {
            Leaving::Quit => {
                if is_given_up {
                    self.session.tasks.give_up_writes();
                }
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
            self.wait_for_writes(to);
        }
        self.save_case(path, Existing::Replace);
    }

    /// Where the user goes once what is being written is in its file, with the number of messages there
    /// were before.
    fn waits_for_writes(&self) -> Option<(Leaving, usize)> {
        self.session.dialogs.iter().find_map(|dialog| match dialog {
            Dialog::Leave { to, stage: LeavingStage::Written { n_messages } } => {
                Some((to.clone(), *n_messages))
            }
            _ => None,
        })
    }

    /// Goes on where something was to be written first and now is. If it could not be written, the user is
    /// asked.
    pub(in crate::app) fn leave_if_written(&mut self, context: &Context) {
        let Some((to, n_messages)) = self.waits_for_writes() else { return };
        let tasks = &self.session.tasks;
        let is_written = match to {
            Leaving::Quit => !tasks.has_writes(),
            _ => !tasks.is_running(&TaskKey::SaveCase),
        };
        if !is_written {
            return;
        }
        self.stay();
        let said = self.session.log.iter().skip(n_messages).map(|(_, message)| message);
        let errors = said.filter(|message| message.severity == Severity::Error);
        let failures: Vec<String> = errors.map(|message| message.text.clone()).collect();
        match failures.is_empty() {
            true => self.leave(to, context),
            false => self.ask_before_leaving(to, failures),
        }
    }
}

/// Draws the question before the user leaves, or what is waited for, and adds a command with the answer.
///
/// - `leaving`: where the user goes, and what that waits for.
pub fn leaving_ui(
    ui: &mut Ui,
    (to, stage): (&Leaving, &LeavingStage),
    state: &State,
    commands: &mut Vec<Command>,
) {
    ui.heading(match to {
        Leaving::Quit => "Quit impactlab?",
        Leaving::New
        | Leaving::Pit
        | Leaving::Reconstruction
        | Leaving::Example
        | Leaving::Open(_) => "Leave this case?",
    });
    let leave = Command::Case(CaseCommand::LeaveUnasked(to.clone()));
    let failures = match stage {
        LeavingStage::Asked { failures } => failures,
        LeavingStage::Written { .. } => {
            ui.label(match to {
                Leaving::Quit => "A file is still being written; the window closes once it is.",
                _ => "The case is being saved; the other one opens once it is.",
            });
            ui.separator();
            ui.horizontal(|ui| {
                if *to == Leaving::Quit && ui.button("Quit without waiting").clicked() {
                    commands.push(leave);
                }
                if ui.button("Stay").clicked() {
                    commands.push(Command::CloseDialog);
                }
            });
            return;
        }
    };
    for failure in failures {
        ui.colored_label(ui.visuals().error_fg_color, failure);
    }
    for reason in state.reasons_to_stay(to) {
        ui.label(reason);
    }
    ui.separator();
    ui.horizontal(|ui| {
        if state.is_case_changed() && ui.button("Save the case").clicked() {
            commands.push(Command::Case(CaseCommand::SaveAndLeave));
        }
        if ui.button(to.label()).clicked() {
            commands.push(leave);
        }
        if ui.button("Stay").clicked() {
            commands.push(Command::CloseDialog);
        }
    });
}
