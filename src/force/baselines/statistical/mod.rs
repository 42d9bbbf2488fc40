//! Baseline (c): Gaussian processes on principal components.

mod baseline;
mod choice;
mod scales;
mod shapes;
mod spread;

pub use baseline::{StatisticalBaseline, StatisticalOptions};
