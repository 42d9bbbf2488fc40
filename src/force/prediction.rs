//! What a force model says of a case.

use rand::Rng;

use crate::uncertainty::{CurveFigures, CurveMixture, ForceCurve};

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

    /// A distribution, and the part of it from which the point estimates come: the curve is the
    /// mean of that; peak and duration are the medians of draws, as the mean of curves that peak at
    /// different times is too flat; the impulse is that of the mean.
    ///
    /// - `n_samples`: draws for the medians, 1 or more.
    pub fn of_mixture(
        mixture: CurveMixture,
        likely: &CurveMixture,
        n_samples: usize,
        rng: &mut impl Rng,
    ) -> Self {
        let figures = likely.sample_figures(n_samples, rng);
        let mut prediction = Self::of_curve(likely.mean());
        if let Some(peak_n) = CurveFigures::median(&figures.peak_n) {
            prediction.peak_n = peak_n;
        }
        prediction.curve.duration_s = likely.duration_s().quantile(0.5);
        prediction.mixture = Some(mixture);
        prediction
    }
}
