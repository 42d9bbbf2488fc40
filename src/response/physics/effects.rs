//! What the 4DOF model leaves out though its form is known: each effect as the residual acceleration
//! it gives at a strength of one.
//!
//! ```text
//! a_effects = Σ_k c_k e_k(x, u)          e_k(x, u): [v̇_x, v̇_y, ṙ, φ̈]
//! ```
//!
//! The strengths c_k are few, the same everywhere and linear, so that five trajectories say much
//! about them and they hold for motions that no trajectory shows; what is left is the network's.
//! Each axle i moves at `[u, w_i]`, `w_i = v_y + l_i r`, with slip angle `α_i`, load `F_zi`, and
//! friction μ:
//!
//! - *axle characteristic*: side force `μ F_zi Λ_k(|α_i| μ₀/μ) sgn α_i`, Λ_k hat functions over the
//!   slip angle, as a tyre's curve differs from its formula;
//! - *drag*: `−μ F_zi [sin α, sin² α, sin 2α, cos α]` along the car, from toe, camber and compliance;
//! - *wheel inertia*: `−v̇_x`, as wheels are spun up with the car;
//! - *wheel spin lag*: a wheel under a large slip angle has little grip along its plane, so that its
//!   rolling speed lags behind that of a car that turns under it; for a steady rotation with
//!
//! ```text
//! u_w = (u − τ r w)/(1 + (r τ)²)    τ = m_w S/(μ F_z)    S² = (u − u_w)² + w²
//! ```
//!
//!   it drags with `μ F_z (u − u_w)/S` and loses side force `μ F_z (1 − |w|/S)`, for two equivalent
//!   masses m_w;
//! - *relaxation*: side force lags behind the slip angle, `−σ/V ∂F_y/∂α α̇`;
//! - *load transfer*: an axle whose load rests on one wheel has less side force, `F_y (ΔF_z/F_z)²`;
//! - *roll*: `φ`, `φ̇`, `a_y` and `F_y/m` in φ̈, and φ̇ in v̇_y and ṙ, φ̈ in ṙ (compliance, steer);
//! - *contact*: shares of the collision force and moment that come late or are taken up elsewhere.
//!
//! Sources: tyres with rolling wheels, relaxation and load dependence, H. B. Pacejka, Tire and
//! Vehicle Dynamics, 3rd ed., 2012, chapters 1, 4 and 7. The set was chosen by cross-validation on
//! training trajectories.

use std::ops::Range;

use crate::numerics::Scalar;
use crate::response::N_RESIDUAL;
use crate::response::physics::axle_effects::{
    Axle, CHARACTERISTIC_SCALE, N_PER_AXLE, N_SLIP_KNOTS,
};
use crate::vehicle::{VehicleEvaluation, VehicleParameters, VehicleState};

/// An effect of the body, named by its cause and by the acceleration that it adds to. The effects of the
/// front axle and of the rear axle come before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum BodyEffect {
    /// Wheels that are spun up with the car: in v̇_x.
    WheelInertia,
    /// Roll angle φ: in φ̈.
    RollAngle,
    /// Roll rate φ̇: in φ̈.
    RollRate,
    /// Lateral acceleration: in φ̈.
    LateralAccelerationRoll,
    /// Lateral force of the collision: in φ̈.
    CollisionRoll,
    /// Share of the longitudinal force of the collision: in v̇_x.
    CollisionLongitudinal,
    /// Share of the lateral force of the collision: in v̇_y.
    CollisionLateral,
    /// Share of the yaw moment of the collision: in ṙ.
    CollisionYaw,
    /// Roll rate φ̇, by compliance and steer: in v̇_y.
    RollRateLateral,
    /// Roll rate φ̇, by compliance and steer: in ṙ.
    RollRateYaw,
    /// Roll acceleration φ̈: in ṙ.
    RollAccelerationYaw,
}

impl BodyEffect {
    /// Number of effects of the body.
    const COUNT: usize = Self::RollAccelerationYaw as usize + 1;

    /// Index among all effects.
    const fn index(self) -> usize {
        2 * N_PER_AXLE + self as usize
    }
}

/// Which of the axles, in the order of their effects.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum AxlePosition {
    Front,
    Rear,
}

impl AxlePosition {
    /// Indices among all effects of those that correct the characteristic of the axle.
    const fn characteristic(self) -> Range<usize> {
        let first = self as usize * N_PER_AXLE;
        first..first + N_SLIP_KNOTS
    }
}

/// Number of effects.
pub const N_EFFECTS: usize = 2 * N_PER_AXLE + BodyEffect::COUNT;

/// Places of v̇_x, v̇_y, ṙ and φ̈ in a residual acceleration.
const VX: usize = 0;
const VY: usize = 1;
const YAW: usize = 2;
const ROLL: usize = 3;

/// Share of the collision's force or moment at a strength of one.
const COLLISION_SCALE: f64 = 0.1;

/// Residual acceleration of each effect at strength one: v̇_x, v̇_y, m/s², ṙ, φ̈, rad/s².
pub type Effects<T> = [[T; N_RESIDUAL]; N_EFFECTS];

/// The effects, scaled so that their strengths are of the order of 0.1 to 1.
///
/// - `now`: the 4DOF model at the same state.
#[inline] // where it is called, the numbers are written to their place instead of copied
pub fn effects<T: Scalar>(
    vehicle: &VehicleParameters,
    x: &VehicleState<T>,
    now: &VehicleEvaluation<T>,
) -> Effects<T> {
    let mut effects = [[T::from(0.0); N_RESIDUAL]; N_EFFECTS];
    fill(&mut effects, vehicle, x, now);
    effects
}

fn fill<T: Scalar>(
    effects: &mut Effects<T>,
    vehicle: &VehicleParameters,
    x: &VehicleState<T>,
    now: &VehicleEvaluation<T>,
) {
    let geometry = &vehicle.geometry;
    let (tires, [fl, fr, rl, rr]) = (&vehicle.tires, now.vertical_loads_n);
    let axles = [
        (geometry.cg_to_front_axle_m, tires.cornering_coefficient_front_per_rad, [fl, fr]),
        (-geometry.cg_to_rear_axle_m, tires.cornering_coefficient_rear_per_rad, [rl, rr]),
    ];
    let (of_axles, of_body) = effects.split_at_mut(2 * N_PER_AXLE);
    let (of_axles, _) = of_axles.as_chunks_mut();
    for ((arm_m, cornering_coefficient, loads_n), out) in axles.into_iter().zip(of_axles) {
        Axle::new(vehicle, arm_m, cornering_coefficient, loads_n).effects(x, now, out);
    }
    if let Some(of_body) = of_body.first_chunk_mut() {
        body_effects(vehicle, x, now, of_body);
    }
}

/// - `out`: all zero.
fn body_effects<T: Scalar>(
    vehicle: &VehicleParameters,
    x: &VehicleState<T>,
    now: &VehicleEvaluation<T>,
    out: &mut [[T; N_RESIDUAL]; BodyEffect::COUNT],
) {
    let mass = &vehicle.mass;
    let [fx, fy] = now.collision_force_n.map(|force| force / mass.mass_kg);
    let struck_yaw = now.collision_yaw_moment_n_m / mass.yaw_inertia_kg_m2;
    let rate = &now.derivative;
    let [_, ay] = now.acceleration_m_s2;
    out[BodyEffect::WheelInertia as usize][VX] = -rate.vx_m_s * 0.05;
    out[BodyEffect::RollAngle as usize][ROLL] = x.roll_rad * 100.0;
    out[BodyEffect::RollRate as usize][ROLL] = x.roll_rate_rad_s * 10.0;
    out[BodyEffect::LateralAccelerationRoll as usize][ROLL] = ay;
    out[BodyEffect::CollisionRoll as usize][ROLL] = fy;
    out[BodyEffect::CollisionLongitudinal as usize][VX] = fx * COLLISION_SCALE;
    out[BodyEffect::CollisionLateral as usize][VY] = fy * COLLISION_SCALE;
    out[BodyEffect::CollisionYaw as usize][YAW] = struck_yaw * COLLISION_SCALE;
    out[BodyEffect::RollRateLateral as usize][VY] = x.roll_rate_rad_s;
    out[BodyEffect::RollRateYaw as usize][YAW] = x.roll_rate_rad_s;
    out[BodyEffect::RollAccelerationYaw as usize][YAW] = rate.roll_rate_rad_s * 0.05;
}

/// Whether an effect is one of the collision: it is nothing where no force acts.
pub(crate) fn is_of_collision(effect: usize) -> bool {
    use BodyEffect as B;
    [B::CollisionRoll, B::CollisionLongitudinal, B::CollisionLateral, B::CollisionYaw]
        .iter()
        .any(|of| of.index() == effect)
}

/// A change of several strengths together that has a name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Direction {
    /// Side force of both axles, as a share of the friction.
    Grip,
    /// Side force, more on the front axle and less on the rear axle, as a share of the friction.
    Balance,
    /// Yaw moment of the collision, as a share.
    YawImpulse,
    /// Lateral force of the collision, as a share.
    LateralImpulse,
}

/// Strengths at which the change is a whole: side force of all the friction, the whole collision force.
pub(crate) fn direction(direction: Direction) -> [f64; N_EFFECTS] {
    let mut strengths = [0.0; N_EFFECTS];
    let mut side_force = |axle: AxlePosition, sign: f64| {
        strengths[axle.characteristic()].fill(sign / CHARACTERISTIC_SCALE);
    };
    match direction {
        Direction::Grip => {
            side_force(AxlePosition::Front, 1.0);
            side_force(AxlePosition::Rear, 1.0);
        }
        Direction::Balance => {
            side_force(AxlePosition::Front, 1.0);
            side_force(AxlePosition::Rear, -1.0);
        }
        Direction::YawImpulse => {
            strengths[BodyEffect::CollisionYaw.index()] = 1.0 / COLLISION_SCALE
        }
        Direction::LateralImpulse => {
            strengths[BodyEffect::CollisionLateral.index()] = 1.0 / COLLISION_SCALE;
        }
    }
    strengths
}

/// `Σ_k c_k e_k`, m/s² and rad/s².
///
/// - `strengths`: c_k, as many as effects.
pub fn combined<T: Scalar>(effects: &Effects<T>, strengths: &[f64]) -> [T; N_RESIDUAL] {
    let mut sum = [T::from(0.0); N_RESIDUAL];
    for (effect, strength) in effects.iter().zip(strengths) {
        for (sum, value) in sum.iter_mut().zip(effect) {
            *sum += *value * *strength;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::response::RESIDUAL_MIRROR;
    use crate::vehicle::{Preset, VehicleInput};

    fn state(signs: f64) -> VehicleState<f64> {
        VehicleState {
            vx_m_s: 12.0,
            vy_m_s: 3.0 * signs,
            yaw_rate_rad_s: -1.7 * signs,
            roll_rad: 0.02 * signs,
            roll_rate_rad_s: -0.1 * signs,
            ..VehicleState::default()
        }
    }

    fn at(x: &VehicleState<f64>) -> Effects<f64> {
        let (vehicle, u) = (Preset::Reference.parameters(), VehicleInput::released());
        effects(&vehicle, x, &vehicle.evaluate(x, &u))
    }

    #[test]
    fn mirrored_motion_has_mirrored_effects() {
        for (plain, mirrored) in at(&state(1.0)).iter().zip(at(&state(-1.0))) {
            for ((a, b), sign) in plain.iter().zip(mirrored).zip(RESIDUAL_MIRROR) {
                assert!((a - sign * b).abs() < 1e-12, "{plain:?} {mirrored:?}");
            }
        }
    }

    #[test]
    fn a_car_that_goes_straight_feels_drag_alone() {
        let x = VehicleState::driving_straight(20.0);
        let strengths = [1.0; N_EFFECTS];
        let [ax, ay, yaw, roll] = combined(&at(&x), &strengths);
        assert!(ax < -0.1 && ay == 0.0 && yaw == 0.0 && roll == 0.0, "{ax} {ay} {yaw} {roll}");
    }
}
