//! Training of the force network: tensors, losses, epochs with checkpoints, calibration of the
//! variances, and model files.

mod batch;
mod loss;

mod calibration;
mod held_shares;
mod peaks;

mod record;

mod model;

mod training;

pub(crate) use batch::network_input;
pub(crate) use calibration::CalibrationCase;
pub use calibration::{FarFactors, VarianceCalibration, VarianceFactors};
pub use loss::LossTerms;
pub use model::ForceModel;
pub use record::{ForceEpoch, ForceRecord, ForceTraining};
pub use training::{
    FORCE_CHECKPOINT, ForceTrainSettings, ForceTrainingSet, fit_physics, train, train_around,
};
