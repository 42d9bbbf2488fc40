//! Many cases against their truths.

use schemars::JsonSchema;
use serde::Serialize;

use crate::evaluate::{CaseScore, KnownEvidence, ReconstructionMethod, SCORED, ScoredQuantity};
use impactlab_core::numerics::{median, quantile_of_sorted};

/// Effective sample size from which on intervals are relied on.
pub const SUFFICIENT_ESS: f64 = 400.0;

/// How one method does on cases of which the same is known.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct MethodSummary {
    /// How much of the evidence was used.
    pub known: KnownEvidence,
    /// How the speeds were estimated.
    pub method: ReconstructionMethod,
    /// Number of cases.
    pub n_cases: usize,
    /// Median of the time of a case, s.
    pub median_seconds: f64,
    /// Time within which 90 % of the cases are done, s.
    pub p90_seconds: f64,
    /// Number of cases whose effective sample size is [`SUFFICIENT_ESS`] or more, of a method that
    /// samples.
    pub n_sufficient_ess: Option<usize>,
    /// The quantities that the method knows.
    pub quantities: Vec<QuantitySummary>,
}

/// How well a quantity is estimated.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct QuantitySummary {
    /// Name with its unit.
    pub name: &'static str,
    /// Symbol of the unit.
    pub unit: &'static str,
    /// Number of cases in which it is estimated.
    pub n: usize,
    /// Share of the truths in the intervals of 50 %.
    pub coverage_50: f64,
    /// … of 80 %.
    pub coverage_80: f64,
    /// … of 90 %.
    pub coverage_90: f64,
    /// … of 95 %.
    pub coverage_95: f64,
    /// Median of the absolute errors of the medians.
    pub median_absolute_error: f64,
    /// Median of the errors of the medians, positive where they are too large.
    pub median_error: f64,
    /// Median width of the intervals of 90 %.
    pub median_width_90: f64,
    /// Mean of the continuous ranked probability scores.
    pub mean_crps: f64,
}

impl MethodSummary {
    /// The summary of each method for each part of the evidence that was used.
    pub fn from_scores(scores: &[CaseScore]) -> Vec<Self> {
        let methods = |known| ReconstructionMethod::ALL.map(|method| (known, method));
        let pairs = KnownEvidence::ALL.into_iter().flat_map(methods);
        pairs.filter_map(|(known, method)| Self::for_method(scores, known, method)).collect()
    }

    fn for_method(
        scores: &[CaseScore],
        known: KnownEvidence,
        method: ReconstructionMethod,
    ) -> Option<Self> {
        let is_of = |score: &&CaseScore| score.known == known && score.method == method;
        let scores: Vec<&CaseScore> = scores.iter().filter(is_of).collect();
        let mut seconds: Vec<f64> = scores.iter().map(|score| score.seconds).collect();
        seconds.sort_by(f64::total_cmp);
        let ess: Vec<f64> = scores.iter().filter_map(|score| score.ess).collect();
        let n_sufficient = ess.iter().filter(|ess| **ess >= SUFFICIENT_ESS).count();
        let quantities = SCORED.iter().filter_map(|speed| {
            let scored: Vec<&ScoredQuantity> =
                scores.iter().filter_map(|score| score.quantity(speed.key())).collect();
            QuantitySummary::new(&scored)
        });
        Some(Self {
            known,
            method,
            n_cases: scores.len(),
            median_seconds: quantile_of_sorted(&seconds, 0.5)?,
            p90_seconds: quantile_of_sorted(&seconds, 0.9)?,
            n_sufficient_ess: (!ess.is_empty()).then_some(n_sufficient),
            quantities: quantities.collect(),
        })
    }
}

impl QuantitySummary {
    /// The summary of one quantity over cases; `None` without cases.
    pub fn new(scored: &[&ScoredQuantity]) -> Option<Self> {
        let first = scored.first()?;
        let n = scored.len();
        let share = |level: f64| {
            let holds = |quantity: &&&ScoredQuantity| {
                let interval = quantity.estimate.estimate.interval(level);
                interval.is_some_and(|[low, high]| (low..=high).contains(&quantity.truth))
            };
            scored.iter().filter(holds).count() as f64 / n as f64
        };
        let median = |value: fn(&ScoredQuantity) -> f64| {
            median(scored.iter().map(|quantity| value(quantity)))
        };
        Some(Self {
            name: first.estimate.name,
            unit: first.estimate.unit,
            n,
            coverage_50: share(0.5),
            coverage_80: share(0.8),
            coverage_90: share(0.9),
            coverage_95: share(0.95),
            median_absolute_error: median(|quantity| quantity.error().abs())?,
            median_error: median(ScoredQuantity::error)?,
            median_width_90: median(ScoredQuantity::width_90)?,
            mean_crps: scored.iter().map(|quantity| quantity.crps).sum::<f64>() / n as f64,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ReconstructedQuantity;
    use crate::evaluate::{
        EstimatedQuantity, MethodEstimates, QuantityDistribution, TrueQuantities,
    };
    use crate::evidence::Measured;
    use impactlab_core::numerics::wrap_angle_rad;

    /// A case whose struck car was estimated at 20 ± 2 m/s.
    fn score(truth_m_s: f64, seconds: f64, ess: f64) -> CaseScore {
        let distribution = QuantityDistribution::Normal(Measured { value: 20.0, sigma: 2.0 });
        let quantity = ReconstructedQuantity::StruckSpeed;
        let estimates = MethodEstimates {
            method: ReconstructionMethod::Reconstruction,
            seconds,
            ess: Some(ess),
            n_simulations: 7,
            quantities: vec![EstimatedQuantity { quantity, distribution }],
        };
        let truth = TrueQuantities { struck_m_s: truth_m_s, ..TrueQuantities::default() };
        CaseScore::new("case", KnownEvidence::RestOnly, &estimates, &truth)
    }

    #[test]
    fn the_summary_of_four_cases_by_hand() {
        // 20 ± 1.349 hold 50 %, ± 2.563 80 %, ± 3.290 90 %, ± 3.920 95 %.
        let truths = [21.0, 22.0, 17.0, 24.0];
        let cases = truths.iter().zip([1.0, 2.0, 4.0, 8.0]).zip([399.0, 400.0, 1.0, 500.0]);
        let scores: Vec<CaseScore> = cases.map(|((t, s), ess)| score(*t, s, ess)).collect();
        let [summary] = MethodSummary::from_scores(&scores).try_into().unwrap();
        assert_eq!((summary.known, summary.n_cases), (KnownEvidence::RestOnly, 4));
        assert_eq!((summary.median_seconds, summary.n_sufficient_ess), (3.0, Some(2)));
        assert!((summary.p90_seconds - 6.8).abs() < 1e-12);
        let [speed] = summary.quantities.try_into().unwrap();
        let coverage = [speed.coverage_50, speed.coverage_80, speed.coverage_90, speed.coverage_95];
        assert_eq!(coverage, [0.25, 0.5, 0.75, 0.75]);
        // Errors −1, −2, 3, −4.
        assert_eq!((speed.median_absolute_error, speed.median_error), (2.5, -1.5));
        assert!((speed.median_width_90 - 4.0 * 1.644_853_627).abs() < 1e-6);
        // CRPS of N(0, 1) at 0.5, 1, 1.5, 2, twice as large here.
        let expected = 2.0 * (0.331_404 + 0.602_441 + 0.994_424 + 1.452_789) / 4.0;
        assert!((speed.mean_crps - expected).abs() < 1e-4, "{} {expected}", speed.mean_crps);
    }

    #[test]
    fn a_heading_is_compared_with_the_nearest_turn_of_the_truth() {
        let quantity = ReconstructedQuantity::HeadingDifference;
        let draws = (-10..=10).map(|k| wrap_angle_rad((179.0 + f64::from(k)).to_radians()));
        let distribution = QuantityDistribution::from_draws(quantity, draws.collect());
        let estimates = MethodEstimates {
            method: ReconstructionMethod::Reconstruction,
            seconds: 1.0,
            ess: None,
            n_simulations: 7,
            quantities: vec![EstimatedQuantity { quantity, distribution }],
        };
        let heading = Some((-179_f64).to_radians());
        let truth = TrueQuantities { heading_difference_rad: heading, ..TrueQuantities::default() };
        let score = CaseScore::new("case", KnownEvidence::RestOnly, &estimates, &truth);
        let [scored] = score.quantities.try_into().unwrap();
        assert!((scored.error().to_degrees() + 2.0).abs() < 1e-9, "{scored:?}");
        assert!((scored.width_90().to_degrees() - 18.0).abs() < 1e-9, "{scored:?}");
    }

    #[test]
    fn a_speed_without_a_distribution_is_left_out() {
        let mut none = score(20.0, 1.0, 1.0);
        none.quantities.clear();
        let summary = MethodSummary::from_scores(&[none, score(20.0, 1.0, 1.0)]);
        assert_eq!((summary[0].n_cases, summary[0].quantities[0].n), (2, 1));
        for distribution in [
            QuantityDistribution::Draws(Vec::new()),
            QuantityDistribution::Normal(Measured { value: 20.0, sigma: 0.0 }),
            QuantityDistribution::Normal(Measured { value: 20.0, sigma: f64::NAN }),
        ] {
            assert_eq!((distribution.quantile(0.5), distribution.crps(1.0)), (None, None));
        }
    }
}
