//! The two networks behind one interface, for the parts of the app that treat them alike, and the
//! questions about them.

mod kind;
mod questions;
mod trained_model;
mod training_mode;

pub use kind::Network;
pub use questions::NetworkQuestions;
pub use trained_model::TrainedModel;
pub use training_mode::TrainingMode;
