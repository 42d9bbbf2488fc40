//! Asks before a case does more than read files in its own folder, and remembers what was allowed.

use std::path::{Path, PathBuf};

use egui::{ScrollArea, Ui};
use serde::{Deserialize, Serialize};

use crate::app::case::CaseCommand;
use crate::app::command::Command;
use crate::app::dialog::Dialog;
use crate::app::model::file_name;
use crate::app::state::State;
use impactlab_study::case_file::Reach;

/// Number of cases of which it is remembered what they may do.
const MAX_TRUSTED: usize = 200;

/// Height of the list of what a case does, points; what is longer scrolls.
const LIST_HEIGHT: f32 = 320.0;

/// A case and what it may do.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct TrustedCase {
    /// Its file.
    path: PathBuf,
    /// What the user has allowed, or has saved in the window.
    reach: Reach,
}

impl State {
    /// Whether a case may do this. If not, the user is asked.
    pub(super) fn may_reach(&mut self, path: &Path, reach: Reach) -> bool {
        let trusted = TrustedCase { path: path.to_owned(), reach };
        let may = trusted.reach.is_empty() || self.view.trusted.contains(&trusted);
        if !may {
            self.session.dialogs.open(Dialog::Trust(Box::new(trusted)));
        }
        may
    }

    /// Remembers what a case may do.
    pub(super) fn trust(&mut self, trusted: TrustedCase) {
        let known = &mut self.view.trusted;
        known.retain(|case| case.path != trusted.path);
        if !trusted.reach.is_empty() {
            known.insert(0, trusted);
            known.truncate(MAX_TRUSTED);
        }
    }

    /// Remembers what a case may do that the user has made.
    pub(super) fn trust_own(&mut self, path: PathBuf, reach: Reach) {
        self.trust(TrustedCase { path, reach });
    }

    /// Allows what the user was asked about, and opens the case.
    pub(super) fn open_trusted(&mut self, trusted: TrustedCase) {
        self.session.dialogs.close_if(|dialog| matches!(dialog, Dialog::Trust(_)));
        let path = trusted.path.clone();
        self.trust(trusted);
        self.open_case(&path);
    }
}

/// Draws the question whether a case may be opened, and adds a command with the answer.
pub fn trust_ui(ui: &mut Ui, trusted: &TrustedCase, commands: &mut Vec<Command>) {
    let TrustedCase { path, reach } = trusted;
    let name = file_name(path);
    ui.heading(format!("Open {name}?"));
    ui.label("This case does more than read the files in its folder:");
    ScrollArea::vertical().max_height(LIST_HEIGHT).show(ui, |ui| {
        for phrase in reach.phrases() {
            ui.label(phrase);
        }
    });
    ui.weak("Open it if you know who made it. Nothing of it was read or written so far.");
    ui.separator();
    ui.horizontal(|ui| {
        if ui.button("Open and allow this").clicked() {
            commands.push(Command::Case(CaseCommand::OpenTrusted(Box::new(trusted.clone()))));
        }
        if ui.button("Do not open").clicked() {
            commands.push(Command::CloseDialog);
        }
    });
}
