//! The force network in the app: its settings, its model, its forecast, its training and its
//! evaluation. The panes of these names show them.

mod collision;
mod edit;
mod recorded;
mod settings;
mod update;

pub use collision::{NamedCollision, collision_of};
pub use edit::{
    forget_contact, know_contact, set_contact_x, set_mass, set_side, set_striking_heading,
};
pub use recorded::RecordedCase;
pub use settings::{ForceView, Statistic};
pub(in crate::app) use update::WITHOUT_MODEL;

use crate::app::latest::Latest;
use crate::app::model::ModelStatus;
use crate::app::question_job::QuestionJob;
use crate::app::training_status::TrainingStatus;
use impactlab_networks::force::ForceModel;
use impactlab_study::{EvaluateForceRequest, PredictForceRequest};

/// The data and the running work of the force network, which are not saved.
#[derive(Default)]
pub struct ForceSession {
    /// The model that predicts.
    pub model: ModelStatus<ForceModel>,
    /// The predicted force of the collision.
    pub forecast: Latest<PredictForceRequest>,
    /// The selected case, if it has a recorded force with which the prediction can be compared.
    pub recorded: Option<RecordedCase>,
    /// The training, running or finished.
    pub training: TrainingStatus<ForceModel>,
    /// The evaluation on a data set, running or finished.
    pub evaluation: QuestionJob<EvaluateForceRequest>,
}
