//! The contact force before it happens: cases to learn from, models, and how well they do.

mod scenario;

mod case;
mod split;

mod momentum;
mod prediction;

mod clusters;
pub mod metrics;

pub mod baselines;

pub use case::{ForceCase, ForceCaseError, curve_on_grid};
pub use clusters::{ImpulseClusters, ImpulseFeatures};
pub use momentum::MomentumModel;
pub use prediction::Prediction;
pub use scenario::ForceScenario;
pub use split::{Split, TEST_SHARE, folds, split};
