//! Non-linear least squares by the method of Levenberg and Marquardt.
//!
//! The method is implemented here because the maintained crate for it requires another version of
//! `nalgebra`.

use std::ops::ControlFlow;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Step of the forward differences, in units of the scale of each parameter.
const DIFFERENCE: f64 = 1e-4;
/// Damping λ of the first step.
const FIRST_DAMPING: f64 = 1e-2;
/// Damping above which no further step is tried.
const MAX_DAMPING: f64 = 1e8;
/// Relative decrease of the cost with one Jacobian below which the search ends.
const MIN_GAIN: f64 = 1e-4;

/// Largest number of steps with one Jacobian. A Jacobian costs one evaluation of the residuals per
/// parameter, so that it is used again while the steps lower the cost considerably.
const STEPS_PER_JACOBIAN: usize = 3;
/// Relative decrease of the cost by a step from which another step with the same Jacobian is tried.
const GOOD_GAIN: f64 = 0.02;

/// Residuals r(x) whose squares are minimised. A function of the parameters is one.
pub trait LeastSquaresProblem: Sync {
    /// The residuals at given parameters, always of the same number; `None` if they have no value there,
    /// so that no step leads there.
    fn residuals(&self, x: &[f64]) -> Option<Vec<f64>>;

    /// The same where a single parameter has moved. Problems in which a parameter changes few of the
    /// residuals compute only these.
    ///
    /// - `x`: with the parameter moved;
    /// - `idx`: of that parameter;
    /// - `before`: the residuals with the parameter where it was.
    fn with_one_moved(&self, x: &[f64], _idx: usize, _before: &[f64]) -> Option<Vec<f64>> {
        self.residuals(x)
    }
}

impl<F: Fn(&[f64]) -> Option<Vec<f64>> + Sync> LeastSquaresProblem for F {
    fn residuals(&self, x: &[f64]) -> Option<Vec<f64>> {
        self(x)
    }
}

/// The result of [`levenberg_marquardt`].
#[derive(Debug, Clone, PartialEq)]
pub struct LeastSquares {
    /// The parameters with the smallest cost that was found.
    pub parameters: Vec<f64>,
    /// Cost ½ ‖r‖² at these parameters.
    pub cost: f64,
    /// Number of Jacobians that were computed.
    pub n_steps: usize,
}

/// Minimises ½ ‖r(x)‖² by the method of Levenberg and Marquardt with a Jacobian J from forward
/// differences. The columns of the Jacobian are computed in parallel; the result does not depend on
/// the number of threads.
///
/// ```text
/// (JᵀJ + λ 1) δ = −Jᵀ r      x ← x + scale ⊙ δ if the cost falls, else λ ← 4 λ
/// ```
///
/// J is taken with respect to x / scale. λ is divided by 3 after a step that lowers the cost.
///
/// Source: D. Marquardt, SIAM J. Appl. Math. 11 (1963) 431–441.
///
/// - `problem`: the residuals r.
/// - `start`: parameters at which the search starts.
/// - `scale`: expected change of each parameter, positive, in its own unit.
/// - `max_steps`: largest number of Jacobians; each is followed by up to three steps.
/// - `report`: called with the cost before each Jacobian; if it breaks, the search ends with the
///   parameters found so far.
/// - returns `None` if the residuals have no value or no finite cost at the start.
pub fn levenberg_marquardt(
    problem: &impl LeastSquaresProblem,
    [start, scale]: [&[f64]; 2],
    max_steps: usize,
    report: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Option<LeastSquares> {
    let sized = |residuals: Vec<f64>| {
        let r = DVector::from_vec(residuals);
        let cost = 0.5 * r.norm_squared();
        cost.is_finite().then_some((r, cost))
    };
    let at = |x: &[f64]| sized(problem.residuals(x)?);
    let mut x = start.to_vec();
    let (mut r, mut cost) = at(&x)?;
    let (mut damping, mut n_steps) = (FIRST_DAMPING, 0);
    while n_steps < max_steps && report(cost).is_continue() {
        let columns: Vec<DVector<f64>> = (0..x.len())
            .into_par_iter()
            .map(|j| {
                let mut moved = x.clone();
                moved[j] += DIFFERENCE * scale[j];
                let there = problem.with_one_moved(&moved, j, r.as_slice()).and_then(sized);
                there.map_or_else(|| DVector::zeros(r.len()), |(s, _)| (s - &r) / DIFFERENCE)
            })
            .collect();
        let jacobian = DMatrix::from_columns(&columns);
        let normal = jacobian.tr_mul(&jacobian);
        let before = cost;
        for _ in 0..STEPS_PER_JACOBIAN {
            let gradient = jacobian.tr_mul(&r);
            let mut next = None;
            while next.is_none() && damping < MAX_DAMPING {
                let damped = &normal + DMatrix::identity(x.len(), x.len()) * damping;
                next = damped.cholesky().and_then(|factor| {
                    let step = factor.solve(&gradient);
                    let moved: Vec<f64> =
                        x.iter().zip(&step).zip(scale).map(|((x, d), s)| x - d * s).collect();
                    at(&moved).filter(|(_, new)| *new < cost).map(|(r, new)| (moved, r, new))
                });
                damping = if next.is_some() { damping / 3.0 } else { damping * 4.0 };
            }
            let Some((moved, new_r, new_cost)) = next else { break };
            let gain = (cost - new_cost) / cost;
            (x, r, cost) = (moved, new_r, new_cost);
            if gain < GOOD_GAIN {
                break;
            }
        }
        n_steps += 1;
        damping = damping.min(MAX_DAMPING / 1e4);
        if before - cost < MIN_GAIN * before {
            break;
        }
    }
    Some(LeastSquares { parameters: x, cost, n_steps })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn search(residuals: &impl LeastSquaresProblem, start: &[f64]) -> LeastSquares {
        let scale = vec![1.0; start.len()];
        let go_on = &mut |_: f64| ControlFlow::Continue(());
        levenberg_marquardt(residuals, [start, &scale], 200, go_on).unwrap()
    }

    #[test]
    fn rosenbrock_is_solved_to_its_minimum() {
        let rosenbrock = |x: &[f64]| Some(vec![10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0]]);
        let found = search(&rosenbrock, &[-1.2, 1.0]);
        assert!(found.cost < 1e-8, "{found:?}");
        assert!((found.parameters[0] - 1.0).abs() < 1e-3, "{found:?}");
    }

    #[test]
    fn a_start_without_value_is_none_and_breaking_stops() {
        let scale = [1.0];
        let go_on = &mut |_: f64| ControlFlow::Continue(());
        assert!(levenberg_marquardt(&|_: &[f64]| None, [&[0.0], &scale], 5, go_on).is_none());
        let stop = &mut |_: f64| ControlFlow::Break(());
        let residuals = |x: &[f64]| Some(vec![x[0] - 1.0]);
        let found = levenberg_marquardt(&residuals, [&[0.0], &scale], 5, stop).unwrap();
        assert_eq!((found.parameters, found.n_steps), (vec![0.0], 0));
    }
}
