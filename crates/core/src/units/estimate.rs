//! A median with its central intervals: the one form in which the program says how sure a number is.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::numerics::quantile_of_sorted;

/// A central interval of a quantity: it leaves out as much below as above.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Interval {
    /// Probability that the interval holds the quantity, 0 to 1.
    pub level: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end of the interval.
    pub high: f64,
}

/// Median of a quantity with its central intervals, in SI units.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(into = "WrittenEstimate")]
pub struct Estimate {
    /// Median: the value that is exceeded with a probability of 50 %.
    pub median: f64,
    /// Intervals from the narrowest to the widest.
    pub intervals: Vec<Interval>,
}

/// An [`Estimate`] as it is written. Estimates with intervals of 50 % and 90 % alone, or of 90 % alone,
/// also have the keys of version 0.1, which a later version will not write.
#[derive(Serialize, JsonSchema)]
struct WrittenEstimate {
    /// Median: the value that is exceeded with a probability of 50 %.
    median: f64,
    /// Intervals from the narrowest to the widest.
    intervals: Vec<Interval>,
    /// Former key: ends of the interval that holds 50 %.
    #[serde(skip_serializing_if = "Option::is_none")]
    half: Option<[f64; 2]>,
    /// Former key: ends of the interval that holds 90 %.
    #[serde(skip_serializing_if = "Option::is_none")]
    ninety: Option<[f64; 2]>,
}

impl Interval {
    /// Lower and upper end.
    pub fn ends(&self) -> [f64; 2] {
        [self.low, self.high]
    }

    /// Distance between the ends.
    pub fn width(&self) -> f64 {
        self.high - self.low
    }
}

impl Estimate {
    /// A median with the intervals of 50 % and 90 %.
    pub fn new(median: f64, half: [f64; 2], ninety: [f64; 2]) -> Self {
        let interval = |level, [low, high]: [f64; 2]| Interval { level, low, high };
        Self { median, intervals: vec![interval(0.5, half), interval(0.9, ninety)] }
    }

    /// Median, 50 % and 90 % of draws; NaN without any.
    pub fn from_draws(mut draws: Vec<f64>) -> Self {
        draws.sort_by(f64::total_cmp);
        let at = |probability| quantile_of_sorted(&draws, probability).unwrap_or(f64::NAN);
        Self::new(at(0.5), [at(0.25), at(0.75)], [at(0.05), at(0.95)])
    }

    /// Median and intervals of a distribution; `None` if it has no quantiles.
    ///
    /// - `levels`: probabilities of the intervals, ascending;
    /// - `quantile`: the value below which the quantity lies with a probability.
    pub fn from_quantiles(levels: &[f64], quantile: impl Fn(f64) -> Option<f64>) -> Option<Self> {
        let interval = |&level: &f64| {
            let (low, high) = (quantile((1.0 - level) / 2.0)?, quantile((1.0 + level) / 2.0)?);
            Some(Interval { level, low, high })
        };
        let intervals = levels.iter().map(interval).collect::<Option<_>>()?;
        Some(Self { median: quantile(0.5)?, intervals })
    }

    /// Ends of the interval at a level; `None` if there is no interval at this level.
    pub fn interval(&self, level: f64) -> Option<[f64; 2]> {
        self.intervals.iter().find(|interval| interval.level == level).map(Interval::ends)
    }

    /// Ends of the interval that holds 50 %; not numbers if there is none, so that nothing looks certain
    /// of which no interval is known.
    pub fn half(&self) -> [f64; 2] {
        self.interval(0.5).unwrap_or([f64::NAN; 2])
    }

    /// Ends of the interval that holds 90 %; not numbers if there is none.
    pub fn ninety(&self) -> [f64; 2] {
        self.interval(0.9).unwrap_or([f64::NAN; 2])
    }

    /// Whether something is known of how sure it is. Draws that are all alike, such as a single one, leave
    /// intervals without width, which tell nothing.
    pub fn has_interval(&self) -> bool {
        self.intervals.iter().any(|interval| interval.width() > 0.0)
    }

    /// The median alone.
    #[must_use]
    pub fn without_intervals(&self) -> Self {
        Self { median: self.median, intervals: Vec::new() }
    }

    /// The same estimate in another unit.
    ///
    /// - `factor`: positive; median and ends are multiplied by it.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        self.mapped(|value| value * factor)
    }

    /// Applies an increasing function to the median and the ends.
    #[must_use]
    pub fn mapped(&self, map: impl Fn(f64) -> f64) -> Self {
        let mapped = |Interval { level, low, high }: &Interval| Interval {
            level: *level,
            low: map(*low),
            high: map(*high),
        };
        Self { median: map(self.median), intervals: self.intervals.iter().map(mapped).collect() }
    }
}

impl From<Estimate> for WrittenEstimate {
    fn from(estimate: Estimate) -> Self {
        let had_former_keys =
            estimate.intervals.iter().all(|interval| [0.5, 0.9].contains(&interval.level));
        let former = |level| estimate.interval(level).filter(|_| had_former_keys);
        let (half, ninety) = (former(0.5), former(0.9));
        Self { median: estimate.median, intervals: estimate.intervals, half, ninety }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interval_that_is_not_known_is_not_narrow() {
        let estimate = Estimate { median: 3.0, intervals: Vec::new() };
        assert!(estimate.ninety().iter().chain(&estimate.half()).all(|end| end.is_nan()));
    }

    #[test]
    fn every_interval_is_spelt_alike_and_former_keys_are_still_written() {
        let spread = Estimate::new(3.0, [2.5, 3.5], [1.0, 5.0]);
        let written = serde_json::to_value(&spread).unwrap();
        assert_eq!(written["intervals"][1]["level"], 0.9);
        assert_eq!(written["intervals"][1]["low"], written["ninety"][0]);
        assert_eq!(written["intervals"][0]["high"], written["half"][1]);
        let wide = Estimate::from_quantiles(&[0.5, 0.9, 0.95], Some).unwrap();
        let written = serde_json::to_value(&wide).unwrap();
        assert_eq!(written["intervals"][2]["level"], 0.95);
        assert_eq!(written.get("ninety"), None);
    }

    #[test]
    fn an_estimate_in_another_unit_keeps_its_levels() {
        let degrees = Estimate::new(1.0, [0.9, 1.1], [0.5, 1.5]).scaled(57.0);
        assert_eq!((degrees.median, degrees.ninety()), (57.0, [28.5, 85.5]));
        assert_eq!(degrees.interval(0.8), None);
    }
}
