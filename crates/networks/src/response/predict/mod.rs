//! The prediction: a trained model, what is uncertain along a whole motion, and the distribution of
//! the motion that follows.

mod domain;

mod latents;

pub(super) mod calibration;

mod model;

mod dynamics;

mod side_by_side;

mod abreast;

pub(super) mod predictor;

mod distribution;

mod forecast;
#[cfg(test)]
mod test_motions;

mod to_rest;

mod in_contact;

pub use distribution::MotionDistribution;
pub use domain::{Applicability, MotionDomain, OutsideDomain};
pub use forecast::LEAST_MOTIONS;
pub use in_contact::CoupledDraw;
pub use latents::{LATENT_NAMES, LatentScales, N_LATENTS, N_NAMED_LATENTS, Widths};
pub(crate) use latents::{Latents, N_OF_COLLISION};
pub use model::ResponseModel;
pub use predictor::weighted_mean;
pub use predictor::{ComponentPath, Predictor};
pub(crate) use to_rest::with_resistance;
pub use to_rest::{RESISTANCE_SCATTER, RestSearch, SettledMotion, SettledMotions};
