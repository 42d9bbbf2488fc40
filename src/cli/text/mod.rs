//! Reports as a person reads them.

mod check;
mod comparison;
mod contact;
mod force_evaluation;
mod force_prediction;
mod motion_prediction;
mod reconstruction;
mod reconstruction_evaluation;
mod sensitivity;
mod simulate;
mod simulate_dataset;
mod training;

pub(super) use check::print_check;
pub(super) use comparison::print_comparison;
pub(super) use force_evaluation::print_force_evaluation;
pub(super) use force_prediction::print_force_prediction;
pub(super) use motion_prediction::print_motion_prediction;
pub(super) use reconstruction::print_reconstruction;
pub(super) use reconstruction_evaluation::print_reconstruction_evaluation;
pub(super) use simulate::print_simulation;
pub(super) use simulate_dataset::print_dataset_simulation;
pub(super) use training::{Trained, print_force_training, print_response_training};
