//! What is kept, as the window shows it, and the work on it in the background.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::app::archive::event::{ArchiveEvent, OpenedResult, Removal};
use crate::app::archive::{ArchiveEntry, ArchiveError, ArchiveFolder, ArchiveList};
use crate::app::command::Command;
use crate::app::found::Found;
use crate::app::model::file_name;
use crate::app::tasks::{TaskKey, Tasks};
use impactlab_core::data::{Existing, write_bytes};
use impactlab_core::error_chain;
use impactlab_core::jobs::ProgressCallback;
use impactlab_core::numerics::sha256_hex;
use impactlab_networks::shipped::ModelSource;
use impactlab_study::{ModelChoice, Request};

impl From<ArchiveEvent> for Command {
    fn from(event: ArchiveEvent) -> Self {
        Self::Archive(Found::new(event))
    }
}

/// What is kept, and the work on it.
#[derive(Default)]
pub struct ArchiveStatus {
    folder: Option<ArchiveFolder>,
    is_reading: bool,
    /// What is kept.
    pub list: ArchiveList,
}

impl ArchiveStatus {
    /// Takes the user's data folder and starts to read what is kept there.
    pub fn open(&mut self, folder: PathBuf, tasks: &mut Tasks) {
        let folder = ArchiveFolder::new(folder);
        self.folder = Some(folder.clone());
        self.is_reading = true;
        tasks.start(
            TaskKey::ListArchive,
            move |_| Ok(folder.read()),
            |result| Command::from(ArchiveEvent::Listed(result)),
        );
    }

    /// Returns where results are kept; `None` if this window keeps nothing.
    pub fn folder(&self) -> Option<&ArchiveFolder> {
        self.folder.as_ref()
    }

    /// Whether what is kept is still being read.
    pub fn is_reading(&self) -> bool {
        self.is_reading
    }

    /// Returns the entry of a model file; `None` for a file of the user.
    pub fn entry_of(&self, path: &Path) -> Option<&ArchiveEntry> {
        let folder = self.folder.as_ref()?;
        self.list.entries.iter().find(|entry| folder.path_of(entry) == path)
    }

    /// Returns what the user calls a model: its name in the list, otherwise that of its file.
    pub fn name_of(&self, choice: &ModelChoice) -> String {
        match choice {
            ModelChoice::Source(ModelSource::File(path)) => match self.entry_of(path) {
                Some(entry) => entry.name.clone(),
                None => file_name(path),
            },
            other => other.to_string(),
        }
    }

    /// Disk space of everything that is kept, bytes.
    pub fn bytes(&self) -> u64 {
        self.list.entries.iter().map(|entry| entry.bytes).sum()
    }

    /// Starts to keep a comparison or an evaluation. Without a folder nothing is kept.
    ///
    /// - `draft`: its note;
    /// - `content`: the report as JSON.
    pub fn keep_result(&self, draft: ArchiveEntry, content: Vec<u8>, tasks: &mut Tasks) {
        let Some(folder) = self.folder.clone() else { return };
        let content = Arc::new(content);
        let key = TaskKey::KeepResult(Arc::clone(&content));
        let work = move |_: &mut ProgressCallback<'_>| {
            let name = draft.name.clone();
            let entry = keep_bytes(&folder, draft, &content);
            entry.map_err(|error| format!("{name} is not kept: {}", error_chain(&error)))
        };
        tasks.start(key, work, |result| Command::from(ArchiveEvent::Put(result)));
    }

    /// Starts to give an entry another name.
    pub fn rename(&self, entry: ArchiveEntry, name: String, tasks: &mut Tasks) {
        let Some(folder) = self.folder.clone() else { return };
        let key = TaskKey::PutIntoArchive(entry.sha256.clone());
        let work = move |_: &mut ProgressCallback<'_>| {
            folder.rename(entry, name).map_err(|error| error_chain(&error))
        };
        tasks.start(key, work, |result| Command::from(ArchiveEvent::Put(result)));
    }

    /// Starts to remove files. What is missing already counts as removed.
    pub fn remove(&self, removal: Removal, tasks: &mut Tasks) {
        let key = TaskKey::RemoveArchived(removal.files.clone());
        let work = move |_: &mut ProgressCallback<'_>| {
            for path in &removal.files {
                match std::fs::remove_file(path) {
                    Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                        return Err(format!("{}: {error}", path.display()));
                    }
                    _ => {}
                }
            }
            Ok(removal)
        };
        tasks.start(key, work, |result| Command::from(ArchiveEvent::Removed(result)));
    }

    /// Starts to read a comparison or an evaluation.
    pub fn open_result(&self, entry: ArchiveEntry, tasks: &mut Tasks) {
        let Some(folder) = self.folder.clone() else { return };
        let work = move |_: &mut ProgressCallback<'_>| read_result(&folder, entry);
        tasks.start(TaskKey::OpenArchived, work, |result| {
            Command::from(ArchiveEvent::Opened(result))
        });
    }

    /// Takes the list that was read. What was kept while it was being read is in it or is newer.
    pub fn take_list(&mut self, list: ArchiveList) {
        let newer = std::mem::replace(&mut self.list, list);
        newer.entries.into_iter().for_each(|entry| self.add(entry));
    }

    /// Notes that the list has been read, or that it could not be.
    pub fn end_reading(&mut self) {
        self.is_reading = false;
    }

    /// Adds an entry, or replaces the one with the same content.
    pub fn add(&mut self, entry: ArchiveEntry) {
        let entries = &mut self.list.entries;
        match entries.iter_mut().find(|of| of.sha256 == entry.sha256 && of.kind == entry.kind) {
            Some(before) => *before = entry,
            None => entries.insert(0, entry),
        }
    }

    /// Takes files that were removed out of the list.
    pub fn forget(&mut self, removal: &Removal) {
        if let Some(folder) = &self.folder {
            let is_left = |entry: &ArchiveEntry| !removal.files.contains(&folder.path_of(entry));
            self.list.entries.retain(is_left);
        }
        let is_left = |file: &PathBuf| !removal.files.contains(file);
        self.list.problems.retain(|of| of.files.is_empty() || of.files.iter().any(is_left));
    }
}

/// Keeps content that is in memory.
fn keep_bytes(
    folder: &ArchiveFolder,
    draft: ArchiveEntry,
    content: &[u8],
) -> Result<ArchiveEntry, ArchiveError> {
    let draft = ArchiveEntry { sha256: sha256_hex([content]), ..draft };
    folder.put(draft, |path| Ok(write_bytes(path, Existing::Replace, content)?))
}

fn read_result(folder: &ArchiveFolder, entry: ArchiveEntry) -> Result<OpenedResult, String> {
    let bytes = folder.read_content(&entry).map_err(|error| error_chain(&error))?;
    let damaged = |error: serde_json::Error| {
        format!("{}: {error}, expected a report", folder.path_of(&entry).display())
    };
    Ok(match &entry.question {
        Request::EvaluateForce(_) => {
            let report = serde_json::from_slice(&bytes).map_err(damaged)?;
            OpenedResult::ForceEvaluation(Box::new((entry.question, report)))
        }
        _ => OpenedResult::Comparison(serde_json::from_slice(&bytes).map_err(damaged)?),
    })
}
