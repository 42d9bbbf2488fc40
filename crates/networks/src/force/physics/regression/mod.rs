//! Force curves by regression: Gaussian processes on principal components of curves that are scaled
//! by impulse and duration. Options are chosen by cross-validation on training cases.

mod error;

mod columns;

mod alignment;
mod validation;

mod scales;
mod shapes;
mod spread;

mod choice;
mod curve_regression;

pub use alignment::Alignment;
pub(crate) use alignment::impulse_share_times_s;
pub use columns::{ColumnSet, FeatureMap};
pub use curve_regression::{CurveRegression, CurveRegressionOptions};
pub use error::CurveFitError;
pub use validation::N_FOLDS;
pub(crate) use validation::{best_of, case_folds, history_error, mean};
