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

use crate::numerics::Scalar;
use crate::response::N_RESIDUAL;
use crate::vehicle::{Evaluation, VehicleParameters, VehicleState};

/// Slip angles at which the axle characteristic is corrected, rad, on a road of friction μ₀.
const SLIP_KNOTS_RAD: [f64; 10] = [0.01, 0.025, 0.05, 0.09, 0.15, 0.25, 0.4, 0.6, 0.85, 1.2];
/// μ₀: on another road a tyre has the same share of its friction at μ/μ₀ times the slip angle.
const KNOT_FRICTION: f64 = 0.8;
/// Equivalent masses of a wheel that is spun up, as shares of the car's mass: a wheel alone, and one
/// with its share of the driveline.
const WHEEL_MASS_SHARES: [f64; 2] = [0.0075, 0.03];
/// Passes through slip → time constant → slip.
const SPIN_LAG_PASSES: usize = 4;
/// Speed below which slip angles fade, m/s, as in the tyre model.
const SLOW_M_S: f64 = 0.5;
/// Relaxation length σ, m.
const RELAXATION_LENGTH_M: f64 = 0.1;
/// Largest side force from relaxation, as a share of the load.
const RELAXATION_LIMIT: f64 = 0.5;

/// Of each axle: characteristic, drag, spin lag, relaxation, load transfer.
const N_PER_AXLE: usize = SLIP_KNOTS_RAD.len() + 4 + 2 * WHEEL_MASS_SHARES.len() + 2;
/// Of the body.
const N_OF_BODY: usize = 11;

/// How many effects there are.
pub const N_EFFECTS: usize = 2 * N_PER_AXLE + N_OF_BODY;

/// Residual acceleration of each effect at strength one: v̇_x, v̇_y, m/s², ṙ, φ̈, rad/s².
pub type Effects<T> = [[T; N_RESIDUAL]; N_EFFECTS];

/// The effects, scaled so that their strengths are of the order of 0.1 to 1.
///
/// - `now`: the 4DOF model at the same state.
pub fn effects<T: Scalar>(
    vehicle: &VehicleParameters,
    x: &VehicleState<T>,
    now: &Evaluation<T>,
) -> Effects<T> {
    let zero = T::from(0.0);
    let mut effects = [[zero; N_RESIDUAL]; N_EFFECTS];
    let geometry = &vehicle.geometry;
    let (tires, [fl, fr, rl, rr]) = (&vehicle.tires, now.vertical_loads_n);
    let axles = [
        (geometry.cg_to_front_axle_m, tires.cornering_coefficient_front_per_rad, [fl, fr]),
        (-geometry.cg_to_rear_axle_m, tires.cornering_coefficient_rear_per_rad, [rl, rr]),
    ];
    let forward = (x.vx_m_s / SLOW_M_S).tanh();
    let (of_axles, of_body) = effects.split_at_mut(2 * N_PER_AXLE);
    for ((arm_m, cornering_coefficient, loads_n), out) in
        axles.into_iter().zip(of_axles.chunks_exact_mut(N_PER_AXLE))
    {
        let by_side_force = vehicle.acceleration_of([0.0, 1.0], arm_m);
        let axle = Axle { vehicle, arm_m, by_side_force, forward, cornering_coefficient, loads_n };
        axle.effects(x, now, out);
    }
    body_effects(vehicle, x, now, of_body);
    effects
}

/// One axle.
struct Axle<'a, T> {
    vehicle: &'a VehicleParameters,
    /// From the CG, forward, m.
    arm_m: f64,
    /// v̇_x, v̇_y, ṙ, φ̈ by a side force of 1 N.
    by_side_force: [f64; N_RESIDUAL],
    /// Which way the car rolls, −1 to 1.
    forward: T,
    cornering_coefficient: f64,
    /// Of its left and its right wheel.
    loads_n: [T; 2],
}

impl<T: Scalar> Axle<'_, T> {
    fn effects(&self, x: &VehicleState<T>, now: &Evaluation<T>, out: &mut [[T; N_RESIDUAL]]) {
        let friction = self.vehicle.tires.friction;
        let load_n = self.loads_n[0] + self.loads_n[1];
        let u = x.vx_m_s;
        let w = x.vy_m_s + x.yaw_rate_rad_s * self.arm_m;
        let slope = w / (u.abs() + SLOW_M_S);
        let slip_rad = -slope.atan();
        let grip_n = load_n * friction;
        let mut out = out.iter_mut();
        let mut put = |acceleration| {
            if let Some(slot) = out.next() {
                *slot = acceleration;
            }
        };
        let side = sign(slip_rad);
        let scaled_rad = slip_rad.abs() * (KNOT_FRICTION / friction);
        for k in 0..SLIP_KNOTS_RAD.len() {
            put(self.side_force(hat(k, scaled_rad) * grip_n * (0.125 * side)));
        }
        let cos = (slope * slope + 1.0).sqrt().recip();
        let sin = slope.abs() * cos;
        for shape in [sin, sin * sin, sin * cos * 2.0, cos] {
            put(self.along_force(-shape * grip_n * self.forward * 0.125));
        }
        for share in WHEEL_MASS_SHARES {
            let mass_kg = 2.0 * share * self.vehicle.mass.mass_kg;
            let [along, across] = spin_lag_n([u, w, x.yaw_rate_rad_s], grip_n, mass_kg);
            put(self.along_force(along * 0.3));
            put(self.side_force(across * 0.3));
        }
        let relaxation = self.relaxation_n([u, w, slip_rad], now, load_n);
        put(self.side_force(relaxation));
        let transfer = (self.loads_n[0] - self.loads_n[1]) / (load_n + 1.0);
        let stiffness = slip_rad * (self.cornering_coefficient / friction);
        let side_force_n = grip_n * stiffness / (stiffness * stiffness + 1.0).sqrt();
        put(self.side_force(side_force_n * transfer * transfer * 0.3));
    }

    /// `−σ/V ∂F_y/∂α α̇`, N.
    fn relaxation_n(&self, [u, w, slip_rad]: [T; 3], now: &Evaluation<T>, load_n: T) -> T {
        let rate = &now.derivative;
        let across = rate.vy_m_s + rate.yaw_rate_rad_s * self.arm_m;
        let speed_squared = u * u + w * w + SLOW_M_S * SLOW_M_S;
        let turning = -(across * u.abs() - w * rate.vx_m_s * sign(u)) / speed_squared;
        let stiffness = slip_rad * (self.cornering_coefficient / self.vehicle.tires.friction);
        let flattening = stiffness * stiffness + 1.0;
        let slope = load_n * self.cornering_coefficient / (flattening * flattening.sqrt());
        let force_n = -slope * turning * RELAXATION_LENGTH_M / speed_squared.sqrt();
        let limit_n = load_n * RELAXATION_LIMIT;
        if force_n.re().abs() > limit_n.re() { limit_n * sign(force_n) } else { force_n }
    }

    fn side_force(&self, force_n: T) -> [T; N_RESIDUAL] {
        self.by_side_force.map(|acceleration| force_n * acceleration)
    }

    fn along_force(&self, force_n: T) -> [T; N_RESIDUAL] {
        [force_n / self.vehicle.mass.mass_kg, T::from(0.0), T::from(0.0), T::from(0.0)]
    }
}

/// Drag, and the loss of side force, of an axle whose wheels roll slower or faster than they move, N.
fn spin_lag_n<T: Scalar>([u, w, yaw_rate]: [T; 3], grip_n: T, mass_kg: f64) -> [T; 2] {
    let rest = w * w + 0.1;
    let across = rest.sqrt();
    let (mut slip, mut along) = (w.abs() + 0.3, T::from(0.0));
    for _ in 0..SPIN_LAG_PASSES {
        let lag_s = slip * mass_kg / (grip_n + 100.0);
        let turned = yaw_rate * lag_s;
        let rolling = (u - lag_s * yaw_rate * w) / (turned * turned + 1.0);
        along = u - rolling;
        slip = (along * along + rest).sqrt();
    }
    let lost = w / slip - w / across;
    [-grip_n * along / slip, -grip_n * lost]
}

/// Height of the hat function over one of [`SLIP_KNOTS_RAD`].
fn hat<T: Scalar>(knot_idx: usize, slip_rad: T) -> T {
    let knot = |idx: usize| SLIP_KNOTS_RAD.get(idx).copied();
    let Some(at) = knot(knot_idx) else { return T::from(0.0) };
    let before = knot_idx.checked_sub(1).and_then(knot).unwrap_or(0.0);
    if slip_rad.re() <= before {
        T::from(0.0)
    } else if slip_rad.re() <= at {
        (slip_rad - before) / (at - before)
    } else {
        match knot(knot_idx + 1) {
            None => T::from(1.0),
            Some(after) if slip_rad.re() < after => -(slip_rad - after) / (after - at),
            Some(_) => T::from(0.0),
        }
    }
}

fn body_effects<T: Scalar>(
    vehicle: &VehicleParameters,
    x: &VehicleState<T>,
    now: &Evaluation<T>,
    out: &mut [[T; N_RESIDUAL]],
) {
    let zero = T::from(0.0);
    let mass = &vehicle.mass;
    let [fx, fy] = now.collision_force_n.map(|force| force / mass.mass_kg);
    let struck_yaw = now.collision_yaw_moment_n_m / mass.yaw_inertia_kg_m2;
    let rate = &now.derivative;
    let [_, ay] = now.acceleration_m_s2;
    let effects: [[T; N_RESIDUAL]; N_OF_BODY] = [
        [-rate.vx_m_s * 0.05, zero, zero, zero],
        [zero, zero, zero, x.roll_rad * 100.0],
        [zero, zero, zero, x.roll_rate_rad_s * 10.0],
        [zero, zero, zero, ay],
        [zero, zero, zero, fy],
        [fx * 0.1, zero, zero, zero],
        [zero, fy * 0.1, zero, zero],
        [zero, zero, struck_yaw * 0.1, zero],
        [zero, x.roll_rate_rad_s, zero, zero],
        [zero, zero, x.roll_rate_rad_s, zero],
        [zero, zero, rate.roll_rate_rad_s * 0.05, zero],
    ];
    for (slot, effect) in out.iter_mut().zip(effects) {
        *slot = effect;
    }
}

/// Sign of a number, 0 at 0.
fn sign<T: Scalar>(x: T) -> f64 {
    if x.re() == 0.0 { 0.0 } else { x.re().signum() }
}

/// A change of several strengths together that has a name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Direction {
    /// Side force of both axles, as a share of the friction.
    Grip,
    /// The same, more in front and less behind.
    Balance,
    /// Yaw moment of the collision, as a share.
    YawImpulse,
    /// Lateral force of the collision, as a share.
    LateralImpulse,
}

/// Strengths at which the change is a whole: side force of all the friction, the whole collision force.
pub(crate) fn direction(direction: Direction) -> [f64; N_EFFECTS] {
    let mut strengths = [0.0; N_EFFECTS];
    let n_knots = SLIP_KNOTS_RAD.len();
    let (front, rear) = (0, N_PER_AXLE);
    let mut side_force = |axle: usize, sign: f64| {
        strengths.iter_mut().skip(axle).take(n_knots).for_each(|value| *value = sign / 0.125);
    };
    match direction {
        Direction::Grip => {
            side_force(front, 1.0);
            side_force(rear, 1.0);
        }
        Direction::Balance => {
            side_force(front, 1.0);
            side_force(rear, -1.0);
        }
        Direction::YawImpulse => strengths[2 * N_PER_AXLE + 7] = 10.0,
        Direction::LateralImpulse => strengths[2 * N_PER_AXLE + 6] = 10.0,
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
    fn hats_sum_to_one_between_the_knots_and_beyond() {
        for slip in [0.01, 0.02, 0.3, 1.0, 1.5] {
            let sum: f64 = (0..SLIP_KNOTS_RAD.len()).map(|k| hat(k, slip)).sum();
            assert!((sum - 1.0).abs() < 1e-12, "{slip}: {sum}");
        }
        assert_eq!(hat(0, 0.005), 0.5);
    }

    #[test]
    fn a_car_that_goes_straight_feels_drag_alone() {
        let x = VehicleState::driving_straight(20.0);
        let strengths = [1.0; N_EFFECTS];
        let [ax, ay, yaw, roll] = combined(&at(&x), &strengths);
        assert!(ax < -0.1 && ay == 0.0 && yaw == 0.0 && roll == 0.0, "{ax} {ay} {yaw} {roll}");
    }

    #[test]
    fn wheels_lag_behind_a_fast_rotation_and_drag() {
        let grip_n = 7_000.0;
        // Rolling backwards after half a turn: the wheels still brake.
        let [along, _] = spin_lag_n([-30.0, 0.5, 4.0], grip_n, 120.0);
        assert!(along > 0.0 && along <= grip_n, "{along}");
        // In a gentle curve the drag is that of the wheels' inertia, m_w r w.
        let [along, _]: [f64; 2] = spin_lag_n([20.0, 1.0, 0.2], grip_n, 30.0);
        assert!((along / (-30.0 * 0.2 * 1.0) - 1.0).abs() < 0.1, "{along}");
    }
}
