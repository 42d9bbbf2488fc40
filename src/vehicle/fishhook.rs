//! The fishhook manoeuvre, a steering test for the propensity to roll over: a quick turn of the
//! steering wheel to one side, a quicker reversal to the other, held.
//!
//! ```text
//! A = 6.5 δ₀.₃        δ₀.₃ = (l_f + l_r) a/v² + (a/g) (1/c_f − 1/c_r)        a = 0.3 g, v = 50 mph
//! ```
//!
//! Source: the laboratory test procedure of the NHTSA ([`Nhtsa2013`]). It measures the angle δ₀.₃ at
//! which the vehicle turns with 0.3 g; here it is that of the linear bicycle model with the cornering
//! coefficients c of the axles. The procedure reverses when the roll rate has come to nearly zero;
//! here it reverses after a fixed dwell. The test varies the speed from 35 to 50 mph.
//!
//! [`Nhtsa2013`]: crate::bibliography::Nhtsa2013

use crate::units::{MILE_PER_HOUR_M_S, STANDARD_GRAVITY_M_S2};
use crate::vehicle::{SteerHistory, VehicleParameters};

/// Steering ratio of a usual car, for the rate at which the road wheels turn.
pub const USUAL_STEERING_RATIO: f64 = 16.0;

/// Amplitude over the angle at 0.3 g.
const STEERING_SCALAR: f64 = 6.5;
/// Rate of the steering wheel, rad/s: 720 deg/s.
const STEERING_WHEEL_RATE_RAD_S: f64 = 4.0 * std::f64::consts::PI;
/// Time for which the first angle is held, s: about that in which a car has rolled to its side.
const DWELL_S: f64 = 0.25;
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

/// Road-wheel angle over time, to the left first.
///
/// - `angle_rad`: that of [`angle_at_third_g_rad`], more than 0;
/// - `steering_ratio`: angle of the steering wheel over that of the road wheels.
pub fn fishhook(angle_rad: f64, steering_ratio: f64) -> SteerHistory {
    let amplitude_rad = STEERING_SCALAR * angle_rad;
    let ramp_s = amplitude_rad * steering_ratio / STEERING_WHEEL_RATE_RAD_S;
    let mut time_s = 0.0;
    let mut after = |duration_s: f64| {
        time_s += duration_s;
        time_s
    };
    SteerHistory {
        time_s: [0.0, ramp_s, DWELL_S, 2.0 * ramp_s, HOLD_S, RETURN_S].map(&mut after).to_vec(),
        steer_rad: [0.0, 1.0, 1.0, -1.0, -1.0, 0.0].map(|share| share * amplitude_rad).to_vec(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vehicle::{Integrator, Manoeuvre, Preset, VehicleState};

    /// The angle is the one at which the simulated vehicle turns with 0.3 g.
    #[test]
    fn the_angle_at_a_third_of_g_turns_the_vehicle_as_it_says() {
        let vehicle = Preset::Reference.parameters();
        let angle_rad = angle_at_third_g_rad(&vehicle);
        let speed_m_s = 50.0 * MILE_PER_HOUR_M_S;
        let steer = SteerHistory { time_s: vec![0.0, 1.0], steer_rad: vec![0.0, angle_rad] };
        let manoeuvre = Manoeuvre {
            initial: VehicleState::driving_straight(speed_m_s),
            controls: crate::vehicle::Controls { steer: Some(steer), wheels: None },
            duration_s: 3.0,
            ..Manoeuvre::default()
        };
        let motion = vehicle.simulate(&manoeuvre, Integrator::Rk4).unwrap().series;
        let last = |channel| *motion.require(channel).unwrap().last().unwrap();
        let (vx, rate) = (last(crate::data::Channel::Vx), last(crate::data::Channel::YawRate));
        // It loses some speed in the turn.
        let share = vx * rate / STANDARD_GRAVITY_M_S2 / 0.3;
        assert!((0.8..1.15).contains(&share), "{share} of 0.3 g at {vx} m/s");
    }

    #[test]
    fn the_history_has_the_rate_and_the_holds_of_the_procedure() {
        let history = fishhook(0.02, 16.0);
        let steps: Vec<f64> = history.time_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let ramp_s = 6.5 * 0.02 * 16.0 / 720_f64.to_radians();
        for (got, expected) in steps.iter().zip([ramp_s, 0.25, 2.0 * ramp_s, 3.0, 2.0]) {
            assert!((got - expected).abs() < 1e-12, "{steps:?}");
        }
        assert_eq!(history.steer_rad, [0.0, 0.13, 0.13, -0.13, -0.13, 0.0]);
    }
}
