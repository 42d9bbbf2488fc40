//! Principal components of the shapes, and regressions of coefficients, onset and length.

use nalgebra::DMatrix;

use serde::{Deserialize, Serialize};

use crate::force::ForceCase;
use crate::force::regression::alignment::SHAPE_CELLS;
use crate::force::regression::scales::{Scales, unusual};
use crate::force::regression::{Alignment, CurveFitError, CurveRegressionOptions};
use crate::nn::{Expected, NnError, check_length, check_numbers};
use impactlab_core::numerics::{GaussianPrediction, GaussianProcess, GaussianProcessData};

/// Added to onsets, which may be zero, before their logarithm is taken, s.
const ONSET_FLOOR_S: f64 = 2e-3;

/// Weight of all coefficients of a shape together in the likelihood of their hyperparameters, in
/// outputs. It is less than their number since they are not independent.
const COEFFICIENTS_WEIGHT: f64 = 3.0;

/// Mean and principal components of the shapes, and the regressions that predict their coefficients.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Shapes {
    mean: Vec<f64>,
    /// Unit vectors, by falling share of the variance.
    components: Vec<Vec<f64>>,
    /// Standard deviation of the part that the components do not explain.
    residual_std: Vec<f64>,
    length: GaussianProcess,
    onset: GaussianProcess,
    coefficients: GaussianProcess,
}

impl Shapes {
    /// Checks the shapes from a file, as [`CurveRegression::check`](super::CurveRegression::check).
    pub(super) fn check(&self, name: &str) -> Result<(), NnError> {
        let n_values = 2 * SHAPE_CELLS;
        check_length(&format!("{name}.mean"), self.mean.len(), n_values)?;
        check_length(&format!("{name}.residual_std"), self.residual_std.len(), n_values)?;
        let std = format!("{name}.residual_std");
        check_numbers(&std, &self.residual_std, Expected::NotNegative)?;
        for (i, component) in self.components.iter().enumerate() {
            check_length(&format!("{name}.components[{i}]"), component.len(), n_values)?;
        }
        check_length(&format!("{name}.length"), self.length.n_outputs(), 1)?;
        check_length(&format!("{name}.onset"), self.onset.n_outputs(), 1)
    }

    pub(super) fn fit(
        cases: &[&ForceCase],
        scales: &Scales,
        options: CurveRegressionOptions,
    ) -> Result<Self, CurveFitError> {
        let CurveRegressionOptions { alignment, n_components, .. } = options;
        let unusual = unusual(cases);
        let shapes: Vec<Vec<f64>> = cases.iter().map(|case| shape_of(alignment, case)).collect();
        let basis =
            Basis::from_shapes(&shapes, &unusual, n_components).ok_or(CurveFitError::NoCases)?;
        let inputs = cases.iter().map(|case| Ok(scales.row(&case.scenario)?.0));
        let inputs: Vec<Vec<f64>> = inputs.collect::<Result<_, CurveFitError>>()?;
        let regress = |outputs: &[Vec<f64>], weights: &[f64]| {
            let data = GaussianProcessData { inputs: &inputs, outputs, unusual: &unusual, weights };
            GaussianProcess::fit(&data)
        };
        let intervals: Vec<(f64, f64)> =
            cases.iter().map(|case| alignment.interval_s(case)).collect();
        let lengths: Vec<Vec<f64>> = intervals.iter().map(|(_, l)| vec![l.ln()]).collect();
        let onsets: Vec<Vec<f64>> =
            intervals.iter().map(|(start, _)| vec![(start + ONSET_FLOOR_S).ln()]).collect();
        let coefficients: Vec<Vec<f64>> =
            shapes.iter().map(|shape| basis.coefficients(shape)).collect();
        Ok(Self {
            length: regress(&lengths, &[])?,
            onset: regress(&onsets, &[])?,
            coefficients: regress(&coefficients, &basis.weights)?,
            residual_std: basis.residual_std(&shapes, &unusual),
            mean: basis.mean,
            components: basis.components,
        })
    }

    /// The same with the first `n_components` only.
    pub(super) fn truncated(mut self, n_components: usize) -> Self {
        self.components.truncate(n_components);
        self
    }

    /// `ln T` and `ln (t₀ + floor)`.
    pub(super) fn predict_times(
        &self,
        row: &[f64],
    ) -> Result<[GaussianPrediction; 2], CurveFitError> {
        Ok([self.length.predict(row)?, self.onset.predict(row)?])
    }

    pub(super) fn predict_coefficients(
        &self,
        row: &[f64],
    ) -> Result<GaussianPrediction, CurveFitError> {
        let mut prediction = self.coefficients.predict(row)?;
        for values in [&mut prediction.mean, &mut prediction.std, &mut prediction.std_unusual] {
            values.truncate(self.components.len());
        }
        Ok(prediction)
    }

    pub(super) fn shape(&self, coefficients: &[f64]) -> Vec<f64> {
        let mut shape = self.mean.clone();
        for (component, coefficient) in self.components.iter().zip(coefficients) {
            for (sum, value) in shape.iter_mut().zip(component) {
                *sum += coefficient * value;
            }
        }
        shape
    }

    pub(super) fn residual_std(&self) -> &[f64] {
        &self.residual_std
    }
}

/// Onset of a regressed logarithm, s.
pub(super) fn start_s(ln_start: f64) -> f64 {
    ln_start.exp() - ONSET_FLOOR_S
}

fn shape_of(alignment: Alignment, case: &ForceCase) -> Vec<f64> {
    alignment.placement(case).shape_of(&case.curve)
}

/// Principal components of usual shapes.
struct Basis {
    mean: Vec<f64>,
    components: Vec<Vec<f64>>,
    /// Share of the variance of each component, scaled to [`COEFFICIENTS_WEIGHT`].
    weights: Vec<f64>,
}

impl Basis {
    /// By the eigenvectors of the Gram matrix, as there are fewer shapes than values. `None` for
    /// fewer than two usual shapes.
    fn from_shapes(shapes: &[Vec<f64>], unusual: &[bool], n_components: usize) -> Option<Self> {
        let usual = shapes.iter().zip(unusual).filter(|(_, unusual)| !**unusual);
        let mut usual: Vec<&Vec<f64>> = usual.map(|(shape, _)| shape).collect();
        if usual.len() < 2 {
            usual = shapes.iter().collect();
        }
        let (n, n_values) = (usual.len(), usual.first()?.len());
        if n < 2 {
            return None;
        }
        let sum = |j: usize| usual.iter().filter_map(|shape| shape.get(j)).sum::<f64>();
        let mean: Vec<f64> = (0..n_values).map(|j| sum(j) / n as f64).collect();
        let centred = DMatrix::from_fn(n, n_values, |i, j| usual[i][j] - mean[j]);
        let gram = (&centred * centred.transpose()).symmetric_eigen();
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by(|a, b| gram.eigenvalues[*b].total_cmp(&gram.eigenvalues[*a]));
        order.truncate(n_components.clamp(1, n - 1));
        let component = |idx: &usize| {
            let direction = centred.tr_mul(&gram.eigenvectors.column(*idx));
            let norm = direction.norm().max(f64::MIN_POSITIVE);
            direction.iter().map(|value| value / norm).collect()
        };
        let variance = |idx: &usize| gram.eigenvalues[*idx].max(0.0);
        let total = order.iter().map(variance).sum::<f64>().max(f64::MIN_POSITIVE);
        Some(Self {
            components: order.iter().map(component).collect(),
            weights: order.iter().map(|i| COEFFICIENTS_WEIGHT * variance(i) / total).collect(),
            mean,
        })
    }

    fn coefficients(&self, shape: &[f64]) -> Vec<f64> {
        let off: Vec<f64> =
            shape.iter().zip(&self.mean).map(|(value, mean)| value - mean).collect();
        let dot = |component: &Vec<f64>| component.iter().zip(&off).map(|(a, b)| a * b).sum();
        self.components.iter().map(dot).collect()
    }

    /// Root mean square over usual shapes of the part that the components do not explain.
    fn residual_std(&self, shapes: &[Vec<f64>], unusual: &[bool]) -> Vec<f64> {
        let (mut squares, mut n) = (vec![0.0; self.mean.len()], 0.0);
        for (shape, _) in shapes.iter().zip(unusual).filter(|(_, unusual)| !**unusual) {
            let mut left: Vec<f64> = shape.iter().zip(&self.mean).map(|(s, m)| s - m).collect();
            for (component, c) in self.components.iter().zip(self.coefficients(shape)) {
                for (value, part) in left.iter_mut().zip(component) {
                    *value -= c * part;
                }
            }
            squares.iter_mut().zip(left).for_each(|(sum, value)| *sum += value * value);
            n += 1.0;
        }
        squares.into_iter().map(|sum| (sum / f64::max(n, 1.0)).sqrt()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_of_two_directions_have_two_components() {
        let shape = |a: f64, b: f64| vec![1.0 + a, 2.0 + b, 3.0 - a, b];
        let shapes: Vec<Vec<f64>> =
            (0..9).map(|i| shape(f64::from(i).sin(), 0.3 * f64::from(i * i).cos())).collect();
        let basis = Basis::from_shapes(&shapes, &[false; 9], 2).unwrap();
        for shape in &shapes {
            let c = basis.coefficients(shape);
            for (j, value) in shape.iter().enumerate() {
                let back =
                    basis.mean[j] + c[0] * basis.components[0][j] + c[1] * basis.components[1][j];
                assert!((back - value).abs() < 1e-9, "{shape:?}");
            }
        }
        assert!((basis.weights.iter().sum::<f64>() - COEFFICIENTS_WEIGHT).abs() < 1e-9);
        assert!(basis.residual_std(&shapes, &[false; 9]).iter().all(|std| *std < 1e-9));
        assert!(Basis::from_shapes(&shapes[..1], &[false], 2).is_none());
    }
}
