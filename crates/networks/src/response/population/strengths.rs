//! The strengths of one car, and what its trajectories say of them.

use nalgebra::{DMatrix, DVector};

use crate::response::{N_EFFECTS, Widths};

/// The distribution of what is added to the strengths of the network for one car.
#[derive(Debug, Clone, PartialEq)]
pub struct CarStrengths {
    /// Mean, `[N_EFFECTS]`.
    pub mean: DVector<f64>,
    /// Covariance of what is common to all motions of the car, `[N_EFFECTS, N_EFFECTS]`.
    pub covariance: DMatrix<f64>,
    /// Share of the remainder of the network that holds for the car: 1 for one that the network has
    /// learned from.
    pub remainder: f64,
    /// How wide the distribution of a motion of the car is.
    pub widths: Widths,
}

/// What trajectories say of strengths: `Jᵀ V⁻¹ J` and `Jᵀ V⁻¹ (e + J d₀)`.
#[derive(Debug, Clone)]
pub(super) struct Evidence {
    pub precision: DMatrix<f64>,
    pub weighted: DVector<f64>,
}

impl Evidence {
    pub fn none() -> Self {
        Self {
            precision: DMatrix::zeros(N_EFFECTS, N_EFFECTS),
            weighted: DVector::zeros(N_EFFECTS),
        }
    }

    /// The same, counted so many times.
    #[must_use]
    pub fn times(mut self, share: f64) -> Self {
        self.precision *= share;
        self.weighted *= share;
        self
    }

    pub fn is_finite(&self) -> bool {
        self.precision.iter().chain(&self.weighted).all(|value| value.is_finite())
    }

    pub fn sum(all: impl IntoIterator<Item = Self>) -> Self {
        all.into_iter().fold(Self::none(), |mut sum, one| {
            sum.precision += one.precision;
            sum.weighted += one.weighted;
            sum
        })
    }
}

impl CarStrengths {
    /// The distribution after trajectories: `Σ = (Σ₀⁻¹ + A)⁻¹`, `m = Σ (Σ₀⁻¹ m₀ + b)`; this one if they
    /// are not finite.
    pub(super) fn updated(&self, evidence: &Evidence) -> Self {
        let updated = || {
            let prior = self.covariance.clone().cholesky()?.inverse();
            let root = (&prior + &evidence.precision).cholesky()?;
            let mean = root.solve(&(prior * &self.mean + &evidence.weighted));
            let is_finite = mean.iter().all(|value| value.is_finite());
            is_finite.then(|| Self { mean, covariance: root.inverse(), ..self.clone() })
        };
        updated().unwrap_or_else(|| self.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn evidence_of_one_strength_moves_it_and_what_goes_with_it() {
        let mut covariance = DMatrix::identity(N_EFFECTS, N_EFFECTS) * 0.04;
        covariance[(0, 1)] = 0.03;
        covariance[(1, 0)] = 0.03;
        let mean = DVector::zeros(N_EFFECTS);
        let prior = CarStrengths { mean, covariance, remainder: 1.0, widths: Widths::NORMAL };
        let mut evidence = Evidence::none();
        // Strength 0 is 0.5, measured with a variance of 0.04.
        evidence.precision[(0, 0)] = 25.0;
        evidence.weighted[0] = 12.5;
        let found = prior.updated(&evidence);
        assert!((found.mean[0] - 0.25).abs() < 1e-12, "{}", found.mean[0]);
        assert!((found.mean[1] - 0.1875).abs() < 1e-12, "{}", found.mean[1]);
        assert!((found.covariance[(0, 0)] - 0.02).abs() < 1e-12);
        assert!((found.covariance[(2, 2)] - 0.04).abs() < 1e-12);
        evidence.weighted[0] = f64::NAN;
        assert_eq!(prior.updated(&evidence), prior);
    }
}
