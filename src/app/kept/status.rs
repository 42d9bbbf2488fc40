//! What is kept, as the window shows it, and the work on it in the background.

use std::path::{Path, PathBuf};

use crate::app::kept::{KeptEntry, KeptError, KeptFolder, KeptList};
use crate::app::model::file_name;
use impactlab_core::data::write::sha256_hex;
use impactlab_core::data::{Existing, write_atomically};
use impactlab_core::error_chain;
use impactlab_core::jobs::Job;
use impactlab_networks::shipped::ModelSource;
use impactlab_study::{CompareReport, EvaluateForceReport, ModelChoice, Request};

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
        entry: Box<KeptEntry>,
        /// The name as typed so far.
        name: String,
    },
    /// Whether files are to be removed.
    Remove(Removal),
}

/// A comparison or an evaluation that is shown again.
pub enum OpenedResult {
    /// A comparison of response models, or the evaluation of one.
    Comparison(Box<CompareReport>),
    /// An evaluation of a force model, with its question.
    ForceEvaluation(Box<(Request, EvaluateForceReport)>),
}

/// What is kept, and the work on it.
#[derive(Default)]
pub struct KeptStatus {
    folder: Option<KeptFolder>,
    reading: Option<Job<Result<KeptList, String>>>,
    writing: Vec<Job<Result<KeptEntry, String>>>,
    removing: Vec<Job<Result<Removal, String>>>,
    opening: Option<Job<Result<OpenedResult, String>>>,
    /// What is kept.
    pub list: KeptList,
}

impl KeptStatus {
    /// Takes the user's data folder and starts to read what is kept there.
    ///
    /// - `wake`: called when it has been read.
    ///
    /// # Errors
    /// The error of the operating system, if the thread cannot be started.
    pub fn open(
        &mut self,
        folder: PathBuf,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<()> {
        let folder = KeptFolder::new(folder);
        self.folder = Some(folder.clone());
        self.reading = Some(Job::spawn("read kept models", wake, move |_| Ok(folder.read()))?);
        Ok(())
    }

    /// Returns where results are kept; `None` if this window keeps nothing.
    pub fn folder(&self) -> Option<&KeptFolder> {
        self.folder.as_ref()
    }

    /// Whether what is kept is still being read.
    pub fn is_reading(&self) -> bool {
        self.reading.is_some()
    }

    /// Whether something is being written.
    pub fn is_writing(&self) -> bool {
        !self.writing.is_empty()
    }

    /// Returns the entry of a model file; `None` for a file of the user.
    pub fn entry_of(&self, path: &Path) -> Option<&KeptEntry> {
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
    /// - `content`: the report as JSON;
    /// - `wake`: called when it has been written.
    ///
    /// # Errors
    /// The error of the operating system, if the thread cannot be started.
    pub fn keep_result(
        &mut self,
        draft: KeptEntry,
        content: Vec<u8>,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<()> {
        let Some(folder) = self.folder.clone() else { return Ok(()) };
        let job = Job::spawn("keep result", wake, move |_| {
            let name = draft.name.clone();
            let kept = keep_bytes(&folder, draft, &content);
            kept.map_err(|error| format!("{name} is not kept: {}", error_chain(&error)))
        })?;
        self.writing.push(job);
        Ok(())
    }

    /// Starts to give an entry another name.
    ///
    /// # Errors
    /// The error of the operating system, if the thread cannot be started.
    pub fn rename(
        &mut self,
        (entry, name): (KeptEntry, String),
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<()> {
        let Some(folder) = self.folder.clone() else { return Ok(()) };
        let job = Job::spawn("rename", wake, move |_| {
            folder.rename(entry, name).map_err(|error| error_chain(&error))
        })?;
        self.writing.push(job);
        Ok(())
    }

    /// Starts to remove files. What is missing already counts as removed.
    ///
    /// # Errors
    /// The error of the operating system, if the thread cannot be started.
    pub fn remove(
        &mut self,
        removal: Removal,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<()> {
        let job = Job::spawn("remove", wake, move |_| {
            for path in &removal.files {
                match std::fs::remove_file(path) {
                    Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                        return Err(format!("{}: {error}", path.display()));
                    }
                    _ => {}
                }
            }
            Ok(removal)
        })?;
        self.removing.push(job);
        Ok(())
    }

    /// Starts to read a comparison or an evaluation.
    ///
    /// # Errors
    /// The error of the operating system, if the thread cannot be started.
    pub fn open_result(
        &mut self,
        entry: KeptEntry,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<()> {
        let Some(folder) = self.folder.clone() else { return Ok(()) };
        let job = Job::spawn("open result", wake, move |_| read_result(&folder, entry))?;
        self.opening = Some(job);
        Ok(())
    }

    /// Adds an entry, or replaces the one with the same content.
    pub fn add(&mut self, entry: KeptEntry) {
        let entries = &mut self.list.entries;
        match entries.iter_mut().find(|of| of.sha256 == entry.sha256 && of.kind == entry.kind) {
            Some(before) => *before = entry,
            None => entries.insert(0, entry),
        }
    }

    /// Receives the results of the jobs.
    ///
    /// - returns the comparison or evaluation that has been read, the files that have been removed,
    ///   and messages for the user about what went wrong.
    pub fn poll(&mut self) -> (Option<OpenedResult>, Vec<Removal>, Vec<String>) {
        let mut problems = Vec::new();
        let read = self.reading.as_mut().and_then(|job| job.poll().into_result("the reader"));
        match read {
            None => {}
            Some(Err(problem)) => {
                self.reading = None;
                problems.push(problem);
            }
            Some(Ok(list)) => {
                self.reading = None;
                // What was kept while the list was being read is in it or is newer.
                let newer = std::mem::replace(&mut self.list, list);
                newer.entries.into_iter().for_each(|entry| self.add(entry));
            }
        }
        let mut written = Vec::new();
        self.writing.retain_mut(|job| match job.poll().into_result("the writer") {
            None => true,
            Some(result) => {
                written.push(result);
                false
            }
        });
        for result in written {
            match result {
                Ok(entry) => self.add(entry),
                Err(problem) => problems.push(problem),
            }
        }
        let mut removed = Vec::new();
        self.removing.retain_mut(|job| match job.poll().into_result("the remover") {
            None => true,
            Some(Ok(removal)) => {
                removed.push(removal);
                false
            }
            Some(Err(problem)) => {
                problems.push(problem);
                false
            }
        });
        for removal in &removed {
            self.forget(removal);
        }
        let opened = self.opening.as_mut().and_then(|job| job.poll().into_result("the reader"));
        if opened.is_some() {
            self.opening = None;
        }
        let opened = match opened {
            Some(Err(problem)) => {
                problems.push(problem);
                None
            }
            Some(Ok(opened)) => Some(opened),
            None => None,
        };
        (opened, removed, problems)
    }

    fn forget(&mut self, removal: &Removal) {
        if let Some(folder) = &self.folder {
            let is_left = |entry: &KeptEntry| !removal.files.contains(&folder.path_of(entry));
            self.list.entries.retain(is_left);
        }
        let is_left = |file: &PathBuf| !removal.files.contains(file);
        self.list.problems.retain(|of| of.files.is_empty() || of.files.iter().any(is_left));
    }
}

/// Keeps content that is in memory.
fn keep_bytes(
    folder: &KeptFolder,
    draft: KeptEntry,
    content: &[u8],
) -> Result<KeptEntry, KeptError> {
    let draft = KeptEntry { sha256: sha256_hex(content), ..draft };
    folder.put(draft, |path| {
        Ok(write_atomically(path, Existing::Replace, |out| out.write_all(content))?)
    })
}

fn read_result(folder: &KeptFolder, entry: KeptEntry) -> Result<OpenedResult, String> {
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
