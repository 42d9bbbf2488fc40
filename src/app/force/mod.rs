//! The force network in the app: which model is loaded, what it is asked, how it learns and how
//! well it does. The panels of the same names show it.

mod edit;
mod settings;
mod update;

pub use edit::{
    forget_contact, know_contact, set_bullet_heading, set_contact_x, set_mass, set_side,
};
pub use settings::{ForceProject, ForceTrainingForm, ForceView, Statistic};
pub use update::RecordedCase;

use std::path::PathBuf;

use crate::app::latest::Latest;
use crate::app::model::ModelStatus;
use crate::app::question_job::QuestionJob;
use crate::app::training_status::TrainingStatus;
use crate::force::ForceModel;
use crate::study::{EvaluateForceRequest, PredictForceRequest};

/// What is loaded, computed and under way about the force network.
#[derive(Default)]
pub struct ForceSession {
    /// The model that answers.
    pub model: ModelStatus<ForceModel>,
    /// What it says of the collision.
    pub forecast: Latest<PredictForceRequest>,
    /// The selected case, if it has a force to compare with.
    pub recorded: Option<RecordedCase>,
    /// A training, under way or over.
    pub training: TrainingStatus<ForceModel>,
    /// An evaluation, under way or over.
    pub evaluation: QuestionJob<EvaluateForceRequest>,
    /// Where a training is kept while it runs, so that it can go on after a crash.
    pub checkpoint: Option<PathBuf>,
}
