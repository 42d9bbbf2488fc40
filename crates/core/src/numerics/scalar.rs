//! The scalar types over which the equations of motion are generic.

use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub};

use num_dual::{Dual64, DualNum, DualSVec64};
use pulp::NullaryFnOnce;

use crate::numerics::elementary::{self, Elementary};

/// A real number, or several real numbers side by side (the lanes of a vector register), for which
/// the equations of motion are written.
///
/// - `f64` is used for simulation;
/// - a dual number of `num_dual` gives the exact Jacobian of the same code;
/// - [`Packed`](crate::numerics::Packed) evaluates as many motions at once as the machine has lanes,
///   each to the last digit as `f64` does.
///
/// The numbers have no order, because one of two lanes may be less than a limit and the other one
/// not. What depends on an order is chosen for each lane by [`Lanes::if_less`].
pub trait Lanes:
    LanesOver<f64>
    + Copy
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + AddAssign
    + MulAssign
{
    /// The same number in every lane, without a derivative. Any number of the type will do for
    /// `self`, whose value does not matter.
    fn constant(self, value: f64) -> Self;
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
    /// Arc tangent of the quotient of this number and one above 0, rad.
    fn atan_ratio(self, over: Self) -> Self;
    /// Sine and cosine of an angle in rad.
    fn sin_cos(self) -> (Self, Self);

    /// Square x².
    #[inline(always)]
    fn squared(self) -> Self {
        self * self
    }

    /// Arc tangent, rad.
    #[inline(always)]
    fn atan(self) -> Self {
        self.atan_ratio(self.constant(1.0))
    }

    /// Sine of an angle in rad.
    #[inline(always)]
    fn sin(self) -> Self {
        self.sin_cos().0
    }

    /// For each lane, `then` where this number is less than `limit` and `otherwise` where it is
    /// not.
    fn if_less(self, limit: Self, then: Self, otherwise: Self) -> Self;

    /// Whether this number is less than `limit` in at least one lane.
    fn any_less(self, limit: Self) -> bool;

    /// Whether this number is zero in every lane, and has no derivative.
    fn is_nothing(self) -> bool;

    /// The sign of the number, −1 or 1, with a derivative of zero; 1 at 0.
    #[inline(always)]
    fn sign(self) -> Self {
        self.if_less(self.constant(0.0), self.constant(-1.0), self.constant(1.0))
    }

    /// The hyperbolic tangent, also for large arguments: the derivative of `tanh` by dual numbers
    /// divides by cosh², which overflows from about 350 on.
    #[inline(always)]
    fn smooth_sign(self) -> Self {
        let end = self.constant(20.0); // tanh is 1 from here on
        if self.abs().any_less(end) { self.clamped(-end, end).tanh() } else { self.sign() }
    }

    /// The number, limited to the range from `low` to `high`.
    #[inline(always)]
    fn clamped(self, low: Self, high: Self) -> Self {
        self.if_less(low, low, high.if_less(self, high, self))
    }

    /// Carries out `work` on numbers of this type, as a function of its own that is compiled with the
    /// vector instructions that the type needs. It is no closure, since that would be compiled without
    /// them.
    #[inline(always)]
    fn apart<W: NullaryFnOnce>(self, work: W) -> W::Output {
        work.call()
    }
}

/// A number that goes together with constants of type `P` in the four operations: `f64`, if all lanes
/// have the same constants, or the number's own type, if each lane has its own.
pub trait LanesOver<P>:
    Sized
    + Add<P, Output = Self>
    + Sub<P, Output = Self>
    + Mul<P, Output = Self>
    + Div<P, Output = Self>
{
}

impl<P, T> LanesOver<P> for T where
    T: Add<P, Output = T> + Sub<P, Output = T> + Mul<P, Output = T> + Div<P, Output = T>
{
}

/// A single real number, with or without derivatives.
pub trait Scalar: Lanes + From<f64> + PartialOrd {
    /// The number without its derivatives.
    fn re(self) -> f64;
}

impl Elementary for f64 {
    #[inline(always)]
    fn power_of_two(self) -> Self {
        f64::from_bits(((self as i64 + 1023) as u64) << 52)
    }
}

impl Lanes for f64 {
    #[inline(always)]
    fn constant(self, value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }

    #[inline(always)]
    fn recip(self) -> Self {
        1.0 / self
    }

    #[inline(always)]
    fn exp(self) -> Self {
        elementary::exp(self)
    }

    #[inline(always)]
    fn tanh(self) -> Self {
        elementary::tanh(self)
    }

    #[inline(always)]
    fn atan_ratio(self, over: Self) -> Self {
        elementary::atan_ratio(self, over)
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        elementary::sin_cos(self)
    }

    #[inline(always)]
    fn if_less(self, limit: Self, then: Self, otherwise: Self) -> Self {
        if self < limit { then } else { otherwise }
    }

    #[inline(always)]
    fn any_less(self, limit: Self) -> bool {
        self < limit
    }

    #[inline(always)]
    fn is_nothing(self) -> bool {
        self == 0.0
    }
}

/// The operations of dual numbers, which `num_dual` has.
macro_rules! lanes_of_dual {
    () => {
        fn constant(self, value: f64) -> Self {
            Self::from(value)
        }

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

        fn atan_ratio(self, over: Self) -> Self {
            DualNum::atan(&(self / over))
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

        fn is_nothing(self) -> bool {
            false
        }

        // Each operation is many: in place at every call, one step alone takes a megabyte.
        #[inline(never)]
        fn apart<W: NullaryFnOnce>(self, work: W) -> W::Output {
            work.call()
        }
    };
}

/// Absolute value |x|; its derivative is that of the side of zero on which x lies.
fn magnitude<T: DualNum<Primitive = f64>>(x: T) -> T {
    x.abs()
}

impl Lanes for Dual64 {
    lanes_of_dual!();
}

impl<const N: usize> Lanes for DualSVec64<N> {
    lanes_of_dual!();
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
