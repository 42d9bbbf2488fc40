//! Physics and regressions as a committee: each is wrong in its own way, so that their mean is
//! nearer than either.
//!
//! ```text
//! F(t) = (1 − w) F_crush(t) + w F_regression(t)        T likewise
//! ```
//!
//! The regression is [`StatisticalBaseline`]; the share w is chosen on training cases, each through
//! members of the committee that have not seen it. Stacking: Wolpert, "Stacked generalization",
//! Neural Networks 5 (1992). A share of its own for the impulse was tried and is no better in
//! cross-validation.

use std::ops::ControlFlow;

use serde::{Deserialize, Serialize};

use crate::force::metrics::PointErrors;
use crate::force::regression::{BaselineError, ColumnSet, StatisticalBaseline};
use crate::force::{ForceCase, ForceError, ForceScenario, Prediction};
use crate::learning::Split;
use crate::uncertainty::ForceCurve;

/// Shares tried: steps from none to all.
const N_SHARES: usize = 20;

/// The regression and what it counts for.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Committee {
    /// Fitted to all training cases.
    regression: StatisticalBaseline,
    /// w, 0 to 1.
    share: f64,
}

impl Committee {
    /// Fits a regression without each fold, chooses the share, and fits the regression to all.
    ///
    /// - `crush`: for each case the curve of a crush law that has not seen it;
    /// - `report`: fits done of all; breaking leaves the committee unfounded.
    /// - returns the committee and, for each case, what members that have not seen it say; `None`
    ///   if broken off.
    ///
    /// # Errors
    /// [`ForceError::Regression`].
    pub(super) fn fit(
        (cases, folds): (&[ForceCase], &[Split]),
        crush: &[ForceCurve],
        seed: u64,
        report: &mut dyn FnMut(usize, usize) -> ControlFlow<()>,
    ) -> Result<Option<(Self, Vec<ForceCurve>)>, ForceError> {
        let regress = |cases: &[&ForceCase]| {
            StatisticalBaseline::fit(cases, ColumnSet::ThetaContactAndBody, seed)
        };
        let mut unseen: Vec<ForceCurve> = crush.to_vec();
        for (i, fold) in folds.iter().enumerate() {
            if report(i, folds.len() + 1).is_break() {
                return Ok(None);
            }
            let train: Vec<&ForceCase> = fold.train.iter().map(|&idx| &cases[idx]).collect();
            let regression = regress(&train)?;
            for &idx in &fold.test {
                unseen[idx] = member(&regression, &crush[idx], &cases[idx].scenario)?;
            }
        }
        if report(folds.len(), folds.len() + 1).is_break() {
            return Ok(None);
        }
        let share = best_share(cases, crush, &unseen);
        let blended = crush.iter().zip(&unseen).map(|(crush, other)| blend(share, crush, other));
        let regression = regress(&cases.iter().collect::<Vec<_>>())?;
        Ok(Some((Self { regression, share }, blended.collect())))
    }

    /// What the committee says where the crush model says `crush`.
    ///
    /// # Errors
    /// [`ForceError::Regression`].
    pub(super) fn curve(
        &self,
        crush: &ForceCurve,
        scenario: &ForceScenario,
    ) -> Result<ForceCurve, ForceError> {
        Ok(blend(self.share, crush, &member(&self.regression, crush, scenario)?))
    }
}

/// The regression's curve; the crush model's where vehicles do not approach, which a regression
/// relative to the momentum solution knows nothing of.
fn member(
    regression: &StatisticalBaseline,
    crush: &ForceCurve,
    scenario: &ForceScenario,
) -> Result<ForceCurve, BaselineError> {
    match regression.point(scenario) {
        Err(BaselineError::NotApproaching) => Ok(crush.clone()),
        point => Ok(point?.curve),
    }
}

/// Force and duration.
fn blend(share: f64, crush: &ForceCurve, other: &ForceCurve) -> ForceCurve {
    let pairs = crush.to_values().into_iter().zip(other.to_values());
    let values: Vec<f64> = pairs.map(|(a, b)| (1.0 - share) * a + share * b).collect();
    ForceCurve::from_values(&values)
}

/// The share with the smallest sum of history and impulse error, over clean cases if there are any.
fn best_share(cases: &[ForceCase], crush: &[ForceCurve], others: &[ForceCurve]) -> f64 {
    let any_clean = cases.iter().any(ForceCase::is_clean);
    let loss = |share: f64| -> f64 {
        let triples = cases.iter().zip(crush).zip(others);
        let chosen = triples.filter(|((case, _), _)| case.is_clean() || !any_clean);
        let errors = chosen.map(|((case, crush), other)| {
            let prediction = Prediction::of_curve(blend(share, crush, other));
            let errors = PointErrors::of(case, &prediction);
            errors.history_error + errors.impulse_error
        });
        errors.sum()
    };
    let shares = (0..=N_SHARES).map(|i| i as f64 / N_SHARES as f64);
    let losses = shares.map(|share| (loss(share), share));
    losses.min_by(|(a, _), (b, _)| a.total_cmp(b)).map_or(0.0, |(_, share)| share)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::force::input::shipped;

    #[test]
    fn the_share_follows_the_better_member_and_the_mean_of_opposite_errors() {
        let cases: Vec<ForceCase> = shipped("fea").into_iter().take(8).collect();
        let scaled = |factor: f64| -> Vec<ForceCurve> {
            let scale = |values: &[f64]| values.iter().map(|value| factor * value).collect();
            let of = |case: &ForceCase| ForceCurve {
                fx_n: scale(&case.curve.fx_n),
                fy_n: scale(&case.curve.fy_n),
                ..case.curve
            };
            cases.iter().map(of).collect()
        };
        let best = |crush, other| best_share(&cases, &scaled(crush), &scaled(other));
        assert_eq!(best(1.0, 1.4), 0.0);
        assert_eq!(best(0.6, 1.0), 1.0);
        assert_eq!(best(0.9, 1.3), 0.25);
    }
}
