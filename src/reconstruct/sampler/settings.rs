//! Settings of the sampler.

use serde::{Deserialize, Serialize};

/// Settings of the sampler.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SamplerSettings {
    /// Number of particles of the answer, 2 or more.
    pub n_particles: usize,
    /// Seed of all random numbers. The same seed gives the same particles to the last digit.
    pub seed: u64,
    /// Effective sample size at which sampling ends. The sampler goes on at temperature 1 until it
    /// is reached or the evaluations are spent.
    pub least_ess: f64,
    /// Largest number of evaluations of the likelihood. It is exceeded only if temperature 1 has
    /// not been reached by then.
    pub max_evaluations: usize,
}

impl Default for SamplerSettings {
    fn default() -> Self {
        Self { n_particles: 2000, seed: 0, least_ess: 400.0, max_evaluations: 60_000 }
    }
}
