//! When a vehicle has come to rest.

use crate::vehicle::{VehicleParameters, VehicleState};

/// Speed of the CG below which a vehicle counts as at rest, m/s.
pub const REST_SPEED_M_S: f64 = 0.05;
/// Yaw rate below which a vehicle counts as at rest, rad/s: the end of a car, 3 m from its CG, then
/// moves at less than [`REST_SPEED_M_S`].
pub const REST_YAW_RATE_RAD_S: f64 = 0.01;
/// How long both must stay below their limits, s, so that a moment of standstill is not taken for
/// rest.
pub const REST_DURATION_S: f64 = 0.1;

/// The same on a road with a slope, s: a vehicle that rolls uphill stands still for longer before it rolls
/// back. One that the slope moves by less than 0.05 m/s² counts as at rest.
pub const REST_ON_SLOPE_S: f64 = 2.0;

/// Looks for rest along a motion.
#[derive(Debug)]
pub struct RestWatch {
    /// Before this instant the vehicle may still be pushed or braked otherwise, s.
    last_change_s: f64,
    /// How long both limits must hold, s.
    duration_s: f64,
    /// Since when both limits have held, s.
    since_s: Option<f64>,
}

impl RestWatch {
    /// Watches for the vehicle to come to rest after the last change from outside.
    pub fn after(last_change_s: f64) -> Self {
        Self { last_change_s, duration_s: REST_DURATION_S, since_s: None }
    }

    /// The same for a vehicle that may be on a road with a slope.
    #[must_use]
    pub fn of(self, vehicle: &VehicleParameters) -> Self {
        Self { duration_s: vehicle.rest_duration_s(), ..self }
    }

    /// Whether both limits hold at an instant.
    pub(crate) fn is_slow(x: &VehicleState<f64>) -> bool {
        let speed_m_s = x.vx_body_m_s.hypot(x.vy_body_m_s);
        speed_m_s < REST_SPEED_M_S && x.yaw_rate_rad_s.abs() < REST_YAW_RATE_RAD_S
    }

    /// Whether the vehicle has been at rest for [`REST_DURATION_S`], or for [`REST_ON_SLOPE_S`].
    pub fn has_settled(&mut self, time_s: f64, x: &VehicleState<f64>) -> bool {
        if !Self::is_slow(x) || time_s < self.last_change_s {
            self.since_s = None;
            return false;
        }
        *self.since_s.get_or_insert(time_s) + self.duration_s - 1e-9 <= time_s
    }

    /// The instant since which the vehicle is at rest, s; `None` if it still moves.
    ///
    /// - `end_s`: the last instant that was looked at.
    pub fn since_s(&self, end_s: f64) -> Option<f64> {
        self.since_s.filter(|since_s| since_s + self.duration_s - 1e-9 <= end_s)
    }
}

impl VehicleParameters {
    /// How long the vehicle must be slow to count as at rest, s.
    pub fn rest_duration_s(&self) -> f64 {
        if self.slope.is_level() { REST_DURATION_S } else { REST_ON_SLOPE_S }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parked_car_is_at_rest_only_once_nothing_more_will_push_it() {
        let (parked, mut rest) = (VehicleState::default(), RestWatch::after(0.5));
        let found = (0..200).map(|i| f64::from(i) * 0.01).find(|&t| rest.has_settled(t, &parked));
        assert!((found.unwrap() - 0.6).abs() < 0.015, "{found:?}");
    }

    #[test]
    fn a_moment_of_standstill_or_a_turn_on_the_spot_is_not_rest() {
        let mut rest = RestWatch::after(0.0);
        for i in 0..500 {
            let t = f64::from(i) * 0.01;
            let swings = VehicleState { vx_body_m_s: (t - 2.0), ..VehicleState::default() };
            assert!(!rest.has_settled(t, &swings), "at {t} s");
        }
        let turns = VehicleState { yaw_rate_rad_s: 0.5, ..VehicleState::default() };
        assert!((500..900).all(|i| !rest.has_settled(f64::from(i) * 0.01, &turns)));
    }
}
