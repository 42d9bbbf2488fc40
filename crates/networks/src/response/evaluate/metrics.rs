//! Error metrics of a model over trajectories.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::response::evaluate::{MotionCaseMetrics, MotionCoverage};
use impactlab_core::data::{finite_or_null, null_as_nan};
use impactlab_core::numerics::quantile_of_sorted;
use impactlab_core::units::KILOMETRE_PER_HOUR_M_S;

/// Mean, standard deviation and median.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MeanStd {
    /// Mean.
    #[serde(serialize_with = "finite_or_null", deserialize_with = "null_as_nan")]
    #[schemars(with = "Option<f64>")]
    pub mean: f64,
    /// Standard deviation over the trajectories (divisor n).
    #[serde(serialize_with = "finite_or_null", deserialize_with = "null_as_nan")]
    #[schemars(with = "Option<f64>")]
    pub std: f64,
    /// Median.
    #[serde(serialize_with = "finite_or_null", deserialize_with = "null_as_nan")]
    #[schemars(with = "Option<f64>")]
    pub median: f64,
}

/// Metrics of a model over trajectories.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MotionMetrics {
    /// Trajectories asked about, counted once for each choice of the fine-tune trajectories.
    pub n: usize,
    /// Average error, m.
    pub average_error_m: MeanStd,
    /// Average error over the first 4 s, m.
    #[serde(default = "MeanStd::undefined")]
    pub average_error_4_s_m: MeanStd,
    /// Distance between recorded and predicted rest position, m, where a recording ends at rest.
    #[serde(default = "MeanStd::undefined")]
    pub rest_error_m: MeanStd,
    /// Trajectories that end at rest, counted as in `n`.
    #[serde(default)]
    pub n_at_rest: usize,
    /// 1/mean of the average error, 1/m.
    #[serde(serialize_with = "finite_or_null", deserialize_with = "null_as_nan")]
    #[schemars(with = "Option<f64>")]
    pub score: f64,
    /// Root mean square errors.
    pub rmse: RootMeanSquares,
    /// Size of the final heading error, deg.
    pub final_heading_error_deg: MeanStd,
    /// Distance after 0.5, 1, 2 and 4 s, m.
    pub horizon_error_m: [MeanStd; 4],
    /// Instants at which kinetic energy grows with no force.
    pub violations: usize,
    /// Time for a step, µs: the median.
    pub time_per_step_us: f64,
    /// Coverage of the predicted regions, for a model that predicts a distribution.
    pub coverage: Option<CoverageMetrics>,
}

/// Root mean square errors over a trajectory.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RootMeanSquares {
    /// Error of X, m.
    pub x_m: MeanStd,
    /// Error of Y, m.
    pub y_m: MeanStd,
    /// Error of v_x, km/h.
    pub vx_km_h: MeanStd,
    /// Error of v_y, km/h.
    pub vy_km_h: MeanStd,
    /// Error of the yaw rate, deg/s.
    pub yaw_rate_deg_s: MeanStd,
}

impl RootMeanSquares {
    /// The name of each error in tables, with its unit, and its value.
    pub fn named(&self) -> [(&'static str, MeanStd); 5] {
        [
            ("X, m", self.x_m),
            ("Y, m", self.y_m),
            ("v_x, km/h", self.vx_km_h),
            ("v_y, km/h", self.vy_km_h),
            ("yaw rate, deg/s", self.yaw_rate_deg_s),
        ]
    }
}

/// How well the predicted distribution agrees with the recorded positions.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CoverageMetrics {
    /// Share of the positions along the path that lie in the 50 % regions.
    #[serde(rename = "50")]
    pub path_50: f64,
    /// Share of the positions along the path that lie in the 90 % regions.
    #[serde(rename = "90")]
    pub path_90: f64,
    /// Share of the ends that lie in the 50 % regions.
    pub end_50: f64,
    /// Share of the ends that lie in the 90 % regions.
    pub end_90: f64,
    /// Mean continuous ranked probability score of X, m.
    #[serde(serialize_with = "finite_or_null", deserialize_with = "null_as_nan")]
    #[schemars(with = "Option<f64>")]
    pub crps_x_m: f64,
    /// Mean continuous ranked probability score of Y, m.
    #[serde(serialize_with = "finite_or_null", deserialize_with = "null_as_nan")]
    #[schemars(with = "Option<f64>")]
    pub crps_y_m: f64,
    /// Mean continuous ranked probability score of the heading, deg.
    #[serde(serialize_with = "finite_or_null", deserialize_with = "null_as_nan")]
    #[schemars(with = "Option<f64>")]
    pub crps_yaw_deg: f64,
    /// Mean energy score of (X, Y), m.
    #[serde(serialize_with = "finite_or_null", deserialize_with = "null_as_nan")]
    #[schemars(with = "Option<f64>")]
    pub energy_score_m: f64,
}

impl MeanStd {
    /// The same in another unit.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        let Self { mean, std, median } = self;
        Self { mean: mean * factor, std: std * factor, median: median * factor }
    }

    /// The statistics of no values, as in files from before something was measured.
    fn undefined() -> Self {
        Self::from_values([])
    }

    /// The statistics of values; NaN without any.
    pub fn from_values(values: impl IntoIterator<Item = f64>) -> Self {
        let mut values: Vec<f64> = values.into_iter().collect();
        values.sort_by(f64::total_cmp);
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / n;
        let median = quantile_of_sorted(&values, 0.5).unwrap_or(f64::NAN);
        Self { mean, std: variance.sqrt(), median }
    }
}

impl MotionMetrics {
    /// Metrics over trajectories.
    pub fn from_cases(cases: &[&MotionCaseMetrics]) -> Self {
        let over = |value: &dyn Fn(&MotionCaseMetrics) -> f64| {
            MeanStd::from_values(cases.iter().map(|case| value(case)))
        };
        let known = |value: Option<f64>| value.unwrap_or(f64::NAN);
        let average_error_m = over(&|case| case.error.average_error_m);
        Self {
            n: cases.len(),
            average_error_m,
            average_error_4_s_m: over(&|case| case.average_error_4_s_m),
            rest_error_m: MeanStd::from_values(cases.iter().filter_map(|case| case.rest_error_m)),
            n_at_rest: cases.iter().filter(|case| case.rest_error_m.is_some()).count(),
            score: 1.0 / average_error_m.mean,
            rmse: RootMeanSquares {
                x_m: over(&|case| case.error.rmse_x_m),
                y_m: over(&|case| case.error.rmse_y_m),
                vx_km_h: over(&|case| known(case.error.rmse_vx_body_m_s) / KILOMETRE_PER_HOUR_M_S),
                vy_km_h: over(&|case| known(case.error.rmse_vy_body_m_s) / KILOMETRE_PER_HOUR_M_S),
                yaw_rate_deg_s: over(&|case| known(case.error.rmse_yaw_rate_rad_s).to_degrees()),
            },
            final_heading_error_deg: over(&|case| {
                case.error.final_heading_error_rad.to_degrees().abs()
            }),
            horizon_error_m: std::array::from_fn(|i| {
                // NaN where a recording does not last as long.
                let errors = cases.iter().map(|case| case.error.horizon_error_m[i]);
                MeanStd::from_values(errors.filter(|error| !error.is_nan()))
            }),
            violations: cases.iter().map(|case| case.violations).sum(),
            time_per_step_us: over(&|case| case.time_per_step_us).median,
            coverage: CoverageMetrics::from_cases(cases),
        }
    }
}

impl CoverageMetrics {
    fn from_cases(cases: &[&MotionCaseMetrics]) -> Option<Self> {
        let all: Option<Vec<_>> = cases.iter().map(|case| case.coverage).collect();
        let all = all.filter(|all| !all.is_empty())?;
        let mean = |value: fn(&MotionCoverage) -> f64| {
            all.iter().map(value).sum::<f64>() / all.len() as f64
        };
        Some(Self {
            path_50: mean(|coverage| coverage.path_50),
            path_90: mean(|coverage| coverage.path_90),
            end_50: mean(|coverage| coverage.end_50),
            end_90: mean(|coverage| coverage.end_90),
            crps_x_m: mean(|coverage| coverage.crps_x_m),
            crps_y_m: mean(|coverage| coverage.crps_y_m),
            crps_yaw_deg: mean(|coverage| coverage.crps_yaw_rad).to_degrees(),
            energy_score_m: mean(|coverage| coverage.energy_score_m),
        })
    }
}
