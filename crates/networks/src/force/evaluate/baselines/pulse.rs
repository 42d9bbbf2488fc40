//! Baseline (a): a classic pulse with the momentum solution's impulse.
//!
//! Restitution, friction limit and normal are fitted to the training impulses; onset and length are
//! regressions on the training cases; the shape is the one of [`PulseShape::ALL`] with the smallest
//! history error of training cases that were left out (cross-validation).

use crate::force::regression::{
    ColumnSet, CurveFitError, FeatureMap, best_of, case_folds, history_error,
    impulse_share_times_s, mean,
};
use crate::force::{CurvePrediction, ForceCase, ForceScenario, MomentumModel};
use impactlab_core::collision::{Pulse, PulseShape};
use impactlab_core::numerics::{GaussianProcess, GaussianProcessData};
use impactlab_core::uncertainty::{CURVE_INTERVAL_S, CURVE_N_INSTANTS, ForceCurve};

/// Shares of the impulse at whose times the pulse meets the recorded curve.
const SHARES: [f64; 2] = [0.05, 0.90];

/// Added to times before their logarithm is taken, s: onsets may be zero.
const TIME_FLOOR_S: f64 = 2e-3;

/// A pulse whose position, length and shape are fitted to training cases.
#[derive(Debug, Clone)]
pub struct PulseBaseline {
    /// The chosen shape.
    pub shape: PulseShape,
    /// The momentum solution.
    pub momentum: MomentumModel,
    features: FeatureMap,
    /// Logarithms of the time of the first share (with the floor), of the time between the shares,
    /// and of the duration, s.
    times: GaussianProcess,
}

impl PulseBaseline {
    /// Fits the regressions and chooses the shape.
    ///
    /// # Errors
    /// [`CurveFitError`].
    pub fn fit(cases: &[&ForceCase], columns: ColumnSet, seed: u64) -> Result<Self, CurveFitError> {
        let mut losses = PulseShape::ALL.map(|shape| (0.0, shape));
        for (train, test) in case_folds(cases, seed) {
            let fitted = Self::fit_shape(&train, columns, PulseShape::HalfSine)?;
            for (loss, shape) in &mut losses {
                let model = Self { shape: *shape, ..fitted.clone() };
                let error = |case: &&ForceCase| history_error(case, model.predict(&case.scenario));
                *loss += mean(test.iter().map(error));
            }
        }
        let shape = best_of(losses).ok_or(CurveFitError::NoCases)?;
        Self::fit_shape(cases, columns, shape)
    }

    fn fit_shape(
        cases: &[&ForceCase],
        columns: ColumnSet,
        shape: PulseShape,
    ) -> Result<Self, CurveFitError> {
        let features = FeatureMap::fit(cases, columns);
        let row = |case: &&ForceCase| features.row(&case.scenario);
        let times = |case: &&ForceCase| {
            let [from, to] = impulse_share_times_s(&case.curve, SHARES);
            vec![
                (from + TIME_FLOOR_S).ln(),
                (to - from).max(CURVE_INTERVAL_S).ln(),
                case.curve.duration_s.max(CURVE_INTERVAL_S).ln(),
            ]
        };
        let unusual: Vec<bool> = cases.iter().map(|case| !case.is_clean()).collect();
        let times = GaussianProcess::fit(&GaussianProcessData {
            inputs: &cases.iter().map(row).collect::<Vec<_>>(),
            outputs: &cases.iter().map(times).collect::<Vec<_>>(),
            unusual: &unusual,
            weights: &[],
        })?;
        Ok(Self { shape, momentum: columns.fit_momentum(cases), features, times })
    }

    /// The pulse of a canonical scenario. It is placed such that it reaches its shares of the impulse at
    /// the times that the regression predicts, but does not start before the record.
    ///
    /// # Errors
    /// [`CurveFitError`].
    pub fn predict(&self, scenario: &ForceScenario) -> Result<CurvePrediction, CurveFitError> {
        let times = self.times.predict(&self.features.row(scenario))?.mean;
        let [ln_first, ln_between, ln_duration] = [0, 1, 2].map(|i| times[i]);
        let [from, to] = SHARES.map(|share| position_of_share(self.shape, share));
        let length_s = ln_between.exp() / (to - from);
        let start_s = (ln_first.exp() - TIME_FLOOR_S - from * length_s).max(0.0);
        let impulse_n_s = self.momentum.solve(scenario)?.impulse_world_n_s;
        let pulse = Pulse::new(self.shape, impulse_n_s, start_s, length_s)?;
        let curve = ForceCurve { duration_s: ln_duration.exp(), ..on_grid(&pulse) };
        Ok(CurvePrediction { impulse_n_s, ..CurvePrediction::from_curve(curve) })
    }
}

/// Position in a pulse, 0 to 1, at which this share of its area is reached, by bisection.
fn position_of_share(shape: PulseShape, share: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..40 {
        let middle = (low + high) / 2.0;
        if shape.cumulative(middle) < share {
            low = middle;
        } else {
            high = middle;
        }
    }
    (low + high) / 2.0
}

/// Exact means of a pulse over the cells of the time grid. The duration is not set.
fn on_grid(pulse: &Pulse) -> ForceCurve {
    let mut curve = ForceCurve::default();
    let mut before = [0.0; 2];
    for i in 1..=CURVE_N_INSTANTS {
        let now = pulse.impulse_until_n_s(i as f64 * CURVE_INTERVAL_S);
        curve.fx_n.push((now[0] - before[0]) / CURVE_INTERVAL_S);
        curve.fy_n.push((now[1] - before[1]) / CURVE_INTERVAL_S);
        before = now;
    }
    curve
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::force::input::shipped;
    use crate::force::metrics::PointErrors;

    #[test]
    fn pulses_recorded_as_cases_are_learned() {
        let mut cases: Vec<ForceCase> = shipped("fea").into_iter().take(40).collect();
        let momentum = MomentumModel::prior(true);
        for case in &mut cases {
            let [vx, vy] = case.scenario.relative_velocity_m_s();
            let duration_s = 0.2 / (1.0 + vy) + 0.002 * vx;
            let impulse = momentum.solve(&case.scenario).unwrap().impulse_world_n_s;
            let pulse = Pulse::new(PulseShape::Triangle, impulse, 0.003, duration_s).unwrap();
            case.curve = ForceCurve { duration_s, ..on_grid(&pulse) };
            case.impulse_n_s = case.curve.impulse_n_s();
            case.peak_n = case.curve.peak().0;
            case.scenario.striking_position_m = None;
            case.scenario.yaw_inertia_kg_m2 = [None; 2];
        }
        let cases: Vec<&ForceCase> = cases.iter().collect();
        let (train, test) = cases.split_at(30);
        let baseline = PulseBaseline::fit(train, ColumnSet::ThetaContactAndBody, 0).unwrap();
        assert_eq!(baseline.shape, PulseShape::Triangle);
        let error = |case: &&ForceCase| {
            PointErrors::new(case, &baseline.predict(&case.scenario).unwrap()).history_error
        };
        let error = mean(test.iter().map(error));
        assert!(error < 0.1, "{error}");
    }

    #[test]
    fn shares_are_met() {
        for shape in PulseShape::ALL {
            for share in SHARES {
                let met = shape.cumulative(position_of_share(shape, share));
                assert!((met - share).abs() < 1e-9, "{shape:?}: {met}");
            }
        }
    }
}
