//! The particles of a posterior.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::mixture::Mixture;

/// Particles of equal weight from the prior times the likelihood to the power of a temperature.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Particles {
    /// Standard normal variables of each particle, `[n_particles][dim]`. A particle may occur more
    /// than once.
    pub z: Vec<Vec<f64>>,
    /// Natural logarithm of the likelihood of each particle.
    pub log_likelihood: Vec<f64>,
    /// Number of the draw that each particle is a copy of; draws are independent.
    pub draw: Vec<usize>,
    /// Power β of the likelihood, 0 to 1: at 0 the particles are of the prior, at 1 of the
    /// posterior.
    pub temperature: f64,
    /// Whether somebody stopped the run before its end.
    pub is_stopped: bool,
    /// Effective sample size of all draws at temperature 1.
    pub posterior_ess: f64,
    /// Estimate of `ln ∫ N(z; 0, I) L(z)^β dz`, at temperature 1 the log evidence.
    pub log_evidence: f64,
    /// Effective sample size `1 / Σ w²` of all draws by their weights. It may exceed the number of
    /// particles here, which are taken from those.
    pub ess: f64,
    /// Number of evaluations of the likelihood until now.
    pub n_evaluations: usize,
    /// Particles of the posterior without each part of the evidence, from the same draws; none where
    /// these are not of the posterior.
    pub left_out: Vec<LeftOutParticles>,
    /// Where a similar target may be sampled from.
    pub start: SamplerStart,
}

/// Particles of equal weight of the posterior without one part of the evidence.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LeftOutParticles {
    /// Standard normal variables of each particle, `[n][dim]`.
    pub z: Vec<Vec<f64>>,
    /// Effective sample size of all draws by their weights. Few draws lie where the evidence that is
    /// left out keeps others away, so that it may be small.
    pub ess: f64,
}

/// Where the particles of a target lie, in a wide sense: a start for the sampling of a similar one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SamplerStart(pub(super) Mixture);

impl Particles {
    /// Whether the particles are of the posterior; those of a cancelled run may not be.
    pub fn is_posterior(&self) -> bool {
        self.temperature >= 1.0
    }

    /// Whether a finished run has particles of a weakened posterior, since too few were drawn where the
    /// posterior lies. To the power β a normal likelihood is that of a standard deviation σ / √β, so that
    /// their intervals are those of less certain evidence.
    pub fn is_weakened(&self) -> bool {
        !self.is_stopped && (Self::LEAST_WEAKENED..1.0).contains(&self.temperature)
    }

    /// Smallest temperature of a weakened posterior: standard deviations of the evidence four times as
    /// large.
    pub const LEAST_WEAKENED: f64 = 0.0625;

    /// How many times as large as stated the standard deviations of the evidence count: `1 / √β` in a
    /// weakened posterior, else 1.
    pub fn sigma_factor(&self) -> f64 {
        if self.is_weakened() { 1.0 / self.temperature.sqrt() } else { 1.0 }
    }

    /// Effective number of draws that these particles are copies of: `1 / Σ w²` by the share of each.
    pub fn effective_draws(&self) -> f64 {
        let share = 1.0 / self.draw.len().max(1) as f64;
        let mut shares = BTreeMap::new();
        self.draw.iter().for_each(|draw| *shares.entry(draw).or_insert(0.0) += share);
        1.0 / shares.values().map(|share: &f64| share * share).sum::<f64>()
    }

    /// Effective sample size of the mean of a quantity over these particles, of which those of one draw
    /// are copies:
    ///
    /// ```text
    /// V = G/(G − 1) Σ_g (Σ_{i in g} (x_i − μ)/n)²      ESS = σ² / V      standard error = σ / √ESS
    /// ```
    ///
    /// G is the effective number of draws g.
    ///
    /// - `values`: the quantity for each particle.
    /// - returns `None` for a quantity that does not vary.
    pub fn effective_sample_size(&self, values: &[f64]) -> Option<f64> {
        let share = 1.0 / values.len() as f64;
        let mean = share * values.iter().sum::<f64>();
        let n_draws = self.draw.iter().max().map_or(0, |largest| largest + 1);
        let (mut sums, mut variance) = (vec![0.0; n_draws], 0.0);
        for (value, draw) in values.iter().zip(&self.draw) {
            let deviation = share * (value - mean);
            variance += deviation * deviation / share;
            sums[*draw] += deviation;
        }
        if variance <= f64::EPSILON * mean * mean {
            return None;
        }
        let effective = self.effective_draws();
        if effective < 1.5 {
            return Some(1.0);
        }
        let scatter: f64 = sums.iter().map(|sum| sum * sum).sum();
        Some((variance * (effective - 1.0) / (effective * scatter)).max(1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::super::mixture::Weighted;
    use super::*;

    fn particles(draw: Vec<usize>) -> Particles {
        let n = draw.len();
        Particles {
            z: vec![vec![0.0]; n],
            log_likelihood: vec![0.0; n],
            draw,
            temperature: 1.0,
            is_stopped: false,
            posterior_ess: 1.0,
            log_evidence: 0.0,
            ess: 1.0,
            n_evaluations: n,
            left_out: Vec::new(),
            start: SamplerStart(Mixture::fit(Weighted { z: &[&[0.0]], weight: &[1.0] })),
        }
    }

    #[test]
    fn independent_draws_count_in_full_and_copies_do_not() {
        let values: Vec<f64> = (0..200).map(|i| f64::from(i * 37 % 101)).collect();
        let independent = particles((0..200).collect());
        let ess = independent.effective_sample_size(&values).unwrap();
        assert!((ess - 199.0).abs() < 1e-6, "{ess}");
        // Each value four times, from one draw.
        let copies: Vec<f64> = values[..50].iter().flat_map(|value| [*value; 4]).collect();
        let copied = particles((0..200).map(|i| i / 4).collect());
        let ess = copied.effective_sample_size(&copies).unwrap();
        assert!((ess - 49.0).abs() < 1e-6, "{ess}");
        assert!((copied.effective_draws() - 50.0).abs() < 1e-9);
        assert_eq!(independent.effective_sample_size(&[3.0; 200]), None);
        assert_eq!(particles(vec![7; 200]).effective_sample_size(&values), Some(1.0));
    }
}
