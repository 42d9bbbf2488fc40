//! The run from the prior to the posterior.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use rand::{Rng, RngExt};

use super::mixture::{Mixture, standard_normals};
use super::population::Population;
use super::{
    LeftOutParticles, Likelihood, Particles, SamplerCheckpoint, SamplerError, SamplerReport,
    SamplerSettings, SamplerStage, SamplerStart, Target,
};
use crate::LEAST_ESS_FOR_INTERVALS;
use impactlab_core::numerics::random_stream;

/// Draws from the prior for each particle of the answer.
const PRIOR_DRAWS: usize = 20;

/// Draws from the prior and from the start for each particle of the answer, where there is one.
const STARTED_DRAWS: [usize; 2] = [4, 6];

/// Effective sample size of what a start is fitted to, for each particle of the answer. It is as wide as
/// that of a low temperature.
const START_ESS: f64 = 8.0;

/// Largest share of the evaluations that is drawn from the prior, as a divisor.
const MAX_PRIOR_SHARE: usize = 4;

/// Number of draws from the prior that the evidence has to be possible for, before anything is fitted.
const MIN_POSSIBLE: usize = 50;

/// Draws of a round for each particle of the answer, at temperature 0 and at 1: the colder the fit, the
/// sooner it is made anew.
const ROUND_DRAWS: [f64; 2] = [1.0, 3.0];

/// Effective sample size that a mixture is fitted to, for each particle of the answer. A fit to fewer is
/// colder and narrower: it is worth more where it lies right and does not see what lies beside it.
const FIT_ESS: f64 = 2.0;

/// The same of every second fit where the evidence is sharp: after a part of the evaluations the
/// posterior is not in sight.
const SHARP_FIT_ESS: f64 = 0.25;

/// That part of the evaluations, as a divisor.
const SHARP_AFTER: usize = 3;

/// Effective sample size of the posterior up to which it is not in sight.
const IN_SIGHT_ESS: f64 = 100.0;

/// Effective sample size that a mixture is fitted to at the least.
const MIN_FIT_ESS: f64 = 200.0;

/// Number of particles that the mixture is fitted to.
const FIT_PARTICLES: usize = 4000;

/// Parts of the particles of the answer that are evaluated, and shown, at a time.
const BATCHES: usize = 8;

/// Particles that are evaluated at once before it is known how long they take.
const PIECE: usize = 32;

/// The same at the least.
const MIN_PIECE: usize = 8;

/// Time that the particles that are evaluated at once should take. A run whose particles take longer is
/// reported, and can be stopped, within a batch.
const PIECE_TIME: [Duration; 2] = [Duration::from_millis(250), Duration::from_secs(1)];

/// Effective sample size from which particles are said to be of the posterior.
const MIN_POSTERIOR_ESS: f64 = 20.0;

/// Effective sample size of a weakened posterior.
const WEAKENED_ESS: f64 = 200.0;

/// How many times the largest number of evaluations may be exceeded until one of the two is reached.
const MAX_EXCESS: usize = 4;

/// Particles without a part of the evidence at the most.
const LEFT_OUT_PARTICLES: usize = 300;

/// Growth of the number of draws after which a run is saved.
const SAVED_GROWTH: f64 = 1.3;

/// Samples the posterior of a target.
///
/// - `checkpoint`: where the run is saved every now and then, and resumed from.
/// - `report`: called after each batch of evaluations. If it breaks, the sampler stops: what it
///   returns then are particles of the temperature that was reached
///   ([`Particles::is_posterior`] tells whether that was 1). A run that has spent its evaluations on a
///   posterior of which it has hardly a draw returns a weakened one ([`Particles::is_weakened`]).
///
/// # Errors
/// [`SamplerError`] if a setting is outside its range, if the evidence is impossible everywhere or for all
/// that was drawn before the sampler was stopped, or if the checkpoint is of another run, is damaged, cannot
/// be read or written, or belongs to another process.
pub fn sample(
    target: &(impl Target + ?Sized),
    settings: &SamplerSettings,
    checkpoint: Option<&SamplerCheckpoint>,
    report: &mut dyn FnMut(SamplerReport<'_>) -> ControlFlow<()>,
) -> Result<Particles, SamplerError> {
    sample_from(None, target, settings, checkpoint, report)
}

/// As [`sample`], from where the particles of a similar target lie: most of the first draws are taken
/// there, the others from the prior as ever. The weights are right wherever the draws come from.
///
/// - `start`: of a target whose variables are the first ones of this one.
///
/// # Errors
/// Those of [`sample`].
pub fn sample_from(
    start: Option<&SamplerStart>,
    target: &(impl Target + ?Sized),
    settings: &SamplerSettings,
    checkpoint: Option<&SamplerCheckpoint>,
    report: &mut dyn FnMut(SamplerReport<'_>) -> ControlFlow<()>,
) -> Result<Particles, SamplerError> {
    settings.check()?;
    let _claim = checkpoint.map(SamplerCheckpoint::claim).transpose()?;
    let saved = match checkpoint {
        Some(checkpoint) => checkpoint.read(settings, target.dim())?,
        None => None,
    };
    let n_started = start.map_or(0, |_| STARTED_DRAWS[1] * settings.n_particles);
    let population = Population::default();
    let mut run = Run { target, settings, report, population, n_started, piece: PIECE };
    let mut flow = match saved {
        Some(population) => {
            run.population = population;
            ControlFlow::Continue(())
        }
        None => match start {
            None => run.draw_prior(PRIOR_DRAWS)?,
            Some(start) => run.draw_start(start)?,
        },
    };
    let mut n_saved = 0;
    while flow.is_continue() && !run.is_done() {
        flow = run.round()?;
        let n_draws = run.population.n_draws();
        let has_grown = n_draws as f64 >= SAVED_GROWTH * n_saved as f64 || run.is_done();
        if let (Some(checkpoint), true, true) = (checkpoint, flow.is_continue(), has_grown) {
            checkpoint.write(settings, &run.population)?;
            n_saved = n_draws;
        }
    }
    Ok(run.answer(flow.is_break()))
}

struct Run<'a, T: ?Sized> {
    target: &'a T,
    settings: &'a SamplerSettings,
    report: &'a mut dyn FnMut(SamplerReport<'_>) -> ControlFlow<()>,
    population: Population,
    /// Number of draws from a start.
    n_started: usize,
    /// Number of particles that are evaluated at once. It follows from how long they take, and no number
    /// of the answer follows from it.
    piece: usize,
}

impl<T: Target + ?Sized> Run<'_, T> {
    fn batch(&self) -> usize {
        (self.settings.n_particles / BATCHES).max(BATCHES)
    }

    fn evaluate(&self, z: &[Vec<f64>]) -> Result<Vec<Likelihood>, SamplerError> {
        let mut all = self.target.likelihoods(z);
        if all.len() != z.len() {
            return Err(SamplerError::WrongCount { expected: z.len(), got: all.len() });
        }
        for of in &mut all {
            let is_number = !of.log.is_nan() && of.without.iter().all(|value| value.is_finite());
            of.log = if is_number { of.log } else { f64::NEG_INFINITY };
        }
        match all.iter().any(|of| of.log == f64::INFINITY) {
            true => Err(SamplerError::InfiniteLikelihood),
            false => Ok(all),
        }
    }

    /// Evaluates the first ones of some particles, and says whether they took so long that the run should be
    /// reported before the others.
    fn evaluate_some(&mut self, z: &[Vec<f64>]) -> Result<(Vec<Likelihood>, bool), SamplerError> {
        let start = Instant::now();
        let likelihood = self.evaluate(&z[..self.piece.min(z.len())])?;
        let ([short, long], passed) = (PIECE_TIME, start.elapsed());
        if passed > long {
            self.piece = (self.piece / 2).max(MIN_PIECE);
        } else if passed < short {
            self.piece = (2 * self.piece).min(self.batch().max(PIECE));
        }
        Ok((likelihood, passed >= short))
    }

    /// Evaluates particles of the prior, and reports them. Those that were not evaluated when the run is
    /// stopped are dropped.
    ///
    /// - `n_drawn`: how many were drawn before.
    fn evaluate_prior(
        &mut self,
        z: &mut Vec<Vec<f64>>,
        n_drawn: usize,
    ) -> Result<(Vec<Likelihood>, ControlFlow<()>), SamplerError> {
        let mut likelihood = Vec::with_capacity(z.len());
        let mut log_likelihood = Vec::with_capacity(z.len());
        let mut flow = ControlFlow::Continue(());
        while likelihood.len() < z.len() && flow.is_continue() {
            let (some, is_slow) = self.evaluate_some(&z[likelihood.len()..])?;
            log_likelihood.extend(some.iter().map(|of| of.log));
            likelihood.extend(some);
            let n = likelihood.len();
            if is_slow || n == z.len() {
                flow = (self.report)(SamplerReport {
                    stage: SamplerStage::Prior,
                    temperature: 0.0,
                    n_evaluations: n_drawn + n,
                    ess: None,
                    z: &z[..n],
                    log_likelihood: &log_likelihood,
                });
            }
        }
        z.truncate(likelihood.len());
        Ok((likelihood, flow))
    }

    /// Draws from the prior, until the evidence is possible for some of the particles.
    ///
    /// - `per_particle`: draws for each particle of the answer.
    fn draw_prior(&mut self, per_particle: usize) -> Result<ControlFlow<()>, SamplerError> {
        let (n, dim) = (self.settings.n_particles, self.target.dim());
        let share = self.settings.max_evaluations / MAX_PRIOR_SHARE;
        let mut rng = random_stream(self.settings.seed, "reconstruct prior", 0);
        let mut flow = ControlFlow::Continue(());
        let (mut n_possible, mut n_drawn) = (0, 0);
        while flow.is_continue() {
            let goal = match n_possible < MIN_POSSIBLE.min(n) {
                true => n.max(share),
                false => n.max(share.min(per_particle * n)),
            };
            if n_drawn >= goal {
                break;
            }
            let batch = self.batch().min(goal - n_drawn);
            let mut z: Vec<Vec<f64>> =
                (0..batch).map(|_| standard_normals(dim, &mut rng)).collect();
            let (likelihood, after_batch) = self.evaluate_prior(&mut z, n_drawn)?;
            flow = after_batch;
            n_possible += likelihood.iter().filter(|of| of.log.is_finite()).count();
            n_drawn += z.len();
            self.population.add_prior(z, likelihood);
        }
        if !self.population.is_possible() {
            return Err(match flow.is_break() {
                true => SamplerError::Stopped { n_evaluations: n_drawn },
                false => SamplerError::ImpossibleEverywhere { n_evaluations: n_drawn },
            });
        }
        Ok(flow)
    }

    /// Draws from the prior and from a start.
    fn draw_start(&mut self, start: &SamplerStart) -> Result<ControlFlow<()>, SamplerError> {
        let [of_prior, of_start] = STARTED_DRAWS;
        let flow = self.draw_prior(of_prior)?;
        if flow.is_break() {
            return Ok(flow);
        }
        let mixture = start.0.extended_to(self.target.dim());
        let mut rng = random_stream(self.settings.seed, "reconstruct start", 0);
        let n = of_start * self.settings.n_particles;
        let temperature = 0.0;
        let weights = self.population.weights(temperature);
        let shown = self.shown(temperature, &weights.resample(self.batch(), rng.random()));
        self.draw_from(mixture, n, &shown, &mut rng)
    }

    /// Draws from a mixture that is fitted at the temperature that the weights allow.
    fn round(&mut self) -> Result<ControlFlow<()>, SamplerError> {
        let number = self.population.n_rounds() as u64;
        let mut rng = random_stream(self.settings.seed, "reconstruct draws", number);
        let temperature = self.population.temperature_of(self.fit_ess());
        let weights = self.population.weights(temperature);
        let mixture = self.population.mixture(&weights, FIT_PARTICLES, rng.random());
        let shown = self.shown(temperature, &weights.resample(self.batch(), rng.random()));
        self.population.forget_negligible(&weights);
        let [first, last] = ROUND_DRAWS.map(|draws| draws * self.settings.n_particles as f64);
        let n = ((first + (last - first) * temperature) as usize).max(BATCHES);
        self.draw_from(mixture, n, &shown, &mut rng)
    }

    /// Draws from a mixture.
    ///
    /// - `shown`: the particles that are reported meanwhile.
    fn draw_from(
        &mut self,
        mixture: Mixture,
        n: usize,
        shown: &Shown,
        rng: &mut impl Rng,
    ) -> Result<ControlFlow<()>, SamplerError> {
        let z: Vec<Vec<f64>> = (0..n).map(|_| mixture.draw(rng)).collect();
        let mut likelihood = Vec::with_capacity(n);
        for batch in z.chunks(self.batch()) {
            let end = likelihood.len() + batch.len();
            while likelihood.len() < end {
                let (some, is_slow) = self.evaluate_some(&z[likelihood.len()..end])?;
                likelihood.extend(some);
                let n_evaluations = self.population.n_draws() + likelihood.len();
                let is_reported = is_slow || likelihood.len() == end;
                if is_reported && (self.report)(shown.report(n_evaluations)).is_break() {
                    return Ok(ControlFlow::Break(()));
                }
            }
        }
        self.population.add(z, likelihood, mixture);
        Ok(ControlFlow::Continue(()))
    }

    fn shown(&self, temperature: f64, idx: &[usize]) -> Shown {
        let particles = idx.iter().map(|idx| self.population.particle(*idx));
        let (z, log_likelihood) = particles.map(|(z, value)| (z.clone(), value)).unzip();
        Shown { z, log_likelihood, temperature, ess: self.posterior_ess() }
    }

    /// Effective sample size that a mixture is fitted to.
    fn fit_ess(&self) -> f64 {
        let is_late = self.population.n_draws() > self.settings.max_evaluations / SHARP_AFTER;
        let is_sharp = is_late && self.posterior_ess() < IN_SIGHT_ESS;
        let share = match is_sharp && self.population.n_rounds() % 2 == 1 {
            true => SHARP_FIT_ESS,
            false => FIT_ESS,
        };
        let wanted = (share * self.settings.n_particles as f64).max(MIN_FIT_ESS);
        let n_first = self.population.n_prior() + self.n_started;
        wanted.min(n_first as f64 / 4.0).max(1.0)
    }

    fn posterior_ess(&self) -> f64 {
        self.population.weights(1.0).effective()
    }

    fn is_done(&self) -> bool {
        let n_draws = self.population.n_draws();
        if self.population.n_rounds() == 0 {
            return false;
        }
        let ess = self.posterior_ess();
        let is_out_of_sight = ess < MIN_POSTERIOR_ESS.min(self.settings.least_ess)
            && self.weakened_temperature().is_none();
        let largest = match is_out_of_sight {
            true => MAX_EXCESS.saturating_mul(self.settings.max_evaluations),
            false => self.settings.max_evaluations,
        };
        ess >= self.settings.least_ess || n_draws >= largest
    }

    /// Temperature of a weakened posterior, where too few draws are of the posterior itself.
    fn weakened_temperature(&self) -> Option<f64> {
        let least = self.settings.least_ess;
        if self.posterior_ess() >= LEAST_ESS_FOR_INTERVALS.min(least) {
            return None;
        }
        let temperature = self.population.temperature_of(WEAKENED_ESS.min(least));
        (temperature >= Particles::LEAST_WEAKENED).then_some(temperature)
    }

    /// Temperature of the answer.
    fn temperature(&self, is_stopped: bool) -> f64 {
        if self.population.n_rounds() == 0 {
            return 0.0;
        }
        let least = MIN_POSTERIOR_ESS.min(self.settings.least_ess);
        let weakened = self.weakened_temperature().filter(|_| !is_stopped);
        weakened.unwrap_or_else(|| self.population.temperature_of(least))
    }

    fn answer(&self, is_stopped: bool) -> Particles {
        let population = &self.population;
        let temperature = self.temperature(is_stopped);
        let weights = population.weights(temperature);
        let u = random_stream(self.settings.seed, "reconstruct answer", 0).random();
        let draw = weights.resample(self.settings.n_particles, u);
        let wide = START_ESS * self.settings.n_particles as f64;
        let wide = population.weights(population.temperature_of(wide));
        let start = SamplerStart(population.mixture(&wide, FIT_PARTICLES, u));
        let particle = |idx: &usize| population.particle(*idx);
        let left_out = |part: usize| {
            let weights = population.weights_without(part);
            let drawn = weights.resample(self.settings.n_particles.min(LEFT_OUT_PARTICLES), u);
            let z = drawn.iter().map(|idx| particle(idx).0.clone()).collect();
            LeftOutParticles { z, ess: weights.effective() }
        };
        let n_parts = if temperature < 1.0 { 0 } else { population.n_parts() };
        Particles {
            left_out: (0..n_parts).map(left_out).collect(),
            z: draw.iter().map(|idx| particle(idx).0.clone()).collect(),
            log_likelihood: draw.iter().map(|idx| particle(idx).1).collect(),
            draw,
            temperature,
            is_stopped,
            posterior_ess: self.posterior_ess(),
            log_evidence: weights.log_evidence,
            ess: weights.effective().max(1.0),
            n_evaluations: population.n_draws(),
            start,
        }
    }
}

/// Particles that are reported while a round is drawn.
struct Shown {
    z: Vec<Vec<f64>>,
    log_likelihood: Vec<f64>,
    temperature: f64,
    ess: f64,
}

impl Shown {
    fn report(&self, n_evaluations: usize) -> SamplerReport<'_> {
        SamplerReport {
            stage: match self.temperature < 1.0 {
                true => SamplerStage::Tempering,
                false => SamplerStage::Posterior,
            },
            temperature: self.temperature,
            n_evaluations,
            ess: Some(self.ess),
            z: &self.z,
            log_likelihood: &self.log_likelihood,
        }
    }
}
