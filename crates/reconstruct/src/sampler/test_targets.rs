//! Targets whose posterior is known.

use nalgebra::{DMatrix, DVector};

use super::Target;

/// A target given by a function.
pub(crate) struct Function<F> {
    pub dim: usize,
    pub log_likelihood: F,
}

impl<F: Fn(&[f64]) -> f64 + Sync> Target for Function<F> {
    fn dim(&self) -> usize {
        self.dim
    }

    fn log_likelihoods(&self, z: &[Vec<f64>]) -> Vec<f64> {
        use rayon::prelude::*;
        z.par_iter().map(|z| (self.log_likelihood)(z)).collect()
    }
}

/// Logarithm of a normal density without its constant.
pub(crate) fn normal(x: f64, mean: f64, std: f64) -> f64 {
    -0.5 * ((x - mean) / std).powi(2) - std.ln()
}

/// Measurements `y = A z + noise` of twenty variables, of which the sharpest has a noise of 0.004:
/// a tire mark of ± 0.1 m over 25 m.
pub(crate) struct LinearGaussian {
    a: DMatrix<f64>,
    y: DVector<f64>,
    noise: DVector<f64>,
}

impl LinearGaussian {
    pub fn narrow() -> Self {
        // Fixed numbers between −1 and 1 without a pattern.
        let entry = |i: usize, j: usize| ((i * 20 + j) as f64 * 12.9898).sin() * 43.5 % 1.0;
        Self {
            a: DMatrix::from_fn(6, 20, entry),
            y: DVector::from_row_slice(&[-0.7, 0.0, 0.7, -0.7, 0.0, 0.7]),
            noise: DVector::from_row_slice(&[0.004, 0.01, 0.02, 0.1, 0.1, 0.3]),
        }
    }

    /// The same measurements with noise that is so many times as large.
    pub fn with_noise_times(mut self, factor: f64) -> Self {
        self.noise *= factor;
        self
    }

    /// Mean, covariance and log evidence in closed form:
    ///
    /// ```text
    /// S = A Aᵀ + R    m = Aᵀ S⁻¹ y    C = I − Aᵀ S⁻¹ A    ln Z = ln N(y; 0, S) + n/2 ln 2π
    /// ```
    pub fn closed_form(&self) -> (DVector<f64>, DMatrix<f64>, f64) {
        let r = DMatrix::from_diagonal(&self.noise.component_mul(&self.noise));
        let s = (&self.a * self.a.transpose() + r).cholesky().unwrap();
        let mean = self.a.transpose() * s.solve(&self.y);
        let covariance = DMatrix::identity(20, 20) - self.a.transpose() * s.solve(&self.a);
        let ln_det: f64 = s.l().diagonal().iter().map(|l| l.ln()).sum();
        (mean, covariance, -ln_det - self.y.dot(&s.solve(&self.y)) / 2.0)
    }
}

impl Target for LinearGaussian {
    fn dim(&self) -> usize {
        20
    }

    fn log_likelihoods(&self, z: &[Vec<f64>]) -> Vec<f64> {
        let log_likelihood = |z: &Vec<f64>| {
            let found = &self.a * DVector::from_column_slice(z);
            let terms = found.iter().zip(self.y.iter()).zip(self.noise.iter());
            terms.map(|((found, y), noise)| normal(*found, *y, *noise)).sum()
        };
        z.iter().map(log_likelihood).collect()
    }
}

/// Two modes in twenty dimensions, 10 σ apart, with the weights 0.8 (z₀ > 0) and 0.2.
pub(crate) fn bimodal() -> Function<impl Fn(&[f64]) -> f64 + Sync> {
    let log_likelihood = |z: &[f64]| {
        let common: f64 = z[3..8].iter().map(|z| normal(*z, 0.5, 0.1)).sum();
        let mode = |weight: f64, sign: f64| {
            weight.ln() + normal(z[0], 1.5 * sign, 0.3) + normal(z[1] - z[2], sign, 0.1)
        };
        let [a, b] = [mode(0.8, 1.0), mode(0.2, -1.0)];
        a.max(b) + (-(a - b).abs()).exp().ln_1p() + common
    };
    Function { dim: 20, log_likelihood }
}

/// A wheel that is locked where z₀ > 0.5, which shifts two measurements, and a place that is
/// impossible. The probability of a locked wheel and the log evidence follow from one-dimensional
/// normals; see the test.
pub(crate) fn discontinuous() -> Function<impl Fn(&[f64]) -> f64 + Sync> {
    let log_likelihood = |z: &[f64]| {
        let locked = f64::from(u8::from(z[0] > 0.5));
        if z[6] > 1.0 {
            return f64::NEG_INFINITY;
        }
        normal(z[1] + 1.5 * locked, 0.3, 0.05)
            + normal(z[2] - 0.3 * z[3] + 0.8 * locked, 0.3, 0.05)
            + normal(z[4] + z[5], 1.0, 0.02)
    };
    Function { dim: 20, log_likelihood }
}
