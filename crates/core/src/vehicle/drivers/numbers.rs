//! The numbers of drivers and systems: their names with their ranges, and their distributions.

use crate::data::key_with_unit;
use crate::numerics::normal_cdf;
use crate::ranges::Range;
use crate::units::Phrase;

/// A number: its name without the unit, its place, `None` where nobody states it, and its range.
pub(in crate::vehicle) type Number<'a> = (&'static str, &'a mut Option<f64>, Range);

/// Those numbers that are stated, with their whole names, such as `rise_s`, and their ranges.
pub(super) fn named<const N: usize>(numbers: [Number<'_>; N]) -> Vec<(String, f64, Range)> {
    let named = |(base, value, range): Number<'_>| {
        let name = key_with_unit(base, &range.quantity.si_unit());
        value.map(|value| (name, value, range))
    };
    numbers.into_iter().filter_map(named).collect()
}

/// The distributions in words of those numbers that are not stated.
///
/// - `numbers`: whether each is stated, and how it is drawn if not, in English and in German.
pub(super) fn drawn_words<const N: usize>(numbers: [(bool, [&'static str; 2]); N]) -> Vec<Phrase> {
    let open = numbers.into_iter().filter(|(is_stated, _)| !is_stated);
    open.map(|(_, [en, de])| Phrase::new(en, de)).collect()
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
