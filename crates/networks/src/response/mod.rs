//! The motion after an impact: trajectories to learn from, and the response network around the 4DOF
//! vehicle model.

mod config;
mod memory;

mod physics;

mod network;

mod train;

mod predict;

mod population;

pub mod evaluate;

mod motion_log;

pub use config::{
    CalibrationConfig, PhysicsSchedule, PhysicsTrend, PretrainingConfig, ResponseConfig,
    ResponseLossWeights, ResponseNetworkConfig, RolloutConfig, SingleStepConfig,
};
pub use motion_log::{ForceOrigin, LogError, LogNoise, LogSettings, LoggedImpact, MotionLog};
pub use network::ResponseLossTerms;
pub use physics::{
    Correction, Effects, EffectsConfig, FEATURE_MIRROR, IS_OF_MODEL, N_EFFECTS, N_FEATURES,
    N_RESIDUAL, N_TOKEN_NUMBERS, N_TOKENS, RESIDUAL_MIRROR, STEP_S, Tuning, TuningConfig,
    average_error_m, combined, effects, features, motion_series, rollout, step, vehicle_tokens,
};
pub use population::{CarStrengths, KnownCar, StrengthPopulation};
pub use population::{UnseenCar, is_same_car};
pub use predict::weighted_mean;
pub(crate) use predict::with_resistance;
pub use predict::{
    Applicability, ComponentPath, CoupledDraw, LATENT_NAMES, LEAST_MOTIONS, LatentScales,
    MotionDistribution, MotionDomain, N_LATENTS, N_NAMED_LATENTS, OutsideDomain, Predictor,
    RESISTANCE_SCATTER, ResponseModel, RestSearch, SettledMotion, SettledMotions, Widths,
};
pub use train::{
    ImpactRecord, RESPONSE_CHECKPOINT, ResponseCase, ResponseCaseError, ResponseEpoch,
    ResponseRecord, ResponseStage, ResponseTrainSettings, ResponseTraining, ResponseTrainingSet,
    UnseenCars, condition, fine_tune, learn_population, pretrain, recalibrate, train_fleet,
};
