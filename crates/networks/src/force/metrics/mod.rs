//! Errors of predicted forces, and calibration and sharpness of predicted distributions.

mod curve_prediction;

mod aggregate;
mod point;
mod probabilistic;

pub use aggregate::{CurveMetrics, DistributionMetrics, IntervalCoverage};
pub use curve_prediction::CurvePrediction;
pub use point::PointErrors;
pub use probabilistic::{
    BAND_LEVELS, CaseCoverage, N_PIT_BINS, ProbabilisticScores, ProbabilisticSettings,
};
