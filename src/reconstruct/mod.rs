//! Reconstruction: from the evidence of a collision back to the speeds before it, as a distribution.

pub mod sampler;
