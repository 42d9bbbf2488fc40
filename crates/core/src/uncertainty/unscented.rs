//! The unscented transform: mean and covariance of a non-linear function of a random vector, from
//! evaluations at sigma points around the mean.
//!
//! ```text
//! χ_0 = m    χ_i = m ± (√((n + λ) P))_i        λ = α² (n + κ) − n
//! W_0^m = λ/(n + λ)    W_0^c = W_0^m + 1 − α² + β    W_i = 1/(2 (n + λ))
//! ```
//!
//! Source: S. J. Julier, J. K. Uhlmann, Unscented Filtering and Nonlinear Estimation, Proc. IEEE 92
//! (2004) 401–422; `eq:sigma_points_gmm` of [`PitPinnPaper`](crate::bibliography::PitPinnPaper).
//!
//! Departure from the paper: its α = 1e-3 gives the centre a weight of some −10⁶, with which single
//! precision loses 8 m in 120 m. Here α = 1 is used, in double precision.

use nalgebra::{SMatrix, SVector};

/// Parameters that determine the distance of the sigma points from the mean and their weights.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unscented {
    /// α: scale of the distance of the sigma points from the mean.
    pub alpha: f64,
    /// β: correction of the centre's weight in the covariance by the shape of the distribution; 2
    /// for normal distributions.
    pub beta: f64,
    /// κ: second parameter of the distance, added to the number of dimensions.
    pub kappa: f64,
}

impl Default for Unscented {
    fn default() -> Self {
        Self { alpha: 1.0, beta: 2.0, kappa: 0.0 }
    }
}

/// Distance and weights of the sigma points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UnscentedWeights {
    /// √(n + λ): distance of the outer points from the mean, in standard deviations.
    pub reach: f64,
    /// W_0^m: weight of the centre in the mean.
    pub centre_mean: f64,
    /// W_0^c: weight of the centre in the covariance.
    pub centre_covariance: f64,
    /// W_i: weight of each outer point in the mean and in the covariance.
    pub other: f64,
}

impl Unscented {
    /// The parameters of the paper: α = 1e-3, β = 2, κ = 0.
    pub fn paper() -> Self {
        Self { alpha: 1e-3, ..Self::default() }
    }

    /// Distance and weights of the sigma points in `n` dimensions.
    pub fn weights(&self, n: usize) -> UnscentedWeights {
        let n = n as f64;
        let scale = self.alpha * self.alpha * (n + self.kappa);
        let centre_mean = (scale - n) / scale;
        UnscentedWeights {
            reach: scale.sqrt(),
            centre_mean,
            centre_covariance: centre_mean + 1.0 - self.alpha * self.alpha + self.beta,
            other: 0.5 / scale,
        }
    }

    /// Mean `[M]` and covariance `[M, M]` of `f(x)` for a random vector x of a given mean `[N]` and
    /// covariance `[N, N]`; `None` if the covariance is not positive definite.
    pub fn transform<const N: usize, const M: usize>(
        &self,
        mean: &SVector<f64, N>,
        covariance: &SMatrix<f64, N, N>,
        f: impl Fn(&SVector<f64, N>) -> SVector<f64, M>,
    ) -> Option<(SVector<f64, M>, SMatrix<f64, M, M>)> {
        let weights = self.weights(N);
        let root = covariance.cholesky()?.unpack() * weights.reach;
        let centre = f(mean);
        let others: Vec<SVector<f64, M>> = root
            .column_iter()
            .flat_map(|column| [f(&(mean + column)), f(&(mean - column))])
            .collect();
        // Sums are taken relative to the value at the centre, so that large weights of opposite
        // sign cancel before they multiply large numbers.
        let off: SVector<f64, M> = others.iter().map(|point| point - centre).sum();
        let moved = off * weights.other;
        let spread: SMatrix<f64, M, M> = others
            .iter()
            .map(|point| {
                let off = point - centre - moved;
                off * off.transpose() * weights.other
            })
            .sum();
        Some((centre + moved, spread + moved * moved.transpose() * weights.centre_covariance))
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix2, Vector2};

    use super::*;

    #[test]
    fn a_linear_function_is_exact_and_weights_sum_to_one() {
        let mean = Vector2::new(1.0, -2.0);
        let covariance = Matrix2::new(2.0, 0.5, 0.5, 1.0);
        let turn = Matrix2::new(0.6, -0.8, 0.8, 0.6);
        for unscented in [Unscented::default(), Unscented::paper()] {
            let (m, p) = unscented.transform(&mean, &covariance, |x| turn * x).unwrap();
            assert!((m - turn * mean).norm() < 1e-9, "{m}");
            assert!((p - turn * covariance * turn.transpose()).norm() < 1e-6, "{p}");
            let weights = unscented.weights(2);
            assert!((weights.centre_mean + 4.0 * weights.other - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn the_mean_of_a_square_is_that_of_a_normal_distribution() {
        let (m, p) = Unscented::default()
            .transform(&SVector::<f64, 1>::new(3.0), &SMatrix::<f64, 1, 1>::new(0.25), |x| {
                SVector::<f64, 1>::new(x[0] * x[0])
            })
            .unwrap();
        // The exact moments are E x² = m² + s² and Var x² = 4 m² s² + 2 s⁴.
        assert!((m[0] - 9.25).abs() < 1e-12, "{m}");
        assert!((p[(0, 0)] - (9.0 + 2.0 * 0.0625)).abs() < 0.07, "{p}");
    }

    #[test]
    fn a_covariance_that_is_none_is_refused() {
        let covariance = Matrix2::new(1.0, 2.0, 2.0, 1.0);
        assert!(Unscented::default().transform(&Vector2::zeros(), &covariance, |x| *x).is_none());
    }
}
