//! Tests of the contact of two outlines: known positions, and properties for random ones.

use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::*;
use crate::collision::footprint::examples::{CAR, pose};

/// The contact of two cars at rest.
fn still(struck: Pose, striking: Pose) -> Result<Contact, FootprintError> {
    let [struck, striking] = [struck, striking].map(|at| MovingFootprint::at_rest(CAR, at));
    find_contact(&struck, &striking)
}

#[test]
fn a_rear_end_hit_touches_in_the_middle_of_the_shared_width() {
    let (struck, striking) = (pose(0.0, 0.0, 0.0), pose(-4.8, 0.6, 0.0));
    let contact = still(struck, striking).unwrap();
    assert_eq!(contact.surface, StruckSurface::Struck(Side::Rear));
    assert!(contact.normal_angle_world_rad.abs() < 1e-12, "{contact:?}");
    assert!((contact.point_world_m[0] + 2.6).abs() < 1e-9, "{contact:?}");
    assert!((contact.point_world_m[1] - 0.3).abs() < 1e-9, "{contact:?}");
}

#[test]
fn a_pit_touches_at_the_striking_vehicles_corner_with_the_normal_across_the_struck() {
    for (side, theta_deg, normal_deg) in [(Side::Right, 12.0, 90.0), (Side::Left, -12.0, -90.0)] {
        let struck = pose(3.0, -2.0, 30.0);
        let heading_rad = (30.0_f64 + theta_deg).to_radians();
        let striking = place_touching(&CAR, &struck, side, -1.2, &CAR, heading_rad).unwrap();
        let contact = still(struck, striking).unwrap();
        assert_eq!(contact.surface, StruckSurface::Struck(side));
        let normal = contact.normal_angle_world_rad.to_degrees();
        assert!((normal - 30.0 - normal_deg).abs() < 1e-9, "{contact:?}");
        assert!(contact.depth_m.abs() < 1e-9, "{contact:?}");
        let [x, y] = struck.body_from_world(contact.point_world_m);
        let expected_y = CAR.side_middle_m(side)[1];
        assert!((x + 1.4).abs() < 3e-3 && (y - expected_y).abs() < 1e-3, "{x} {y}");
    }
}

#[test]
fn the_targets_corner_in_the_striking_vehicles_side_takes_the_striking_vehicles_normal() {
    let contact = still(pose(0.0, 0.0, 0.0), pose(3.45, 1.0, 60.0)).unwrap();
    assert_eq!(contact.surface, StruckSurface::Striking(Side::Left));
    assert!((contact.normal_angle_world_rad.to_degrees() - 150.0).abs() < 1e-9);
}

#[test]
fn placing_touches_for_every_side_and_heading() {
    let struck = pose(1.0, 2.0, -40.0);
    for side in Side::ALL {
        for heading_deg in (0..360).step_by(5) {
            let heading_rad = f64::from(heading_deg).to_radians();
            let striking = place_touching(&CAR, &struck, side, 0.3, &CAR, heading_rad);
            let contact = still(struck, striking.unwrap()).unwrap();
            assert!(contact.depth_m.abs() < 1e-9, "{side:?} {heading_deg}: {contact:?}");
            let normal = direction(contact.normal_angle_world_rad);
            let outward = direction(struck.yaw_rad + side.outward_angle_rad());
            assert!(dot(normal, outward) < -1.0 + 1e-9, "{side:?} {heading_deg}: {contact:?}");
        }
    }
}

#[test]
fn vehicles_apart_are_refused() {
    let here = pose(0.0, 0.0, 0.0);
    let error = still(here, pose(0.0, 2.3, 0.0)).unwrap_err();
    assert_eq!(error.to_string(), "the vehicles are 0.500 m apart");
    assert!(place_touching(&CAR, &here, Side::Rear, 2.0, &CAR, 0.3).is_err());
    assert!(still(here, pose(f64::NAN, 2.3, 0.0)).is_err());
}

/// Two cars, of which the striking vehicle approaches with `velocity_m_s` relative to the struck
/// vehicle.
fn approaching(striking: Pose, velocity_world_m_s: [f64; 2]) -> Result<Contact, FootprintError> {
    let struck = MovingFootprint::at_rest(CAR, pose(0.0, 0.0, 0.0));
    let striking =
        MovingFootprint { velocity_world_m_s, ..MovingFootprint::at_rest(CAR, striking) };
    find_contact(&struck, &striking)
}

/// A deep overlap flipped the normal to the side along which it happened to be smaller: out of
/// the way of the approach, so that there was no impact and no warning.
#[test]
fn a_growing_overlap_keeps_the_normal_of_the_approach() {
    for overlap_cm in 1..=115 {
        let overlap_m = f64::from(overlap_cm) / 100.0;
        // A push at the right rear quarter, the striking vehicle's front 0.6 m ahead of the struck
        // vehicle's rear.
        let pit = approaching(pose(-4.2, -1.8 + overlap_m, 0.0), [0.5, 6.0]).unwrap();
        assert_eq!(pit.surface, StruckSurface::Struck(Side::Right), "{overlap_m}");
        assert!((pit.depth_m - overlap_m).abs() < 1e-9, "{pit:?}");
        // The same from behind, with little of the widths shared.
        let rear = approaching(pose(-4.8 + overlap_m, -1.2, 0.0), [8.0, 0.3]).unwrap();
        assert_eq!(rear.surface, StruckSurface::Struck(Side::Rear), "{overlap_m}");
        // A striking vehicle that comes from the right at a right angle into the front wing.
        let cross = approaching(pose(2.0, -3.1 + overlap_m, 90.0), [-3.0, 10.0]).unwrap();
        assert_eq!(cross.surface, StruckSurface::Struck(Side::Right), "{overlap_m}");
    }
}

#[test]
fn an_overlap_that_no_contact_brings_about_is_refused() {
    // Side by side, half a metre in each other, and one overtakes: the front did not come
    // through four metres of the other car.
    let error = approaching(pose(-0.5, -1.3, 0.0), [5.0, 0.0]).unwrap_err();
    assert!(matches!(error, FootprintError::TooDeep { .. }), "{error}");
    assert!(error.to_string().starts_with("the outlines overlap by 4.300 m, 0.86 s"), "{error}");
    // The striking vehicle's CG has passed that of the struck vehicle.
    let error = approaching(pose(0.3, -0.2, 0.0), [40.0, 1.0]).unwrap_err();
    assert!(matches!(error, FootprintError::TooDeep { .. }), "{error}");
}

#[test]
fn the_approach_is_that_of_the_contact_points() {
    let struck = MovingFootprint::at_rest(CAR, pose(0.0, 0.0, 0.0));
    let at = MovingFootprint::at_rest(CAR, pose(-4.2, -1.1, 0.0));
    // The striking vehicle's front swings to the left with no velocity of its CG.
    let swinging = MovingFootprint { yaw_rate_rad_s: 3.0, ..at };
    let contact = find_contact(&struck, &swinging).unwrap();
    assert_eq!(contact.surface, StruckSurface::Struck(Side::Right));
    assert_eq!(find_contact(&struck, &at).unwrap().surface, StruckSurface::Struck(Side::Rear));
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 1000,
        rng_seed: RngSeed::Fixed(1),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// The normal is never against the approach, however deep the overlap.
    #[test]
    fn the_normal_follows_the_approach(
        at in (-3.0..3.0, -3.0..3.0, -4.0..4.0),
        velocity in [-20.0..20.0, -20.0..20.0],
    ) {
        let striking = Pose { x_m: at.0, y_m: at.1, yaw_rad: at.2 };
        let Ok(contact) = approaching(striking, velocity) else { return Ok(()) };
        if contact.depth_m > TOUCH_TOLERANCE_M {
            let closing = dot(velocity, direction(contact.normal_angle_world_rad));
            prop_assert!(closing > 0.0, "{closing} {contact:?}");
            // Moved back to first contact, the outlines touch.
            let back = contact.depth_m / closing;
            let touching = Pose {
                x_m: at.0 - back * velocity[0],
                y_m: at.1 - back * velocity[1],
                yaw_rad: at.2,
            };
            let [a, b] = [Pose::default(), touching]
                .map(|at| MovingFootprint::at_rest(CAR, at));
            prop_assert!(overlap_m(&a, &b) < 1e-6, "{}", overlap_m(&a, &b));
        }
    }

    /// A rigid motion of both vehicles moves the contact with them; a mirrored scene has the
    /// same overlap; the contact point lies in both outlines.
    #[test]
    fn contacts_move_with_the_scene(
        at in (-3.0..3.0, -3.0..3.0, -4.0..4.0),
        scene in (-50.0..50.0, -50.0..50.0, -4.0..4.0),
    ) {
        let car = |x_m: f64, y_m: f64, yaw_rad: f64| Pose { x_m, y_m, yaw_rad };
        let (here, there) = (car(0.0, 0.0, 0.0), car(at.0, at.1, at.2));
        let Ok(contact) = still(here, there) else {
            return Ok(());
        };
        for pose in [here, there] {
            let [x, y] = pose.body_from_world(contact.point_world_m);
            prop_assert!((-2.6 - 0.02..2.2 + 0.02).contains(&x) && y.abs() < 0.92, "{x} {y}");
        }
        let moved = car(scene.0, scene.1, scene.2);
        let [x, y] = moved.world_from_body([at.0, at.1]);
        let striking = car(x, y, at.2 + scene.2);
        let other = still(moved, striking).unwrap();
        prop_assert!((other.depth_m - contact.depth_m).abs() < 1e-9);
        // If two sides have the same overlap, rounding decides which of them is found.
        if other.surface == contact.surface {
            let point = moved.body_from_world(other.point_world_m);
            for (got, expected) in point.into_iter().zip(contact.point_world_m) {
                prop_assert!((got - expected).abs() < 1e-6, "{other:?}");
            }
        }
        let image = still(here, car(at.0, -at.1, -at.2)).unwrap();
        prop_assert!((image.depth_m - contact.depth_m).abs() < 1e-9);
    }
}
