//! The prediction: a trained model, what is uncertain along a whole motion, and the distribution of
//! the motion that follows.

mod domain;

mod latents;

pub(super) mod calibration;

mod model;

mod dynamics;

mod joint_state;

mod side_by_side;

mod propagate;
#[cfg(test)]
mod propagate_tests;

pub(super) mod predictor;

mod path_draws;

mod to_rest;

mod in_contact;

pub use domain::{Applicability, MotionDomain, OutsideDomain};
pub use in_contact::CoupledDraw;
pub use latents::{LATENT_NAMES, LatentScales, N_LATENTS, N_NAMED_LATENTS, Widths};
pub(crate) use latents::{Latents, N_OF_COLLISION};
pub use model::ResponseModel;
pub use predictor::weighted_mean;
pub use predictor::{ComponentPath, MotionDistribution, Predictor};
pub use propagate::{ComponentMotion, StateDistribution};
pub(crate) use to_rest::with_resistance;
pub use to_rest::{RESISTANCE_SCATTER, RestSearch, SettledMotion};
