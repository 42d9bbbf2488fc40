//! Outlines of vehicles in plan view: rectangles of the outer length and width.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::collision::polygon::clip;
use crate::data::{Channel, TimeSeries};
use crate::numerics::{interpolate, polygon_area};
use crate::ranges::OFF_OUTLINE;
use crate::vehicle::{GeometryParameters, VehicleParameters, VehicleState};

/// Smallest area that an outline and a lane share, m².
const LEAST_SHARED_M2: f64 = 5e-7;

/// Share of the width by which another side may be farther from a contact point than the nearest one and be
/// touched as well, as at a corner.
const CORNER_SHARE: f64 = 0.15;
/// Least share of a force that points out of a side, so that it pulls: 10° off the direction of the side.
const LEAST_PULL: f64 = 0.17;

/// Position and heading of a vehicle in world axes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// X coordinate of the centre of gravity (CG) in world axes, m.
    pub x_m: f64,
    /// Y coordinate of the CG in world axes, m.
    pub y_m: f64,
    /// Heading (yaw angle ψ) in world axes, rad, counter-clockwise positive.
    pub yaw_rad: f64,
}

/// Outline of a vehicle in plan view: a rectangle whose sides are parallel to the body axes, with
/// the CG midway between the left and the right side.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Footprint {
    /// Outer length of the vehicle, m, more than 0.
    pub length_m: f64,
    /// Outer width of the vehicle, m, more than 0.
    pub width_m: f64,
    /// Distance from the front of the outline back to the CG, m, 0 to `length_m`.
    pub cg_from_front_m: f64,
}

/// One of the four sides of the outline of a vehicle.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Hash,
    Serialize,
    Deserialize,
    strum::IntoStaticStr,
    JsonSchema,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum Side {
    /// The front of the vehicle, with the outward normal along +x of the body axes.
    Front,
    /// The left side of the vehicle, with the outward normal along +y of the body axes.
    Left,
    /// The rear of the vehicle, with the outward normal along −x of the body axes.
    Rear,
    /// The right side of the vehicle, with the outward normal along −y of the body axes.
    Right,
}

/// Reason why no contact can be computed from two outlines.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FootprintError {
    /// The outlines are further apart than [`TOUCH_TOLERANCE_M`](crate::collision::TOUCH_TOLERANCE_M), or have no common area.
    #[error("the vehicles are {gap_m:.3} m apart")]
    Apart {
        /// Gap between the outlines along the axis on which they are furthest apart, m.
        gap_m: f64,
    },
    /// The outlines overlap so deeply that the side that was struck cannot be determined.
    #[error(
        "the outlines overlap by {depth_m:.3} m, {time_s:.2} s of their approach: which side was \
         struck cannot be determined; place the striking vehicle where it first touches, or give \
         contact point and normal"
    )]
    TooDeep {
        /// Overlap along the normal of first contact, m.
        depth_m: f64,
        /// How long ago the vehicles first touched at their relative velocity, s.
        time_s: f64,
    },
    /// A number is out of range: an outline has no area, the CG lies outside the outline, or a pose
    /// is not finite.
    #[error("{name} is {value}, expected {expected}")]
    Range {
        /// Name of the field.
        name: &'static str,
        /// Value of the field, m (`yaw_rad`: rad).
        value: f64,
        /// Description of the permitted range.
        expected: &'static str,
    },
}

/// A contact point that lies off the vehicle.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "the contact point ({x_body_m:.3} m, {y_body_m:.3} m from the CG) lies {distance_m:.3} m off the outline, \
     expected {allowed_m:.3} m at most"
)]
pub struct OffOutline {
    /// Coordinate x of the point in body axes, m.
    pub x_body_m: f64,
    /// Coordinate y of the point in body axes, m.
    pub y_body_m: f64,
    /// Distance from the outline, m.
    pub distance_m: f64,
    /// Largest permitted distance, m.
    pub allowed_m: f64,
}

impl Pose {
    /// The pose of a vehicle in a state.
    pub fn from_state(state: &VehicleState<f64>) -> Self {
        Self { x_m: state.x_m, y_m: state.y_m, yaw_rad: state.yaw_rad }
    }

    /// The pose in a motion at a time, interpolated linearly, beyond its ends that at the nearer one. The
    /// heading is 0 without a yaw channel; `None` without X or Y.
    pub fn from_motion(motion: &TimeSeries, time_s: f64) -> Option<Self> {
        let at = |channel| interpolate(motion.time_s(), motion.get(channel)?, time_s);
        let yaw_rad = at(Channel::Yaw).unwrap_or(0.0);
        Some(Self { x_m: at(Channel::X)?, y_m: at(Channel::Y)?, yaw_rad })
    }

    /// Transforms a point from body axes (origin at the CG) to world axes, m.
    pub fn world_from_body(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = self.yaw_rad.sin_cos();
        [self.x_m + x * cos - y * sin, self.y_m + x * sin + y * cos]
    }

    /// Transforms a point from world axes to body axes (origin at the CG), m.
    pub fn body_from_world(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = self.yaw_rad.sin_cos();
        let (dx, dy) = (x - self.x_m, y - self.y_m);
        [dx * cos + dy * sin, dy * cos - dx * sin]
    }
}

impl Side {
    /// All four sides, counter-clockwise from the front.
    pub const ALL: [Self; 4] = [Self::Front, Self::Left, Self::Rear, Self::Right];

    /// Name of the side in scenario files.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// Name of the side in sentences.
    pub fn label(self) -> &'static str {
        match self {
            Self::Front => "front",
            Self::Left => "left side",
            Self::Rear => "rear",
            Self::Right => "right side",
        }
    }

    /// Angle of the outward normal of the side in body axes, rad, counter-clockwise from +x.
    pub fn outward_angle_rad(self) -> f64 {
        let quarters = match self {
            Self::Front => 0.0,
            Self::Left => 1.0,
            Self::Rear => 2.0,
            Self::Right => -1.0,
        };
        quarters * std::f64::consts::FRAC_PI_2
    }
}

impl From<&GeometryParameters> for Footprint {
    fn from(geometry: &GeometryParameters) -> Self {
        Self {
            length_m: geometry.outer_length_m,
            width_m: geometry.outer_width_m,
            cg_from_front_m: geometry.cg_to_front_end_m,
        }
    }
}

impl Footprint {
    /// A vehicle with this outline; [`VehicleParameters::stated`] says which sizes are not those of its
    /// source any more.
    #[must_use]
    pub fn given_to(self, mut vehicle: VehicleParameters) -> VehicleParameters {
        let geometry = &mut vehicle.geometry;
        for (key, now_m, before_m) in [
            ("geometry.outer_length_m", self.length_m, &mut geometry.outer_length_m),
            ("geometry.outer_width_m", self.width_m, &mut geometry.outer_width_m),
            ("geometry.cg_to_front_end_m", self.cg_from_front_m, &mut geometry.cg_to_front_end_m),
        ] {
            let was_m = std::mem::replace(before_m, now_m);
            if (was_m - now_m).abs() > 1e-9 {
                let text = format!("said with the collision, instead of {was_m} m");
                vehicle.stated.insert(key.to_owned(), text);
                vehicle.estimates.remove(key);
            }
        }
        vehicle
    }

    /// Checks that the outline has an area and that the CG lies inside it.
    ///
    /// # Errors
    /// [`FootprintError::Range`] for the first field that is out of range.
    pub fn check(&self) -> Result<(), FootprintError> {
        let positive = |x: f64| x.is_finite() && x > 0.0;
        let inside = self.cg_from_front_m >= 0.0 && self.cg_from_front_m <= self.length_m;
        for (ok, name, value, expected) in [
            (positive(self.length_m), "length_m", self.length_m, "more than 0"),
            (positive(self.width_m), "width_m", self.width_m, "more than 0"),
            (inside, "cg_from_front_m", self.cg_from_front_m, "0 to length_m"),
        ] {
            if !ok {
                return Err(FootprintError::Range { name, value, expected });
            }
        }
        Ok(())
    }

    /// Corners of the outline in world axes, m, counter-clockwise: front left, rear left, rear
    /// right, front right.
    pub fn corners_m(&self, pose: &Pose) -> [[f64; 2]; 4] {
        let front = self.cg_from_front_m;
        let rear = front - self.length_m;
        let side = self.width_m / 2.0;
        [[front, side], [rear, side], [rear, -side], [front, -side]]
            .map(|corner| pose.world_from_body(corner))
    }

    /// Whether a part of an area lies below the outline.
    ///
    /// - `border_m`: corners `[X, Y]` of the area in world axes, in either sense.
    pub fn lies_over(&self, pose: &Pose, border_m: &[[f64; 2]]) -> bool {
        // What is clipped from an area around the outline has sides along it, but no area.
        polygon_area(&clip(border_m, &self.corners_m(pose))) > LEAST_SHARED_M2
    }

    /// Whether a part of a line lies below the outline.
    ///
    /// - `line_m`: points `[X, Y]` of the line in world axes.
    pub fn crosses(&self, pose: &Pose, line_m: &[[f64; 2]]) -> bool {
        let corners = self.corners_m(pose);
        line_m.windows(2).any(|part| clip(part, &corners).len() > 1)
    }

    /// Distance of a point from the outline, m; 0 for a point inside of it.
    ///
    /// - `[x, y]`: the point in body axes, m.
    pub fn distance_m(&self, [x, y]: [f64; 2]) -> f64 {
        let ahead = (x - self.cg_from_front_m).max(self.cg_from_front_m - self.length_m - x);
        let beside = y.abs() - self.width_m / 2.0;
        ahead.max(0.0).hypot(beside.max(0.0))
    }

    /// Checks that a contact point lies at the vehicle: inside the outline, where crushed vehicles
    /// touch, or outside of it by no more than a small share of the length ([`OFF_OUTLINE`]).
    ///
    /// - `[x_m, y_m]`: the point in body axes, m.
    ///
    /// # Errors
    /// [`OffOutline`] with the distance.
    pub fn check_contact(&self, [x_body_m, y_body_m]: [f64; 2]) -> Result<(), OffOutline> {
        let distance_m = self.distance_m([x_body_m, y_body_m]);
        let allowed_m = OFF_OUTLINE.high * self.length_m;
        if distance_m <= allowed_m {
            return Ok(());
        }
        Err(OffOutline { x_body_m, y_body_m, distance_m, allowed_m })
    }

    /// The side out of which a force pulls at a contact point; `None` if it pushes, as contacts do, or
    /// acts along the side. At a corner it pushes if it does so at one of the two sides.
    ///
    /// - `[x_m, y_m]`: the point in body axes, m.
    /// - `[fx, fy]`: the force or its impulse in body axes, in any unit.
    pub fn pulled_side(&self, [x_m, y_m]: [f64; 2], [fx, fy]: [f64; 2]) -> Option<Side> {
        let depth_m = |side: Side| match side {
            Side::Front => self.cg_from_front_m - x_m,
            Side::Left => self.width_m / 2.0 - y_m,
            Side::Rear => x_m - self.cg_from_front_m + self.length_m,
            Side::Right => self.width_m / 2.0 + y_m,
        };
        let outward = |side: Side| {
            let (sin, cos) = side.outward_angle_rad().sin_cos();
            fx * cos + fy * sin
        };
        let by_depth = |a: &Side, b: &Side| depth_m(*a).total_cmp(&depth_m(*b));
        let nearest = Side::ALL.into_iter().min_by(by_depth)?;
        let reach_m = depth_m(nearest) + CORNER_SHARE * self.width_m;
        let mut touched = Side::ALL.into_iter().filter(|side| depth_m(*side) <= reach_m);
        touched.all(|side| outward(side) > LEAST_PULL * fx.hypot(fy)).then_some(nearest)
    }

    /// Midpoint of a side in body axes, m.
    pub fn side_middle_m(&self, side: Side) -> [f64; 2] {
        let middle = self.cg_from_front_m - self.length_m / 2.0;
        match side {
            Side::Front => [self.cg_from_front_m, 0.0],
            Side::Left => [middle, self.width_m / 2.0],
            Side::Rear => [self.cg_from_front_m - self.length_m, 0.0],
            Side::Right => [middle, -self.width_m / 2.0],
        }
    }
}

/// An outline and poses for tests.
#[cfg(test)]
pub(super) mod examples {
    use super::{Footprint, Pose};

    pub(in crate::collision) const CAR: Footprint =
        Footprint { length_m: 4.8, width_m: 1.8, cg_from_front_m: 2.2 };

    pub(in crate::collision) fn pose(x_m: f64, y_m: f64, yaw_deg: f64) -> Pose {
        let yaw_rad = yaw_deg.to_radians();
        Pose { x_m, y_m, yaw_rad }
    }
}

#[cfg(test)]
mod tests {
    use super::examples::{CAR, pose};

    #[test]
    fn an_outline_lies_over_lanes_and_across_lines() {
        use crate::collision::{Footprint, Pose};
        let outline = Footprint { length_m: 4.0, width_m: 2.0, cg_from_front_m: 2.0 };
        let at = |x_m, y_m, yaw_rad| Pose { x_m, y_m, yaw_rad };
        // A lane with a bend, in both senses, and a line.
        let mut lane =
            vec![[-50.0, 2.0], [10.0, 2.0], [20.0, 12.0], [18.0, 14.0], [8.0, 5.0], [-50.0, 5.0]];
        for _ in 0..2 {
            assert!(!outline.lies_over(&at(0.0, 0.5, 0.0), &lane));
            assert!(outline.lies_over(&at(0.0, 1.5, 0.0), &lane));
            assert!(outline.lies_over(&at(0.0, 0.5, 0.7), &lane), "a corner");
            assert!(outline.lies_over(&at(0.0, 3.5, 0.0), &lane), "inside");
            assert!(!outline.lies_over(&at(17.0, 4.0, 0.0), &lane), "within the bend");
            lane.reverse();
        }
        let line = [[-50.0, 2.0], [50.0, 2.0], [50.0, -9.0]];
        assert!(outline.crosses(&at(0.0, 1.5, 0.0), &line));
        assert!(!outline.crosses(&at(0.0, 0.5, 0.0), &line));
    }

    #[test]
    fn a_force_pulls_where_it_points_out_of_the_side_that_is_touched() {
        use crate::collision::Side;
        for (point, force, side) in [
            ([-1.5, -0.9], [0.0, 40.0], None),
            ([-1.5, -0.9], [0.0, -40.0], Some(Side::Right)),
            // Friction along the side, larger than what presses.
            ([-1.5, -0.9], [-60.0, 40.0], None),
            ([-1.5, -0.9], [40.0, -5.0], None),
            ([2.2, 0.1], [30.0, 0.0], Some(Side::Front)),
            // At the rear left corner a force to the front pushes, whatever it does to the side.
            ([-2.5, 0.85], [20.0, 20.0], None),
            ([-2.5, 0.85], [-20.0, 20.0], Some(Side::Left)),
            // In the middle there is always a side that is pushed.
            ([0.0, 0.0], [0.0, 20.0], None),
            ([-1.5, -0.9], [0.0, 0.0], None),
        ] {
            assert_eq!(CAR.pulled_side(point, force), side, "{point:?} {force:?}");
        }
    }

    #[test]
    fn corners_run_counter_clockwise_from_the_front_left() {
        let corners = CAR.corners_m(&pose(10.0, 1.0, 90.0));
        let expected = [[9.1, 3.2], [9.1, -1.6], [10.9, -1.6], [10.9, 3.2]];
        for (corner, expected) in corners.into_iter().zip(expected) {
            assert!((corner[0] - expected[0]).abs() < 1e-12, "{corners:?}");
            assert!((corner[1] - expected[1]).abs() < 1e-12, "{corners:?}");
        }
    }
}
