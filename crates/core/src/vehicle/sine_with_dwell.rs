//! The sine with dwell, the steering test for stability control: one period of a sine at 0.7 Hz with a
//! pause of 0.5 s at its second peak, at 80 km/h and with the throttle released.
//!
//! ```text
//! δ(t) = a sin(2π f t)     t ≤ T₁ = 3/(4 f);  then −a for 0.5 s;  then the last quarter     f = 0.7 Hz
//! a from 1.5 A in steps of 0.5 A to the greater one of 6.5 A and 270° of the steering wheel
//! (300° where 6.5 A is more)
//! ```
//!
//! A is the angle of the steering wheel with which the vehicle turns at 0.3 g where it is steered slowly;
//! here it is that of the linear bicycle model, see [`angle_at_third_g_rad`]. After the steering has
//! ended, the yaw rate must be at most 35 % of its peak within 1.00 s and 20 % within 1.75 s. The peak is
//! that after the steering changes sign. With 5 A and more, the CG must have moved aside by 1.83 m within
//! 1.07 s after the steering begins, of vehicles up to 3500 kg.
//!
//! Source: 49 CFR 571.126 ([`Fmvss126`]), sections S5.2, S7.6 and S7.9.
//!
//! [`angle_at_third_g_rad`]: crate::vehicle::angle_at_third_g_rad
//! [`Fmvss126`]: crate::bibliography::Fmvss126

use std::f64::consts::{PI, TAU};

use crate::data::Channel;
use crate::numerics::interpolate;
use crate::units::KILOMETRE_PER_HOUR_M_S;
use crate::vehicle::{
    ClosedLoop, Controls, Integrator, Manoeuvre, SimulationError, StabilityControl, SteerHistory,
    VehicleParameters, VehicleState,
};

/// Frequency of the sine, Hz.
const FREQUENCY_HZ: f64 = 0.7;
/// Pause at the second peak, s.
const DWELL_S: f64 = 0.5;
/// Interval between the samples of the steer angle, s.
const SAMPLE_S: f64 = 0.01;
/// Speed at which the steering begins, m/s.
const SPEED_M_S: f64 = 80.0 * KILOMETRE_PER_HOUR_M_S;
/// Least largest amplitude and bound of the largest amplitude at the steering wheel, rad.
const LARGEST_STEERING_WHEEL_RAD: [f64; 2] = [1.5 * PI, 300.0 / 180.0 * PI];

/// What comes out of one sine with dwell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SineWithDwellOutcome {
    /// Largest yaw rate after the steering has changed sign and until it ends, rad/s.
    pub peak_yaw_rate_rad_s: f64,
    /// Yaw rate 1.00 s after the end of the steering over the peak, 0 or more.
    pub share_after_1_00_s: f64,
    /// Yaw rate 1.75 s after the end of the steering over the peak, 0 or more.
    pub share_after_1_75_s: f64,
    /// How far the CG has moved aside 1.07 s after the steering began, m, to the side of the first turn.
    pub displacement_m: f64,
    /// Largest side slip of the vehicle up to 1.75 s after the end of the steering, rad.
    pub largest_sideslip_rad: f64,
}

impl SineWithDwellOutcome {
    /// Whether the vehicle meets both criteria of stability.
    pub fn is_stable(&self) -> bool {
        self.share_after_1_00_s <= 0.35 && self.share_after_1_75_s <= 0.20
    }

    /// Whether the vehicle meets the criterion of responsiveness, which holds for 5 A and more.
    pub fn is_responsive(&self) -> bool {
        self.displacement_m >= 1.83
    }
}

/// Amplitudes of the series of a vehicle at the road wheels, rad.
///
/// - `angle_rad`: A at the road wheels, more than 0;
/// - `steering_ratio`: angle of the steering wheel over that of the road wheels.
pub fn sine_with_dwell_amplitudes_rad(angle_rad: f64, steering_ratio: f64) -> Vec<f64> {
    let [least_rad, most_rad] = LARGEST_STEERING_WHEEL_RAD.map(|angle| angle / steering_ratio);
    let last_rad = (6.5 * angle_rad).max(least_rad).min(most_rad.max(least_rad));
    let multiple = |step: u32| (1.5 + 0.5 * f64::from(step)) * angle_rad;
    let below_last = (0..).map(multiple).take_while(|rad| *rad < last_rad);
    // A vehicle that hardly needs to be steered has a long series; its steps are not counted further.
    below_last.take(1000).chain([last_rad]).collect()
}

/// When the steering ends, s.
fn end_of_steer_s() -> f64 {
    1.0 / FREQUENCY_HZ + DWELL_S
}

/// Road-wheel angle over time, to the left first.
///
/// - `amplitude_rad`: at the road wheels; a negative one steers to the right first.
pub fn sine_with_dwell(amplitude_rad: f64) -> SteerHistory {
    let dwell_from_s = 0.75 / FREQUENCY_HZ;
    let phase_s = |time_s: f64| {
        let after_s = (time_s - dwell_from_s - DWELL_S).max(0.0);
        time_s.min(dwell_from_s) + after_s
    };
    let n_steps = (end_of_steer_s() / SAMPLE_S).floor() as usize;
    let sampled = (0..=n_steps).map(|i| i as f64 * SAMPLE_S);
    let time_s: Vec<f64> = sampled.chain([end_of_steer_s()]).collect();
    let angle = |time_s: &f64| amplitude_rad * (TAU * FREQUENCY_HZ * phase_s(*time_s)).sin();
    let mut steer_rad: Vec<f64> = time_s.iter().map(angle).collect();
    if let Some(last) = steer_rad.last_mut() {
        *last = 0.0;
    }
    SteerHistory { time_s, steer_rad }
}

/// Simulates a sine with dwell.
///
/// - `amplitude_rad`: at the road wheels, not 0;
/// - `esc`: stability control; none if `None`.
///
/// # Errors
/// [`SimulationError`] if the motion of the vehicle cannot be simulated.
pub fn sine_with_dwell_outcome(
    vehicle: &VehicleParameters,
    amplitude_rad: f64,
    esc: Option<StabilityControl>,
) -> Result<SineWithDwellOutcome, SimulationError> {
    let closed_loop = esc.map(|esc| ClosedLoop { esc: Some(esc), ..ClosedLoop::default() });
    let steer = Some(sine_with_dwell(amplitude_rad));
    let end_s = end_of_steer_s();
    let manoeuvre = Manoeuvre {
        initial: VehicleState::driving_straight(SPEED_M_S),
        controls: Controls { steer, closed_loop, wheels: None },
        duration_s: end_s + 1.8,
        ..Manoeuvre::default()
    };
    let motion = vehicle.simulate(&manoeuvre, Integrator::Rk4)?.series;
    let column = |channel| motion.require(channel);
    let (yaw_rate, y) = (column(Channel::YawRate)?, column(Channel::Y)?);
    let (vx, vy) = (column(Channel::Vx)?, column(Channel::Vy)?);
    let time_s = motion.time_s();
    let at = |values: &[f64], at_s: f64| interpolate(time_s, values, at_s).unwrap_or(0.0);
    let side = amplitude_rad.signum();
    let reversal_s = 0.5 / FREQUENCY_HZ;
    let peak = time_s
        .iter()
        .zip(yaw_rate)
        .filter(|(at_s, _)| (reversal_s..=end_s).contains(*at_s))
        .fold(0.0, |peak: f64, (_, rate)| peak.max(-side * rate));
    let sideslip = vx.iter().zip(vy).map(|(vx, vy)| vy.atan2(*vx).abs());
    Ok(SineWithDwellOutcome {
        peak_yaw_rate_rad_s: peak,
        share_after_1_00_s: at(yaw_rate, end_s + 1.0).abs() / peak,
        share_after_1_75_s: at(yaw_rate, end_s + 1.75).abs() / peak,
        displacement_m: side * at(y, 1.07),
        largest_sideslip_rad: sideslip.fold(0.0, f64::max),
    })
}

#[cfg(test)]
#[path = "sine_with_dwell_tests.rs"]
mod tests;
