//! Baselines of the evaluation besides the regressions of the centre: a classic pulse and the nearest
//! training case. They are fitted to training cases, choose their options by cross-validation on them
//! and take canonical scenarios.

mod nearest;
mod pulse;

pub use nearest::{NearestBaseline, NearestScaling};
pub use pulse::PulseBaseline;
