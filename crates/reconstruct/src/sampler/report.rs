//! The progress of a run of the sampler.

/// What the sampler is doing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SamplerStage {
    /// It draws particles from the prior.
    Prior,
    /// It raises the temperature to 1.
    Tempering,
    /// It samples the posterior until the effective sample size suffices.
    Posterior,
}

/// The progress of a run, reported after each batch of evaluations, and within a batch that takes long.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SamplerReport<'a> {
    /// What is being done.
    pub stage: SamplerStage,
    /// Power β of the likelihood of the particles below, 0 to 1.
    pub temperature: f64,
    /// Number of evaluations of the likelihood until now.
    pub n_evaluations: usize,
    /// Effective sample size of the posterior until now, once anything but the prior was drawn from.
    pub ess: Option<f64>,
    /// Latest particles, to be drawn, `[n][dim]`: their number varies.
    pub z: &'a [Vec<f64>],
    /// Natural logarithm of the likelihood of each of them.
    pub log_likelihood: &'a [f64],
}
