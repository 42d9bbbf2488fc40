//! The weighted mean of the crush model and a regression. Their errors differ, so that the mean has
//! smaller errors than either.
//!
//! ```text
//! F(t) = (1 − w) F_crush(t) + w F_regression(t)        T likewise
//! ```
//!
//! The regression is a [`CurveRegression`]. The share w is chosen on the training cases, where each
//! case is predicted by members that were fitted without it (stacking: Wolpert, "Stacked
//! generalization", Neural Networks 5, 1992). A separate share for the impulse is no better in
//! cross-validation.

use std::ops::ControlFlow;

use serde::{Deserialize, Serialize};

use crate::force::metrics::PointErrors;
use crate::force::regression::{ColumnSet, CurveFitError, CurveRegression};
use crate::force::{CurvePrediction, ForceCase, ForceError, ForceScenario};
use crate::learning::Split;
use crate::nn::{Expected, NnError, check_number};
use impactlab_core::uncertainty::ForceCurve;

/// Number of steps between the shares 0 and 1 that are tried.
const N_SHARES: usize = 20;

/// The regression and its share of the mean.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Committee {
    /// Fitted to all training cases.
    regression: CurveRegression,
    /// w, 0 to 1.
    share: f64,
}

impl Committee {
    /// Fits a regression without each fold, chooses the share, and fits the regression to all.
    ///
    /// - `crush`: for each case the curve of a crush law that has not seen it;
    /// - `report`: called with the number of fits done and of all fits; if it breaks, there is no
    ///   committee.
    /// - returns the committee and, for each case, the mean of members that were fitted without it;
    ///   `None` if `report` broke.
    ///
    /// # Errors
    /// [`ForceError::Regression`].
    pub(super) fn fit(
        cases: &[ForceCase],
        folds: &[Split],
        crush: &[ForceCurve],
        seed: u64,
        report: &mut dyn FnMut(usize, usize) -> ControlFlow<()>,
    ) -> Result<Option<(Self, Vec<ForceCurve>)>, ForceError> {
        let regress = |cases: &[&ForceCase]| {
            CurveRegression::fit(cases, ColumnSet::ThetaContactAndBody, seed)
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

    /// Checks a committee from a file.
    ///
    /// - `name`: its place in the metadata.
    ///
    /// # Errors
    /// [`NnError`] with the first number or list that is refused.
    pub(super) fn check(&self, name: &str) -> Result<(), NnError> {
        check_number(&format!("{name}.share"), self.share, Expected::Share)?;
        self.regression.check(&format!("{name}.regression"))
    }

    /// The weighted mean of the regression and the crush model's curve `crush`.
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

/// The regression's curve, or the crush model's if the vehicles do not approach each other: then
/// there is no momentum solution for the regression to scale.
fn member(
    regression: &CurveRegression,
    crush: &ForceCurve,
    scenario: &ForceScenario,
) -> Result<ForceCurve, CurveFitError> {
    match regression.point(scenario) {
        Err(CurveFitError::NotApproaching) => Ok(crush.clone()),
        point => Ok(point?.curve),
    }
}

/// The weighted mean of two curves and of their durations.
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
            let prediction = CurvePrediction::from_curve(blend(share, crush, other));
            let errors = PointErrors::new(case, &prediction);
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
            let scaled = |case: &ForceCase| ForceCurve {
                fx_n: scale(&case.curve.fx_n),
                fy_n: scale(&case.curve.fy_n),
                ..case.curve
            };
            cases.iter().map(scaled).collect()
        };
        let best = |crush, other| best_share(&cases, &scaled(crush), &scaled(other));
        assert_eq!(best(1.0, 1.4), 0.0);
        assert_eq!(best(0.6, 1.0), 1.0);
        assert_eq!(best(0.9, 1.3), 0.25);
    }
}
