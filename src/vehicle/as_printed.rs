//! The equations of motion of the 4DOF vehicle exactly as the paper prints them. They serve as an
//! ablation, which shows the effect of the corrections in `four_dof.rs`, `tire.rs` and `loads.rs`,
//! and are selected by [`Equations::Paper`].
//!
//! Source: `eq:4dof` to `eq:tire_model4` of [`PitPinnPaper`](crate::bibliography::PitPinnPaper),
//! with the printed signs:
//!
//! - The tyre force has a leading minus, which together with the printed slip angle supplies energy
//!   to the vehicle.
//! - The rolling resistance acts in the direction of motion.
//! - Vertical loads may become negative.
//! - The lateral acceleration does not enter the roll equation. Yaw influences roll by I_xz, but
//!   roll does not influence yaw.
//! - The front tyre forces are not rotated by the steer angle δ.
//!
//! Drive and brake forces and the fall of friction beyond its peak are not part of these equations;
//! the inputs and parameters for them have no effect. The paper does not say how the loop of loads,
//! forces, accelerations and loads is resolved; here this is done by fixed-point passes as in
//! `four_dof.rs`.

use serde::{Deserialize, Serialize};

use crate::numerics::Lanes;
use crate::units::STANDARD_GRAVITY_M_S2;
use crate::vehicle::four_dof::{LOAD_PASSES, collision_wrench};
use crate::vehicle::loads::Wheel;
use crate::vehicle::{VehicleEvaluation, VehicleInput, VehicleParameters, VehicleState};

/// The form of the equations of motion of the 4DOF vehicle.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Equations {
    /// The equations of the paper with the corrections that are described in `four_dof.rs`,
    /// `tire.rs` and `loads.rs`.
    #[default]
    Corrected,
    /// The equations as the paper prints them, for comparison.
    Paper,
}

impl VehicleParameters {
    /// The right-hand side of the equations of motion as the paper prints them.
    pub(super) fn evaluate_as_printed<T: Lanes>(
        &self,
        x: &VehicleState<T>,
        u: &VehicleInput<T>,
    ) -> VehicleEvaluation<T> {
        let collision = collision_wrench(x.yaw_rad, u.collision.as_ref());
        let mass_kg = self.mass.mass_kg;
        let mut acceleration = [T::from(0.0); 2];
        let mut loads = self.loads_as_printed(acceleration, x.roll_rad);
        let mut yaw_moment = collision.yaw_moment_n_m;
        for pass in 0..=LOAD_PASSES {
            let ([fx, fy], tire_moment) = self.tires_as_printed(x, u.steer_rad, &loads);
            acceleration =
                [fx + collision.force_n[0], fy + collision.force_n[1]].map(|force| force / mass_kg);
            yaw_moment = tire_moment + collision.yaw_moment_n_m;
            if pass < LOAD_PASSES {
                loads = self.loads_as_printed(acceleration, x.roll_rad);
            }
        }
        let yaw_acceleration = yaw_moment / self.mass.yaw_inertia_kg_m2;
        let suspension = &self.suspension;
        let contact_height_m = u.collision.map_or(0.0, |c| c.contact.height_m);
        let roll_moment = self.gravity_roll_moment_n_m(x.roll_rad)
            - x.roll_rad * suspension.roll_stiffness_n_m_rad
            - x.roll_rate_rad_s * suspension.roll_damping_n_m_s_rad
            - collision.force_n[1] * (contact_height_m - suspension.roll_axis_height_m)
            - yaw_acceleration * self.mass.roll_yaw_product_kg_m2;
        let roll_acceleration = roll_moment / self.mass.roll_inertia_kg_m2;
        VehicleEvaluation {
            derivative: x.derivative(acceleration, [yaw_acceleration, roll_acceleration]),
            acceleration_m_s2: acceleration,
            vertical_loads_n: loads,
            collision_force_n: collision.force_n,
            collision_yaw_moment_n_m: collision.yaw_moment_n_m,
        }
    }

    /// Tyre forces by `eq:tire_model` to `eq:tire_model3`, summed by `eq:4dof2`: `[F_x, F_y]`, N,
    /// and the yaw moment M_z, N m.
    fn tires_as_printed<T: Lanes>(
        &self,
        x: &VehicleState<T>,
        steer_rad: T,
        loads_n: &[T; 4],
    ) -> ([T; 2], T) {
        let tires = &self.tires;
        let zero = T::from(0.0);
        let speed = x.vx_m_s;
        let resistance = speed * speed * tires.rolling_resistance_s2_m2
            + speed * tires.rolling_resistance_s_m
            + tires.rolling_resistance;
        let (mut force, mut moment) = ([zero; 2], zero);
        for (wheel, &load) in Wheel::ALL.into_iter().zip(loads_n) {
            let [px, py] = wheel.position_m(self);
            let course =
                ((x.vy_m_s + x.yaw_rate_rad_s * px) / (x.vx_m_s - x.yaw_rate_rad_s * py)).atan();
            let (steer, coefficient) = if wheel.is_front() {
                (steer_rad, tires.cornering_coefficient_front_per_rad)
            } else {
                (zero, tires.cornering_coefficient_rear_per_rad)
            };
            let stiffness = (steer - course) * (coefficient / tires.friction);
            let fx = resistance * load;
            let limit = load * tires.friction;
            let fy = -(stiffness / (stiffness * stiffness + 1.0).sqrt())
                * (limit * limit - fx * fx).sqrt();
            force[0] += fx;
            force[1] += fy;
            moment += fy * px - fx * py;
        }
        (force, moment)
    }

    /// Vertical loads by `eq:tire_model4`, N, in the order of [`Wheel::ALL`]. The lateral load
    /// transfer is divided between the axles by CORNERING stiffness, as printed.
    fn loads_as_printed<T: Lanes>(&self, [ax, ay]: [T; 2], roll_rad: T) -> [T; 4] {
        let (mass, geometry, tires) = (&self.mass, &self.geometry, &self.tires);
        let (lf, lr) = (geometry.cg_to_front_axle_m, geometry.cg_to_rear_axle_m);
        let weight = mass.mass_kg * STANDARD_GRAVITY_M_S2;
        let pitch = ax * (mass.mass_kg * geometry.cg_height_m / (2.0 * geometry.wheelbase_m()));
        let front = -(pitch - weight * lr / (2.0 * geometry.wheelbase_m()));
        let rear = pitch + weight * lf / (2.0 * geometry.wheelbase_m());
        let stiffness_front = tires.cornering_coefficient_front_per_rad * lr;
        let stiffness_rear = tires.cornering_coefficient_rear_per_rad * lf;
        let share = stiffness_front / (stiffness_front + stiffness_rear);
        let lateral = (ay * (mass.mass_kg * geometry.cg_height_m)
            + self.gravity_roll_moment_n_m(roll_rad))
            / geometry.track_width_m;
        let (shift_front, shift_rear) = (lateral * share, lateral * (1.0 - share));
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
