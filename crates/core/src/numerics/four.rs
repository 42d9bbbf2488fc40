//! Four numbers that go through the same calculation, such as those of the wheels of a vehicle.

use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub};

use crate::numerics::Lanes;

/// Four numbers that go through the same calculation. Each operation is carried out on all of them
/// before the next one, so that roots and divisions do not wait for each other.
#[derive(Debug, Clone, Copy)]
pub struct Four<T>(pub [T; 4]);

impl<T: Copy> Four<T> {
    /// The same number four times.
    #[inline(always)]
    pub fn splat(value: T) -> Self {
        Self([value; 4])
    }
}

/// Carries out an operation on each number.
macro_rules! each {
    (|$i:ident| $operation:expr) => {
        Four([
            {
                let $i = 0;
                $operation
            },
            {
                let $i = 1;
                $operation
            },
            {
                let $i = 2;
                $operation
            },
            {
                let $i = 3;
                $operation
            },
        ])
    };
}

/// An operation with four others, and with one number.
macro_rules! operation {
    ($operation:ident, $method:ident) => {
        impl<T: Lanes> $operation for Four<T> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                each!(|i| self.0[i].$method(other.0[i]))
            }
        }

        impl<T: Lanes> $operation<f64> for Four<T> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                each!(|i| self.0[i].$method(other))
            }
        }
    };
}

operation!(Add, add);
operation!(Sub, sub);
operation!(Mul, mul);
operation!(Div, div);

impl<T: Lanes> Neg for Four<T> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        each!(|i| -self.0[i])
    }
}

impl<T: Lanes> AddAssign for Four<T> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<T: Lanes> MulAssign for Four<T> {
    #[inline(always)]
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl<T: Lanes> Lanes for Four<T> {
    #[inline(always)]
    fn constant(self, value: f64) -> Self {
        Self::splat(self.0[0].constant(value))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        each!(|i| self.0[i].abs())
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        each!(|i| self.0[i].sqrt())
    }

    #[inline(always)]
    fn recip(self) -> Self {
        each!(|i| self.0[i].recip())
    }

    #[inline(always)]
    fn exp(self) -> Self {
        each!(|i| self.0[i].exp())
    }

    #[inline(always)]
    fn tanh(self) -> Self {
        each!(|i| self.0[i].tanh())
    }

    #[inline(always)]
    fn atan_ratio(self, over: Self) -> Self {
        each!(|i| self.0[i].atan_ratio(over.0[i]))
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let [a, b, c, d] =
            [self.0[0].sin_cos(), self.0[1].sin_cos(), self.0[2].sin_cos(), self.0[3].sin_cos()];
        (Self([a.0, b.0, c.0, d.0]), Self([a.1, b.1, c.1, d.1]))
    }

    #[inline(always)]
    fn if_less(self, limit: Self, then: Self, otherwise: Self) -> Self {
        each!(|i| self.0[i].if_less(limit.0[i], then.0[i], otherwise.0[i]))
    }

    #[inline(always)]
    fn any_less(self, limit: Self) -> bool {
        let [a, b, c, d] = self.0;
        let [of_a, of_b, of_c, of_d] = limit.0;
        a.any_less(of_a) | b.any_less(of_b) | c.any_less(of_c) | d.any_less(of_d)
    }

    #[inline(always)]
    fn is_nothing(self) -> bool {
        let [a, b, c, d] = self.0;
        a.is_nothing() && b.is_nothing() && c.is_nothing() && d.is_nothing()
    }
}
