//! The force network in the app: which model is loaded, what it is asked, how it learns and how
//! well it does. The panels of the same names show it.

mod edit;
mod evaluation;
mod model;
mod predictor;
mod settings;
mod training;
mod update;

pub use edit::{
    forget_contact, know_contact, set_bullet_heading, set_contact_x, set_mass, set_side,
};
pub use evaluation::{EvaluatedCase, EvaluationStatus, FinishedEvaluation};
pub use model::ModelStatus;
pub use predictor::{Forecast, Predictor, Question};
pub use settings::{ForceProject, ForceView, Statistic, TrainingForm};
pub use training::{Phase, TrainingStatus};
pub use update::{RecordedCase, force_datasets, source_name};

use std::path::PathBuf;
use std::sync::Arc;

use crate::jobs::Job;

/// What is loaded, computed and under way about the force network.
#[derive(Default)]
pub struct ForceSession {
    /// The model that answers.
    pub model: ModelStatus,
    /// The thread that predicts.
    pub predictor: Option<Predictor>,
    /// What it was asked last.
    pub asked: Option<Question>,
    /// Its latest answer, or why there is none.
    pub forecast: Option<Result<Arc<Forecast>, String>>,
    /// The selected case, if it has a force to compare with.
    pub recorded: Option<RecordedCase>,
    /// A training, under way or over.
    pub training: TrainingStatus,
    /// An evaluation, under way or over.
    pub evaluation: EvaluationStatus,
    /// Where a training is kept while it runs, so that it can go on after a crash.
    pub checkpoint: Option<PathBuf>,
    /// The model being written.
    pub saving: Option<Job<Result<PathBuf, String>>>,
    /// A path to which the model is to be saved, being typed.
    pub typed_model_path: String,
}
