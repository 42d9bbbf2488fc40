//! A model in use, and what tasks make of models.

use std::path::PathBuf;
use std::sync::Arc;

use crate::app::archive::ArchiveEntry;
use impactlab_study::ModelChoice;

/// A model in use or ready for use, and its origin.
pub struct CurrentModel<M> {
    /// The reference to the model in questions.
    pub choice: ModelChoice,
    /// The model.
    pub model: Arc<M>,
    /// The name that is shown: the name of the file, “shipped”, or a description of the training.
    pub name: String,
    /// Whether the model is stored in a file or is the shipped one.
    pub is_saved: bool,
}

impl<M> Clone for CurrentModel<M> {
    fn clone(&self) -> Self {
        let Self { choice, model, name, is_saved } = self;
        let (choice, model, name) = (choice.clone(), Arc::clone(model), name.clone());
        Self { choice, model, name, is_saved: *is_saved }
    }
}

/// What a task has made of a model, which need not be the one in use any more.
pub enum ModelEvent<M> {
    /// The model that the project requests was read, or why it could not be.
    Loaded(Result<CurrentModel<M>, String>),
    /// The model is in this file of the user now, or why it is not.
    Saved(Arc<M>, Result<PathBuf, String>),
    /// The model is kept in this file of the user's data folder now, or why it is not, with its name.
    Archived(Arc<M>, Result<(ArchiveEntry, PathBuf), String>),
}

/// What the user has to know of it.
pub enum ModelNews {
    /// Nothing.
    Nothing,
    /// A model could not be read.
    Problem(String),
    /// A model was written, or could not be.
    Saved(Result<PathBuf, String>),
    /// A model is kept, or could not be.
    Archived(Result<ArchiveEntry, String>),
}
