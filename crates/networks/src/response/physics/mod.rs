//! The physics of the motion: one step of the 4DOF model with a residual acceleration, what that
//! model leaves out though its form is known, and the 4DOF model with tuned parameters.

pub(super) mod step;

mod rollout;

mod motion_series;

pub(super) mod features;

pub(super) mod vehicle_tokens;

mod axle_effects;
pub(super) mod effects;

pub(super) mod effects_fit;

pub(super) mod step_operations;

pub(super) mod effect_operation;

mod tuned;

pub use effects::{Effects, N_EFFECTS, combined, effects};
pub use effects_fit::EffectsConfig;
pub use features::{FEATURE_MIRROR, IS_OF_MODEL, N_FEATURES, features};
pub use motion_series::motion_series;
pub use rollout::{average_error_m, rollout};
pub use step::{Correction, N_RESIDUAL, RESIDUAL_MIRROR, STEP_S, step};
pub use tuned::{Tuning, TuningConfig};
pub use vehicle_tokens::{N_TOKEN_NUMBERS, N_TOKENS, vehicle_tokens};
