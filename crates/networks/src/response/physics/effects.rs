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
//!   slip angle, as a tire's curve differs from its formula;
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
//! Sources: tires with rolling wheels, relaxation and load dependence, H. B. Pacejka, Tire and
//! Vehicle Dynamics, 3rd ed., 2012, chapters 1, 4 and 7. The set was chosen by cross-validation on
//! training trajectories.

use std::ops::Range;

use crate::response::N_RESIDUAL;
use crate::response::physics::axle_effects::{
    Axle, AxleForces, CHARACTERISTIC_SCALE, N_PER_AXLE, N_SLIP_KNOTS,
};
use impactlab_core::numerics::Lanes;
use impactlab_core::vehicle::{VehicleEvaluation, VehicleParameters, VehicleState};

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

    /// The component of the residual acceleration that each adds to.
    const COMPONENTS: [usize; Self::COUNT] =
        [VX, ROLL, ROLL, ROLL, ROLL, VX, VY, YAW, VY, YAW, YAW];

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

/// The effects of a vehicle, prepared for all states.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EffectModel {
    axles: [Axle; 2],
    mass_kg: f64,
    yaw_inertia_kg_m2: f64,
}

/// How large each effect is at a state and a strength of one: a force of the axles, N, and the
/// accelerations of the body, in the order of [`Effects`].
#[derive(Debug, Clone, Copy)]
pub(crate) struct EffectAmounts<T> {
    axles: [AxleForces<T>; 2],
    body: [T; BodyEffect::COUNT],
}

impl<T: Lanes> EffectAmounts<T> {
    /// No residual acceleration.
    #[inline(always)]
    pub fn none(&self) -> [T; N_RESIDUAL] {
        [self.body[0].constant(0.0); N_RESIDUAL]
    }
}

impl EffectModel {
    pub fn new(vehicle: &VehicleParameters) -> Self {
        let (geometry, tires) = (&vehicle.geometry, &vehicle.tires);
        let [front, rear] =
            [tires.cornering_coefficient_front_per_rad, tires.cornering_coefficient_rear_per_rad];
        Self {
            axles: [
                Axle::new(vehicle, geometry.cg_to_front_axle_m, front),
                Axle::new(vehicle, -geometry.cg_to_rear_axle_m, rear),
            ],
            mass_kg: vehicle.mass.mass_kg,
            yaw_inertia_kg_m2: vehicle.mass.yaw_inertia_kg_m2,
        }
    }

    /// The amounts at a state.
    ///
    /// - `now`: the 4DOF model at the same state.
    #[inline(always)]
    pub fn amounts<T: Lanes>(
        &self,
        x: &VehicleState<T>,
        now: &VehicleEvaluation<T>,
    ) -> EffectAmounts<T> {
        let [fl, fr, rl, rr] = now.vertical_loads_n;
        let [front, rear] = &self.axles;
        let [fx, fy] = now.collision_force_body_n;
        let (fx, fy) = (fx / self.mass_kg, fy / self.mass_kg);
        let struck_yaw = now.collision_yaw_moment_n_m / self.yaw_inertia_kg_m2;
        let rate = &now.derivative;
        let mut body = [fx; BodyEffect::COUNT];
        body[BodyEffect::WheelInertia as usize] = -rate.vx_body_m_s * 0.05;
        body[BodyEffect::RollAngle as usize] = x.roll_rad * 100.0;
        body[BodyEffect::RollRate as usize] = x.roll_rate_rad_s * 10.0;
        body[BodyEffect::LateralAccelerationRoll as usize] = now.acceleration_body_m_s2[1];
        body[BodyEffect::CollisionRoll as usize] = fy;
        body[BodyEffect::CollisionLongitudinal as usize] = fx * COLLISION_SCALE;
        body[BodyEffect::CollisionLateral as usize] = fy * COLLISION_SCALE;
        body[BodyEffect::CollisionYaw as usize] = struck_yaw * COLLISION_SCALE;
        body[BodyEffect::RollRateLateral as usize] = x.roll_rate_rad_s;
        body[BodyEffect::RollRateYaw as usize] = x.roll_rate_rad_s;
        body[BodyEffect::RollAccelerationYaw as usize] = rate.roll_rate_rad_s * 0.05;
        EffectAmounts {
            axles: [front.forces(x, now, [fl, fr]), rear.forces(x, now, [rl, rr])],
            body,
        }
    }

    /// `Σ_k c_k e_k`, m/s² and rad/s².
    ///
    /// - `strengths`: c_k.
    #[inline(always)]
    pub fn combined<T: Lanes>(
        &self,
        amounts: &EffectAmounts<T>,
        strengths: &[f64; N_EFFECTS],
    ) -> [T; N_RESIDUAL] {
        let mut sum = amounts.none();
        let (of_axles, of_body) = strengths.split_at(2 * N_PER_AXLE);
        let (of_axles, _) = of_axles.as_chunks();
        for ((axle, forces), strengths) in self.axles.iter().zip(&amounts.axles).zip(of_axles) {
            axle.add(forces, strengths, &mut sum);
        }
        for (i, strength) in of_body.iter().enumerate().take(BodyEffect::COUNT) {
            sum[BodyEffect::COMPONENTS[i]] += amounts.body[i] * *strength;
        }
        sum
    }

    /// The residual acceleration of each effect.
    fn each<T: Lanes>(&self, amounts: &EffectAmounts<T>) -> Effects<T> {
        let zero = amounts.body[0].constant(0.0);
        let mut effects = [[zero; N_RESIDUAL]; N_EFFECTS];
        let (of_axles, of_body) = effects.split_at_mut(2 * N_PER_AXLE);
        let (of_axles, _) = of_axles.as_chunks_mut();
        for ((axle, forces), out) in self.axles.iter().zip(&amounts.axles).zip(of_axles) {
            axle.each(forces, out);
        }
        let of_body = of_body.iter_mut().zip(amounts.body).zip(BodyEffect::COMPONENTS);
        for ((slot, amount), component) in of_body {
            slot[component] = amount;
        }
        effects
    }
}

/// The effects, scaled so that their strengths are of the order of 0.1 to 1.
///
/// - `now`: the 4DOF model at the same state.
pub fn effects<T: Lanes>(
    vehicle: &VehicleParameters,
    x: &VehicleState<T>,
    now: &VehicleEvaluation<T>,
) -> Effects<T> {
    let model = EffectModel::new(vehicle);
    model.each(&model.amounts(x, now))
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
pub fn combined<T: Lanes>(effects: &Effects<T>, strengths: &[f64]) -> [T; N_RESIDUAL] {
    let mut sum = [effects[0][0].constant(0.0); N_RESIDUAL];
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
    use impactlab_core::vehicle::{Preset, VehicleInput};

    fn state(signs: f64) -> VehicleState<f64> {
        VehicleState {
            vx_body_m_s: 12.0,
            vy_body_m_s: 3.0 * signs,
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
    fn the_sum_by_force_is_the_sum_of_the_effects() {
        let (vehicle, x) = (Preset::Reference.parameters(), state(1.0));
        let strengths: [f64; N_EFFECTS] = std::array::from_fn(|k| (k as f64 * 0.7).sin());
        let (model, now) =
            (EffectModel::new(&vehicle), vehicle.evaluate(&x, &VehicleInput::released()));
        let sum = model.combined(&model.amounts(&x, &now), &strengths);
        for (got, expected) in sum.into_iter().zip(combined(&at(&x), &strengths)) {
            assert!((got - expected).abs() < 1e-12 * (1.0 + expected.abs()), "{got} {expected}");
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
