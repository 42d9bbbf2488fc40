//! Contact point and contact normal of two vehicles from their outlines in plan view.
//!
//! Assumptions: the vehicles are at first contact, or overlap as in the course of a contact that
//! began a moment ago at their present velocities. Rounded corners, wheels and crush are left out.
//!
//! Source: the test for overlap is that of separating axes of two rectangles
//! ([`Gottschalk1996`](crate::bibliography::Gottschalk1996)).

use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::collision::polygon::{centroid, clip, direction, dot, reach};
use crate::collision::{Footprint, FootprintError, Pose, Side};

/// Largest gap between the outlines at which the vehicles still count as touching, m. Poses that
/// are measured from photographs or video are no more accurate than this.
pub const TOUCH_TOLERANCE_M: f64 = 0.02;

/// Overlap to which vehicles that barely touch are pushed together before the polygon of their
/// overlap is computed, m.
const PROBE_DEPTH_M: f64 = 1e-3;

/// Longest time since first contact for which the relative velocity still tells which side was
/// struck, s. Vehicles are in contact for 0.1 to 0.15 s; the shipped finite-element runs for 0.116 s.
pub const MAX_APPROACH_TIME_S: f64 = 0.2;

/// Closing speed below which vehicles do not approach each other, m/s.
const MIN_CLOSING_M_S: f64 = 1e-6;

/// The side to which the contact normal is perpendicular, and the vehicle to which it belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum StruckSurface {
    /// A side of the struck vehicle, which is struck by a corner or a side of the striking vehicle.
    #[serde(rename = "target")]
    Struck(Side),
    /// A side of the striking vehicle, into which a corner of the struck vehicle penetrates.
    #[serde(rename = "bullet")]
    Striking(Side),
}

impl fmt::Display for StruckSurface {
    /// Where the normal points, for a person.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Struck(side) => write!(f, "into the struck vehicle's {}", side.label()),
            Self::Striking(side) => write!(f, "out of the striking vehicle's {}", side.label()),
        }
    }
}

/// Contact of two vehicles: contact point, contact normal and overlap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Contact point in world axes, m.
    pub point_world_m: [f64; 2],
    /// Angle Γ of the contact normal in world axes, rad. The normal points INTO the struck vehicle.
    pub normal_angle_world_rad: f64,
    /// Overlap of the outlines along the normal, m. A negative value is the gap between them.
    pub depth_m: f64,
    /// The side to which the normal is perpendicular.
    pub surface: StruckSurface,
}

/// An outline in motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MovingFootprint {
    /// Outline of the vehicle.
    pub footprint: Footprint,
    /// Its position and heading.
    pub pose: Pose,
    /// Velocity of the CG in world axes, m/s.
    pub velocity_world_m_s: [f64; 2],
    /// Yaw rate, rad/s.
    pub yaw_rate_rad_s: f64,
}

impl MovingFootprint {
    /// An outline that does not move.
    pub fn at_rest(footprint: Footprint, pose: Pose) -> Self {
        Self { footprint, pose, velocity_world_m_s: [0.0; 2], yaw_rate_rad_s: 0.0 }
    }

    /// Velocity of a point of the vehicle, m/s.
    ///
    /// - `[x, y]`: the point in world axes, m.
    fn velocity_at_m_s(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [vx, vy] = self.velocity_world_m_s;
        let rate = self.yaw_rate_rad_s;
        [vx - rate * (y - self.pose.y_m), vy + rate * (x - self.pose.x_m)]
    }

    fn check(&self) -> Result<(), FootprintError> {
        self.footprint.check()?;
        let Pose { x_m, y_m, yaw_rad } = self.pose;
        let [vx, vy] = self.velocity_world_m_s;
        for (value, name) in [
            (x_m, "x_m"),
            (y_m, "y_m"),
            (yaw_rad, "yaw_rad"),
            (vx, "velocity_m_s[0]"),
            (vy, "velocity_m_s[1]"),
            (self.yaw_rate_rad_s, "yaw_rate_rad_s"),
        ] {
            if !value.is_finite() {
                let expected = "a finite number";
                return Err(FootprintError::Range { name, value, expected });
            }
        }
        Ok(())
    }

    fn corners_m(&self) -> [[f64; 2]; 4] {
        self.footprint.corners_m(&self.pose)
    }
}

/// A side with the overlap along its normal.
#[derive(Clone, Copy)]
struct Candidate {
    depth_m: f64,
    /// Into the struck vehicle.
    normal_world: [f64; 2],
    surface: StruckSurface,
}

/// Overlap of two outlines along the axis on which it is smallest, m; negative for a gap. Outlines
/// overlap if and only if it is positive.
pub fn overlap_m(struck: &MovingFootprint, striking: &MovingFootprint) -> f64 {
    candidates(struck, striking)
        .map(|candidate| candidate.depth_m)
        .into_iter()
        .fold(f64::INFINITY, f64::min)
}

/// Centroid of the overlap of two outlines in world axes, m; `None` if they do not overlap.
pub fn overlap_centre_m(struck: &MovingFootprint, striking: &MovingFootprint) -> Option<[f64; 2]> {
    centroid(&clip(&struck.corners_m(), &striking.corners_m()))
}

/// Finds the contact of two vehicles that touch or overlap.
///
/// Outlines that touch, with an overlap up to [`TOUCH_TOLERANCE_M`], have the normal of that side,
/// of either vehicle, along whose normal the overlap is smallest; if two sides are equal, a side of
/// the struck vehicle is preferred. Outlines that overlap more are moved back along the relative
/// velocity at the contact point to where they first touched: the normal is that of the side whose
/// overlap divided by its closing speed is smallest,
///
/// ```text
/// min over sides with v_rel·n > 0 of depth / (v_rel·n)
/// ```
///
/// so that it never points against the approach. Without a relative velocity the smallest overlap
/// decides.
///
/// The contact point is the centroid of the overlap. Outlines that overlap by less than 1 mm, or
/// that have a gap up to [`TOUCH_TOLERANCE_M`], are first pushed together to an overlap of 1 mm. Two
/// parallel sides therefore touch in the middle of their common length, and a corner touches at the
/// corner.
///
/// - returns the contact in world axes.
///
/// # Errors
/// [`FootprintError::Apart`] if the gap is larger than [`TOUCH_TOLERANCE_M`] or the outlines have
/// no common area; [`FootprintError::TooDeep`] if the vehicles have passed each other along the
/// normal, or if the side of first contact is not that of the smallest overlap and the first contact
/// is more than [`MAX_APPROACH_TIME_S`] ago; [`FootprintError::Range`] if a number is out of range.
pub fn find_contact(
    struck: &MovingFootprint,
    striking: &MovingFootprint,
) -> Result<Contact, FootprintError> {
    struck.check()?;
    striking.check()?;
    let candidates = candidates(struck, striking);
    let shallowest = shallowest_of(&candidates);
    let depth_m = shallowest.depth_m;
    if depth_m < -TOUCH_TOLERANCE_M {
        return Err(FootprintError::Apart { gap_m: -depth_m });
    }
    let push = (PROBE_DEPTH_M - depth_m).max(0.0);
    let normal = shallowest.normal_world;
    let pushed = striking.corners_m().map(|[x, y]| [x + push * normal[0], y + push * normal[1]]);
    let [x, y] = centroid(&clip(&struck.corners_m(), &pushed))
        .ok_or(FootprintError::Apart { gap_m: -depth_m })?;
    // The striking vehicle alone was pushed, but the contact point lies midway between the
    // vehicles.
    let point_world_m = [x - push / 2.0 * normal[0], y - push / 2.0 * normal[1]];
    let touched = if depth_m > TOUCH_TOLERANCE_M {
        let ([tx, ty], [bx, by]) =
            (struck.velocity_at_m_s(point_world_m), striking.velocity_at_m_s(point_world_m));
        let first = first_touch(&candidates, shallowest, [bx - tx, by - ty])?;
        let apart = [struck.pose.x_m - striking.pose.x_m, struck.pose.y_m - striking.pose.y_m];
        if dot(apart, first.normal_world) <= 0.0 {
            return Err(FootprintError::TooDeep { depth_m: first.depth_m, time_s: 0.0 });
        }
        first
    } else {
        shallowest
    };
    Ok(Contact {
        point_world_m,
        normal_angle_world_rad: touched.normal_world[1].atan2(touched.normal_world[0]),
        depth_m: touched.depth_m,
        surface: touched.surface,
    })
}

/// The four sides of the struck vehicle, then those of the striking vehicle.
fn candidates(struck: &MovingFootprint, striking: &MovingFootprint) -> [Candidate; 8] {
    let (struck_m, striking_m) = (struck.corners_m(), striking.corners_m());
    let [front, left, rear, right] = Side::ALL;
    let of_struck = |side: Side| {
        let outward = direction(struck.pose.yaw_rad + side.outward_angle_rad());
        let inward = outward.map(|c| -c);
        let depth_m = reach(&struck_m, outward) + reach(&striking_m, inward);
        Candidate { depth_m, normal_world: inward, surface: StruckSurface::Struck(side) }
    };
    let of_striking = |side: Side| {
        let outward = direction(striking.pose.yaw_rad + side.outward_angle_rad());
        let depth_m = reach(&striking_m, outward) + reach(&struck_m, outward.map(|c| -c));
        Candidate { depth_m, normal_world: outward, surface: StruckSurface::Striking(side) }
    };
    [
        of_struck(front),
        of_struck(left),
        of_struck(rear),
        of_struck(right),
        of_striking(front),
        of_striking(left),
        of_striking(rear),
        of_striking(right),
    ]
}

/// The side with the smallest overlap. Sides of equal overlap up to rounding do not replace a side
/// of the struck vehicle.
fn shallowest_of(candidates: &[Candidate; 8]) -> Candidate {
    let [first, others @ ..] = candidates;
    others.iter().fold(
        *first,
        |best, other| {
            if other.depth_m < best.depth_m - 1e-9 { *other } else { best }
        },
    )
}

/// The side at which outlines that overlap first touched.
///
/// - `approach_m_s`: velocity of the striking vehicle relative to the struck vehicle at the contact
///   point.
fn first_touch<'a>(
    candidates: &'a [Candidate; 8],
    shallowest: Candidate,
    approach_m_s: [f64; 2],
) -> Result<Candidate, FootprintError> {
    let time_s =
        |candidate: &Candidate| candidate.depth_m / dot(approach_m_s, candidate.normal_world);
    let closing = candidates
        .iter()
        .filter(|candidate| dot(approach_m_s, candidate.normal_world) > MIN_CLOSING_M_S);
    // As for the smallest overlap, a side of the struck vehicle stays where two are equal.
    let earlier = |best: &'a Candidate, other: &'a Candidate| {
        if time_s(other) < time_s(best) - 1e-9 { other } else { best }
    };
    let Some(first) = closing.reduce(earlier) else {
        return Ok(shallowest);
    };
    if dot(first.normal_world, shallowest.normal_world) > 1.0 - 1e-9 {
        return Ok(shallowest);
    }
    if time_s(first) > MAX_APPROACH_TIME_S {
        return Err(FootprintError::TooDeep { depth_m: first.depth_m, time_s: time_s(first) });
    }
    Ok(*first)
}

/// Computes the pose of a striking vehicle of given heading that just touches a side of the struck
/// vehicle.
///
/// The point of the striking vehicle that is furthest in the direction into the struck vehicle lies
/// on the struck side. It is a corner of the striking vehicle, or the midpoint of a side of the
/// striking vehicle that is parallel to the struck side.
///
/// - `side`: side on which the struck vehicle is hit.
/// - `offset_m`: position of the touching point relative to the midpoint of the struck side, m,
///   positive along the x axis of the struck vehicle for its left and right side and along its y
///   axis for its front and rear. A striking vehicle at the right rear quarter of the struck
///   vehicle has the side [`Side::Right`] and a negative offset.
/// - `heading_rad`: heading of the striking vehicle in world axes, rad.
///
/// # Errors
/// [`FootprintError::Apart`] if the offset lies so far beyond the end of the side that the outlines
/// do not touch; [`FootprintError::Range`] if an outline or a pose is out of range.
pub fn place_touching(
    struck: &Footprint,
    struck_pose: &Pose,
    side: Side,
    offset_m: f64,
    striking: &Footprint,
    heading_rad: f64,
) -> Result<Pose, FootprintError> {
    struck.check()?;
    striking.check()?;
    let [mx, my] = struck.side_middle_m(side);
    let point = struck_pose.world_from_body(match side {
        Side::Front | Side::Rear => [mx, my + offset_m],
        Side::Left | Side::Right => [mx + offset_m, my],
    });
    let inward = direction(struck_pose.yaw_rad + side.outward_angle_rad()).map(|c| -c);
    let turned = Pose { x_m: 0.0, y_m: 0.0, yaw_rad: heading_rad };
    let corners = striking.corners_m(&turned);
    let foremost = reach(&corners, inward);
    let touching: Vec<_> =
        corners.into_iter().filter(|&corner| dot(corner, inward) > foremost - 1e-9).collect();
    let n = touching.len().max(1) as f64;
    let middle = [0, 1].map(|i| touching.iter().map(|corner| corner[i]).sum::<f64>() / n);
    let pose = Pose { x_m: point[0] - middle[0], y_m: point[1] - middle[1], yaw_rad: heading_rad };
    let [still, placed] = [(struck, struck_pose), (striking, &pose)]
        .map(|(footprint, pose)| MovingFootprint::at_rest(*footprint, *pose));
    find_contact(&still, &placed)?;
    Ok(pose)
}

#[cfg(test)]
#[path = "outline_contact_tests.rs"]
mod tests;
