//! The trainings that have not ended, as the window shows them.

use std::path::{Path, PathBuf};

use crate::app::archive::ArchiveEvent;
use crate::app::command::Command;
use crate::app::network::Network;
use crate::app::tasks::{TaskKey, Tasks};
use crate::app::unfinished::note::{LostTraining, Unfinished, UnfinishedList};
use impactlab_core::jobs::ProgressCallback;
use impactlab_study::MODEL_ENDING;

/// Name of the folder in the user's data folder.
const FOLDER: &str = "trainings";

/// The trainings that have not ended, as the window shows them.
#[derive(Default)]
pub struct UnfinishedTrainings {
    folder: Option<PathBuf>,
    is_reading: bool,
    /// Whether something has changed since the reading began.
    is_outdated: bool,
    /// What can go on.
    pub list: UnfinishedList,
    /// Whether the status line does not speak of interrupted trainings any more.
    pub is_hidden: bool,
}

impl UnfinishedTrainings {
    /// Takes the user's data folder and starts to read what has not ended.
    pub fn open(&mut self, data_folder: &Path, tasks: &mut Tasks) {
        self.folder = Some(data_folder.join(FOLDER));
        self.read(tasks);
    }

    /// Starts to read again what has not ended, after the reading that is under way, which holds the
    /// locks of the checkpoints.
    pub fn read(&mut self, tasks: &mut Tasks) {
        let Some(folder) = self.folder.clone() else { return };
        self.is_outdated = self.is_reading;
        if self.is_outdated {
            return;
        }
        self.is_reading = true;
        let work = move |_: &mut ProgressCallback<'_>| Ok(UnfinishedList::read(&folder));
        let take = |result| Command::from(ArchiveEvent::Trainings(result));
        tasks.start(TaskKey::ListTrainings, work, take);
    }

    /// Returns where checkpoints are stored; `None` if this window stores none.
    pub fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    /// Takes what has been read, and reads it again if something has changed meanwhile.
    pub fn take(&mut self, list: Result<UnfinishedList, String>, tasks: &mut Tasks) {
        self.is_reading = false;
        match list {
            Ok(list) => self.list = list,
            Err(reason) => self.list.lost = vec![LostTraining { files: Vec::new(), reason }],
        }
        if self.is_outdated {
            self.read(tasks);
        }
    }

    /// Returns the trainings that the end of the program has interrupted.
    pub fn interrupted(&self) -> impl Iterator<Item = &Unfinished> {
        self.list.trainings.iter().filter(|of| !of.note.is_cancelled)
    }

    /// Returns a checkpoint for a new training; `None` if this window stores none.
    pub fn new_checkpoint(&self, network: Network) -> Option<PathBuf> {
        let folder = self.folder.as_ref()?;
        let now = humantime::format_rfc3339_millis(std::time::SystemTime::now()).to_string();
        let now: String = now.chars().filter(char::is_ascii_digit).collect();
        Some(folder.join(format!("{}-{now}.{MODEL_ENDING}", network.stem())))
    }
}
