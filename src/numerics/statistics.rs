//! Summary statistics and quantiles of a sample.

use serde::{Deserialize, Serialize};
use statrs::statistics::{Data, Distribution, Max, Min, OrderStatistics};

/// Mean, standard deviation and order statistics of a sample, in the unit of its values.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
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
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
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

/// Quantile of values in increasing order, by linear interpolation between neighbouring values: the
/// probability 0 gives the smallest value, 1 the largest. A probability outside this range is
/// limited to it.
///
/// - returns `None` if there are no values.
///
/// ```
/// # use impactlab::numerics::quantile_of_sorted;
/// assert_eq!(quantile_of_sorted(&[1.0, 2.0, 4.0], 0.75), Some(3.0));
/// ```
pub fn quantile_of_sorted(values: &[f64], probability: f64) -> Option<f64> {
    let last = values.len().checked_sub(1)?;
    let position = probability.clamp(0.0, 1.0) * last as f64;
    let low = position.floor() as usize;
    let (&below, &above) = (values.get(low)?, values.get((low + 1).min(last))?);
    Some(below + position.fract() * (above - below))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_sample_by_hand() {
        let summary = Summary::of([1.0, 2.0, 3.0, 10.0]).unwrap();
        assert_eq!((summary.n, summary.mean, summary.median), (4, 4.0, 2.5));
        assert!((summary.std - (50.0_f64 / 3.0).sqrt()).abs() < 1e-12);
        assert_eq!(Summary::of([5.0]).unwrap().std, 0.0);
        assert_eq!(Summary::of([]), None);
        assert_eq!(Summary::of([1.0, f64::NAN]), None);
    }
}
