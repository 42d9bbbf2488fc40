//! Real numbers side by side in the vector registers that the machine has: four with AVX2, eight with
//! AVX-512, one without either. Which it is, is found out when the program runs.
//!
//! What computes with them must be inlined into a function that is compiled for these registers,
//! [`Lanes::apart`] or `pulp::Simd::vectorize`; otherwise it is right but slow.

use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub};

use pulp::{NullaryFnOnce, Simd, WithSimd};

use crate::numerics::Lanes;
use crate::numerics::elementary::{self, Elementary};

/// Most lanes that a machine has.
pub const MAX_LANES: usize = 8;

/// Real numbers side by side in a vector register of the kind S. Every lane has the result of `f64` to
/// the last digit.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))] // a register that lies across two cache lines takes twice as long
pub struct Packed<S: Simd> {
    simd: S,
    lanes: S::f64s,
}

impl<S: Simd> Packed<S> {
    /// Number of lanes.
    pub const N: usize = {
        assert!(S::F64_LANES <= MAX_LANES);
        S::F64_LANES
    };

    /// The same number in every lane.
    #[inline(always)]
    pub fn splat(simd: S, value: f64) -> Self {
        Self { simd, lanes: simd.splat_f64s(value) }
    }

    /// A number for each lane; those beyond [`Packed::N`] are left out.
    #[inline(always)]
    pub fn new(simd: S, values: &[f64; MAX_LANES]) -> Self {
        // A load of so many numbers as are there would call an assembler routine that jumps to their number.
        let lanes =
            pulp::bytemuck::pod_read_unaligned(pulp::bytemuck::cast_slice(&values[..Self::N]));
        Self { simd, lanes }
    }

    /// The numbers of the lanes; those beyond [`Packed::N`] are zero.
    #[inline(always)]
    pub fn to_array(self) -> [f64; MAX_LANES] {
        let mut values = [0.0; MAX_LANES];
        let lanes = pulp::bytemuck::cast_slice(std::slice::from_ref(&self.lanes));
        values[..Self::N].copy_from_slice(lanes);
        values
    }

    /// Rows of numbers, one for each lane, as numbers side by side; lanes beyond the rows repeat the last
    /// one.
    #[inline(always)]
    pub fn columns<const M: usize>(simd: S, rows: &[[f64; M]]) -> [Self; M] {
        let mut columns = [Self::splat(simd, 0.0); M];
        let Some(last) = rows.len().checked_sub(1) else { return columns };
        for (i, column) in columns.iter_mut().enumerate() {
            let mut values = [0.0; MAX_LANES];
            for (lane, value) in values[..Self::N].iter_mut().enumerate() {
                *value = rows[lane.min(last)][i];
            }
            *column = Self::new(simd, &values);
        }
        columns
    }

    /// Numbers side by side as rows, one for each lane: what [`Packed::columns`] takes.
    #[inline(always)]
    pub fn rows<const M: usize>(columns: &[Self; M]) -> [[f64; M]; MAX_LANES] {
        let mut rows = [[0.0; M]; MAX_LANES];
        for (i, column) in columns.iter().enumerate() {
            for (row, value) in rows.iter_mut().zip(column.to_array()) {
                row[i] = value;
            }
        }
        rows
    }

    #[inline(always)]
    fn with_lanes(self, lanes: S::f64s) -> Self {
        Self { lanes, ..self }
    }
}

/// An operation with another of the same kind, and with a number that all lanes share.
macro_rules! operation {
    ($operation:ident, $method:ident, $of_simd:ident) => {
        impl<S: Simd> $operation for Packed<S> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.with_lanes(self.simd.$of_simd(self.lanes, other.lanes))
            }
        }

        impl<S: Simd> $operation<f64> for Packed<S> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                self.with_lanes(self.simd.$of_simd(self.lanes, self.simd.splat_f64s(other)))
            }
        }
    };
}

operation!(Add, add, add_f64s);
operation!(Sub, sub, sub_f64s);
operation!(Mul, mul, mul_f64s);
operation!(Div, div, div_f64s);

impl<S: Simd> Neg for Packed<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self.with_lanes(self.simd.neg_f64s(self.lanes))
    }
}

impl<S: Simd> AddAssign for Packed<S> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<S: Simd> MulAssign for Packed<S> {
    #[inline(always)]
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl<S: Simd> Elementary for Packed<S> {
    #[inline(always)]
    fn power_of_two(self) -> Self {
        // In the unit of 2⁵² the digits of a number are those of a whole number.
        let digits = self.simd.transmute_u64s_f64s((self + (1023.0 + TWO_TO_52)).lanes);
        let shifted = self.simd.mul_u64s(digits, self.simd.splat_u64s(1 << 52));
        self.with_lanes(self.simd.transmute_f64s_u64s(shifted))
    }
}

/// 2⁵².
const TWO_TO_52: f64 = 4_503_599_627_370_496.0;

impl<S: Simd> Lanes for Packed<S> {
    #[inline(always)]
    fn constant(self, value: f64) -> Self {
        Self::splat(self.simd, value)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        self.with_lanes(self.simd.abs_f64s(self.lanes))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.with_lanes(self.simd.sqrt_f64s(self.lanes))
    }

    #[inline(always)]
    fn recip(self) -> Self {
        self.constant(1.0) / self
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
        let mask = self.simd.less_than_f64s(self.lanes, limit.lanes);
        self.with_lanes(self.simd.select_f64s(mask, then.lanes, otherwise.lanes))
    }

    #[inline(always)]
    fn any_less(self, limit: Self) -> bool {
        let mask = self.simd.less_than_f64s(self.lanes, limit.lanes);
        self.simd.first_true_m64s(mask) < Self::N
    }

    #[inline(always)]
    fn is_nothing(self) -> bool {
        !self.constant(0.0).any_less(self.abs())
    }

    #[inline(always)]
    fn apart<W: NullaryFnOnce>(self, work: W) -> W::Output {
        self.simd.vectorize(Apart(work))
    }
}

/// Work that does not need to be told for which registers it is compiled.
struct Apart<W>(W);

impl<W: NullaryFnOnce> WithSimd for Apart<W> {
    type Output = W::Output;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> W::Output {
        self.0.call()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Every operation, on a number and on a limit.
    #[inline(always)]
    fn all<T: Lanes>(x: T, limit: T) -> [T; 16] {
        let (sin, cos) = x.sin_cos();
        [
            x + limit,
            x - limit,
            x * limit,
            x / limit,
            x.abs().sqrt(),
            x.recip(),
            (-x.abs()).exp(),
            x.tanh(),
            x.atan_ratio(limit.abs() + 1.0),
            x.sign(),
            x.if_less(limit, x * 2.0, limit),
            x.clamped(-limit.abs(), limit.abs()),
            sin,
            cos,
            -x + 1.0,
            (x - 3.0) / 7.0,
        ]
    }

    struct Compared {
        x: [f64; MAX_LANES],
        limit: [f64; MAX_LANES],
    }

    impl WithSimd for Compared {
        type Output = Result<(), TestCaseError>;

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
            let (x, limit) = (Packed::new(simd, &self.x), Packed::new(simd, &self.limit));
            let got = all(x, limit).map(Packed::to_array);
            let mut any = false;
            for lane in 0..Packed::<S>::N {
                let (x, limit) = (self.x[lane], self.limit[lane]);
                any |= x < limit;
                for (i, (got, expected)) in got.iter().zip(all(x, limit)).enumerate() {
                    let same = got[lane].to_bits() == expected.to_bits()
                        || (got[lane].is_nan() && expected.is_nan());
                    prop_assert!(same, "{i} of {x}, {limit}: {} {expected}", got[lane]);
                }
            }
            prop_assert_eq!(x.any_less(limit), any);
            prop_assert!(!x.is_nothing() && (x * 0.0).is_nothing());
            Ok(())
        }
    }

    fn numbers() -> impl Strategy<Value = [f64; MAX_LANES]> {
        prop::array::uniform8(prop_oneof![-1e-3..1e-3, -5.0..5.0, -1e4..1e4])
    }

    proptest! {
        #[test]
        fn each_lane_is_the_number_by_itself_to_the_last_digit(x in numbers(), limit in numbers()) {
            pulp::Arch::new().dispatch(Compared { x, limit })?;
            #[cfg(target_arch = "x86_64")]
            if let Some(four) = pulp::x86::V3::try_new() {
                Simd::vectorize(four, Compared { x, limit })?;
            }
            Simd::vectorize(pulp::Scalar, Compared { x, limit })?;
        }
    }
}
