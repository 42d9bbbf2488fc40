//! Reconstruction: from the evidence of a collision back to the speeds before it, as a distribution.

pub mod baseline;
mod budget;
mod calibration;
mod modes;
pub mod sampler;

pub use budget::Narrowing;
pub use calibration::{RankedQuantity, Ranks, ranks_of_cases};
pub use modes::{ParticleMode, cluster_keys, modes_by};
