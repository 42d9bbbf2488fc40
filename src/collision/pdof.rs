//! Principal direction of force, as the trade reports it.
//!
//! Source: [`SaeJ224`](crate::bibliography::SaeJ224) for the clock.

use std::f64::consts::TAU;

/// Where the force on a vehicle comes from, seen by its occupants: 180° from the force itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PrincipalDirectionOfForce {
    /// Angle from straight ahead, CLOCKWISE seen from above, rad, in `[0, 2π)`: a quarter turn is a
    /// force that comes from the right and pushes to the left.
    pub angle_rad: f64,
}

impl PrincipalDirectionOfForce {
    /// Of an impulse (or force) on a vehicle with this heading.
    ///
    /// ```text
    /// F_body = R(−ψ) F          PDOF = atan2(F_y,body, −F_x,body)
    /// ```
    ///
    /// - `impulse`: on the vehicle, world axes, any unit;
    /// - `heading_rad`: the vehicle's yaw ψ.
    ///
    /// `None` without an impulse.
    pub fn from_impulse(impulse: [f64; 2], heading_rad: f64) -> Option<Self> {
        let [x, y] = impulse;
        let magnitude = x.hypot(y);
        if !(magnitude.is_finite() && magnitude > 0.0) {
            return None;
        }
        let (sin, cos) = heading_rad.sin_cos();
        let (forward, left) = (x * cos + y * sin, y * cos - x * sin);
        let angle = left.atan2(-forward).rem_euclid(TAU);
        // `rem_euclid` of a tiny negative angle rounds to τ itself.
        let angle_rad = if angle < TAU { angle } else { 0.0 };
        Some(Self { angle_rad })
    }

    /// Degrees, `[0, 360)`, clockwise from straight ahead.
    pub fn angle_deg(self) -> f64 {
        self.angle_rad.to_degrees()
    }

    /// Clock direction, 1 to 12: 12 o'clock from the front, 3 from the right, each hour ±15°.
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
