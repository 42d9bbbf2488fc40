//! Folders of files that commands write.

mod force_evaluation;
mod force_prediction;
mod motion_prediction;
mod reconstruction;
mod reconstruction_evaluation;

pub(super) use force_evaluation::{write_force_evaluation, write_json};
pub(super) use force_prediction::write_force_prediction;
pub(super) use motion_prediction::{MotionFiles, write_motion_prediction};
pub(super) use reconstruction::write_reconstruction;
pub(super) use reconstruction_evaluation::{
    RECONSTRUCTION_EVALUATION_FILES, write_reconstruction_evaluation,
};
