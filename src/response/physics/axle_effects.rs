//! The effects of an axle that the 4DOF model leaves out; what they are stands in `effects.rs`.

use crate::numerics::Scalar;
use crate::response::N_RESIDUAL;
use crate::vehicle::{VehicleEvaluation, VehicleParameters, VehicleState};

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

/// Slip angles at which the axle characteristic is corrected.
pub(super) const N_SLIP_KNOTS: usize = SLIP_KNOTS_RAD.len();
/// Effects of an axle: characteristic, drag, spin lag, relaxation, load transfer.
pub(super) const N_PER_AXLE: usize = N_SLIP_KNOTS + 4 + 2 * WHEEL_MASS_SHARES.len() + 2;
/// Share of the friction at a strength of one of the characteristic.
pub(super) const CHARACTERISTIC_SCALE: f64 = 0.125;

/// One axle.
pub(super) struct Axle<'a, T> {
    vehicle: &'a VehicleParameters,
    /// Distance of the axle from the CG, positive forward, m.
    arm_m: f64,
    /// v̇_x, v̇_y, ṙ, φ̈ by a side force of 1 N.
    by_side_force: [f64; N_RESIDUAL],
    /// v̇_x by a force of 1 N along the car.
    by_along_force: f64,
    cornering_coefficient: f64,
    /// Vertical loads of the left and of the right wheel, N.
    loads_n: [T; 2],
}

impl<'a, T: Scalar> Axle<'a, T> {
    /// - `arm_m`: from the CG, forward; `loads_n`: of its left and its right wheel.
    pub(super) fn new(
        vehicle: &'a VehicleParameters,
        arm_m: f64,
        cornering_coefficient: f64,
        loads_n: [T; 2],
    ) -> Self {
        let by_side_force = vehicle.acceleration_of([0.0, 1.0], arm_m);
        let by_along_force = 1.0 / vehicle.mass.mass_kg;
        Self { vehicle, arm_m, by_side_force, by_along_force, cornering_coefficient, loads_n }
    }

    /// The effects of the axle, in order.
    ///
    /// - `out`: all zero.
    pub(super) fn effects(
        &self,
        x: &VehicleState<T>,
        now: &VehicleEvaluation<T>,
        out: &mut [[T; N_RESIDUAL]; N_PER_AXLE],
    ) {
        let friction = self.vehicle.tires.friction;
        let load_n = self.loads_n[0] + self.loads_n[1];
        let u = x.vx_m_s;
        let w = x.vy_m_s + x.yaw_rate_rad_s * self.arm_m;
        let slope = w / (u.abs() + SLOW_M_S);
        let slip_rad = -slope.atan();
        let grip_n = load_n * friction;
        let (characteristic, others) = out.split_at_mut(N_SLIP_KNOTS);
        let hat_force_n = grip_n * (CHARACTERISTIC_SCALE * sign(slip_rad));
        for (knot_idx, height) in hats(slip_rad.abs() * (KNOT_FRICTION / friction)) {
            if let Some(slot) = characteristic.get_mut(knot_idx) {
                *slot = self.side_force(height * hat_force_n);
            }
        }
        let mut others = others.iter_mut();
        let mut put = |acceleration| {
            if let Some(slot) = others.next() {
                *slot = acceleration;
            }
        };
        let cos = (slope * slope + 1.0).sqrt().recip();
        let sin = slope.abs() * cos;
        let drag_n = grip_n * (u / SLOW_M_S).tanh() * -0.125;
        for shape in [sin, sin * sin, sin * cos * 2.0, cos] {
            put(self.along_force(shape * drag_n));
        }
        let masses_kg = WHEEL_MASS_SHARES.map(|share| 2.0 * share * self.vehicle.mass.mass_kg);
        for [along, across] in spin_lags_n([u, w, x.yaw_rate_rad_s], grip_n, masses_kg) {
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
    fn relaxation_n(&self, [u, w, slip_rad]: [T; 3], now: &VehicleEvaluation<T>, load_n: T) -> T {
        let rate = &now.derivative;
        let across = rate.vy_m_s + rate.yaw_rate_rad_s * self.arm_m;
        let speed_squared = u * u + w * w + SLOW_M_S * SLOW_M_S;
        let turning = -(across * u.abs() - w * rate.vx_m_s * sign(u)) / speed_squared;
        let stiffness = slip_rad * (self.cornering_coefficient / self.vehicle.tires.friction);
        let flattening = stiffness * stiffness + 1.0;
        let slope = load_n * self.cornering_coefficient / (flattening * flattening.sqrt());
        let force_n = -slope * turning * RELAXATION_LENGTH_M / speed_squared.sqrt();
        let limit_n = load_n * RELAXATION_LIMIT;
        force_n.clamped(-limit_n, limit_n)
    }

    fn side_force(&self, force_n: T) -> [T; N_RESIDUAL] {
        self.by_side_force.map(|acceleration| force_n * acceleration)
    }

    fn along_force(&self, force_n: T) -> [T; N_RESIDUAL] {
        [force_n * self.by_along_force, T::from(0.0), T::from(0.0), T::from(0.0)]
    }
}

/// Drag, and the loss of side force, of an axle whose wheels roll slower or faster than they move, N,
/// for each mass.
fn spin_lags_n<T: Scalar, const N: usize>(
    [u, w, yaw_rate]: [T; 3],
    grip_n: T,
    masses_kg: [f64; N],
) -> [[T; 2]; N] {
    let yaw_rate_per_grip = yaw_rate / (grip_n + 100.0);
    let rest = w * w + 0.1;
    let across = rest.sqrt();
    let (mut slips, mut alongs) = ([w.abs() + 0.3; N], [T::from(0.0); N]);
    // All masses in a pass: their divisions and roots do not wait for each other.
    for _ in 0..SPIN_LAG_PASSES {
        for ((slip, along), mass_kg) in slips.iter_mut().zip(&mut alongs).zip(masses_kg) {
            let turned = yaw_rate_per_grip * *slip * mass_kg;
            let rolling = (u - turned * w) / (turned * turned + 1.0);
            *along = u - rolling;
            *slip = (*along * *along + rest).sqrt();
        }
    }
    std::array::from_fn(|i| {
        let lost = w / slips[i] - w / across;
        [-grip_n * alongs[i] / slips[i], -grip_n * lost]
    })
}

/// The hat functions over [`SLIP_KNOTS_RAD`] that are not zero, with their heights: those of the knots
/// below and above.
fn hats<T: Scalar>(slip_rad: T) -> [(usize, T); 2] {
    let above = SLIP_KNOTS_RAD.partition_point(|knot| *knot < slip_rad.re());
    match (above.checked_sub(1), SLIP_KNOTS_RAD.get(above)) {
        (Some(below), Some(high)) => {
            let low = SLIP_KNOTS_RAD[below];
            let share = (slip_rad - low) / (high - low);
            [(below, -(share - 1.0)), (above, share)]
        }
        (None, Some(high)) => [(above, slip_rad / *high), (above + 1, T::from(0.0))],
        (_, None) => [(N_SLIP_KNOTS - 2, T::from(0.0)), (N_SLIP_KNOTS - 1, T::from(1.0))],
    }
}

/// Sign of a number, 0 at 0.
fn sign<T: Scalar>(x: T) -> f64 {
    if x.re() == 0.0 { 0.0 } else { x.re().signum() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hats_sum_to_one_between_the_knots_and_beyond() {
        for slip in [0.01_f64, 0.02, 0.3, 1.0, 1.5] {
            let [(below, low), (above, high)] = hats(slip);
            assert!((low + high - 1.0).abs() < 1e-12 && above == below + 1, "{slip}: {low} {high}");
        }
        assert_eq!(hats(0.005)[0], (0, 0.5));
        assert_eq!(hats(0.15), [(3, 0.0), (4, 1.0)]);
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
