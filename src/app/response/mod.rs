//! The response network in the app: which model is loaded, what it forecasts, how it learns, how it
//! compares. The panels of the same names show it.

mod comparison;
mod motion;
mod settings;
mod update;

pub use comparison::ComparisonStatus;
pub use motion::{DensityQuestion, MotionAnswer, MotionQuestion};
pub use settings::{
    ComparisonForm, DensityChoice, ForceChoice, ResponseProject, ResponseTrainingForm,
    ResponseView, TrainingMode,
};

use std::path::PathBuf;
use std::sync::Arc;

use crate::app::latest::Latest;
use crate::app::model::ModelStatus;
use crate::app::training_status::TrainingStatus;
use crate::render::DensityGpu;
use crate::response::ResponseModel;

/// What is loaded, computed and under way about the response network.
#[derive(Default)]
pub struct ResponseSession {
    /// The model that answers.
    pub model: ModelStatus<ResponseModel>,
    /// Where the struck vehicle goes.
    pub forecast: Latest<MotionQuestion>,
    /// Where it is likely to be.
    pub density: Latest<DensityQuestion>,
    /// What computes densities; the CPU without.
    pub gpu: Option<Arc<DensityGpu>>,
    /// A training, under way or over.
    pub training: TrainingStatus<ResponseModel>,
    /// A comparison or an evaluation, under way or over.
    pub comparison: ComparisonStatus,
    /// Where a training is kept while it runs, so that it can go on after a crash.
    pub checkpoint: Option<PathBuf>,
}
