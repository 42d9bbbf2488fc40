//! Numerical tools that know no vehicle.

mod scalar;

pub use scalar::Scalar;
