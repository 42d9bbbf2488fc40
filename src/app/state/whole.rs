//! The state as a whole, and what of it is stored between runs.

use std::path::PathBuf;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::app::case::OpenCase;
use crate::app::project::Project;
use crate::app::state::saved::View;
use crate::app::state::session::{Message, Session};
use impactlab_core::data::Severity;
use impactlab_study::SimulateAnswer;

/// Version of the format in which the state is saved. A state of another version is not read.
const SAVED_VERSION: u32 = 2;

/// The whole state of the application.
#[derive(Default)]
pub struct State {
    /// What the user works on. Undo and redo change this part alone.
    pub project: Project,
    /// The case to whose variant that is shown the project belongs.
    pub case: OpenCase,
    /// How the project is shown.
    pub view: View,
    /// Loaded data, answers and running work.
    pub session: Session,
}

/// The part of the state that is stored between runs.
#[derive(Serialize, Deserialize)]
pub struct Saved {
    version: u32,
    project: Project,
    #[serde(default)]
    case: OpenCase,
    view: View,
    sources: Vec<PathBuf>,
}

impl Saved {
    fn new(state: &State) -> Self {
        Self {
            version: SAVED_VERSION,
            project: state.project.clone(),
            case: state.case.clone(),
            view: state.view.clone(),
            sources: state.session.sources.iter().map(|source| source.opened.clone()).collect(),
        }
    }

    fn is_of(&self, state: &State) -> bool {
        let opened = state.session.sources.iter().map(|source| &source.opened);
        self.project == state.project
            && self.case == state.case
            && self.view == state.view
            && self.sources.iter().eq(opened)
    }
}

/// The state as text, which is written anew only when the state has changed: a window that plays a motion
/// draws many frames of the same state.
#[derive(Default)]
pub struct StateText {
    of: Option<Saved>,
    text: String,
}

impl StateText {
    /// The state as [`State::save`] writes it.
    ///
    /// # Errors
    /// As for [`State::save`].
    pub fn update(&mut self, state: &State) -> Result<&str, serde_json::Error> {
        if !self.of.as_ref().is_some_and(|saved| saved.is_of(state)) {
            let saved = Saved::new(state);
            self.text = serde_json::to_string(&saved)?;
            self.of = Some(saved);
        }
        Ok(&self.text)
    }
}

/// The version in which a state was saved.
#[derive(Deserialize)]
struct SavedBy {
    version: u32,
}

/// The reason why a saved state cannot be restored.
#[derive(Debug, thiserror::Error)]
pub enum RestoreError {
    /// It is not what [`State::save`] writes.
    #[error("it is damaged")]
    Damaged(#[from] serde_json::Error),
    /// It was saved by another version of the program.
    #[error("it has the version {version}, expected {SAVED_VERSION}")]
    Version {
        /// The version in which it was saved.
        version: u32,
    },
}

impl RestoreError {
    /// Whether a later version of the program has saved the state.
    pub fn is_of_later_version(&self) -> bool {
        matches!(self, Self::Version { version } if *version > SAVED_VERSION)
    }
}

impl State {
    /// Returns the project, the view and the opened paths as JSON.
    ///
    /// # Errors
    /// A file has a name that is not Unicode, which JSON cannot hold.
    pub fn save(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string(&Saved::new(self))
    }

    /// Reads the state that [`save`](Self::save) has written and returns it with the paths that
    /// were open. A workspace that lacks a pane gets its default arrangement.
    ///
    /// # Errors
    /// [`RestoreError`] if the text is damaged or of another version; the application then starts
    /// with the default state.
    pub fn restore(text: &str) -> Result<(Self, Vec<PathBuf>), RestoreError> {
        let SavedBy { version } = serde_json::from_str(text)?;
        if version != SAVED_VERSION {
            return Err(RestoreError::Version { version });
        }
        let mut saved: Saved = serde_json::from_str(text)?;
        saved.view.workspaces.complete();
        let forgotten = saved.project.forget_held_models();
        let Saved { project, case, view, mut sources, .. } = saved;
        let mut state = Self { project, case, view, session: Session::default() };
        for name in forgotten {
            let text = format!(
                "the network {name:?} of the last run is in no file: the shipped one is asked instead"
            );
            state.say(Severity::Warning, text);
        }
        sources.dedup();
        Ok((state, sources))
    }

    /// Returns the latest simulation of the subject. While a newer one is awaited, it may belong to
    /// an earlier subject.
    pub fn analysis(&self) -> Option<&SimulateAnswer> {
        self.session.analysis.ok().map(Arc::as_ref)
    }

    /// Adds a message for the user.
    pub fn say(&mut self, severity: Severity, text: impl Into<String>) {
        let message = Message { severity, text: text.into() };
        let now = humantime::format_rfc3339_seconds(std::time::SystemTime::now()).to_string();
        self.session.log.push((now, message.clone()));
        self.session.messages.push(message);
    }
}
