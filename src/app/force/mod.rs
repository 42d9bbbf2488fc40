//! The force network in the app: which model is loaded, what it is asked, how it learns and how
//! well it does. The panels of the same names show it.

mod edit;
mod evaluation;
mod question;
mod settings;
mod training;
mod update;

pub use edit::{
    forget_contact, know_contact, set_bullet_heading, set_contact_x, set_mass, set_side,
};
pub use evaluation::{EvaluatedCase, EvaluationStatus, FinishedEvaluation};
pub use question::{ForceQuestion, Forecast};
pub use settings::{ForceProject, ForceView, Statistic, TrainingForm};
pub use training::{ForceTrainingData, run_force_training};
pub use update::RecordedCase;

use std::path::PathBuf;

use crate::app::latest::Latest;
use crate::app::model::ModelStatus;
use crate::app::training_status::TrainingStatus;
use crate::force::ForceModel;

/// What is loaded, computed and under way about the force network.
#[derive(Default)]
pub struct ForceSession {
    /// The model that answers.
    pub model: ModelStatus<ForceModel>,
    /// What it says of the collision.
    pub forecast: Latest<ForceQuestion>,
    /// The selected case, if it has a force to compare with.
    pub recorded: Option<RecordedCase>,
    /// A training, under way or over.
    pub training: TrainingStatus<ForceModel>,
    /// An evaluation, under way or over.
    pub evaluation: EvaluationStatus,
    /// Where a training is kept while it runs, so that it can go on after a crash.
    pub checkpoint: Option<PathBuf>,
}
