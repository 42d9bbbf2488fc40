//! State, force and time as the response network sees them: what tires and inertia feel, in numbers
//! of the order of one.

use impactlab_core::numerics::Lanes;
use impactlab_core::vehicle::{
    SLIP_ANGLE_SPEED_M_S, VehicleEvaluation, VehicleInput, VehicleParameters, VehicleState,
};

/// Numbers of an instant.
pub const N_FEATURES: usize = 20;

/// Signs of the features of the mirrored motion.
pub const FEATURE_MIRROR: [f64; N_FEATURES] = [
    1.0, -1.0, -1.0, -1.0, -1.0, 1.0, -1.0, -1.0, -1.0, -1.0, 1.0, -1.0, -1.0, -1.0, 1.0, -1.0,
    1.0, -1.0, 1.0, 1.0,
];

/// 1 for the features that the 4DOF model gives, which a network without it does not see.
pub const IS_OF_MODEL: [f64; N_FEATURES] = [
    0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0,
    0.0,
];

const VX_UNIT_M_S: f64 = 20.0;
const VY_UNIT_M_S: f64 = 10.0;
const YAW_RATE_UNIT_RAD_S: f64 = 1.5;
const ROLL_RATE_UNIT_RAD_S: f64 = 1.0 / 3.0;
const ROLL_UNIT_RAD: f64 = 0.05;
/// Acceleration, m/s², in whose unit forces over the mass are seen.
const FORCE_UNIT_M_S2: f64 = 10.0;
const ANGULAR_UNIT_RAD_S2: f64 = 5.0;
const TIRE_UNIT_M_S2: f64 = 5.0;
/// Rates of the velocities in body axes, which a fast rotation makes large.
const RATE_UNIT_M_S2: f64 = 20.0;
const ANGULAR_RATE_UNIT_RAD_S2: f64 = 4.0;
/// Time over which what an impact stirs up (wheels, springs) comes to rest, s.
const TRANSIENT_S: f64 = 0.2;
const HORIZON_S: f64 = 4.0;

/// The features.
///
/// ```text
/// v_x, v_y, r, φ̇, φ                    in units of a PIT
/// F_x/m, F_y/m, M_z/I_zz               of the collision, body axes
/// α_f, α_r                             slip angles of the axles
/// v̇_x, v̇_y, ṙ, φ̈                      of the 4DOF model
/// a_x, a_y                             of the CG by the 4DOF model
/// v_x/V, v_y/V                         direction of motion
/// e^(−t/0.2 s), t/4 s                  time since the impact began
/// ```
pub fn features<T: Lanes>(
    vehicle: &VehicleParameters,
    x: &VehicleState<T>,
    u: &VehicleInput<T>,
    time_s: f64,
) -> [T; N_FEATURES] {
    features_of(vehicle, x, &vehicle.evaluate(x, u), time_s)
}

/// [`features`] where the 4DOF model was evaluated already.
#[inline(always)]
pub(crate) fn features_of<T: Lanes>(
    vehicle: &VehicleParameters,
    x: &VehicleState<T>,
    now: &VehicleEvaluation<T>,
    time_s: f64,
) -> [T; N_FEATURES] {
    let (rate, [ax, ay]) = (&now.derivative, now.acceleration_body_m_s2);
    let [fx, fy] = now.collision_force_body_n;
    let (mass, geometry) = (&vehicle.mass, &vehicle.geometry);
    let speed = (x.vx_body_m_s * x.vx_body_m_s + x.vy_body_m_s * x.vy_body_m_s + 1e-12).sqrt()
        + SLIP_ANGLE_SPEED_M_S;
    let along = x.vx_body_m_s.abs() + SLIP_ANGLE_SPEED_M_S;
    let front = x.vy_body_m_s + x.yaw_rate_rad_s * geometry.cg_to_front_axle_m;
    let rear = x.vy_body_m_s - x.yaw_rate_rad_s * geometry.cg_to_rear_axle_m;
    [
        x.vx_body_m_s / VX_UNIT_M_S,
        x.vy_body_m_s / VY_UNIT_M_S,
        x.yaw_rate_rad_s / YAW_RATE_UNIT_RAD_S,
        x.roll_rate_rad_s / ROLL_RATE_UNIT_RAD_S,
        x.roll_rad / ROLL_UNIT_RAD,
        fx / (mass.mass_kg * FORCE_UNIT_M_S2),
        fy / (mass.mass_kg * FORCE_UNIT_M_S2),
        now.collision_yaw_moment_n_m / (mass.yaw_inertia_kg_m2 * ANGULAR_UNIT_RAD_S2),
        front.atan_ratio(along),
        rear.atan_ratio(along),
        rate.vx_body_m_s / RATE_UNIT_M_S2,
        rate.vy_body_m_s / RATE_UNIT_M_S2,
        rate.yaw_rate_rad_s / ANGULAR_RATE_UNIT_RAD_S2,
        rate.roll_rate_rad_s / ANGULAR_RATE_UNIT_RAD_S2,
        ax / TIRE_UNIT_M_S2,
        ay / TIRE_UNIT_M_S2,
        x.vx_body_m_s / speed,
        x.vy_body_m_s / speed,
        along.constant((-time_s / TRANSIENT_S).exp()),
        along.constant(time_s / HORIZON_S),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::vehicle::Preset;

    #[test]
    fn mirrored_motion_has_mirrored_features() {
        let vehicle = Preset::Reference.parameters();
        let x = VehicleState {
            vx_body_m_s: 12.0,
            vy_body_m_s: 3.0,
            yaw_rate_rad_s: 0.7,
            roll_rad: 0.02,
            roll_rate_rad_s: -0.1,
            ..VehicleState::default()
        };
        let mirrored = VehicleState {
            vy_body_m_s: -3.0,
            yaw_rate_rad_s: -0.7,
            roll_rad: -0.02,
            roll_rate_rad_s: 0.1,
            ..x
        };
        let u = VehicleInput::released();
        let [a, b] = [x, mirrored].map(|x| features(&vehicle, &x, &u, 0.3));
        for (i, (a, b)) in a.iter().zip(b).enumerate() {
            assert!((a - FEATURE_MIRROR[i] * b).abs() < 1e-12, "{i}: {a} {b}");
        }
    }
}
