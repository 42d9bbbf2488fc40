//! How sure the outputs of a method by hand are: to first order and from its draws.

use std::cmp::Ordering;
use std::collections::BTreeMap;

use crate::hand::HandSensitivity;
use impactlab_core::numerics::quantile_of_sorted;
use impactlab_core::units::{Estimate, Interval};

/// Levels of the intervals.
const LEVELS: [f64; 3] = [0.5, 0.9, 0.95];
/// Rounding of a share.
const ROUNDING: f64 = 1e-9;

/// Standard deviation of an output to first order; `None` if an input moves it to where it is none. Inputs of
/// one rule are off together or independent, whichever moves it more.
pub(super) fn first_order(sensitivities: &[HandSensitivity], idx: usize) -> Option<f64> {
    let (mut squares, mut of_rules) = (0.0, BTreeMap::<&str, [f64; 2]>::new());
    for of in sensitivities.iter().filter(|of| !of.is_exact) {
        let change = of.changes.get(idx).copied().flatten()?;
        match of.rule {
            Some((rule, is_negative)) => {
                let [together, apart] = of_rules.entry(rule).or_default();
                *together += if is_negative { -change } else { change };
                *apart += change * change;
            }
            None => squares += change * change,
        }
    }
    squares +=
        of_rules.values().map(|[together, apart]| (together * together).max(*apart)).sum::<f64>();
    Some(squares.sqrt())
}

/// Median and intervals of an output over the draws; `None` if no draw has it. Draws that do not have it may lie
/// beyond either end: an interval leaves out fewer of the others by as many, and there is none of a level that
/// leaves out fewer than these.
fn estimate(drawn: &[Vec<f64>], idx: usize, draws: usize) -> Option<Estimate> {
    let values = drawn.iter().filter_map(|outputs| outputs.get(idx).copied());
    let mut values: Vec<f64> = values.filter(|value| value.is_finite()).collect();
    values.sort_by(f64::total_cmp);
    let left_out = 1.0 - values.len() as f64 / draws as f64;
    let has_ends = |level: &f64| (1.0 - level) / 2.0 > left_out - ROUNDING;
    let levels: Vec<f64> = LEVELS.into_iter().filter(has_ends).collect();
    let beyond = |share: f64| ((share - left_out) / (1.0 - left_out)).max(0.0);
    Estimate::from_quantiles(&levels, |probability| {
        let of_values = match probability.total_cmp(&0.5) {
            Ordering::Less => beyond(probability),
            Ordering::Equal => probability,
            Ordering::Greater => 1.0 - beyond(1.0 - probability),
        };
        quantile_of_sorted(&values, of_values)
    })
}

/// Of several sets of draws the estimate with the widest interval, of equal ones the first; `None` if none has
/// the output.
pub(super) fn widest(sets: &[&Vec<Vec<f64>>], idx: usize, draws: usize) -> Option<Estimate> {
    let width = |of: &Estimate| of.intervals.last().map_or(0.0, Interval::width);
    let estimates = sets.iter().filter_map(|set| estimate(set, idx, draws));
    estimates.reduce(|widest, of| if width(&of) > width(&widest) { of } else { widest })
}

/// Share of the draws of which something holds.
pub(super) fn share_of(drawn: &[Vec<f64>], holds: impl Fn(&[f64]) -> bool) -> f64 {
    drawn.iter().filter(|outputs| holds(outputs)).count() as f64 / drawn.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Draws that are left out are those of one end, and an interval of 95 % of the others held some 92 % of all.
    #[test]
    fn an_interval_holds_its_share_of_all_draws_wherever_those_lie_that_are_left_out() {
        let drawn = |n: u32| (0..n).map(|i| vec![f64::from(i)]).collect::<Vec<_>>();
        // Of 1000 draws 0 to 999 those above have no answer.
        for (n, levels) in [
            (1000, &[0.5, 0.9, 0.95][..]),
            (990, &[0.5, 0.9, 0.95]),
            (975, &[0.5, 0.9, 0.95]),
            (970, &[0.5, 0.9]),
            (950, &[0.5, 0.9]),
            (700, &[]),
        ] {
            let found = estimate(&drawn(n), 0, 1000).unwrap();
            let has: Vec<f64> = found.intervals.iter().map(|of| of.level).collect();
            assert_eq!(has, levels, "{n}");
            for of in &found.intervals {
                let beyond = 500.0 * (1.0 - of.level);
                let above = 999.0 - of.high;
                assert!((above - beyond).abs() < 1.0, "{n}: {of:?}, {above} above");
                assert!(of.low <= beyond, "{n}: {of:?}");
            }
            assert!((found.median - f64::from(n - 1) / 2.0).abs() < 1e-9, "{n}: {}", found.median);
        }
    }
}
