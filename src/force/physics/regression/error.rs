//! What no baseline can do.

use crate::collision::{ImpactError, PulseError};
use crate::numerics::GaussianProcessError;
use crate::uncertainty::MixtureError;

/// A baseline that cannot be fitted or asked.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BaselineError {
    /// No case to learn from.
    #[error("a baseline fitted to no cases")]
    NoCases,
    /// The momentum solution has no impulse to scale by: the vehicles do not approach.
    #[error("the vehicles do not approach: the momentum solution has no impulse")]
    NotApproaching,
    /// The momentum solution fails.
    #[error("the momentum solution fails")]
    Impact(#[from] ImpactError),
    /// The pulse is no pulse.
    #[error("the pulse is out of range")]
    Pulse(#[from] PulseError),
    /// The regression fails.
    #[error("the regression fails")]
    Regression(#[from] GaussianProcessError),
    /// The spread is no distribution.
    #[error("the spread is no distribution")]
    Mixture(#[from] MixtureError),
}
