//! Samples a posterior whose prior is a standard normal distribution: adaptive tempered sequential
//! Monte Carlo with independent proposals, every one of which is kept and weighted.
//!
//! ```text
//! p(z | E) ∝ N(z; 0, I) L(z)          p_β(z) ∝ N(z; 0, I) L(z)^β,   β from 0 to 1
//! ```
//!
//! 1. Particles are drawn from the prior.
//! 2. The temperature β is the largest at which the effective sample size of the weights is twice the
//!    number of particles asked for, found by bisection ([`Jasra2011`](impactlab_core::bibliography::Jasra2011)).
//! 3. A mixture of normals is fitted to the particles as weighted at β, and a batch is drawn from it.
//! 4. All particles are weighted anew as draws from the mixture of everything that was drawn from
//!    (`population`), which needs no estimate and leaves no bias in the weights.
//! 5. The last two steps are repeated until the effective sample size at β = 1 suffices.
//!
//! β stays below 1 for as long as there are few particles of the posterior, so that what is drawn from
//! is wider than the posterior. There are no Markov chains: chains between temperatures, of which this
//! sampler was made before, had not spread over the posterior when the temperature was raised, and
//! each fit to them was narrower than the one before, so that tails and small modes were lost without
//! a trace in their effective sample size (BENCHMARKS.md).
//!
//! Where a similar target was sampled before ([`SamplerStart`]), most of the first draws are taken from
//! where its particles lie.
//!
//! The same seed gives the same particles to the last digit, whatever the number of threads:
//! random numbers are drawn on one thread, a stream for each round.

mod checkpoint;
mod error;
mod mixture;
mod particles;
mod population;
mod report;
mod run;
mod settings;
mod target;
#[cfg(test)]
pub(crate) mod test_targets;
#[cfg(test)]
mod tests;

pub use checkpoint::SamplerCheckpoint;
pub use error::SamplerError;
pub(crate) use mixture::standard_normals;
pub use particles::{LeftOutParticles, Particles, SamplerStart};
pub use report::{SamplerReport, SamplerStage};
pub use run::{sample, sample_from};
pub use settings::SamplerSettings;
pub use target::{Likelihood, Target};
