//! Metrics over several cases.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::force::metrics::{
    BAND_LEVELS, CaseCoverage, N_PIT_BINS, PointErrors, ProbabilisticScores,
};
use impactlab_core::numerics::Summary;

/// Statistics of [`PointErrors`] over several cases, all of the same weight.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CurveMetrics {
    /// Number of cases.
    pub n_cases: usize,
    /// Root mean square error over the peak.
    pub rmse_over_peak: Summary,
    /// Root mean square error of F_x, N.
    pub rmse_x_n: Summary,
    /// Root mean square error of F_y, N.
    pub rmse_y_n: Summary,
    /// Error of the history, both axes.
    pub history_error: Summary,
    /// Error of the history of F_x, over the cases that have a force along x.
    pub history_error_x: Option<Summary>,
    /// Error of the history of F_y, over the cases that have a force along y.
    pub history_error_y: Option<Summary>,
    /// Error of the impulse vector.
    pub impulse_error: Summary,
    /// Error of the peak.
    pub peak_error: Summary,
    /// Error of the duration.
    pub duration_error: Summary,
    /// Metrics of the predicted distributions; `None` for a model without distributions.
    #[serde(flatten)]
    pub probabilistic: Option<DistributionMetrics>,
}

/// How often the intervals of one level contain the observed values.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct IntervalCoverage {
    /// Nominal share.
    pub level: f64,
    /// Observed share: the mean over the cases of the share of each case.
    pub share: f64,
    /// Standard error of `share`: the standard deviation between cases over the root of their number,
    /// since the instants of one case are not independent.
    pub standard_error: f64,
    /// Mean width, in the unit of the quantity.
    pub mean_width: f64,
}

/// Statistics of [`ProbabilisticScores`] over several cases.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DistributionMetrics {
    /// Observed shares of F_x(t) and F_y(t) by nominal level in percent.
    pub coverage: BTreeMap<String, f64>,
    /// Bands of F_x(t) and F_y(t), N.
    pub force_n: [IntervalCoverage; 4],
    /// Intervals of `|P|`, N s.
    pub impulse_n_s: [IntervalCoverage; 4],
    /// Intervals of the largest `|F|`, N.
    pub peak_n: [IntervalCoverage; 4],
    /// Intervals of the duration, s.
    pub duration_s: [IntervalCoverage; 4],
    /// Continuous ranked probability score of F(t), N.
    pub crps_force_n: Summary,
    /// The same of `|P|`, N s.
    pub crps_impulse_n_s: Summary,
    /// The same of the peak, N.
    pub crps_peak_n: Summary,
    /// The same of the duration, s.
    pub crps_duration_s: Summary,
    /// Energy score of whole curves, N.
    pub energy_score_n: Summary,
    /// Negative log likelihood of a whole curve, nats.
    pub nll_nats: Summary,
    /// Probability integral transform of F(t): counts in equal bins.
    pub pit_force: [u32; N_PIT_BINS],
    /// The same of P_x and P_y.
    pub pit_impulse: [u32; N_PIT_BINS],
}

impl CurveMetrics {
    /// Statistics over cases; `None` without any case.
    ///
    /// - `scores`: of the same cases, or empty.
    pub fn new(errors: &[&PointErrors], scores: &[&ProbabilisticScores]) -> Option<Self> {
        let summary = |metric: fn(&PointErrors) -> f64| {
            Summary::from_values(errors.iter().map(|e| metric(e)))
        };
        let known = |metric: fn(&PointErrors) -> Option<f64>| {
            Summary::from_values(errors.iter().filter_map(|e| metric(e)))
        };
        Some(Self {
            n_cases: errors.len(),
            rmse_over_peak: summary(|e| e.rmse_over_peak)?,
            rmse_x_n: summary(|e| e.rmse_x_n)?,
            rmse_y_n: summary(|e| e.rmse_y_n)?,
            history_error: summary(|e| e.history_error)?,
            history_error_x: known(|e| e.history_error_x),
            history_error_y: known(|e| e.history_error_y),
            impulse_error: summary(|e| e.impulse_error)?,
            peak_error: summary(|e| e.peak_error)?,
            duration_error: summary(|e| e.duration_error)?,
            probabilistic: DistributionMetrics::from_scores(scores),
        })
    }
}

impl DistributionMetrics {
    /// Statistics over cases; `None` without any case.
    pub fn from_scores(scores: &[&ProbabilisticScores]) -> Option<Self> {
        let summary = |metric: fn(&ProbabilisticScores) -> f64| {
            Summary::from_values(scores.iter().map(|s| metric(s)))
        };
        let covered = |metric: fn(&ProbabilisticScores) -> &CaseCoverage| {
            IntervalCoverage::from_cases(&scores.iter().map(|s| metric(s)).collect::<Vec<_>>())
        };
        let pit = |metric: fn(&ProbabilisticScores) -> &[u32; N_PIT_BINS]| {
            scores.iter().fold([0; N_PIT_BINS], |mut sum, score| {
                sum.iter_mut().zip(metric(score)).for_each(|(sum, count)| *sum += count);
                sum
            })
        };
        let force_n = covered(|s| &s.force_n)?;
        let by_percent = |c: &IntervalCoverage| (format!("{:.0}", c.level * 100.0), c.share);
        Some(Self {
            coverage: force_n.iter().map(by_percent).collect(),
            force_n,
            impulse_n_s: covered(|s| &s.impulse_n_s)?,
            peak_n: covered(|s| &s.peak_n)?,
            duration_s: covered(|s| &s.duration_s)?,
            crps_force_n: summary(|s| s.crps_force_n)?,
            crps_impulse_n_s: summary(|s| s.crps_impulse_n_s)?,
            crps_peak_n: summary(|s| s.crps_peak_n)?,
            crps_duration_s: summary(|s| s.crps_duration_s)?,
            energy_score_n: summary(|s| s.energy_score_n)?,
            nll_nats: summary(|s| s.nll_nats)?,
            pit_force: pit(|s| &s.pit_force),
            pit_impulse: pit(|s| &s.pit_impulse),
        })
    }
}

impl IntervalCoverage {
    /// Coverage at each of [`BAND_LEVELS`]; `None` without cases.
    fn from_cases(cases: &[&CaseCoverage]) -> Option<[Self; 4]> {
        let at = |i: usize| {
            let share = Summary::from_values(cases.iter().map(|case| case.share[i]))?;
            let width = Summary::from_values(cases.iter().map(|case| case.width[i]))?;
            Some(Self {
                level: BAND_LEVELS[i],
                share: share.mean,
                standard_error: share.std / (share.n as f64).sqrt(),
                mean_width: width.mean,
            })
        };
        Some([at(0)?, at(1)?, at(2)?, at(3)?])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coverage_has_the_standard_error_of_the_cases() {
        let covered = |share: f64| CaseCoverage { share: [share; 4], width: [10.0; 4] };
        let cases = [covered(1.0), covered(0.0), covered(1.0), covered(1.0)];
        let all: Vec<&CaseCoverage> = cases.iter().collect();
        let [coverage, ..] = IntervalCoverage::from_cases(&all).unwrap();
        assert_eq!((coverage.level, coverage.share, coverage.mean_width), (0.5, 0.75, 10.0));
        assert!((coverage.standard_error - 0.25).abs() < 1e-12, "{coverage:?}");
        assert_eq!(IntervalCoverage::from_cases(&[]), None);
        assert_eq!(DistributionMetrics::from_scores(&[]), None);
        assert_eq!(CurveMetrics::new(&[], &[]), None);
    }
}
