//! Logarithm of the probability density of a whole force curve. The covariance of a component is a
//! low-rank update of a matrix that is cheap to invert, so that the density follows from Woodbury's
//! identity and the matrix determinant lemma, without forming the full covariance.
//!
//! Source: [`GolubVanLoan2013`](crate::bibliography::GolubVanLoan2013), section 2.1.4. Checked
//! against the density by the full covariance matrix.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};

use crate::numerics::ln_sum_exp;
use crate::uncertainty::{CurveComponent, CurveMixture, ForceCurve, MixtureError};

impl CurveMixture {
    /// Natural logarithm of the joint density of the forces (N) and the duration (s) of a curve.
    ///
    /// ```text
    /// ln p(y) = ln Σ_k π_k N(y; m_k, U_k U_kᵀ + √D_k R_k √D_k)
    /// ```
    ///
    /// - `curve`: has as many instants as the mixture.
    ///
    /// # Errors
    /// [`MixtureError::Shape`] for a curve with another number of instants.
    pub fn log_density(&self, curve: &ForceCurve) -> Result<f64, MixtureError> {
        let values = curve.to_values();
        let mut logs = Vec::with_capacity(self.components().len());
        for (idx, component) in self.components().iter().enumerate() {
            let (expected, got) = (component.mean.len(), values.len());
            if got != expected {
                return Err(MixtureError::Shape { component: idx, what: "curve", expected, got });
            }
            logs.push(component.weight.ln() + component.log_density(&values));
        }
        Ok(ln_sum_exp(&logs))
    }
}

impl CurveComponent {
    /// Natural logarithm of the component's density at a row of 2T + 1 values, without its weight.
    ///
    /// ```text
    /// z, W: y − m and U, whitened     A = I + Wᵀ W = L Lᵀ     b = Wᵀ z
    /// −2 ln N = n ln 2π + Σ ln d_i + 2 (T − 1) ln(1 − φ²) + 2 Σ ln L_jj + |z|² − |L⁻¹ b|²
    /// ```
    fn log_density(&self, values: &[f64]) -> f64 {
        let n_factors = self.factors.ncols();
        let residual: Vec<f64> = values.iter().zip(&self.mean).map(|(y, m)| y - m).collect();
        let residual = DVector::from_vec(self.whitened(residual.iter()));
        let columns: Vec<DVector<f64>> = self
            .factors
            .column_iter()
            .map(|column| DVector::from_vec(self.whitened(column.iter())))
            .collect();
        let inner = DMatrix::from_fn(n_factors, n_factors, |a, b| {
            columns[a].dot(&columns[b]) + f64::from(u8::from(a == b))
        });
        let projected = DVector::from_iterator(n_factors, columns.iter().map(|w| w.dot(&residual)));
        let n_steps = 2 * (values.len() / 2).saturating_sub(1);
        let log_own: f64 = self.variance.iter().map(|d| d.ln()).sum::<f64>()
            + n_steps as f64 * (1.0 - self.lag_correlation.powi(2)).ln();
        // `inner` is the identity plus a Gram matrix, which is positive definite for finite
        // factors.
        let Some(cholesky) = inner.cholesky() else { return f64::NAN };
        let explained = cholesky.solve(&projected).dot(&projected);
        let log_determinant = log_own + 2.0 * cholesky.l_dirty().diagonal().map(f64::ln).sum();
        let square = residual.norm_squared() - explained;
        -(values.len() as f64 * TAU.ln() + log_determinant + square) / 2.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::uncertainty::mixture::tests::{covariance, example};

    /// Log density of a row of values by the full covariance matrix.
    fn dense_log_density(mixture: &CurveMixture, values: &[f64]) -> f64 {
        let density = |component: &CurveComponent| {
            let covariance = covariance(component);
            let residual =
                DVector::from_row_slice(values) - DVector::from_row_slice(&component.mean);
            let quadratic = residual.dot(&(covariance.clone().try_inverse().unwrap() * &residual));
            let log = values.len() as f64 * TAU.ln() + covariance.determinant().ln() + quadratic;
            component.weight * (-log / 2.0).exp()
        };
        mixture.components().iter().map(density).sum::<f64>().ln()
    }

    #[test]
    fn it_is_that_of_the_covariance_in_full() {
        let mixture = example(3, 6);
        for shift in [0.0, 0.3, -1.0] {
            let mut values = mixture.components()[1].mean.clone();
            for (i, value) in values.iter_mut().enumerate() {
                *value *= 1.0 + 0.05 * shift * (i as f64).cos();
            }
            let log = mixture.log_density(&ForceCurve::from_values(&values)).unwrap();
            let dense = dense_log_density(&mixture, &values);
            assert!((log - dense).abs() < 1e-7 * dense.abs(), "{shift}: {log}, dense {dense}");
        }
    }

    #[test]
    fn a_far_curve_has_a_finite_log_density() {
        let mixture = example(2, 50);
        let far = ForceCurve { fx_n: vec![1e7; 50], fy_n: vec![-1e7; 50], duration_s: 3.0 };
        assert!(mixture.log_density(&far).unwrap().is_finite());
        assert!(mixture.log_density(&ForceCurve::default()).is_err());
    }
}
