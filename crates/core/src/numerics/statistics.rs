//! Summary statistics and quantiles of a sample.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use statrs::statistics::{Data, Distribution, Max, Min, OrderStatistics};

/// Mean, standard deviation and order statistics of a sample, in the unit of its values.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Summary {
    /// Number of values.
    pub n: usize,
    /// Arithmetic mean.
    pub mean: f64,
    /// Standard deviation with the divisor n − 1; 0 for a single value.
    pub std: f64,
    /// Median.
    pub median: f64,
    /// 90th percentile.
    pub p90: f64,
    /// Smallest value.
    pub min: f64,
    /// Largest value.
    pub max: f64,
}

impl Summary {
    /// Computes the statistics of a sample; `None` if it is empty or contains NaN.
    pub fn from_values(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let values: Vec<f64> = values.into_iter().collect();
        if values.is_empty() || values.iter().any(|value| value.is_nan()) {
            return None;
        }
        let n = values.len();
        let mut data = Data::new(values);
        Some(Self {
            n,
            mean: data.mean()?,
            std: if n > 1 { data.std_dev()? } else { 0.0 },
            median: data.median(),
            p90: data.percentile(90),
            min: data.min(),
            max: data.max(),
        })
    }
}

/// Standard errors of estimates, by leaving out each of several groups of the sample in turn:
///
/// ```text
/// s² = (g − 1)/g Σ_j (θ_j − mean of θ)²
/// ```
///
/// - `n_groups`: g, 2 or more; with fewer the errors are zero;
/// - `without`: the estimates θ_j without the group of a number from 0 on.
pub fn jackknife_errors<const N: usize>(
    n_groups: usize,
    without: impl Fn(usize) -> [f64; N],
) -> [f64; N] {
    let estimates: Vec<[f64; N]> = (0..n_groups).map(without).collect();
    let n = n_groups.max(1) as f64;
    std::array::from_fn(|idx| {
        let values = || estimates.iter().map(|estimate| estimate[idx]);
        let mean = values().sum::<f64>() / n;
        let squares: f64 = values().map(|value| (value - mean).powi(2)).sum();
        ((n - 1.0) / n * squares).sqrt()
    })
}

/// Standard error of the share of a sample, of which two more hits and two more misses are taken into
/// account, so that it is not nothing where all or none are hits:
///
/// ```text
/// p̃ = (n p + 2) / (n + 4)      σ = √(p̃ (1 − p̃) / (n + 4))
/// ```
///
/// Source: Agresti and Coull, The American Statistician 52 (1998), 119 to 126. Where all of n are hits,
/// two of these are about 3/n, the largest share of misses that such a sample leaves possible.
///
/// - `share`: 0 to 1;
/// - `n`: effective size of the sample, 0 or more.
///
/// ```
/// # use impactlab_core::numerics::share_standard_error;
/// assert!((share_standard_error(1.0, 100.0) - 0.0135).abs() < 1e-4);
/// assert!((share_standard_error(0.3, 1e6) - (0.3_f64 * 0.7 / 1e6).sqrt()).abs() < 1e-8);
/// ```
pub fn share_standard_error(share: f64, n: f64) -> f64 {
    let n_more = n + 4.0;
    let share_more = (n * share + 2.0) / n_more;
    (share_more * (1.0 - share_more) / n_more).sqrt()
}

/// Bounds of 95 % confidence of a share of which `hits` of `n` were counted.
///
/// ```text
/// (p̂ + z²/2n ± z √(p̂ (1 − p̂)/n + z²/4n²)) / (1 + z²/n),   z = 1.96
/// ```
///
/// Source: Wilson, Journal of the American Statistical Association 22 (1927), 209 to 212.
///
/// - returns [0, 1] without a count.
///
/// ```
/// # use impactlab_core::numerics::wilson_interval;
/// let [from, to] = wilson_interval(19, 25);
/// assert!((from - 0.566).abs() < 1e-3 && (to - 0.885).abs() < 1e-3);
/// let [from, to] = wilson_interval(25, 25);
/// assert!((from - 0.867).abs() < 1e-3 && to == 1.0);
/// ```
pub fn wilson_interval(hits: usize, n: usize) -> [f64; 2] {
    if n == 0 {
        return [0.0, 1.0];
    }
    let (z2, n, share) = (1.959_963_985_f64.powi(2), n as f64, hits as f64 / n as f64);
    let centre = share + z2 / (2.0 * n);
    let half = (z2 * share * (1.0 - share) / n + (z2 / (2.0 * n)).powi(2)).sqrt();
    [centre - half, centre + half].map(|end| (end / (1.0 + z2 / n)).clamp(0.0, 1.0))
}

/// Quantile of values in increasing order, by linear interpolation between neighbouring values: the
/// probability 0 gives the smallest value, 1 the largest. A probability outside this range is
/// limited to it.
///
/// - returns `None` if there are no values.
///
/// ```
/// # use impactlab_core::numerics::quantile_of_sorted;
/// assert_eq!(quantile_of_sorted(&[1.0, 2.0, 4.0], 0.75), Some(3.0));
/// ```
pub fn quantile_of_sorted(values: &[f64], probability: f64) -> Option<f64> {
    let last = values.len().checked_sub(1)?;
    let position = probability.clamp(0.0, 1.0) * last as f64;
    let low = position.floor() as usize;
    let (&below, &above) = (values.get(low)?, values.get((low + 1).min(last))?);
    Some(below + position.fract() * (above - below))
}

/// Median of values in any order: the mean of the two in the middle where their number is even.
///
/// - returns `None` if there are no values.
///
/// ```
/// # use impactlab_core::numerics::median;
/// assert_eq!(median([9.0, 1.0, 2.0]), Some(2.0));
/// assert_eq!(median([9.0, 1.0, 2.0, 4.0]), Some(3.0));
/// ```
pub fn median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.into_iter().collect();
    values.sort_by(f64::total_cmp);
    quantile_of_sorted(&values, 0.5)
}

/// Standard error of [`quantile_of_sorted`] for independent values: half the distance between the
/// quantiles at p ± √(p (1 − p)/n), by how many of n values lie below the true quantile.
///
/// - returns `None` if there are no values.
pub fn quantile_error_of_sorted(values: &[f64], probability: f64) -> Option<f64> {
    let share_error = (probability * (1.0 - probability) / values.len().max(1) as f64).sqrt();
    let at = |probability: f64| quantile_of_sorted(values, probability);
    Some((at(probability + share_error)? - at(probability - share_error)?) / 2.0)
}

/// Quantile of weighted values in increasing order, by linear interpolation. With equal weights it is
/// that of [`quantile_of_sorted`]; a value without weight changes nothing.
///
/// ```text
/// value k stands at (w_1/2 + w_2 + … + w_(k−1) + w_k/2) − w_1/2, the last one at probability 1
/// ```
///
/// - returns `None` if no value has a weight.
///
/// ```
/// # use impactlab_core::numerics::quantile_of_weighted;
/// assert_eq!(quantile_of_weighted(&[1.0, 2.0, 4.0], &[1.0, 1.0, 1.0], 0.75), Some(3.0));
/// assert_eq!(quantile_of_weighted(&[1.0, 2.0, 4.0], &[1.0, 0.0, 1.0], 0.5), Some(2.5));
/// ```
pub fn quantile_of_weighted(values: &[f64], weights: &[f64], probability: f64) -> Option<f64> {
    let weighted = || values.iter().zip(weights).filter(|(_, weight)| **weight > 0.0);
    let (first, last) = (weighted().next()?, weighted().next_back()?);
    let total: f64 = weighted().map(|(_, weight)| weight).sum::<f64>() - (first.1 + last.1) / 2.0;
    let goal = probability.clamp(0.0, 1.0) * total;
    let (mut position, mut before) = (0.0, first);
    for value in weighted().skip(1) {
        let step = (before.1 + value.1) / 2.0;
        if position + step >= goal {
            return Some(before.0 + (goal - position) / step * (value.0 - before.0));
        }
        position += step;
        before = value;
    }
    Some(*last.0)
}

/// The place in a list of weights that a share of their sum falls upon: the first whose sum up to and with it is
/// larger. One without a weight is never taken.
///
/// - `weights`: 0 or more each;
/// - `share`: 0 to their sum. One that rounding leaves beyond it falls upon the last that has a weight.
/// - returns 0 if none has a weight.
///
/// ```
/// # use impactlab_core::numerics::index_of_share;
/// assert_eq!([0.0, 0.2, 0.9].map(|share| index_of_share([0.2, 0.0, 0.8], share)), [0, 2, 2]);
/// ```
pub fn index_of_share(weights: impl IntoIterator<Item = f64>, share: f64) -> usize {
    let (mut sum, mut last) = (0.0, 0);
    for (idx, weight) in weights.into_iter().enumerate() {
        sum += weight;
        if weight > 0.0 {
            last = idx;
        }
        if share < sum {
            break;
        }
    }
    last
}

/// Natural logarithm of `Σ exp(v)`, whose terms may be too small or too large for a number by themselves; −∞ if
/// every value is, or without any.
///
/// ```
/// # use impactlab_core::numerics::ln_sum_exp;
/// assert!((ln_sum_exp(&[-2000.0, -2000.0]) - (2.0_f64.ln() - 2000.0)).abs() < 1e-9);
/// assert_eq!(ln_sum_exp(&[f64::NEG_INFINITY; 2]), f64::NEG_INFINITY);
/// ```
pub fn ln_sum_exp(values: &[f64]) -> f64 {
    let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if largest == f64::NEG_INFINITY {
        return largest;
    }
    largest + values.iter().map(|value| (value - largest).exp()).sum::<f64>().ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A share that rounding left beyond the sum fell upon the last of all, though nothing lay there.
    #[test]
    fn a_share_falls_upon_places_by_their_weights_and_never_upon_one_without() {
        let weights = [0.0, 1.0, 0.0, 3.0, 0.0];
        for (share, expected) in [(0.0, 1), (0.99, 1), (1.0, 3), (3.99, 3), (4.0, 3), (9.0, 3)] {
            assert_eq!(index_of_share(weights, share), expected, "{share}");
        }
        assert_eq!(index_of_share([], 0.5), 0);
        let tenths = [0.1; 10];
        let sum: f64 = tenths.iter().sum();
        let below = 1.0 - f64::EPSILON / 2.0;
        assert!(below >= sum, "{sum}");
        assert_eq!(index_of_share(tenths.into_iter().chain([0.0]), below), 9);
    }

    #[test]
    fn equal_weights_give_the_quantiles_of_the_values_and_a_weight_of_two_counts_twice() {
        let values: Vec<f64> = (0..31).map(|i| f64::from(i * i)).collect();
        for probability in [-1.0, 0.0, 0.05, 0.33, 0.5, 0.95, 1.0, 2.0] {
            let expected = quantile_of_sorted(&values, probability).unwrap();
            let found = quantile_of_weighted(&values, &[0.3; 31], probability).unwrap();
            assert!((found - expected).abs() < 1e-9, "{probability}: {found} for {expected}");
        }
        assert_eq!(quantile_of_weighted(&[1.0, 5.0], &[0.0, 2.0], 0.1), Some(5.0));
        assert_eq!(quantile_of_weighted(&[1.0, 5.0], &[0.0, 0.0], 0.1), None);
        let twice = quantile_of_weighted(&[0.0, 1.0, 2.0], &[1.0, 2.0, 1.0], 0.5).unwrap();
        assert!((twice - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_error_of_a_quantile_is_that_of_the_share_below_it() {
        // Uniform between 0 and 1: the error of a quantile is that of the share.
        let values: Vec<f64> = (0..=400).map(|i| f64::from(i) / 400.0).collect();
        for (probability, expected) in [(0.5, 0.025), (0.05, 0.0109)] {
            let error = quantile_error_of_sorted(&values, probability).unwrap();
            assert!((error - expected).abs() < 1e-4, "{probability}: {error}");
        }
        assert_eq!(quantile_error_of_sorted(&[], 0.5), None);
    }

    #[test]
    fn the_jackknife_of_a_mean_is_its_standard_error() {
        let values = [1.0, 4.0, 2.0, 9.0, 5.0];
        let mean = |left_out: usize| {
            let others = values.iter().enumerate().filter(|(idx, _)| *idx != left_out);
            [others.map(|(_, value)| value).sum::<f64>() / 4.0]
        };
        let [error] = jackknife_errors(5, mean);
        let summary = Summary::from_values(values).unwrap();
        assert!((error - summary.std / 5.0_f64.sqrt()).abs() < 1e-12, "{error}");
        assert_eq!(jackknife_errors(1, |_| [3.0]), [0.0]);
    }

    #[test]
    fn a_small_sample_by_hand() {
        let summary = Summary::from_values([1.0, 2.0, 3.0, 10.0]).unwrap();
        assert_eq!((summary.n, summary.mean, summary.median), (4, 4.0, 2.5));
        assert!((summary.std - (50.0_f64 / 3.0).sqrt()).abs() < 1e-12);
        assert_eq!(Summary::from_values([5.0]).unwrap().std, 0.0);
        assert_eq!(Summary::from_values([]), None);
        assert_eq!(Summary::from_values([1.0, f64::NAN]), None);
    }
}
