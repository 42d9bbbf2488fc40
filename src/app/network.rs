//! The two networks, where the app treats them alike.

use std::path::Path;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

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
    /// Scenario to impact force.
    #[default]
    Force,
    /// Impact force to motion.
    Response,
}

impl Network {
    /// Both networks.
    pub const ALL: [Self; 2] = [Self::Force, Self::Response];

    /// In a sentence: “force model”.
    pub fn model(self) -> &'static str {
        match self {
            Self::Force => "force model",
            Self::Response => "response model",
        }
    }

    /// As a choice.
    pub fn label(self) -> &'static str {
        match self {
            Self::Force => "Force network",
            Self::Response => "Response network",
        }
    }

    /// What a file with such a model is called at first.
    pub fn file_name(self) -> &'static str {
        match self {
            Self::Force => "force.safetensors",
            Self::Response => "response.safetensors",
        }
    }
}

/// A model that files hold and trainings make.
pub trait TrainedModel: Sized + Send + Sync + 'static {
    /// Of which network.
    const NETWORK: Network;

    /// What a training answers.
    type Answer: Send + 'static;

    /// What is told of a training.
    type Report;

    /// The model of this name in questions; it is read if it is not in memory.
    ///
    /// # Errors
    /// [`StudyError`] if it cannot be read.
    fn of_library(library: &Library, choice: &ModelChoice) -> Result<Arc<Self>, StudyError>;

    /// Keeps the model in the library under its name in questions.
    fn hold(library: &Library, choice: ModelChoice, model: Arc<Self>);

    /// Writes the model to a file.
    ///
    /// # Errors
    /// A message for the user.
    fn write(&self, path: &Path) -> Result<(), String>;

    /// The model that came out of a training, and what is told of it.
    fn of_answer(answer: Self::Answer) -> (Self, Self::Report);

    /// Cases that the training left out, and what it assumed.
    fn notes(report: &Self::Report) -> (&[String], &[Assumption]);

    /// What the data that it learned from were called.
    fn data(&self) -> &str;

    /// Every epoch of its training.
    fn history(&self) -> Vec<EpochSummary>;

    /// The epoch whose weights it has, where that is not the last one.
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

    fn write(&self, path: &Path) -> Result<(), String> {
        self.save(path).map_err(|error| error_chain(&error))
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

    fn write(&self, path: &Path) -> Result<(), String> {
        self.save(path).map_err(|error| error_chain(&error))
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
