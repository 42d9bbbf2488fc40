//! States of a vehicle from the samples of its log.

use schemars::JsonSchema;
use serde::Serialize;

use crate::response::motion_log::contact::find_contact;
use crate::response::motion_log::tracks::{LogWindow, TrackScales, Tracks};
use crate::response::{LogError, MotionLog};
use impactlab_core::data::{Channel, SeriesError};
use impactlab_core::numerics::TrackPoint;
use impactlab_core::vehicle::VehicleState;
use impactlab_core::vehicle::frames::{body_from_world, world_from_body};

/// Standard deviations of an angle, its rate and its acceleration before any sample, rad and s.
const ANGLE_PRIOR: [f64; 3] = [10.0, 10.0, 30.0];
/// Standard deviations of a position, its velocity and its acceleration before any sample, m and s.
const POSITION_PRIOR: [f64; 3] = [1e3, 60.0, 30.0];
/// Time before the first instant that is wanted from which samples of the log are used, s.
const RUN_IN_S: f64 = 2.0;

/// Noise of a log's channels, standard deviations.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct LogNoise {
    /// Noise of x and y, m.
    pub position_m: f64,
    /// Noise of v_x and v_y, m/s, where the log has them.
    pub velocity_m_s: Option<f64>,
    /// Noise of the yaw angle, rad.
    pub yaw_rad: f64,
    /// Noise of the yaw rate, rad/s, where the log has it.
    pub yaw_rate_rad_s: Option<f64>,
}

impl MotionLog {
    /// When the vehicle was struck, from its motion alone; `None` where it was not.
    ///
    /// - `impact_s`: first contact, s, where it is known.
    pub(super) fn contact(&self, impact_s: Option<f64>) -> Result<LogWindow, LogError> {
        let yaw = self.yaw().map_err(|source| self.lacks(source))?;
        let raw: Vec<f64> =
            yaw.samples.iter().flatten().filter(|s| s.order == 0).map(|s| s.value).collect();
        let positions = self.positions(&raw).map_err(|source| self.lacks(source))?;
        let groups = [(&yaw, yaw.start()), (&positions, positions.start())];
        Ok(find_contact(&groups, self.ends_s(), impact_s))
    }

    /// The states at some instants, s, rising; a roll angle that the log lacks is zero.
    pub(super) fn states_at(
        &self,
        times_s: &[f64],
        window: LogWindow,
    ) -> Result<(Vec<VehicleState<f64>>, LogNoise), LogError> {
        let lacks = |source| self.lacks(source);
        let from_s = times_s.first().map_or(f64::NEG_INFINITY, |first_s| first_s - RUN_IN_S);
        let smoothed = |tracks: &Tracks, scales: &TrackScales, at_s: &[f64]| {
            let points = tracks.smooth(scales, window, at_s);
            points.ok_or_else(|| LogError::NoMotion { path: self.path.clone() })
        };
        let of_time = self.series.time_s();
        let at_samples = of_time.get(of_time.partition_point(|t| *t < from_s)..).unwrap_or(of_time);
        let yaw = self.yaw().map_err(lacks)?.from(from_s);
        let yaw_scales = yaw.fit(window);
        let headings = smoothed(&yaw, &yaw_scales, at_samples)?;
        let headings: Vec<f64> = headings.iter().flatten().map(|at| at.mean[0]).collect();
        let before = vec![0.0; of_time.len() - at_samples.len()];
        let headings = [before, headings].concat();
        let positions = self.positions(&headings).map_err(lacks)?.from(from_s);
        let scales = positions.fit(window);
        let noise = LogNoise {
            position_m: scales.sample_std[0],
            velocity_m_s: self.velocity().map(|_| scales.sample_std[1]),
            yaw_rad: yaw_scales.sample_std[0],
            yaw_rate_rad_s: self.series.get(Channel::YawRate).map(|_| yaw_scales.sample_std[1]),
        };
        let headings = smoothed(&yaw, &yaw_scales, times_s)?;
        let mut states = states(&headings, &smoothed(&positions, &scales, times_s)?);
        if let Some(roll) = self.roll() {
            let roll = roll.from(from_s);
            let angles = smoothed(&roll, &roll.fit(window), times_s)?;
            for (state, at) in states.iter_mut().zip(angles.iter().flatten()) {
                [state.roll_rad, state.roll_rate_rad_s, _] = at.mean;
            }
        }
        Ok((states, noise))
    }

    fn lacks(&self, source: SeriesError) -> LogError {
        LogError::Series { path: self.path.clone(), source }
    }

    fn yaw(&self) -> Result<Tracks, SeriesError> {
        let yaw = self.series.require(Channel::Yaw)?;
        let rate = self.series.get(Channel::YawRate);
        let samples = Tracks::samples_of(self.series.time_s(), yaw, rate);
        Ok(Tracks { samples: vec![samples], prior_std: ANGLE_PRIOR })
    }

    fn roll(&self) -> Option<Tracks> {
        let roll = self.series.get(Channel::Roll)?;
        let rate = self.series.get(Channel::RollRate);
        let samples = Tracks::samples_of(self.series.time_s(), roll, rate);
        Some(Tracks { samples: vec![samples], prior_std: ANGLE_PRIOR })
    }

    /// v_x and v_y, which are of use together alone.
    fn velocity(&self) -> Option<[&[f64]; 2]> {
        Some([self.series.get(Channel::Vx)?, self.series.get(Channel::Vy)?])
    }

    /// - `headings_rad`: at each sample, to turn velocities by.
    fn positions(&self, headings_rad: &[f64]) -> Result<Tracks, SeriesError> {
        let velocities = self.velocity().map(|[vx, vy]| {
            let body = vx.iter().zip(vy).map(|(vx, vy)| [*vx, *vy]);
            let world = body.zip(headings_rad).map(|(v, yaw)| world_from_body(*yaw, v));
            world.collect::<Vec<[f64; 2]>>()
        });
        let track = |channel: Channel, axis: usize| {
            let along: Option<Vec<f64>> =
                velocities.as_ref().map(|v| v.iter().map(|v| v[axis]).collect());
            let values = self.series.require(channel)?;
            Ok(Tracks::samples_of(self.series.time_s(), values, along.as_deref()))
        };
        let samples = vec![track(Channel::X, 0)?, track(Channel::Y, 1)?];
        Ok(Tracks { samples, prior_std: POSITION_PRIOR })
    }
}

/// - `headings`: of one coordinate, `places`: of X and Y.
fn states(headings: &[Vec<TrackPoint>], places: &[Vec<TrackPoint>]) -> Vec<VehicleState<f64>> {
    let [yaw] = headings else { return Vec::new() };
    let [x, y] = places else { return Vec::new() };
    let state = |((yaw, x), y): ((&TrackPoint, &TrackPoint), &TrackPoint)| {
        let [yaw_rad, yaw_rate_rad_s, _] = yaw.mean;
        let [vx_body_m_s, vy_body_m_s] = body_from_world(yaw_rad, [x.mean[1], y.mean[1]]);
        let (x_m, y_m) = (x.mean[0], y.mean[0]);
        VehicleState {
            vx_body_m_s,
            vy_body_m_s,
            yaw_rad,
            yaw_rate_rad_s,
            x_m,
            y_m,
            ..VehicleState::default()
        }
    };
    yaw.iter().zip(x).zip(y).map(state).collect()
}
