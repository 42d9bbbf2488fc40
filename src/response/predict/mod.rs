//! The prediction: a trained model, what is uncertain along a whole motion, and the distribution of
//! the motion that follows.

mod latents;

pub(super) mod calibration;

mod model;

mod dynamics;

mod joint_state;

mod propagate;
#[cfg(test)]
mod propagate_tests;

mod predictor;

pub use latents::{LATENT_NAMES, LatentScales, N_LATENTS};
pub use model::ResponseModel;
pub(crate) use predictor::weighted_mean;
pub use predictor::{ComponentPath, MotionDistribution, Predictor};
pub use propagate::{ComponentMotion, StateDistribution};
