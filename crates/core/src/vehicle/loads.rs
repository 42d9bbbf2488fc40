//! Vertical loads of the four wheels.
//!
//! Source: `eq:tire_model4` of [`PitPinnPaper`](crate::bibliography::PitPinnPaper).
//! The load transfer is quasi-static: pitch and roll accelerations do not enter.
//!
//! Departures from the paper:
//! - Load is transferred by the forces that cause it, each with its own height: the tire forces at
//!   the ground and the collision force at the contact height. The paper uses the total
//!   acceleration of the CG. With it, a hard impact at the height of the CG would lift wheels,
//!   although such a force has no lever arm about the CG.
//! - The lateral load transfer is divided between the axles by the front share K_f/(K_f + K_r) of
//!   the ROLL stiffness.
//! - Every load is ≥ 0 and their sum is m g. If a wheel lifts, the other wheel of the axle carries
//!   its load; if an axle lifts, the other axle carries its load.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::numerics::{Lanes, LanesOver};
use crate::units::STANDARD_GRAVITY_M_S2;
use crate::vehicle::VehicleParameters;
use crate::vehicle::constants::BodyConstants;

/// The four wheels. Every array over wheels is in this order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Wheel {
    /// The left wheel of the front axle.
    FrontLeft,
    /// The right wheel of the front axle.
    FrontRight,
    /// The left wheel of the rear axle.
    RearLeft,
    /// The right wheel of the rear axle.
    RearRight,
}

impl Wheel {
    /// All wheels, in the order of every array over wheels.
    pub const ALL: [Self; 4] = [Self::FrontLeft, Self::FrontRight, Self::RearLeft, Self::RearRight];

    /// Place of the wheel in [`Wheel::ALL`].
    pub fn index(self) -> usize {
        self as usize
    }

    /// Name of the wheel in messages.
    pub fn label(self) -> &'static str {
        match self {
            Self::FrontLeft => "front left",
            Self::FrontRight => "front right",
            Self::RearLeft => "rear left",
            Self::RearRight => "rear right",
        }
    }

    /// Whether the wheel belongs to the front axle, whose wheels are steered.
    pub fn is_front(self) -> bool {
        matches!(self, Self::FrontLeft | Self::FrontRight)
    }

    /// Position of the centre of the wheel relative to the CG in body axes, m.
    pub fn position_m(self, vehicle: &VehicleParameters) -> [f64; 2] {
        let geometry = &vehicle.geometry;
        let half_track = geometry.track_width_m / 2.0;
        let x =
            if self.is_front() { geometry.cg_to_front_axle_m } else { -geometry.cg_to_rear_axle_m };
        let left = matches!(self, Self::FrontLeft | Self::RearLeft);
        [x, if left { half_track } else { -half_track }]
    }
}

/// Moments about the CG that transfer load between the wheels, N m.
#[derive(Debug, Clone, Copy)]
pub struct LoadTransfer<T> {
    /// Moment that increases the load of the front axle, N m: −h_cog ΣF_x,tire + (z_c − h_cog)
    /// F_x,coll.
    pub to_front_n_m: T,
    /// Moment that increases the loads of the right wheels, N m: h_cog ΣF_y,tire − (z_c − h_cog)
    /// F_y,coll + m_s g h sin φ.
    pub to_right_n_m: T,
}

/// Computes the vertical load of each wheel, N, in the order of [`Wheel::ALL`].
///
/// ```text
/// F_z,front = (m g l_r + M_front) / (l_f + l_r)      F_z,right − F_z,left = 2 share_axle M_right /
/// w
/// ```
///
/// The load of an axle is limited to the interval from 0 to m g, and the load of a wheel to that
/// from 0 to the load of its axle.
#[inline(always)]
pub(super) fn vertical_loads_n<P: Copy, T: Lanes + LanesOver<P>>(
    body: &BodyConstants<P>,
    transfer: LoadTransfer<T>,
) -> [T; 4] {
    let zero = transfer.to_front_n_m.constant(0.0);
    let weight = zero + body.weight_n;
    let front = (transfer.to_front_n_m + body.weight_about_rear_n_m) * body.per_wheelbase_1_m;
    let front = front.clamped(zero, weight);
    let [front_left, front_right] =
        wheel_loads_n(front, transfer.to_right_n_m * body.front_shift_1_m);
    let [rear_left, rear_right] =
        wheel_loads_n(weight - front, transfer.to_right_n_m * body.rear_shift_1_m);
    [front_left, front_right, rear_left, rear_right]
}

/// Loads of the left and of the right wheel of an axle.
#[inline(always)]
fn wheel_loads_n<T: Lanes>(load_n: T, shift_n: T) -> [T; 2] {
    let half = load_n * 0.5;
    let shift = shift_n.clamped(-half, half);
    [half - shift, half + shift]
}

/// Vertical loads of the front and of the rear axle at rest, N.
pub(super) fn static_axle_loads_n(vehicle: &VehicleParameters) -> [f64; 2] {
    let geometry = &vehicle.geometry;
    let weight = vehicle.mass.mass_kg * STANDARD_GRAVITY_M_S2 * vehicle.slope.normal_share();
    let front = weight * geometry.cg_to_rear_axle_m * (1.0 / geometry.wheelbase_m());
    let front = front.clamp(0.0, weight);
    [front, weight - front]
}

impl VehicleParameters {
    /// Vertical loads of the wheels at rest, N, in the order of [`Wheel::ALL`].
    pub fn static_loads_n(&self) -> [f64; 4] {
        let [front, rear] = static_axle_loads_n(self).map(|load| load / 2.0);
        [front, front, rear, rear]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vehicle::Preset;

    #[test]
    fn loads_are_never_negative_and_always_carry_the_weight() {
        let vehicle = Preset::Reference.parameters();
        let body = vehicle.constants().body;
        let weight = vehicle.mass.mass_kg * STANDARD_GRAVITY_M_S2;
        for to_front_n_m in [-1e5, -3e3, 0.0, 5e3, 1e5] {
            for to_right_n_m in [-1e5, -2e3, 0.0, 4e3, 1e5] {
                let transfer = LoadTransfer { to_front_n_m, to_right_n_m };
                let loads = vertical_loads_n(&body, transfer);
                assert!(loads.iter().all(|&load| load >= 0.0), "{loads:?}");
                assert!((loads.iter().sum::<f64>() - weight).abs() < 1e-8, "{loads:?}");
            }
        }
    }

    #[test]
    fn a_left_turn_loads_the_right_and_braking_the_front() {
        let vehicle = Preset::Reference.parameters();
        let (body, at_rest) = (vehicle.constants().body, vehicle.static_loads_n());
        let none = LoadTransfer { to_front_n_m: 0.0, to_right_n_m: 0.0 };
        assert_eq!(vertical_loads_n(&body, none), at_rest);
        let turning = vertical_loads_n(&body, LoadTransfer { to_right_n_m: 2e3, ..none });
        assert!(turning[1] > at_rest[1] && turning[3] > at_rest[3]);
        let braking = vertical_loads_n(&body, LoadTransfer { to_front_n_m: 2e3, ..none });
        assert!(braking[0] > at_rest[0] && braking[2] < at_rest[2]);
    }
}
