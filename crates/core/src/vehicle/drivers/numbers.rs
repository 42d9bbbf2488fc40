//! The numbers of drivers and systems: their names with their ranges, and their distributions.

use crate::data::key_with_unit;
use crate::numerics::normal_cdf;
use crate::ranges::Range;

/// A number: its name without the unit, its place and its range.
pub(in crate::vehicle) type Number<'a> = (&'static str, &'a mut f64, Range);

/// Numbers with their whole names, such as `rise_s`, and their ranges.
pub(super) fn named<const N: usize>(numbers: [Number<'_>; N]) -> Vec<(String, f64, Range)> {
    let named = |(base, value, range): Number<'_>| {
        (key_with_unit(base, &range.quantity.si_unit()), *value, range)
    };
    numbers.into_iter().map(named).collect()
}

/// Puts those numbers that stand at what nobody said in the place of those of a draw: what somebody said is
/// known. Signs do not count.
///
/// - `known`: as they were said; `usual`: where nobody says them; `drawn`: gets those that were said.
pub(super) fn keep_said<const N: usize>(
    known: [Number<'_>; N],
    usual: [Number<'_>; N],
    drawn: [Number<'_>; N],
) {
    for (((_, known, _), (_, usual, _)), (_, drawn, _)) in known.into_iter().zip(usual).zip(drawn) {
        if known.abs() != usual.abs() {
            *drawn = *known;
        }
    }
}

/// A number that is uniform between two limits, from a standard normal variable.
pub(super) fn uniform(z: f64, [low, high]: [f64; 2]) -> f64 {
    low + (high - low) * normal_cdf(z)
}

/// A number whose logarithm is normal, from a standard normal variable.
///
/// - `sigma`: standard deviation of the logarithm.
pub(super) fn lognormal(z: f64, median: f64, sigma: f64) -> f64 {
    median * (sigma * z).exp()
}
