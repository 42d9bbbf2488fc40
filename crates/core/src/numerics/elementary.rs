//! Elementary functions by the four operations alone, so that a number gives the same result to the
//! last bit by itself and in a vector register of any width.
//!
//! Arguments are reduced and then approximated by polynomials. The errors are below 1e-15 of the
//! result; the library functions of the platform, which they replace, differ by as much from each
//! other.
//!
//! Sources of the coefficients: arc tangent, sine and cosine: FDLIBM 5.3, Sun Microsystems 1993;
//! hyperbolic tangent: Cephes Mathematical Library 2.8, S. L. Moshier 2000; exponential function: its
//! Taylor series.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_2, FRAC_PI_4, LOG2_E};

use crate::numerics::Lanes;

/// What the functions below need of a type besides its arithmetic.
pub(super) trait Elementary: Lanes {
    /// 2ⁿ.
    ///
    /// - `self`: n, a whole number from −1022 to 1023.
    fn power_of_two(self) -> Self;
}

/// Added to a number and taken away again, it leaves the nearest whole number: 1.5 · 2⁵².
const ROUNDING: f64 = 6_755_399_441_055_744.0;

/// ln 2 in two parts, of which the first has few digits.
const LN_2: [f64; 2] = [6.931_457_519_531_25e-1, 1.428_606_820_309_417_2e-6];

/// π/2 in three parts, of which the first two have 33 binary digits.
const HALF_PI: [f64; 3] =
    [1.570_796_326_734_125_6, 6.077_100_506_303_966e-11, 2.022_266_248_795_950_6e-21];

/// 1/k! from k = 0 to 13.
const EXP: [f64; 14] = [
    1.0,
    1.0,
    0.5,
    1.0 / 6.0,
    1.0 / 24.0,
    1.0 / 120.0,
    1.0 / 720.0,
    1.0 / 5_040.0,
    1.0 / 40_320.0,
    1.0 / 362_880.0,
    1.0 / 3_628_800.0,
    1.0 / 39_916_800.0,
    1.0 / 479_001_600.0,
    1.0 / 6_227_020_800.0,
];

/// `(1 − atan(z)/z)/z²` in powers of z⁴: the even and the odd powers of z², lowest first.
const ATAN_EVEN: [f64; 6] = [
    3.333_333_333_333_293e-1,
    1.428_571_427_250_346_6e-1,
    9.090_887_133_436_507e-2,
    6.661_073_137_387_531e-2,
    4.976_877_994_615_932e-2,
    1.628_582_011_536_578_2e-2,
];
const ATAN_ODD: [f64; 5] = [
    -1.999_999_999_987_648_3e-1,
    -1.111_111_040_546_235_6e-1,
    -7.691_876_205_044_83e-2,
    -5.833_570_133_790_573_5e-2,
    -3.653_157_274_421_691_6e-2,
];
/// tan(π/8) and tan(3π/8), between which the arc tangent is taken about π/4.
const ATAN_BOUNDS: [f64; 2] = [0.414_213_562_373_095_03, 2.414_213_562_373_095];

/// `(sin z − z)/z³` and `(cos z − 1 + z²/2)/z⁴` in powers of z², lowest first.
const SIN: [f64; 6] = [
    -1.666_666_666_666_663_2e-1,
    8.333_333_333_322_49e-3,
    -1.984_126_982_985_795e-4,
    2.755_731_370_707_006_8e-6,
    -2.505_076_025_340_686_3e-8,
    1.589_690_995_211_55e-10,
];
const COS: [f64; 6] = [
    4.166_666_666_666_66e-2,
    -1.388_888_888_887_411e-3,
    2.480_158_728_947_673e-5,
    -2.755_731_435_139_066_3e-7,
    2.087_572_321_298_175e-9,
    -1.135_964_755_778_819_5e-11,
];

/// Numerator and denominator of `(tanh(x)/x − 1)/x²` in powers of x², lowest first.
const TANH_ABOVE: [f64; 3] =
    [-1.614_687_684_417_084_5e3, -9.928_772_310_019_185e1, -9.643_991_794_250_523e-1];
const TANH_BELOW: [f64; 4] =
    [4.844_063_053_251_255e3, 2.235_488_390_601_004_5e3, 1.128_116_784_916_329_3e2, 1.0];
/// Size of the argument from which the hyperbolic tangent is taken by the exponential function.
const TANH_BOUND: f64 = 0.625;

/// The polynomial with these coefficients, lowest first. They are joined in pairs, so that half as many
/// operations wait for each other.
#[inline(always)]
fn polynomial<T: Lanes, const N: usize>(x: T, coefficients: [f64; N]) -> T {
    let square = x * x;
    let mut sum: Option<T> = None;
    for pair in coefficients.chunks(2).rev() {
        let pair = match *pair {
            [low, high] => x * high + low,
            [low, ..] => x.constant(low),
            [] => x.constant(0.0),
        };
        sum = Some(match sum {
            Some(sum) => sum * square + pair,
            None => pair,
        });
    }
    sum.unwrap_or(x)
}

#[inline(always)]
fn rounded<T: Lanes>(x: T) -> T {
    (x + ROUNDING) - ROUNDING
}

/// eˣ for −700 ≤ x ≤ 700; beyond, the value at the nearer end.
#[inline(always)]
pub(super) fn exp<T: Elementary>(x: T) -> T {
    let x = x.clamped(x.constant(-700.0), x.constant(700.0));
    let n = rounded(x * LOG2_E);
    let rest = x - n * LN_2[0] - n * LN_2[1];
    polynomial(rest, EXP) * n.power_of_two()
}

/// Hyperbolic tangent.
#[inline(always)]
pub(super) fn tanh<T: Elementary>(x: T) -> T {
    let square = x * x;
    let near = x + x * square * polynomial(square, TANH_ABOVE) / polynomial(square, TANH_BELOW);
    let size = x.abs();
    // tanh is 1 to the last digit from 20 on.
    let end = x.constant(20.0);
    let beyond = -(x.constant(2.0) / (exp(size.if_less(end, size, end) * 2.0) + 1.0) - 1.0);
    let far = x.if_less(x.constant(0.0), -beyond, beyond);
    size.if_less(x.constant(TANH_BOUND), near, far)
}

/// Arc tangent of y/x for x above 0, rad: without the division, where it is not needed.
#[inline(always)]
pub(super) fn atan_ratio<T: Lanes>(y: T, x: T) -> T {
    let size = y.abs();
    let [low, high] = [x * ATAN_BOUNDS[0], x * ATAN_BOUNDS[1]];
    let above = high.if_less(size, -x, low.if_less(size, size - x, size));
    let below = high.if_less(size, size, low.if_less(size, size + x, x));
    let base = low.if_less(size, x.constant(FRAC_PI_4), x.constant(0.0));
    let base = high.if_less(size, x.constant(FRAC_PI_2), base);
    let z = above / below;
    let square = z * z;
    let fourth = square * square;
    let even = square * polynomial(fourth, ATAN_EVEN);
    let odd = fourth * polynomial(fourth, ATAN_ODD);
    let angle = base + (z - z * (even + odd));
    y.if_less(x.constant(0.0), -angle, angle)
}

/// Sine and cosine of an angle of up to a hundred thousand turns, rad.
#[inline(always)]
pub(super) fn sin_cos<T: Lanes>(x: T) -> (T, T) {
    let n = rounded(x * FRAC_2_PI);
    let rest = x - n * HALF_PI[0] - n * HALF_PI[1] - n * HALF_PI[2];
    let square = rest * rest;
    let sin = rest + rest * square * polynomial(square, SIN);
    let cos = (square * -0.5 + 1.0) + square * square * polynomial(square, COS);
    // The quadrant, 0 to 3.
    let quadrant = n - rounded(n * 0.25 - 0.375) * 4.0;
    let half = x.constant(0.5);
    let from_two = (quadrant - 2.0).abs();
    let from_odd = (from_two - 1.0).abs();
    let (sin, cos) = (from_odd.if_less(half, cos, sin), from_odd.if_less(half, sin, cos));
    let sin = quadrant.if_less(x.constant(1.5), sin, -sin);
    let cos = (quadrant - 1.5).abs().if_less(x.constant(1.0), -cos, cos);
    (sin, cos)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn they_are_the_functions_of_the_library(
            x in prop_oneof![-1e-3..1e-3_f64, -5.0..5.0, -300.0..300.0], y in 1e-3..1e3_f64) {
            let x: f64 = x;
            let (sin, cos) = sin_cos(x);
            let near = x.clamp(-30.0, 30.0);
            for (name, got, expected) in [
                ("exp", exp(x), x.exp()),
                ("tanh", tanh(near), near.tanh()),
                ("atan", atan_ratio(x, y), x.atan2(y)),
            ] {
                let off = (got - expected).abs() / expected.abs().max(1e-300);
                prop_assert!(off < 1e-15, "{name} {x}: {got} {expected}");
            }
            for (got, expected) in [(sin, x.sin()), (cos, x.cos())] {
                prop_assert!((got - expected).abs() < 3e-16, "{x}: {got} {expected}");
            }
        }
    }

    #[test]
    fn ends_and_middles() {
        for x in [0.0, -0.0, 25.0, -25.0, 700.0_f64] {
            let expected: f64 = if x == 0.0 { x } else { x.signum() };
            assert_eq!(tanh(x), expected, "{x}");
            assert_eq!(atan_ratio(x * 1e300, 1.0), expected * FRAC_PI_2, "{x}");
        }
        assert!((exp(-1e9) / 1e-304 - 0.986).abs() < 1e-3 && exp(0.0) == 1.0);
        assert!(exp(f64::NAN).is_nan() && atan_ratio(f64::NAN, 1.0).is_nan());
    }
}
