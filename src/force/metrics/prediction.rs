//! What a force model says of a case.

use crate::uncertainty::{CurveMixture, ForceCurve};

/// Point estimates and, if the model has one, a distribution; in canonical axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Prediction {
    /// Curve and duration.
    pub curve: ForceCurve,
    /// Impulse, N s.
    pub impulse_n_s: [f64; 2],
    /// Largest `|F|`, N.
    pub peak_n: f64,
    /// Distribution of curve and duration.
    pub mixture: Option<CurveMixture>,
}

impl Prediction {
    /// A curve alone: impulse and peak are its own.
    pub fn of_curve(curve: ForceCurve) -> Self {
        let (impulse_n_s, peak_n) = (curve.impulse_n_s(), curve.peak().0);
        Self { curve, impulse_n_s, peak_n, mixture: None }
    }

    /// A distribution, and the part of it from which the point estimates come: curve, impulse and
    /// peak are those of its mean, the duration is its median. Drawn curves are rougher than the
    /// recorded ones, so that the median of their peaks lies too high; it gives the intervals.
    pub fn of_mixture(mixture: CurveMixture, likely: &CurveMixture) -> Self {
        let mut prediction = Self::of_curve(likely.mean());
        prediction.curve.duration_s = likely.duration_s().quantile(0.5);
        prediction.mixture = Some(mixture);
        prediction
    }
}
