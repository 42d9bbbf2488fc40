//! Every particle that was drawn, with its weight at any temperature.
//!
//! Particles are independent draws from the prior and from mixtures that were fitted to the particles
//! before them. All are weighted as draws from the mixture of all these distributions, whose densities
//! are known, so that weights and evidence are right whatever the fits are like:
//!
//! ```text
//! w_i(β) ∝ L_i^β N(z_i; 0, I) / Σ_t n_t q_t(z_i)        Z(β) = Σ_i L_i^β N(z_i; 0, I) / Σ_t n_t q_t(z_i)
//! ```
//!
//! with n_t draws from q_t. The prior is one of the q_t, so that no weight exceeds `L_i / n_0`.
//!
//! Source: [`OwenZhou2000`](impactlab_core::bibliography::OwenZhou2000) for the weights, with the prior as the
//! defensive component; [`Cornuet2012`](impactlab_core::bibliography::Cornuet2012) for mixtures that follow
//! from the draws before them.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::Likelihood;
use super::mixture::{Mixture, Weighted, is_plausible};
use impactlab_core::numerics::ln_sum_exp;

/// Number of halvings of the range of the temperature.
const N_BISECTIONS: usize = 50;

/// Weight of a particle, of the sum of all, below which it is forgotten: at a higher temperature it
/// weighs even less.
const NEGLIGIBLE: f64 = 1e-12;

/// Draws from one mixture.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Proposal {
    n_draws: usize,
    mixture: Mixture,
}

/// All particles of a run.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Population {
    z: Vec<Vec<f64>>,
    log_likelihood: Vec<f64>,
    /// The same without each part of the evidence, `[n][n_parts]`.
    without: Vec<Vec<f64>>,
    /// `ln Σ_t n_t q_t(z) / N(z; 0, I)` of each particle.
    log_density: Vec<f64>,
    n_prior: usize,
    proposals: Vec<Proposal>,
}

/// Weights of all particles at a temperature; they sum to 1.
#[derive(Debug, Clone)]
pub(super) struct Weights {
    pub weight: Vec<f64>,
    pub log_evidence: f64,
}

impl Weights {
    /// Kish's effective sample size `1 / Σ w²`; 0 where nothing has a weight.
    pub fn effective(&self) -> f64 {
        let square = self.weight.iter().map(|weight| weight * weight).sum::<f64>();
        if square > 0.0 { 1.0 / square } else { 0.0 }
    }

    /// Systematic resampling: indices in increasing order, each `n w` times on average, rounded up
    /// or down.
    ///
    /// - `u`: uniform random number, 0 to 1.
    pub fn resample(&self, n: usize, u: f64) -> Vec<usize> {
        let (mut sum, mut idx) = (self.weight.first().copied().unwrap_or(0.0), 0);
        let mut drawn = Vec::with_capacity(n);
        for k in 0..n {
            let at = (k as f64 + u) / n as f64;
            while sum <= at && idx + 1 < self.weight.len() {
                idx += 1;
                sum += self.weight[idx];
            }
            drawn.push(idx);
        }
        // The rounding of the sum may lead beyond the last particle that has a weight.
        let last = self.weight.iter().rposition(|weight| *weight > 0.0).unwrap_or(0);
        drawn.iter().map(|idx| *idx.min(&last)).collect()
    }
}

impl Population {
    /// Number of draws until now, forgotten ones included.
    pub fn n_draws(&self) -> usize {
        self.n_prior + self.proposals.iter().map(|proposal| proposal.n_draws).sum::<usize>()
    }

    /// Number of draws from the prior.
    pub fn n_prior(&self) -> usize {
        self.n_prior
    }

    /// Number of mixtures that were drawn from.
    pub fn n_rounds(&self) -> usize {
        self.proposals.len()
    }

    /// A particle with its likelihood.
    pub fn particle(&self, idx: usize) -> (&Vec<f64>, f64) {
        (&self.z[idx], self.log_likelihood[idx])
    }

    /// Whether the evidence is possible for any particle.
    pub fn is_possible(&self) -> bool {
        !self.z.is_empty()
    }

    /// Adds draws from the prior, before any others.
    pub fn add_prior(&mut self, z: Vec<Vec<f64>>, likelihood: Vec<Likelihood>) {
        self.n_prior += z.len();
        let log_density = (self.n_prior as f64).ln();
        self.log_density.fill(log_density);
        self.push(z, likelihood, |_| log_density);
    }

    /// Adds draws from a mixture.
    pub fn add(&mut self, z: Vec<Vec<f64>>, likelihood: Vec<Likelihood>, mixture: Mixture) {
        self.proposals.push(Proposal { n_draws: z.len(), mixture });
        let Some(proposal) = self.proposals.last() else { return };
        let of_each = self.z.par_iter().zip(&mut self.log_density);
        of_each.for_each(|(z, sum)| *sum = ln_sum_exp(&[*sum, proposal.ln_share(z)]));
        let (n_prior, proposals) = (self.n_prior as f64, std::mem::take(&mut self.proposals));
        self.push(z, likelihood, |z| {
            let of_mixtures = proposals.iter().map(|proposal| proposal.ln_share(z));
            ln_sum_exp(&std::iter::once(n_prior.ln()).chain(of_mixtures).collect::<Vec<f64>>())
        });
        self.proposals = proposals;
    }

    /// Keeps what has a likelihood.
    fn push(
        &mut self,
        z: Vec<Vec<f64>>,
        likelihood: Vec<Likelihood>,
        log_density: impl Fn(&[f64]) -> f64 + Sync,
    ) {
        let all = z.into_iter().zip(likelihood);
        let (z, of_z): (Vec<Vec<f64>>, Vec<Likelihood>) =
            all.filter(|(_, of)| of.log.is_finite()).unzip();
        let densities: Vec<f64> = z.par_iter().map(|z| log_density(z)).collect();
        self.z.extend(z);
        self.log_likelihood.extend(of_z.iter().map(|of| of.log));
        self.without.extend(of_z.into_iter().map(|of| of.without));
        self.log_density.extend(densities);
    }

    /// Weights at a temperature.
    pub fn weights(&self, temperature: f64) -> Weights {
        let pairs = self.log_likelihood.iter().zip(&self.log_density);
        Self::weights_of(pairs.map(|(value, density)| temperature * value - density).collect())
    }

    /// Number of parts of the evidence that can be left out.
    pub fn n_parts(&self) -> usize {
        self.without.first().map_or(0, Vec::len)
    }

    /// Weights of the posterior without a part of the evidence.
    pub fn weights_without(&self, part: usize) -> Weights {
        let pairs = self.without.iter().zip(&self.log_density);
        Self::weights_of(pairs.map(|(values, density)| values[part] - density).collect())
    }

    /// - `weight`: logarithms of the weights, up to a constant.
    fn weights_of(mut weight: Vec<f64>) -> Weights {
        let log_evidence = ln_sum_exp(&weight);
        weight.iter_mut().for_each(|weight| *weight = (*weight - log_evidence).exp());
        Weights { weight, log_evidence }
    }

    /// The highest temperature at which the effective sample size of the weights is still `least`.
    pub fn temperature_of(&self, least: f64) -> f64 {
        let suffices = |temperature: f64| self.weights(temperature).effective() >= least;
        if suffices(1.0) {
            return 1.0;
        }
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..N_BISECTIONS {
            // Small temperatures differ by their ratio, large ones by their difference.
            let middle = if low > 0.09 * high { (low + high) / 2.0 } else { 0.1 * high };
            *(if suffices(middle) { &mut low } else { &mut high }) = middle;
        }
        low
    }

    /// A mixture that is fitted to weighted particles.
    ///
    /// - `n`: number of particles that it is fitted to;
    /// - `u`: uniform random number, 0 to 1.
    pub fn mixture(&self, weights: &Weights, n: usize, u: f64) -> Mixture {
        let (mut z, mut weight): (Vec<&[f64]>, Vec<f64>) = (Vec::new(), Vec::new());
        let mut last = None;
        // Copies of a particle, which follow each other, are one particle.
        for idx in weights.resample(n, u) {
            match weight.last_mut() {
                Some(weight) if last == Some(idx) => *weight += 1.0 / n as f64,
                _ => {
                    z.push(&self.z[idx]);
                    weight.push(1.0 / n as f64);
                }
            }
            last = Some(idx);
        }
        Mixture::fit(Weighted { z: &z, weight: &weight })
    }

    /// Forgets the particles that have no weight worth mentioning.
    pub fn forget_negligible(&mut self, weights: &Weights) {
        let keep = |idx: usize| weights.weight[idx] > NEGLIGIBLE;
        let remaining: Vec<usize> = (0..self.z.len()).filter(|idx| keep(*idx)).collect();
        self.z = remaining.iter().map(|idx| std::mem::take(&mut self.z[*idx])).collect();
        self.log_likelihood = remaining.iter().map(|idx| self.log_likelihood[*idx]).collect();
        self.without =
            remaining.iter().map(|idx| std::mem::take(&mut self.without[*idx])).collect();
        self.log_density = remaining.iter().map(|idx| self.log_density[*idx]).collect();
    }

    /// Checks a population that comes from a file, so that nothing is counted or indexed wrongly.
    pub fn check(&self, dim: usize) -> Result<(), &'static str> {
        let n = self.z.len();
        let lengths = [self.log_likelihood.len(), self.log_density.len(), self.without.len()];
        if n == 0 || lengths != [n; 3] {
            return Err("its lists of particles differ in length");
        }
        if self.z.iter().any(|z| z.len() != dim || !z.iter().all(is_plausible)) {
            return Err("a particle is not as many finite numbers as the question has variables");
        }
        let values = self.log_likelihood.iter().chain(&self.log_density);
        let n_parts = self.n_parts();
        let is_whole = |without: &Vec<f64>| {
            without.len() == n_parts && without.iter().all(|value| value.is_finite())
        };
        if !values.into_iter().all(|value| value.is_finite()) || !self.without.iter().all(is_whole)
        {
            return Err("a likelihood or a density is no number");
        }
        let is_good = |proposal: &Proposal| proposal.n_draws > 0 && proposal.mixture.is_of(dim);
        let n_draws = self
            .proposals
            .iter()
            .try_fold(self.n_prior, |n, proposal| n.checked_add(proposal.n_draws));
        match self.proposals.iter().all(is_good) && n_draws.is_some_and(|n_draws| n_draws >= n) {
            true => Ok(()),
            false => Err("a distribution that particles were drawn from is none"),
        }
    }
}

impl Proposal {
    /// `ln n_t q_t(z) / N(z; 0, I)`.
    fn ln_share(&self, z: &[f64]) -> f64 {
        let square: f64 = z.iter().map(|z| z * z).sum();
        (self.n_draws as f64).ln() + self.mixture.ln_density(z) + square / 2.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn population(log_likelihood: &[f64]) -> Population {
        let mut population = Population::default();
        let of = |log: &f64| Likelihood { log: *log, without: vec![0.0] };
        let likelihood = log_likelihood.iter().map(of).collect();
        population.add_prior(vec![vec![0.0]; log_likelihood.len()], likelihood);
        population
    }

    #[test]
    fn weights_of_the_prior_are_powers_of_the_likelihood() {
        let population = population(&[0.0, 2.0_f64.ln(), f64::NEG_INFINITY, 4.0_f64.ln()]);
        assert_eq!(population.weights_without(0).weight, [1.0 / 3.0; 3], "it says nothing else");
        let half = population.weights(0.5);
        let sum = 1.0 + 2.0_f64.sqrt() + 2.0;
        // What is impossible is counted and not kept.
        assert_eq!(half.weight.len(), 3);
        for (weight, expected) in half.weight.iter().zip([1.0, 2.0_f64.sqrt(), 2.0]) {
            assert!((weight - expected / sum).abs() < 1e-12, "{half:?}");
        }
        assert!((half.log_evidence - (sum / 4.0).ln()).abs() < 1e-12);
        assert!((population.weights(0.0).effective() - 3.0).abs() < 1e-9);
    }

    #[test]
    fn the_temperature_has_the_effective_sample_size_asked_for() {
        let values: Vec<f64> = (0..100).map(|i| -1e3 * f64::from(i)).collect();
        let population = population(&values);
        let temperature = population.temperature_of(50.0);
        assert!(temperature > 0.0 && temperature < 1e-3, "{temperature}");
        let effective = population.weights(temperature).effective();
        assert!((effective - 50.0).abs() < 1e-6, "{effective}");
        assert_eq!(population.temperature_of(1.0), 1.0);
    }

    #[test]
    fn resampling_keeps_shares_and_never_takes_what_has_no_weight() {
        let weights = Weights { weight: vec![0.0, 0.5, 0.0, 0.25, 0.25, 0.0], log_evidence: 0.0 };
        for u in [0.0, 0.5, 0.999_999_999] {
            assert_eq!(weights.resample(4, u), [1, 1, 3, 4], "u = {u}");
        }
    }

    #[test]
    fn what_weighs_nothing_is_forgotten_and_changes_no_weight() {
        let mut population = population(&[0.0, -900.0, -1.0]);
        let before = population.weights(1.0);
        population.forget_negligible(&before);
        let after = population.weights(1.0);
        assert_eq!(after.weight, [before.weight[0], before.weight[2]]);
        assert_eq!((after.log_evidence, population.n_draws()), (before.log_evidence, 3));
    }
}
