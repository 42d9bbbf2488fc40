//! Errors of the point estimates of one case.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::force::{CurvePrediction, ForceCase};
use impactlab_core::uncertainty::distance_n;

/// Errors of one case, as shares unless the name has a unit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PointErrors {
    /// Root mean square error over the peak of `|F|`.
    ///
    /// ```text
    /// √(mean over all instants of the grid and both axes of (F̂ − F)²) / max |F|
    /// ```
    ///
    /// The mean is over the whole grid of 250 ms, not over the contact.
    pub rmse_over_peak: f64,
    /// Root mean square error of F_x over the grid, N.
    pub rmse_x_n: f64,
    /// Root mean square error of F_y over the grid, N.
    pub rmse_y_n: f64,
    /// `‖F̂ − F‖₂ / ‖F‖₂`, both axes together.
    pub history_error: f64,
    /// The same of F_x alone; `None` without any force along x.
    pub history_error_x: Option<f64>,
    /// The same of F_y alone; `None` without any force along y.
    pub history_error_y: Option<f64>,
    /// `|P̂ − P| / |P|` of the impulse vector.
    pub impulse_error: f64,
    /// `|max |F̂| − max |F|| / max |F|`.
    pub peak_error: f64,
    /// `|Δt̂ − Δt| / Δt` of the duration.
    pub duration_error: f64,
}

impl PointErrors {
    /// Errors of a prediction for a case.
    pub fn new(case: &ForceCase, prediction: &CurvePrediction) -> Self {
        let (truth, curve) = (&case.curve, &prediction.curve);
        let n = truth.n_instants() as f64;
        let [ex, ey] = [difference(&curve.fx_n, &truth.fx_n), difference(&curve.fy_n, &truth.fy_n)];
        let [fx, fy] = [norm(&truth.fx_n), norm(&truth.fy_n)];
        let [px, py] = case.impulse_n_s;
        let [qx, qy] = prediction.impulse_n_s;
        Self {
            rmse_over_peak: distance_n(curve, truth) / case.peak_n,
            rmse_x_n: ex / n.sqrt(),
            rmse_y_n: ey / n.sqrt(),
            history_error: ex.hypot(ey) / fx.hypot(fy),
            history_error_x: (fx > 0.0).then_some(ex / fx),
            history_error_y: (fy > 0.0).then_some(ey / fy),
            impulse_error: (qx - px).hypot(qy - py) / px.hypot(py),
            peak_error: (prediction.peak_n - case.peak_n).abs() / case.peak_n,
            duration_error: (curve.duration_s - truth.duration_s).abs() / truth.duration_s,
        }
    }
}

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum::<f64>().sqrt()
}

fn difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::force::input::shipped;

    #[test]
    fn a_perfect_prediction_has_no_error() {
        let case = &shipped("fea")[0];
        let errors = PointErrors::new(case, &CurvePrediction::from_curve(case.curve.clone()));
        let json = serde_json::to_value(errors).unwrap();
        for (name, value) in json.as_object().unwrap() {
            assert_eq!(value.as_f64(), Some(0.0), "{name}");
        }
    }

    #[test]
    fn a_scaled_prediction_has_known_errors() {
        let case = &shipped("fea")[1];
        let mut curve = case.curve.clone();
        for force in curve.fx_n.iter_mut().chain(&mut curve.fy_n) {
            *force *= 1.1;
        }
        curve.duration_s *= 0.8;
        let errors = PointErrors::new(case, &CurvePrediction::from_curve(curve));
        for (name, got, expected) in [
            ("history", errors.history_error, 0.1),
            ("along", errors.history_error_x.unwrap(), 0.1),
            ("across", errors.history_error_y.unwrap(), 0.1),
            ("impulse", errors.impulse_error, 0.1),
            ("peak", errors.peak_error, 0.1),
            ("duration", errors.duration_error, 0.2),
        ] {
            assert!((got - expected).abs() < 1e-9, "{name}: {got}");
        }
        let both = errors.rmse_x_n.hypot(errors.rmse_y_n) / 2_f64.sqrt() / case.peak_n;
        assert!((errors.rmse_over_peak - both).abs() < 1e-12);
    }
}
