//! The motion after an impact: trajectories to learn from, and the response network around the 4DOF
//! vehicle.

mod case;
pub mod comparison;
mod config;
mod error;

mod axle_effects;
mod effects;
mod features;
mod step;
mod vehicle_tokens;

mod dense;
mod dynamics;
mod effect_operation;
mod effects_fit;
mod folded_attention;
mod network;
mod network_layers;
mod one_step;
mod physics_points;
mod physics_weight;
mod simulated;
mod step_operations;

mod calibration;
mod joint_state;
mod latents;
mod load;
mod loss;
mod model;
mod motion_log;
mod motion_series;
mod predictor;
mod propagate;
#[cfg(test)]
mod propagate_tests;
mod record;
mod rollout;
mod rollout_loss;
mod train;
mod training_file;
mod training_run;
mod tuned;
mod vehicle_network;

pub use case::{ResponseCase, ResponseCaseError};
pub use config::{
    CalibrationConfig, PhysicsSchedule, PhysicsTrend, PretrainingConfig, ResponseConfig,
    ResponseLossWeights, ResponseNetworkConfig, RolloutConfig, SingleStepConfig,
};
pub use effects::{Effects, N_EFFECTS, combined, effects};
pub use effects_fit::EffectsConfig;
pub use error::ResponseError;
pub use features::{FEATURE_MIRROR, IS_OF_MODEL, N_FEATURES, features};
pub use latents::{LATENT_NAMES, LatentScales, N_LATENTS};
pub use load::ResponseLoadError;
pub use loss::ResponseLossTerms;
pub use model::ResponseModel;
pub use motion_log::{ForceOrigin, LogError, LogNoise, LogSettings, LoggedImpact, MotionLog};
pub use motion_series::motion_series;
pub(crate) use predictor::weighted_mean;
pub use predictor::{ComponentPath, MotionDistribution, Predictor};
pub use propagate::{ComponentMotion, StateDistribution};
pub use record::{ResponseEpoch, ResponseRecord, ResponseStage, ResponseTrainingSet};
pub use rollout::{average_error_m, rollout};
pub use simulated::ImpactRecord;
pub use step::{Correction, N_RESIDUAL, RESIDUAL_MIRROR, STEP_S, step};
pub use train::{ResponseProgress, ResponseReport, ResponseTrainSettings, fine_tune, pretrain};
pub use tuned::{Tuning, TuningConfig};
pub use vehicle_tokens::{N_TOKEN_NUMBERS, N_TOKENS, vehicle_tokens};
