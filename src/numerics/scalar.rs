//! The number that the physics is written in.

use num_dual::DualNum;

/// A real number with or without derivatives: `f64` simulates, a dual number of `num_dual` gives
/// the exact Jacobian of the same lines.
pub trait Scalar: DualNum<Primitive = f64> + Copy {}

impl<T: DualNum<Primitive = f64> + Copy> Scalar for T {}
