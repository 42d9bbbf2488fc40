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
use crate::units::Phrase;
use crate::vehicle::drivers::numbers::{Number, drawn_words, lognormal, named, uniform};
use crate::vehicle::{OUTPUT_INTERVAL_S, USUAL_STEERING_RATIO, VehicleState};

/// Median of the reaction time, s.
const REACTION_MEDIAN_S: f64 = 0.8;
/// Standard deviation of the logarithm of the reaction time: 90 % lies from 0.4 to 1.8 s.
const REACTION_SIGMA: f64 = 0.4528;
/// Speed below which the driver holds the steering wheel, m/s: the direction of motion is none there.
const LEAST_SPEED_M_S: f64 = 1.0;

/// A driver who countersteers: what is stated of him.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Countersteer {
    /// Time from the first contact to the first turn of the steering wheel, s; 0.8 s if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub delay_s: Option<f64>,
    /// k_β: steer angle of the road wheels over the side slip; 1 if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sideslip_gain: Option<f64>,
    /// k_r: steer angle of the road wheels over the yaw rate, s; 0.15 s if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub yaw_rate_gain_s: Option<f64>,
    /// Largest angle of the steering wheel to either side, rad; 360° if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest_steering_wheel_rad: Option<f64>,
    /// Largest angular velocity of the steering wheel, rad/s; 500 deg/s if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steering_wheel_rate_rad_s: Option<f64>,
    /// Angle of the steering wheel over that of the road wheels; 16 if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steering_ratio: Option<f64>,
}

/// A driver who countersteers as he acts; see [`Countersteer`] for the fields.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ActingCountersteer {
    pub delay_s: f64,
    pub sideslip_gain: f64,
    pub yaw_rate_gain_s: f64,
    pub largest_steering_wheel_rad: f64,
    pub steering_wheel_rate_rad_s: f64,
    pub steering_ratio: f64,
}

impl Countersteer {
    /// Number of standard normal variables that [`Countersteer::drawn`] takes.
    pub const N_DRAWN: usize = 5;

    /// The same with what is not stated drawn: a lognormal reaction time, k_β uniform from 0.6 to 1.4, k_r
    /// from 0 to 0.3 s, the largest steering-wheel angle from 180° to 540° and its rate from 300 to
    /// 500 deg/s.
    pub fn drawn(&self, z: [f64; Self::N_DRAWN]) -> Self {
        let [delay, sideslip, yaw_rate, largest, rate] = z;
        let delay_s = lognormal(delay, REACTION_MEDIAN_S, REACTION_SIGMA).min(REACTION_TIME.high);
        let largest_rad = uniform(largest, [180.0, 540.0]).to_radians();
        let rate_rad_s = uniform(rate, [300.0, 500.0]).to_radians();
        Self {
            delay_s: self.delay_s.or(Some(delay_s)),
            sideslip_gain: self.sideslip_gain.or(Some(uniform(sideslip, [0.6, 1.4]))),
            yaw_rate_gain_s: self.yaw_rate_gain_s.or(Some(uniform(yaw_rate, [0.0, 0.3]))),
            largest_steering_wheel_rad: self.largest_steering_wheel_rad.or(Some(largest_rad)),
            steering_wheel_rate_rad_s: self.steering_wheel_rate_rad_s.or(Some(rate_rad_s)),
            ..*self
        }
    }

    /// What [`Countersteer::drawn`] draws, in words.
    pub(super) fn distributions(&self) -> Vec<Phrase> {
        drawn_words([
            (
                self.delay_s.is_some(),
                ["after 0.4 to 1.8 s (90 %, median 0.8)", "nach 0,4 bis 1,8 s (90 %, Median 0,8)"],
            ),
            (
                self.largest_steering_wheel_rad.is_some(),
                [
                    "at most 180 to 540 deg of the steering wheel",
                    "höchstens 180° bis 540° am Lenkrad",
                ],
            ),
            (
                self.steering_wheel_rate_rad_s.is_some(),
                ["at 300 to 500 deg/s of it", "mit 300 bis 500 °/s am Lenkrad"],
            ),
            (
                self.sideslip_gain.is_some(),
                ["gain on side slip 0.6 to 1.4", "Verstärkung auf den Schwimmwinkel 0,6 bis 1,4"],
            ),
            (
                self.yaw_rate_gain_s.is_some(),
                ["gain on the yaw rate 0 to 0.3 s", "Verstärkung auf die Gierrate 0 bis 0,3 s"],
            ),
        ])
    }

    /// The driver with usual values where nothing is stated.
    pub fn acting(&self) -> ActingCountersteer {
        let largest_rad = self.largest_steering_wheel_rad.unwrap_or(360_f64.to_radians());
        let rate_rad_s = self.steering_wheel_rate_rad_s.unwrap_or(500_f64.to_radians());
        ActingCountersteer {
            delay_s: self.delay_s.unwrap_or(REACTION_MEDIAN_S),
            sideslip_gain: self.sideslip_gain.unwrap_or(1.0),
            yaw_rate_gain_s: self.yaw_rate_gain_s.unwrap_or(0.15),
            largest_steering_wheel_rad: largest_rad,
            steering_wheel_rate_rad_s: rate_rad_s,
            steering_ratio: self.steering_ratio.unwrap_or(USUAL_STEERING_RATIO),
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

    /// Every stated number with its name and its range.
    pub fn ranges(&self) -> Vec<(String, f64, Range)> {
        let mut copy = *self;
        named(copy.numbers())
    }
}

impl ActingCountersteer {
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
