//! Error metrics of one model on one trajectory.

use std::time::Instant;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::learning::LearningError;
use crate::response::evaluate::MotionModel;
use crate::response::evaluate::motion_model::PredictedMotion;
use crate::response::{MotionDistribution, ResponseCase, STEP_S, average_error_m, motion_series};
use impactlab_core::compare::{MotionError, physical_violations};
use impactlab_core::data::{finite_or_null, null_as_nan};
use impactlab_core::uncertainty::sample_crps;
use impactlab_core::vehicle::{REST_SPEED_M_S, REST_YAW_RATE_RAD_S, VehicleState};

/// Every how many steps the regions are looked at: 0.1 s.
const STRIDE: usize = 10;
/// Steps of the part of a motion that long and short recordings have in common: 4 s.
const COMMON_STEPS: usize = 400;
/// How long after the recorded rest a prediction may go on until it rests too, s.
const REST_SEARCH_S: f64 = 10.0;

/// How often the recorded positions lie in the predicted regions, for one model on one trajectory.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MotionCoverage {
    /// Share of the instants inside the 50 % region.
    pub path_50: f64,
    /// Share of the instants inside the 90 % region.
    pub path_90: f64,
    /// Whether the end lies in the 50 % region, 0 or 1.
    pub end_50: f64,
    /// Whether the end lies in the 90 % region, 0 or 1.
    pub end_90: f64,
    /// Probability level of the smallest region that holds the end.
    pub end_level: f64,
    /// Mean over time of the continuous ranked probability score of X, m.
    #[serde(serialize_with = "finite_or_null", deserialize_with = "null_as_nan")]
    #[schemars(with = "Option<f64>")]
    pub crps_x_m: f64,
    /// Mean over time of the continuous ranked probability score of Y, m.
    #[serde(serialize_with = "finite_or_null", deserialize_with = "null_as_nan")]
    #[schemars(with = "Option<f64>")]
    pub crps_y_m: f64,
    /// Mean over time of the continuous ranked probability score of the heading, rad.
    #[serde(serialize_with = "finite_or_null", deserialize_with = "null_as_nan")]
    #[schemars(with = "Option<f64>")]
    pub crps_yaw_rad: f64,
    /// Mean over time of the energy score of (X, Y), m.
    #[serde(serialize_with = "finite_or_null", deserialize_with = "null_as_nan")]
    #[schemars(with = "Option<f64>")]
    pub energy_score_m: f64,
}

/// Metrics of one model on one trajectory.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MotionCaseMetrics {
    /// Errors of the central path; infinite where it is not finite.
    #[serde(flatten)]
    pub error: MotionError,
    /// Average error over the first 4 s, or over the whole of a shorter recording, m.
    #[serde(
        default = "unmeasured",
        serialize_with = "finite_or_null",
        deserialize_with = "null_as_nan"
    )]
    #[schemars(with = "Option<f64>")]
    pub average_error_4_s_m: f64,
    /// Distance between the recorded and the predicted rest position, m; `None` where the recording
    /// does not end at rest.
    pub rest_error_m: Option<f64>,
    /// Instants at which kinetic energy grows with no force on the vehicle, over the paths of the
    /// components of the network, without the noise of its draws.
    pub violations: usize,
    /// Time for a step of the whole answer, µs.
    pub time_per_step_us: f64,
    /// Coverage of the predicted regions, for a model that predicts a distribution.
    pub coverage: Option<MotionCoverage>,
}

impl MotionCaseMetrics {
    /// Predicts a trajectory with a model and compares; returns the predicted states too.
    ///
    /// # Errors
    /// [`LearningError::Network`].
    pub(crate) fn evaluate(
        model: &MotionModel,
        case: &ResponseCase,
    ) -> Result<(Self, Vec<VehicleState<f64>>), LearningError> {
        let started = Instant::now();
        let predicted = model.predict(case)?;
        let seconds = started.elapsed().as_secs_f64();
        let PredictedMotion { states, paths, distribution } = predicted;
        let error = motion_series(&states, &case.inputs)
            .and_then(|predicted| {
                MotionError::between(&predicted, &motion_series(&case.states, &case.inputs)?)
            })
            .unwrap_or_else(|_| infinite());
        let violations = paths.iter().map(|path| violations(path, case)).sum();
        let common = &case.states[..case.states.len().min(COMMON_STEPS + 1)];
        let metrics = Self {
            error,
            average_error_4_s_m: average_error_m(&states, common),
            rest_error_m: rest_error_m(model, case)?,
            violations,
            time_per_step_us: seconds * 1e6 / case.inputs.len().max(1) as f64,
            coverage: distribution.map(|distribution| coverage(&distribution, case)),
        };
        Ok((metrics, states))
    }
}

/// What files from before it was measured say of an error.
fn unmeasured() -> f64 {
    f64::NAN
}

/// Distance between the recorded and the predicted rest position, m: the prediction goes on after the
/// recording as it ends, until the vehicle rests.
fn rest_error_m(model: &MotionModel, case: &ResponseCase) -> Result<Option<f64>, LearningError> {
    let is_at_rest = |state: &&VehicleState<f64>| {
        state.vx_body_m_s.hypot(state.vy_body_m_s) < REST_SPEED_M_S
            && state.yaw_rate_rad_s.abs() < REST_YAW_RATE_RAD_S
    };
    let (Some(end), Some(last)) = (case.states.last().filter(is_at_rest), case.inputs.last())
    else {
        return Ok(None);
    };
    let mut longer = case.clone();
    longer.inputs.extend(vec![*last; (REST_SEARCH_S / STEP_S) as usize]);
    let states = model.path(&longer)?;
    // A vehicle that slows down to nothing before it is struck is not at rest yet.
    let after_recording = states.iter().skip(case.states.len() / 2);
    let rest = after_recording.clone().find(is_at_rest).or(states.last());
    Ok(rest.map(|rest| (rest.x_m - end.x_m).hypot(rest.y_m - end.y_m)))
}

/// A path whose numbers are not finite breaks mechanics at every step.
fn violations(path: &[VehicleState<f64>], case: &ResponseCase) -> usize {
    let series = motion_series(path, &case.inputs);
    series
        .and_then(|series| physical_violations(&series, &case.vehicle))
        .unwrap_or(case.inputs.len())
}

fn infinite() -> MotionError {
    MotionError {
        average_error_m: f64::INFINITY,
        final_error_m: f64::INFINITY,
        final_heading_error_rad: f64::INFINITY,
        horizon_error_m: [f64::INFINITY; 4],
        rmse_x_m: f64::INFINITY,
        rmse_y_m: f64::INFINITY,
        rmse_vx_body_m_s: Some(f64::INFINITY),
        rmse_vy_body_m_s: Some(f64::INFINITY),
        rmse_yaw_rate_rad_s: Some(f64::INFINITY),
    }
}

fn coverage(distribution: &MotionDistribution, case: &ResponseCase) -> MotionCoverage {
    let (last, resolution_m) = (case.states.len().saturating_sub(1), case.resolution_m());
    let mut sum = MotionCoverage::default();
    let mut n = 0.0;
    for (at, state) in case.states.iter().enumerate().skip(STRIDE).step_by(STRIDE) {
        let point = [state.x_m, state.y_m];
        let position = distribution.position(at).recorded_to(resolution_m);
        let level = position.level_of(point);
        sum.path_50 += f64::from(u8::from(level <= 0.5));
        sum.path_90 += f64::from(u8::from(level <= 0.9));
        let numbers = [state.x_m, state.y_m, state.yaw_rad];
        let crps = |axis: usize| sample_crps(&distribution.values(at, axis), numbers[axis]);
        let places: Vec<[f64; 2]> =
            distribution.states(at).map(|drawn| [drawn.x_m, drawn.y_m]).collect();
        sum.crps_x_m += crps(0);
        sum.crps_y_m += crps(1);
        sum.crps_yaw_rad += crps(2);
        sum.energy_score_m += energy_score_m(&places, point);
        n += 1.0;
    }
    let end = case.states.last().copied().unwrap_or_default();
    let end_level =
        distribution.position(last).recorded_to(resolution_m).level_of([end.x_m, end.y_m]);
    let n = f64::max(n, 1.0);
    MotionCoverage {
        path_50: sum.path_50 / n,
        path_90: sum.path_90 / n,
        end_50: f64::from(u8::from(end_level <= 0.5)),
        end_90: f64::from(u8::from(end_level <= 0.9)),
        end_level,
        crps_x_m: sum.crps_x_m / n,
        crps_y_m: sum.crps_y_m / n,
        crps_yaw_rad: sum.crps_yaw_rad / n,
        energy_score_m: sum.energy_score_m / n,
    }
}

/// `mean ‖x_i − y‖ − ½ mean ‖x_i − x_j‖` over draws, m.
///
/// Source: T. Gneiting, A. E. Raftery, Strictly Proper Scoring Rules, JASA 102 (2007) 359–378.
fn energy_score_m(draws: &[[f64; 2]], point: [f64; 2]) -> f64 {
    let distance = |a: &[f64; 2], b: &[f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
    let n = draws.len().max(1) as f64;
    let to_point = draws.iter().map(|draw| distance(draw, &point)).sum::<f64>() / n;
    // Neighbours in the order of the draws are independent: as good as all pairs, at less cost.
    let among = draws.iter().zip(draws.iter().skip(1)).map(|(a, b)| distance(a, b)).sum::<f64>();
    to_point - 0.5 * among / (n - 1.0).max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_energy_score_of_a_point_is_its_distance() {
        let score = energy_score_m(&[[1.0, 0.0]; 50], [4.0, 4.0]);
        assert!((score - 5.0).abs() < 1e-12, "{score}");
    }
}
