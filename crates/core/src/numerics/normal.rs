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

#[cfg(test)]
mod tests {
    use super::*;

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
