//! The standard normal distribution.

use std::f64::consts::{PI, SQRT_2};

use statrs::function::erf::{erfc, erfc_inv};

/// Normal quantile of 0.95: an interval of 90 % reaches so many standard deviations from its median to both
/// sides.
pub const NORMAL_QUANTILE_95: f64 = 1.644_853_626_951_472_2;

/// Standard deviation of a normal variable over its median absolute deviation.
pub const SIGMA_PER_MAD: f64 = 1.4826;

/// Probability density at z: `φ(z) = exp(−z²/2) / √(2π)`.
pub fn normal_density(z: f64) -> f64 {
    (-z * z / 2.0).exp() / (2.0 * PI).sqrt()
}

/// Probability `Φ(z)` that a standard normal variable is at most z.
pub fn normal_cdf(z: f64) -> f64 {
    erfc(-z / SQRT_2) / 2.0
}

/// The quantile z for which `Φ(z) = probability`; −∞ at 0, +∞ at 1 and NaN outside this range.
pub fn normal_quantile(probability: f64) -> f64 {
    -SQRT_2 * erfc_inv(2.0 * probability)
}

/// A normal distribution that is cut off at both ends.
///
/// ```text
/// F⁻¹(p) = μ + σ Φ⁻¹(Φ(a) + (Φ(b) − Φ(a)) p)        a, b: the ends from the mean, in units of σ
/// ```
///
/// ```
/// # use impactlab_core::numerics::TruncatedNormal;
/// let positive = TruncatedNormal::new([0.0, 2.0], [0.0, f64::INFINITY]);
/// assert_eq!(positive.share(), 0.5);
/// assert!((positive.quantile(0.5) - 2.0 * 0.674_489_75).abs() < 1e-6);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TruncatedNormal {
    mean: f64,
    sigma: f64,
    ends: [f64; 2],
    /// Probabilities below the ends without the cut.
    below: [f64; 2],
}

impl TruncatedNormal {
    /// - `[mean, sigma]`: before it is cut off, the standard deviation more than 0;
    /// - `ends`: in increasing order, infinite where it is not cut off.
    pub fn new([mean, sigma]: [f64; 2], ends: [f64; 2]) -> Self {
        let below = ends.map(|end| normal_cdf((end - mean) / sigma));
        Self { mean, sigma, ends, below }
    }

    /// Probability of its range without the cut, 0 to 1.
    pub fn share(&self) -> f64 {
        self.below[1] - self.below[0]
    }

    /// The value between the ends below which it lies with a probability, 0 to 1.
    pub fn quantile(&self, probability: f64) -> f64 {
        // The quantile is infinite at 0 and 1.
        let share = (self.below[0] + self.share() * probability).clamp(1e-15, 1.0 - 1e-15);
        (self.mean + self.sigma * normal_quantile(share)).clamp(self.ends[0], self.ends[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The share of the range below each quantile is its probability, whichever end there is.
    #[test]
    fn quantiles_of_a_truncated_normal_have_their_probabilities_between_its_ends() {
        let (mean, sigma) = (3.0, 0.5);
        let (no, all) = (f64::NEG_INFINITY, f64::INFINITY);
        for ends in [[2.5, 4.5], [no, 3.2], [3.2, all], [no, all], [4.0, 4.1]] {
            let cut = TruncatedNormal::new([mean, sigma], ends);
            let below = |value: f64| normal_cdf((value - mean) / sigma);
            assert!((cut.share() - (below(ends[1]) - below(ends[0]))).abs() < 1e-12, "{ends:?}");
            for probability in [0.0, 0.01, 0.3, 0.5, 0.9, 1.0] {
                let value = cut.quantile(probability);
                assert!(value.is_finite() && (ends[0]..=ends[1]).contains(&value), "{ends:?}");
                let found = (below(value) - below(ends[0])) / cut.share();
                assert!((found - probability).abs() < 1e-6, "{ends:?} {probability}: {found}");
            }
        }
    }

    #[test]
    fn the_quantile_inverts_the_probability() {
        for probability in [1e-6, 0.025, 0.25, 0.5, 0.841_344_746_068_542_9, 0.999] {
            let z = normal_quantile(probability);
            assert!((normal_cdf(z) - probability).abs() < 1e-10, "{probability}: {z}");
        }
        assert!((normal_quantile(0.841_344_746_068_542_9) - 1.0).abs() < 1e-9);
        assert!((normal_density(0.0) - 0.398_942_280_401).abs() < 1e-12);
    }
}
