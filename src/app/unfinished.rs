//! Trainings that have not ended: each has a checkpoint and beside it a note of what it is, so that
//! it can go on after the program was killed, also if its settings are not in the form any more.
//!
//! ```text
//! trainings/NETWORK-DATE.safetensors   the checkpoint, written by the training
//! trainings/NETWORK-DATE.note          question, data and the planned number of epochs
//! ```

use std::path::{Path, PathBuf};

use egui::Context;
use serde::{Deserialize, Serialize};

use crate::app::command::{Command, wake};
use crate::app::kept::{KeptError, KeptEvent, NOTE_ENDING};
use crate::app::network::Network;
use crate::app::state::{Session, State};
use crate::app::tasks::{TaskKey, Tasks};
use impactlab_core::data::write::WriterLock;
use impactlab_core::data::{
    Existing, MAX_RESULTS_BYTES, Severity, list_folder, read_bytes, write_atomically,
};
use impactlab_core::error_chain;
use impactlab_core::jobs::ProgressCallback;
use impactlab_networks::force::FORCE_CHECKPOINT;
use impactlab_networks::learning::{TrainingReport, stored_epochs};
use impactlab_networks::response::RESPONSE_CHECKPOINT;
use impactlab_study::MODEL_ENDING;
use impactlab_study::{Request, TrainingOptions};

/// Version of the format of notes.
const VERSION: u32 = 1;

/// Name of the folder in the user's data folder.
const FOLDER: &str = "trainings";

/// What is known of a training beside its checkpoint.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrainingNote {
    version: u32,
    /// The network that is trained.
    pub network: Network,
    /// The question.
    pub question: Request,
    /// Name of the data.
    pub data: String,
    /// When it was started: UTC, RFC 3339.
    pub started: String,
    /// Epochs before this training that its history lists too, and planned epochs with those; `None`
    /// before the first epoch.
    pub plan: Option<[usize; 2]>,
    /// Whether the user has cancelled it. Otherwise the program has ended before it.
    pub is_cancelled: bool,
}

/// A training that can go on.
#[derive(Debug, Clone, PartialEq)]
pub struct Unfinished {
    /// The checkpoint. It is missing if the program has ended before the first one.
    pub checkpoint: PathBuf,
    /// What it is.
    pub note: TrainingNote,
    /// Number of epochs in the checkpoint.
    pub n_epochs: usize,
}

/// A checkpoint from which no training can go on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LostTraining {
    /// Its files.
    pub files: Vec<PathBuf>,
    /// What is wrong, with the name of the file.
    pub reason: String,
}

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

/// What is in the folder.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct UnfinishedList {
    /// What can go on, the latest first.
    pub trainings: Vec<Unfinished>,
    /// What cannot.
    pub lost: Vec<LostTraining>,
}

impl TrainingNote {
    /// The note of a training that starts now.
    pub fn new(network: Network, question: Request, data: String) -> Self {
        let started = humantime::format_rfc3339_seconds(std::time::SystemTime::now()).to_string();
        let (plan, is_cancelled) = (None, false);
        Self { version: VERSION, network, question, data, started, plan, is_cancelled }
    }
}

impl Unfinished {
    /// Returns how far it has got, such as “epoch 12 of 100”.
    pub fn progress(&self) -> String {
        match self.note.plan {
            _ if self.n_epochs == 0 => "no epoch is stored, it begins anew".to_owned(),
            None => format!("epoch {}", self.n_epochs),
            Some([before, planned]) => {
                let done = self.n_epochs.saturating_sub(before);
                format!("epoch {done} of {}", planned.saturating_sub(before))
            }
        }
    }

    /// Returns the files that belong to it.
    pub fn files(&self) -> Vec<PathBuf> {
        vec![self.checkpoint.clone(), self.checkpoint.with_extension(NOTE_ENDING)]
    }
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
        let take = |result| Command::from(KeptEvent::Trainings(result));
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
        let name = match network {
            Network::Force => "force",
            Network::Response => "response",
        };
        Some(folder.join(format!("{name}-{now}.{MODEL_ENDING}")))
    }
}

impl UnfinishedList {
    /// Reads the notes in a folder and how far their trainings have got. Trainings that are running
    /// are left out.
    fn read(folder: &Path) -> Self {
        let mut list = Self::default();
        if folder.symlink_metadata().is_err() {
            return list; // Nothing has been trained yet.
        }
        let mut paths = match list_folder(folder) {
            Ok(paths) => paths,
            Err(error) => {
                let lost = LostTraining { files: Vec::new(), reason: error_chain(&error) };
                return Self { lost: vec![lost], ..list };
            }
        };
        paths.sort();
        let ending = |path: &Path| path.extension().unwrap_or_default().to_owned();
        for path in paths {
            let note = path.with_extension(NOTE_ENDING);
            let checkpoint = path.with_extension(MODEL_ENDING);
            let is_alone = ending(&path) == MODEL_ENDING && !note.exists();
            if ending(&path) != NOTE_ENDING && !is_alone {
                continue;
            }
            // The lock is held by a training that is running.
            let Ok(_lock) = WriterLock::lock_file(&checkpoint) else { continue };
            match read_training(&checkpoint, &note) {
                Ok(training) => list.trainings.push(training),
                Err(reason) => {
                    list.lost.push(LostTraining { files: vec![checkpoint, note], reason });
                }
            }
        }
        list.trainings.sort_by(|a, b| b.note.started.cmp(&a.note.started));
        list
    }
}

fn read_training(checkpoint: &Path, note: &Path) -> Result<Unfinished, String> {
    if !note.exists() {
        return Err(KeptError::NoNote { path: checkpoint.to_owned() }.to_string());
    }
    let bytes = read_bytes(note, MAX_RESULTS_BYTES).map_err(|error| error_chain(&error))?;
    let damaged = |error| format!("{}: the note is damaged ({error})", note.display());
    let note: TrainingNote = serde_json::from_slice(&bytes).map_err(damaged)?;
    let kind = match note.network {
        Network::Force => FORCE_CHECKPOINT,
        Network::Response => RESPONSE_CHECKPOINT,
    };
    let n_epochs = match checkpoint.exists() {
        true => stored_epochs(checkpoint, kind).map_err(|error| error_chain(&error))?,
        false => 0,
    };
    Ok(Unfinished { checkpoint: checkpoint.to_owned(), note, n_epochs })
}

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
    pub fn told(&mut self, report: &TrainingReport) {
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
        write_atomically(&path, Existing::Replace, |out| out.write_all(text.as_bytes()))
            .map_err(|error| error_chain(&error))
    }
}

/// Returns the options of a training; `None` for a question that trains nothing.
pub fn training_options(question: &mut Request) -> Option<&mut TrainingOptions> {
    match question {
        Request::TrainForce(of) => Some(&mut of.training),
        Request::TrainResponse(of) => Some(&mut of.training),
        Request::FineTune(of) => Some(&mut of.training),
        _ => None,
    }
}

impl State {
    /// Starts a training.
    ///
    /// - `data`: name of the data, shown to the user.
    pub(in crate::app) fn start_training(
        &mut self,
        mut question: Request,
        (network, data): (Network, String),
        context: &Context,
    ) {
        let checkpoint = self.session.unfinished.new_checkpoint(network);
        if let Some(options) = training_options(&mut question) {
            options.checkpoint = checkpoint.clone();
        }
        let note = TrainingNote::new(network, question.clone(), data);
        self.run_training(question, (checkpoint, note), context);
    }

    /// Goes on with a training that has not ended.
    pub(in crate::app) fn resume_training(&mut self, checkpoint: &Path, context: &Context) {
        let mut trainings = self.session.unfinished.list.trainings.iter();
        let Some(of) = trainings.find(|of| of.checkpoint == checkpoint) else { return };
        let is_running = match of.note.network {
            Network::Force => self.session.force.training.run.is_running(),
            Network::Response => self.session.response.training.run.is_running(),
        };
        if is_running {
            let text = format!("a {} is being trained; wait or cancel it", of.note.network.model());
            return self.say(Severity::Warning, text);
        }
        let note = TrainingNote { is_cancelled: false, ..of.note.clone() };
        let mut question = note.question.clone();
        if let Some(options) = training_options(&mut question) {
            (options.checkpoint, options.resume) = (Some(checkpoint.to_owned()), true);
        }
        self.view.trained = note.network;
        self.session.unfinished.list.trainings.retain(|of| of.checkpoint != checkpoint);
        self.run_training(question, (Some(checkpoint.to_owned()), note), context);
    }

    fn run_training(
        &mut self,
        question: Request,
        (checkpoint, note): (Option<PathBuf>, TrainingNote),
        context: &Context,
    ) {
        let data = note.data.clone();
        let diary = checkpoint.map(|checkpoint| TrainingDiary::new(checkpoint, note));
        let Session { force, response, library, .. } = &mut self.session;
        let started = match question {
            Request::TrainForce(question) => {
                force.training.start((*question, diary), (data, library), wake(context))
            }
            Request::TrainResponse(question) => {
                response.training.start((*question, diary), (data, library), wake(context))
            }
            Request::FineTune(question) => {
                response.training.start((*question, diary), (data, library), wake(context))
            }
            _ => return,
        };
        if let Err(error) = started {
            self.say(Severity::Error, error.to_string());
        }
    }
}
