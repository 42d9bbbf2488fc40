//! The dialogs that are open in the window, one over the other. All keys belong to the uppermost one.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};

use crate::app::archive::ModelsDialog;
use crate::app::case::{Leaving, LeavingStage, TrustedCase};
use crate::app::crash_test::CrashTestForm;
use crate::app::dialog::PathDialog;
use crate::app::film::FilmForm;
use crate::app::ground::CloudForm;
use crate::app::import::ImportDialog;
use crate::app::output::Output;
use crate::app::recorder::RecorderForm;

/// A dialog within the window.
pub enum Dialog {
    /// How a file is to be read.
    Import(Box<ImportDialog>),
    /// The licences of third parties.
    Licences,
    /// All messages since the start.
    Messages,
    /// Whether what exists at the path may be replaced.
    Replace(Output, PathBuf),
    /// Whether to leave, though something would be lost.
    Leave {
        /// Where the user goes.
        to: Leaving,
        /// What that still waits for.
        stage: LeavingStage,
    },
    /// Whether a case may do more than read files in its own folder.
    Trust(Box<TrustedCase>),
    /// Whether to open what was being read when the program last ended without a word.
    Unread(Vec<PathBuf>),
    /// For a path, where the desktop has no file dialog.
    Path(PathDialog),
    /// A name, or whether to remove something, in the Models pane.
    Models(ModelsDialog),
    /// How a film of the scene is to be made.
    Film(Box<FilmForm>),
    /// How a point cloud becomes a ground.
    Cloud(Box<CloudForm>),
    /// What of a crash test a vehicle gets.
    CrashTest(Box<CrashTestForm>),
    /// What of an event data recorder becomes evidence.
    Recorder(Box<RecorderForm>),
}

/// The dialogs that are open, the uppermost last.
#[derive(Default)]
pub struct Dialogs {
    stack: Vec<Dialog>,
    /// The files about which the import dialog asks next, in the order of opening.
    pub to_import: VecDeque<PathBuf>,
}

impl Dialogs {
    /// Opens a dialog over the others. One of the same kind that is open already is closed.
    pub fn open(&mut self, dialog: Dialog) {
        let kind = std::mem::discriminant(&dialog);
        self.stack.retain(|other| std::mem::discriminant(other) != kind);
        self.stack.push(dialog);
    }

    /// Closes the uppermost dialog and returns it.
    pub fn close(&mut self) -> Option<Dialog> {
        self.stack.pop()
    }

    /// Closes every dialog for which `is_meant` holds.
    pub fn close_if(&mut self, is_meant: impl Fn(&Dialog) -> bool) {
        self.stack.retain(|dialog| !is_meant(dialog));
    }

    /// Whether a dialog is open, to which all keys belong.
    pub fn is_any_open(&self) -> bool {
        !self.stack.is_empty()
    }

    /// The dialogs that are open, the uppermost last.
    pub fn iter(&self) -> impl Iterator<Item = &Dialog> {
        self.stack.iter()
    }

    /// Takes the dialogs out, so that they can be drawn beside the state.
    pub(super) fn take(&mut self) -> Vec<Dialog> {
        std::mem::take(&mut self.stack)
    }

    /// Puts them back, below those that were opened meanwhile.
    pub(super) fn put_back(&mut self, mut stack: Vec<Dialog>) {
        stack.append(&mut self.stack);
        self.stack = stack;
    }

    /// The dialog for the columns of a file, if it is open.
    pub fn import(&self) -> Option<&ImportDialog> {
        self.iter().find_map(|dialog| match dialog {
            Dialog::Import(dialog) => Some(&**dialog),
            _ => None,
        })
    }

    /// The same, to be changed.
    pub fn import_mut(&mut self) -> Option<&mut ImportDialog> {
        self.stack.iter_mut().find_map(|dialog| match dialog {
            Dialog::Import(dialog) => Some(&mut **dialog),
            _ => None,
        })
    }

    /// The path of which the user is asked whether what exists there may be replaced.
    pub fn replacing(&self) -> Option<&Path> {
        self.iter().find_map(|dialog| match dialog {
            Dialog::Replace(_, path) => Some(path.as_path()),
            _ => None,
        })
    }

    /// The form of a film, if it is open.
    pub fn film(&self) -> Option<&FilmForm> {
        self.iter().find_map(|dialog| match dialog {
            Dialog::Film(form) => Some(&**form),
            _ => None,
        })
    }
}
