//! The equations of motion of the 4DOF vehicle: longitudinal, lateral, yaw and roll motion under
//! tire and collision forces. They are written only here and are generic over the scalar type, so
//! that the same lines serve for simulation and for exact Jacobians; the file is long because they
//! stand together.
//!
//! ```text
//! m (v̇_x − v_y r)   = ΣF_x,tire + F_x,coll + m g_x
//! m (v̇_y + v_x r)   = ΣF_y,tire + F_y,coll + m g_y
//! I_zz ṙ + I_xz φ̈   = M_z,tire + M_z,coll
//! I_xx φ̈ + I_xz ṙ   = m_s g h sin φ + m_s h a_y − K_φ φ − B φ̇ + M_x,coll      a_y = v̇_y + v_x r − g_y
//! Ẋ = v_x cos ψ − v_y sin ψ      Ẏ = v_x sin ψ + v_y cos ψ
//! ```
//!
//! Source: `eq:4dof`, `eq:4dof2` of [`PitPinnPaper`](crate::bibliography::PitPinnPaper).
//! g_x, g_y: weight along the road, 0 on a level one (`road_slope.rs`).
//! Assumes a rigid sprung mass on a roll axis along x, no pitch, no heave and no tire relaxation.
//! A wheel turns freely, turns against a brake or is locked; the inertia of its spin is that of a
//! steady rotation of the vehicle (`tire.rs`).
//! Aligning moments and suspension kinematics are left out.
//! Validated against multibody simulations (`docs/VALIDATION.md`).
//!
//! Departures from the paper:
//! - The roll equation contains m_s h a_y, and the coupling of yaw and roll by I_xz acts both ways.
//!   In the printed equations the tire forces do not excite roll except through the yaw
//!   acceleration, and roll does not influence yaw.
//! - The front tire forces are rotated by the steer angle δ into body axes.
//! - Tire forces and vertical loads depart from the paper as described in `tire.rs` and `loads.rs`.
//! - Tire forces depend on the vertical loads and these on the tire forces. This loop is resolved
//!   by two fixed-point passes that start from the static loads, so that the right-hand side
//!   remains a pure function of state and input.
//!
//! The printed form can be selected for comparison; see `as_printed.rs`.

use nalgebra::{SMatrix, SVector};
use num_dual::DualSVec64;
use pulp::NullaryFnOnce;

use crate::numerics::{Four, Lanes, LanesOver};
use crate::vehicle::constants::{BodyConstants, VehicleConstants};
use crate::vehicle::frames::Heading;
use crate::vehicle::loads::{LoadTransfer, vertical_loads_n};
use crate::vehicle::tire::{WheelEffort, WheelHold, WheelSlip};
use crate::vehicle::{
    CollisionForce, ContactPoint, Equations, N_STATE, VehicleInput, VehicleParameters, VehicleState,
};

/// Number of fixed-point passes by which vertical loads and tire forces are made consistent.
pub(super) const LOAD_PASSES: usize = 2;

/// Result of the equations of motion at one state and input.
#[derive(Debug, Clone, Copy)]
pub struct VehicleEvaluation<T> {
    /// Time derivative of the state.
    pub derivative: VehicleState<T>,
    /// Acceleration `[a_x, a_y]` of the CG in body axes, m/s².
    pub acceleration_body_m_s2: [T; 2],
    /// Vertical loads of the wheels, N, in the order of [`Wheel::ALL`](crate::vehicle::Wheel::ALL).
    pub vertical_loads_n: [T; 4],
    /// Collision force in body axes, N.
    pub collision_force_body_n: [T; 2],
    /// Yaw moment of the collision force about the CG, N m.
    pub collision_yaw_moment_n_m: T,
}

/// Resultant of forces in body axes: `[F_x, F_y]`, N, and the yaw moment M_z about the CG, N m.
#[derive(Clone, Copy)]
pub(super) struct Wrench<T> {
    pub(super) force_body_n: [T; 2],
    pub(super) yaw_moment_n_m: T,
}

impl VehicleParameters {
    /// Evaluates the right-hand side f(x, u) of the equations of motion once. Where it is evaluated
    /// more often, [`VehicleParameters::constants`] are prepared first.
    pub fn evaluate<T: Lanes>(
        &self,
        x: &VehicleState<T>,
        u: &VehicleInput<T>,
    ) -> VehicleEvaluation<T> {
        self.constants().evaluate(x, u)
    }

    /// Change of the accelerations by an additional force at the ground; see
    /// [`VehicleConstants::acceleration_of`].
    pub fn acceleration_of(&self, force_n: [f64; 2], yaw_moment_n_m: f64) -> [f64; 4] {
        self.constants().acceleration_of(force_n, yaw_moment_n_m)
    }

    /// Evaluates the right-hand side f, `[8]`, and its Jacobian ∂f/∂x, `[8, 8]`, both in the order
    /// of `eq:state_vector`. The Jacobian is exact, because the same equations are evaluated with
    /// dual numbers.
    pub fn jacobian(
        &self,
        x: &VehicleState<f64>,
        u: &VehicleInput<f64>,
    ) -> (SVector<f64, N_STATE>, SMatrix<f64, N_STATE, N_STATE>) {
        let constants = self.constants();
        let u = u.map(DualSVec64::<N_STATE>::from);
        let f = |x: SVector<DualSVec64<N_STATE>, N_STATE>| {
            let state = VehicleState::from_array(x.into());
            SVector::from(constants.evaluate(&state, &u).derivative.to_array())
        };
        num_dual::jacobian(f, &SVector::from(x.to_array()))
    }
}

impl VehicleConstants<f64> {
    /// What the road holds of the wheels at a state and an input.
    pub(super) fn wheel_holds(
        &self,
        x: &VehicleState<f64>,
        u: &VehicleInput<f64>,
    ) -> [WheelHold; 4] {
        let slips = self.wheel_slips(x, &Steer::new(u.steer_rad), u.friction_share.as_ref());
        slips.holds(self.evaluate(x, u).vertical_loads_n)
    }
}

impl<P: Copy> VehicleConstants<P> {
    /// Evaluates the right-hand side f(x, u) of the equations of motion, in the form that the vehicle
    /// has.
    pub fn evaluate<T: Lanes + LanesOver<P>>(
        &self,
        x: &VehicleState<T>,
        u: &VehicleInput<T>,
    ) -> VehicleEvaluation<T> {
        x.vx_body_m_s.apart(Evaluation { constants: self, x, u })
    }

    /// The time derivative of the state alone, `[8]`, in the order of `eq:state_vector`.
    #[inline(always)]
    pub fn derivative<T: Lanes + LanesOver<P>>(
        &self,
        x: &[T; N_STATE],
        u: &VehicleInput<T>,
    ) -> [T; N_STATE] {
        self.evaluate(&VehicleState::from_array(*x), u).derivative.to_array()
    }

    #[inline(always)]
    fn evaluate_corrected<T: Lanes + LanesOver<P>>(
        &self,
        x: &VehicleState<T>,
        u: &VehicleInput<T>,
    ) -> VehicleEvaluation<T> {
        let body = &self.body;
        let heading = Heading::new(x.yaw_rad);
        let collision = collision_wrench(heading, x.yaw_rad.constant(0.0), u.collision.as_ref());
        let leaning_n_m = x.roll_rad.sin() * body.weight_moment_n_m;
        let [arm_m, roll_arm_m] = match &u.collision {
            Some(CollisionForce { contact, .. }) => {
                [contact.height_m - body.cg_height_m, contact.height_m - body.roll_axis_height_m]
            }
            None => [x.yaw_rad.constant(0.0); 2],
        };
        let of_body = LoadTransfer {
            to_front_n_m: collision.force_body_n[0] * arm_m,
            to_right_n_m: leaning_n_m - collision.force_body_n[1] * arm_m,
        };
        let (tires, vertical_loads_n) = self.tire_wrench(x, u, of_body);

        let ax = (tires.force_body_n[0] + collision.force_body_n[0]) * body.per_mass_1_kg;
        let ay = (tires.force_body_n[1] + collision.force_body_n[1]) * body.per_mass_1_kg;
        let yaw_moment = tires.yaw_moment_n_m + collision.yaw_moment_n_m;
        let roll_moment = leaning_n_m + ay * body.sprung_moment_kg_m
            - x.roll_rad * body.roll_stiffness_n_m_rad
            - x.roll_rate_rad_s * body.roll_damping_n_m_s_rad
            - collision.force_body_n[1] * roll_arm_m;
        let [yaw_acceleration, roll_acceleration] = body.solve_yaw_roll(yaw_moment, roll_moment);
        let acceleration = self.with_weight_along(heading, [ax, ay]);
        VehicleEvaluation {
            derivative: x.derivative(heading, acceleration, [yaw_acceleration, roll_acceleration]),
            acceleration_body_m_s2: acceleration,
            vertical_loads_n,
            collision_force_body_n: collision.force_body_n,
            collision_yaw_moment_n_m: collision.yaw_moment_n_m,
        }
    }

    /// Change of the accelerations by an additional force at the ground, by the corrected equations
    /// of motion and without its effect on the vertical loads.
    ///
    /// - `force_n`: additional force in body axes, N;
    /// - `yaw_moment_n_m`: additional yaw moment about the CG, N m;
    /// - returns the changes of v̇_x and v̇_y, m/s², and of ṙ and φ̈, rad/s².
    #[inline(always)]
    pub fn acceleration_of<T: Lanes + LanesOver<P>>(
        &self,
        force_n: [T; 2],
        yaw_moment_n_m: T,
    ) -> [T; 4] {
        let [ax, ay] = [force_n[0] * self.body.per_mass_1_kg, force_n[1] * self.body.per_mass_1_kg];
        let roll_moment = ay * self.body.sprung_moment_kg_m;
        let [yaw, roll] = self.body.solve_yaw_roll(yaw_moment_n_m, roll_moment);
        [ax, ay, yaw, roll]
    }

    /// Acceleration of the CG by the forces, together with that by the weight along a road with a slope,
    /// `[a_x, a_y]` in body axes, m/s². The roll of the body follows the forces alone, since the weight acts
    /// on every part of it alike.
    #[inline(always)]
    pub(super) fn with_weight_along<T: Lanes + LanesOver<P>>(
        &self,
        heading: Heading<T>,
        [ax, ay]: [T; 2],
    ) -> [T; 2] {
        match self.slope_m_s2 {
            None => [ax, ay],
            Some([g_x, g_y]) => {
                let zero = ax.constant(0.0);
                let [down_x, down_y] = heading.body_from_world([zero + g_x, zero + g_y]);
                [ax + down_x, ay + down_y]
            }
        }
    }

    /// Resultant of the tire forces, and the vertical loads of the wheels, N.
    ///
    /// - `of_body`: load transfer by everything except the tire forces.
    #[inline(always)]
    fn tire_wrench<T: Lanes + LanesOver<P>>(
        &self,
        x: &VehicleState<T>,
        u: &VehicleInput<T>,
        of_body: LoadTransfer<T>,
    ) -> (Wrench<T>, [T; 4]) {
        let body = &self.body;
        let zero = x.vx_body_m_s.constant(0.0);
        let steer = Steer::new(u.steer_rad);
        let slips = self.wheel_slips(x, &steer, u.friction_share.as_ref());
        let free = slips.free();
        let efforts = u.wheels.as_ref().map(side_by_side);
        let [front_n, rear_n] = [zero + body.front_static_n, zero + body.rear_static_n];
        let mut loads_n = [front_n, front_n, rear_n, rear_n];
        let mut tires_n = [[zero; 4]; 2];
        for pass in 0..=LOAD_PASSES {
            if pass > 0 {
                let transfer = LoadTransfer {
                    to_front_n_m: of_body.to_front_n_m - sum(tires_n[0]) * body.cg_height_m,
                    to_right_n_m: of_body.to_right_n_m + sum(tires_n[1]) * body.cg_height_m,
                };
                loads_n = vertical_loads_n(body, transfer);
            }
            let [Four(along), Four(across)] = match &efforts {
                None => free.force_n(Four(loads_n)),
                Some(efforts) => slips.force_n(Four(loads_n), efforts),
            };
            let [x_fl, y_fl] = steer.body_from_wheel([along[0], across[0]]);
            let [x_fr, y_fr] = steer.body_from_wheel([along[1], across[1]]);
            tires_n = [[x_fl, x_fr, along[2], along[3]], [y_fl, y_fr, across[2], across[3]]];
        }
        let [[x_fl, x_fr, x_rl, x_rr], [y_fl, y_fr, y_rl, y_rr]] = tires_n;
        let yaw_moment_n_m = (y_fl + y_fr) * body.front_x_m
            + (y_rl + y_rr) * body.rear_x_m
            + (x_fr + x_rr - (x_fl + x_rl)) * body.half_track_m;
        (Wrench { force_body_n: [sum(tires_n[0]), sum(tires_n[1])], yaw_moment_n_m }, loads_n)
    }

    /// The slip of the four wheels, side by side in the order of [`Wheel::ALL`](crate::vehicle::Wheel::ALL).
    #[inline(always)]
    fn wheel_slips<T: Lanes + LanesOver<P>>(
        &self,
        x: &VehicleState<T>,
        steer: &Steer<T>,
        friction_share: Option<&[T; 4]>,
    ) -> WheelSlip<Four<T>> {
        let body = &self.body;
        let tires = self.tires.along(x.vx_body_m_s, Four::splat);
        let yaw_rate = x.yaw_rate_rad_s;
        let by_track = yaw_rate * body.half_track_m;
        let [left, right] = [x.vx_body_m_s - by_track, x.vx_body_m_s + by_track];
        let front = x.vy_body_m_s + yaw_rate * body.front_x_m;
        let rear = x.vy_body_m_s + yaw_rate * body.rear_x_m;
        let [u_fl, w_fl] = steer.wheel_from_body([left, front]);
        let [u_fr, w_fr] = steer.wheel_from_body([right, front]);
        let velocity_m_s = [Four([u_fl, u_fr, left, right]), Four([w_fl, w_fr, rear, rear])];
        let [of_front, of_rear] =
            [tires.front_stiffness_1_rad.0[0], tires.rear_stiffness_1_rad.0[0]];
        let stiffness = Four([of_front, of_front, of_rear, of_rear]);
        match friction_share {
            None => tires.slip(stiffness, velocity_m_s, Four::splat(yaw_rate)),
            Some(share) => tires.on_ground(Four(*share)).slip(
                stiffness / Four(*share),
                velocity_m_s,
                Four::splat(yaw_rate),
            ),
        }
    }
}

impl<P: Copy> BodyConstants<P> {
    /// Solves the coupled yaw and roll equations for `[ṙ, φ̈]`, rad/s², from the moments about the
    /// yaw and the roll axis, N m.
    #[inline(always)]
    fn solve_yaw_roll<T: Lanes + LanesOver<P>>(&self, yaw_moment: T, roll_moment: T) -> [T; 2] {
        [
            yaw_moment * self.yaw_by_yaw - roll_moment * self.yaw_by_roll,
            roll_moment * self.roll_by_roll - yaw_moment * self.yaw_by_roll,
        ]
    }
}

/// Sine and cosine of the steer angle; `None` where no front wheel is turned.
struct Steer<T>(Option<[T; 2]>);

impl<T: Lanes> Steer<T> {
    #[inline(always)]
    fn new(steer_rad: T) -> Self {
        if steer_rad.is_nothing() {
            return Self(None);
        }
        let (sin, cos) = steer_rad.sin_cos();
        Self(Some([sin, cos]))
    }

    #[inline(always)]
    fn wheel_from_body(&self, [u, w]: [T; 2]) -> [T; 2] {
        match self.0 {
            Some([sin, cos]) => [cos * u + sin * w, cos * w - sin * u],
            None => [u, w],
        }
    }

    #[inline(always)]
    fn body_from_wheel(&self, [along, across]: [T; 2]) -> [T; 2] {
        match self.0 {
            Some([sin, cos]) => [cos * along - sin * across, sin * along + cos * across],
            None => [along, across],
        }
    }
}

/// The equations of motion at a state and an input.
struct Evaluation<'a, P, T> {
    constants: &'a VehicleConstants<P>,
    x: &'a VehicleState<T>,
    u: &'a VehicleInput<T>,
}

impl<P: Copy, T: Lanes + LanesOver<P>> NullaryFnOnce for Evaluation<'_, P, T> {
    type Output = VehicleEvaluation<T>;

    #[inline(always)]
    fn call(self) -> VehicleEvaluation<T> {
        match self.constants.equations {
            Equations::Corrected => self.constants.evaluate_corrected(self.x, self.u),
            Equations::Paper => self.constants.evaluate_as_printed(self.x, self.u),
        }
    }
}

/// Sum of a quantity of the wheels.
#[inline(always)]
fn sum<T: Lanes>([front_left, front_right, rear_left, rear_right]: [T; 4]) -> T {
    front_left + front_right + (rear_left + rear_right)
}

/// The efforts of the four wheels, side by side.
#[inline(always)]
fn side_by_side<T: Lanes>([fl, fr, rl, rr]: &[WheelEffort<T>; 4]) -> WheelEffort<Four<T>> {
    WheelEffort {
        drive_n: Four([fl.drive_n, fr.drive_n, rl.drive_n, rr.drive_n]),
        braking_n: Four([fl.braking_n, fr.braking_n, rl.braking_n, rr.braking_n]),
        locked: Four([fl.locked, fr.locked, rl.locked, rr.locked]),
    }
}

/// The collision force in body axes and its yaw moment about the CG; zero without a collision
/// force.
#[inline(always)]
pub(super) fn collision_wrench<T: Lanes>(
    heading: Heading<T>,
    zero: T,
    collision: Option<&CollisionForce<T>>,
) -> Wrench<T> {
    let Some(collision) = collision else {
        return Wrench { force_body_n: [zero; 2], yaw_moment_n_m: zero };
    };
    let force_body_n = match collision.in_world_axes {
        true => heading.body_from_world(collision.force_n),
        false => collision.force_n,
    };
    let ContactPoint { x_body_m, y_body_m, .. } = collision.contact;
    let at_contact = force_body_n[1] * x_body_m - force_body_n[0] * y_body_m;
    Wrench { force_body_n, yaw_moment_n_m: collision.yaw_moment_n_m.unwrap_or(at_contact) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vehicle::Preset;

    #[test]
    fn an_effort_of_zero_is_none() {
        let vehicle = Preset::Reference.parameters();
        for (vx_body_m_s, vy_body_m_s, yaw_rate_rad_s) in
            [(20.0, 1.0, 0.3), (-8.0, 3.0, -2.0), (0.0, 5.0, 1.0), (0.0, 0.0, 0.0)]
        {
            let x = VehicleState {
                vx_body_m_s,
                vy_body_m_s,
                yaw_rate_rad_s,
                ..VehicleState::default()
            };
            let free = VehicleInput { steer_rad: 0.05, ..VehicleInput::released() };
            let driven = VehicleInput { wheels: Some([WheelEffort::none(); 4]), ..free };
            let [(free, by_free), (driven, by_driven)] =
                [free, driven].map(|u| vehicle.jacobian(&x, &u));
            assert!((free - driven).amax() < 1e-12, "{x:?}: {free} {driven}");
            assert!((by_free - by_driven).amax() < 1e-9, "{x:?}: {by_free} {by_driven}");
        }
    }
}
