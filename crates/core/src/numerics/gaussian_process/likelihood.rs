//! The marginal likelihood of a Gaussian process and the hyperparameters that maximise it.
//!
//! Source: [`RasmussenWilliams2006`](crate::bibliography::RasmussenWilliams2006), section 5.4.1.

use std::cell::RefCell;
use std::rc::Rc;

use argmin::core::{CostFunction, Error, Executor, Gradient};
use argmin::solver::linesearch::MoreThuenteLineSearch;
use argmin::solver::quasinewton::LBFGS;
use nalgebra::{DMatrix, Dim, Matrix, RawStorage, U1};

/// Variance of the noise that is always added, as a share of the variance of an output. It keeps
/// the covariance matrix positive definite.
const MIN_NOISE: f64 = 1e-6;

/// Largest number of iterations of the optimiser.
const MAX_STEPS: u64 = 60;

/// Number of past steps from which L-BFGS approximates the Hessian.
const MEMORY: usize = 7;

/// Norm of the gradient of the cost per sample at which the optimiser stops. Predictions no longer
/// change noticeably at this gradient.
const GRADIENT_TOLERANCE: f64 = 1e-4;

/// Normal priors `(mean, standard deviation)` of the logarithms of the hyperparameters. The lengths
/// are about 2.5 standard deviations of an input, the other standard deviations are of the order of
/// that of an output. The priors are broad: one standard deviation is a factor of e or more.
const PRIOR_LENGTH: (f64, f64) = (0.916, 1.0);
const PRIOR_SIGNAL: (f64, f64) = (0.0, 1.5);
const PRIOR_LINEAR: (f64, f64) = (-0.5, 1.5);
const PRIOR_NOISE: (f64, f64) = (-1.0, 1.0);
const PRIOR_UNUSUAL: (f64, f64) = (0.0, 1.0);

/// Number of hyperparameters besides the lengths.
pub(super) const N_VARIANCES: usize = 4;

/// The hyperparameters `l_j`, `s_f`, `s_l`, `s_n` and `s_u` of the covariance, given by their
/// natural logarithms in this order.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Hyperparameters {
    log: Vec<f64>,
    /// Inverse squares of the lengths, `1/l_j²`.
    inverse_square: Vec<f64>,
    /// Variances `s_f²`, `s_l²`, `s_n²` and `s_u²`.
    signal: f64,
    linear: f64,
    noise: f64,
    unusual: f64,
}

impl Hyperparameters {
    /// Computes the variances from the logarithms of the lengths and of the four standard
    /// deviations.
    pub(super) fn new(log: Vec<f64>) -> Self {
        let n_lengths = log.len().saturating_sub(N_VARIANCES);
        let variance = |idx: usize| log.get(n_lengths + idx).map_or(0.0, |log| (2.0 * log).exp());
        let inverse_square = log.iter().take(n_lengths).map(|log| (-2.0 * log).exp()).collect();
        let [signal, linear, noise, unusual] = [0, 1, 2, 3].map(variance);
        Self { inverse_square, signal, linear, noise, unusual, log }
    }

    /// Covariance `k(a, b)` of the function at two standardised inputs, without noise.
    pub(super) fn kernel<R: Dim, C: Dim, S, S2>(
        &self,
        a: &Matrix<f64, U1, R, S>,
        b: &Matrix<f64, U1, C, S2>,
    ) -> f64
    where
        S: RawStorage<f64, U1, R>,
        S2: RawStorage<f64, U1, C>,
    {
        let (mut square, mut dot) = (0.0, 0.0);
        for ((a, b), inverse) in a.iter().zip(b.iter()).zip(&self.inverse_square) {
            square += (a - b) * (a - b) * inverse;
            dot += a * b;
        }
        self.signal * (-square / 2.0).exp() + self.linear * (dot + 1.0)
    }

    /// Covariance matrix `[samples, samples]` of the samples with their noise.
    pub(super) fn covariance(&self, inputs: &DMatrix<f64>, unusual: &[bool]) -> DMatrix<f64> {
        let rows: Vec<_> = inputs.row_iter().collect();
        let mut covariance = DMatrix::zeros(rows.len(), rows.len());
        for (i, row) in rows.iter().enumerate() {
            let is_unusual = unusual.get(i).copied().unwrap_or(false);
            for (j, other) in rows.iter().enumerate().take(i + 1) {
                let noise = if i == j { self.noise(is_unusual) } else { 0.0 };
                let value = self.kernel(row, other) + noise;
                covariance[(i, j)] = value;
                covariance[(j, i)] = value;
            }
        }
        covariance
    }

    /// The logarithms from which the hyperparameters were made.
    pub(super) fn into_log(self) -> Vec<f64> {
        self.log
    }

    /// Variance of the noise of a usual or an unusual sample.
    pub(super) fn noise(&self, unusual: bool) -> f64 {
        MIN_NOISE + self.noise + if unusual { self.unusual } else { 0.0 }
    }
}

/// The standardised samples, for which the marginal likelihood is computed.
pub(super) struct Likelihood {
    inputs: DMatrix<f64>,
    outputs: DMatrix<f64>,
    unusual: Vec<bool>,
    weights: Vec<f64>,
}

/// Cost and gradient at a point in the space of hyperparameters.
#[derive(Clone)]
struct LikelihoodEvaluation {
    at: Vec<f64>,
    cost: f64,
    gradient: Vec<f64>,
}

impl Likelihood {
    pub(super) fn new(
        inputs: DMatrix<f64>,
        outputs: DMatrix<f64>,
        unusual: Vec<bool>,
        weights: Vec<f64>,
    ) -> Self {
        Self { inputs, outputs, unusual, weights }
    }

    /// Finds the hyperparameters with the largest product of likelihood and prior by L-BFGS,
    /// starting from the means of the prior. If the line search fails, the best point found so far
    /// is used.
    pub(super) fn maximise(self: &Likelihood) -> Hyperparameters {
        let start: Vec<f64> = self.priors().iter().map(|(mean, _)| *mean).collect();
        let best = Rc::new(RefCell::new(None::<LikelihoodEvaluation>));
        let problem =
            LikelihoodProblem { likelihood: self, last: RefCell::new(None), best: best.clone() };
        let line_search = MoreThuenteLineSearch::new();
        let solver = LBFGS::new(line_search, MEMORY).with_tolerance_grad(GRADIENT_TOLERANCE);
        let ended = solver.and_then(|solver| {
            let executor = Executor::new(problem, solver);
            executor.configure(|state| state.param(start.clone()).max_iters(MAX_STEPS)).run()
        });
        drop(ended);
        let best = best.borrow_mut().take();
        Hyperparameters::new(best.map_or(start, |best| best.at))
    }

    /// The prior `(mean, standard deviation)` of each logarithm.
    fn priors(&self) -> Vec<(f64, f64)> {
        let lengths = std::iter::repeat_n(PRIOR_LENGTH, self.inputs.ncols());
        lengths.chain([PRIOR_SIGNAL, PRIOR_LINEAR, PRIOR_NOISE, PRIOR_UNUSUAL]).collect()
    }

    /// The negative logarithm of likelihood and prior, divided by the number of samples, and its
    /// gradient. The cost is infinite where the covariance matrix is not positive definite.
    ///
    /// ```text
    /// L = Σ_o w_o (½ y_oᵀ K⁻¹ y_o + ½ ln |K|) + prior      α_o = K⁻¹ y_o
    /// ∂L/∂h = ½ tr(G ∂K/∂h)                               G = Σ_o w_o (K⁻¹ − α_o α_oᵀ)
    /// ```
    ///
    /// Here o runs over the outputs y_o with the weights w_o.
    fn evaluate(&self, at: &[f64]) -> LikelihoodEvaluation {
        let h = Hyperparameters::new(at.to_vec());
        let n_parameters = at.len();
        let Some(cholesky) = h.covariance(&self.inputs, &self.unusual).cholesky() else {
            let gradient = vec![0.0; n_parameters];
            return LikelihoodEvaluation { at: at.to_vec(), cost: f64::INFINITY, gradient };
        };
        let n = self.inputs.nrows() as f64;
        let mut alpha = cholesky.solve(&self.outputs);
        let weight: f64 = self.weights.iter().sum();
        let half_log: f64 = cholesky.l_dirty().diagonal().map(f64::ln).sum();
        let mut cost = weight * half_log;
        for (j, w) in self.weights.iter().enumerate() {
            cost += w * self.outputs.column(j).dot(&alpha.column(j)) / 2.0;
            alpha.column_mut(j).scale_mut(w.sqrt());
        }
        let outer = cholesky.inverse() * weight - &alpha * alpha.transpose();
        let mut gradient = self.trace_products(&outer, &h);
        for ((g, value), (mean, std)) in gradient.iter_mut().zip(at).zip(self.priors()) {
            cost += ((value - mean) / std).powi(2) / 2.0;
            *g = (*g + (value - mean) / (std * std)) / n;
        }
        LikelihoodEvaluation { at: at.to_vec(), cost: cost / n, gradient }
    }

    /// The derivatives `½ tr(G ∂K/∂h)` with respect to the logarithm h of each hyperparameter.
    fn trace_products(&self, outer: &DMatrix<f64>, h: &Hyperparameters) -> Vec<f64> {
        let (n, d) = self.inputs.shape();
        let mut gradient = vec![0.0; d + N_VARIANCES];
        let rows: Vec<Vec<f64>> =
            self.inputs.row_iter().map(|row| row.iter().copied().collect()).collect();
        let mut squares = vec![0.0; d];
        for i in 0..n {
            for j in 0..=i {
                // The matrix is symmetric, so that an entry off the diagonal occurs twice.
                let g = outer[(i, j)] * if i == j { 1.0 } else { 2.0 };
                let (mut sum, mut dot) = (0.0, 0.0);
                for (k, (a, b)) in rows[i].iter().zip(&rows[j]).enumerate() {
                    squares[k] = (a - b) * (a - b) * h.inverse_square[k];
                    sum += squares[k];
                    dot += a * b;
                }
                let smooth = g * h.signal * (-sum / 2.0).exp();
                for (entry, square) in gradient.iter_mut().zip(&squares) {
                    *entry += smooth * square / 2.0;
                }
                gradient[d] += smooth;
                gradient[d + 1] += g * h.linear * (dot + 1.0);
            }
            gradient[d + 2] += outer[(i, i)] * h.noise;
            if self.unusual[i] {
                gradient[d + 3] += outer[(i, i)] * h.unusual;
            }
        }
        gradient
    }
}

/// The likelihood in the form that `argmin` requires. Cost and gradient at a point are computed
/// together and only once.
struct LikelihoodProblem<'a> {
    likelihood: &'a Likelihood,
    last: RefCell<Option<LikelihoodEvaluation>>,
    best: Rc<RefCell<Option<LikelihoodEvaluation>>>,
}

impl LikelihoodProblem<'_> {
    fn at(&self, parameters: &[f64]) -> LikelihoodEvaluation {
        if let Some(last) = self.last.borrow().as_ref().filter(|last| last.at == parameters) {
            return last.clone();
        }
        let evaluation = self.likelihood.evaluate(parameters);
        let mut best = self.best.borrow_mut();
        let is_better = best.as_ref().is_none_or(|best| evaluation.cost < best.cost);
        if is_better && evaluation.cost.is_finite() {
            *best = Some(evaluation.clone());
        }
        *self.last.borrow_mut() = Some(evaluation.clone());
        evaluation
    }
}

impl CostFunction for LikelihoodProblem<'_> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, parameters: &Vec<f64>) -> Result<f64, Error> {
        Ok(self.at(parameters).cost)
    }
}

impl Gradient for LikelihoodProblem<'_> {
    type Param = Vec<f64>;
    type Gradient = Vec<f64>;

    fn gradient(&self, parameters: &Vec<f64>) -> Result<Vec<f64>, Error> {
        Ok(self.at(parameters).gradient)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn likelihood() -> Likelihood {
        let n = 15;
        let inputs = DMatrix::from_fn(n, 2, |i, j| ((i * (3 + 2 * j)) as f64).sin());
        let outputs = DMatrix::from_fn(n, 2, |i, j| (i as f64 * 0.7 + j as f64).cos());
        let unusual = (0..n).map(|i| i % 5 == 0).collect();
        Likelihood::new(inputs, outputs, unusual, vec![1.0, 0.4])
    }

    #[test]
    fn the_gradient_is_that_of_finite_differences() {
        let likelihood = likelihood();
        let at = [0.3, -0.2, 0.1, -0.4, -1.2, 0.2];
        let gradient = likelihood.evaluate(&at).gradient;
        for (k, got) in gradient.iter().enumerate() {
            let step = 1e-5;
            let moved = |by: f64| {
                let mut at = at;
                at[k] += by;
                likelihood.evaluate(&at).cost
            };
            let expected = (moved(step) - moved(-step)) / (2.0 * step);
            assert!((got - expected).abs() < 1e-7, "{k}: {got}, expected {expected}");
        }
    }

    #[test]
    fn the_optimum_has_no_slope() {
        let likelihood = likelihood();
        let optimum = likelihood.evaluate(&likelihood.maximise().log);
        let start: Vec<f64> = likelihood.priors().iter().map(|(mean, _)| *mean).collect();
        assert!(optimum.cost < likelihood.evaluate(&start).cost);
        let slope = optimum.gradient.iter().map(|g| g * g).sum::<f64>().sqrt();
        assert!(slope < 1e-3, "{slope}");
    }
}
