//! Stores the state of the application on disk.
//!
//! The state is written about one second after a change, also while it goes on changing, so that little
//! is lost if the process is killed. It is written to a temporary file that is then renamed, so that the file is
//! never left incomplete.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::time::Duration;

use egui::Context;

use crate::app::state::State;
use impactlab_core::data::write::WriterLock;
use impactlab_core::data::{DataError, Existing, MAX_RESULTS_BYTES, read_utf8, write_bytes};
use impactlab_core::error_chain;
use impactlab_core::jobs::{Job, Update};

/// Time from the first change that is not written yet until it is: what is changed all the time is
/// written as often.
const WRITING_TIME: Duration = Duration::from_secs(1);

/// The file of the state, what has been written to it, and what is still to be written.
pub struct Store {
    path: PathBuf,
    /// Keeps other windows from storing their state in the same file.
    _lock: WriterLock,
    /// The text that was written last, or the text of the file if nothing has been written yet.
    written: String,
    /// Time of the first change that has not been written, in seconds of the window's clock.
    pending_since: Option<f64>,
    job: Option<Job<Result<(), DataError>>>,
    /// Whether the last write has failed.
    is_failing: bool,
}

/// What is known at the start of the program of the state that the last run has stored.
#[derive(Default)]
pub struct OpenedState {
    /// Where this window stores its state; `None` if it stores nothing.
    pub store: Option<Store>,
    /// The state of the last run and the paths that were open; `None` if there is none that can be
    /// restored.
    pub restored: Option<(State, Vec<PathBuf>)>,
    /// What the user has to know of it.
    pub message: Option<String>,
}

/// Opens the file of the state and restores what is in it. Nothing in it is ever lost: a state that
/// cannot be restored is renamed, and one of a later version of the program stays as it is.
///
/// - `path`: the file; `None` stores nothing.
pub fn open_state(path: Option<PathBuf>) -> OpenedState {
    let Some(path) = path else { return OpenedState::default() };
    let store = match Store::open(path.clone()) {
        Ok(store) => store,
        Err(error) => {
            let restored = read_utf8(&path, MAX_RESULTS_BYTES).ok();
            let restored = restored.and_then(|text| State::restore(&text).ok());
            let why = error_chain(&error);
            let message = format!("what is changed in this window will not be kept ({why})");
            return OpenedState { store: None, restored, message: Some(message) };
        }
    };
    store.restore()
}

impl Store {
    /// Takes the file for this window. Nothing is read or written yet.
    ///
    /// # Errors
    /// [`DataError`] if another window stores its state there, or if nothing can be written there.
    fn open(path: PathBuf) -> Result<Self, DataError> {
        if let Some(folder) = path.parent() {
            // If the folder cannot be created, taking the lock fails and reports the error.
            let _ = std::fs::create_dir_all(folder).and_then(|()| keep_private(folder));
        }
        let lock = WriterLock::lock_file(&path)?;
        let (written, pending_since, job) = (String::new(), None, None);
        Ok(Self { path, _lock: lock, written, pending_since, job, is_failing: false })
    }

    /// Restores the state that is in the file.
    fn restore(mut self) -> OpenedState {
        let why = match read_utf8(&self.path, MAX_RESULTS_BYTES) {
            Err(DataError::NotFound { .. }) => {
                return OpenedState { store: Some(self), ..OpenedState::default() };
            }
            Err(DataError::Io { source, .. }) if source.kind() == ErrorKind::InvalidData => {
                error_chain(&source)
            }
            Err(error) => {
                let why = error_chain(&error);
                let message = format!("what is changed in this window will not be kept ({why})");
                return OpenedState { message: Some(message), ..OpenedState::default() };
            }
            Ok(text) => match State::restore(&text) {
                Ok(restored) => {
                    self.written = text;
                    return OpenedState {
                        store: Some(self),
                        restored: Some(restored),
                        message: None,
                    };
                }
                Err(error) if error.is_of_later_version() => {
                    let message = format!(
                        "{} was stored by a later version of the program ({error}); it stays as \
                         it is, and what is changed in this window will not be kept",
                        self.path.display()
                    );
                    return OpenedState { message: Some(message), ..OpenedState::default() };
                }
                Err(error) => error_chain(&error),
            },
        };
        self.set_aside(&why)
    }

    /// Renames the file, so that its content is kept, and says so.
    ///
    /// - `why`: the reason why it cannot be restored.
    fn set_aside(self, why: &str) -> OpenedState {
        let (path, renamed) = (self.path.display(), free_name(&self.path));
        match std::fs::rename(&self.path, &renamed) {
            Ok(()) => {
                let message = format!(
                    "the state of the last run cannot be restored ({why}); it is kept as {}",
                    renamed.display()
                );
                OpenedState { store: Some(self), restored: None, message: Some(message) }
            }
            Err(error) => {
                let message = format!(
                    "{path} cannot be restored ({why}) nor renamed ({error}); what is changed in \
                     this window will not be kept"
                );
                OpenedState { message: Some(message), ..OpenedState::default() }
            }
        }
    }

    /// Receives the state of this frame and writes it in the background once it has not changed for
    /// [`WRITING_TIME`].
    ///
    /// - `text`: the state as text;
    /// - returns a message for the user if an earlier write has failed.
    pub fn keep(&mut self, text: &str, context: &Context) -> Option<String> {
        let failure = self.poll();
        if text == self.written {
            self.pending_since = None;
            return failure;
        }
        let now = context.input(|input| input.time);
        let since = *self.pending_since.get_or_insert(now);
        if now - since < WRITING_TIME.as_secs_f64() || self.job.is_some() {
            context.request_repaint_after(WRITING_TIME);
            return failure;
        }
        self.pending_since = None;
        text.clone_into(&mut self.written);
        let (path, text) = (self.path.clone(), text.to_owned());
        self.job = Job::spawn("save", || {}, move |_| write(&path, &text)).ok();
        failure
    }

    /// Whether the state could not be written the last time.
    pub fn is_failing(&self) -> bool {
        self.is_failing
    }

    /// Writes the state at the end of the program, on the calling thread.
    pub fn finish(&mut self, text: &str) {
        if let Some(job) = &mut self.job {
            job.wait(); // So that an older state does not replace this one.
        }
        // The window is closed already, so that an error cannot be shown.
        let _ = write(&self.path, text);
    }

    fn poll(&mut self) -> Option<String> {
        let update = self.job.as_mut()?.poll();
        if matches!(update, Update::Running) {
            return None;
        }
        self.job = None;
        let was_failing =
            std::mem::replace(&mut self.is_failing, !matches!(update, Update::Finished(Ok(()))));
        if self.is_failing {
            // A disk that is full for a while: what is not on it is written again.
            self.written.clear();
        }
        match update {
            Update::Finished(Err(error)) if !was_failing => Some(error_chain(&error)),
            _ => None,
        }
    }
}

/// Lets nobody but the user look into the folder of the user's data: notes and drafts of cases without a file,
/// paths, and trained networks are in it.
#[cfg(unix)]
fn keep_private(folder: &Path) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    std::fs::set_permissions(folder, std::fs::Permissions::from_mode(0o700))
}

/// Other systems give such a folder to its user alone.
#[cfg(not(unix))]
fn keep_private(_: &Path) -> std::io::Result<()> {
    Ok(())
}

/// Returns the first name `PATH.damaged-N` that is not taken.
fn free_name(path: &Path) -> PathBuf {
    let mut n = 1;
    loop {
        let mut name = path.as_os_str().to_owned();
        name.push(format!(".damaged-{n}"));
        if Path::new(&name).symlink_metadata().is_err() {
            return name.into();
        }
        n += 1;
    }
}

fn write(path: &Path, text: &str) -> Result<(), DataError> {
    write_bytes(path, Existing::Replace, text.as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Everybody on the machine could read what was typed into a case without a file.
    #[cfg(unix)]
    #[test]
    fn nobody_else_looks_into_the_folder_of_the_state() {
        use std::fs::{self, Permissions};
        use std::os::unix::fs::PermissionsExt;

        let home = tempfile::tempdir().unwrap();
        let data = home.path().join("share/impactlab");
        // New, and as an earlier version has left it.
        for before in [None, Some(0o755)] {
            if let Some(bits) = before {
                fs::set_permissions(&data, Permissions::from_mode(bits)).unwrap();
            }
            assert!(open_state(Some(data.join("state.json"))).store.is_some());
            let bits = fs::metadata(&data).unwrap().permissions().mode() & 0o777;
            assert_eq!(bits, 0o700, "{before:?}");
        }
    }
}
