//! The number type of physics that is written once: `f64` for simulation, dual numbers for exact
//! derivatives.

/// A real number or a dual number over `f64`.
pub trait Scalar: num_dual::DualNum<Primitive = f64> + Copy {}

impl<T: num_dual::DualNum<Primitive = f64> + Copy> Scalar for T {}
