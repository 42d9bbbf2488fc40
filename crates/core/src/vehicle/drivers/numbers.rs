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
