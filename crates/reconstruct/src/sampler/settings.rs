//! Settings of the sampler.

use serde::{Deserialize, Serialize};

use super::SamplerError;

/// Settings of the sampler.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SamplerSettings {
    /// Number of particles of the answer, 2 to 1 000 000. Twice as many is the effective sample size
    /// that mixtures are fitted to.
    pub n_particles: usize,
    /// Seed of all random numbers. The same seed gives the same particles to the last digit.
    pub seed: u64,
    /// Effective sample size at which sampling ends, 1 or more. The sampler goes on
    /// until it is reached or the evaluations are spent.
    pub least_ess: f64,
    /// Largest number of evaluations of the likelihood, a quarter of them of draws from the prior. It is
    /// exceeded by the rest of a round, and up to fourfold as long as the effective sample size at
    /// temperature 1 is below 20; after that the particles are not of the posterior.
    pub max_evaluations: usize,
}

impl Default for SamplerSettings {
    fn default() -> Self {
        Self { n_particles: 2000, seed: 0, least_ess: 400.0, max_evaluations: 60_000 }
    }
}

impl SamplerSettings {
    /// Checks the settings.
    ///
    /// # Errors
    /// [`SamplerError::Setting`].
    pub fn check(&self) -> Result<(), SamplerError> {
        let checks = [
            (
                "n_particles",
                self.n_particles as f64,
                (2..=1_000_000).contains(&self.n_particles),
                "2 to 1 000 000",
            ),
            ("least_ess", self.least_ess, self.least_ess >= 1.0, "1 or more"),
            (
                "max_evaluations",
                self.max_evaluations as f64,
                self.max_evaluations >= self.n_particles,
                "the number of particles or more",
            ),
        ];
        match checks.into_iter().find(|(.., is_good, _)| !is_good) {
            Some((name, value, _, expected)) => {
                Err(SamplerError::Setting { name, value, expected })
            }
            None => Ok(()),
        }
    }
}
