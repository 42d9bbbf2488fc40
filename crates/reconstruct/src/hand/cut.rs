//! How an input of a method by hand is drawn.

use crate::hand::HandNumber;
use impactlab_core::numerics::{normal_cdf, normal_quantile};

/// A normal distribution that is cut off at the limits of a range.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cut {
    value: f64,
    sigma: f64,
    limits: [f64; 2],
    /// Probabilities below the limits without the cut.
    below: [f64; 2],
}

impl Cut {
    pub fn new(number: &HandNumber) -> Self {
        let HandNumber { field, value, sigma, .. } = *number;
        let limits = [field.range.low, field.range.high];
        let below = limits.map(|limit| normal_cdf((limit - value) / sigma));
        Self { value, sigma, limits, below }
    }

    /// The value with a probability below it.
    pub fn at(&self, probability: f64) -> f64 {
        let [low, high] = self.below;
        let z = normal_quantile(low + probability * (high - low));
        (self.value + self.sigma * z).clamp(self.limits[0], self.limits[1])
    }
}
