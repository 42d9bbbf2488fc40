//! A driver who steers against the skid of the own car.
//!
//! ```text
//! δ = −clip(k_β β + k_r r, ±δ_max)        β: angle from the direction of motion to the heading
//! ```
//!
//! β is minus the sideslip angle of ISO 8855, positive where the nose points to the left of the way. With
//! k_β = 1 and k_r = 0 the front wheels point along the way of the CG; k_r damps the rotation. The driver
//! begins after a reaction time and turns the steering wheel no faster than a person can.
//!
//! The reaction time has a lognormal distribution with a median of 0.8 s, of which 90 % lies from 0.4 to
//! 1.8 s. Beyond the reaction time the driver follows the motion without delay, which is better than
//! people are.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::ranges::{
    LARGEST_STEERING_WHEEL_ANGLE, REACTION_TIME, Range, SIDESLIP_GAIN, STEER_ANGLE, STEERING_RATIO,
    STEERING_WHEEL_RATE, YAW_RATE_GAIN,
};
use crate::vehicle::drivers::numbers::{Number, lognormal, named, uniform};
use crate::vehicle::{OUTPUT_INTERVAL_S, USUAL_STEERING_RATIO, VehicleState};

/// Median of the reaction time, s.
const REACTION_MEDIAN_S: f64 = 0.8;
/// Standard deviation of the logarithm of the reaction time: 90 % lies from 0.4 to 1.8 s.
const REACTION_SIGMA: f64 = 0.4528;
/// Speed below which the driver holds the steering wheel, m/s: the direction of motion is none there.
const LEAST_SPEED_M_S: f64 = 1.0;

const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// A driver who countersteers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Countersteer {
    /// Time from the first contact to the first turn of the steering wheel, s.
    pub delay_s: f64,
    /// k_β: steer angle of the road wheels over the side slip.
    pub sideslip_gain: f64,
    /// k_r: steer angle of the road wheels over the yaw rate, s.
    pub yaw_rate_gain_s: f64,
    /// Largest angle of the steering wheel to either side, rad.
    pub largest_steering_wheel_rad: f64,
    /// Largest angular velocity of the steering wheel, rad/s.
    pub steering_wheel_rate_rad_s: f64,
    /// Angle of the steering wheel over that of the road wheels.
    pub steering_ratio: f64,
}

impl Default for Countersteer {
    fn default() -> Self {
        Self {
            delay_s: REACTION_MEDIAN_S,
            sideslip_gain: 1.0,
            yaw_rate_gain_s: 0.15,
            largest_steering_wheel_rad: 360.0 * DEGREE,
            steering_wheel_rate_rad_s: 500.0 * DEGREE,
            steering_ratio: USUAL_STEERING_RATIO,
        }
    }
}

impl Countersteer {
    /// Number of standard normal variables that [`Countersteer::drawn`] takes.
    pub const N_DRAWN: usize = 5;

    /// An unknown driver: a lognormal reaction time, k_β uniform from 0.6 to 1.4, k_r from 0 to 0.3 s,
    /// the largest steering-wheel angle from 180° to 540° and its rate from 300 to 500 deg/s.
    pub fn drawn(z: [f64; Self::N_DRAWN]) -> Self {
        let [delay, sideslip, yaw_rate, largest, rate] = z;
        let delay_s = lognormal(delay, REACTION_MEDIAN_S, REACTION_SIGMA);
        Self {
            delay_s: delay_s.min(REACTION_TIME.high),
            sideslip_gain: uniform(sideslip, [0.6, 1.4]),
            yaw_rate_gain_s: uniform(yaw_rate, [0.0, 0.3]),
            largest_steering_wheel_rad: uniform(largest, [180.0, 540.0]) * DEGREE,
            steering_wheel_rate_rad_s: uniform(rate, [300.0, 500.0]) * DEGREE,
            ..Self::default()
        }
    }

    /// Every number with its name without the unit, and its range.
    pub(in crate::vehicle) fn numbers(&mut self) -> [Number<'_>; 6] {
        [
            ("delay", &mut self.delay_s, REACTION_TIME),
            ("sideslip_gain", &mut self.sideslip_gain, SIDESLIP_GAIN),
            ("yaw_rate_gain", &mut self.yaw_rate_gain_s, YAW_RATE_GAIN),
            (
                "largest_steering_wheel",
                &mut self.largest_steering_wheel_rad,
                LARGEST_STEERING_WHEEL_ANGLE,
            ),
            ("steering_wheel_rate", &mut self.steering_wheel_rate_rad_s, STEERING_WHEEL_RATE),
            ("steering_ratio", &mut self.steering_ratio, STEERING_RATIO),
        ]
    }

    /// Every number with its name and its range.
    pub fn ranges(&self) -> Vec<(String, f64, Range)> {
        let mut copy = *self;
        named(copy.numbers())
    }

    /// Steer angle of the road wheels at a sample, rad; `None` before the driver reacts.
    ///
    /// - `steer_rad`: steer angle until now.
    pub(super) fn steer_rad(
        &self,
        time_s: f64,
        x: &VehicleState<f64>,
        steer_rad: f64,
    ) -> Option<f64> {
        if time_s < self.delay_s - 1e-9 {
            return None;
        }
        if x.vx_body_m_s.hypot(x.vy_body_m_s) < LEAST_SPEED_M_S {
            return Some(steer_rad);
        }
        let largest_rad =
            (self.largest_steering_wheel_rad / self.steering_ratio).min(STEER_ANGLE.high);
        let drift_rad = -x.vy_body_m_s.atan2(x.vx_body_m_s);
        let against = self.sideslip_gain * drift_rad + self.yaw_rate_gain_s * x.yaw_rate_rad_s;
        let wanted_rad = -against.clamp(-largest_rad, largest_rad);
        Some(turned_towards(
            steer_rad,
            wanted_rad,
            self.steering_wheel_rate_rad_s / self.steering_ratio,
        ))
    }
}

/// Steer angle after the road wheels have turned towards an angle for one interval, rad.
///
/// - `rate_rad_s`: angular velocity that is not exceeded.
pub(super) fn turned_towards(from_rad: f64, to_rad: f64, rate_rad_s: f64) -> f64 {
    let largest_rad = rate_rad_s * OUTPUT_INTERVAL_S;
    from_rad + (to_rad - from_rad).clamp(-largest_rad, largest_rad)
}
