//! The training: trajectories and simulations to learn from, the stages of a training with their
//! epochs, and what a training leaves behind besides weights.

pub(super) mod case;

pub(super) mod simulated;

mod physics_points;

mod physics_weight;

mod record;

mod training_data;
mod training_run;

mod fleet;
mod side_by_side;
mod strengths_over_cars;
mod widths;

mod stages;

pub use case::{ResponseCase, ResponseCaseError};
pub(crate) use fleet::{cars_of, train_parts};
pub use fleet::{condition, train_fleet};
pub use record::{ResponseEpoch, ResponseRecord, ResponseStage, ResponseTraining};
pub use simulated::ImpactRecord;
pub(crate) use stages::check_start;
pub use stages::{ResponseTrainSettings, ResponseTrainingSet, fine_tune, pretrain};
pub use strengths_over_cars::{UnseenCars, learn_population};
pub use training_run::RESPONSE_CHECKPOINT;
pub use widths::recalibrate;
