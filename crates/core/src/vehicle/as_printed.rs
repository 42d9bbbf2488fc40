//! The equations of motion of the 4DOF vehicle exactly as the paper prints them. They serve as an
//! ablation, which shows the effect of the corrections in `four_dof.rs`, `tire.rs` and `loads.rs`,
//! and are selected by [`Equations::Paper`].
//!
//! Source: `eq:4dof` to `eq:tire_model4` of [`PitPinnPaper`](crate::bibliography::PitPinnPaper),
//! with the printed signs:
//!
//! - The tire force has a leading minus, which together with the printed slip angle supplies energy
//!   to the vehicle.
//! - The rolling resistance acts in the direction of motion.
//! - Vertical loads may become negative.
//! - The lateral acceleration does not enter the roll equation. Yaw influences roll by I_xz, but
//!   roll does not influence yaw.
//! - The front tire forces are not rotated by the steer angle δ.
//!
//! Zones of the ground with their own friction, and the slope of the road, are honoured as by the corrected equations.
//!
//! Drive and brake forces and the fall of friction beyond its peak are not part of these equations;
//! the inputs and parameters for them have no effect. The paper does not say how the loop of loads,
//! forces, accelerations and loads is resolved; here this is done by fixed-point passes as in
//! `four_dof.rs`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::numerics::{Lanes, LanesOver};
use crate::vehicle::constants::VehicleConstants;
use crate::vehicle::four_dof::{LOAD_PASSES, collision_wrench};
use crate::vehicle::frames::Heading;
use crate::vehicle::{VehicleEvaluation, VehicleInput, VehicleState};

/// The form of the equations of motion of the 4DOF vehicle.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Equations {
    /// The equations of the paper with the corrections that are described in `four_dof.rs`,
    /// `tire.rs` and `loads.rs`.
    #[default]
    Corrected,
    /// The equations as the paper prints them, for comparison.
    Paper,
}

impl<P: Copy> VehicleConstants<P> {
    /// The right-hand side of the equations of motion as the paper prints them.
    #[inline(always)]
    pub(super) fn evaluate_as_printed<T: Lanes + LanesOver<P>>(
        &self,
        x: &VehicleState<T>,
        u: &VehicleInput<T>,
    ) -> VehicleEvaluation<T> {
        let (body, printed) = (&self.body, &self.printed);
        let zero = x.vx_body_m_s.constant(0.0);
        let heading = Heading::new(x.yaw_rad);
        let collision = collision_wrench(heading, zero, u.collision.as_ref());
        let leaning_n_m = x.roll_rad.sin() * body.weight_moment_n_m;
        let mut acceleration = [zero; 2];
        let mut loads = [zero; 4];
        let mut yaw_moment = collision.yaw_moment_n_m;
        for _ in 0..=LOAD_PASSES {
            loads = self.loads_as_printed(acceleration, leaning_n_m);
            let ([fx, fy], tire_moment) = self.tires_as_printed(x, u, &loads);
            acceleration = [
                (fx + collision.force_body_n[0]) * body.per_mass_1_kg,
                (fy + collision.force_body_n[1]) * body.per_mass_1_kg,
            ];
            yaw_moment = tire_moment + collision.yaw_moment_n_m;
        }
        let yaw_acceleration = yaw_moment / printed.yaw_inertia_kg_m2;
        let roll_arm_m = match &u.collision {
            Some(collision) => collision.contact.height_m - body.roll_axis_height_m,
            None => zero,
        };
        let roll_moment = leaning_n_m
            - x.roll_rad * body.roll_stiffness_n_m_rad
            - x.roll_rate_rad_s * body.roll_damping_n_m_s_rad
            - collision.force_body_n[1] * roll_arm_m
            - yaw_acceleration * printed.roll_yaw_product_kg_m2;
        let roll_acceleration = roll_moment / printed.roll_inertia_kg_m2;
        let acceleration = self.with_weight_along(heading, acceleration);
        VehicleEvaluation {
            derivative: x.derivative(heading, acceleration, [yaw_acceleration, roll_acceleration]),
            acceleration_body_m_s2: acceleration,
            vertical_loads_n: loads,
            collision_force_body_n: collision.force_body_n,
            collision_yaw_moment_n_m: collision.yaw_moment_n_m,
        }
    }

    /// Tire forces by `eq:tire_model` to `eq:tire_model3`, summed by `eq:4dof2`: `[F_x, F_y]`, N,
    /// and the yaw moment M_z, N m.
    #[inline(always)]
    fn tires_as_printed<T: Lanes + LanesOver<P>>(
        &self,
        x: &VehicleState<T>,
        u: &VehicleInput<T>,
        loads_n: &[T; 4],
    ) -> ([T; 2], T) {
        let (body, tires) = (&self.body, &self.tires);
        let zero = x.vx_body_m_s.constant(0.0);
        let speed = x.vx_body_m_s;
        let resistance = speed * speed * tires.rolling_resistance_s2_m2
            + speed * tires.rolling_resistance_s_m
            + tires.rolling_resistance;
        let (half_track, front, rear) =
            (zero + body.half_track_m, zero + body.front_x_m, zero + body.rear_x_m);
        let (of_front, of_rear) =
            ((u.steer_rad, tires.front_stiffness_1_rad), (zero, tires.rear_stiffness_1_rad));
        let wheels = [
            (front, half_track, of_front),
            (front, -half_track, of_front),
            (rear, half_track, of_rear),
            (rear, -half_track, of_rear),
        ];
        let (mut force, mut moment) = ([zero; 2], zero);
        for (i, ((px, py, (steer, stiffness)), &load)) in
            wheels.into_iter().zip(loads_n).enumerate()
        {
            let share = u.friction_share.map(|shares| shares[i]);
            let course = ((x.vy_body_m_s + x.yaw_rate_rad_s * px)
                / (x.vx_body_m_s - x.yaw_rate_rad_s * py))
                .atan();
            let stiffness = (steer - course) * stiffness;
            let stiffness = share.map_or(stiffness, |share| stiffness / share);
            let fx = resistance * load;
            let limit = load * tires.friction;
            let limit = share.map_or(limit, |share| limit * share);
            let fy = -(stiffness / (stiffness * stiffness + 1.0).sqrt())
                * (limit * limit - fx * fx).sqrt();
            force[0] += fx;
            force[1] += fy;
            moment += fy * px - fx * py;
        }
        (force, moment)
    }

    /// Vertical loads by `eq:tire_model4`, N, in the order of
    /// [`Wheel::ALL`](crate::vehicle::Wheel::ALL). The lateral load transfer is divided between the
    /// axles by CORNERING stiffness, as printed.
    ///
    /// - `leaning_n_m`: moment of the weight about the roll axis, N m.
    #[inline(always)]
    fn loads_as_printed<T: Lanes + LanesOver<P>>(
        &self,
        [ax, ay]: [T; 2],
        leaning_n_m: T,
    ) -> [T; 4] {
        let (body, printed) = (&self.body, &self.printed);
        let pitch = ax * printed.pitch_kg;
        let [front, rear] = [-pitch + body.front_static_n, pitch + body.rear_static_n];
        let lateral = ay * printed.lateral_kg + leaning_n_m * printed.per_track_1_m;
        let (shift_front, shift_rear) =
            (lateral * printed.front_share, lateral * printed.rear_share);
        [front - shift_front, front + shift_front, rear - shift_rear, rear + shift_rear]
    }
}

#[cfg(test)]
mod tests {
    use crate::data::Channel;
    use crate::vehicle::{Equations, Integrator, Manoeuvre, Preset, VehicleState};

    #[test]
    fn the_printed_signs_diverge_where_the_corrected_ones_recover() {
        let lateral_speed = |equations| {
            let vehicle = Preset::Reference.parameters().with_equations(equations);
            let manoeuvre = Manoeuvre {
                initial: VehicleState {
                    yaw_rate_rad_s: 0.05,
                    ..VehicleState::driving_straight(20.0)
                },
                duration_s: 2.0,
                ..Manoeuvre::default()
            };
            let motion = vehicle.simulate(&manoeuvre, Integrator::Rk4).unwrap();
            *motion.series.require(Channel::Vy).unwrap().last().unwrap()
        };
        assert!(lateral_speed(Equations::Corrected).abs() < 0.01);
        assert!(lateral_speed(Equations::Paper).abs() > 10.0);
    }
}
