//! The contact force before it happens: cases to learn from, the force network, its baselines, and
//! how well they do.
//!
//! Cases: [`ForceCase`], [`split`](crate::data::split). Network: [`ForceConfig`], [`train`], [`ForceModel::predict`].
//! Figures: [`metrics`].

mod error;

mod scenario;

mod case;
mod load;

mod momentum;

mod config;

mod centre;
mod committee;
mod features;

mod batch;
mod calibration;
mod loss;
mod network;

mod record;
mod residuals;

mod train;
mod training_file;

mod model;
mod predict;

mod prediction;

mod clusters;
pub mod metrics;

pub mod baselines;

mod evaluation;

mod evaluate_model;

pub use calibration::VarianceFactors;
pub use case::{ForceCase, ForceCaseError, curve_on_grid};
pub use centre::{CentreCurve, CentreFit, CentreModel};
pub use clusters::{ImpulseClusters, ImpulseFeatures};
pub use config::{Centre, CrushConfig, ForceConfig, LossWeights, NetworkConfig, TrainingConfig};
pub use error::ForceError;
pub use evaluate_model::{
    Compared, CrossValidation, EvaluateError, cross_validate, evaluate_model,
};
pub use evaluation::{
    BaselineFigures, CaseErrors, ClusterFigures, Evaluation, EvaluationError, EvaluationSettings,
    FittedBaselines, ModelFigures, evaluate,
};
pub use features::{OpenFeatures, OutsideTraining, Standardisation};
pub use load::LoadError;
pub use loss::LossTerms;
pub use model::ForceModel;
pub use momentum::MomentumModel;
pub use predict::ForcePrediction;
pub use prediction::Prediction;
pub use record::{CaseId, EpochRecord, TrainingRecord, TrainingSet};
pub use scenario::ForceScenario;
pub use train::{
    TrainSettings, TrainingProgress, TrainingReport, fit_physics, train, train_around,
};
