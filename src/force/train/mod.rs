//! From cases to a trained model: losses, training with checkpoints, calibration, model files.

mod batch;
mod loss;

mod calibration;

mod record;

mod model;

mod training;

pub(crate) use batch::network_input;
pub use calibration::VarianceFactors;
pub use loss::LossTerms;
pub use model::ForceModel;
pub use record::{ForceEpoch, ForceRecord, ForceTraining};
pub use training::{ForceTrainSettings, ForceTrainingSet, fit_physics, train, train_around};
