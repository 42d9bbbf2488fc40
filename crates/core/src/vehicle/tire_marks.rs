//! Where and how strongly the tires of a moving vehicle mark the ground.
//!
//! A wheel leaves a mark where it moves faster than 1 m/s and is locked, or slides sideways by more than
//! 8°: tires reach their largest side force at slip angles of 6° to 10°, where the whole tread slides
//! ([`Brach2011`], tire marks).
//!
//! How dark and how wide a mark is drawn are rules of ours, which order marks and are not measured:
//!
//! ```text
//! darkness = min(1, ½ F_z/F_z0 · s · μ/0.8)        s = 1 of a locked wheel, else |w|/√(u² + w²)
//! width    = c (b |u| + ℓ |w|)/√(u² + w²)          c = 1 of a locked wheel, else (1 + s)/2
//! ```
//!
//! with the load F_z and its value F_z0 at rest, the friction μ of the ground, the velocity u in the
//! plane of the wheel and w across it, the width of the tire b, 0.65 rolling radii, and the length of its
//! contact patch ℓ, 0.6 rolling radii. A wheel that slides sideways marks with its outer shoulder first.
//! Not said: striations, scrubs where a wheel is dented, marks of rims, and what rain and time do.
//!
//! [`Brach2011`]: crate::bibliography::Brach2011

use schemars::JsonSchema;
use serde::Serialize;

use crate::data::{Channel, TimeSeries};
use crate::vehicle::frames::body_from_world;
use crate::vehicle::{ControlledVehicle, Wheel};

/// Slip angle beyond which a tire leaves a mark, rad: 8°.
pub const MARK_SLIP_RAD: f64 = 0.139_626_340_159_546_36;

/// Speed of the wheel above which it leaves a mark, m/s.
pub const MARK_SPEED_M_S: f64 = 1.0;

/// Gap that a mark may have, m.
pub const LARGEST_MARK_GAP_M: f64 = 1.0;

/// Load under which a wheel leaves no mark, as a share of that at rest.
const LEAST_LOAD_SHARE: f64 = 0.05;

/// Shortest mark that is told, m: less than a contact patch is none.
const LEAST_LENGTH_M: f64 = 0.2;

/// Friction of the ground on which a mark is as dark as its load and slip make it.
const DARK_FRICTION: f64 = 0.8;

/// Length of the contact patch over the rolling radius: 0.19 m for 0.31 m.
const PATCH_LENGTH_RATIO: f64 = 0.6;

/// What left most of a mark.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum TireMarkKind {
    /// A locked wheel.
    Locked,
    /// A wheel that slid sideways.
    SideSlip,
}

impl TireMarkKind {
    /// For a person.
    pub fn label(self) -> &'static str {
        match self {
            Self::Locked => "locked",
            Self::SideSlip => "side slip",
        }
    }
}

/// A point of a mark.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TireMarkPoint {
    /// When the wheel was there, s.
    pub time_s: f64,
    /// Place `[X, Y]` of the middle of the mark, m.
    pub place_m: [f64; 2],
    /// Width of the mark, m.
    pub width_m: f64,
    /// Darkness, 0 to 1; 0 in a gap of the mark.
    pub darkness: f64,
    /// Whether the wheel is locked.
    pub is_locked: bool,
}

/// A mark of one wheel.
#[derive(Debug, Clone, PartialEq)]
pub struct TireMark {
    /// The wheel that leaves it.
    pub wheel: Wheel,
    /// Points in the order of time, at least two.
    pub points: Vec<TireMarkPoint>,
}

impl TireMark {
    /// Length along the mark, m.
    pub fn length_m(&self) -> f64 {
        self.points.windows(2).map(piece_m).sum()
    }

    /// What left most of its length.
    pub fn kind(&self) -> TireMarkKind {
        let locked_m: f64 =
            self.points.windows(2).filter(|pair| pair[0].is_locked).map(piece_m).sum();
        match 2.0 * locked_m > self.length_m() {
            true => TireMarkKind::Locked,
            false => TireMarkKind::SideSlip,
        }
    }

    /// First and last point; `None` without points.
    pub fn ends(&self) -> Option<[&TireMarkPoint; 2]> {
        Some([self.points.first()?, self.points.last()?])
    }
}

/// Whether a wheel that moves so leaves a mark.
///
/// - `[u, w]`: velocity of its centre in its plane and across it, m/s.
pub fn leaves_mark([u, w]: [f64; 2], is_locked: bool) -> bool {
    u.hypot(w) > MARK_SPEED_M_S && (is_locked || w.abs() > u.abs() * MARK_SLIP_RAD.tan())
}

/// The marks of a motion, wheel by wheel in the order of time. Their ends are told to within an interval
/// of the samples.
///
/// - `series`: the motion, with at least X, Y and yaw. Velocities that it lacks follow from these, and
///   loads that it lacks are those at rest; front wheels whose steer angle it lacks are straight.
/// - returns no marks without X, Y or yaw.
pub fn tire_marks(series: &TimeSeries, vehicle: ControlledVehicle<'_>) -> Vec<TireMark> {
    let Some(track) = Track::from_series(series) else { return Vec::new() };
    Wheel::ALL.into_iter().flat_map(|wheel| marks_of_wheel(&track, vehicle, wheel)).collect()
}

fn piece_m(pair: &[TireMarkPoint]) -> f64 {
    let ([x0, y0], [x1, y1]) = (pair[0].place_m, pair[1].place_m);
    (x1 - x0).hypot(y1 - y0)
}

fn marks_of_wheel(
    track: &Track<'_>,
    vehicle: ControlledVehicle<'_>,
    wheel: Wheel,
) -> Vec<TireMark> {
    let mut marks: Vec<TireMark> = Vec::new();
    let mut points: Vec<TireMarkPoint> = Vec::new();
    // Points since the last one that is marked, which belong to the mark only if it goes on.
    let mut gap: Vec<TireMarkPoint> = Vec::new();
    let mut end = |points: &mut Vec<TireMarkPoint>, gap: &mut Vec<TireMarkPoint>| {
        gap.clear();
        let mark = TireMark { wheel, points: std::mem::take(points) };
        if mark.length_m() >= LEAST_LENGTH_M {
            marks.push(mark);
        }
    };
    for idx in 0..track.time_s.len() {
        let Some(point) = track.point(idx, vehicle, wheel) else { break };
        if point.darkness > 0.0 {
            points.append(&mut gap);
            points.push(point);
        } else if let Some(last) = points.last() {
            gap.push(point);
            if piece_m(&[*last, point]) > LARGEST_MARK_GAP_M {
                end(&mut points, &mut gap);
            }
        }
    }
    end(&mut points, &mut gap);
    marks
}

/// Columns of a motion.
struct Track<'a> {
    time_s: &'a [f64],
    /// X, Y and yaw.
    pose: [&'a [f64]; 3],
    /// Velocities along x and y in body axes, and yaw rate.
    rates: Option<[&'a [f64]; 3]>,
    steer_rad: [Option<&'a [f64]>; 2],
    loads_n: [Option<&'a [f64]>; 4],
}

impl<'a> Track<'a> {
    fn from_series(series: &'a TimeSeries) -> Option<Self> {
        let get = |channel| series.get(channel);
        let rates = [Channel::Vx, Channel::Vy, Channel::YawRate].map(get);
        Some(Self {
            time_s: series.time_s(),
            pose: [get(Channel::X)?, get(Channel::Y)?, get(Channel::Yaw)?],
            rates: match rates {
                [Some(vx), Some(vy), Some(yaw)] => Some([vx, vy, yaw]),
                _ => None,
            },
            steer_rad: [Channel::SteerFl, Channel::SteerFr].map(get),
            loads_n: [Channel::FzFl, Channel::FzFr, Channel::FzRl, Channel::FzRr].map(get),
        })
    }

    /// X, Y, m, and heading, rad, at a sample.
    fn pose(&self, idx: usize) -> Option<[f64; 3]> {
        let [x, y, yaw] = self.pose;
        Some([*x.get(idx)?, *y.get(idx)?, *yaw.get(idx)?])
    }

    /// Velocities in body axes, m/s, and yaw rate, rad/s, at a sample.
    fn rates(&self, idx: usize) -> Option<[f64; 3]> {
        if let Some([vx, vy, yaw]) = self.rates {
            return Some([*vx.get(idx)?, *vy.get(idx)?, *yaw.get(idx)?]);
        }
        let last = self.time_s.len().checked_sub(1)?;
        let (from, to) = (idx.saturating_sub(1), (idx + 1).min(last));
        let step_s = self.time_s.get(to)? - self.time_s.get(from)?;
        let ([x0, y0, yaw0], [x1, y1, yaw1]) = (self.pose(from)?, self.pose(to)?);
        if step_s <= 0.0 {
            return Some([0.0; 3]);
        }
        let [_, _, yaw] = self.pose(idx)?;
        let [vx, vy] = body_from_world(yaw, [(x1 - x0) / step_s, (y1 - y0) / step_s]);
        Some([vx, vy, (yaw1 - yaw0) / step_s])
    }

    /// The point of the ground under a wheel at a sample, with a darkness of 0 where it leaves no mark.
    fn point(
        &self,
        idx: usize,
        vehicle: ControlledVehicle<'_>,
        wheel: Wheel,
    ) -> Option<TireMarkPoint> {
        let (time_s, [x_m, y_m, yaw_rad]) = (*self.time_s.get(idx)?, self.pose(idx)?);
        let [vx, vy, yaw_rate] = self.rates(idx)?;
        let value = |column: Option<&[f64]>| column.and_then(|values| values.get(idx)).copied();
        let [x, y] = vehicle.vehicle.geometry.wheel_place_m(wheel);
        let (sin, cos) = yaw_rad.sin_cos();
        let place_m = [x_m + x * cos - y * sin, y_m + x * sin + y * cos];
        let steer_rad = match wheel {
            Wheel::FrontLeft => value(self.steer_rad[0]).unwrap_or(0.0),
            Wheel::FrontRight => value(self.steer_rad[1]).unwrap_or(0.0),
            Wheel::RearLeft | Wheel::RearRight => 0.0,
        };
        let velocity = body_from_world(steer_rad, [vx - yaw_rate * y, vy + yaw_rate * x]);
        let static_n = vehicle.vehicle.static_loads_n()[wheel.index()];
        let load_n = value(self.loads_n[wheel.index()]).unwrap_or(static_n);
        let is_locked = vehicle.is_locked(time_s, wheel, place_m, velocity, load_n);
        let load_share = load_n / static_n;
        let is_marked = leaves_mark(velocity, is_locked) && load_share > LEAST_LOAD_SHARE;
        let [along, across] = {
            let speed = velocity[0].hypot(velocity[1]).max(1e-9);
            velocity.map(|part| part.abs() / speed)
        };
        let slip_share = if is_locked { 1.0 } else { across };
        let friction = vehicle.tires_at(place_m).friction;
        let darkness = 0.5 * load_share * slip_share * friction / DARK_FRICTION;
        let tires = &vehicle.vehicle.tires;
        let patch_m = PATCH_LENGTH_RATIO * tires.rolling_radius_m;
        let of_tread = if is_locked { 1.0 } else { (1.0 + across) / 2.0 };
        Some(TireMarkPoint {
            time_s,
            place_m,
            width_m: of_tread * (along * tires.width_m() + across * patch_m),
            // A mark that is hardly seen is one all the same.
            darkness: if is_marked { darkness.clamp(1e-3, 1.0) } else { 0.0 },
            is_locked,
        })
    }
}

#[cfg(test)]
#[path = "tire_marks_tests.rs"]
mod tests;
