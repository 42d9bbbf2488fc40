//! The effects of an axle that the 4DOF model leaves out; what they are stands in `effects.rs`.

use crate::response::N_RESIDUAL;
use impactlab_core::numerics::Lanes;
use impactlab_core::vehicle::{
    SLIP_ANGLE_SPEED_M_S, VehicleEvaluation, VehicleParameters, VehicleState,
};

/// Slip angles at which the axle characteristic is corrected, rad, on a road of friction μ₀.
const SLIP_KNOTS_RAD: [f64; 10] = [0.01, 0.025, 0.05, 0.09, 0.15, 0.25, 0.4, 0.6, 0.85, 1.2];
/// μ₀: on another road a tire has the same share of its friction at μ/μ₀ times the slip angle.
const KNOT_FRICTION: f64 = 0.8;
/// Equivalent masses of a wheel that is spun up, as shares of the car's mass: a wheel alone, and one
/// with its share of the driveline.
const WHEEL_MASS_SHARES: [f64; 2] = [0.0075, 0.03];
/// Passes through slip → time constant → slip.
const SPIN_LAG_PASSES: usize = 4;
/// Relaxation length σ, m.
const RELAXATION_LENGTH_M: f64 = 0.1;
/// Largest side force from relaxation, as a share of the load.
const RELAXATION_LIMIT: f64 = 0.5;

/// Slip angles at which the axle characteristic is corrected.
pub(super) const N_SLIP_KNOTS: usize = SLIP_KNOTS_RAD.len();
/// Effects of an axle: characteristic, drag, spin lag, relaxation, load transfer.
pub(super) const N_PER_AXLE: usize = N_SLIP_KNOTS + 4 + 2 * WHEEL_MASS_SHARES.len() + 2;
/// Share of the friction at a strength of one of the characteristic.
pub(super) const CHARACTERISTIC_SCALE: f64 = 0.125;

/// The effects of an axle that push it to the side; the others push along the car.
const IS_SIDE_FORCE: [bool; N_PER_AXLE] = {
    let mut is_side_force = [true; N_PER_AXLE];
    let mut i = N_SLIP_KNOTS;
    while i < N_SLIP_KNOTS + 4 {
        is_side_force[i] = false; // drag
        i += 1;
    }
    while i < N_SLIP_KNOTS + 4 + 2 * WHEEL_MASS_SHARES.len() {
        is_side_force[i] = false; // drag of the spin lag; its loss of side force comes next
        i += 2;
    }
    is_side_force
};

/// One axle of a vehicle, prepared for all states.
#[derive(Debug, Clone, Copy)]
pub(super) struct Axle {
    /// Distance of the axle from the CG, positive forward, m.
    arm_m: f64,
    friction: f64,
    /// Equivalent masses of the two wheels that are spun up, kg.
    spun_masses_kg: [f64; WHEEL_MASS_SHARES.len()],
    cornering_coefficient: f64,
    /// v̇_x, v̇_y, ṙ, φ̈ by a side force of 1 N.
    by_side_force: [f64; N_RESIDUAL],
    /// v̇_x by a force of 1 N along the car.
    by_along_force: f64,
}

/// The effects of an axle at a state: the force of each at a strength of one, N.
pub(super) type AxleForces<T> = [T; N_PER_AXLE];

impl Axle {
    /// - `arm_m`: from the CG, forward.
    pub(super) fn new(vehicle: &VehicleParameters, arm_m: f64, cornering_coefficient: f64) -> Self {
        let mass_kg = vehicle.mass.mass_kg;
        Self {
            arm_m,
            friction: vehicle.tires.friction,
            spun_masses_kg: WHEEL_MASS_SHARES.map(|share| 2.0 * share * mass_kg),
            cornering_coefficient,
            by_side_force: vehicle.acceleration_of([0.0, 1.0], arm_m),
            by_along_force: 1.0 / mass_kg,
        }
    }

    /// The forces of the effects, in order, N.
    ///
    /// - `loads_n`: vertical loads of the left and of the right wheel.
    #[inline(always)]
    pub(super) fn forces<T: Lanes>(
        &self,
        x: &VehicleState<T>,
        now: &VehicleEvaluation<T>,
        loads_n: [T; 2],
    ) -> AxleForces<T> {
        let load_n = loads_n[0] + loads_n[1];
        let u = x.vx_body_m_s;
        let w = x.vy_body_m_s + x.yaw_rate_rad_s * self.arm_m;
        let slope = w / (u.abs() + SLIP_ANGLE_SPEED_M_S);
        let slip_rad = -slope.atan();
        let grip_n = load_n * self.friction;
        let mut forces = [load_n; N_PER_AXLE];
        let (characteristic, others) = forces.split_at_mut(N_SLIP_KNOTS);
        let hat_force_n = grip_n * (slip_rad.sign() * CHARACTERISTIC_SCALE);
        let hats = hats(slip_rad.abs() * (KNOT_FRICTION / self.friction));
        for (slot, height) in characteristic.iter_mut().zip(hats) {
            *slot = height * hat_force_n;
        }
        let cos = (slope * slope + 1.0).sqrt().recip();
        let sin = slope.abs() * cos;
        let drag_n = grip_n * (u / SLIP_ANGLE_SPEED_M_S).smooth_sign() * -0.125;
        let [[along, across], [heavy_along, heavy_across]] =
            spin_lags_n([u, w, x.yaw_rate_rad_s], grip_n, self.spun_masses_kg);
        let relaxation_n = self.relaxation_n([u, w, slip_rad], now, load_n);
        let transfer = (loads_n[0] - loads_n[1]) / (load_n + 1.0);
        let stiffness = slip_rad * (self.cornering_coefficient / self.friction);
        let side_force_n = grip_n * stiffness / (stiffness * stiffness + 1.0).sqrt();
        others.copy_from_slice(&[
            sin * drag_n,
            sin * sin * drag_n,
            sin * cos * 2.0 * drag_n,
            cos * drag_n,
            along * 0.3,
            across * 0.3,
            heavy_along * 0.3,
            heavy_across * 0.3,
            relaxation_n,
            side_force_n * transfer * transfer * 0.3,
        ]);
        forces
    }

    /// The residual acceleration of each effect at a strength of one.
    pub(super) fn each<T: Lanes>(
        &self,
        forces: &AxleForces<T>,
        out: &mut [[T; N_RESIDUAL]; N_PER_AXLE],
    ) {
        for ((slot, force), is_side_force) in out.iter_mut().zip(forces).zip(IS_SIDE_FORCE) {
            *slot = match is_side_force {
                true => self.by_side_force.map(|acceleration| *force * acceleration),
                false => {
                    let zero = force.constant(0.0);
                    [*force * self.by_along_force, zero, zero, zero]
                }
            };
        }
    }

    /// Adds the residual acceleration of all effects at given strengths to a sum.
    #[inline(always)]
    pub(super) fn add<T: Lanes>(
        &self,
        forces: &AxleForces<T>,
        strengths: &[f64; N_PER_AXLE],
        sum: &mut [T; N_RESIDUAL],
    ) {
        let zero = sum[0].constant(0.0);
        let (mut side, mut along) = (zero, zero);
        for i in 0..N_PER_AXLE {
            let part = forces[i] * strengths[i];
            if IS_SIDE_FORCE[i] {
                side += part;
            } else {
                along += part;
            }
        }
        for (sum, acceleration) in sum.iter_mut().zip(self.by_side_force) {
            *sum += side * acceleration;
        }
        sum[0] += along * self.by_along_force;
    }

    /// `−σ/V ∂F_y/∂α α̇`, N.
    #[inline(always)]
    fn relaxation_n<T: Lanes>(
        &self,
        [u, w, slip_rad]: [T; 3],
        now: &VehicleEvaluation<T>,
        load_n: T,
    ) -> T {
        let rate = &now.derivative;
        let across = rate.vy_body_m_s + rate.yaw_rate_rad_s * self.arm_m;
        let speed_squared = u * u + w * w + SLIP_ANGLE_SPEED_M_S * SLIP_ANGLE_SPEED_M_S;
        let turning = -(across * u.abs() - w * rate.vx_body_m_s * sign(u)) / speed_squared;
        let stiffness = slip_rad * (self.cornering_coefficient / self.friction);
        let flattening = stiffness * stiffness + 1.0;
        let slope = load_n * self.cornering_coefficient / (flattening * flattening.sqrt());
        let force_n = -slope * turning * RELAXATION_LENGTH_M / speed_squared.sqrt();
        let limit_n = load_n * RELAXATION_LIMIT;
        force_n.clamped(-limit_n, limit_n)
    }
}

/// Drag, and the loss of side force, of an axle whose wheels roll slower or faster than they move, N,
/// for each mass.
#[inline(always)]
fn spin_lags_n<T: Lanes, const N: usize>(
    [u, w, yaw_rate]: [T; 3],
    grip_n: T,
    masses_kg: [f64; N],
) -> [[T; 2]; N] {
    let yaw_rate_per_grip = yaw_rate / (grip_n + 100.0);
    let rest = w * w + 0.1;
    let across = rest.sqrt();
    let (mut slips, mut alongs) = ([w.abs() + 0.3; N], [w.constant(0.0); N]);
    // All masses in a pass: their divisions and roots do not wait for each other.
    for _ in 0..SPIN_LAG_PASSES {
        for ((slip, along), mass_kg) in slips.iter_mut().zip(&mut alongs).zip(masses_kg) {
            let turned = yaw_rate_per_grip * *slip * mass_kg;
            let rolling = (u - turned * w) / (turned * turned + 1.0);
            *along = u - rolling;
            *slip = (*along * *along + rest).sqrt();
        }
    }
    let mut lags = [[across; 2]; N];
    for ((lag, slip), along) in lags.iter_mut().zip(slips).zip(alongs) {
        let lost = w / slip - w / across;
        *lag = [-grip_n * along / slip, -grip_n * lost];
    }
    lags
}

/// The heights of the hat functions over [`SLIP_KNOTS_RAD`]; beyond the last knot its hat stays at one.
#[inline(always)]
fn hats<T: Lanes>(slip_rad: T) -> [T; N_SLIP_KNOTS] {
    let (zero, one) = (slip_rad.constant(0.0), slip_rad.constant(1.0));
    // What has risen up to a knot falls up to the next one.
    let mut heights = [zero; N_SLIP_KNOTS];
    let mut below = 0.0;
    for (height, knot) in heights.iter_mut().zip(SLIP_KNOTS_RAD) {
        *height = ((slip_rad - below) * (1.0 / (knot - below))).clamped(zero, one);
        below = knot;
    }
    for i in 0..N_SLIP_KNOTS - 1 {
        heights[i] = heights[i] - heights[i + 1];
    }
    heights
}

/// Sign of a number, 0 at 0.
#[inline(always)]
fn sign<T: Lanes>(x: T) -> T {
    let zero = x.constant(0.0);
    x.if_less(zero, x.constant(-1.0), zero.if_less(x, x.constant(1.0), zero))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hats_sum_to_one_between_the_knots_and_beyond() {
        for slip in [0.01_f64, 0.02, 0.3, 1.0, 1.5] {
            let heights = hats(slip);
            assert!((heights.iter().sum::<f64>() - 1.0).abs() < 1e-12, "{slip}: {heights:?}");
            assert!(heights.iter().filter(|height| **height > 0.0).count() <= 2, "{heights:?}");
        }
        assert_eq!(hats(0.005)[..2], [0.5, 0.0]);
        let at_knot = hats(0.15).map(|height: f64| (height * 1e12).round() / 1e12);
        assert_eq!(at_knot, std::array::from_fn(|i| if i == 4 { 1.0 } else { 0.0 }));
    }

    #[test]
    fn wheels_lag_behind_a_fast_rotation_and_drag() {
        let grip_n = 7_000.0;
        // Rolling backwards after half a turn: the wheels still brake.
        let [[along, _]] = spin_lags_n([-30.0, 0.5, 4.0], grip_n, [120.0]);
        assert!(along > 0.0 && along <= grip_n, "{along}");
        // In a gentle curve the drag is that of the wheels' inertia, m_w r w.
        let [[along, _]]: [[f64; 2]; 1] = spin_lags_n([20.0, 1.0, 0.2], grip_n, [30.0]);
        assert!((along / (-30.0 * 0.2 * 1.0) - 1.0).abs() < 0.1, "{along}");
    }
}
