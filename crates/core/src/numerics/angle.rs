//! Angles in the plane.

use std::f64::consts::{PI, TAU};

/// The angle in (−π, π] rad that differs from `angle_rad` by whole turns.
pub fn wrap_angle_rad(angle_rad: f64) -> f64 {
    let wrapped = angle_rad.rem_euclid(TAU);
    if wrapped > PI { wrapped - TAU } else { wrapped }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrapping_keeps_the_direction() {
        for (angle, expected) in [(3.0 * PI, PI), (-PI, PI), (-0.1, -0.1), (7.0, 7.0 - TAU)] {
            assert!((wrap_angle_rad(angle) - expected).abs() < 1e-12, "{angle}");
        }
    }
}
