//! The run from the prior to the posterior.

use std::ops::ControlFlow;

use rand::RngExt;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::mixture::{Mixture, Weighted, standard_normals};
use super::moves::{MoveRecord, MoveSettings, Proposal};
use super::population::{COMMON_FIT, Level, Population, Weights, group_ess};
use super::{
    Particles, SamplerCheckpoint, SamplerError, SamplerReport, SamplerSettings, SamplerStage,
    Target,
};
use crate::nn::random_stream;

/// Number of particles of the answer for each chain that is moved side by side with the others.
const PARTICLES_PER_CHAIN: usize = 8;

/// Smallest number of chains.
const MIN_CHAINS: usize = 8;

/// Smallest and largest number of moves of a chain at one temperature.
const MOVES: [usize; 2] = [4, 12];

/// Correlation of the ends of the chains with their starts, over all chains, up to which a component
/// has moved enough.
const MOVED_ENOUGH: f64 = 0.3;

/// Number of particles that the mixture is fitted to.
const FIT_PARTICLES: usize = 2000;

/// Number of draws from the prior that the evidence has to be possible for, before the temperature
/// is raised.
const MIN_POSSIBLE: usize = 50;

/// The evaluations that may be spent on the prior while the evidence is possible for too few draws:
/// one in this many.
const MAX_PRIOR_SHARE: usize = 4;

/// How many times the largest number of evaluations may be exceeded until temperature 1 is reached.
const MAX_EXCESS: usize = 4;

/// Smallest number of rounds at temperature 1.
const MIN_POSTERIOR_ROUNDS: usize = 2;

/// What a checkpoint holds of a run. Random numbers are drawn from one stream for each round, so that
/// they need no state.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RunState {
    population: Population,
    moves: MoveSettings,
}

/// Samples the posterior of a target.
///
/// - `checkpoint`: where the run is saved after each temperature, and resumed from.
/// - `report`: called after each batch of evaluations. If it breaks, the sampler stops: what it
///   returns then are particles of the last temperature that was completed
///   ([`Particles::of_posterior`] tells whether that was 1).
///
/// # Errors
/// [`SamplerError`] if a setting is outside its range, if the evidence is impossible everywhere, or
/// if the checkpoint is of another run or cannot be read or written.
pub fn sample(
    target: &(impl Target + ?Sized),
    settings: &SamplerSettings,
    checkpoint: Option<&SamplerCheckpoint>,
    report: &mut dyn FnMut(SamplerReport<'_>) -> ControlFlow<()>,
) -> Result<Particles, SamplerError> {
    settings.check()?;
    let saved = match checkpoint {
        Some(checkpoint) => checkpoint.read(settings, target.dim())?,
        None => None,
    };
    let was_saved = saved.is_some();
    let mut run = Run { target, settings, report, state: saved.unwrap_or_default() };
    let mut flow = if was_saved { ControlFlow::Continue(()) } else { run.draw_prior()? };
    while flow.is_continue() && !run.is_done() {
        flow = run.round()?;
        if let (Some(checkpoint), true) = (checkpoint, flow.is_continue()) {
            checkpoint.write(settings, &run.state)?;
        }
    }
    Ok(run.answer())
}

struct Run<'a, T: ?Sized> {
    target: &'a T,
    settings: &'a SamplerSettings,
    report: &'a mut dyn FnMut(SamplerReport<'_>) -> ControlFlow<()>,
    state: RunState,
}

impl<T: Target + ?Sized> Run<'_, T> {
    fn n_chains(&self) -> usize {
        let n = self.settings.n_particles;
        (n / PARTICLES_PER_CHAIN).max(MIN_CHAINS.min(n))
    }

    fn evaluate(&self, z: &[Vec<f64>]) -> Result<Vec<f64>, SamplerError> {
        let mut values = self.target.log_likelihoods(z);
        if values.len() != z.len() {
            return Err(SamplerError::WrongCount { expected: z.len(), got: values.len() });
        }
        for value in &mut values {
            *value = if value.is_nan() { f64::NEG_INFINITY } else { *value };
        }
        match values.contains(&f64::INFINITY) {
            true => Err(SamplerError::InfiniteLikelihood),
            false => Ok(values),
        }
    }

    /// Draws from the prior until there are as many particles as asked for, and the evidence is
    /// possible for some of them.
    fn draw_prior(&mut self) -> Result<ControlFlow<()>, SamplerError> {
        let (n, n_chains, dim) = (self.settings.n_particles, self.n_chains(), self.target.dim());
        let mut rng = random_stream(self.settings.seed, "reconstruct prior", 0);
        let mut flow = ControlFlow::Continue(());
        let mut n_possible = 0;
        while flow.is_continue() {
            let drawn = self.state.population.z.len();
            let goal = match n_possible < MIN_POSSIBLE.min(n) {
                true => n.max(self.settings.max_evaluations / MAX_PRIOR_SHARE),
                false => n,
            };
            if drawn >= goal {
                break;
            }
            let batch = n_chains.min(goal - drawn);
            let z: Vec<Vec<f64>> = (0..batch).map(|_| standard_normals(dim, &mut rng)).collect();
            let log_likelihood = self.evaluate(&z)?;
            n_possible += log_likelihood.iter().filter(|value| value.is_finite()).count();
            let population = &mut self.state.population;
            population.ancestor.extend(drawn..drawn + batch);
            population.level.extend(vec![0; batch]);
            population.z.extend(z);
            population.log_likelihood.extend(log_likelihood);
            flow = (self.report)(SamplerReport {
                stage: SamplerStage::Prior,
                temperature: 0.0,
                n_evaluations: population.z.len(),
                ess: None,
                z: &population.z,
                log_likelihood: &population.log_likelihood,
            });
        }
        let n_particles = self.state.population.z.len();
        let level = Level { temperature: 0.0, n_particles, log_evidence: 0.0 };
        self.state.population.levels.push(level);
        if n_possible == 0 && flow.is_continue() {
            return Err(SamplerError::ImpossibleEverywhere { n_evaluations: n_particles });
        }
        Ok(flow)
    }

    /// Raises the temperature as far as the weights allow, and moves particles there.
    fn round(&mut self) -> Result<ControlFlow<()>, SamplerError> {
        let population = &self.state.population;
        let (temperature, weights) = match self.state.temperature() {
            before if before < 1.0 => {
                // The prior alone has no more than n particles.
                let least = self.settings.n_particles.min(population.z.len() / 2).max(1);
                population.next_temperature(before, least as f64)
            }
            _ => (1.0, population.weights(1.0, &population.log_mixture())),
        };
        let number = population.levels.len() as u64;
        let mut rng = random_stream(self.settings.seed, "reconstruct moves", number);
        let mixture = population.mixture(&weights, rng.random());
        let ancestors = weights.resample(self.n_chains(), rng.random());
        let chains = Chains::start(population, &ancestors);
        let Some(chains) = self.move_chains(chains, temperature, &mixture, &mut rng)? else {
            return Ok(ControlFlow::Break(()));
        };
        self.state.moves.adapt(&chains.record);
        let level = Level {
            temperature,
            n_particles: chains.n_particles(),
            log_evidence: weights.log_evidence,
        };
        self.state.population.add(level, chains, &ancestors);
        Ok(ControlFlow::Continue(()))
    }

    /// Moves the chains until each component has moved enough; `None` if the report breaks.
    fn move_chains(
        &mut self,
        mut chains: Chains,
        temperature: f64,
        mixture: &Mixture,
        rng: &mut impl rand::Rng,
    ) -> Result<Option<Chains>, SamplerError> {
        let (moves, ess) = (self.state.moves, self.state.ess(self.settings));
        for n_moves in 1..=MOVES[1] {
            let proposals: Vec<Proposal> =
                chains.z.iter().map(|z| moves.propose(mixture, z, rng)).collect();
            let moved: Vec<Vec<f64>> =
                proposals.iter().map(|proposal| proposal.z.clone()).collect();
            let values = self.evaluate(&moved)?;
            for (idx, (proposal, value)) in proposals.into_iter().zip(values).enumerate() {
                let gain = temperature * (value - chains.log_likelihood[idx]) + proposal.ln_ratio;
                let probability = if gain.is_nan() { 0.0 } else { gain.min(0.0).exp() };
                let distance = mixture.distance_square(&chains.z[idx], &proposal.z);
                let dim = self.target.dim();
                chains.record.add(proposal.kind, probability, distance, dim);
                if rng.random::<f64>() < probability {
                    chains.z[idx] = proposal.z;
                    chains.log_likelihood[idx] = value;
                }
            }
            chains.remember();
            let flow = (self.report)(SamplerReport {
                stage: match temperature {
                    1.0 => SamplerStage::Posterior,
                    _ => SamplerStage::Tempering,
                },
                temperature,
                n_evaluations: self.state.population.z.len() + chains.n_particles(),
                ess,
                z: &chains.z,
                log_likelihood: &chains.log_likelihood,
            });
            if flow.is_break() {
                return Ok(None);
            }
            if n_moves >= MOVES[0] && chains.largest_correlation() <= MOVED_ENOUGH {
                break;
            }
        }
        Ok(Some(chains))
    }

    fn is_done(&self) -> bool {
        let n_evaluations = self.state.population.z.len();
        if self.state.temperature() < 1.0 {
            return n_evaluations >= MAX_EXCESS.saturating_mul(self.settings.max_evaluations);
        }
        let levels = self.state.population.levels.iter();
        let n_rounds = levels.filter(|level| level.temperature >= 1.0).count();
        let suffices = n_rounds >= MIN_POSTERIOR_ROUNDS
            && self.state.ess(self.settings).is_some_and(|ess| ess >= self.settings.least_ess);
        suffices || n_evaluations >= self.settings.max_evaluations
    }

    fn answer(&self) -> Particles {
        let population = &self.state.population;
        let temperature = self.state.temperature();
        let weights = population.weights(temperature, &population.log_mixture());
        let u = random_stream(self.settings.seed, "reconstruct answer", 0).random();
        let drawn = weights.resample(self.settings.n_particles, u);
        let groups = population.groups(&weights);
        Particles {
            z: drawn.iter().map(|idx| population.z[*idx].clone()).collect(),
            log_likelihood: drawn.iter().map(|idx| population.log_likelihood[*idx]).collect(),
            ancestor: drawn.iter().map(|idx| groups[*idx]).collect(),
            temperature,
            log_evidence: weights.log_evidence,
            ess: population.smallest_ess(&weights).min(largest_ess(self.settings)),
            n_evaluations: population.z.len(),
        }
    }
}

/// The effective sample size that a number of particles is worth at the most. Of few particles the
/// estimate says far too much: 100 of them that were said to be worth 400 had intervals of a third of
/// the right width.
fn largest_ess(settings: &SamplerSettings) -> f64 {
    (settings.n_particles as f64 / COMMON_FIT).max(1.0)
}

impl RunState {
    fn temperature(&self) -> f64 {
        self.population.levels.last().map_or(0.0, |level| level.temperature)
    }

    /// Effective sample size at the present temperature; `None` for the prior.
    fn ess(&self, settings: &SamplerSettings) -> Option<f64> {
        let population = &self.population;
        let weights = population.weights(self.temperature(), &population.log_mixture());
        let ess = (population.levels.len() > 1).then(|| population.smallest_ess(&weights));
        ess.map(|ess| ess.min(largest_ess(settings)))
    }

    /// Checks a state that comes from a file, so that nothing is counted or indexed wrongly.
    pub(super) fn check(&self, dim: usize) -> Result<(), &'static str> {
        let of = &self.population;
        let n = of.z.len();
        let lengths = [of.log_likelihood.len(), of.ancestor.len(), of.level.len()];
        let in_levels: usize = of.levels.iter().map(|level| level.n_particles).sum();
        if n == 0 || lengths != [n; 3] || in_levels != n {
            return Err("its lists of particles differ in length");
        }
        if of.z.iter().any(|z| z.len() != dim || !z.iter().all(|value| value.is_finite())) {
            return Err("a particle is not as many finite numbers as the question has variables");
        }
        if of.log_likelihood.iter().any(|value| value.is_nan() || *value == f64::INFINITY) {
            return Err("a likelihood is no number");
        }
        let descends = |idx: usize| match of.level[idx] {
            0 => of.ancestor[idx] == idx,
            level => {
                level < of.levels.len()
                    && of.level.get(of.ancestor[idx]).is_some_and(|before| *before < level)
            }
        };
        if !(0..n).all(descends) {
            return Err("a particle descends from none of an earlier temperature");
        }
        let is_temperature = |level: &Level| {
            (0.0..=1.0).contains(&level.temperature) && level.log_evidence.is_finite()
        };
        let moves = [self.moves.step, self.moves.independent_share];
        let in_range = moves.iter().all(|value| (0.0..=1.0).contains(value));
        match of.levels.iter().all(is_temperature) && in_range {
            true => Ok(()),
            false => Err("a temperature, an evidence or a step is outside its range"),
        }
    }
}

impl Population {
    /// The mixture of the weighted particles.
    fn mixture(&self, weights: &Weights, u: f64) -> Mixture {
        let (mut z, mut weight): (Vec<&[f64]>, Vec<f64>) = (Vec::new(), Vec::new());
        let share = 1.0 / FIT_PARTICLES as f64;
        // Copies of a particle, which follow each other, are one particle.
        for idx in weights.resample(FIT_PARTICLES, u) {
            match (z.last(), weight.last_mut()) {
                (Some(last), Some(weight)) if *last == self.z[idx].as_slice() => *weight += share,
                _ => {
                    z.push(&self.z[idx]);
                    weight.push(share);
                }
            }
        }
        Mixture::fit(Weighted { z: &z, weight: &weight })
    }

    /// The smallest effective sample size of a component of z.
    fn smallest_ess(&self, weights: &Weights) -> f64 {
        let groups = self.groups(weights);
        let component = |j: usize| self.z.iter().map(move |z| z[j]).collect::<Vec<f64>>();
        let dim = self.z.first().map_or(0, Vec::len);
        let ess = (0..dim)
            .into_par_iter()
            .filter_map(|j| group_ess(&component(j), &weights.weight, &groups));
        let smallest = ess.reduce(|| f64::INFINITY, f64::min);
        if smallest.is_finite() { smallest } else { 1.0 }
    }

    /// Adds the particles of chains as a level.
    fn add(&mut self, level: Level, chains: Chains, ancestors: &[usize]) {
        let number = self.levels.len();
        self.levels.push(level);
        for (states, ancestor) in chains.states.into_iter().zip(ancestors) {
            for (z, log_likelihood) in states {
                self.z.push(z);
                self.log_likelihood.push(log_likelihood);
                self.ancestor.push(*ancestor);
                self.level.push(number);
            }
        }
    }
}

/// Chains that are moved side by side.
struct Chains {
    start: Vec<Vec<f64>>,
    z: Vec<Vec<f64>>,
    log_likelihood: Vec<f64>,
    /// Every state after a move of each chain, with its log likelihood.
    states: Vec<Vec<(Vec<f64>, f64)>>,
    record: MoveRecord,
}

impl Chains {
    fn start(population: &Population, ancestors: &[usize]) -> Self {
        let z: Vec<Vec<f64>> = ancestors.iter().map(|idx| population.z[*idx].clone()).collect();
        Self {
            log_likelihood: ancestors.iter().map(|idx| population.log_likelihood[*idx]).collect(),
            states: vec![Vec::new(); z.len()],
            record: MoveRecord::default(),
            start: z.clone(),
            z,
        }
    }

    fn n_particles(&self) -> usize {
        self.states.iter().map(Vec::len).sum()
    }

    fn remember(&mut self) {
        let present = self.z.iter().zip(&self.log_likelihood);
        for (states, (z, log_likelihood)) in self.states.iter_mut().zip(present) {
            states.push((z.clone(), *log_likelihood));
        }
    }

    /// The largest correlation, over the chains, between start and present of a component.
    fn largest_correlation(&self) -> f64 {
        let n = self.z.len() as f64;
        let dim = self.z.first().map_or(0, Vec::len);
        let correlation = |j: usize| {
            let mean = |of: &[Vec<f64>]| of.iter().map(|z| z[j]).sum::<f64>() / n;
            let means = [mean(&self.start), mean(&self.z)];
            let [mut aa, mut ab, mut bb] = [0.0; 3];
            for (a, b) in self.start.iter().zip(&self.z) {
                let (a, b) = (a[j] - means[0], b[j] - means[1]);
                (aa, ab, bb) = (aa + a * a, ab + a * b, bb + b * b);
            }
            if aa * bb > 0.0 { ab / (aa * bb).sqrt() } else { 1.0 }
        };
        (0..dim).map(correlation).fold(0.0, f64::max)
    }
}
