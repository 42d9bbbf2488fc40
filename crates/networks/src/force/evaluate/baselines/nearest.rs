//! Baseline (b): the curve of the nearest training case.

use crate::force::regression::{
    ColumnSet, CurveFitError, FeatureMap, best_of, case_folds, history_error, mean,
};
use crate::force::{CurvePrediction, ForceCase, ForceScenario, MomentumModel};
use impactlab_core::numerics::Summary;
use impactlab_core::uncertainty::ForceCurve;

/// Whether the curve of the nearest case is scaled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NearestScaling {
    /// The curve as it was recorded.
    AsRecorded,
    /// The curve times the ratio of the momentum solutions' impulses.
    ToImpulse,
}

/// The training cases, from which the nearest one is taken.
#[derive(Debug, Clone)]
pub struct NearestBaseline {
    /// The chosen scaling.
    pub scaling: NearestScaling,
    momentum: MomentumModel,
    features: FeatureMap,
    /// `1/standard deviation` of each feature; 0 for one that does not vary.
    inverse_std: Vec<f64>,
    known: Vec<Known>,
}

/// A training case.
#[derive(Debug, Clone)]
struct Known {
    row: Vec<f64>,
    curve: ForceCurve,
    /// Size of the momentum solution's impulse, N s.
    impulse_n_s: f64,
}

impl NearestBaseline {
    /// Stores the cases and chooses whether curves are scaled, by cross-validation.
    ///
    /// # Errors
    /// [`CurveFitError`].
    pub fn fit(cases: &[&ForceCase], columns: ColumnSet, seed: u64) -> Result<Self, CurveFitError> {
        let mut losses =
            [NearestScaling::AsRecorded, NearestScaling::ToImpulse].map(|scaling| (0.0, scaling));
        for (train, test) in case_folds(cases, seed) {
            let fitted = Self::store(&train, columns)?;
            for (loss, scaling) in &mut losses {
                let model = Self { scaling: *scaling, ..fitted.clone() };
                let error = |case: &&ForceCase| history_error(case, model.predict(&case.scenario));
                *loss += mean(test.iter().map(error));
            }
        }
        let scaling = best_of(losses).ok_or(CurveFitError::NoCases)?;
        Ok(Self { scaling, ..Self::store(cases, columns)? })
    }

    fn store(cases: &[&ForceCase], columns: ColumnSet) -> Result<Self, CurveFitError> {
        let features = FeatureMap::fit(cases, columns);
        let momentum = columns.fit_momentum(cases);
        let known = cases.iter().map(|case| {
            Ok(Known {
                row: features.row(&case.scenario),
                curve: case.curve.clone(),
                impulse_n_s: impulse_n_s(&momentum, &case.scenario)?,
            })
        });
        let known: Vec<Known> = known.collect::<Result<_, CurveFitError>>()?;
        let n_features = known.first().map_or(0, |first| first.row.len());
        let inverse_std = |j: usize| {
            let std = Summary::from_values(known.iter().map(|known| known.row[j]))
                .map_or(0.0, |summary| summary.std);
            if std > 0.0 { std.recip() } else { 0.0 }
        };
        let inverse_std = (0..n_features).map(inverse_std).collect();
        let scaling = NearestScaling::AsRecorded;
        Ok(Self { scaling, momentum, features, inverse_std, known })
    }

    /// The curve of the nearest case, by the distance of standardised features.
    ///
    /// # Errors
    /// [`CurveFitError`].
    pub fn predict(&self, scenario: &ForceScenario) -> Result<CurvePrediction, CurveFitError> {
        let row = self.features.row(scenario);
        let distance = |known: &Known| -> f64 {
            let steps = known.row.iter().zip(&row).zip(&self.inverse_std);
            steps.map(|((a, b), inverse)| ((a - b) * inverse).powi(2)).sum()
        };
        let candidates = self.known.iter().map(|known| (distance(known), known));
        let nearest = best_of(candidates).ok_or(CurveFitError::NoCases)?;
        let mut curve = nearest.curve.clone();
        if self.scaling == NearestScaling::ToImpulse {
            let ratio = impulse_n_s(&self.momentum, scenario)? / nearest.impulse_n_s;
            for force in curve.fx_n.iter_mut().chain(&mut curve.fy_n) {
                *force *= ratio;
            }
        }
        Ok(CurvePrediction::from_curve(curve))
    }
}

/// Size of the momentum solution's impulse, N s.
fn impulse_n_s(momentum: &MomentumModel, scenario: &ForceScenario) -> Result<f64, CurveFitError> {
    let [px, py] = momentum.solve(scenario)?.impulse_world_n_s;
    Some(px.hypot(py)).filter(|impulse| *impulse > 0.0).ok_or(CurveFitError::NotApproaching)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::force::input::shipped;
    use crate::force::metrics::PointErrors;

    #[test]
    fn a_training_case_is_its_own_nearest() {
        let cases = shipped("fea");
        let cases: Vec<&ForceCase> = cases.iter().take(30).collect();
        for columns in ColumnSet::ALL {
            let baseline = NearestBaseline::fit(&cases, columns, 0).unwrap();
            for case in &cases {
                let prediction = baseline.predict(&case.scenario).unwrap();
                assert!(PointErrors::new(case, &prediction).history_error < 1e-9, "{}", case.name);
            }
        }
    }
}
