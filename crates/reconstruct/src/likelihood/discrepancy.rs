//! What the forward model errs by, although every quantity is right: no model is exact.
//!
//! The error of the path is a displacement of the car and a turn of it that grow along the way and are
//! alike at neighbouring places, so that the points of a mark, the marks of all wheels and the rest
//! pose err together and are not counted as if each were a witness of its own:
//!
//! ```text
//! r_i = n_i·δ(s_i) + l_i ε(s_i) + noise            residual of an observation in the direction n_i
//! cov(δ(s), δ(s')) = a(s) a(s') k 1       a(s) = a₀ + a₁ s
//! cov(ε(s), ε(s')) = b(s) b(s') k         b(s) = b₀ + b₁ φ(s)      k = exp(−|s − s'|/L)
//! ```
//!
//! s is the distance that the CG has travelled, φ the angle that the car has turned, l the lever
//! `n·(e_z × ρ)` of a wheel at ρ from the CG. A share of the error of a wheel's point is its own.
//! With R = (r_1 …)ᵀ and its covariance C the density is a multivariate Student distribution, whose
//! common scale is open: if everything fits worse than expected, everything says less.
//!
//! ```text
//! ln p = −(ν + n)/2 ln(1 + Rᵀ C⁻¹ R/ν) − ½ ln det C + const
//! ```
//!
//! Form of the discrepancy: [`KennedyOHagan2001`](impactlab_core::bibliography::KennedyOHagan2001). Its sizes
//! are chosen on the 20 tuning cases of `datasets/staged` (BENCHMARKS.md).

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use serde::{Deserialize, Serialize};

/// Sizes of the errors of the forward model.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Discrepancy {
    /// Displacement at the start, a₀, m.
    pub position_m: f64,
    /// Displacement over the distance travelled, a₁.
    pub position_share: f64,
    /// Turn at the start, b₀, rad.
    pub heading_rad: f64,
    /// Turn over the angle turned, b₁.
    pub heading_share: f64,
    /// L over the whole distance travelled.
    pub correlation_share: f64,
    /// Error of a point of a wheel that no other point shares, over that of the car.
    pub own_share: f64,
    /// Error of the place at which a wheel begins and ceases to slide, m.
    pub onset_m: f64,
    /// The same over the distance travelled.
    pub onset_share: f64,
    /// Error of the recorded change of velocity over its size.
    pub delta_v_share: f64,
    /// Degrees of freedom ν.
    pub degrees_of_freedom: f64,
}

impl Default for Discrepancy {
    fn default() -> Self {
        Self {
            position_m: 0.05,
            position_share: 0.02,
            heading_rad: 0.03,
            heading_share: 0.05,
            correlation_share: 0.4,
            own_share: 0.15,
            onset_m: 1.2,
            onset_share: 0.04,
            delta_v_share: 0.04,
            degrees_of_freedom: 6.0,
        }
    }
}

/// One observed coordinate of the path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PathResidual {
    /// Distance travelled by the CG, m.
    pub travelled_m: f64,
    /// Angle turned, rad, 0 or more.
    pub turned_rad: f64,
    /// Direction of the residual, world axes; zero for a heading.
    pub direction: [f64; 2],
    /// What a turn of the car by 1 rad adds to the residual: m, or 1 for a heading.
    pub lever: f64,
    /// Found minus computed, m or rad.
    pub residual: f64,
    /// Standard deviation of the measurement.
    pub sigma: f64,
}

impl Discrepancy {
    fn displacement_m(&self, at: &PathResidual) -> f64 {
        self.position_m + self.position_share * at.travelled_m
    }

    fn turn_rad(&self, at: &PathResidual) -> f64 {
        self.heading_rad + self.heading_share * at.turned_rad
    }

    /// Standard deviation of the place where a wheel begins or ceases to slide, m.
    pub(crate) fn onset_sigma_m(&self, travelled_m: f64) -> f64 {
        self.onset_m + self.onset_share * travelled_m
    }

    /// Covariance of two residuals.
    fn covariance(&self, a: &PathResidual, b: &PathResidual, length_m: f64) -> f64 {
        let alike = (-(a.travelled_m - b.travelled_m).abs() / length_m).exp();
        let along = a.direction[0] * b.direction[0] + a.direction[1] * b.direction[1];
        let moved = self.displacement_m(a) * self.displacement_m(b) * along;
        let turned = self.turn_rad(a) * self.turn_rad(b) * a.lever * b.lever;
        alike * (moved + turned)
    }

    /// Variance of a residual by itself.
    pub(crate) fn variance(&self, at: &PathResidual) -> f64 {
        let [x, y] = at.direction;
        let own = self.own_share * self.displacement_m(at) * x.hypot(y);
        self.covariance(at, at, 1.0) + at.sigma * at.sigma + own * own
    }

    /// L of C = L Lᵀ; `None` where it is not positive definite.
    fn factor(&self, all: &[PathResidual], whole_m: f64) -> Option<Cholesky<f64, Dyn>> {
        let length_m = (self.correlation_share * whole_m).max(1.0);
        let c = DMatrix::from_fn(all.len(), all.len(), |i, j| match i == j {
            true => self.variance(&all[i]),
            false => self.covariance(&all[i], &all[j], length_m),
        });
        c.cholesky()
    }

    /// Errors L ξ of independent standard normal variables ξ; `None` where C has no factor.
    pub(crate) fn correlated(
        &self,
        all: &[PathResidual],
        whole_m: f64,
        noise: &[f64],
    ) -> Option<Vec<f64>> {
        let lower = self.factor(all, whole_m)?.l();
        Some((lower * DVector::from_column_slice(noise)).as_slice().to_vec())
    }

    /// Logarithm of the density of residuals, up to a constant, and their distance `Rᵀ C⁻¹ R`;
    /// −∞ where they are not finite.
    ///
    /// - `whole_m`: distance that the car travels in all, m.
    pub(crate) fn log_density(&self, all: &[PathResidual], whole_m: f64) -> f64 {
        let n = all.len();
        if n == 0 {
            return 0.0;
        }
        let Some(factor) = self.factor(all, whole_m) else { return f64::NEG_INFINITY };
        let r = DVector::from_fn(n, |i, _| all[i].residual);
        let solved = factor.l_dirty().solve_lower_triangular(&r);
        let Some(distance) = solved.map(|solved| solved.norm_squared()) else {
            return f64::NEG_INFINITY;
        };
        let half_log_det: f64 = factor.l_dirty().diagonal().iter().map(|d| d.ln()).sum();
        student(distance, n as f64, self.degrees_of_freedom) - half_log_det
    }
}

/// Logarithm of a Student density with a squared distance in n dimensions, up to a constant.
pub(crate) fn student(distance: f64, n: f64, degrees_of_freedom: f64) -> f64 {
    -(degrees_of_freedom + n) / 2.0 * (distance / degrees_of_freedom).ln_1p()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(travelled_m: f64, residual: f64) -> PathResidual {
        let (direction, lever, sigma) = ([0.0, 1.0], 0.0, 0.1);
        PathResidual { travelled_m, turned_rad: 0.0, direction, lever, residual, sigma }
    }

    #[test]
    fn neighbours_that_err_alike_say_less_than_those_that_err_by_turns() {
        let model = Discrepancy::default();
        let at = [30.0, 31.0, 32.0, 33.0, 34.0];
        let alike: Vec<_> = at.iter().map(|s| point(*s, 0.5)).collect();
        let by_turns: Vec<_> = at
            .iter()
            .enumerate()
            .map(|(i, s)| point(*s, if i % 2 == 0 { 0.5 } else { -0.5 }))
            .collect();
        let [alike, by_turns] = [&alike, &by_turns].map(|all| model.log_density(all, 40.0));
        assert!(alike > by_turns + 3.0, "{alike} {by_turns}");
    }

    #[test]
    fn without_discrepancy_the_density_is_that_of_independent_measurements() {
        let model = Discrepancy {
            position_m: 0.0,
            position_share: 0.0,
            heading_rad: 0.0,
            heading_share: 0.0,
            degrees_of_freedom: 1e9,
            ..Discrepancy::default()
        };
        let all = [point(3.0, 0.2), point(9.0, -0.1)];
        let expected = -0.5 * (4.0 + 1.0) - 2.0 * 0.1_f64.ln();
        assert!((model.log_density(&all, 20.0) - expected).abs() < 1e-6);
    }

    #[test]
    fn what_is_not_finite_is_impossible() {
        let density = Discrepancy::default().log_density(&[point(f64::NAN, 0.0)], 20.0);
        assert_eq!(density, f64::NEG_INFINITY);
    }
}
