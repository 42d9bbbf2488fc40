//! A vehicle whose speed is known over time, such as from an event data recorder: engine and brakes are
//! what it takes to have that speed.
//!
//! ```text
//! F = m ((v(t + Δt) − v_x)/Δt − a_free)        Δt = 10 ms
//! ```
//!
//! a_free is the acceleration v̇_x without drive and brake. F > 0 drives the driven axle. F < 0 brakes all
//! wheels, divided between the axles so that both reach the limit of friction together
//! ([`Gillespie1992`](crate::bibliography::Gillespie1992), chapter 3), and each wheel by no more than 0.95
//! of what the road holds along it: a speed that falls faster than the road allows is not followed.

use crate::numerics::interpolate;
use crate::units::STANDARD_GRAVITY_M_S2;
use crate::vehicle::tire::WheelHold;
use crate::vehicle::{DrivenAxle, OUTPUT_INTERVAL_S, VehicleParameters, Wheel};

/// Braking force of a wheel over the largest that the road holds.
const LARGEST_SHARE: f64 = 0.95;

/// A speed over time that the vehicle follows. It is linear between samples; outside, the first or the last
/// value holds.
#[derive(Debug, Clone, PartialEq)]
pub struct FollowedSpeed {
    /// Times of the samples, s, strictly rising.
    pub time_s: Vec<f64>,
    /// Velocity v_x along the vehicle at these times, m/s, not backwards.
    pub speed_m_s: Vec<f64>,
    /// The axle that is driven.
    pub axle: DrivenAxle,
}

/// What the wheels are asked for, N.
pub(super) struct SpeedDemand {
    pub drive_n: [f64; 4],
    pub braking_n: [f64; 4],
}

impl FollowedSpeed {
    /// What is asked for over the next 10 ms.
    ///
    /// - `speed_m_s`: v_x now;
    /// - `free_acceleration_m_s2`: v̇_x of wheels that nothing drives or brakes;
    /// - `holds`: what the road holds of the wheels.
    pub(super) fn demand(
        &self,
        vehicle: &VehicleParameters,
        time_s: f64,
        speed_m_s: f64,
        free_acceleration_m_s2: f64,
        holds: &[WheelHold; 4],
    ) -> SpeedDemand {
        let next_m_s = interpolate(&self.time_s, &self.speed_m_s, time_s + OUTPUT_INTERVAL_S);
        let wanted_m_s2 = (next_m_s.unwrap_or(speed_m_s) - speed_m_s) / OUTPUT_INTERVAL_S;
        let force_n = vehicle.mass.mass_kg * (wanted_m_s2 - free_acceleration_m_s2);
        let deceleration_g = (-wanted_m_s2 / STANDARD_GRAVITY_M_S2).clamp(0.0, 1.0);
        let front = front_share(vehicle, deceleration_g.min(vehicle.tires.friction));
        let braking_n = |wheel: Wheel| {
            let share = if wheel.is_front() { front } else { 1.0 - front };
            let asked_n = (-force_n).max(0.0) * share / 2.0;
            asked_n.min(LARGEST_SHARE * holds[wheel.index()].largest_braking_n.max(0.0))
        };
        SpeedDemand {
            drive_n: self.axle.shared_n(force_n.max(0.0)),
            braking_n: Wheel::ALL.map(braking_n),
        }
    }

    /// The last instant at which the speed changes, s.
    pub(super) fn last_change_s(&self) -> Option<f64> {
        self.time_s.last().copied()
    }
}

/// Share of the front axle in the braking force with which both axles use the same friction.
fn front_share(vehicle: &VehicleParameters, deceleration_g: f64) -> f64 {
    let geometry = &vehicle.geometry;
    let front_load = geometry.cg_to_rear_axle_m + geometry.cg_height_m * deceleration_g;
    (front_load / geometry.wheelbase_m()).clamp(0.0, 1.0)
}
