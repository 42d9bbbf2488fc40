//! Trainings that have not ended: each has a checkpoint and beside it a note of what it is, so that
//! it can go on after the program was killed, also if its settings are not in the form any more.
//!
//! ```text
//! trainings/NETWORK-DATE.safetensors   the checkpoint, written by the training
//! trainings/NETWORK-DATE.note          question, data and the planned number of epochs
//! ```

mod diary;
mod note;
mod start;
mod status;

pub use diary::TrainingDiary;
pub use note::{Unfinished, UnfinishedList, training_options};
pub use status::UnfinishedTrainings;
