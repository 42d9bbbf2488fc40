//! The model that answers the questions of one network. It is loaded and saved in the background,
//! or it comes from a training.

mod current;
mod name;
mod status;

pub use current::{CurrentModel, ModelEvent, ModelNews};
pub use name::file_name;
pub use status::ModelStatus;
