//! Error metrics of a predicted motion against a reference, and violations of energy conservation.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::data::{
    Channel, SeriesError, TimeSeries, finite_or_null, finite_or_nulls, null_as_nan, nulls_as_nan,
};
use crate::numerics::{interpolate, wrap_angle_rad};
use crate::vehicle::VehicleParameters;

/// Times after the start at which the position error is reported, s.
pub const HORIZONS_S: [f64; 4] = [0.5, 1.0, 2.0, 4.0];

/// Errors of a predicted motion against a reference, evaluated at the reference's samples. JSON has
/// `null` for an error that is not finite, which that of a model whose motion diverges is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MotionError {
    /// Mean over the samples of the distance between the positions (X, Y), m.
    #[serde(serialize_with = "finite_or_null", deserialize_with = "null_as_nan")]
    #[schemars(with = "Option<f64>")]
    pub average_error_m: f64,
    /// Distance between the positions at the last sample, m.
    #[serde(serialize_with = "finite_or_null", deserialize_with = "null_as_nan")]
    #[schemars(with = "Option<f64>")]
    pub final_error_m: f64,
    /// Difference of yaw (prediction − reference) at the last sample, wrapped, rad.
    #[serde(serialize_with = "finite_or_null", deserialize_with = "null_as_nan")]
    #[schemars(with = "Option<f64>")]
    pub final_heading_error_rad: f64,
    /// Distance between the positions at each of [`HORIZONS_S`], m, linear between samples; NaN for
    /// a horizon more than a sample interval beyond the end of the reference.
    #[serde(serialize_with = "finite_or_nulls", deserialize_with = "nulls_as_nan")]
    #[schemars(with = "[Option<f64>; 4]")]
    pub horizon_error_m: [f64; 4],
    /// Root mean square error of X, m.
    #[serde(serialize_with = "finite_or_null", deserialize_with = "null_as_nan")]
    #[schemars(with = "Option<f64>")]
    pub rmse_x_m: f64,
    /// Root mean square error of Y, m.
    #[serde(serialize_with = "finite_or_null", deserialize_with = "null_as_nan")]
    #[schemars(with = "Option<f64>")]
    pub rmse_y_m: f64,
    /// Root mean square error of v_x, m/s; `None` unless both motions have it.
    #[serde(rename = "rmse_vx_m_s")]
    pub rmse_vx_body_m_s: Option<f64>,
    /// Root mean square error of v_y, m/s; `None` unless both motions have it.
    #[serde(rename = "rmse_vy_m_s")]
    pub rmse_vy_body_m_s: Option<f64>,
    /// Root mean square error of the yaw rate, rad/s; `None` unless both motions have it.
    pub rmse_yaw_rate_rad_s: Option<f64>,
}

impl MotionError {
    /// Compares `predicted` with `reference` at the times of the reference. The prediction is
    /// interpolated linearly; it may end one sample interval before the reference, over which its
    /// last value is held.
    ///
    /// # Errors
    /// [`SeriesError::Missing`] if X, Y or yaw is missing in either, [`SeriesError::TooShort`] if the
    /// prediction ends earlier.
    pub fn between(predicted: &TimeSeries, reference: &TimeSeries) -> Result<Self, SeriesError> {
        let time_s = reference.time_s();
        let (end_s, expected_s) = (end_s(predicted), end_s(reference));
        let interval_s = last_interval_s(reference).max(last_interval_s(predicted));
        let tolerance_s = interval_s * (1.0 + 1e-6);
        if expected_s > end_s + tolerance_s {
            return Err(SeriesError::TooShort { end_s, expected_s });
        }
        let difference = |channel| -> Result<Vec<f64>, SeriesError> {
            let (predicted, grid) = (predicted.require(channel)?, predicted.time_s());
            let pairs = time_s.iter().zip(reference.require(channel)?);
            Ok(pairs
                .map(|(&t, r)| interpolate(grid, predicted, t).unwrap_or(f64::NAN) - r)
                .collect())
        };
        let (dx, dy) = (difference(Channel::X)?, difference(Channel::Y)?);
        let distance: Vec<f64> = dx.iter().zip(&dy).map(|(x, y)| x.hypot(*y)).collect();
        let heading = difference(Channel::Yaw)?.last().copied().unwrap_or(f64::NAN);
        let at = |horizon_s: f64| {
            let is_within = horizon_s <= expected_s + tolerance_s;
            let found = is_within.then(|| interpolate(time_s, &distance, horizon_s)).flatten();
            found.unwrap_or(f64::NAN)
        };
        let optional = |channel| difference(channel).ok().map(|values| root_mean_square(&values));
        Ok(Self {
            average_error_m: distance.iter().sum::<f64>() / distance.len() as f64,
            final_error_m: distance.last().copied().unwrap_or(f64::NAN),
            final_heading_error_rad: wrap_angle_rad(heading),
            horizon_error_m: HORIZONS_S.map(at),
            rmse_x_m: root_mean_square(&dx),
            rmse_y_m: root_mean_square(&dy),
            rmse_vx_body_m_s: optional(Channel::Vx),
            rmse_vy_body_m_s: optional(Channel::Vy),
            rmse_yaw_rate_rad_s: optional(Channel::YawRate),
        })
    }
}

/// The last instant, s; −∞ without samples.
fn end_s(series: &TimeSeries) -> f64 {
    series.time_s().last().copied().unwrap_or(f64::NEG_INFINITY)
}

/// Time between the last two samples, s; 0 for fewer.
fn last_interval_s(series: &TimeSeries) -> f64 {
    match series.time_s() {
        [.., before, last] => last - before,
        _ => 0.0,
    }
}

/// Growth of kinetic energy from one sample to the next that counts as a violation, as a share of
/// the initial energy. It is far above rounding errors and the energy that passes from roll to yaw
/// through I_xz, and far below what is visible in a plot.
const VIOLATION_SHARE: f64 = 1e-4;

/// Number of samples after which the planar kinetic energy grows without a force on the vehicle. A
/// sample i counts if the contact force is zero over the interval from i to i + 1 while
///
/// ```text
/// E = m (v_x² + v_y²)/2 + I_zz r²/2        E(i + 1) − E(i) > 10⁻⁴ E(0)
/// ```
///
/// The force columns hold means over the interval that follows the sample, as in
/// [`Motion`](crate::vehicle::Motion).
///
/// # Errors
/// [`SeriesError::Missing`] without velocities, yaw rate or force in body axes.
pub fn physical_violations(
    motion: &TimeSeries,
    vehicle: &VehicleParameters,
) -> Result<usize, SeriesError> {
    let [vx, vy, rate, fx, fy] =
        [Channel::Vx, Channel::Vy, Channel::YawRate, Channel::FxBody, Channel::FyBody]
            .map(|channel| motion.require(channel));
    let (vx, vy, rate, fx, fy) = (vx?, vy?, rate?, fx?, fy?);
    let (mass, inertia) = (vehicle.mass.mass_kg, vehicle.mass.yaw_inertia_kg_m2);
    let energy: Vec<f64> = vx
        .iter()
        .zip(vy)
        .zip(rate)
        .map(|((vx, vy), r)| (mass * (vx * vx + vy * vy) + inertia * r * r) / 2.0)
        .collect();
    let limit = VIOLATION_SHARE * energy.first().copied().unwrap_or(0.0);
    let steps = energy.windows(2).zip(fx.iter().zip(fy));
    let grows = |pair: &[f64]| pair[1] - pair[0] > limit;
    Ok(steps.filter(|(pair, (fx, fy))| **fx == 0.0 && **fy == 0.0 && grows(pair)).count())
}

fn root_mean_square(values: &[f64]) -> f64 {
    (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt()
}

/// Largest deviation of yaw from its initial value, to either side, rad.
///
/// # Errors
/// [`SeriesError::Missing`] without a yaw column.
pub fn largest_yaw_change_rad(motion: &TimeSeries) -> Result<f64, SeriesError> {
    let yaw = motion.require(Channel::Yaw)?;
    let first = yaw.first().copied().unwrap_or(0.0);
    Ok(yaw.iter().fold(0.0, |largest, yaw| (yaw - first).abs().max(largest)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn motion(offset_m: f64, yaw_rad: f64) -> TimeSeries {
        let time_s: Vec<f64> = (0..=400).map(|i| f64::from(i) * 0.01).collect();
        let mut series = TimeSeries::new(time_s.clone()).unwrap();
        series.insert(Channel::X, time_s.iter().map(|t| 10.0 * t).collect()).unwrap();
        series.insert(Channel::Y, time_s.iter().map(|t| offset_m * t).collect()).unwrap();
        series.insert(Channel::Yaw, vec![yaw_rad; 401]).unwrap();
        series
    }

    #[test]
    fn a_steadily_growing_offset_has_known_figures() {
        let error = MotionError::between(&motion(0.5, 6.2), &motion(0.0, 0.0)).unwrap();
        assert!((error.average_error_m - 1.0).abs() < 1e-12);
        assert!((error.final_error_m - 2.0).abs() < 1e-12);
        assert!((error.final_heading_error_rad - (6.2 - std::f64::consts::TAU)).abs() < 1e-12);
        for (got, expected) in error.horizon_error_m.iter().zip([0.25, 0.5, 1.0, 2.0]) {
            assert!((got - expected).abs() < 1e-12);
        }
        assert_eq!((error.rmse_x_m, error.rmse_vx_body_m_s), (0.0, None));
    }

    /// The first samples of a motion.
    fn cut(motion: &TimeSeries, n_samples: usize) -> TimeSeries {
        let mut cut = TimeSeries::new(motion.time_s()[..n_samples].to_vec()).unwrap();
        for channel in motion.channels() {
            cut.insert(channel, motion.get(channel).unwrap()[..n_samples].to_vec()).unwrap();
        }
        cut
    }

    #[test]
    fn a_horizon_that_the_recording_does_not_reach_has_no_error() {
        let (predicted, reference) = (motion(0.5, 0.0), motion(0.0, 0.0));
        let error = MotionError::between(&predicted, &cut(&reference, 150)).unwrap();
        let [half, one, two, four] = error.horizon_error_m;
        assert!((half - 0.25).abs() < 1e-12 && (one - 0.5).abs() < 1e-12, "{half} {one}");
        assert!(two.is_nan() && four.is_nan(), "{two} {four}");
        // The recordings of the data sets end at 3.99 s.
        let error = MotionError::between(&predicted, &cut(&reference, 400)).unwrap();
        assert!((error.horizon_error_m[3] - 0.5 * 3.99).abs() < 1e-12, "{error:?}");
    }

    #[test]
    fn a_prediction_that_ends_before_the_recording_is_no_prediction_of_it() {
        let reference = motion(0.0, 0.0);
        let error = MotionError::between(&cut(&reference, 300), &reference).unwrap_err();
        assert_eq!(error, SeriesError::TooShort { end_s: 2.99, expected_s: 4.0 });
        assert!(MotionError::between(&cut(&reference, 400), &reference).is_ok());
    }

    #[test]
    fn energy_that_grows_without_a_force_is_counted() {
        let vehicle = crate::vehicle::Preset::Reference.parameters();
        let mut series = TimeSeries::new(vec![0.0, 0.01, 0.02, 0.03]).unwrap();
        // The energy grows under force, grows without force, and falls without force.
        for (channel, values) in [
            (Channel::Vx, vec![10.0, 11.0, 11.5, 11.4]),
            (Channel::Vy, vec![0.0; 4]),
            (Channel::YawRate, vec![0.0; 4]),
            (Channel::FxBody, vec![5e3, 0.0, 0.0, 0.0]),
            (Channel::FyBody, vec![0.0; 4]),
        ] {
            series.insert(channel, values).unwrap();
        }
        assert_eq!(physical_violations(&series, &vehicle), Ok(1));
    }

    #[test]
    fn a_motion_without_position_is_refused() {
        let bare = TimeSeries::new(vec![0.0]).unwrap();
        assert!(MotionError::between(&motion(0.0, 0.0), &bare).is_err());
    }
}
