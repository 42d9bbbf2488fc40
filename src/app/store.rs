//! Stores the state of the application on disk.
//!
//! The state is written about one second after its last change, so that little is lost if the
//! process is killed. It is written to a temporary file that is then renamed, so that the file is
//! never left incomplete.

use std::path::{Path, PathBuf};
use std::time::Duration;

use egui::Context;

use crate::data::{DataError, Existing, write_atomically};
use crate::error_chain;
use crate::jobs::{Job, Update};

/// Time for which the state must not have changed before it is written.
const SETTLING_TIME: Duration = Duration::from_secs(1);

/// The file of the state, what has been written to it, and what is still to be written.
pub struct Store {
    path: PathBuf,
    /// The text that was written last, or the text of the file if nothing has been written yet.
    written: String,
    /// A newer state that has not been written, and the time since which it has not changed, in
    /// seconds of the window's clock.
    pending: Option<(String, f64)>,
    job: Option<Job<Result<(), DataError>>>,
}

impl Store {
    /// Returns a store that keeps the state in this file. Nothing is read or written yet.
    pub fn new(path: PathBuf) -> Self {
        Self { path, written: String::new(), pending: None, job: None }
    }

    /// Reads the state that the last run has left; `None` if there is no readable file.
    pub fn read(&mut self) -> Option<String> {
        self.written = std::fs::read_to_string(&self.path).ok()?;
        Some(self.written.clone())
    }

    /// Receives the state of this frame and writes it in the background once it has not changed for
    /// [`SETTLING_TIME`].
    ///
    /// - `text`: the state as text;
    /// - returns a message for the user if an earlier write has failed.
    pub fn keep(&mut self, text: String, context: &Context) -> Option<String> {
        let failure = self.poll();
        if text == self.written {
            self.pending = None;
            return failure;
        }
        let now = context.input(|input| input.time);
        let since = match &self.pending {
            Some((pending, since)) if *pending == text => *since,
            _ => now,
        };
        if now - since < SETTLING_TIME.as_secs_f64() || self.job.is_some() {
            self.pending = Some((text, since));
            context.request_repaint_after(SETTLING_TIME);
            return failure;
        }
        self.pending = None;
        self.written = text.clone();
        let path = self.path.clone();
        self.job = Job::spawn("save", || {}, move |_| write(&path, &text)).ok();
        failure
    }

    /// Writes the state at the end of the program, on the calling thread.
    pub fn finish(&mut self, text: &str) {
        // The window is closed already, so that an error cannot be shown.
        let _ = write(&self.path, text);
    }

    fn poll(&mut self) -> Option<String> {
        let update = self.job.as_mut()?.poll();
        if matches!(update, Update::Running) {
            return None;
        }
        self.job = None;
        match update {
            Update::Finished(Err(error)) => Some(error_chain(&error)),
            _ => None,
        }
    }
}

fn write(path: &Path, text: &str) -> Result<(), DataError> {
    if let Some(folder) = path.parent() {
        // If the folder cannot be created, writing the file below fails and reports the error.
        let _ = std::fs::create_dir_all(folder);
    }
    write_atomically(path, Existing::Replace, |out| out.write_all(text.as_bytes()))
}
