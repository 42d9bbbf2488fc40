//! What stands beside the checkpoint of a training, and the list of those that can go on.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::app::archive::{ArchiveError, NOTE_ENDING};
use crate::app::network::Network;
use impactlab_core::data::write::WriterLock;
use impactlab_core::data::{MAX_RESULTS_BYTES, list_folder, read_bytes};
use impactlab_core::error_chain;
use impactlab_networks::force::FORCE_CHECKPOINT;
use impactlab_networks::learning::stored_epochs;
use impactlab_networks::response::RESPONSE_CHECKPOINT;
use impactlab_study::{MODEL_ENDING, Request, TrainingOptions};

/// Version of the format of notes.
const VERSION: u32 = 1;

/// What is known of a training beside its checkpoint.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrainingNote {
    pub(super) version: u32,
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

impl UnfinishedList {
    /// Reads the notes in a folder and how far their trainings have got. Trainings that are running
    /// are left out.
    pub(super) fn read(folder: &Path) -> Self {
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
        return Err(ArchiveError::NoNote { path: checkpoint.to_owned() }.to_string());
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

/// Returns the options of a training; `None` for a question that trains nothing.
pub fn training_options(question: &mut Request) -> Option<&mut TrainingOptions> {
    match question {
        Request::TrainForce(of) => Some(&mut of.training),
        Request::TrainResponse(of) => Some(&mut of.training),
        Request::FineTune(of) => Some(&mut of.training),
        _ => None,
    }
}
