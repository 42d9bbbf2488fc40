//! Writes the note of a training while it runs.

use std::path::{Path, PathBuf};

use crate::app::archive::NOTE_ENDING;
use crate::app::unfinished::note::TrainingNote;
use impactlab_core::data::{Existing, write_bytes};
use impactlab_core::error_chain;
use impactlab_networks::learning::TrainingReport;

/// Writes the note of a training while it runs, on its thread.
pub struct TrainingDiary {
    checkpoint: PathBuf,
    note: TrainingNote,
}

impl TrainingDiary {
    /// The diary of a training with a checkpoint.
    pub fn new(checkpoint: PathBuf, note: TrainingNote) -> Self {
        Self { checkpoint, note }
    }

    /// Returns the checkpoint.
    pub fn checkpoint(&self) -> &Path {
        &self.checkpoint
    }

    /// Writes the note before the training begins.
    ///
    /// # Errors
    /// A message for the user, if the folder or the note cannot be written.
    pub fn begin(&self) -> Result<(), String> {
        if let Some(folder) = self.checkpoint.parent() {
            let failed = |error| format!("{}: {error}", folder.display());
            std::fs::create_dir_all(folder).map_err(failed)?;
        }
        self.write()
    }

    /// Adds the planned number of epochs to the note once it is known.
    pub fn record(&mut self, report: &TrainingReport) {
        if let TrainingReport::Epoch(epoch) = report
            && self.note.plan.is_none()
        {
            self.note.plan = Some([epoch.n_before, epoch.n_epochs]);
            // The training itself does not depend on it, and the note of the beginning stays.
            let _ = self.write();
        }
    }

    /// Ends the diary of a training that has ended or was stopped. Where there is no checkpoint,
    /// nothing can go on, and the note is removed.
    pub fn end(mut self, is_cancelled: bool) {
        if !self.checkpoint.exists() {
            let _ = std::fs::remove_file(self.checkpoint.with_extension(NOTE_ENDING));
        } else if is_cancelled {
            self.note.is_cancelled = true;
            let _ = self.write();
        }
    }

    fn write(&self) -> Result<(), String> {
        let path = self.checkpoint.with_extension(NOTE_ENDING);
        let text = serde_json::to_string_pretty(&self.note).map_err(|error| error.to_string())?;
        write_bytes(&path, Existing::Replace, text.as_bytes()).map_err(|error| error_chain(&error))
    }
}
