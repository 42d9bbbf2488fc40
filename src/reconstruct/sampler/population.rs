//! Every particle that was ever evaluated, with its weight at any temperature.
//!
//! The particles of earlier temperatures are kept and weighted as draws from the mixture of all
//! levels, so that no evaluation is wasted:
//!
//! ```text
//! w_i(β) ∝ L_i^β / Σ_s n_s L_i^β_s / Z_s        Z(β) = Σ_i L_i^β / Σ_s n_s L_i^β_s / Z_s
//! ```
//!
//! with n_s particles of temperature β_s and evidence Z_s. The prior cancels.
//!
//! Source: [`KaramanisSeljak2024`](crate::bibliography::KaramanisSeljak2024).

use serde::{Deserialize, Serialize};

use super::mixture::ln_sum_exp;

/// Number of halvings of the range of the next temperature.
const N_BISECTIONS: usize = 50;

/// Smallest increase of the temperature, where the likelihood is zero for nearly all particles.
const MIN_INCREASE: f64 = 1e-12;

/// How many times larger the variance of an estimate is than the ancestors alone say, because all
/// chains move by one mixture that was fitted to all of them: 1.8 to 3.1 for three targets
/// and two numbers of particles (BENCHMARKS.md).
pub(super) const COMMON_FIT: f64 = 2.5;

/// Effective number of groups of common ancestors that the effective sample size needs at least.
const MIN_GROUPS: f64 = 50.0;

/// The particles of one temperature.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Level {
    pub temperature: f64,
    pub n_particles: usize,
    /// Estimate of `ln Z(β)`.
    pub log_evidence: f64,
}

/// All particles of a run.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Population {
    pub z: Vec<Vec<f64>>,
    pub log_likelihood: Vec<f64>,
    /// Index of the particle from which the chain of each one started; of itself for those of the
    /// prior.
    pub ancestor: Vec<usize>,
    /// Index of the level of each particle.
    pub level: Vec<usize>,
    pub levels: Vec<Level>,
}

/// Weights of all particles at a temperature; they sum to 1.
#[derive(Debug, Clone)]
pub(super) struct Weights {
    pub weight: Vec<f64>,
    pub log_evidence: f64,
}

impl Weights {
    /// Kish's effective sample size `1 / Σ w²`.
    pub fn effective(&self) -> f64 {
        1.0 / self.weight.iter().map(|weight| weight * weight).sum::<f64>()
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
    /// `ln Σ_s n_s L^β_s / Z_s` of each particle.
    pub fn log_mixture(&self) -> Vec<f64> {
        let term = |level: &Level, log_likelihood: f64| {
            (level.n_particles as f64).ln() + power(level.temperature, log_likelihood)
                - level.log_evidence
        };
        let of = |log_likelihood: &f64| {
            let terms: Vec<f64> =
                self.levels.iter().map(|level| term(level, *log_likelihood)).collect();
            ln_sum_exp(&terms)
        };
        self.log_likelihood.iter().map(of).collect()
    }

    /// Weights at a temperature.
    ///
    /// - `log_mixture`: that of [`Population::log_mixture`].
    pub fn weights(&self, temperature: f64, log_mixture: &[f64]) -> Weights {
        let pairs = self.log_likelihood.iter().zip(log_mixture);
        let mut weight: Vec<f64> =
            pairs.map(|(l, mixture)| power(temperature, *l) - mixture).collect();
        let log_evidence = ln_sum_exp(&weight);
        weight.iter_mut().for_each(|weight| *weight = (*weight - log_evidence).exp());
        Weights { weight, log_evidence }
    }

    /// The highest temperature at which the effective sample size of the weights is still `least`,
    /// and the weights there.
    ///
    /// - `after`: the temperature until now, which the next one exceeds.
    pub fn next_temperature(&self, after: f64, least: f64) -> (f64, Weights) {
        let mixture = self.log_mixture();
        let suffices = |temperature: f64| self.weights(temperature, &mixture).effective() >= least;
        if suffices(1.0) {
            return (1.0, self.weights(1.0, &mixture));
        }
        let (mut low, mut high) = (after, 1.0);
        for _ in 0..N_BISECTIONS {
            // Small temperatures differ by their ratio, large ones by their difference.
            let middle = if low > 0.09 * high { (low + high) / 2.0 } else { 0.1 * high };
            *(if suffices(middle) { &mut low } else { &mut high }) = middle;
        }
        let temperature = low.max(after + MIN_INCREASE).min(1.0);
        (temperature, self.weights(temperature, &mixture))
    }

    /// For each particle the index of its ancestor at the earliest level from which enough
    /// ancestors are left.
    pub fn groups(&self, weights: &Weights) -> Vec<usize> {
        let mut groups = Vec::new();
        for level in 0..self.levels.len() {
            groups = (0..self.z.len()).map(|idx| self.ancestor_at(idx, level)).collect();
            let mut sums = vec![0.0; self.z.len()];
            for (group, weight) in groups.iter().zip(&weights.weight) {
                sums[*group] += weight;
            }
            if 1.0 / sums.iter().map(|sum| sum * sum).sum::<f64>() >= MIN_GROUPS {
                break;
            }
        }
        groups
    }

    fn ancestor_at(&self, mut idx: usize, level: usize) -> usize {
        while self.level[idx] > level {
            idx = self.ancestor[idx];
        }
        idx
    }
}

/// `β ln L`, where `0 · ln 0` is 0.
fn power(temperature: f64, log_likelihood: f64) -> f64 {
    if temperature == 0.0 { 0.0 } else { temperature * log_likelihood }
}

/// Effective sample size of the weighted mean of a value, from how far the sums over groups of
/// common ancestry scatter:
///
/// ```text
/// μ = Σ_i w_i x_i       σ² = Σ_i w_i (x_i − μ)²
/// V = c G/(G − 1) Σ_g (Σ_{i in g} w_i (x_i − μ))²      ESS = σ² / V, at most 1 / Σ w²
/// ```
///
/// G is the effective number of groups, c is [`COMMON_FIT`]. Duplicates, the autocorrelation of a chain and the loss of
/// ancestors all show in V.
///
/// Source: [`LeeWhiteley2018`](crate::bibliography::LeeWhiteley2018) for groups of common roots,
/// [`OlssonDouc2019`](crate::bibliography::OlssonDouc2019) for a more recent ancestor where few
/// roots are left.
///
/// - returns `None` for a value that does not vary.
pub(super) fn group_ess(values: &[f64], weights: &[f64], groups: &[usize]) -> Option<f64> {
    let mean: f64 = values.iter().zip(weights).map(|(value, weight)| weight * value).sum();
    let (mut variance, mut square) = (0.0, 0.0);
    let n_ids = groups.iter().max().map_or(0, |largest| largest + 1);
    let mut sums = vec![(0.0, 0.0); n_ids];
    for ((value, weight), group) in values.iter().zip(weights).zip(groups) {
        let deviation = value - mean;
        variance += weight * deviation * deviation;
        square += weight * weight;
        let sum = &mut sums[*group];
        *sum = (sum.0 + weight * deviation, sum.1 + weight);
    }
    if variance <= f64::EPSILON * mean * mean {
        return None;
    }
    let n_groups = 1.0 / sums.iter().map(|(_, weight): &(f64, f64)| weight * weight).sum::<f64>();
    if n_groups < 1.5 {
        return Some(1.0);
    }
    let scatter: f64 = sums.iter().map(|(sum, _)| sum * sum).sum();
    let error = COMMON_FIT * scatter * n_groups / (n_groups - 1.0);
    Some((variance / error).min(1.0 / square).max(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn population(log_likelihood: Vec<f64>) -> Population {
        let n = log_likelihood.len();
        Population {
            z: vec![vec![0.0]; n],
            log_likelihood,
            ancestor: (0..n).collect(),
            level: vec![0; n],
            levels: vec![Level { temperature: 0.0, n_particles: n, log_evidence: 0.0 }],
        }
    }

    #[test]
    fn weights_of_the_prior_are_powers_of_the_likelihood() {
        let population = population(vec![0.0, 2.0_f64.ln(), f64::NEG_INFINITY, 4.0_f64.ln()]);
        let mixture = population.log_mixture();
        let half = population.weights(0.5, &mixture);
        let sum = 1.0 + 2.0_f64.sqrt() + 2.0;
        for (weight, expected) in half.weight.iter().zip([1.0, 2.0_f64.sqrt(), 0.0, 2.0]) {
            assert!((weight - expected / sum).abs() < 1e-12, "{half:?}");
        }
        assert!((half.log_evidence - (sum / 4.0).ln()).abs() < 1e-12);
        assert!((population.weights(0.0, &mixture).effective() - 4.0).abs() < 1e-9);
    }

    #[test]
    fn the_next_temperature_has_the_effective_sample_size_asked_for() {
        let population = population((0..100).map(|i| -1e3 * f64::from(i)).collect());
        let (temperature, weights) = population.next_temperature(0.0, 50.0);
        assert!(temperature > 0.0 && temperature < 1e-3, "{temperature}");
        assert!((weights.effective() - 50.0).abs() < 1e-6, "{}", weights.effective());
        assert_eq!(population.next_temperature(0.0, 1.0).0, 1.0);
    }

    #[test]
    fn resampling_keeps_shares_and_never_takes_what_has_no_weight() {
        let weights = Weights { weight: vec![0.0, 0.5, 0.0, 0.25, 0.25, 0.0], log_evidence: 0.0 };
        for u in [0.0, 0.5, 0.999_999_999] {
            assert_eq!(weights.resample(4, u), [1, 1, 3, 4], "u = {u}");
        }
    }

    #[test]
    fn independent_groups_count_in_full_and_copies_do_not() {
        let values: Vec<f64> = (0..200).map(|i| f64::from(i * 37 % 101)).collect();
        let own: Vec<usize> = (0..200).collect();
        let each = vec![1.0 / 200.0; 200];
        let independent = group_ess(&values, &each, &own).unwrap();
        assert!((independent - 199.0 / COMMON_FIT).abs() < 1e-6, "{independent}");
        // Each value four times, from one ancestor.
        let copies: Vec<f64> = values[..50].iter().flat_map(|value| [*value; 4]).collect();
        let groups: Vec<usize> = (0..200).map(|i| i / 4).collect();
        let copied = group_ess(&copies, &each, &groups).unwrap();
        assert!((copied - 49.0 / COMMON_FIT).abs() < 1e-6, "{copied}");
        assert_eq!(group_ess(&[3.0; 200], &each, &own), None);
        assert_eq!(group_ess(&values, &each, &[7; 200]), Some(1.0), "one ancestor alone");
    }
}
