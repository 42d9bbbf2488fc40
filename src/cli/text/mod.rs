//! Reports as a person reads them.

mod check;
mod comparison;
mod facts;
mod force_evaluation;
mod reconstruction_evaluation;
mod simulate_dataset;
mod trained;

pub(super) use check::print_check;
pub(super) use comparison::print_comparison;
pub(super) use facts::{PrintedAnswer, print_answer};
pub(super) use force_evaluation::print_force_evaluation;
pub(super) use reconstruction_evaluation::print_reconstruction_evaluation;
pub(super) use simulate_dataset::print_dataset_simulation;
pub(super) use trained::print_trained;
