//! Why a regression or baseline cannot be fitted or give a force curve.

use impactlab_core::collision::{ImpactError, PulseError};
use impactlab_core::numerics::GaussianProcessError;
use impactlab_core::uncertainty::MixtureError;

/// A regression or a baseline that cannot be fitted to cases, or has no curve for a scenario.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CurveFitError {
    /// There is no case to learn from.
    #[error("there are no cases to fit to")]
    NoCases,
    /// The momentum solution has no impulse to scale by: the vehicles do not approach.
    #[error("the vehicles do not approach: the momentum solution has no impulse")]
    NotApproaching,
    /// The momentum solution fails.
    #[error("the momentum solution fails")]
    Impact(#[from] ImpactError),
    /// The parameters of the pulse are out of range.
    #[error("the pulse is out of range")]
    Pulse(#[from] PulseError),
    /// A Gaussian process cannot be fitted or evaluated.
    #[error("the regression fails")]
    Regression(#[from] GaussianProcessError),
    /// The drawn curves give no distribution.
    #[error("the drawn curves give no distribution")]
    Mixture(#[from] MixtureError),
}
