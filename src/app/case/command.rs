//! Actions on the case, and what is saved of it.

use std::path::PathBuf;

use crate::app::case::trust::TrustedCase;
use crate::app::found::Found;
use impactlab_study::case_file::{CaseFile, Change, Reach};

/// An action on the case as a whole.
#[derive(Debug, Clone)]
pub enum CaseCommand {
    /// Write the case to its file; asks for one if it has none.
    Save,
    /// Save the case and go where the user was asked about.
    SaveAndLeave,
    /// Quit, or begin or open another case, after asking if something would be lost.
    Leave(Leaving),
    /// The same without asking.
    LeaveUnasked(Leaving),
    /// Allow what a case does beyond reading files in its folder, and open it.
    OpenTrusted(Box<TrustedCase>),
    /// Say what has become of the files of the case with this file.
    Changed(PathBuf, Vec<Change>),
    /// Take the case that was written, or say why it was not.
    Saved(Result<Found<SavedCase>, String>),
    /// Write down that the case was packed, or say why it was not.
    Packed(Result<PackedCase, String>),
}

/// An action on the variants of the case.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum VariantCommand {
    /// Show another variant.
    Show(String),
    /// Make a copy of the variant that is shown, and show it.
    Duplicate,
    /// Give the variant that is shown another name.
    Rename(String),
    /// Write notes about a variant.
    Note {
        /// The variant.
        name: String,
        /// All that is to be known about it.
        notes: String,
    },
    /// Remove the variant that is shown.
    Remove,
}

/// Where the user goes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Leaving {
    /// The window closes.
    Quit,
    /// A new case.
    New,
    /// A new case with a PIT, ready to play.
    Pit,
    /// A new case, to be reconstructed from what was found.
    Reconstruction,
    /// The finished example case that comes with the program.
    Example,
    /// Another case.
    Open(PathBuf),
}

/// What the way to where the user goes waits for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum LeavingStage {
    /// For the user's answer, since something would be lost.
    Asked {
        /// Why something that was to be written first is in no file.
        failures: Vec<String>,
    },
    /// For what is being written.
    Written {
        /// How many messages there were before.
        n_messages: usize,
    },
}

/// A case that was written.
#[derive(Debug, Clone)]
pub struct SavedCase {
    /// The case as it is in its file.
    pub(super) file: CaseFile,
    /// Its file.
    pub(super) path: PathBuf,
    /// The text of the file.
    pub(super) on_disk: String,
    /// What it does beyond reading files in its own folder.
    pub(super) reach: Reach,
    /// What the case holds.
    pub(super) fingerprint: String,
    /// Which of the cases of the window it is, by `Session::n_cases`.
    pub(super) n_cases: u64,
    /// How many entries the log of the case had before the save was noted.
    pub(super) n_noted: usize,
}

/// A case that was packed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PackedCase {
    /// What the log has of it.
    pub(super) event: String,
    /// What the user is told.
    pub(super) message: String,
    /// Which of the cases of the window it is, by `Session::n_cases`.
    pub(super) n_cases: u64,
}
