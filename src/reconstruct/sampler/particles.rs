//! The particles of a posterior.

use serde::{Deserialize, Serialize};

use super::population::group_ess;

/// Particles of equal weight from the prior times the likelihood to the power of a temperature.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Particles {
    /// Standard normal variables of each particle, `[n_particles][dim]`. A particle may occur more
    /// than once.
    pub z: Vec<Vec<f64>>,
    /// Natural logarithm of the likelihood of each particle.
    pub log_likelihood: Vec<f64>,
    /// Number of the ancestor of each particle. Particles of one ancestor may depend on each other.
    pub ancestor: Vec<usize>,
    /// Power β of the likelihood, 0 to 1: at 0 the particles are of the prior, at 1 of the
    /// posterior.
    pub temperature: f64,
    /// Estimate of `ln ∫ N(z; 0, I) L(z)^β dz`, at temperature 1 the log evidence.
    pub log_evidence: f64,
    /// Effective sample size of all evaluated particles: the smallest over the components of z. It
    /// may exceed the number of particles here, which are drawn from those. It is far too large for
    /// a ridge that folds back on itself (BENCHMARKS.md).
    pub ess: f64,
    /// Number of evaluations of the likelihood until now.
    pub n_evaluations: usize,
}

impl Particles {
    /// Whether the particles are of the posterior; those of a cancelled run may not be.
    pub fn of_posterior(&self) -> bool {
        self.temperature >= 1.0
    }

    /// Effective sample size of the mean of a quantity, from how far the sums over particles of one
    /// ancestor scatter. It is at most the number of particles.
    ///
    /// ```text
    /// standard error of the mean = standard deviation / √ESS
    /// ```
    ///
    /// - `values`: the quantity for each particle.
    /// - returns `None` for a quantity that does not vary.
    pub fn effective_sample_size(&self, values: &[f64]) -> Option<f64> {
        let weights = vec![1.0 / values.len() as f64; values.len()];
        group_ess(values, &weights, &self.ancestor)
    }
}
