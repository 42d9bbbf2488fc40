//! The two networks behind one interface, for the parts of the app that treat them alike.

mod kind;
mod trained_model;

pub use kind::Network;
pub use trained_model::TrainedModel;
