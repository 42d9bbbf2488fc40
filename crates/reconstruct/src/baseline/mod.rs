//! What the sampler is compared with: the most probable point with its curvature, and rejection.

mod point_optimum;
mod rejection;

pub use point_optimum::{OptimumSettings, PointOptimum};
pub use rejection::{Rejection, RejectionError, rejection_sample};
