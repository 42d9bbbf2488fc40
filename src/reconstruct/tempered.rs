//! Tempered sequential Monte Carlo in its plain form: the next temperature by effective sample size,
//! systematic resampling, moves along differences of particles.
//!
//! ```text
//! β' = largest β' ≤ 1 with ESS of the weights L^(β'−β) at least N/2
//! z_i' = z_i + γ (z_a − z_b) + ε        γ adapted to a quarter of accepted moves, 1 in one of ten
//! z_i' = √(1 − b²) z_i + b ξ            ξ ~ N(0, I), in three of ten
//! ```
//!
//! Each of a part of the components, so that what the evidence says nothing of moves freely.
//!
//! Sources: [`DelMoral2006`](crate::bibliography::DelMoral2006) (sequential Monte Carlo),
//! [`TerBraak2006`](crate::bibliography::TerBraak2006) (moves along differences, γ = 1 to change
//! modes), [`Cotter2013`](crate::bibliography::Cotter2013) (moves that keep the prior).

use std::ops::ControlFlow;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use crate::reconstruct::sampler::{
    Particles, SamplerReport, SamplerSettings, SamplerStage, Target,
};

/// Share of the particles that the weights of the next temperature are worth.
const ESS_SHARE: f64 = 0.5;

/// Moves of every particle at each temperature below 1.
const MOVES_PER_TEMPERATURE: usize = 3;

/// Wanted share of accepted moves.
const ACCEPTED_SHARE: f64 = 0.25;

/// Shares of the components that a move changes, one of them drawn for each move.
const MOVED_SHARES: [f64; 3] = [0.1, 0.35, 1.0];

/// Share of the moves towards new components of the prior.
const PRIOR_MOVES: f64 = 0.3;

/// Scatter of a move beside the difference of two particles.
const JITTER: f64 = 0.02;

/// The likelihood of no particle is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("no motion within the prior can be computed: every likelihood is zero")]
pub struct NothingPossible;

/// Samples the posterior of a target.
///
/// - `told`: is told after each batch of evaluations, and says whether to go on. If it breaks, the
///   particles so far are the answer; their temperature says what they are of.
///
/// # Errors
/// [`NothingPossible`] if the likelihood of all particles of the prior is zero.
pub fn sample(
    target: &impl Target,
    settings: &SamplerSettings,
    told: &mut dyn FnMut(SamplerReport<'_>) -> ControlFlow<()>,
) -> Result<Particles, NothingPossible> {
    let mut run = Run::new(target, settings);
    if run.log_likelihood.iter().all(|l| *l == f64::NEG_INFINITY) {
        return Err(NothingPossible);
    }
    let mut goes_on = run.tell(SamplerStage::Prior, told);
    while goes_on && run.temperature < 1.0 {
        run.raise_temperature();
        for _ in 0..MOVES_PER_TEMPERATURE {
            run.move_all();
            goes_on = goes_on && run.tell(SamplerStage::Tempering, told);
        }
    }
    run.moved = vec![0; run.z.len()];
    let n = run.z.len();
    while goes_on
        && run.ess() < settings.least_ess
        && run.n_evaluations + n <= settings.max_evaluations
    {
        run.move_all();
        goes_on = run.tell(SamplerStage::Posterior, told);
    }
    let ess = run.ess();
    Ok(Particles {
        z: run.z,
        log_likelihood: run.log_likelihood,
        temperature: run.temperature,
        log_evidence: run.log_evidence,
        ess,
        n_evaluations: run.n_evaluations,
    })
}

struct Run<'a, T> {
    target: &'a T,
    random: ChaCha8Rng,
    z: Vec<Vec<f64>>,
    log_likelihood: Vec<f64>,
    /// Accepted moves of each particle at the last temperature.
    moved: Vec<usize>,
    temperature: f64,
    log_evidence: f64,
    scale: f64,
    n_evaluations: usize,
}

impl<'a, T: Target> Run<'a, T> {
    fn new(target: &'a T, settings: &SamplerSettings) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(settings.seed);
        let n = settings.n_particles.max(2);
        let mut draw = || (0..target.dim()).map(|_| StandardNormal.sample(&mut random)).collect();
        let z: Vec<Vec<f64>> = (0..n).map(|_| draw()).collect();
        let log_likelihood = finite(target.log_likelihoods(&z));
        Self {
            target,
            random,
            z,
            log_likelihood,
            moved: vec![0; n],
            temperature: 0.0,
            log_evidence: 0.0,
            scale: 0.6,
            n_evaluations: n,
        }
    }

    fn tell(
        &self,
        stage: SamplerStage,
        told: &mut dyn FnMut(SamplerReport<'_>) -> ControlFlow<()>,
    ) -> bool {
        let ess = (stage == SamplerStage::Posterior).then(|| self.ess());
        told(SamplerReport {
            stage,
            temperature: self.temperature,
            n_evaluations: self.n_evaluations,
            ess,
            z: &self.z,
            log_likelihood: &self.log_likelihood,
        })
        .is_continue()
    }

    /// Effective sample size: particles, each counted as far as it has moved since it was copied. Ten
    /// accepted moves make it a new one. It is an estimate by experience, and not by theory.
    fn ess(&self) -> f64 {
        let dim = self.target.dim() as f64;
        self.moved.iter().map(|&moves| (moves as f64 / (dim / 2.0)).min(1.0)).sum()
    }

    /// Weights of the particles if the temperature were raised, the largest of them 1.
    fn weights(&self, to: f64) -> Vec<f64> {
        let largest = self.log_likelihood.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let step = to - self.temperature;
        self.log_likelihood.iter().map(|l| (step * (l - largest)).exp()).collect()
    }

    fn raise_temperature(&mut self) {
        let worth = |weights: &[f64]| {
            let sum: f64 = weights.iter().sum();
            sum * sum / weights.iter().map(|w| w * w).sum::<f64>()
        };
        let least = ESS_SHARE * self.z.len() as f64;
        let (mut low, mut high) = (self.temperature, 1.0);
        if worth(&self.weights(1.0)) < least {
            for _ in 0..60 {
                let middle = (low + high) / 2.0;
                if worth(&self.weights(middle)) < least { high = middle } else { low = middle }
            }
        }
        let weights = self.weights(high);
        let largest = self.log_likelihood.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let mean = weights.iter().sum::<f64>() / weights.len() as f64;
        self.log_evidence += mean.ln() + (high - self.temperature) * largest;
        self.temperature = high;
        self.resample(&weights);
    }

    /// Systematic resampling.
    fn resample(&mut self, weights: &[f64]) {
        let n = weights.len();
        let total: f64 = weights.iter().sum();
        let offset: f64 = self.random.random();
        let (mut from, mut sum) = (0, weights[0]);
        let chosen: Vec<usize> = (0..n)
            .map(|i| {
                let at = (i as f64 + offset) / n as f64 * total;
                while sum < at && from + 1 < n {
                    from += 1;
                    sum += weights[from];
                }
                from
            })
            .collect();
        self.z = chosen.iter().map(|&i| self.z[i].clone()).collect();
        self.log_likelihood = chosen.iter().map(|&i| self.log_likelihood[i]).collect();
    }

    /// Moves every particle: some of its components along the difference of two others, or towards new
    /// ones of the prior.
    fn move_all(&mut self) {
        let moves: Vec<Move> = (0..self.z.len()).map(|idx| self.proposed(idx)).collect();
        let (proposed, gains): (Vec<Vec<f64>>, Vec<f64>) =
            moves.into_iter().map(|it| (it.z, it.log_prior_gain)).unzip();
        let likelihoods = finite(self.target.log_likelihoods(&proposed));
        let n = proposed.len();
        self.n_evaluations += n;
        let mut n_accepted = 0;
        for (i, (z, likelihood)) in proposed.into_iter().zip(likelihoods).enumerate() {
            let gain = self.temperature * (likelihood - self.log_likelihood[i]) + gains[i];
            let is_accepted = self.random.random::<f64>().ln() < gain;
            if likelihood > f64::NEG_INFINITY && is_accepted {
                (self.z[i], self.log_likelihood[i]) = (z, likelihood);
                self.moved[i] += 1;
                n_accepted += 1;
            }
        }
        let share = n_accepted as f64 / n as f64;
        self.scale = (self.scale * (1.5 * (share - ACCEPTED_SHARE)).exp()).clamp(0.05, 1.5);
    }

    fn proposed(&mut self, idx: usize) -> Move {
        let (n, dim) = (self.z.len(), self.target.dim());
        let share = MOVED_SHARES[self.random.random_range(0..MOVED_SHARES.len())];
        let mut moved: Vec<usize> =
            (0..dim).filter(|_| self.random.random::<f64>() < share).collect();
        if moved.is_empty() {
            moved.push(self.random.random_range(0..dim));
        }
        let mut z = self.z[idx].clone();
        if self.random.random::<f64>() < PRIOR_MOVES {
            let kept = (1.0 - self.scale.min(0.9).powi(2)).sqrt();
            for &k in &moved {
                let new: f64 = StandardNormal.sample(&mut self.random);
                z[k] = kept * z[k] + self.scale.min(0.9) * new;
            }
            return Move { z, log_prior_gain: 0.0 };
        }
        let (a, b) = (self.random.random_range(0..n), self.random.random_range(0..n));
        let far = self.random.random::<f64>() < 0.1;
        let usual = self.scale * 2.38 / (2.0 * moved.len() as f64).sqrt();
        let gamma = if far { 1.0 } else { usual };
        let mut log_prior_gain = 0.0;
        for &k in &moved {
            let jitter: f64 = StandardNormal.sample(&mut self.random);
            let from = z[k];
            z[k] += gamma * (self.z[a][k] - self.z[b][k]) + JITTER * jitter;
            log_prior_gain += (from * from - z[k] * z[k]) / 2.0;
        }
        Move { z, log_prior_gain }
    }
}

/// A proposed move.
struct Move {
    z: Vec<f64>,
    /// Logarithm of the ratio of prior densities and proposals.
    log_prior_gain: f64,
}

/// NaN counts as impossible.
fn finite(mut values: Vec<f64>) -> Vec<f64> {
    values.iter_mut().filter(|value| value.is_nan()).for_each(|value| *value = f64::NEG_INFINITY);
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two measurements of one component.
    struct Linear;

    impl Target for Linear {
        fn dim(&self) -> usize {
            2
        }

        fn log_likelihoods(&self, z: &[Vec<f64>]) -> Vec<f64> {
            z.iter().map(|z| -0.5 * ((z[0] - 1.5) / 0.2_f64).powi(2)).collect()
        }
    }

    #[test]
    fn a_linear_gaussian_posterior_is_met_and_repeated_by_its_seed() {
        let settings = SamplerSettings { n_particles: 2000, ..SamplerSettings::default() };
        let run = || sample(&Linear, &settings, &mut |_| ControlFlow::Continue(())).unwrap();
        let particles = run();
        assert_eq!(particles, run());
        let n = particles.z.len() as f64;
        let mean = particles.z.iter().map(|z| z[0]).sum::<f64>() / n;
        let variance = particles.z.iter().map(|z| (z[0] - mean).powi(2)).sum::<f64>() / n;
        // Precision 1 of the prior and 25 of the measurement; five standard errors of 400 draws.
        assert!((mean - 1.5 * 25.0 / 26.0).abs() < 0.05, "{mean}");
        assert!((variance * 26.0 - 1.0).abs() < 0.35, "{variance}");
        let evidence = -0.5 * 1.5 * 1.5 / 1.04 + 0.5 * (0.04_f64 / 1.04).ln();
        assert!((particles.log_evidence - evidence).abs() < 0.25, "{particles:?} {evidence}");
    }

    /// Nothing is possible.
    struct Impossible;

    impl Target for Impossible {
        fn dim(&self) -> usize {
            1
        }

        fn log_likelihoods(&self, z: &[Vec<f64>]) -> Vec<f64> {
            vec![f64::NAN; z.len()]
        }
    }

    #[test]
    fn an_impossible_target_is_an_error_and_a_break_keeps_what_there_is() {
        let settings = SamplerSettings { n_particles: 2, ..SamplerSettings::default() };
        let go_on = &mut |_: SamplerReport<'_>| ControlFlow::Continue(());
        assert_eq!(sample(&Impossible, &settings, go_on), Err(NothingPossible));
        let stopped = sample(&Linear, &settings, &mut |_| ControlFlow::Break(())).unwrap();
        assert!(!stopped.of_posterior() && stopped.z.len() == 2);
    }
}
