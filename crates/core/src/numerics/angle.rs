//! Angles in the plane.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Whether a change of heading to either side is a quarter turn or more, which is a spin.
pub fn is_quarter_turn(turn_rad: f64) -> bool {
    turn_rad.abs() >= FRAC_PI_2
}

/// Whether a change of heading to either side is a half turn or more: the vehicle faces backwards.
pub fn is_half_turn(turn_rad: f64) -> bool {
    turn_rad.abs() >= PI
}

/// The angle in (−π, π] rad that differs from `angle_rad` by whole turns.
pub fn wrap_angle_rad(angle_rad: f64) -> f64 {
    let wrapped = angle_rad.rem_euclid(TAU);
    if wrapped > PI { wrapped - TAU } else { wrapped }
}

/// A recorded angle that jumps by whole turns made one that does not; it changes by less than half a turn
/// between two samples.
pub fn continued_rad(angles_rad: &[f64]) -> Vec<f64> {
    let mut turns_rad = 0.0;
    let mut before = angles_rad.first().copied().unwrap_or_default();
    let go_on = |&angle: &f64| {
        turns_rad -= TAU * ((angle - before + PI) / TAU).floor();
        before = angle;
        angle + turns_rad
    };
    angles_rad.iter().map(go_on).collect()
}

/// A recorded direction without the jumps of a recorder that keeps it within one turn (179°, then −179°);
/// one that spans more than a turn counts turns by itself and stays as it is.
pub fn counted_turns_rad(angles_rad: Vec<f64>) -> Vec<f64> {
    let least = angles_rad.iter().copied().fold(f64::INFINITY, f64::min);
    let greatest = angles_rad.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    match greatest - least <= TAU * (1.0 + 1e-6) {
        true => continued_rad(&angles_rad),
        false => angles_rad,
    }
}

/// Directions as numbers without a jump: each is moved by whole turns to within half a turn of the mean
/// direction, which lies in (−π, π], so that their order and quantiles are those along the circle.
///
/// Without a mean direction the angles stay as they are.
pub fn unwrapped_rad(angles_rad: &[f64]) -> Vec<f64> {
    let sum = |part: fn(f64) -> f64| angles_rad.iter().map(|angle| part(*angle)).sum::<f64>();
    let [x, y] = [sum(f64::cos), sum(f64::sin)];
    let length = x.hypot(y);
    if length.is_nan() || length <= 1e-9 * angles_rad.len() as f64 {
        return angles_rad.to_vec();
    }
    let mean = y.atan2(x);
    angles_rad.iter().map(|angle| mean + wrap_angle_rad(angle - mean)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_of_just_90_or_180_degrees_counts_to_either_side() {
        for (turn_deg, expected) in [
            (89.9, [false, false]),
            (90.0, [true, false]),
            (179.9, [true, false]),
            (180.0, [true, true]),
            (f64::NAN, [false, false]),
        ] {
            for turn_rad in [turn_deg, -turn_deg].map(f64::to_radians) {
                let counted = [is_quarter_turn(turn_rad), is_half_turn(turn_rad)];
                assert_eq!(counted, expected, "{turn_deg}°");
            }
        }
    }

    #[test]
    fn turns_are_counted_where_the_recorder_did_not() {
        let spin: Vec<f64> = (0..90).map(|i| 3.0 + 0.1 * f64::from(i)).collect();
        for start in [-PI, 0.0] {
            let kept = spin.iter().map(|angle| (angle - start).rem_euclid(TAU) + start).collect();
            for (got, expected) in counted_turns_rad(kept).iter().zip(&spin) {
                assert!((got - expected).abs() < 1e-9, "{got} for {expected}");
            }
        }
        // Every second of a fast spin, in a record that counts its turns.
        let coarse = vec![0.0, 4.0, 8.0, 11.0];
        assert_eq!(counted_turns_rad(coarse.clone()), coarse);
    }

    #[test]
    fn full_turns_are_taken_out() {
        let smooth: Vec<f64> = (0..200).map(|i| 0.3 - 0.1 * f64::from(i)).collect();
        let jumping: Vec<f64> =
            smooth.iter().map(|angle| (angle + PI).rem_euclid(TAU) - PI).collect();
        for (got, expected) in continued_rad(&jumping).iter().zip(&smooth) {
            assert!((got - expected).abs() < 1e-9, "{got} {expected}");
        }
    }

    #[test]
    fn directions_about_backwards_have_no_jump() {
        let angles = [170.0_f64, -175.0, -160.0, 178.0].map(f64::to_radians);
        let degrees: Vec<f64> = unwrapped_rad(&angles).iter().map(|a| a.to_degrees()).collect();
        let spread = |values: &[f64]| {
            let ends = values.iter().fold((f64::MAX, f64::MIN), |(low, high), value| {
                (low.min(*value), high.max(*value))
            });
            ends.1 - ends.0
        };
        assert!((spread(&degrees) - 30.0).abs() < 1e-9, "{degrees:?}");
        // Opposite directions have no mean.
        assert_eq!(unwrapped_rad(&[0.0, PI]), [0.0, PI]);
        assert_eq!(unwrapped_rad(&[]), [0.0; 0]);
    }

    #[test]
    fn wrapping_keeps_the_direction() {
        for (angle, expected) in [(3.0 * PI, PI), (-PI, PI), (-0.1, -0.1), (7.0, 7.0 - TAU)] {
            assert!((wrap_angle_rad(angle) - expected).abs() < 1e-12, "{angle}");
        }
    }
}
