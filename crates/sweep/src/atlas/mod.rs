//! The atlas: what a manoeuvre leads to over the space of its conditions, aggregated from the rows of
//! a sweep.
//!
//! ```text
//! rows ──> cells over all axes ──┬──> slice: two axes, the others held or averaged ──> map
//!                                └──> cell: all outcomes of one place, or of many together
//! rows of a Saltelli design ──> Sobol indices: which input moves an outcome
//! ```
//!
//! It is a model study: it says what was computed, and of no speed that it is safe. A cell with few
//! rows has no mean, a mean has its Monte Carlo standard error, and the share of rows in which both
//! networks apply stands beside it.

mod error;

mod axis;

mod histogram;

mod cell;

mod model;

mod hold;

mod make;

mod npy;

mod file;

mod file_error;

mod sensitivity;

mod case;

pub use axis::{Axis, AxisError};
pub use case::{CasePlace, OutsideInput, place_of_case, why_no_pit};
pub use cell::{Cell, Corridor, MIN_ROWS, Measure, Quantile, SliceCell};
pub use error::AtlasError;
pub use file_error::AtlasFileError;
pub use histogram::HistogramKind;
pub use make::AtlasBuilder;
pub use model::{Atlas, Slice};
pub use sensitivity::{OutcomeSensitivity, Sensitivity, SensitivityError, sobol_indices};
