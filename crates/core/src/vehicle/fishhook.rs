//! The fishhook manoeuvre, a steering test for the propensity to roll over: a quick turn of the
//! steering wheel to one side, a quicker reversal to the other, held.
//!
//! ```text
//! A = 6.5 δ₀.₃        δ₀.₃ = (l_f + l_r) a/v² + (a/g) (1/c_f − 1/c_r)        a = 0.3 g, v = 50 mph
//!
//! turn to A at 720 deg/s of the steering wheel · wait until |roll rate| ≤ 1.5 deg/s ·
//! turn to −A at 720 deg/s · hold for 3 s · return to 0 in 2 s
//! ```
//!
//! Source: the policy statement of the NHTSA on rollover resistance ([`Nhtsa2003`]) and its laboratory
//! test procedure ([`Nhtsa2013`]). The test measures the angle δ₀.₃ at which the vehicle turns with 0.3 g
//! while it is steered slowly at 50 mph; here it is that of the linear bicycle model with the cornering
//! coefficients c of the axles. The roll rate that ends the wait is that of the 4DOF vehicle. The test
//! varies the speed from 35 to 50 mph.
//!
//! [`Nhtsa2003`]: crate::bibliography::Nhtsa2003
//! [`Nhtsa2013`]: crate::bibliography::Nhtsa2013

use crate::data::Channel;
use crate::units::{MILE_PER_HOUR_M_S, STANDARD_GRAVITY_M_S2};
use crate::vehicle::{
    Controls, Integrator, Manoeuvre, SimulationError, SteerHistory, VehicleParameters, VehicleState,
};

/// Steering ratio of a usual car, for the rate at which the road wheels turn.
pub const USUAL_STEERING_RATIO: f64 = 16.0;

/// Amplitude over the angle at 0.3 g.
const STEERING_SCALAR: f64 = 6.5;
/// Rate of the steering wheel, rad/s: 720 deg/s.
const STEERING_WHEEL_RATE_RAD_S: f64 = 4.0 * std::f64::consts::PI;
/// Roll rate at which the steering is reversed, rad/s: 1.5 deg/s.
const REVERSAL_ROLL_RATE_RAD_S: f64 = 1.5 * std::f64::consts::PI / 180.0;
/// Longest wait for it, s. A car has rolled to its side within some tenths of a second.
const LONGEST_DWELL_S: f64 = 2.0;
/// Shortest wait, s, so that the instants of the history rise.
const MIN_DWELL_S: f64 = 1e-3;
/// Time for which the second angle is held, s.
const HOLD_S: f64 = 3.0;
/// Time in which the steering wheel returns to its centre, s.
const RETURN_S: f64 = 2.0;

/// Road-wheel angle with which a vehicle turns steadily at 0.3 g and 50 mph by the linear bicycle
/// model, rad; 0 or less for a vehicle that oversteers so much that it cannot.
pub fn angle_at_third_g_rad(vehicle: &VehicleParameters) -> f64 {
    let (geometry, tires) = (&vehicle.geometry, &vehicle.tires);
    let acceleration_g = 0.3;
    let wheelbase_m = geometry.wheelbase_m();
    let curvature_per_m =
        acceleration_g * STANDARD_GRAVITY_M_S2 / (50.0 * MILE_PER_HOUR_M_S).powi(2);
    let understeer_rad_g = 1.0 / tires.cornering_coefficient_front_per_rad
        - 1.0 / tires.cornering_coefficient_rear_per_rad;
    wheelbase_m * curvature_per_m + acceleration_g * understeer_rad_g
}

/// Road-wheel angle to which a fishhook turns, rad.
///
/// - `angle_rad`: that of [`angle_at_third_g_rad`].
pub fn fishhook_amplitude_rad(angle_rad: f64) -> f64 {
    STEERING_SCALAR * angle_rad
}

/// Road-wheel angle over time, to the left first. The vehicle is simulated to find when its roll rate
/// has come to nearly zero.
///
/// - `amplitude_rad`: that of [`fishhook_amplitude_rad`], more than 0;
/// - `steering_ratio`: angle of the steering wheel over that of the road wheels.
///
/// # Errors
/// [`SimulationError`] if the motion of the vehicle cannot be simulated.
pub fn fishhook(
    vehicle: &VehicleParameters,
    initial: &VehicleState<f64>,
    amplitude_rad: f64,
    steering_ratio: f64,
) -> Result<SteerHistory, SimulationError> {
    let ramp_s = amplitude_rad * steering_ratio / STEERING_WHEEL_RATE_RAD_S;
    let dwell_s = dwell_s(vehicle, initial, amplitude_rad, ramp_s)?;
    let mut time_s = 0.0;
    let mut after = |duration_s: f64| {
        time_s += duration_s;
        time_s
    };
    Ok(SteerHistory {
        time_s: [0.0, ramp_s, dwell_s, 2.0 * ramp_s, HOLD_S, RETURN_S].map(&mut after).to_vec(),
        steer_rad: [0.0, 1.0, 1.0, -1.0, -1.0, 0.0].map(|share| share * amplitude_rad).to_vec(),
    })
}

/// Time for which the first angle is held until the vehicle has rolled to its side, s; the longest if it
/// swings on.
fn dwell_s(
    vehicle: &VehicleParameters,
    initial: &VehicleState<f64>,
    amplitude_rad: f64,
    ramp_s: f64,
) -> Result<f64, SimulationError> {
    let steer = SteerHistory { time_s: vec![0.0, ramp_s], steer_rad: vec![0.0, amplitude_rad] };
    let manoeuvre = Manoeuvre {
        initial: *initial,
        controls: Controls { steer: Some(steer), ..Controls::default() },
        duration_s: ramp_s + LONGEST_DWELL_S,
        ..Manoeuvre::default()
    };
    let motion = vehicle.simulate(&manoeuvre, Integrator::Rk4)?.series;
    let roll_rate = motion.require(Channel::RollRate)?;
    let samples = motion.time_s().iter().zip(roll_rate);
    let settled = samples
        .skip_while(|(time_s, _)| **time_s < ramp_s)
        .find(|(_, rate)| rate.abs() <= REVERSAL_ROLL_RATE_RAD_S);
    Ok(settled.map_or(LONGEST_DWELL_S, |(time_s, _)| (time_s - ramp_s).max(MIN_DWELL_S)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vehicle::Preset;

    /// The angle is the one at which the simulated vehicle turns with 0.3 g.
    #[test]
    fn the_angle_at_a_third_of_g_turns_the_vehicle_as_it_says() {
        let vehicle = Preset::Reference.parameters();
        let angle_rad = angle_at_third_g_rad(&vehicle);
        let speed_m_s = 50.0 * MILE_PER_HOUR_M_S;
        let steer = SteerHistory { time_s: vec![0.0, 1.0], steer_rad: vec![0.0, angle_rad] };
        let manoeuvre = Manoeuvre {
            initial: VehicleState::driving_straight(speed_m_s),
            controls: Controls { steer: Some(steer), ..Controls::default() },
            duration_s: 3.0,
            ..Manoeuvre::default()
        };
        let motion = vehicle.simulate(&manoeuvre, Integrator::Rk4).unwrap().series;
        let last = |channel| *motion.require(channel).unwrap().last().unwrap();
        let (vx, rate) = (last(Channel::Vx), last(Channel::YawRate));
        // It loses some speed in the turn.
        let share = vx * rate / STANDARD_GRAVITY_M_S2 / 0.3;
        assert!((0.8..1.15).contains(&share), "{share} of 0.3 g at {vx} m/s");
    }

    /// The steering was reversed after a fixed 0.25 s.
    #[test]
    fn the_steering_is_reversed_when_the_vehicle_has_rolled_to_its_side() {
        let vehicle = Preset::Reference.parameters();
        let initial = VehicleState::driving_straight(45.0 * MILE_PER_HOUR_M_S);
        let amplitude_rad = fishhook_amplitude_rad(angle_at_third_g_rad(&vehicle));
        let history = fishhook(&vehicle, &initial, amplitude_rad, 16.0).unwrap();
        let steps: Vec<f64> = history.time_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let ramp_s = amplitude_rad * 16.0 / 720_f64.to_radians();
        for (at, expected) in [(0, ramp_s), (2, 2.0 * ramp_s), (3, 3.0), (4, 2.0)] {
            assert!((steps[at] - expected).abs() < 1e-12, "{steps:?}");
        }
        assert_eq!(history.steer_rad, [0.0, 1.0, 1.0, -1.0, -1.0, 0.0].map(|s| s * amplitude_rad));
        // There the vehicle leans outwards and hardly rolls on.
        let manoeuvre = Manoeuvre {
            initial,
            controls: Controls { steer: Some(history.clone()), ..Controls::default() },
            duration_s: history.time_s[2],
            ..Manoeuvre::default()
        };
        let motion = vehicle.simulate(&manoeuvre, Integrator::Rk4).unwrap().series;
        let roll_rate = motion.require(Channel::RollRate).unwrap();
        let largest = roll_rate.iter().copied().fold(0.0, |a: f64, b| a.max(b.abs()));
        let last = roll_rate.last().unwrap().abs();
        assert!(last < 2.0_f64.to_radians() && largest > 4.0 * last, "{last} {largest}");
        assert!((0.02..1.0).contains(&steps[1]), "{steps:?}");
    }
}
