//! Contact point and contact normal from the outlines of the two vehicles.
//!
//! Assumptions: a vehicle's outline is a rectangle of its outer length and width; the vehicles are
//! at first touch or overlap a little. Rounded corners, wheels and crush are left out.
//!
//! Source: separating axes of two rectangles, [`Gottschalk1996`](crate::bibliography::Gottschalk1996);
//! overlap by clipping, [`SutherlandHodgman1974`](crate::bibliography::SutherlandHodgman1974).

use serde::{Deserialize, Serialize};

use crate::vehicle::GeometryParameters;

/// Vehicles further apart than this do not touch, m: poses measured from photographs or video are
/// no better.
pub const TOUCH_TOLERANCE_M: f64 = 0.02;

/// How deep two vehicles that just touch are pushed together before their overlap is cut out, m.
const PROBE_DEPTH_M: f64 = 1e-3;

/// Where a vehicle stands.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// Position of the CG along the world's X axis, m.
    pub x_m: f64,
    /// Position of the CG along the world's Y axis, m.
    pub y_m: f64,
    /// Heading (yaw ψ), rad, counter-clockwise.
    pub yaw_rad: f64,
}

/// A vehicle's outline: a rectangle along the body axes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Footprint {
    /// Outer length, m.
    pub length_m: f64,
    /// Outer width, m.
    pub width_m: f64,
    /// From the foremost point back to the CG, m, 0 to `length_m`.
    pub cg_from_front_m: f64,
}

/// A side of a vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// Front.
    Front,
    /// Left.
    Left,
    /// Rear.
    Rear,
    /// Right.
    Right,
}

/// Whose surface gives the contact normal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StruckSurface {
    /// This side of the target, struck by the bullet's corner or side.
    Target(Side),
    /// This side of the bullet, struck by the target's corner.
    Bullet(Side),
}

/// Where and along which normal two vehicles touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Contact point, world axes, m.
    pub point_m: [f64; 2],
    /// Angle Γ of the normal, world axes, rad, pointing INTO the target.
    pub normal_angle_rad: f64,
    /// How deep the outlines overlap along the normal, m; negative: the gap between them.
    pub depth_m: f64,
    /// Whose side the normal stands on.
    pub surface: StruckSurface,
}

/// Outlines that make no contact.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FootprintError {
    /// The vehicles are apart.
    #[error("the vehicles are {gap_m:.3} m apart")]
    Apart {
        /// Gap between the outlines, m.
        gap_m: f64,
    },
    /// An outline without area, or a CG outside it, or a pose that is not finite.
    #[error("{name} is {value}, expected {expected}")]
    Range {
        /// Which number.
        name: &'static str,
        /// Its value, m (`yaw_rad`: rad).
        value: f64,
        /// The range, in words.
        expected: &'static str,
    },
}

impl Pose {
    /// A point of the body in world axes, m.
    pub fn world_from_body(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = self.yaw_rad.sin_cos();
        [self.x_m + x * cos - y * sin, self.y_m + x * sin + y * cos]
    }

    /// A point of the world in body axes, m.
    pub fn body_from_world(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = self.yaw_rad.sin_cos();
        let (dx, dy) = (x - self.x_m, y - self.y_m);
        [dx * cos + dy * sin, dy * cos - dx * sin]
    }
}

impl Side {
    /// All four, counter-clockwise from the front.
    pub const ALL: [Self; 4] = [Self::Front, Self::Left, Self::Rear, Self::Right];

    /// The word for it in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Front => "front",
            Self::Left => "left",
            Self::Rear => "rear",
            Self::Right => "right",
        }
    }

    /// Angle of the outward normal in body axes, rad.
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
    /// Checks that the outline has an area and holds the CG.
    ///
    /// # Errors
    /// [`FootprintError::Range`].
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

    /// Corners in world axes, m, counter-clockwise from the front left:
    /// front left, rear left, rear right, front right.
    pub fn corners_m(&self, pose: &Pose) -> [[f64; 2]; 4] {
        let front = self.cg_from_front_m;
        let rear = front - self.length_m;
        let side = self.width_m / 2.0;
        [[front, side], [rear, side], [rear, -side], [front, -side]]
            .map(|corner| pose.world_from_body(corner))
    }

    /// Middle of a side in body axes, m.
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

/// Contact of two vehicles that touch or overlap a little.
///
/// The normal stands on the side (of either vehicle) through which the overlap is shallowest; the
/// target's in a tie. The contact point is the centroid of the overlap; outlines that barely touch
/// (or have a gap up to [`TOUCH_TOLERANCE_M`]) are pushed together to an overlap of 1 mm for that,
/// so two flat sides touch in the middle of what they share and a corner touches at the corner.
/// After a deep overlap the shallowest side need not be the one that was struck first.
///
/// # Errors
/// [`FootprintError::Apart`]; [`FootprintError::Range`].
pub fn find_contact(
    (target, target_pose): (&Footprint, &Pose),
    (bullet, bullet_pose): (&Footprint, &Pose),
) -> Result<Contact, FootprintError> {
    for (footprint, pose) in [(target, target_pose), (bullet, bullet_pose)] {
        footprint.check()?;
        for (value, name) in [(pose.x_m, "x_m"), (pose.y_m, "y_m"), (pose.yaw_rad, "yaw_rad")] {
            if !value.is_finite() {
                let expected = "a finite number";
                return Err(FootprintError::Range { name, value, expected });
            }
        }
    }
    let target_m = target.corners_m(target_pose);
    let bullet_m = bullet.corners_m(bullet_pose);
    let by_target = Side::ALL.map(|side| {
        let outward = direction(target_pose.yaw_rad + side.outward_angle_rad());
        let depth = reach(&target_m, outward) + reach(&bullet_m, outward.map(|c| -c));
        (depth, outward.map(|c| -c), StruckSurface::Target(side))
    });
    let by_bullet = Side::ALL.map(|side| {
        let outward = direction(bullet_pose.yaw_rad + side.outward_angle_rad());
        let depth = reach(&bullet_m, outward) + reach(&target_m, outward.map(|c| -c));
        (depth, outward, StruckSurface::Bullet(side))
    });
    let mut shallowest = by_target[0];
    for candidate in by_target.into_iter().skip(1).chain(by_bullet) {
        // A tie up to rounding keeps the target's side.
        if candidate.0 < shallowest.0 - 1e-9 {
            shallowest = candidate;
        }
    }
    let (depth_m, normal, surface) = shallowest;
    if depth_m < -TOUCH_TOLERANCE_M {
        return Err(FootprintError::Apart { gap_m: -depth_m });
    }
    let push = (PROBE_DEPTH_M - depth_m).max(0.0);
    let pushed = bullet_m.map(|[x, y]| [x + push * normal[0], y + push * normal[1]]);
    let [x, y] =
        centroid(&clip(&target_m, &pushed)).ok_or(FootprintError::Apart { gap_m: -depth_m })?;
    Ok(Contact {
        // Half of the push belongs to each vehicle.
        point_m: [x - push / 2.0 * normal[0], y - push / 2.0 * normal[1]],
        normal_angle_rad: normal[1].atan2(normal[0]),
        depth_m,
        surface,
    })
}

/// Pose of a bullet with this heading that just touches a side of the target.
///
/// The bullet's foremost point in the direction of the push (its corner; the middle of its side
/// if that is parallel to the target's) comes to lie on the side, `offset_m` from its middle. The
/// offset counts along the target's x axis for its left and right side and along its y axis for
/// front and rear: a bullet at the right rear quarter has side `Right` and a negative offset.
///
/// # Errors
/// [`FootprintError::Apart`] if the offset lies past the end of the side so that nothing touches;
/// [`FootprintError::Range`].
pub fn place_touching(
    (target, target_pose): (&Footprint, &Pose),
    (side, offset_m): (Side, f64),
    (bullet, heading_rad): (&Footprint, f64),
) -> Result<Pose, FootprintError> {
    target.check()?;
    bullet.check()?;
    let [mx, my] = target.side_middle_m(side);
    let point = target_pose.world_from_body(match side {
        Side::Front | Side::Rear => [mx, my + offset_m],
        Side::Left | Side::Right => [mx + offset_m, my],
    });
    let inward = direction(target_pose.yaw_rad + side.outward_angle_rad()).map(|c| -c);
    let turned = Pose { x_m: 0.0, y_m: 0.0, yaw_rad: heading_rad };
    let corners = bullet.corners_m(&turned);
    let foremost = reach(&corners, inward);
    let touching: Vec<_> =
        corners.into_iter().filter(|&corner| dot(corner, inward) > foremost - 1e-9).collect();
    let n = touching.len().max(1) as f64;
    let middle = [0, 1].map(|i| touching.iter().map(|corner| corner[i]).sum::<f64>() / n);
    let pose = Pose { x_m: point[0] - middle[0], y_m: point[1] - middle[1], yaw_rad: heading_rad };
    find_contact((target, target_pose), (bullet, &pose))?;
    Ok(pose)
}

fn direction(angle_rad: f64) -> [f64; 2] {
    let (sin, cos) = angle_rad.sin_cos();
    [cos, sin]
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Furthest extent of the corners along a direction.
fn reach(corners: &[[f64; 2]; 4], along: [f64; 2]) -> f64 {
    corners.iter().map(|&corner| dot(corner, along)).fold(f64::NEG_INFINITY, f64::max)
}

/// What two convex, counter-clockwise polygons share (Sutherland and Hodgman).
fn clip(subject: &[[f64; 2]], window: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut polygon = subject.to_vec();
    for (i, &a) in window.iter().enumerate() {
        let b = window[(i + 1) % window.len()];
        let inside = |p: [f64; 2]| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
        let mut kept = Vec::with_capacity(polygon.len() + 1);
        for (j, &p) in polygon.iter().enumerate() {
            let q = polygon[(j + 1) % polygon.len()];
            let (dp, dq) = (inside(p), inside(q));
            if dp >= 0.0 {
                kept.push(p);
            }
            if (dp > 0.0 && dq < 0.0) || (dp < 0.0 && dq > 0.0) {
                let t = dp / (dp - dq);
                kept.push([0, 1].map(|k| p[k] + t * (q[k] - p[k])));
            }
        }
        polygon = kept;
    }
    polygon
}

/// Centroid of a polygon; `None` if it has no area.
fn centroid(polygon: &[[f64; 2]]) -> Option<[f64; 2]> {
    let origin = *polygon.first()?;
    let (mut area, mut moment) = (0.0, [0.0; 2]);
    for pair in polygon.windows(2) {
        let [p, q] = [0, 1].map(|k| [pair[k][0] - origin[0], pair[k][1] - origin[1]]);
        let cross = p[0] * q[1] - p[1] * q[0];
        area += cross;
        for k in 0..2 {
            moment[k] += (p[k] + q[k]) * cross / 3.0;
        }
    }
    (area > 0.0).then(|| [0, 1].map(|k| origin[k] + moment[k] / area))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    use super::*;

    const CAR: Footprint = Footprint { length_m: 4.8, width_m: 1.8, cg_from_front_m: 2.2 };

    fn pose(x_m: f64, y_m: f64, yaw_deg: f64) -> Pose {
        let yaw_rad = yaw_deg.to_radians();
        Pose { x_m, y_m, yaw_rad }
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

    #[test]
    fn a_rear_end_hit_touches_in_the_middle_of_the_shared_width() {
        let (target, bullet) = (pose(0.0, 0.0, 0.0), pose(-4.8, 0.6, 0.0));
        let contact = find_contact((&CAR, &target), (&CAR, &bullet)).unwrap();
        assert_eq!(contact.surface, StruckSurface::Target(Side::Rear));
        assert!(contact.normal_angle_rad.abs() < 1e-12, "{contact:?}");
        assert!((contact.point_m[0] + 2.6).abs() < 1e-9, "{contact:?}");
        assert!((contact.point_m[1] - 0.3).abs() < 1e-9, "{contact:?}");
    }

    #[test]
    fn a_pit_touches_at_the_bullets_corner_with_the_normal_across_the_target() {
        for (side, theta_deg, normal_deg) in [(Side::Right, 12.0, 90.0), (Side::Left, -12.0, -90.0)]
        {
            let target = pose(3.0, -2.0, 30.0);
            let heading_rad = (30.0_f64 + theta_deg).to_radians();
            let place = (side, -1.2);
            let bullet = place_touching((&CAR, &target), place, (&CAR, heading_rad)).unwrap();
            let contact = find_contact((&CAR, &target), (&CAR, &bullet)).unwrap();
            assert_eq!(contact.surface, StruckSurface::Target(side));
            let normal = contact.normal_angle_rad.to_degrees();
            assert!((normal - 30.0 - normal_deg).abs() < 1e-9, "{contact:?}");
            assert!(contact.depth_m.abs() < 1e-9, "{contact:?}");
            let [x, y] = target.body_from_world(contact.point_m);
            let expected_y = CAR.side_middle_m(side)[1];
            assert!((x + 1.4).abs() < 3e-3 && (y - expected_y).abs() < 1e-3, "{x} {y}");
        }
    }

    #[test]
    fn the_targets_corner_in_the_bullets_side_takes_the_bullets_normal() {
        let contact =
            find_contact((&CAR, &pose(0.0, 0.0, 0.0)), (&CAR, &pose(3.45, 1.0, 60.0))).unwrap();
        assert_eq!(contact.surface, StruckSurface::Bullet(Side::Left));
        assert!((contact.normal_angle_rad.to_degrees() - 150.0).abs() < 1e-9);
    }

    #[test]
    fn placing_touches_for_every_side_and_heading() {
        let target = pose(1.0, 2.0, -40.0);
        for side in Side::ALL {
            for heading_deg in (0..360).step_by(5) {
                let heading_rad = f64::from(heading_deg).to_radians();
                let bullet = place_touching((&CAR, &target), (side, 0.3), (&CAR, heading_rad));
                let contact = find_contact((&CAR, &target), (&CAR, &bullet.unwrap())).unwrap();
                assert!(contact.depth_m.abs() < 1e-9, "{side:?} {heading_deg}: {contact:?}");
                let normal = direction(contact.normal_angle_rad);
                let outward = direction(target.yaw_rad + side.outward_angle_rad());
                assert!(dot(normal, outward) < -1.0 + 1e-9, "{side:?} {heading_deg}: {contact:?}");
            }
        }
    }

    #[test]
    fn vehicles_apart_are_refused() {
        let here = pose(0.0, 0.0, 0.0);
        let error = find_contact((&CAR, &here), (&CAR, &pose(0.0, 2.3, 0.0))).unwrap_err();
        assert_eq!(error.to_string(), "the vehicles are 0.500 m apart");
        assert!(place_touching((&CAR, &here), (Side::Rear, 2.0), (&CAR, 0.3)).is_err());
        assert!(find_contact((&CAR, &here), (&CAR, &pose(f64::NAN, 2.3, 0.0))).is_err());
    }

    proptest! {
        #![proptest_config(ProptestConfig {
            cases: 1000,
            rng_seed: RngSeed::Fixed(1),
            failure_persistence: None,
            ..ProptestConfig::default()
        })]

        /// Moving the whole scene moves the contact along; mirroring it mirrors the contact; the
        /// contact point lies in both outlines.
        #[test]
        fn contacts_move_with_the_scene(
            at in (-3.0..3.0, -3.0..3.0, -4.0..4.0),
            scene in (-50.0..50.0, -50.0..50.0, -4.0..4.0),
        ) {
            let car = |x_m: f64, y_m: f64, yaw_rad: f64| Pose { x_m, y_m, yaw_rad };
            let (here, there) = (car(0.0, 0.0, 0.0), car(at.0, at.1, at.2));
            let Ok(contact) = find_contact((&CAR, &here), (&CAR, &there)) else {
                return Ok(());
            };
            for pose in [here, there] {
                let [x, y] = pose.body_from_world(contact.point_m);
                prop_assert!((-2.6 - 0.02..2.2 + 0.02).contains(&x) && y.abs() < 0.92, "{x} {y}");
            }
            let moved = car(scene.0, scene.1, scene.2);
            let [x, y] = moved.world_from_body([at.0, at.1]);
            let bullet = car(x, y, at.2 + scene.2);
            let other = find_contact((&CAR, &moved), (&CAR, &bullet)).unwrap();
            prop_assert!((other.depth_m - contact.depth_m).abs() < 1e-9);
            // Two sides may be equally shallow; then rounding decides.
            if other.surface == contact.surface {
                let point = moved.body_from_world(other.point_m);
                for (got, expected) in point.into_iter().zip(contact.point_m) {
                    prop_assert!((got - expected).abs() < 1e-6, "{other:?}");
                }
            }
            let image = find_contact((&CAR, &here), (&CAR, &car(at.0, -at.1, -at.2))).unwrap();
            prop_assert!((image.depth_m - contact.depth_m).abs() < 1e-9);
        }
    }
}
