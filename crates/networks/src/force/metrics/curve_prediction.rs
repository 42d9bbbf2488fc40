//! What any force model, network, regression or baseline, predicts for a case.

use impactlab_core::numerics::{median, random_stream};
use impactlab_core::uncertainty::{CurveMixture, ForceCurve};

/// Number of curves that are drawn for the median of their peaks.
const N_PEAKS: usize = 500;

/// Point estimates and, if the model has one, a distribution, in canonical axes.
#[derive(Debug, Clone, PartialEq)]
pub struct CurvePrediction {
    /// Curve and duration.
    pub curve: ForceCurve,
    /// Impulse, N s.
    pub impulse_n_s: [f64; 2],
    /// Largest `|F|`, N.
    pub peak_n: f64,
    /// Distribution of curve and duration.
    pub mixture: Option<CurveMixture>,
    /// How far the model applies to the case, 0 to 1; 1 for a model that does not say.
    pub applicability: f64,
}

impl CurvePrediction {
    /// The prediction of a curve alone, with the impulse and the peak of this curve.
    pub fn from_curve(curve: ForceCurve) -> Self {
        let (impulse_n_s, peak_n) = (curve.impulse_n_s(), curve.peak().0);
        Self { curve, impulse_n_s, peak_n, mixture: None, applicability: 1.0 }
    }

    /// The prediction of a distribution, with point estimates from a part of it.
    ///
    /// Curve and impulse are those of the mean of `likely`; peak and duration are its medians, as they
    /// are told.
    pub fn from_mixture(mixture: CurveMixture, likely: &CurveMixture) -> Self {
        let mut prediction = Self::from_curve(likely.mean());
        prediction.curve.duration_s = likely.duration_s().quantile(0.5);
        let (_, drawn) = likely.sample_quantities(N_PEAKS, &mut random_stream(0, "peaks", 0));
        prediction.peak_n = median(drawn.peak_n).unwrap_or(prediction.peak_n);
        prediction.mixture = Some(mixture);
        prediction
    }
}
