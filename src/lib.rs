//! What happens when one vehicle hits another, and in the second after.
//!
//! Data flows one way, and each module names only those above it:
//!
//! 1. [`bibliography`], [`units`], [`jobs`]: sources, unit conversion, background work;
//! 2. [`data`]: files become checked time series in SI units;
//! 3. [`collision`]: the impact itself: impulse, contact geometry, scenarios, pulses, filter.

pub mod bibliography;
pub mod collision;
pub mod data;
pub mod jobs;
pub mod numerics;
pub mod units;
