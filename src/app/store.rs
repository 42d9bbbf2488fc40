//! Keeps the state on disk: a moment after every change, so that a kill loses nothing, and by a
//! temporary name, so that a kill leaves no half file.

use std::path::{Path, PathBuf};
use std::time::Duration;

use egui::Context;

use crate::data::{DataError, write_atomically};
use crate::error_chain;
use crate::jobs::{Job, Update};

/// How long the state must have been as it is before it is written.
const SETTLING_TIME: Duration = Duration::from_secs(1);

/// Where the state is kept, and what of it is there.
pub struct Store {
    path: PathBuf,
    written: String,
    /// A newer state, and since when it is so, s of the window's clock.
    pending: Option<(String, f64)>,
    job: Option<Job<Result<(), DataError>>>,
}

impl Store {
    /// Keeps the state in this file.
    pub fn new(path: PathBuf) -> Self {
        Self { path, written: String::new(), pending: None, job: None }
    }

    /// What the last run left; `None` at the first.
    pub fn read(&mut self) -> Option<String> {
        self.written = std::fs::read_to_string(&self.path).ok()?;
        Some(self.written.clone())
    }

    /// Takes in the state of this frame and writes it once it has settled. An error is for the
    /// user.
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

    /// Writes what has not been written, at the end.
    pub fn finish(&mut self, text: &str) {
        // Nobody is left to tell.
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
        // If this fails, writing says so.
        let _ = std::fs::create_dir_all(folder);
    }
    write_atomically(path, |out| out.write_all(text.as_bytes()))
}
