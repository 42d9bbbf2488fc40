//! The contact force before it happens: cases to learn from, the force network, its baselines, and
//! how well they do.
//!
//! Cases: [`ForceCase`], [`split`](crate::learning::split()). Network: [`ForceConfig`], [`train()`], [`ForceModel::predict`].
//! Metrics: [`metrics`].

mod error;

mod input;

pub mod metrics;

mod config;
mod memory;

mod physics;

mod network;

mod train;

mod predict;

mod evaluate;

pub use config::{Centre, CrushConfig, ForceConfig, LossWeights, NetworkConfig, TrainingConfig};
pub use error::ForceError;
pub use evaluate::{
    BaselineMetrics, CaseErrors, ClusterMetrics, ComparedMetrics, CrossValidation, DomainMetrics,
    EvaluateError, Evaluation, EvaluationError, EvaluationSettings, FittedBaselines, ForceMetrics,
    baselines, cross_validate, evaluate, evaluate_model,
};
pub use input::{ContactLaw, ForceCase, ForceCaseError, ForceScenario, curve_on_grid};
pub use metrics::CurvePrediction;
pub use network::{OpenFeatures, OutsideTraining, Standardisation};
pub use physics::{
    CentreCurve, CentreModel, MOMENTUM_DIRECTION_STD_RAD, MOMENTUM_IMPULSE_LOG_STD, MomentumModel,
    regression,
};
pub use predict::{ForcePrediction, SHARE_OF_NETWORK};
pub use regression::ColumnSet;
pub use train::{
    FORCE_CHECKPOINT, FarFactors, ForceEpoch, ForceModel, ForceRecord, ForceTrainSettings,
    ForceTraining, ForceTrainingSet, LossTerms, VarianceCalibration, VarianceFactors, fit_physics,
    train, train_around,
};
