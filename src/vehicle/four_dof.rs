//! The equations of motion of the 4DOF vehicle: longitudinal, lateral, yaw and roll motion under
//! tyre and collision forces. They are written only here and are generic over the scalar type, so
//! that the same lines serve for simulation and for exact Jacobians.
//!
//! ```text
//! m (v̇_x − v_y r)   = ΣF_x,tire + F_x,coll
//! m (v̇_y + v_x r)   = ΣF_y,tire + F_y,coll
//! I_zz ṙ + I_xz φ̈   = M_z,tire + M_z,coll
//! I_xx φ̈ + I_xz ṙ   = m_s g h sin φ + m_s h a_y − K_φ φ − B φ̇ + M_x,coll      a_y = v̇_y + v_x r
//! Ẋ = v_x cos ψ − v_y sin ψ      Ẏ = v_x sin ψ + v_y cos ψ
//! ```
//!
//! Source: `eq:4dof`, `eq:4dof2` of [`PitPinnPaper`](crate::bibliography::PitPinnPaper).
//! Assumes a rigid sprung mass on a roll axis along x, no pitch, no heave and no tyre relaxation.
//! A wheel turns freely, turns against a brake or is locked; the inertia of its spin is that of a
//! steady rotation of the vehicle (`tire.rs`).
//! Aligning moments and suspension kinematics are left out.
//! Validated against multibody simulations (`docs/VALIDATION.md`).
//!
//! Departures from the paper:
//! - The roll equation contains m_s h a_y, and the coupling of yaw and roll by I_xz acts both ways.
//!   In the printed equations the tyre forces do not excite roll except through the yaw
//!   acceleration, and roll does not influence yaw.
//! - The front tyre forces are rotated by the steer angle δ into body axes.
//! - Tyre forces and vertical loads depart from the paper as described in `tire.rs` and `loads.rs`.
//! - Tyre forces depend on the vertical loads and these on the tyre forces. This loop is resolved
//!   by two fixed-point passes that start from the static loads, so that the right-hand side
//!   remains a pure function of state and input.
//!
//! The printed form can be selected for comparison; see `as_printed.rs`.

use nalgebra::{SMatrix, SVector};
use num_dual::DualSVec64;

use serde::{Deserialize, Serialize};

use crate::numerics::Lanes;
use crate::units::STANDARD_GRAVITY_M_S2;
use crate::vehicle::frames::body_from_world;
use crate::vehicle::loads::{LoadTransfer, Wheel, vertical_loads_n};
use crate::vehicle::tire::{WheelEffort, WheelSlip};
use crate::vehicle::{Equations, N_STATE, VehicleParameters, VehicleState};

/// Number of fixed-point passes by which vertical loads and tyre forces are made consistent.
pub(super) const LOAD_PASSES: usize = 2;

/// Point of the vehicle at which the collision force acts.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ContactPoint {
    /// Coordinate x of the point in body axes, m: its distance in front of the CG.
    pub x_m: f64,
    /// Coordinate y of the point in body axes, m: its distance to the left of the CG.
    pub y_m: f64,
    /// Height of the point above the ground, m.
    pub height_m: f64,
}

/// Collision force that acts ON the vehicle at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CollisionForce<T> {
    /// Force `[F_x, F_y]` in world or body axes, N.
    pub force_n: [T; 2],
    /// Whether `force_n` is given in world axes, so that it has to be rotated by the yaw angle ψ
    /// into body axes.
    pub in_world_axes: bool,
    /// Yaw moment about the CG, N m. If it is `None`, the moment `x_c F_y − y_c F_x` of the force
    /// at the contact point is used.
    pub yaw_moment_n_m: Option<T>,
    /// Contact point.
    pub contact: ContactPoint,
}

/// Input u(t) of the equations of motion: steer angle, drive and brakes of the wheels, collision
/// force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VehicleInput<T> {
    /// Steer angle δ of the front road wheels, rad, positive to the left.
    pub steer_rad: T,
    /// What drives, brakes or locks each wheel, in the order of [`Wheel::ALL`]. With `None` all
    /// wheels roll freely.
    pub wheels: Option<[WheelEffort<T>; 4]>,
    /// Collision force; `None` if there is no contact.
    pub collision: Option<CollisionForce<T>>,
}

impl<T: Lanes> VehicleInput<T> {
    /// Input of a vehicle that coasts: steering wheel, throttle and brake are released (δ = 0, all
    /// wheels roll freely) and there is no contact.
    pub fn released() -> Self {
        Self { steer_rad: T::from(0.0), wheels: None, collision: None }
    }

    /// Whether a wheel is driven, so that the energy of the vehicle may grow.
    pub fn is_driven(&self) -> bool {
        let zero = T::from(0.0);
        let wheels = self.wheels.iter().flatten();
        wheels.into_iter().any(|wheel| zero.any_less(wheel.drive_n.abs()))
    }

    /// Converts every component to another scalar type.
    pub fn map<U: Lanes>(self, convert: impl Fn(T) -> U + Copy) -> VehicleInput<U> {
        VehicleInput {
            steer_rad: convert(self.steer_rad),
            wheels: self.wheels.map(|wheels| wheels.map(|wheel| wheel.map(convert))),
            collision: self.collision.map(|collision| CollisionForce {
                force_n: collision.force_n.map(convert),
                in_world_axes: collision.in_world_axes,
                yaw_moment_n_m: collision.yaw_moment_n_m.map(convert),
                contact: collision.contact,
            }),
        }
    }
}

/// Result of the equations of motion at one state and input.
#[derive(Debug, Clone, Copy)]
pub struct VehicleEvaluation<T> {
    /// Time derivative of the state.
    pub derivative: VehicleState<T>,
    /// Acceleration `[a_x, a_y]` of the CG in body axes, m/s².
    pub acceleration_m_s2: [T; 2],
    /// Vertical loads of the wheels, N, in the order of [`Wheel::ALL`].
    pub vertical_loads_n: [T; 4],
    /// Collision force in body axes, N.
    pub collision_force_n: [T; 2],
    /// Yaw moment of the collision force about the CG, N m.
    pub collision_yaw_moment_n_m: T,
}

impl<T: Lanes> VehicleEvaluation<T> {
    /// Converts every component to another scalar type.
    pub(crate) fn map<U: Lanes>(self, convert: impl Fn(T) -> U + Copy) -> VehicleEvaluation<U> {
        VehicleEvaluation {
            derivative: self.derivative.map(convert),
            acceleration_m_s2: self.acceleration_m_s2.map(convert),
            vertical_loads_n: self.vertical_loads_n.map(convert),
            collision_force_n: self.collision_force_n.map(convert),
            collision_yaw_moment_n_m: convert(self.collision_yaw_moment_n_m),
        }
    }
}

/// Resultant of forces in body axes: `[F_x, F_y]`, N, and the yaw moment M_z about the CG, N m.
#[derive(Clone, Copy)]
pub(super) struct Wrench<T> {
    pub(super) force_n: [T; 2],
    pub(super) yaw_moment_n_m: T,
}

impl VehicleParameters {
    /// Evaluates the right-hand side f(x, u) of the equations of motion, in the form that
    /// [`VehicleParameters::equations`] selects.
    pub fn evaluate<T: Lanes>(
        &self,
        x: &VehicleState<T>,
        u: &VehicleInput<T>,
    ) -> VehicleEvaluation<T> {
        if self.equations == Equations::Paper {
            return self.evaluate_as_printed(x, u);
        }
        let collision = collision_wrench(x.yaw_rad, u.collision.as_ref());
        let contact_height_m =
            u.collision.map_or(self.geometry.cg_height_m, |c| c.contact.height_m);
        let leaning_n_m = self.gravity_roll_moment_n_m(x.roll_rad);
        let contact_arm_m = contact_height_m - self.geometry.cg_height_m;
        let of_body = LoadTransfer {
            to_front_n_m: collision.force_n[0] * contact_arm_m,
            to_right_n_m: leaning_n_m - collision.force_n[1] * contact_arm_m,
        };
        let (tires, vertical_loads_n) = self.tire_wrench(x, u, of_body);

        let mass_kg = self.mass.mass_kg;
        let ax = (tires.force_n[0] + collision.force_n[0]) / mass_kg;
        let ay = (tires.force_n[1] + collision.force_n[1]) / mass_kg;
        let yaw_moment = tires.yaw_moment_n_m + collision.yaw_moment_n_m;
        let roll_moment = leaning_n_m + self.roll_moment_n_m(x, ay)
            - collision.force_n[1] * (contact_height_m - self.suspension.roll_axis_height_m);
        let [yaw_acceleration, roll_acceleration] = self.solve_yaw_roll(yaw_moment, roll_moment);
        VehicleEvaluation {
            derivative: x.derivative([ax, ay], [yaw_acceleration, roll_acceleration]),
            acceleration_m_s2: [ax, ay],
            vertical_loads_n,
            collision_force_n: collision.force_n,
            collision_yaw_moment_n_m: collision.yaw_moment_n_m,
        }
    }

    /// Evaluates the right-hand side f, `[8]`, and its Jacobian ∂f/∂x, `[8, 8]`, both in the order
    /// of `eq:state_vector`. The Jacobian is exact, because the same equations are evaluated with
    /// dual numbers.
    pub fn jacobian(
        &self,
        x: &VehicleState<f64>,
        u: &VehicleInput<f64>,
    ) -> (SVector<f64, N_STATE>, SMatrix<f64, N_STATE, N_STATE>) {
        let u = u.map(DualSVec64::<N_STATE>::from);
        let f = |x: SVector<DualSVec64<N_STATE>, N_STATE>| {
            let state = VehicleState::from_array(x.into());
            SVector::from(self.evaluate(&state, &u).derivative.to_array())
        };
        num_dual::jacobian(f, &SVector::from(x.to_array()))
    }

    /// Change of the accelerations by an additional force at the ground, by the corrected equations
    /// of motion and without its effect on the vertical loads.
    ///
    /// - `force_n`: additional force in body axes, N;
    /// - `yaw_moment_n_m`: additional yaw moment about the CG, N m;
    /// - returns the changes of v̇_x and v̇_y, m/s², and of ṙ and φ̈, rad/s².
    pub fn acceleration_of<T: Lanes>(&self, force_n: [T; 2], yaw_moment_n_m: T) -> [T; 4] {
        let [ax, ay] = force_n.map(|force| force / self.mass.mass_kg);
        let roll_moment = ay * (self.mass.sprung_mass_kg * self.suspension.roll_arm_m);
        let [yaw, roll] = self.solve_yaw_roll(yaw_moment_n_m, roll_moment);
        [ax, ay, yaw, roll]
    }

    /// Resultant of the tyre forces, and the vertical loads of the wheels, N.
    ///
    /// - `of_body`: load transfer by everything except the tyre forces.
    fn tire_wrench<T: Lanes>(
        &self,
        x: &VehicleState<T>,
        u: &VehicleInput<T>,
        of_body: LoadTransfer<T>,
    ) -> (Wrench<T>, [T; 4]) {
        let (sin_steer, cos_steer) = u.steer_rad.sin_cos();
        let slips = self.wheel_slips(x, [sin_steer, cos_steer]);
        let in_body_axes = |wheel_idx: usize, [along, across]: [T; 2]| {
            if Wheel::ALL[wheel_idx].is_front() {
                [cos_steer * along - sin_steer * across, sin_steer * along + cos_steer * across]
            } else {
                [along, across]
            }
        };
        let forces_n = |loads_n: &[T; 4]| -> [[T; 2]; 4] {
            std::array::from_fn(|i| match &u.wheels {
                None => in_body_axes(i, slips[i].free_n(loads_n[i])),
                Some(wheels) => in_body_axes(i, slips[i].force_n(loads_n[i], &wheels[i])),
            })
        };

        let cg_height_m = self.geometry.cg_height_m;
        let mut loads_n = vertical_loads_n(self, LoadTransfer::none());
        let mut tires_n = forces_n(&loads_n);
        for _ in 0..LOAD_PASSES {
            let [fx, fy] = sum(&tires_n);
            loads_n = vertical_loads_n(
                self,
                LoadTransfer {
                    to_front_n_m: of_body.to_front_n_m - fx * cg_height_m,
                    to_right_n_m: of_body.to_right_n_m + fy * cg_height_m,
                },
            );
            tires_n = forces_n(&loads_n);
        }
        let mut yaw_moment_n_m = T::from(0.0);
        for (wheel, [fx, fy]) in Wheel::ALL.into_iter().zip(tires_n) {
            let [px, py] = wheel.position_m(self);
            yaw_moment_n_m += fy * px - fx * py;
        }
        (Wrench { force_n: sum(&tires_n), yaw_moment_n_m }, loads_n)
    }

    fn wheel_slips<T: Lanes>(
        &self,
        x: &VehicleState<T>,
        [sin_steer, cos_steer]: [T; 2],
    ) -> [WheelSlip<T>; 4] {
        let tires = &self.tires;
        let cornering_coefficients_per_rad = Wheel::ALL.map(|wheel| match wheel.is_front() {
            true => tires.cornering_coefficient_front_per_rad,
            false => tires.cornering_coefficient_rear_per_rad,
        });
        let velocities_m_s = Wheel::ALL.map(|wheel| {
            let [px, py] = wheel.position_m(self);
            let u = x.vx_m_s - x.yaw_rate_rad_s * py;
            let w = x.vy_m_s + x.yaw_rate_rad_s * px;
            match wheel.is_front() {
                true => [cos_steer * u + sin_steer * w, cos_steer * w - sin_steer * u],
                false => [u, w],
            }
        });
        tires.slips(cornering_coefficients_per_rad, velocities_m_s, x.yaw_rate_rad_s)
    }

    /// Moment of the weight of the sprung mass about the roll axis, `m_s g h sin φ`, N m.
    pub(super) fn gravity_roll_moment_n_m<T: Lanes>(&self, roll_rad: T) -> T {
        let sprung_kg = self.mass.sprung_mass_kg;
        roll_rad.sin() * (sprung_kg * STANDARD_GRAVITY_M_S2 * self.suspension.roll_arm_m)
    }

    /// Right-hand side of the roll equation without the moments of weight and collision force, N m:
    /// `m_s h a_y − K_φ φ − B φ̇`.
    fn roll_moment_n_m<T: Lanes>(&self, x: &VehicleState<T>, ay_m_s2: T) -> T {
        let suspension = &self.suspension;
        ay_m_s2 * (self.mass.sprung_mass_kg * suspension.roll_arm_m)
            - x.roll_rad * suspension.roll_stiffness_n_m_rad
            - x.roll_rate_rad_s * suspension.roll_damping_n_m_s_rad
    }

    /// Solves the coupled yaw and roll equations for `[ṙ, φ̈]`, rad/s², from the moments about the
    /// yaw and the roll axis, N m.
    fn solve_yaw_roll<T: Lanes>(&self, yaw_moment: T, roll_moment: T) -> [T; 2] {
        let (izz, ixx) = (self.mass.yaw_inertia_kg_m2, self.mass.roll_inertia_kg_m2);
        let ixz = self.mass.roll_yaw_product_kg_m2;
        let determinant = izz * ixx - ixz * ixz; // > 0: checked with the parameters
        [
            (yaw_moment * ixx - roll_moment * ixz) / determinant,
            (roll_moment * izz - yaw_moment * ixz) / determinant,
        ]
    }
}

/// Sum of the forces of the wheels.
fn sum<T: Lanes>(forces_n: &[[T; 2]; 4]) -> [T; 2] {
    let [front_left, front_right, rear_left, rear_right] = forces_n;
    std::array::from_fn(|i| front_left[i] + front_right[i] + (rear_left[i] + rear_right[i]))
}

/// The collision force in body axes and its yaw moment about the CG; zero without a collision
/// force.
pub(super) fn collision_wrench<T: Lanes>(
    yaw_rad: T,
    collision: Option<&CollisionForce<T>>,
) -> Wrench<T> {
    let zero = T::from(0.0);
    let Some(collision) = collision else {
        return Wrench { force_n: [zero; 2], yaw_moment_n_m: zero };
    };
    let force_n = if collision.in_world_axes {
        body_from_world(yaw_rad, collision.force_n)
    } else {
        collision.force_n
    };
    let ContactPoint { x_m, y_m, .. } = collision.contact;
    let at_contact = force_n[1] * x_m - force_n[0] * y_m;
    Wrench { force_n, yaw_moment_n_m: collision.yaw_moment_n_m.unwrap_or(at_contact) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vehicle::Preset;

    #[test]
    fn an_effort_of_zero_is_none() {
        let vehicle = Preset::Reference.parameters();
        for (vx_m_s, vy_m_s, yaw_rate_rad_s) in
            [(20.0, 1.0, 0.3), (-8.0, 3.0, -2.0), (0.0, 5.0, 1.0), (0.0, 0.0, 0.0)]
        {
            let x = VehicleState { vx_m_s, vy_m_s, yaw_rate_rad_s, ..VehicleState::default() };
            let free = VehicleInput { steer_rad: 0.05, ..VehicleInput::released() };
            let driven = VehicleInput { wheels: Some([WheelEffort::none(); 4]), ..free };
            let [(free, by_free), (driven, by_driven)] =
                [free, driven].map(|u| vehicle.jacobian(&x, &u));
            assert!((free - driven).amax() < 1e-12, "{x:?}: {free} {driven}");
            assert!((by_free - by_driven).amax() < 1e-9, "{x:?}: {by_free} {by_driven}");
        }
    }
}
