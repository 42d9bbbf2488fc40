//! Principal direction of force (PDOF) on a vehicle, as it is reported in accident reconstruction.
//!
//! Source: the clock directions are those of [`SaeJ224`](crate::bibliography::SaeJ224).

use std::f64::consts::TAU;

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
        let angle = left.atan2(-forward).rem_euclid(TAU);
        // For a tiny negative angle, `rem_euclid` rounds to 2π, which lies outside the interval.
        let angle_rad = if angle < TAU { angle } else { 0.0 };
        Some(Self { angle_rad })
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
    }
}
