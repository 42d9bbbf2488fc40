//! The two networks behind one interface, for the parts of the app that treat them alike.

use std::path::Path;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::data::Existing;
use crate::error_chain;
use crate::force::ForceModel;
use crate::learning::{EpochRecord, EpochSummary, ModelFile};
use crate::response::ResponseModel;
use crate::study::{
    Assumption, Library, ModelChoice, ResponseTrainingAnswer, ResponseTrainingReport, StudyError,
    TrainForceAnswer, TrainForceReport,
};

/// One of the two networks.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Network {
    /// The force network, which predicts the impact force from the collision.
    #[default]
    Force,
    /// The response network, which predicts the motion of the struck vehicle from the impact force.
    Response,
}

impl Network {
    /// Both networks.
    pub const ALL: [Self; 2] = [Self::Force, Self::Response];

    /// Returns the name of a model of this network for use in a sentence, such as “force model”.
    pub fn model(self) -> &'static str {
        match self {
            Self::Force => "force model",
            Self::Response => "response model",
        }
    }

    /// Returns the name of the network for headings and lists.
    pub fn label(self) -> &'static str {
        match self {
            Self::Force => "Force network",
            Self::Response => "Response network",
        }
    }

    /// Returns the file name that is proposed when a model of this network is saved.
    pub fn file_name(self) -> &'static str {
        match self {
            Self::Force => "force.safetensors",
            Self::Response => "response.safetensors",
        }
    }
}

/// A trained model of either network, which can be stored in a file, held in a library and come out
/// of a training.
pub trait TrainedModel: Sized + Send + Sync + 'static {
    /// The network that the model belongs to.
    const NETWORK: Network;

    /// The answer of a training of this network, which contains the model.
    type Answer: Send + 'static;

    /// The report of a training of this network.
    type Report;

    /// Returns the model to which questions refer by `choice`; it is read from its file if it is
    /// not in memory.
    ///
    /// # Errors
    /// [`StudyError`] if the model cannot be read.
    fn of_library(library: &Library, choice: &ModelChoice) -> Result<Arc<Self>, StudyError>;

    /// Keeps the model in the library, where questions refer to it by `choice`.
    fn hold(library: &Library, choice: ModelChoice, model: Arc<Self>);

    /// Writes the model to a file.
    ///
    /// - `existing`: what happens to a file that exists already.
    ///
    /// # Errors
    /// A message for the user, if the file cannot be written.
    fn write(&self, path: &Path, existing: Existing) -> Result<(), String>;

    /// Separates the answer of a training into the model and the report.
    fn of_answer(answer: Self::Answer) -> (Self, Self::Report);

    /// Returns the cases that the training left out, each with its reason, and the assumptions of
    /// the training.
    fn notes(report: &Self::Report) -> (&[String], &[Assumption]);

    /// Returns the name of the data that the model was trained on.
    fn data(&self) -> &str;

    /// Returns a summary of each epoch of the training.
    fn history(&self) -> Vec<EpochSummary>;

    /// Returns the epoch, from 1, from which the weights were taken; `None` if they are those of
    /// the last epoch.
    fn best_epoch(&self) -> Option<usize>;
}

impl TrainedModel for ForceModel {
    const NETWORK: Network = Network::Force;

    type Answer = TrainForceAnswer;
    type Report = TrainForceReport;

    fn of_library(library: &Library, choice: &ModelChoice) -> Result<Arc<Self>, StudyError> {
        library.force_model(choice)
    }

    fn hold(library: &Library, choice: ModelChoice, model: Arc<Self>) {
        library.hold_force_model(choice, model);
    }

    fn write(&self, path: &Path, existing: Existing) -> Result<(), String> {
        self.save(path, existing).map_err(|error| error_chain(&error))
    }

    fn of_answer(answer: TrainForceAnswer) -> (Self, TrainForceReport) {
        (answer.model, answer.report)
    }

    fn notes(report: &TrainForceReport) -> (&[String], &[Assumption]) {
        (&report.left_out, &report.assumptions)
    }

    fn data(&self) -> &str {
        &self.record().data
    }

    fn history(&self) -> Vec<EpochSummary> {
        self.record().history.iter().map(EpochRecord::summary).collect()
    }

    fn best_epoch(&self) -> Option<usize> {
        Some(self.record().detail.best_epoch)
    }
}

impl TrainedModel for ResponseModel {
    const NETWORK: Network = Network::Response;

    type Answer = ResponseTrainingAnswer;
    type Report = ResponseTrainingReport;

    fn of_library(library: &Library, choice: &ModelChoice) -> Result<Arc<Self>, StudyError> {
        library.response_model(choice)
    }

    fn hold(library: &Library, choice: ModelChoice, model: Arc<Self>) {
        library.hold_response_model(choice, model);
    }

    fn write(&self, path: &Path, existing: Existing) -> Result<(), String> {
        self.save(path, existing).map_err(|error| error_chain(&error))
    }

    fn of_answer(answer: ResponseTrainingAnswer) -> (Self, ResponseTrainingReport) {
        (answer.model, answer.report)
    }

    fn notes(report: &ResponseTrainingReport) -> (&[String], &[Assumption]) {
        (&report.left_out, &report.assumptions)
    }

    fn data(&self) -> &str {
        &self.record().data
    }

    fn history(&self) -> Vec<EpochSummary> {
        self.record().history.iter().map(EpochRecord::summary).collect()
    }

    fn best_epoch(&self) -> Option<usize> {
        None
    }
}
