//! Principal direction of force (PDOF) on a vehicle, as it is reported in accident reconstruction.
//!
//! Source: the clock directions are those of [`SaeJ224`](crate::bibliography::SaeJ224).

use std::f64::consts::TAU;

/// Angle below a whole turn that is rounding, rad.
const ROUNDING_RAD: f64 = 1e-9;

/// Direction from which the collision force comes, as seen by the occupants of the vehicle:
/// opposite to the force vector.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PrincipalDirectionOfForce {
    /// Angle from straight ahead, CLOCKWISE as seen from above, rad, in `[0, 2π)`. At π/2 the force
    /// comes from the right and pushes the vehicle to the left.
    pub angle_rad: f64,
}

impl PrincipalDirectionOfForce {
    /// Computes the principal direction of force from the impulse (or the force) on a vehicle.
    ///
    /// ```text
    /// F_body = R(−ψ) F          PDOF = atan2(F_y,body, −F_x,body)
    /// ```
    ///
    /// - `impulse`: impulse or force on the vehicle in world axes, in any unit;
    /// - `heading_rad`: yaw angle ψ of the vehicle, rad.
    /// - returns `None` if the impulse is zero or not finite.
    pub fn from_impulse(impulse: [f64; 2], heading_rad: f64) -> Option<Self> {
        let [x, y] = impulse;
        let magnitude = x.hypot(y);
        if !(magnitude.is_finite() && magnitude > 0.0) {
            return None;
        }
        let (sin, cos) = heading_rad.sin_cos();
        let (forward, left) = (x * cos + y * sin, y * cos - x * sin);
        Some(Self::from_angle(left.atan2(-forward)))
    }

    /// The direction of an angle that may lie outside of one turn.
    pub fn from_angle(angle_rad: f64) -> Self {
        let angle = angle_rad.rem_euclid(TAU);
        // Rounding of a force from straight ahead leaves a whole turn or nothing.
        Self { angle_rad: if TAU - angle > ROUNDING_RAD { angle } else { 0.0 } }
    }

    /// The angle about which an interval is written, rad: less than 0 where the angle would be written as a
    /// whole turn, so that no direction is told as 360 deg and the same one elsewhere as 0.
    ///
    /// - `decimals`: of a degree.
    pub fn centre_rad(self, decimals: i32) -> f64 {
        let half_a_digit_rad = (0.5 * 10.0_f64.powi(-decimals)).to_radians();
        let is_whole_turn = TAU - self.angle_rad <= half_a_digit_rad;
        if is_whole_turn { self.angle_rad - TAU } else { self.angle_rad }
    }

    /// The angle as a single number, rad, which is 0 in place of a whole turn.
    ///
    /// - `decimals`: of a degree, with which it is written.
    pub fn written_rad(self, decimals: i32) -> f64 {
        self.centre_rad(decimals).max(0.0)
    }

    /// The angle in degrees, clockwise from straight ahead, in `[0, 360)`.
    pub fn angle_deg(self) -> f64 {
        self.angle_rad.to_degrees()
    }

    /// Clock direction, 1 to 12. The force comes from the front at 12 o'clock and from the right at
    /// 3 o'clock; each hour covers ±15°.
    pub fn clock(self) -> u8 {
        let hour = (self.angle_rad / (TAU / 12.0)).round() as u8 % 12;
        if hour == 0 { 12 } else { hour }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_clock_reads_where_the_force_comes_from() {
        for (impulse, heading_rad, clock, angle_deg) in [
            ([-1.0, 0.0], 0.0, 12, 0.0),
            ([0.0, 1.0], 0.0, 3, 90.0),
            ([1.0, 0.0], 0.0, 6, 180.0),
            ([0.0, -1.0], 0.0, 9, 270.0),
            ([-1.0, 1.0], 0.0, 2, 45.0),
            ([0.0, -1.0], 90_f64.to_radians(), 12, 0.0),
            ([0.0, 1.0], 180_f64.to_radians(), 9, 270.0),
        ] {
            let pdof = PrincipalDirectionOfForce::from_impulse(impulse, heading_rad).unwrap();
            let off = (pdof.angle_deg() - angle_deg + 180.0).rem_euclid(360.0) - 180.0;
            assert!(off.abs() < 1e-9, "{impulse:?}: {pdof:?}");
            assert_eq!(pdof.clock(), clock, "{impulse:?}: {pdof:?}");
        }
        assert!(PrincipalDirectionOfForce::from_impulse([0.0, 0.0], 0.0).is_none());
        // A blow straight from ahead was told as one from 360°.
        let ahead = PrincipalDirectionOfForce::from_impulse([-1.0, -1e-13], 0.0).unwrap();
        assert_eq!(ahead.angle_rad, 0.0);
    }

    /// Straight ahead was told as 360.0 beside 0.0, by the rounding of a heading.
    #[test]
    fn straight_ahead_is_told_as_nothing_and_never_as_a_whole_turn() {
        for heading_deg in [0.0, 17.0, 45.0, 90.0, 123.4, 270.0] {
            let heading_rad = f64::to_radians(heading_deg);
            for off_rad in [-1e-12, 0.0, 1e-12] {
                let (sin, cos) = (heading_rad + off_rad).sin_cos();
                let impulse = [-5e3 * cos, -5e3 * sin];
                let pdof = PrincipalDirectionOfForce::from_impulse(impulse, heading_rad).unwrap();
                assert!(pdof.angle_rad < 1e-9, "{heading_deg} {off_rad}: {pdof:?}");
                assert_eq!(pdof.clock(), 12);
            }
        }
        let at = |deg: f64| PrincipalDirectionOfForce::from_angle(deg.to_radians());
        for (deg, decimals, centre_deg, written_deg) in [
            (359.7, 0, -0.3, 0.0),
            (359.7, 1, 359.7, 359.7),
            (359.96, 1, -0.04, 0.0),
            (-0.2, 0, -0.2, 0.0),
            (359.4, 0, 359.4, 359.4),
            (0.3, 0, 0.3, 0.3),
            (180.0, 0, 180.0, 180.0),
        ] {
            let [centre, written] =
                [at(deg).centre_rad(decimals), at(deg).written_rad(decimals)].map(f64::to_degrees);
            assert!((centre - centre_deg).abs() < 1e-9, "{deg} {decimals}: {centre}");
            assert!((written - written_deg).abs() < 1e-9, "{deg} {decimals}: {written}");
        }
    }
}
