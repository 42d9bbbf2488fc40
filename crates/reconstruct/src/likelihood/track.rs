//! The path of a car with what the comparison with marks needs of it.

use impactlab_core::numerics::line_length;
use impactlab_core::vehicle::{Path, PathEnd, PathPoint};

/// Time between the points of a path that are kept, s.
const POINT_INTERVAL_S: f64 = 0.018;

/// Deceleration by which a motion that was not followed to its end is continued, m/s²: half of what a
/// dry road can bear. It only tells which of two motions that go too far goes farther.
const CONTINUED_DECELERATION_M_S2: f64 = 4.0;

/// A path with distances and angles along it.
#[derive(Debug, Clone)]
pub(crate) struct Track {
    pub points: Vec<PathPoint>,
    /// Distance travelled by the CG up to each point, m.
    pub travelled_m: Vec<f64>,
    /// Angle turned up to each point, rad.
    pub turned_rad: Vec<f64>,
    axes: Vec<[f64; 2]>,
    end: PathEnd,
}

/// Path of one wheel.
#[derive(Debug, Clone)]
pub(crate) struct WheelTrack {
    /// Its centre at each point, m.
    pub at_m: Vec<[f64; 2]>,
    /// Its velocity in the axes of the car, m/s.
    pub velocity_m_s: Vec<[f64; 2]>,
    /// Distance that it has travelled, m.
    pub travelled_m: Vec<f64>,
}

/// The place on a wheel's path that is nearest to a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Nearest {
    /// Point of the path before it.
    pub idx: usize,
    /// From the foot to the point, m.
    pub offset_m: [f64; 2],
    /// Direction of motion of the wheel.
    pub tangent: [f64; 2],
    /// Distance that the wheel has travelled, m.
    pub travelled_m: f64,
}

impl Track {
    /// `None` for a motion that could not be computed.
    pub fn from_path(path: &Path) -> Option<Self> {
        if path.end == PathEnd::Failed {
            return None;
        }
        let last = *path.points.last()?;
        let mut points: Vec<PathPoint> = Vec::with_capacity(path.points.len());
        for point in &path.points {
            let is_due = points
                .last()
                .is_none_or(|last: &PathPoint| point.time_s >= last.time_s + POINT_INTERVAL_S);
            if is_due {
                points.push(*point);
            }
        }
        if points.last() != Some(&last) {
            points.push(last);
        }
        let mut sums = [0.0; 2];
        let (mut travelled_m, mut turned_rad) = (vec![0.0], vec![0.0]);
        for pair in points.windows(2) {
            sums[0] += (pair[1].x_m - pair[0].x_m).hypot(pair[1].y_m - pair[0].y_m);
            sums[1] += (pair[1].yaw_rad - pair[0].yaw_rad).abs();
            travelled_m.push(sums[0]);
            turned_rad.push(sums[1]);
        }
        let axes = points.iter().map(|at| at.yaw_rad.sin_cos()).map(|(s, c)| [c, s]).collect();
        Some(Self { points, travelled_m, turned_rad, axes, end: path.end })
    }

    /// Distance travelled in all, m.
    pub fn whole_m(&self) -> f64 {
        self.travelled_m.last().copied().unwrap_or(0.0)
    }

    /// Where the car comes to rest: x, y, m, and heading, rad.
    pub fn rest(&self) -> [f64; 3] {
        let (Some(last), Some([cos, sin])) = (self.points.last(), self.axes.last()) else {
            return [f64::NAN; 3];
        };
        if self.end == PathEnd::Rest {
            return [last.x_m, last.y_m, last.yaw_rad];
        }
        let speed_m_s = last.vx_body_m_s.hypot(last.vy_body_m_s);
        let more_s = speed_m_s / (2.0 * CONTINUED_DECELERATION_M_S2);
        [
            last.x_m + (last.vx_body_m_s * cos - last.vy_body_m_s * sin) * more_s,
            last.y_m + (last.vx_body_m_s * sin + last.vy_body_m_s * cos) * more_s,
            last.yaw_rad,
        ]
    }

    /// State at a time, and the number of the point before it.
    pub fn at_time(&self, time_s: f64) -> Option<(usize, PathPoint)> {
        let after = self.points.partition_point(|point| point.time_s <= time_s);
        let before = after.saturating_sub(1);
        let (from, to) = (self.points.get(before)?, self.points.get(after));
        let Some(to) = to else { return Some((before, *from)) };
        Some((before, from.towards(to, time_s)))
    }

    /// Change of velocity of a point of the car in its heading axes up to a time, m/s: the integral of
    /// the acceleration that a recorder there measures.
    ///
    /// ```text
    /// Δv = ∫ (dv_s/dt + r e_z × v_s) dt        v_s = v + r e_z × ρ
    /// ```
    ///
    /// - `sensor_m`: ρ, from the CG.
    pub fn recorded_delta_v_m_s(&self, sensor_m: [f64; 2], end_s: f64) -> Option<[f64; 2]> {
        let velocity = |at: &PathPoint| {
            let [x_m, y_m] = sensor_m;
            [at.vx_body_m_s - at.yaw_rate_rad_s * y_m, at.vy_body_m_s + at.yaw_rate_rad_s * x_m]
        };
        let (last, end) = self.at_time(end_s)?;
        let first = velocity(self.points.first()?);
        let mut sums = [0.0; 2];
        let states = self.points[..=last].iter().chain([&end]);
        let mut before: Option<&PathPoint> = None;
        for at in states {
            if let Some(from) = before {
                let half_s = (at.time_s - from.time_s) / 2.0;
                for state in [from, at] {
                    let [vx, vy] = velocity(state);
                    sums[0] -= state.yaw_rate_rad_s * vy * half_s;
                    sums[1] += state.yaw_rate_rad_s * vx * half_s;
                }
            }
            before = Some(at);
        }
        let [vx, vy] = velocity(&end);
        Some([vx - first[0] + sums[0], vy - first[1] + sums[1]])
    }

    /// From the CG to a wheel at a point, world axes, m.
    pub fn arm_m(&self, idx: usize, [x_m, y_m]: [f64; 2]) -> [f64; 2] {
        let [cos, sin] = self.axes[idx];
        [x_m * cos - y_m * sin, x_m * sin + y_m * cos]
    }

    /// Path of a wheel.
    pub fn wheel(&self, place_m: [f64; 2]) -> WheelTrack {
        let arms = (0..self.points.len()).map(|idx| self.arm_m(idx, place_m));
        let at_m: Vec<[f64; 2]> =
            self.points.iter().zip(arms).map(|(at, [x, y])| [at.x_m + x, at.y_m + y]).collect();
        let mut sum = 0.0;
        let mut travelled_m = vec![0.0];
        travelled_m.extend(at_m.windows(2).map(|pair| {
            sum += line_length(pair);
            sum
        }));
        let velocity_m_s = self
            .points
            .iter()
            .map(|at| {
                let r = at.yaw_rate_rad_s;
                [at.vx_body_m_s - r * place_m[1], at.vy_body_m_s + r * place_m[0]]
            })
            .collect();
        WheelTrack { at_m, velocity_m_s, travelled_m }
    }
}

impl WheelTrack {
    /// The places on the path that are nearest to points in the order of time.
    pub fn nearest(&self, points_m: &[[f64; 2]]) -> Vec<Nearest> {
        let mut found: Vec<Nearest> = Vec::with_capacity(points_m.len());
        let mut from = 0;
        let mut until_m = f64::INFINITY;
        for (k, &point) in points_m.iter().enumerate() {
            let nearest = self.nearest_in(point, from, until_m);
            from = nearest.idx;
            if let Some(&[x, y]) = points_m.get(k + 1) {
                let apart_m = (x - point[0]).hypot(y - point[1]);
                until_m = nearest.travelled_m + 2.0 * apart_m + 3.0;
            }
            found.push(nearest);
        }
        found
    }

    fn nearest_in(&self, [x, y]: [f64; 2], from: usize, until_m: f64) -> Nearest {
        let squared = |at: &[f64; 2]| (at[0] - x).powi(2) + (at[1] - y).powi(2);
        let (mut best, mut least) = (from, f64::INFINITY);
        for idx in from..self.at_m.len() {
            if self.travelled_m[idx] > until_m && idx > from {
                break;
            }
            let distance = squared(&self.at_m[idx]);
            if distance < least {
                (best, least) = (idx, distance);
            }
        }
        let before = best.saturating_sub(1);
        let mut nearest = self.foot([x, y], before);
        if best + 1 < self.at_m.len() && best > before {
            let after = self.foot([x, y], best);
            let size = |nearest: &Nearest| nearest.offset_m[0].hypot(nearest.offset_m[1]);
            if size(&after) < size(&nearest) {
                nearest = after;
            }
        }
        nearest
    }

    /// Foot of a point on the piece of the path after point `idx`.
    fn foot(&self, [x, y]: [f64; 2], idx: usize) -> Nearest {
        let last = self.at_m.len() - 1;
        let (a, b) = (self.at_m[idx], self.at_m[(idx + 1).min(last)]);
        let piece = [b[0] - a[0], b[1] - a[1]];
        let length = piece[0].hypot(piece[1]);
        let share = match length > 1e-9 {
            true => (((x - a[0]) * piece[0] + (y - a[1]) * piece[1]) / (length * length))
                .clamp(0.0, 1.0),
            false => 0.0,
        };
        let tangent = match length > 1e-9 {
            true => piece.map(|part| part / length),
            false => self.tangent_before(idx),
        };
        Nearest {
            idx,
            offset_m: [x - a[0] - share * piece[0], y - a[1] - share * piece[1]],
            tangent,
            travelled_m: self.travelled_m[idx] + share * length,
        }
    }

    /// Direction of the last motion before a point at which the wheel rests.
    fn tangent_before(&self, idx: usize) -> [f64; 2] {
        let moved = self.at_m[..=idx].windows(2).rev().find_map(|pair| {
            let piece = [pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]];
            let length = piece[0].hypot(piece[1]);
            (length > 1e-9).then(|| piece.map(|part| part / length))
        });
        moved.unwrap_or([1.0, 0.0])
    }
}
