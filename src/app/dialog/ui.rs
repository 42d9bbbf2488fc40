//! Draws the dialogs within the window.

use egui::{Id, Modal, Ui};

use crate::app::case::{leaving_ui, trust_ui};
use crate::app::command::Command;
use crate::app::dialog::Dialog;
use crate::app::licences::licences_ui;
use crate::app::menu::messages_ui;
use crate::app::panels::{cloud_ui, crash_test_ui, film_ui, models_dialog_ui, recorder_ui};
use crate::app::reading::unread_ui;
use crate::app::replace::replace_ui;
use crate::app::state::State;
use crate::app::tasks::TaskKey;

/// Draws the dialogs that are open and adds a command when the user has answered one. A click beside
/// the uppermost one or Escape closes it.
pub fn dialogs_ui(ui: &mut Ui, state: &mut State, commands: &mut Vec<Command>) {
    let mut open = state.session.dialogs.take();
    for dialog in &mut open {
        let modal = Modal::new(Id::unique(dialog.id()));
        let response = modal.show(ui.ctx(), |ui| dialog_ui(ui, dialog, state, commands));
        if response.should_close() && commands.is_empty() {
            commands.push(Command::CloseDialog);
        }
    }
    state.session.dialogs.put_back(open);
}

impl Dialog {
    /// What the toolkit knows it by.
    fn id(&self) -> &'static str {
        match self {
            Self::Import(_) => "mapping dialog",
            Self::Licences => "licences",
            Self::Messages => "messages",
            Self::Replace(..) => "replace dialog",
            Self::Leave { .. } => "leaving dialog",
            Self::Trust(_) => "trust dialog",
            Self::Unread(_) => "unread dialog",
            Self::Path(_) => "path dialog",
            Self::Models(_) => "models dialog",
            Self::Film(_) => "film dialog",
            Self::Cloud(_) => "cloud dialog",
            Self::CrashTest(_) => "crash test dialog",
            Self::Recorder(_) => "recorder dialog",
        }
    }
}

fn dialog_ui(ui: &mut Ui, dialog: &mut Dialog, state: &mut State, commands: &mut Vec<Command>) {
    match dialog {
        Dialog::Import(dialog) => dialog.ui(ui, commands),
        Dialog::Licences => licences_ui(ui, commands),
        Dialog::Messages => messages_ui(ui, state, commands),
        Dialog::Replace(output, path) => replace_ui(ui, (output, path), commands),
        Dialog::Leave { to, stage } => leaving_ui(ui, (to, stage), state, commands),
        Dialog::Trust(trusted) => trust_ui(ui, trusted, commands),
        Dialog::Unread(paths) => unread_ui(ui, paths, commands),
        Dialog::Path(dialog) => dialog.ui(ui, commands),
        Dialog::Models(dialog) => models_dialog_ui(ui, dialog, commands),
        Dialog::CrashTest(form) => crash_test_ui(ui, form, state.view.units, commands),
        Dialog::Recorder(form) => recorder_ui(ui, form, state.view.units, commands),
        Dialog::Film(form) => {
            let is_busy = state.session.tasks.film().is_some();
            film_ui(ui, form, is_busy, commands);
        }
        Dialog::Cloud(form) => {
            let progress = state.session.tasks.progress(&TaskKey::MakeGround);
            cloud_ui(ui, form, state.view.units, progress.map(|(progress, _)| progress), commands);
        }
    }
}
