//! Axes and signs of the whole program, which follow [`Iso8855`](crate::bibliography::Iso8855).
//!
//! - World axes: X along the road at the start, Y to the left, Z up.
//! - Body axes, with the origin at the centre of gravity (CG): x forward, y to the left, z up.
//! - Yaw angle ψ: from X to x, counter-clockwise positive as seen from above.
//! - Roll angle φ: about x, positive if the body leans to the right.

use crate::numerics::Lanes;

/// Direction of the vehicle: sine and cosine of its yaw angle.
#[derive(Debug, Clone, Copy)]
pub struct Heading<T> {
    sin: T,
    cos: T,
}

impl<T: Lanes> Heading<T> {
    /// The direction at a yaw angle ψ, rad.
    #[inline(always)]
    pub fn new(yaw_rad: T) -> Self {
        let (sin, cos) = yaw_rad.sin_cos();
        Self { sin, cos }
    }

    /// Transforms a vector from world axes to body axes: `R(−ψ) v`.
    #[inline(always)]
    pub fn body_from_world(self, [x, y]: [T; 2]) -> [T; 2] {
        [self.cos * x + self.sin * y, self.cos * y - self.sin * x]
    }

    /// Transforms a vector from body axes to world axes: `R(ψ) v`.
    #[inline(always)]
    pub fn world_from_body(self, [x, y]: [T; 2]) -> [T; 2] {
        [self.cos * x - self.sin * y, self.sin * x + self.cos * y]
    }
}

/// Transforms a vector from world axes to body axes: `R(−ψ) v`, with the yaw angle ψ in rad.
pub fn body_from_world<T: Lanes>(yaw_rad: T, vector: [T; 2]) -> [T; 2] {
    Heading::new(yaw_rad).body_from_world(vector)
}

/// Transforms a vector from body axes to world axes: `R(ψ) v`, with the yaw angle ψ in rad.
pub fn world_from_body<T: Lanes>(yaw_rad: T, vector: [T; 2]) -> [T; 2] {
    Heading::new(yaw_rad).world_from_body(vector)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forward_of_a_car_turned_left_points_to_the_left() {
        let [x, y] = world_from_body(std::f64::consts::FRAC_PI_2, [1.0, 0.0]);
        assert!(x.abs() < 1e-15 && (y - 1.0).abs() < 1e-15);
        let back: [f64; 2] = body_from_world(0.7, world_from_body(0.7, [3.0, -2.0]));
        assert!((back[0] - 3.0).abs() < 1e-15 && (back[1] + 2.0).abs() < 1e-15);
    }
}
