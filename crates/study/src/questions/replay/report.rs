//! What is told of a vehicle up to the first contact.

use impactlab_core::data::TimeSeries;
use impactlab_core::units::Estimate;
use impactlab_core::vehicle::frames::body_from_world;
use impactlab_core::vehicle::{PathPoint, RecordedMotion};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Answer;

pub use crate::questions::replay::yaw_rate::YawRateCheck;

/// Time between two places of the path in the report, s.
const PATH_STEP_S: f64 = 0.1;

/// Speed below which the velocity has no direction, m/s.
const LEAST_SPEED_M_S: f64 = 0.5;

/// Where the CG is at the first contact, and the heading.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ContactPose {
    /// X of the CG, m.
    pub x_m: f64,
    /// Y of the CG, m.
    pub y_m: f64,
    /// Heading, rad, to the left of X.
    pub yaw_rad: f64,
}

/// What a vehicle did up to the first contact, SI units. Time 0 is the first contact.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ReplayReport {
    /// Name of the recorder's file.
    pub name: String,
    /// What the file is.
    pub description: String,
    /// The event of several that is told; empty if the file says none.
    pub event: String,
    /// The vehicle.
    pub vehicle: String,
    /// Angle of the steering wheel over that of the road wheels.
    pub steering_ratio: f64,
    /// Its standard deviation.
    pub steering_ratio_sigma: f64,
    /// Standard deviation of the recorded speed, as a share of it.
    pub speed_sigma: f64,
    /// Peak friction of the road, median of the draws.
    pub friction: f64,
    /// First and last sample on the clock of the recorder, s.
    pub recorded_s: [f64; 2],
    /// Longest time that may lie between the last sample and the first contact, s.
    pub longest_gap_s: f64,
    /// The vehicle at the first contact.
    pub at_contact: ContactState,
    /// The way from the first sample to the first contact.
    pub travelled: Travelled,
    /// Where the vehicle is at the first contact, as it was asked.
    pub contact: ContactPose,
    /// Where it was at the first sample, so that it comes to that place.
    pub start: StartPose,
    /// The path that ends there.
    pub path: Vec<ReplayPoint>,
    /// The recorded samples beside the computed motion.
    pub samples: Vec<ReplaySample>,
    /// Largest horizontal acceleration over what the friction of the road allows.
    pub friction_use: Estimate,
    /// The recorded yaw rate against the computed one; none if none was recorded.
    pub yaw_rate: Option<YawRateCheck>,
    /// Draws of what is not known.
    pub draws: usize,
    /// Draws whose motion cannot be computed, which are left out.
    pub draws_left_out: usize,
}

/// A vehicle at the first contact.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ContactState {
    /// Speed of the CG, m/s.
    pub speed_m_s: Estimate,
    /// Velocity along the vehicle, m/s.
    pub vx_body_m_s: Estimate,
    /// Velocity to its left, m/s.
    pub vy_body_m_s: Estimate,
    /// Direction of the velocity to the left of the heading, rad; 0 below 0.5 m/s.
    pub sideslip_rad: Estimate,
    /// Yaw rate, rad/s to the left.
    pub yaw_rate_rad_s: Estimate,
}

/// The way from the first sample to the first contact, in the axes of the vehicle at the first sample.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Travelled {
    /// Distance ahead, m.
    pub ahead_m: Estimate,
    /// Distance to the left, m.
    pub left_m: Estimate,
    /// Turn to the left, rad.
    pub turn_rad: Estimate,
    /// Length of the path, m.
    pub length_m: Estimate,
}

/// Where a vehicle was at the first sample.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct StartPose {
    /// X of the CG, m.
    pub x_m: Estimate,
    /// Y of the CG, m.
    pub y_m: Estimate,
    /// Heading, rad.
    pub yaw_rad: Estimate,
}

/// A place of the path. The values are those of the recorded numbers as they are, the ranges hold 90 % of the
/// draws.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct ReplayPoint {
    /// Time, s, 0 at the first contact.
    pub time_s: f64,
    /// X of the CG, m.
    pub x_m: f64,
    /// Y of the CG, m.
    pub y_m: f64,
    /// Heading, rad.
    pub yaw_rad: f64,
    /// Velocity along the vehicle, m/s.
    pub vx_body_m_s: f64,
    /// Velocity to its left, m/s.
    pub vy_body_m_s: f64,
    /// Yaw rate, rad/s.
    pub yaw_rate_rad_s: f64,
    /// Range of X, m.
    pub x_range_m: [f64; 2],
    /// Range of Y, m.
    pub y_range_m: [f64; 2],
    /// Range of the heading, rad.
    pub yaw_range_rad: [f64; 2],
    /// Range of the distance to the left of this place, across this heading, m.
    pub left_range_m: [f64; 2],
}

/// A sample of the recorder beside the computed motion.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ReplaySample {
    /// Time on the clock of the recorder, s.
    pub recorder_time_s: f64,
    /// Recorded speed, m/s.
    pub recorded_speed_m_s: f64,
    /// Recorded angle of the steering wheel, rad, to the left.
    pub steering_wheel_rad: f64,
    /// Recorded yaw rate, rad/s to the left; none if none was recorded.
    pub recorded_yaw_rate_rad_s: Option<f64>,
    /// Computed velocity along the vehicle, m/s.
    pub vx_body_m_s: Estimate,
    /// Computed yaw rate, rad/s to the left.
    pub yaw_rate_rad_s: Estimate,
    /// Steer angle of the front road wheels that is imposed, rad, to the left.
    pub steer_rad: Estimate,
}

/// A vehicle up to the first contact, as it is answered.
#[derive(Debug, Clone, PartialEq)]
pub struct ReplayAnswer {
    /// What is told, with what restricts it and where it comes from.
    pub report: Answer<ReplayReport>,
    /// The motion of the recorded numbers as they are, every 10 ms from the first sample to the first contact.
    pub path: TimeSeries,
}

/// One draw of the motion, put so that it ends at the place of the contact.
#[derive(Debug, Clone)]
pub(super) struct DrawnMotion {
    pub end: PathPoint,
    pub start: PathPoint,
    pub length_m: f64,
    /// X, Y and heading at the times of the path.
    pub poses: Vec<[f64; 3]>,
    /// The vehicle at the samples.
    pub at_samples: Vec<DrawnSample>,
    /// Largest share of the friction that is used.
    pub friction_use: f64,
    pub steering_ratio: f64,
    /// Standard normal error of the recorded yaw rate as a factor of the computed one.
    pub yaw_rate_error: f64,
}

/// The vehicle of a draw at a sample of the recorder.
#[derive(Debug, Clone, Copy)]
pub(super) struct DrawnSample {
    pub vx_body_m_s: f64,
    pub yaw_rate_rad_s: f64,
    pub steer_rad: f64,
    /// Largest share of the friction that was used from the first sample on.
    pub friction_use: f64,
}

impl DrawnMotion {
    /// - `start_s`: when the first sample was taken in this draw;
    /// - `path_s`: times of the path;
    /// - `samples`: when each sample was taken in this draw, s, and the steer angle then, rad;
    /// - `steering_ratio`, `yaw_rate_error`: those of this draw.
    pub fn new(
        motion: &RecordedMotion,
        start_s: f64,
        path_s: &[f64],
        samples: impl Iterator<Item = [f64; 2]>,
        [steering_ratio, yaw_rate_error]: [f64; 2],
    ) -> Option<Self> {
        let pose = |time_s: &f64| {
            let point = motion.at(*time_s)?;
            Some([point.x_m, point.y_m, point.yaw_rad])
        };
        let sample = |[time_s, steer_rad]: [f64; 2]| {
            let PathPoint { vx_body_m_s, yaw_rate_rad_s, .. } = motion.at(time_s)?;
            let friction_use = motion.friction_use_until(time_s);
            Some(DrawnSample { vx_body_m_s, yaw_rate_rad_s, steer_rad, friction_use })
        };
        let from_start = motion.points.iter().filter(|point| point.time_s >= start_s);
        let start = motion.at(start_s)?;
        let places = std::iter::once([start.x_m, start.y_m]);
        let places: Vec<[f64; 2]> =
            places.chain(from_start.map(|point| [point.x_m, point.y_m])).collect();
        let step_m = |pair: &[[f64; 2]]| match pair {
            [[x, y], [to_x, to_y]] => (to_x - x).hypot(to_y - y),
            _ => 0.0,
        };
        Some(Self {
            end: motion.points.last().copied()?,
            start,
            length_m: places.windows(2).map(step_m).sum(),
            poses: path_s.iter().map(pose).collect::<Option<_>>()?,
            at_samples: samples.map(sample).collect::<Option<_>>()?,
            friction_use: motion.friction_use_until(0.0),
            steering_ratio,
            yaw_rate_error,
        })
    }
}

/// Times of the path in the report: the start, then every 0.1 s to the first contact.
pub(super) fn path_times_s(start_s: f64) -> Vec<f64> {
    let steps = (-start_s / PATH_STEP_S - 1e-6).floor().max(0.0) as usize;
    let later = (0..=steps).rev().map(|step| 0.0 - step as f64 * PATH_STEP_S);
    std::iter::once(start_s).chain(later.filter(|time_s| *time_s > start_s + 1e-6)).collect()
}

/// An estimate of a number of each draw.
pub(super) fn estimate(draws: &[DrawnMotion], of: impl Fn(&DrawnMotion) -> f64) -> Estimate {
    Estimate::from_draws(draws.iter().map(of).collect())
}

impl ContactState {
    pub(super) fn of(draws: &[DrawnMotion]) -> Self {
        let of = |value: fn(&PathPoint) -> f64| estimate(draws, |draw| value(&draw.end));
        Self {
            speed_m_s: of(|end| end.vx_body_m_s.hypot(end.vy_body_m_s)),
            vx_body_m_s: of(|end| end.vx_body_m_s),
            vy_body_m_s: of(|end| end.vy_body_m_s),
            sideslip_rad: of(|end| {
                let is_slow = end.vx_body_m_s.hypot(end.vy_body_m_s) < LEAST_SPEED_M_S;
                if is_slow { 0.0 } else { end.vy_body_m_s.atan2(end.vx_body_m_s) }
            }),
            yaw_rate_rad_s: of(|end| end.yaw_rate_rad_s),
        }
    }
}

impl Travelled {
    pub(super) fn of(draws: &[DrawnMotion]) -> Self {
        let way = |draw: &DrawnMotion| {
            let (start, end) = (&draw.start, &draw.end);
            body_from_world(start.yaw_rad, [end.x_m - start.x_m, end.y_m - start.y_m])
        };
        Self {
            ahead_m: estimate(draws, |draw| way(draw)[0]),
            left_m: estimate(draws, |draw| way(draw)[1]),
            turn_rad: estimate(draws, |draw| draw.end.yaw_rad - draw.start.yaw_rad),
            length_m: estimate(draws, |draw| draw.length_m),
        }
    }
}

impl StartPose {
    pub(super) fn of(draws: &[DrawnMotion]) -> Self {
        Self {
            x_m: estimate(draws, |draw| draw.start.x_m),
            y_m: estimate(draws, |draw| draw.start.y_m),
            yaw_rad: estimate(draws, |draw| draw.start.yaw_rad),
        }
    }
}

impl ReplayPoint {
    /// The path of the recorded numbers with the ranges of the draws.
    pub(super) fn path(
        central: &RecordedMotion,
        path_s: &[f64],
        draws: &[DrawnMotion],
    ) -> Vec<Self> {
        let point = |(idx, time_s): (usize, &f64)| {
            let at = central.at(*time_s)?;
            let range_of = |of: &dyn Fn(&[f64; 3]) -> f64| {
                let value = |draw: &DrawnMotion| draw.poses.get(idx).map(of);
                Estimate::from_draws(draws.iter().filter_map(value).collect()).ninety()
            };
            let range = |axis: usize| range_of(&|pose| pose[axis]);
            let left_m = |pose: &[f64; 3]| {
                let [_, left_m] = body_from_world(at.yaw_rad, [pose[0] - at.x_m, pose[1] - at.y_m]);
                left_m
            };
            Some(Self {
                time_s: *time_s,
                x_m: at.x_m,
                y_m: at.y_m,
                yaw_rad: at.yaw_rad,
                vx_body_m_s: at.vx_body_m_s,
                vy_body_m_s: at.vy_body_m_s,
                yaw_rate_rad_s: at.yaw_rate_rad_s,
                x_range_m: range(0),
                y_range_m: range(1),
                yaw_range_rad: range(2),
                left_range_m: range_of(&left_m),
            })
        };
        path_s.iter().enumerate().filter_map(point).collect()
    }
}
