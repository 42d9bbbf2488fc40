//! What a force model must beat, each made as strong as it honestly can be: METHOD of this project,
//! section 4. All are fitted to training cases and choose their own options by cross-validation on
//! them; all take canonical scenarios.

mod error;

mod features;

mod alignment;
mod choice;

mod nearest;
mod pulse;
mod statistical;

pub use alignment::Alignment;
pub use choice::N_FOLDS;
pub use error::BaselineError;
pub use features::{ColumnSet, FeatureMap};
pub use nearest::{NearestBaseline, NearestScaling};
pub use pulse::PulseBaseline;
pub use statistical::{StatisticalBaseline, StatisticalOptions};
