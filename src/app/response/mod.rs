//! The response network in the app: its settings, its model, its forecast, its training and the
//! comparison with other models. The panes of these names show them.

mod comparison;
mod motion;
mod settings;
mod update;

pub use comparison::ComparisonStatus;
pub use motion::{DensityAnswer, DensityQuestion, MotionAnswer, MotionQuestion};
pub use settings::{DensityChoice, ResponseView};

use std::sync::Arc;

use crate::app::latest::Latest;
use crate::app::model::ModelStatus;
use crate::app::training_status::TrainingStatus;
use impactlab_draw::DensityGpu;
use impactlab_networks::response::ResponseModel;

/// The data and the running work of the response network, which are not saved.
#[derive(Default)]
pub struct ResponseSession {
    /// The model that predicts.
    pub model: ModelStatus<ResponseModel>,
    /// The predicted motion of the struck vehicle.
    pub forecast: Latest<MotionQuestion>,
    /// The probability density of the vehicle's position at the chosen times.
    pub density: Latest<DensityQuestion>,
    /// The graphics processor that computes densities; `None` computes them on the CPU.
    pub gpu: Option<Arc<DensityGpu>>,
    /// The training, running or finished.
    pub training: TrainingStatus<ResponseModel>,
    /// The comparison or evaluation, running or finished.
    pub comparison: ComparisonStatus,
}
