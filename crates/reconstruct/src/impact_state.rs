//! From the quantities of a particle to the planar impact of both cars.

use crate::prior::towards;
use crate::{ForwardModel, Latent, LatentValues};
use impactlab_core::collision::{
    ContactSurface, FrictionModel, Impact, ImpactBody, ImpactSolution, RestitutionForm, Side,
    restitution_bounds,
};
use impactlab_core::numerics::wrap_angle_rad;
use impactlab_core::vehicle::VehicleParameters;

/// Depth to which the corner of the striking car is pushed in, m.
const CRUSH_M: f64 = 0.15;

/// Angle over which the contact moves from the middle of an edge of the striking car to its corner,
/// as its sine.
const CORNER_SINE: f64 = 0.3;

/// State of both cars at the impact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImpactState {
    /// Speed of the struck car before it, m/s.
    pub struck_speed_m_s: f64,
    /// Speed of the striking car before it, m/s.
    pub striking_speed_m_s: f64,
    /// Speeds of the struck and of the striking car before a skid that ended at it, m/s; `None` of a car
    /// without one.
    pub speeds_before_skid_m_s: [Option<f64>; 2],
    /// Size of the difference of the velocities of both CGs, m/s.
    pub closing_speed_m_s: f64,
    /// Heading of the striking car against that of the struck car, rad.
    pub heading_difference_rad: f64,
    /// Where the striking car moves, world axes, m/s.
    pub striking_velocity_m_s: [f64; 2],
    /// CG of the striking car at first contact, world axes, m.
    pub striking_m: [f64; 2],
    /// Contact point from the CG of the struck car, m.
    pub contact_m: [f64; 2],
    /// Direction of the contact normal, which points into the struck car, world axes, rad.
    pub normal_rad: f64,
    /// Coefficient of restitution.
    pub restitution: f64,
    /// Impulse and velocities after it.
    pub solution: ImpactSolution,
}

impl ImpactState {
    /// Size of the change of velocity of the struck car by the contact, m/s.
    pub fn delta_v_struck_m_s(&self) -> f64 {
        let [x, y] = self.solution.struck.delta_v_world_m_s;
        x.hypot(y)
    }

    /// Whether the cars push each other: they do not if they draw apart where they touch.
    pub fn is_collision(&self) -> bool {
        self.delta_v_struck_m_s() > 0.0
    }
}

impl ForwardModel {
    /// The impact of a particle, without the motion after it.
    pub fn impact(&self, values: &LatentValues) -> ImpactState {
        let struck_speed_m_s = values.get(Latent::StruckSpeed);
        let difference = values.get(Latent::SpeedDifference);
        let striking_speed_m_s = match difference.is_nan() {
            true => values.get(Latent::StrikingSpeed),
            false => (struck_speed_m_s + difference).max(0.0),
        };
        let sign = towards(self.side);
        let heading_rad = sign * values.get(Latent::HeadingTowards);
        let course_rad = heading_rad + sign * values.get(Latent::SideslipTowards);
        let striking_velocity_m_s =
            [striking_speed_m_s * course_rad.cos(), striking_speed_m_s * course_rad.sin()];
        let along_across = [values.get(Latent::ContactAlong), values.get(Latent::ContactAcross)];
        let (contact_m, side_rad) = contact(self.side, along_across);
        let to_heading_rad = wrap_angle_rad(heading_rad - side_rad);
        let normal_rad = side_rad + values.get(Latent::NormalTilt) * to_heading_rad.signum();
        let arm_m = self.striking_arm_m(heading_rad, side_rad);
        let inertia = |mass_kg: f64, vehicle: &VehicleParameters| {
            vehicle.mass.yaw_inertia_kg_m2 * mass_kg / vehicle.mass.mass_kg
        };
        let [struck_kg, striking_kg] =
            [values.get(Latent::StruckMass), values.get(Latent::StrikingMass)];
        let struck = ImpactBody {
            mass_kg: struck_kg,
            yaw_inertia_kg_m2: inertia(struck_kg, &self.cars.struck.parameters)
                * values.get(Latent::YawInertiaFactor),
            heading_rad: 0.0,
            velocity_world_m_s: [struck_speed_m_s, 0.0],
            yaw_rate_rad_s: 0.0,
            contact_arm_world_m: contact_m,
        };
        let striking = ImpactBody {
            mass_kg: striking_kg,
            yaw_inertia_kg_m2: inertia(striking_kg, &self.cars.striking.parameters),
            heading_rad,
            velocity_world_m_s: striking_velocity_m_s,
            yaw_rate_rad_s: self.striking_yaw_rate_rad_s(values),
            contact_arm_world_m: arm_m,
        };
        let surface = ContactSurface {
            normal_angle_world_rad: normal_rad,
            restitution: 0.0,
            restitution_form: RestitutionForm::Normal,
            friction_limit: values.get(Latent::ContactFriction),
            friction_model: FrictionModel::Limit,
        };
        let mut impact = Impact { struck, striking, surface };
        let restitution = self.restitution(values, impact.closing_speed_m_s());
        impact.surface.restitution = restitution;
        let closing = [striking_velocity_m_s[0] - struck_speed_m_s, striking_velocity_m_s[1]];
        ImpactState {
            struck_speed_m_s,
            striking_speed_m_s,
            speeds_before_skid_m_s: self.speeds_before_skid_m_s(
                values,
                [struck_speed_m_s, striking_speed_m_s],
                course_rad,
            ),
            closing_speed_m_s: closing[0].hypot(closing[1]),
            heading_difference_rad: wrap_angle_rad(heading_rad),
            striking_velocity_m_s,
            striking_m: [contact_m[0] - arm_m[0], contact_m[1] - arm_m[1]],
            contact_m,
            normal_rad,
            restitution,
            solution: solved(&impact),
        }
    }

    /// Yaw rate of the striking car at first contact, rad/s; none where it is not among the quantities.
    pub(crate) fn striking_yaw_rate_rad_s(&self, values: &LatentValues) -> f64 {
        let inwards_rad_s = values.get(Latent::StrikingYawRate);
        if inwards_rad_s.is_nan() { 0.0 } else { towards(self.side) * inwards_rad_s }
    }

    /// Coefficient of restitution at a closing speed, m/s.
    fn restitution(&self, values: &LatentValues, closing_m_s: f64) -> f64 {
        let share = values.get(Latent::RestitutionShare);
        let [low, high] = self.restitution.unwrap_or_else(|| restitution_bounds(closing_m_s));
        low + (high - low) * share
    }

    /// From the CG of the striking car to the contact point, world axes, m: the corner that is nearest
    /// to the struck side, or the middle of an edge that lies along it.
    fn striking_arm_m(&self, heading_rad: f64, normal_rad: f64) -> [f64; 2] {
        let geometry = &self.cars.striking.parameters.geometry;
        let (across, ahead) = (normal_rad - heading_rad).sin_cos();
        let edge = |sine: f64| (sine / CORNER_SINE).clamp(-1.0, 1.0);
        // In a PIT manoeuvre the front corner touches even where the cars are nearly parallel.
        let turned_in = if self.prior.is_pit() { 0.2 } else { 0.0 };
        let front_m = geometry.cg_to_front_end_m - CRUSH_M;
        let rear_m = geometry.outer_length_m - geometry.cg_to_front_end_m - CRUSH_M;
        let along = edge(ahead + turned_in);
        let x_m = if along > 0.0 { along * front_m } else { along * rear_m };
        let y_m = edge(across) * geometry.outer_width_m / 2.0;
        let (sin, cos) = heading_rad.sin_cos();
        [x_m * cos - y_m * sin, x_m * sin + y_m * cos]
    }
}

/// Contact point from the CG of the struck car, m, and direction of the normal into it, rad.
fn contact(side: Side, [along_m, across_m]: [f64; 2]) -> ([f64; 2], f64) {
    use std::f64::consts::{FRAC_PI_2, PI};
    match side {
        Side::Left => ([along_m, across_m], -FRAC_PI_2),
        Side::Right => ([along_m, across_m], FRAC_PI_2),
        Side::Front => ([across_m, along_m], PI),
        Side::Rear => ([across_m, along_m], 0.0),
    }
}

/// The solution of an impact with friction up to a limit, which always exists.
fn solved(impact: &Impact) -> ImpactSolution {
    match impact.solve_unchecked() {
        Ok(solution) => solution,
        Err(error) => unreachable!("only the friction model of the paper jams: {error}"),
    }
}
