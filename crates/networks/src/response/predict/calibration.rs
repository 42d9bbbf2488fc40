//! Scales of the latent factors, from trajectories that a training has not seen.
//!
//! Trainings that each leave out a part of the trajectories predict that part. What they miss is
//! explained by latent factors through the sensitivities of the paths:
//!
//! ```text
//! e_i(t) = [X, Y, ψ](t) recorded − predicted        g_im(t) = ∂[X, Y, ψ](t)/∂z_m
//! s = argmin mean over i, t of −ln N(e_i(t); 0, Σ_m s_m² g_im g_imᵀ + q² N_i(t) + ε²) + prior
//! ```
//!
//! with N_i the spread by the steps' noise. Paths that part at a border between recovering and spinning
//! are not linear in the factors, so that afterwards one factor on all scales makes the regions of the
//! full distribution hold as many of the recorded positions as they say.
//!
//! Nothing but the trajectories to learn from is looked at.

use argmin::core::{CostFunction, Error, Executor};
use argmin::solver::neldermead::NelderMead;
use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;

use crate::response::predict::latents::NAMED_PLACES;
use crate::response::{LatentScales, N_NAMED_LATENTS, Predictor, ResponseCase, STEP_S};
use impactlab_core::vehicle::VehicleState;

/// Instants at which errors are looked at, s.
const INSTANTS_S: [f64; 6] = [0.25, 0.5, 1.0, 2.0, 3.0, 4.0];
/// ε: position, m, and heading, rad, to which nothing is known better.
const FLOOR: [f64; 3] = [0.02, 0.02, 0.003];
/// Scales by which sensitivities are taken, small against the usual ones.
const PROBE: f64 = 2e-3;
/// Deviation of the step noise for which its spread is computed.
const PROBE_NOISE: f64 = 0.02;
const MAX_ITERATIONS: u64 = 400;
/// Errors beyond this many standard deviations count linearly: a car that spins against all
/// expectation says little of the usual scales.
const ROBUST_STD: f64 = 3.0;
/// Factors on all scales that are tried, and the level at which the regions shall be right.
const FACTORS: [f64; 11] = [0.5, 0.6, 0.7, 0.85, 1.0, 1.2, 1.4, 1.7, 2.0, 2.5, 3.0];
const LEVEL: f64 = 0.9;
/// A few trajectories hardly hold the rare ones that miss most: of n the regions shall hold a share
/// of 0.9 + 0.4/n.
const FEW_CASES: f64 = 0.4;

/// A trajectory, and the model that has not seen it.
pub(crate) struct Unseen<'a> {
    pub case: &'a ResponseCase,
    pub predictor: Predictor,
}

/// Deviation of a trajectory from its prediction at an instant.
struct Observation {
    error: Vector3<f64>,
    /// Change of the prediction by one unit of each latent factor.
    sensitivities: [Vector3<f64>; N_NAMED_LATENTS],
    /// Covariance by the steps' noise of deviation one.
    noise: Matrix3<f64>,
}

/// The calibrated scales.
///
/// - `prior_std`: expected deviation of a scale from the guess, as a logarithm.
pub(crate) fn calibrate(unseen: &[Unseen<'_>], prior_std: f64) -> LatentScales {
    let observations: Vec<Vec<Observation>> = unseen.par_iter().map(observe).collect();
    let observations: Vec<Observation> = observations.into_iter().flatten().collect();
    if observations.is_empty() {
        return LatentScales::default();
    }
    let problem =
        CalibrationProblem { observations: &observations, n_cases: unseen.len(), prior_std };
    let start = vec![0.0; N_NAMED_LATENTS + 1];
    let mut simplex = vec![start.clone()];
    for i in 0..start.len() {
        let mut corner = start.clone();
        corner[i] = 0.7;
        simplex.push(corner);
    }
    let found = Executor::new(problem, NelderMead::new(simplex))
        .configure(|state| state.max_iters(MAX_ITERATIONS))
        .run();
    let logs = found.ok().and_then(|found| found.state.best_param).unwrap_or(start);
    let mut scales = scales_of(&logs);
    scales.shared_out = largest(&observations, &scales);
    scales.n_calibrated = unseen.len();
    scales.widened(factor(unseen, scales))
}

fn instants(case: &ResponseCase) -> impl Iterator<Item = usize> + '_ {
    let idx = |time_s: f64| (time_s / STEP_S).round() as usize;
    INSTANTS_S.into_iter().map(idx).filter(|at| *at < case.states.len())
}

fn pose(state: &VehicleState<f64>) -> Vector3<f64> {
    Vector3::new(state.x_m, state.y_m, state.yaw_rad)
}

fn observe(unseen: &Unseen<'_>) -> Vec<Observation> {
    let case = unseen.case;
    let Some(initial) = case.states.first() else { return Vec::new() };
    let with = |scales: [f64; N_NAMED_LATENTS], step_noise: f64| {
        let latents = LatentScales { scales, step_noise, ..LatentScales::default() };
        unseen.predictor.clone().with_latents(latents)
    };
    let certain = with([0.0; N_NAMED_LATENTS], 0.0).central_path(initial, &case.inputs);
    let noise = with([0.0; N_NAMED_LATENTS], PROBE_NOISE).forecast(initial, &case.inputs);
    // A latent that is one: strengths moved by a probe, all components alike.
    let moved: Vec<Vec<VehicleState<f64>>> = (0..N_NAMED_LATENTS)
        .map(|m| {
            let mut scales = [0.0; N_NAMED_LATENTS];
            scales[m] = PROBE;
            with(scales, 0.0).path_at(initial, &case.inputs, NAMED_PLACES[m])
        })
        .collect();
    let at = |idx: usize| {
        let predicted = pose(certain.get(idx)?);
        let sensitivity = |m: usize| {
            moved
                .get(m)
                .and_then(|path| path.get(idx))
                .map_or(Vector3::zeros(), |state| (pose(state) - predicted) / PROBE)
        };
        let spread = noise.covariance(idx);
        Some(Observation {
            error: pose(case.states.get(idx)?) - predicted,
            sensitivities: std::array::from_fn(sensitivity),
            noise: spread.fixed_view::<3, 3>(0, 0) / (PROBE_NOISE * PROBE_NOISE),
        })
    };
    instants(case).filter_map(at).collect()
}

fn scales_of(logs: &[f64]) -> LatentScales {
    let usual = LatentScales::default();
    let log = |i: usize| logs.get(i).copied().unwrap_or(0.0).clamp(-6.0, 6.0);
    LatentScales {
        scales: std::array::from_fn(|m| usual.scales[m] * log(m).exp()),
        step_noise: usual.step_noise * log(N_NAMED_LATENTS).exp(),
        ..usual
    }
}

struct CalibrationProblem<'a> {
    observations: &'a [Observation],
    n_cases: usize,
    prior_std: f64,
}

impl CostFunction for CalibrationProblem<'_> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, logs: &Vec<f64>) -> Result<f64, Error> {
        let scales = scales_of(logs);
        let misses: f64 = self.observations.iter().map(|seen| seen.surprise(&scales)).sum();
        // Instants of one trajectory say the same over and over: each counts as one case.
        let fit = misses / self.observations.len() as f64 * self.n_cases as f64;
        let prior: f64 = logs.iter().map(|log| (log / self.prior_std).powi(2)).sum();
        Ok(fit + 0.5 * prior)
    }
}

impl Observation {
    fn covariance(&self, scales: &LatentScales) -> Matrix3<f64> {
        let mut covariance = Matrix3::from_diagonal(&Vector3::from(FLOOR.map(|std| std * std)));
        covariance += self.noise * scales.step_noise.powi(2);
        for (sensitivity, scale) in self.sensitivities.iter().zip(scales.scales) {
            covariance += sensitivity * sensitivity.transpose() * (scale * scale);
        }
        covariance
    }

    /// Negative log-likelihood of the error, its distance by Huber.
    fn surprise(&self, scales: &LatentScales) -> f64 {
        let Some(root) = self.covariance(scales).cholesky() else { return 1e6 };
        let distance = root.l().solve_lower_triangular(&self.error).map_or(1e3, |z| z.norm());
        let huber = if distance <= ROBUST_STD {
            0.5 * distance * distance
        } else {
            ROBUST_STD * (distance - 0.5 * ROBUST_STD)
        };
        huber + root.l().diagonal().iter().map(|value| value.ln()).sum::<f64>()
    }
}

/// The latent that moves the position most.
fn largest(observations: &[Observation], scales: &LatentScales) -> usize {
    let effect = |m: usize| -> f64 {
        let distances = observations.iter().map(|seen| seen.sensitivities[m].xy().norm());
        distances.sum::<f64>() * scales.scales[m]
    };
    (0..N_NAMED_LATENTS).max_by(|a, b| effect(*a).total_cmp(&effect(*b))).unwrap_or(0)
}

/// The factor on all scales with which the regions hold as many positions as they say, all
/// trajectories and instants counted alike.
fn factor(unseen: &[Unseen<'_>], scales: LatentScales) -> f64 {
    let share_inside = |factor: f64| {
        let widened = scales.widened(factor);
        let counts: Vec<(usize, usize)> = unseen
            .par_iter()
            .map(|unseen| {
                let case = unseen.case;
                let Some(initial) = case.states.first() else { return (0, 0) };
                let predictor = unseen.predictor.clone().with_latents(widened);
                let motion = predictor.forecast(initial, &case.inputs);
                let inside = |at: &usize| {
                    let state = &case.states[*at];
                    motion.position(*at).level_of([state.x_m, state.y_m]) <= LEVEL
                };
                (instants(case).filter(inside).count(), instants(case).count())
            })
            .collect();
        let (inside, all) = counts.into_iter().fold((0, 0), |(a, b), (c, d)| (a + c, b + d));
        inside as f64 / all.max(1) as f64
    };
    let level = (LEVEL + FEW_CASES / unseen.len().max(1) as f64).min(1.0);
    let shares: Vec<f64> = FACTORS.iter().map(|factor| share_inside(*factor)).collect();
    let first = shares.iter().position(|share| *share >= level);
    match first {
        None => FACTORS[FACTORS.len() - 1],
        Some(0) => FACTORS[0],
        Some(k) => {
            // Between two factors along the logarithm.
            let part = (level - shares[k - 1]) / (shares[k] - shares[k - 1]).max(1e-9);
            (FACTORS[k - 1].ln() * (1.0 - part) + FACTORS[k].ln() * part).exp()
        }
    }
}
