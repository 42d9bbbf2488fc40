//! What happens when one vehicle hits another, and in the second after.
//!
//! Data flows one way, and each module names only those above it:
//!
//! 1. [`bibliography`], [`units`], [`jobs`]: sources, unit conversion, background work;
//! 2. [`data`]: files become checked time series in SI units.

pub mod bibliography;
pub mod compare;
pub mod data;
pub mod jobs;
pub mod numerics;
pub mod units;
pub mod vehicle;
