//! The scalar types over which the equations of motion are generic.

use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub};

use num_dual::{Dual64, DualNum, DualSVec64};
use wide::{f64x2, f64x4};

/// A real number, or several real numbers side by side (the lanes of a vector register), for which
/// the equations of motion are written.
///
/// - `f64` is used for simulation;
/// - a dual number of `num_dual` gives the exact Jacobian of the same code;
/// - `f64x2` evaluates two motions at once.
///
/// The numbers have no order, because one of two lanes may be less than a limit and the other one
/// not. What depends on an order is chosen for each lane by [`Lanes::if_less`].
pub trait Lanes:
    Copy
    + From<f64>
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
    + AddAssign
    + MulAssign
{
    /// Absolute value |x|.
    fn abs(self) -> Self;
    /// Square root √x.
    fn sqrt(self) -> Self;
    /// Reciprocal 1/x.
    fn recip(self) -> Self;
    /// Exponential function eˣ.
    fn exp(self) -> Self;
    /// Hyperbolic tangent.
    fn tanh(self) -> Self;
    /// Arc tangent, rad.
    fn atan(self) -> Self;
    /// Sine of an angle in rad.
    fn sin(self) -> Self;
    /// Sine and cosine of an angle in rad.
    fn sin_cos(self) -> (Self, Self);

    /// Square x².
    fn squared(self) -> Self {
        self * self
    }

    /// Arc tangents of four numbers, rad. Types without derivatives compute them by vector
    /// instructions, in a third of the time.
    fn atan_each(x: [Self; 4]) -> [Self; 4] {
        x.map(Self::atan)
    }

    /// For each lane, `then` where this number is less than `limit` and `otherwise` where it is
    /// not.
    fn if_less(self, limit: Self, then: Self, otherwise: Self) -> Self;

    /// Whether this number is less than `limit` in at least one lane.
    fn any_less(self, limit: Self) -> bool;

    /// The sign of the number, −1 or 1, with a derivative of zero; 1 at 0.
    fn sign(self) -> Self {
        self.if_less(Self::from(0.0), Self::from(-1.0), Self::from(1.0))
    }

    /// The number, limited to the range from `low` to `high`.
    fn clamped(self, low: Self, high: Self) -> Self {
        self.if_less(low, low, high.if_less(self, high, self))
    }
}

/// A single real number, with or without derivatives.
pub trait Scalar: Lanes + PartialOrd {
    /// The number without its derivatives.
    fn re(self) -> f64;
}

/// The operations that are delegated to `num_dual` for a type with one lane.
macro_rules! lanes_of_one {
    () => {
        fn abs(self) -> Self {
            magnitude(self)
        }

        fn sqrt(self) -> Self {
            DualNum::sqrt(&self)
        }

        fn recip(self) -> Self {
            DualNum::recip(&self)
        }

        fn exp(self) -> Self {
            DualNum::exp(&self)
        }

        fn tanh(self) -> Self {
            DualNum::tanh(&self)
        }

        fn atan(self) -> Self {
            DualNum::atan(&self)
        }

        fn sin(self) -> Self {
            DualNum::sin(&self)
        }

        fn sin_cos(self) -> (Self, Self) {
            DualNum::sin_cos(&self)
        }

        fn if_less(self, limit: Self, then: Self, otherwise: Self) -> Self {
            if self < limit { then } else { otherwise }
        }

        fn any_less(self, limit: Self) -> bool {
            self < limit
        }
    };
}

/// Absolute value |x|; its derivative is that of the side of zero on which x lies.
fn magnitude<T: DualNum<Primitive = f64>>(x: T) -> T {
    x.abs()
}

impl Lanes for f64 {
    lanes_of_one!();

    fn atan_each(x: [Self; 4]) -> [Self; 4] {
        f64x4::new(x).atan().to_array()
    }
}

impl Lanes for Dual64 {
    lanes_of_one!();
}

impl<const N: usize> Lanes for DualSVec64<N> {
    lanes_of_one!();
}

impl Scalar for f64 {
    fn re(self) -> f64 {
        self
    }
}

impl Scalar for Dual64 {
    fn re(self) -> f64 {
        self.re
    }
}

impl<const N: usize> Scalar for DualSVec64<N> {
    fn re(self) -> f64 {
        self.re
    }
}

impl Lanes for f64x2 {
    fn abs(self) -> Self {
        self.abs()
    }

    fn sqrt(self) -> Self {
        self.sqrt()
    }

    fn recip(self) -> Self {
        Self::ONE / self
    }

    // Here the vector instructions are not faster than one number after the other.
    fn exp(self) -> Self {
        Self::new(self.to_array().map(f64::exp))
    }

    fn tanh(self) -> Self {
        self.tanh()
    }

    fn atan(self) -> Self {
        self.atan()
    }

    fn sin(self) -> Self {
        let (sin, _) = self.sin_cos();
        sin
    }

    fn sin_cos(self) -> (Self, Self) {
        self.sin_cos()
    }

    fn atan_each(x: [Self; 4]) -> [Self; 4] {
        let [[a, b], [c, d], [e, f], [g, h]] = x.map(Self::to_array);
        let [a, b, c, d] = f64x4::new([a, b, c, d]).atan().to_array();
        let [e, f, g, h] = f64x4::new([e, f, g, h]).atan().to_array();
        [[a, b], [c, d], [e, f], [g, h]].map(Self::new)
    }

    fn if_less(self, limit: Self, then: Self, otherwise: Self) -> Self {
        self.simd_lt(limit).select(then, otherwise)
    }

    fn any_less(self, limit: Self) -> bool {
        self.simd_lt(limit).any()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn number() -> impl Strategy<Value = f64> {
        prop_oneof![-1e-3..1e-3, -5.0..5.0, -1e4..1e4]
    }

    fn assert_near(got: f64, expected: f64) {
        assert!((got - expected).abs() <= 4.0 * f64::EPSILON * expected.abs(), "{got} {expected}");
    }

    proptest! {
        #[test]
        fn four_arc_tangents_are_those_of_each(x in prop::array::uniform4(number())) {
            for (got, x) in f64::atan_each(x).into_iter().zip(x) {
                assert_near(got, f64::atan(x));
            }
            let pairs = f64x2::atan_each(x.map(|x| f64x2::new([x, -2.0 * x])));
            for (got, x) in pairs.into_iter().zip(x) {
                assert_near(got.to_array()[0], f64::atan(x));
                assert_near(got.to_array()[1], f64::atan(-2.0 * x));
            }
        }

        #[test]
        fn two_side_by_side_are_each_of_them(x in number(), y in number(), limit in number()) {
            fn all<T: Lanes>(x: T, limit: f64) -> [T; 10] {
                let (sin, cos) = x.sin_cos();
                let limit = T::from(limit);
                [
                    x.abs(), x.abs().sqrt(), x.recip(), (-x.abs()).exp(), x.tanh(), x.atan(), x.sign(),
                    x.if_less(limit, x * 2.0, limit), x.clamped(-limit.abs(), limit.abs()), sin - cos,
                ]
            }
            let both = all(f64x2::new([x, y]), limit);
            let (of_x, of_y) = (all(x, limit), all(y, limit));
            for ((both, x), y) in both.into_iter().zip(of_x).zip(of_y) {
                let off = |got: f64, one: f64| (got - one).abs() / (1e-12 + one.abs());
                prop_assert!(off(both.to_array()[0], x) < 1e-11, "{both:?} {x}");
                prop_assert!(off(both.to_array()[1], y) < 1e-11, "{both:?} {y}");
            }
            let any = f64x2::new([x, y]).any_less(f64x2::from(limit));
            prop_assert_eq!(any, x < limit || y < limit);
        }
    }

    #[test]
    fn the_ends_are_right_angles_and_nothing_is_nothing() {
        let [zero, up, down, none] = f64::atan_each([0.0, f64::INFINITY, -1e300, f64::NAN]);
        assert_eq!([zero, up, down], [0.0, 90_f64.to_radians(), -90_f64.to_radians()]);
        assert!(none.is_nan());
    }
}
