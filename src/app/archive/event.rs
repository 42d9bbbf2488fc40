//! What is asked about what is kept, and what tasks have done with it.

use std::path::PathBuf;

use crate::app::archive::{ArchiveEntry, ArchiveList};
use crate::app::unfinished::UnfinishedList;
use impactlab_study::{Answer, CompareReport, EvaluateForceReport, Request};

/// Files that are to be removed together, after a question.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Removal {
    /// What the user knows it by.
    pub name: String,
    /// What it is and what goes with it, one sentence.
    pub what: String,
    /// The files.
    pub files: Vec<PathBuf>,
}

/// A question of the Models pane that the user has to answer.
#[derive(Debug, Clone, PartialEq)]
pub enum ModelsDialog {
    /// What an entry is to be called.
    Rename {
        /// The entry.
        entry: Box<ArchiveEntry>,
        /// The name as typed so far.
        name: String,
    },
    /// Whether files are to be removed.
    Remove(Removal),
}

/// What a task has done with what is kept.
#[derive(Clone)]
pub enum ArchiveEvent {
    /// The list was read.
    Listed(Result<ArchiveList, String>),
    /// An entry was written, anew or with another name.
    Put(Result<ArchiveEntry, String>),
    /// Files were removed.
    Removed(Result<Removal, String>),
    /// A comparison or an evaluation was read.
    Opened(Result<OpenedResult, String>),
    /// The list of trainings that have not ended was read.
    Trainings(Result<UnfinishedList, String>),
}

/// A comparison or an evaluation that is shown again.
#[derive(Clone)]
pub enum OpenedResult {
    /// A comparison of response models, or the evaluation of one.
    Comparison(Box<Answer<CompareReport>>),
    /// An evaluation of a force model, with its question.
    ForceEvaluation(Box<(Request, Answer<EvaluateForceReport>)>),
}
