//! One-dimensional prior distributions as transformations of a standard normal variable.

use schemars::JsonSchema;
use serde::Serialize;

use impactlab_core::numerics::{NORMAL_QUANTILE_95, TruncatedNormal, normal_cdf};

/// Prior distribution of one quantity.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
#[serde(tag = "form", rename_all = "snake_case")]
pub enum Distribution {
    /// Each value of a range is equally likely.
    Uniform {
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
    },
    /// Normal, cut off at the ends of a range.
    Normal {
        /// Mean before it is cut off.
        mean: f64,
        /// Standard deviation before it is cut off.
        sigma: f64,
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
    },
    /// The logarithm is normal; cut off likewise.
    LogNormal {
        /// Median before it is cut off.
        median: f64,
        /// Standard deviation of the logarithm before it is cut off.
        sigma: f64,
        /// Lower end, more than 0.
        low: f64,
        /// Upper end.
        high: f64,
    },
}

impl Distribution {
    /// The value at a standard normal variable: the quantile `F⁻¹(Φ(z))`.
    ///
    /// ```text
    /// uniform   low + (high − low) Φ(z)
    /// ```
    ///
    /// A normal variable is a [`TruncatedNormal`], as is the logarithm of a lognormal one.
    pub fn at(&self, z: f64) -> f64 {
        let share = normal_cdf(z);
        match *self {
            Self::Uniform { low, high } => low + (high - low) * share,
            Self::Normal { mean, sigma, low, high } => {
                TruncatedNormal::new([mean, sigma], [low, high]).quantile(share)
            }
            Self::LogNormal { median, sigma, low, high } => {
                let log = TruncatedNormal::new([median.ln(), sigma], [low.ln(), high.ln()]);
                log.quantile(share).exp().clamp(low, high)
            }
        }
    }

    /// Central interval of 90 %.
    pub fn ninety(&self) -> [f64; 2] {
        [-NORMAL_QUANTILE_95, NORMAL_QUANTILE_95].map(|z| self.at(z))
    }

    /// The ends of the values that it can take.
    pub fn support(&self) -> [f64; 2] {
        match *self {
            Self::Uniform { low, high }
            | Self::Normal { low, high, .. }
            | Self::LogNormal { low, high, .. } => [low, high],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// “90 %” began at a share of 4.998 %.
    #[test]
    fn ninety_per_cent_of_a_range_leave_a_twentieth_at_each_end() {
        let [low, high] = Distribution::Uniform { low: 0.0, high: 80.0 }.ninety();
        assert!((low - 4.0).abs() < 1e-9 && (high - 76.0).abs() < 1e-9, "{low} {high}");
    }

    #[test]
    fn medians_ends_and_order_are_kept() {
        let all = [
            Distribution::Uniform { low: 2.0, high: 6.0 },
            Distribution::Normal { mean: 4.0, sigma: 1.0, low: 2.0, high: 6.0 },
            Distribution::LogNormal { median: 4.0, sigma: 0.2, low: 2.0, high: 8.0 },
        ];
        for distribution in all {
            assert!((distribution.at(0.0) - 4.0).abs() < 1e-9, "{distribution:?}");
            let [low, high] = distribution.support();
            let values: Vec<f64> =
                (-80..=80).map(|i| distribution.at(f64::from(i) / 4.0)).collect();
            assert!(values.windows(2).all(|pair| pair[0] <= pair[1]), "{distribution:?}");
            assert!(values.iter().all(|value| (low..=high).contains(value)), "{distribution:?}");
        }
        // Far from its ends a normal distribution is one.
        let wide = Distribution::Normal { mean: 1.0, sigma: 0.5, low: -99.0, high: 99.0 };
        assert!((wide.at(1.5) - 1.75).abs() < 1e-9);
    }
}
