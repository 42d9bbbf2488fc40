//! Compares the velocities of a recorded motion with its path, in order to tell velocities in body
//! axes from velocities in world axes.
//!
//! Over each window of time the velocity, turned into world axes if it is taken as one in body axes,
//! is integrated and compared with the displacement. The error of a pair of axes is the root mean
//! square of the differences over that of the displacements.

use std::fmt;

use crate::data::{Channel, TimeSeries, VelocityAxes};

/// Number of windows into which a motion is divided: enough to see a turn, and each long enough that
/// the noise of positions averages out.
const N_WINDOWS: usize = 12;

/// Error up to which velocities fit the path. Positions that are taken beside the centre of gravity
/// and the noise of receivers give some per cent.
pub(super) const FITTING: f64 = 0.2;

/// Ratio of the errors up to which both axes fit equally well, and errors up to which they do
/// whatever the ratio, as in straight motion along x.
const UNDECIDED: f64 = 2.0;
const BOTH_SMALL: f64 = 0.05;

/// What velocities in other units give, read in m/s, over the length of the path.
pub(super) const UNITS: [(f64, &str); 4] =
    [(3.6, "km/h"), (2.236_94, "mph"), (3.280_84, "ft/s"), (1000.0, "mm/s")];

/// Length of the path below which nothing is compared, m.
pub(super) const SHORTEST_PATH_M: f64 = 1.0;

/// The axes in which the velocities of a motion fit its path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum VelocityFit {
    /// In body axes.
    Body,
    /// In world axes.
    World,
    /// In both alike, because the vehicle heads along x.
    Both,
    /// In neither. The value is the length of the path that the velocities give over that which the
    /// positions give: 1 if only the directions differ.
    Neither(f64),
}

/// Finds the axes in which the velocities of a motion fit its path.
///
/// - `series`: as recorded, `vx` and `vy` not yet turned.
/// - returns `None` if positions, yaw angle or velocities are missing, or if the path is too short.
pub fn velocity_fit(series: &TimeSeries) -> Option<VelocityFit> {
    let get = |channel| series.get(channel);
    let path = [get(Channel::X)?, get(Channel::Y)?];
    let velocity = [get(Channel::Vx)?, get(Channel::Vy)?];
    let (yaw_rad, time_s) = (get(Channel::Yaw)?, series.time_s());
    let n_steps = time_s.len().checked_sub(1).filter(|n| *n >= N_WINDOWS)?;
    let (mut body, mut world, mut moved, mut speeds) = (0.0, 0.0, 0.0, [0.0; 2]);
    for window in 0..N_WINDOWS {
        let (from, to) = (window * n_steps / N_WINDOWS, (window + 1) * n_steps / N_WINDOWS);
        let moved_m = [path[0][to] - path[0][from], path[1][to] - path[1][from]];
        let (mut by_body, mut by_world) = ([0.0; 2], [0.0; 2]);
        for i in from..to {
            let half_step_s = (time_s[i + 1] - time_s[i]) / 2.0;
            for at in [i, i + 1] {
                let (vx, vy) = (velocity[0][at], velocity[1][at]);
                let (sin, cos) = yaw_rad[at].sin_cos();
                by_body[0] += half_step_s * (cos * vx - sin * vy);
                by_body[1] += half_step_s * (sin * vx + cos * vy);
                by_world[0] += half_step_s * vx;
                by_world[1] += half_step_s * vy;
            }
        }
        let difference = |by: [f64; 2]| (by[0] - moved_m[0]).hypot(by[1] - moved_m[1]);
        body += difference(by_body).powi(2);
        world += difference(by_world).powi(2);
        moved += moved_m[0].hypot(moved_m[1]).powi(2);
        speeds[0] += moved_m[0].hypot(moved_m[1]);
        speeds[1] += by_world[0].hypot(by_world[1]);
    }
    if speeds[0] < SHORTEST_PATH_M {
        return None;
    }
    let [body, world] = [body, world].map(|squares: f64| (squares / moved).sqrt());
    let fit = match (body < FITTING, world < FITTING) {
        (true, true) if body.max(world) < BOTH_SMALL.max(UNDECIDED * body.min(world)) => {
            VelocityFit::Both
        }
        (false, false) => VelocityFit::Neither(speeds[1] / speeds[0]),
        _ if body < world => VelocityFit::Body,
        _ => VelocityFit::World,
    };
    Some(fit)
}

/// The velocities in body axes of a motion whose velocities are in world axes; `None` if yaw angle or
/// velocities are missing.
pub(super) fn in_body_axes(series: &TimeSeries) -> Option<[Vec<f64>; 2]> {
    let get = |channel| series.get(channel);
    let yaw_rad = get(Channel::Yaw)?;
    let samples = get(Channel::Vx)?.iter().zip(get(Channel::Vy)?).zip(yaw_rad);
    let turned = samples.map(|((vx, vy), yaw_rad)| {
        let (sin, cos) = yaw_rad.sin_cos();
        (cos * vx + sin * vy, cos * vy - sin * vx)
    });
    let (vx, vy) = turned.unzip();
    Some([vx, vy])
}

impl VelocityFit {
    /// Whether velocities in these axes may be right.
    pub fn allows(self, axes: VelocityAxes) -> bool {
        match self {
            Self::Both => true,
            Self::Body => axes == VelocityAxes::Body,
            Self::World => axes == VelocityAxes::World,
            Self::Neither(_) => false,
        }
    }

    /// Says that the velocities do not fit the path.
    ///
    /// - `read_as`: the axes in which they were read.
    pub(super) fn explain(self, read_as: VelocityAxes, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (axes, other) = match read_as {
            VelocityAxes::Body => ("body", "world"),
            VelocityAxes::World => ("world", "body"),
        };
        match self {
            Self::Neither(ratio) if is_other_length(ratio) => {
                write!(
                    f,
                    "v_x and v_y contradict the path: they give {ratio:.2} times its length"
                )?;
                match UNITS.iter().find(|(factor, ..)| (ratio / factor - 1.0).abs() < FITTING) {
                    Some((_, unit)) => write!(f, ", as if {unit} were read as m/s"),
                    None => Ok(()),
                }
            }
            Self::Neither(_) => {
                write!(f, "v_x and v_y contradict the path in body axes and in world axes")
            }
            _ => {
                write!(f, "v_x and v_y were read as {axes} axes, but fit the path in {other} axes")
            }
        }
    }

    /// What can be done where no change of the map is known to help.
    pub(super) fn advice(self) -> &'static str {
        match self {
            Self::Neither(ratio) if is_other_length(ratio) => "check their unit",
            Self::Neither(_) => "check the directions of y and yaw",
            _ => "say in which axes they are",
        }
    }
}

/// Whether velocities give a path of another length than the positions do.
///
/// - `ratio`: that of the lengths.
pub(super) fn is_other_length(ratio: f64) -> bool {
    !(0.8..1.25).contains(&ratio)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A circle of 20 m radius at 10 m/s, with the velocities in body axes times `scale`.
    fn circle(scale: f64, heading_rad: f64) -> TimeSeries {
        let time_s: Vec<f64> = (0..200).map(|i| f64::from(i) * 0.02).collect();
        let sampled =
            |f: &dyn Fn(f64) -> f64| time_s.iter().map(|t| f(0.5 * t)).collect::<Vec<f64>>();
        let mut series = TimeSeries::new(time_s.clone()).unwrap();
        for (channel, values) in [
            (Channel::X, sampled(&|angle| 20.0 * (angle + heading_rad).sin())),
            (Channel::Y, sampled(&|angle| -20.0 * (angle + heading_rad).cos())),
            (Channel::Yaw, sampled(&|angle| angle + heading_rad)),
            (Channel::Vx, sampled(&|_| 10.0 * scale)),
            (Channel::Vy, sampled(&|_| 0.0)),
        ] {
            series.insert(channel, values).unwrap();
        }
        series
    }

    #[test]
    fn body_and_world_velocities_are_told_apart() {
        let body = circle(1.0, 0.3);
        assert_eq!(velocity_fit(&body), Some(VelocityFit::Body));
        let mut world = body.clone();
        let yaw = body.get(Channel::Yaw).unwrap().to_vec();
        world.insert(Channel::Vx, yaw.iter().map(|yaw| 10.0 * yaw.cos()).collect()).unwrap();
        world.insert(Channel::Vy, yaw.iter().map(|yaw| 10.0 * yaw.sin()).collect()).unwrap();
        assert_eq!(velocity_fit(&world), Some(VelocityFit::World));
        let [vx, vy] = in_body_axes(&world).unwrap();
        assert!(vx.iter().all(|v| (v - 10.0).abs() < 1e-9) && vy.iter().all(|v| v.abs() < 1e-9));
    }

    #[test]
    fn a_wrong_unit_and_a_straight_road_are_no_axes() {
        let Some(VelocityFit::Neither(ratio)) = velocity_fit(&circle(3.6, 0.0)) else {
            panic!("km/h fit as m/s");
        };
        assert!((ratio - 3.6).abs() < 0.1, "{ratio}");
        let mut straight = circle(1.0, 0.0);
        let time_s = straight.time_s().to_vec();
        straight.insert(Channel::X, time_s.iter().map(|t| 10.0 * t).collect()).unwrap();
        for channel in [Channel::Y, Channel::Yaw] {
            straight.insert(channel, vec![0.0; time_s.len()]).unwrap();
        }
        assert_eq!(velocity_fit(&straight), Some(VelocityFit::Both));
        // Steps that are exact, and a yaw that is hardly one.
        straight.insert(Channel::X, (0..200).map(|i| f64::from(i) * 0.2).collect()).unwrap();
        assert_eq!(velocity_fit(&straight), Some(VelocityFit::Both));
        straight.insert(Channel::Yaw, vec![0.01; time_s.len()]).unwrap();
        assert_eq!(velocity_fit(&straight), Some(VelocityFit::Both));
        straight.insert(Channel::X, vec![0.0; time_s.len()]).unwrap();
        assert_eq!(velocity_fit(&straight), None);
    }
}
