//! The most probable point, found by a particle swarm, with its curvature as the uncertainty.
//!
//! ```text
//! f(z) = −ln L(z) + |z|²/2       z* = argmin f      C = H⁻¹,  H = ∂²f/∂z² at z*
//! ```
//!
//! What programs for reconstruction offer at best: one course of events and a normal distribution
//! about it. Newton steps refine what the swarm has found. H is taken by central differences whose
//! steps are chosen so that f grows by about [`RISE`]; eigenvalues below 1, the curvature of the
//! prior, are raised to 1, since a measurement widens nothing.

use argmin::core::{CostFunction, Error, Executor, State, SyncAlias};
use argmin::solver::particleswarm::ParticleSwarm;
use argmin_rng::Xoshiro256PlusPlus;
use argmin_rng::rand_core::SeedableRng;
use nalgebra::{DMatrix, DVector, SymmetricEigen};

use crate::sampler::{Target, standard_normals};
use impactlab_core::numerics::random_stream;

/// Range of each variable that the swarm searches, in standard deviations of the prior.
const SEARCH_LIMIT: f64 = 4.0;

/// Rise of f that the steps of the differences are chosen for.
const RISE: f64 = 0.5;

/// Number of doublings or halvings of a step.
const MAX_HALVINGS: usize = 12;

/// Largest number of Newton steps.
const MAX_NEWTON_STEPS: usize = 12;

/// Gain of f below which the Newton steps end.
const LEAST_GAIN: f64 = 1e-3;

/// Value of f where the evidence is impossible.
const IMPOSSIBLE: f64 = 1e12;

/// The search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OptimumSettings {
    /// Number of particles of the swarm.
    pub n_particles: usize,
    /// Number of moves of the swarm.
    pub n_iterations: u64,
    /// Seed of the swarm.
    pub seed: u64,
}

impl Default for OptimumSettings {
    fn default() -> Self {
        Self { n_particles: 100, n_iterations: 100, seed: 0 }
    }
}

/// The most probable point and the normal distribution about it.
#[derive(Debug, Clone, PartialEq)]
pub struct PointOptimum {
    /// The point z*.
    pub z: Vec<f64>,
    /// Covariance C, `[dim][dim]`.
    pub covariance: DMatrix<f64>,
    /// Logarithm of the likelihood at z*.
    pub log_likelihood: f64,
    /// Number of evaluations of the likelihood.
    pub n_evaluations: usize,
}

/// The cost −ln p of a target, counted.
struct Cost<'a, T: ?Sized>(&'a T);

impl<T: Target + ?Sized> Cost<'_, T> {
    fn costs(&self, z: &[Vec<f64>]) -> Vec<f64> {
        let values = self.0.log_likelihoods(z);
        let cost = |(value, z): (f64, &Vec<f64>)| {
            let cost = z.iter().map(|z| z * z).sum::<f64>() / 2.0 - value;
            if cost.is_nan() { IMPOSSIBLE } else { cost.min(IMPOSSIBLE) }
        };
        values.into_iter().zip(z).map(cost).collect()
    }
}

impl<T: Target + ?Sized> CostFunction for Cost<'_, T> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, z: &Vec<f64>) -> Result<f64, Error> {
        Ok(self.costs(std::slice::from_ref(z))[0])
    }

    fn bulk_cost<P>(&self, z: &[P]) -> Result<Vec<f64>, Error>
    where
        P: std::borrow::Borrow<Vec<f64>> + SyncAlias,
    {
        Ok(self.costs(&z.iter().map(|z| z.borrow().clone()).collect::<Vec<_>>()))
    }
}

impl PointOptimum {
    /// Finds the most probable point of a target; `None` if the evidence is impossible wherever the
    /// swarm has looked.
    pub fn find(target: &(impl Target + ?Sized), settings: OptimumSettings) -> Option<Self> {
        let dim = target.dim();
        let cost = Cost(target);
        let bounds = (vec![-SEARCH_LIMIT; dim], vec![SEARCH_LIMIT; dim]);
        let swarm = ParticleSwarm::new(bounds, settings.n_particles)
            .with_rng_generator(Xoshiro256PlusPlus::seed_from_u64(settings.seed));
        let found = Executor::new(Cost(target), swarm)
            .configure(|state| state.max_iters(settings.n_iterations))
            .run()
            .ok()?;
        let best = found.state().get_best_param()?;
        let mut n_evaluations = settings.n_particles * (settings.n_iterations as usize + 1);
        let mut at = Local { z: best.position.clone(), cost: best.cost, steps: vec![0.1; dim] };
        if at.cost >= IMPOSSIBLE {
            return None;
        }
        let mut curvature = Curvature::at(&cost, &mut at, &mut n_evaluations);
        for _ in 0..MAX_NEWTON_STEPS {
            let before = at.cost;
            at.step(&cost, &curvature, &mut n_evaluations);
            curvature = Curvature::at(&cost, &mut at, &mut n_evaluations);
            if before - at.cost < LEAST_GAIN {
                break;
            }
        }
        let square: f64 = at.z.iter().map(|z| z * z).sum();
        Some(Self {
            covariance: curvature.inverse(),
            log_likelihood: square / 2.0 - at.cost,
            z: at.z,
            n_evaluations,
        })
    }

    /// Draws from the normal distribution about the point, `[n][dim]`; `None` if rounding errors have
    /// made its covariance indefinite.
    pub fn draws(&self, n: usize, seed: u64) -> Option<Vec<Vec<f64>>> {
        let root = self.covariance.clone().cholesky()?.unpack();
        let mut rng = random_stream(seed, "optimum", 0);
        let draw = |_| {
            let normals = DVector::from_vec(standard_normals(self.z.len(), &mut rng));
            self.z.iter().zip((&root * normals).iter()).map(|(z, by)| z + by).collect()
        };
        Some((0..n).map(draw).collect())
    }
}

/// A point, its cost, and the steps of the differences about it.
struct Local {
    z: Vec<f64>,
    cost: f64,
    steps: Vec<f64>,
}

impl Local {
    fn moved(&self, by: &[(usize, f64)]) -> Vec<f64> {
        let mut z = self.z.clone();
        by.iter().for_each(|(j, by)| z[*j] += by);
        z
    }

    /// Makes a Newton step, or the share of it that lowers the cost most.
    fn step<T: Target + ?Sized>(&mut self, cost: &Cost<'_, T>, at: &Curvature, n: &mut usize) {
        let step = at.inverse() * &at.gradient;
        let share = |k: usize| 0.5_f64.powi(k as i32);
        let points: Vec<Vec<f64>> = (0..MAX_HALVINGS)
            .map(|k| self.z.iter().zip(step.iter()).map(|(z, s)| z - share(k) * s).collect())
            .collect();
        let costs = cost.costs(&points);
        *n += points.len();
        for (z, cost) in points.into_iter().zip(costs) {
            if cost < self.cost {
                (self.z, self.cost) = (z, cost);
            }
        }
    }

    /// Chooses the steps so that the cost rises by about [`RISE`] on the average of both sides.
    fn choose_steps<T: Target + ?Sized>(&mut self, cost: &Cost<'_, T>, n: &mut usize) {
        for _ in 0..MAX_HALVINGS {
            let steps = self.steps.iter().enumerate();
            let both = steps.flat_map(|(j, h)| [self.moved(&[(j, *h)]), self.moved(&[(j, -h)])]);
            let points: Vec<Vec<f64>> = both.collect();
            *n += points.len();
            let costs = cost.costs(&points);
            let mut changed = false;
            for (h, pair) in self.steps.iter_mut().zip(costs.chunks_exact(2)) {
                let rise = (pair[0] + pair[1]) / 2.0 - self.cost;
                let factor = match rise {
                    rise if rise > 4.0 * RISE => 0.5,
                    rise if rise < RISE / 4.0 && *h < 1.0 => 2.0,
                    _ => continue,
                };
                *h *= factor;
                changed = true;
            }
            if !changed {
                break;
            }
        }
    }
}

/// Gradient and matrix of second derivatives.
struct Curvature {
    gradient: DVector<f64>,
    hessian: DMatrix<f64>,
}

impl Curvature {
    fn at<T: Target + ?Sized>(cost: &Cost<'_, T>, at: &mut Local, n: &mut usize) -> Self {
        at.choose_steps(cost, n);
        let dim = at.z.len();
        let h = &at.steps;
        let mut points = Vec::new();
        for (i, step) in h.iter().enumerate() {
            points.extend([at.moved(&[(i, *step)]), at.moved(&[(i, -step)])]);
        }
        for i in 0..dim {
            for j in 0..i {
                points.push(at.moved(&[(i, h[i]), (j, h[j])]));
                points.push(at.moved(&[(i, -h[i]), (j, -h[j])]));
            }
        }
        *n += points.len();
        let costs = cost.costs(&points);
        let (own, mixed) = costs.split_at(2 * dim);
        let mut mixed = mixed.chunks_exact(2);
        let gradient = DVector::from_fn(dim, |i, _| (own[2 * i] - own[2 * i + 1]) / (2.0 * h[i]));
        let mut hessian = DMatrix::zeros(dim, dim);
        let sum = |i: usize| own[2 * i] + own[2 * i + 1];
        for i in 0..dim {
            hessian[(i, i)] = (sum(i) - 2.0 * at.cost) / (h[i] * h[i]);
            for j in 0..i {
                let both: f64 = mixed.next().map_or(0.0, |pair| pair.iter().sum());
                let value = (both - sum(i) - sum(j) + 2.0 * at.cost) / (2.0 * h[i] * h[j]);
                (hessian[(i, j)], hessian[(j, i)]) = (value, value);
            }
        }
        Self { gradient, hessian }
    }

    /// The inverse, with eigenvalues of 1 or more.
    fn inverse(&self) -> DMatrix<f64> {
        let SymmetricEigen { eigenvectors, eigenvalues } = self.hessian.clone().symmetric_eigen();
        let inverse = eigenvalues.map(|value| 1.0 / value.max(1.0));
        &eigenvectors * DMatrix::from_diagonal(&inverse) * eigenvectors.transpose()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampler::test_targets::{Function, LinearGaussian, bimodal, normal};

    #[test]
    fn a_linear_question_has_the_mean_and_covariance_of_the_closed_form() {
        let target = LinearGaussian::narrow();
        let (mean, covariance, _) = target.closed_form();
        let found = PointOptimum::find(&target, OptimumSettings::default()).unwrap();
        for j in 0..20 {
            let std = covariance[(j, j)].sqrt();
            let error = (found.z[j] - mean[j]) / std;
            assert!(error.abs() < 0.05, "{j}: off by {error} σ");
            let ratio = found.covariance[(j, j)].sqrt() / std;
            assert!(
                (ratio - 1.0).abs() < 0.05,
                "σ of {j} is {ratio} times that of the closed form"
            );
        }
        let draws = found.draws(4000, 3).unwrap();
        let first = || draws.iter().map(|z| z[0]);
        let mean_of_draws = first().sum::<f64>() / 4000.0;
        let square = first().map(|z| (z - mean_of_draws).powi(2)).sum::<f64>() / 4000.0;
        let std = covariance[(0, 0)].sqrt();
        assert!((mean_of_draws - mean[0]).abs() < 0.15 * std, "{mean_of_draws} for {}", mean[0]);
        assert!((square.sqrt() / std - 1.0).abs() < 0.1, "{} for {std}", square.sqrt());
    }

    #[test]
    fn of_two_modes_one_point_is_left() {
        let found = PointOptimum::find(&bimodal(), OptimumSettings::default()).unwrap();
        assert!((found.z[0].abs() - 1.5 / 1.09).abs() < 0.1, "{:?}", found.z);
        assert!(found.covariance[(0, 0)].sqrt() < 0.35);
    }

    #[test]
    fn impossible_evidence_has_no_optimum_and_nan_is_impossible() {
        let settings = OptimumSettings { n_particles: 20, n_iterations: 5, seed: 0 };
        let nowhere = Function { dim: 2, log_likelihood: |_: &[f64]| f64::NAN };
        assert_eq!(PointOptimum::find(&nowhere, settings), None);
        let half = |z: &[f64]| if z[0] > 0.0 { normal(z[0], 1.0, 0.5) } else { f64::NAN };
        let found = PointOptimum::find(&Function { dim: 2, log_likelihood: half }, settings);
        assert!((found.unwrap().z[0] - 0.8).abs() < 0.01);
    }
}
