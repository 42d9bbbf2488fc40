//! Baseline: the 4DOF model with tire and roll parameters fitted to the fine-tune trajectories by
//! particle swarm, held near the data sheet.
//!
//! ```text
//! θ* = argmin mean over cases of ē(θ) / ē(0) + λ Σ (θ_i/s)²        θ = ln(parameter / data sheet)
//! ```
//!
//! ē is the average error of a case, m. Without the prior the fit on 5 trajectories came out worse
//! than no fit.
//!
//! Particle swarm: Zambrano-Bigiarini et al., "Standard Particle Swarm Optimisation 2011 at
//! CEC-2013", IEEE Congress on Evolutionary Computation 2013.

use std::cell::RefCell;
use std::ops::ControlFlow;

use argmin::core::{CostFunction, Error, Executor};
use argmin::solver::particleswarm::ParticleSwarm;
use argmin_rng::Xoshiro256PlusPlus;
use argmin_rng::rand_core::SeedableRng;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::response::{N_RESIDUAL, ResponseCase, average_error_m, rollout};
use impactlab_core::vehicle::VehicleParameters;

/// Parameters that are fitted.
const N_TUNED: usize = 7;

/// Largest change of a parameter, as a logarithm: a factor of 2 either way.
const LOG_LIMIT: f64 = 0.7;

/// Factors on the data sheet's parameters.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tuning {
    /// Factor of the peak friction μ.
    pub friction: f64,
    /// Factor of the front cornering coefficient C_f.
    pub cornering_front: f64,
    /// Factor of the rear cornering coefficient C_r.
    pub cornering_rear: f64,
    /// Factor of the sliding friction ratio.
    pub sliding: f64,
    /// Factor of the roll stiffness.
    pub roll_stiffness: f64,
    /// Factor of the roll damping.
    pub roll_damping: f64,
    /// Factor of the front share of the roll stiffness, which shares out the load transfer.
    pub front_share: f64,
}

/// The search.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct TuningConfig {
    /// Particles of the swarm.
    pub particles: usize,
    /// Moves of the swarm.
    pub iterations: u64,
    /// λ: how strongly the parameters are held at the data sheet.
    pub prior_weight: f64,
    /// s: expected deviation of a parameter from the data sheet, as a logarithm.
    pub prior_std: f64,
}

impl Default for TuningConfig {
    fn default() -> Self {
        Self { particles: 32, iterations: 60, prior_weight: 0.01, prior_std: 0.2 }
    }
}

impl Default for Tuning {
    fn default() -> Self {
        Self::from_log(&[0.0; N_TUNED])
    }
}

impl Tuning {
    /// Fits the factors to trajectories.
    ///
    /// - `report`: moves done and the best cost; breaking ends the search with the best so far.
    pub fn fit(
        cases: &[&ResponseCase],
        config: TuningConfig,
        seed: u64,
        report: &mut dyn FnMut(u64, f64) -> ControlFlow<()>,
    ) -> Self {
        let best = RefCell::new((f64::INFINITY, vec![0.0; N_TUNED]));
        let problem = TuningProblem {
            cases,
            untuned_m: cases.iter().map(|case| Self::default().error_m(case)).collect(),
            config,
            best: &best,
            n_calls: RefCell::new(0),
            report: RefCell::new(report),
        };
        // The data sheet itself is the first point, so that no fit is worse than none.
        let is_broken_off = problem.cost(&vec![0.0; N_TUNED]).is_err();
        let bounds = (vec![-LOG_LIMIT; N_TUNED], vec![LOG_LIMIT; N_TUNED]);
        let swarm = ParticleSwarm::new(bounds, config.particles)
            .with_rng_generator(Xoshiro256PlusPlus::seed_from_u64(seed));
        if !is_broken_off {
            // Broken off or not, the best point so far is what counts.
            let _ = Executor::new(problem, swarm)
                .configure(|state| state.max_iters(config.iterations))
                .run();
        }
        Self::from_log(&best.into_inner().1)
    }

    /// Average error of a case, m.
    fn error_m(&self, case: &ResponseCase) -> f64 {
        let Some(&initial) = case.states.first() else { return 0.0 };
        let vehicle = self.apply(&case.vehicle);
        let states = rollout(&vehicle, initial, &case.inputs, [0.0; N_RESIDUAL]);
        average_error_m(&states, &case.states)
    }

    fn from_log(log: &[f64]) -> Self {
        let factor = |i: usize| log.get(i).copied().unwrap_or(0.0).exp();
        Self {
            friction: factor(0),
            cornering_front: factor(1),
            cornering_rear: factor(2),
            sliding: factor(3),
            roll_stiffness: factor(4),
            roll_damping: factor(5),
            front_share: factor(6),
        }
    }

    /// The vehicle with these parameters.
    pub fn apply(&self, vehicle: &VehicleParameters) -> VehicleParameters {
        let mut tuned = vehicle.clone();
        let (tires, suspension) = (&mut tuned.tires, &mut tuned.suspension);
        tires.friction *= self.friction;
        tires.cornering_coefficient_front_per_rad *= self.cornering_front;
        tires.cornering_coefficient_rear_per_rad *= self.cornering_rear;
        tires.sliding_friction_ratio = (tires.sliding_friction_ratio * self.sliding).min(1.0);
        suspension.roll_stiffness_n_m_rad *= self.roll_stiffness;
        suspension.roll_damping_n_m_s_rad *= self.roll_damping;
        suspension.front_roll_stiffness_share =
            (suspension.front_roll_stiffness_share * self.front_share).min(1.0);
        tuned
    }
}

/// Error below which a case counts no more for being better, m.
const ERROR_FLOOR_M: f64 = 0.05;

struct TuningProblem<'a> {
    cases: &'a [&'a ResponseCase],
    /// Average error of each case by the data sheet, m.
    untuned_m: Vec<f64>,
    config: TuningConfig,
    /// Cost and logarithms of the best point so far.
    best: &'a RefCell<(f64, Vec<f64>)>,
    n_calls: RefCell<u64>,
    report: RefCell<&'a mut dyn FnMut(u64, f64) -> ControlFlow<()>>,
}

/// The search was broken off.
#[derive(Debug, thiserror::Error)]
#[error("broken off")]
struct BrokenOff;

impl CostFunction for TuningProblem<'_> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, log: &Vec<f64>) -> Result<f64, Error> {
        let tuning = Tuning::from_log(log);
        let errors: Vec<f64> = self.cases.par_iter().map(|case| tuning.error_m(case)).collect();
        let shares = errors.iter().zip(&self.untuned_m);
        let share = |(error, untuned): (&f64, &f64)| error / (untuned + ERROR_FLOOR_M);
        let fit = shares.map(share).sum::<f64>() / self.cases.len().max(1) as f64;
        let TuningConfig { prior_weight, prior_std, .. } = self.config;
        let prior: f64 = log.iter().map(|value| (value / prior_std).powi(2)).sum();
        let cost = fit + prior_weight * prior;
        if cost < self.best.borrow().0 {
            *self.best.borrow_mut() = (cost, log.clone());
        }
        *self.n_calls.borrow_mut() += 1;
        let n_moves = *self.n_calls.borrow() / self.config.particles.max(1) as u64;
        match (self.report.borrow_mut())(n_moves, self.best.borrow().0) {
            ControlFlow::Continue(()) => Ok(cost),
            ControlFlow::Break(()) => Err(BrokenOff.into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::vehicle::{Preset, VehicleInput, VehicleState};

    /// A car that was set turning, simulated with known factors.
    fn case(truth: Tuning) -> ResponseCase {
        let vehicle = Preset::Reference.parameters();
        let initial = VehicleState { yaw_rate_rad_s: 1.2, ..VehicleState::driving_straight(20.0) };
        let inputs = vec![VehicleInput::released(); 150];
        let states = rollout(&truth.apply(&vehicle), initial, &inputs, [0.0; N_RESIDUAL]);
        let name = "made".to_owned();
        ResponseCase { name, vehicle, states, inputs, spins: true, digest: String::new() }
    }

    #[test]
    fn known_factors_are_found_and_a_broken_search_keeps_its_best() {
        let truth = Tuning { friction: 0.9, ..Tuning::default() };
        let case = case(truth);
        let config = TuningConfig { particles: 16, iterations: 12, ..TuningConfig::default() };
        let go_on = &mut |_, _| ControlFlow::Continue(());
        let found = Tuning::fit(&[&case], config, 1, go_on);
        let (before, after) = (Tuning::default().error_m(&case), found.error_m(&case));
        assert!(after < 0.3 * before, "{before} m to {after} m: {found:?}");
        assert_eq!(Tuning::fit(&[&case], config, 1, go_on), found, "same seed, same fit");
        let broken = Tuning::fit(&[&case], config, 1, &mut |n_moves, _| match n_moves {
            0 => ControlFlow::Continue(()),
            _ => ControlFlow::Break(()),
        });
        assert!(broken.error_m(&case) <= before, "{broken:?}");
    }
}
