//! The contact force before it happens: cases to learn from, models, and how well they do.

mod scenario;

mod case;
mod split;

mod prediction;

pub mod metrics;

pub use case::{ForceCase, ForceCaseError, curve_on_grid};
pub use prediction::Prediction;
pub use scenario::ForceScenario;
pub use split::{Split, TEST_SHARE, folds, split};
