//! The numbers that the operations compute with, and the exponential function written so that the
//! compiler turns loops over it into vector instructions.

use candle_core::FloatDType;
use ndarray::LinalgScalar;

/// Independent accumulators of a sum, so that it can be taken with vector instructions.
const LANES: usize = 16;

/// `f32` or `f64`, with what the operations need.
pub(crate) trait NetworkNumber: FloatDType + LinalgScalar {
    const ZERO: Self;
    const ONE: Self;

    /// eˣ.
    fn exp(self) -> Self;

    /// 1/(1 + e⁻ˣ).
    #[inline(always)]
    fn sigmoid(self) -> Self {
        Self::ONE / (Self::ONE + (Self::ZERO - self).exp())
    }
}

impl NetworkNumber for f32 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;

    /// eˣ to 2 units in the last place, without branches.
    ///
    /// ```text
    /// x = n·ln 2 + r,  |r| ≤ ½ ln 2,  eˣ = 2ⁿ·(1 + r + r²·P(r))
    /// ```
    ///
    /// Below −87.3 and above 88.3 the value at that bound is returned; NaN stays NaN.
    /// Polynomial and split of ln 2: S. L. Moshier, Cephes Mathematical Library 2.2, `expf.c`.
    #[inline(always)]
    fn exp(self) -> Self {
        // 1.5·2²³: adding it rounds to an integer, which then stands in the lowest bits.
        const ROUND: f32 = 12_582_912.0;
        const LN_2_HIGH: f32 = 0.693_359_4;
        const LN_2_LOW: f32 = -2.121_944_4e-4;
        let x = self.clamp(-87.3, 88.3);
        let shifted = x * std::f32::consts::LOG2_E + ROUND;
        let n = shifted - ROUND;
        let r = (x - n * LN_2_HIGH) - n * LN_2_LOW;
        let p = 1.987_569_1e-4_f32;
        let p = p * r + 1.398_199_9e-3;
        let p = p * r + 8.333_452e-3;
        let p = p * r + 4.166_579_6e-2;
        let p = p * r + 1.666_666_5e-1;
        let p = p * r + 5e-1;
        let e = p * (r * r) + r + 1.0;
        e * f32::from_bits(shifted.to_bits().wrapping_add(127) << 23)
    }
}

impl NetworkNumber for f64 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;

    #[inline(always)]
    fn exp(self) -> Self {
        f64::exp(self)
    }
}

/// Runs `work` compiled for the widest vector instructions that this machine has. Loops in it are
/// `for` loops: `for_each` and `fold` may stay functions of their own, which are compiled without.
#[inline(always)]
pub(crate) fn vectorized<R>(work: impl FnOnce() -> R) -> R {
    pulp::Arch::new().dispatch(work)
}

/// Σ f(a, b) over two slices of one length, in an order that depends on the length alone.
#[inline(always)]
pub(crate) fn sum_of<T: NetworkNumber>(a: &[T], b: &[T], f: impl Fn(T, T) -> T) -> T {
    let mut lanes = [T::ZERO; LANES];
    let (a_chunks, b_chunks) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
    let (a_rest, b_rest) = (a_chunks.remainder(), b_chunks.remainder());
    for (a, b) in a_chunks.zip(b_chunks) {
        for ((lane, &a), &b) in lanes.iter_mut().zip(a).zip(b) {
            *lane += f(a, b);
        }
    }
    for ((lane, &a), &b) in lanes.iter_mut().zip(a_rest).zip(b_rest) {
        *lane += f(a, b);
    }
    let mut sum = T::ZERO;
    for lane in lanes {
        sum += lane;
    }
    sum
}

/// The largest of `scale`·x; of an empty slice 0.
#[inline(always)]
pub(crate) fn max_of<T: NetworkNumber>(values: &[T], scale: T) -> T {
    let first = values.first().map_or(T::ZERO, |&x| x * scale);
    let mut lanes = [first; LANES];
    let chunks = values.chunks_exact(LANES);
    let rest = chunks.remainder();
    let larger = |lane: T, x: T| if x > lane { x } else { lane };
    for chunk in chunks {
        for (lane, &x) in lanes.iter_mut().zip(chunk) {
            *lane = larger(*lane, x * scale);
        }
    }
    for (lane, &x) in lanes.iter_mut().zip(rest) {
        *lane = larger(*lane, x * scale);
    }
    let mut largest = first;
    for lane in lanes {
        largest = larger(largest, lane);
    }
    largest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fast_exponential_is_right_to_two_units_in_the_last_place() {
        for i in -870_000..=880_000 {
            let x = i as f32 * 1e-4;
            let (got, exact) = (NetworkNumber::exp(x), f64::exp(f64::from(x)));
            let relative = (f64::from(got) / exact - 1.0).abs();
            assert!(relative < 2.4e-7, "x = {x}: {got} instead of {exact}, off by {relative:e}");
        }
    }

    #[test]
    fn the_fast_exponential_keeps_its_limits() {
        assert_eq!(NetworkNumber::exp(0.0_f32), 1.0);
        assert!(NetworkNumber::exp(f32::NAN).is_nan());
        assert!(
            NetworkNumber::exp(-1e30_f32) < 2e-38 && NetworkNumber::exp(f32::NEG_INFINITY) >= 0.0
        );
        assert!(NetworkNumber::exp(f32::INFINITY).is_finite());
        assert_eq!(f32::INFINITY.sigmoid(), 1.0);
        assert!((-1e3_f32).sigmoid() < 1e-37);
    }

    #[test]
    fn sums_take_every_value_once() {
        for n in [0, 1, 15, 16, 17, 100] {
            let values: Vec<f64> = (0..n).map(f64::from).collect();
            let expected = f64::from(n) * f64::from(n - 1) / 2.0;
            assert_eq!(sum_of(&values, &values, |a, _| a), expected, "n = {n}");
        }
    }
}
