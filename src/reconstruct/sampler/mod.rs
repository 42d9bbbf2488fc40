//! Samples a posterior whose prior is a standard normal distribution.

mod particles;
mod report;
mod settings;
mod target;

pub use particles::Particles;
pub use report::{SamplerReport, SamplerStage};
pub use settings::SamplerSettings;
pub use target::Target;
