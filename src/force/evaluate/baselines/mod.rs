//! What a force model must beat besides the regressions in its own centre, each made as strong as it
//! honestly can be. All are fitted to training cases and choose
//! their own options by cross-validation on them; all take canonical scenarios.

mod nearest;
mod pulse;

pub use nearest::{NearestBaseline, NearestScaling};
pub use pulse::PulseBaseline;
