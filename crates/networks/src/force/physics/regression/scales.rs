//! Regressions of the impulse, relative to the momentum solution, and of the duration.

use serde::{Deserialize, Serialize};

use crate::force::regression::{ColumnSet, CurveFitError, FeatureMap};
use crate::force::{ForceCase, ForceScenario, MomentumModel};
use crate::nn::{NnError, check_length};
use impactlab_core::numerics::{GaussianPrediction, GaussianProcess, GaussianProcessData};
use impactlab_core::uncertainty::CURVE_INTERVAL_S;

/// Momentum solution, inputs and the regressions on them.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Scales {
    momentum: MomentumModel,
    features: FeatureMap,
    with_impulse: bool,
    /// `ln |P|/|P_m|`, turn of the direction from `P_m`, rad, `ln` duration in s.
    regressions: [GaussianProcess; 3],
}

impl Scales {
    /// Checks the scales from a file, as [`CurveRegression::check`](super::CurveRegression::check).
    pub(super) fn check(&self, name: &str) -> Result<(), NnError> {
        self.momentum.check(&format!("{name}.momentum"))?;
        for (i, regression) in self.regressions.iter().enumerate() {
            check_length(&format!("{name}.regressions[{i}]"), regression.n_outputs(), 1)?;
        }
        Ok(())
    }

    pub(super) fn fit(
        cases: &[&ForceCase],
        columns: ColumnSet,
        with_impulse: bool,
    ) -> Result<Self, CurveFitError> {
        let momentum = columns.fit_momentum(cases);
        let features = FeatureMap::fit(cases, columns);
        let mut inputs = Vec::with_capacity(cases.len());
        let mut outputs: [Vec<Vec<f64>>; 3] = Default::default();
        for case in cases {
            let (row, [mx, my]) = row(&momentum, &features, with_impulse, &case.scenario)?;
            let [px, py] = case.impulse_n_s;
            inputs.push(row);
            outputs[0].push(vec![(px.hypot(py) / mx.hypot(my)).ln()]);
            outputs[1].push(vec![px.atan2(py) - mx.atan2(my)]);
            outputs[2].push(vec![case.curve.duration_s.max(CURVE_INTERVAL_S).ln()]);
        }
        let unusual = unusual(cases);
        let regress = |outputs: &[Vec<f64>]| {
            let data =
                GaussianProcessData { inputs: &inputs, outputs, unusual: &unusual, weights: &[] };
            GaussianProcess::fit(&data)
        };
        let [ratio, turn, duration] = &outputs;
        let regressions = [regress(ratio)?, regress(turn)?, regress(duration)?];
        Ok(Self { momentum, features, with_impulse, regressions })
    }

    /// The inputs of all regressions, and the momentum solution's impulse, N s.
    pub(super) fn row(
        &self,
        scenario: &ForceScenario,
    ) -> Result<(Vec<f64>, [f64; 2]), CurveFitError> {
        row(&self.momentum, &self.features, self.with_impulse, scenario)
    }

    pub(super) fn predict(&self, row: &[f64]) -> Result<[GaussianPrediction; 3], CurveFitError> {
        let [ratio, turn, duration] = &self.regressions;
        Ok([ratio.predict(row)?, turn.predict(row)?, duration.predict(row)?])
    }
}

fn row(
    momentum: &MomentumModel,
    features: &FeatureMap,
    with_impulse: bool,
    scenario: &ForceScenario,
) -> Result<(Vec<f64>, [f64; 2]), CurveFitError> {
    let solution = momentum.solve(scenario)?;
    if solution.impulse_world_n_s == [0.0; 2] {
        return Err(CurveFitError::NotApproaching);
    }
    let row = if with_impulse {
        features.row_with_impulse(scenario, &solution)
    } else {
        features.row(scenario)
    };
    Ok((row, solution.impulse_world_n_s))
}

/// Whether each case hooks or stays together.
pub(super) fn unusual(cases: &[&ForceCase]) -> Vec<bool> {
    cases.iter().map(|case| !case.is_clean()).collect()
}
