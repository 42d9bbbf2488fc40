//! Gaussian process regression.

mod likelihood;
mod process;

pub use process::{GaussianPrediction, GaussianProcess, GaussianProcessData, GaussianProcessError};
