//! How far one outline has to move until it touches another one.

use crate::collision::Pose;
use crate::collision::contact::ContactOutline;

/// Way between two looks for a touch, m.
const LOOK_M: f64 = 0.01;

/// Halvings of that way: the place of the touch is then known to a micrometre.
const N_HALVINGS: usize = 14;

/// Way of the striking vehicle along a direction until the rounded outlines touch, m: 0 if they overlap
/// already, `None` if they do not touch within `most_m`.
///
/// Rectangles touch earlier than outlines whose corners are rounded, so that a place of contact which was
/// found with rectangles leaves a gap.
///
/// - `outlines`, `poses`: of the struck and the striking vehicle;
/// - `direction_world_rad`: angle of the direction from the X axis.
pub fn way_to_touch_m(
    outlines: [&ContactOutline; 2],
    poses: [&Pose; 2],
    direction_world_rad: f64,
    most_m: f64,
) -> Option<f64> {
    let (sin, cos) = direction_world_rad.sin_cos();
    let moved = |way_m: f64| {
        let [struck, striking] = poses;
        let (x_m, y_m) = (striking.x_m + way_m * cos, striking.y_m + way_m * sin);
        [*struck, Pose { x_m, y_m, ..*striking }]
    };
    let touches = |way_m: f64| {
        let poses = moved(way_m);
        (0..2).any(|own| {
            let elements = outlines[own].elements().iter();
            elements.map(|element| poses[own].world_from_body(element.point_body_m)).any(|point| {
                outlines[1 - own].holds_body_point(poses[1 - own].body_from_world(point))
            })
        })
    };
    if touches(0.0) {
        return Some(0.0);
    }
    let n_looks = (most_m / LOOK_M).ceil() as usize;
    let found = (1..=n_looks).map(|look| look as f64 * LOOK_M).find(|way_m| touches(*way_m))?;
    let (mut apart_m, mut touching_m) = (found - LOOK_M, found);
    for _ in 0..N_HALVINGS {
        let middle_m = (apart_m + touching_m) / 2.0;
        if touches(middle_m) {
            touching_m = middle_m;
        } else {
            apart_m = middle_m;
        }
    }
    Some(touching_m)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_4;

    use super::*;
    use crate::collision::Footprint;

    #[test]
    fn a_rounded_corner_comes_as_much_later_as_the_circle_is_short_of_the_corner() {
        let footprint = Footprint { length_m: 4.0, width_m: 2.0, cg_from_front_m: 2.0 };
        let radius_m = 0.6;
        let round = ContactOutline::new(footprint, radius_m, 0.02).unwrap();
        let square = ContactOutline::new(footprint, 0.0, 0.02).unwrap();
        let struck = Pose { x_m: 0.0, y_m: 0.0, yaw_rad: 0.0 };
        // The left front corner of the striking vehicle, turned by 45°, points at the right side.
        let corner_m = 2.0_f64.hypot(1.0) * (0.5_f64.atan() + FRAC_PI_4).sin();
        let at = |gap_m: f64| Pose { x_m: 0.0, y_m: -1.0 - corner_m - gap_m, yaw_rad: FRAC_PI_4 };
        let way = |outlines: [&ContactOutline; 2], gap_m| {
            way_to_touch_m(outlines, [&struck, &at(gap_m)], 2.0 * FRAC_PI_4, 1.0)
        };
        let sharp_m = way([&square, &square], 0.3).unwrap();
        assert!((sharp_m - 0.3).abs() < 0.02, "{sharp_m}");
        let expected_m = 0.3 + radius_m * (2.0_f64.sqrt() - 1.0);
        let round_m = way([&square, &round], 0.3).unwrap();
        assert!((round_m - expected_m).abs() < 0.02, "{round_m}, expected {expected_m}");
        assert_eq!(way([&square, &square], -0.1), Some(0.0));
        assert_eq!(way([&square, &square], 1.5), None);
    }
}
