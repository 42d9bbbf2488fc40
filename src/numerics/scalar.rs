//! The number that the physics is written in.

use num_dual::{Dual64, DualNum, DualSVec64};
use wide::f64x4;

/// A real number with or without derivatives: `f64` simulates, a dual number of `num_dual` gives
/// the exact Jacobian of the same lines.
pub trait Scalar: DualNum<Primitive = f64> + Copy {
    /// Arc tangents of four numbers, rad; in vector instructions where there are no derivatives, at
    /// a third of the time.
    fn atan_each(x: [Self; 4]) -> [Self; 4] {
        x.map(|x| x.atan())
    }
}

impl Scalar for f64 {
    fn atan_each(x: [Self; 4]) -> [Self; 4] {
        f64x4::new(x).atan().to_array()
    }
}

impl Scalar for Dual64 {}

impl<const N: usize> Scalar for DualSVec64<N> {}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn four_arc_tangents_are_those_of_each(
            x in prop::array::uniform4(prop_oneof![-1e-3..1e-3, -5.0..5.0, -1e9..1e9]),
        ) {
            for (got, x) in f64::atan_each(x).into_iter().zip(x) {
                prop_assert!((got - x.atan()).abs() <= 4.0 * f64::EPSILON * x.atan().abs(), "{x}");
            }
        }
    }

    #[test]
    fn the_ends_are_right_angles_and_nothing_is_nothing() {
        let [zero, up, down, none] = f64::atan_each([0.0, f64::INFINITY, -1e300, f64::NAN]);
        assert_eq!([zero, up, down], [0.0, 90_f64.to_radians(), -90_f64.to_radians()]);
        assert!(none.is_nan());
    }
}
