//! The training: trajectories and simulations to learn from, the stages of a training with their
//! epochs, and what a training leaves behind besides weights.

pub(super) mod case;
mod load;

pub(super) mod simulated;

mod physics_points;

mod physics_weight;

mod record;

mod training_file;
mod training_run;

mod stages;

pub use case::{ResponseCase, ResponseCaseError};
pub use load::ResponseLoadError;
pub use record::{ResponseEpoch, ResponseRecord, ResponseStage, ResponseTrainingSet};
pub use simulated::ImpactRecord;
pub use stages::{ResponseProgress, ResponseReport, ResponseTrainSettings, fine_tune, pretrain};
