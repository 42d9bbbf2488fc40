//! Factors on the largest force of drawn curves.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Factors on the peaks of drawn curves.
///
/// ```text
/// peak = scale · p̄ · (p / p̄)^spread      p: largest |F| of the drawn curve, p̄: of the mean curve
/// ```
///
/// A normal distribution that is right about the force at every instant and about the impulse need not be
/// so about the largest force: drawn curves are rougher than recorded ones, and mean curves flatter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PeakFactors {
    /// Factor on all peaks.
    pub scale: f64,
    /// Factor on the deviation of their logarithms.
    pub spread: f64,
}

impl Default for PeakFactors {
    /// Factors that leave peaks unchanged.
    fn default() -> Self {
        Self { scale: 1.0, spread: 1.0 }
    }
}

impl PeakFactors {
    /// The peak that is told of a drawn curve, N.
    ///
    /// - `peak_n`: the largest force of the curve, N;
    /// - `mean_n`: that of the mean curve, N; where it is zero, the peak stays as it is.
    pub fn apply(self, peak_n: f64, mean_n: f64) -> f64 {
        match mean_n > 0.0 {
            true => self.scale * mean_n * (peak_n / mean_n).powf(self.spread),
            false => peak_n,
        }
    }
}
