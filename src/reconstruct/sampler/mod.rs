//! Samples a posterior whose prior is a standard normal distribution: adaptive tempered sequential
//! Monte Carlo that keeps every evaluation.
//!
//! ```text
//! p(z | E) ∝ N(z; 0, I) L(z)          p_β(z) ∝ N(z; 0, I) L(z)^β,   β from 0 to 1
//! ```
//!
//! 1. Particles are drawn from the prior, β = 0.
//! 2. The next β is the largest at which the effective sample size of the weights is as large as the
//!    number of particles asked for, found by bisection ([`Jasra2011`](crate::bibliography::Jasra2011)).
//!    Particles of all temperatures are weighted, not those of the last one alone
//!    ([`KaramanisSeljak2024`](crate::bibliography::KaramanisSeljak2024)).
//! 3. Chains start from particles drawn by systematic resampling and make moves that keep p_β
//!    ([`DelMoral2006`](crate::bibliography::DelMoral2006)): steps towards a mixture of normals that
//!    is fitted to the particles, near and far, until each component has moved enough. Every state
//!    of a chain is a particle ([`DauChopin2022`](crate::bibliography::DauChopin2022)).
//! 4. At β = 1 the rounds go on until the effective sample size suffices. It is estimated from how
//!    far groups of common ancestry differ, so that it sees duplicates and slow chains.
//!
//! The same seed gives the same particles to the last digit, whatever the number of threads:
//! random numbers are drawn on one thread, a stream for each round.

mod checkpoint;
mod error;
mod mixture;
mod moves;
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
pub use particles::Particles;
pub use report::{SamplerReport, SamplerStage};
pub use run::sample;
pub use settings::SamplerSettings;
pub use target::Target;
