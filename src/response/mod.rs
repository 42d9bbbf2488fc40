//! The motion after an impact: trajectories to learn from, and the response network around the 4DOF
//! vehicle.

mod case;
mod config;
mod error;
mod features;
mod model;
mod network;
mod one_step;
mod rollout;
mod rollout_training;
mod step;
mod step_operations;
mod train;
mod tuned;
mod vehicle_tokens;

pub use case::{ResponseCase, ResponseCaseError};
pub use config::{ResponseConfig, ResponseNetworkConfig, ResponseTrainingConfig};
pub use error::ResponseError;
pub use features::{FEATURE_MIRROR, N_FEATURES, features};
pub use model::{ComponentPath, ResponseModel};
pub use rollout::{average_error_m, rollout};
pub use step::{N_RESIDUAL, RESIDUAL_MIRROR, STEP_S, step};
pub use train::ResponseProgress;
pub use tuned::{Tuning, TuningConfig};
pub use vehicle_tokens::{N_TOKEN_NUMBERS, N_TOKENS, vehicle_tokens};
