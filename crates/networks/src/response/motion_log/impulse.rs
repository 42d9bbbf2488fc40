//! The force of an impact that nobody measured, from what it did to the motion.
//!
//! ```text
//! F(t) = P h(t), M_z(t) = L h(t)      h: haversine over the contact, area 1
//! P, L such that the 4DOF model comes to the recorded v_X, v_Y, r at the end of the contact
//! ```
//!
//! The model has the tire forces during contact, those of the recorded steering among them, so that P is
//! the impulse of the contact alone; what the tires really did during contact and the model does not know
//! is counted as impulse.

use crate::response::{N_RESIDUAL, STEP_S, rollout};
use impactlab_core::collision::{Pulse, PulseError, PulseShape};
use impactlab_core::vehicle::frames::world_from_body;
use impactlab_core::vehicle::{
    ContactLoad, ContactPoint, Controls, Manoeuvre, VehicleParameters, VehicleState,
};

/// Sample interval of the pulse, s.
const SAMPLE_S: f64 = 1e-3;
/// Rounds of correcting P and L; each leaves a few percent of the error.
const N_ROUNDS: usize = 12;

/// The load of a haversine pulse that starts at t = 0 and leads from one state to the other.
///
/// - `controls`: what steered it meanwhile, on the clock of the contact;
/// - `states`: recorded, every [`STEP_S`] from the start of the contact;
/// - `duration_s`: of the contact, positive.
pub(super) fn estimated_load(
    vehicle: &VehicleParameters,
    controls: &Controls,
    states: &[VehicleState<f64>],
    duration_s: f64,
) -> Result<Option<ContactLoad>, PulseError> {
    let n_steps = (duration_s / STEP_S).round().max(1.0) as usize;
    let (Some(initial), Some(after)) = (states.first(), states.get(n_steps)) else {
        return Ok(None);
    };
    let (mass, yaw_inertia) = (vehicle.mass.mass_kg, vehicle.mass.yaw_inertia_kg_m2);
    let (mut impulse_n_s, mut angular_n_m_s) = ([0.0; 2], 0.0);
    let recorded = world_rates(after);
    for _ in 0..N_ROUNDS {
        let load = load(vehicle, impulse_n_s, angular_n_m_s, duration_s)?;
        let manoeuvre = Manoeuvre {
            initial: *initial,
            contact_load: Some(load),
            controls: controls.clone(),
            duration_s,
            ..Manoeuvre::default()
        };
        let inputs = manoeuvre.inputs(STEP_S, n_steps);
        let path = rollout(vehicle, *initial, &inputs, [0.0; N_RESIDUAL]);
        let Some(end) = path.last() else { break };
        let [vx, vy, yaw_rate] = world_rates(end);
        impulse_n_s[0] += mass * (recorded[0] - vx);
        impulse_n_s[1] += mass * (recorded[1] - vy);
        angular_n_m_s += yaw_inertia * (recorded[2] - yaw_rate);
    }
    load(vehicle, impulse_n_s, angular_n_m_s, duration_s).map(Some)
}

fn world_rates(state: &VehicleState<f64>) -> [f64; 3] {
    let [vx, vy] = world_from_body(state.yaw_rad, [state.vx_body_m_s, state.vy_body_m_s]);
    [vx, vy, state.yaw_rate_rad_s]
}

fn load(
    vehicle: &VehicleParameters,
    impulse_n_s: [f64; 2],
    angular_n_m_s: f64,
    duration_s: f64,
) -> Result<ContactLoad, PulseError> {
    let history =
        |impulse| Pulse::new(PulseShape::Haversine, impulse, 0.0, duration_s)?.to_history(SAMPLE_S);
    let mut force = history(impulse_n_s)?;
    force.mz_n_m = Some(history([angular_n_m_s, 0.0])?.fx_n);
    let contact =
        ContactPoint { x_body_m: 0.0, y_body_m: 0.0, height_m: vehicle.geometry.cg_height_m };
    Ok(ContactLoad { force, contact, recorded_moment: true })
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::vehicle::{Preset, SteerHistory};

    #[test]
    fn a_known_impulse_is_found_again() {
        let vehicle = Preset::ScaledStruck.parameters();
        let initial = VehicleState { yaw_rad: 0.4, ..VehicleState::driving_straight(6.0) };
        for (impulse, angular, steer_rad) in [
            ([20.0, 150.0], -60.0, 0.0),
            ([-40.0, -90.0], 35.0, 0.0),
            ([0.0; 2], 0.0, 0.0),
            // What the steering turned is not counted as impulse.
            ([20.0, 150.0], -60.0, 0.1),
            ([0.0; 2], 0.0, 0.1),
        ] {
            let steer = SteerHistory { time_s: vec![0.0], steer_rad: vec![steer_rad] };
            let controls = Controls { steer: Some(steer), ..Controls::default() };
            let known = load(&vehicle, impulse, angular, 0.1).unwrap();
            let manoeuvre = Manoeuvre {
                initial,
                contact_load: Some(known),
                controls: controls.clone(),
                duration_s: 0.2,
                ..Manoeuvre::default()
            };
            let inputs = manoeuvre.inputs(STEP_S, 20);
            let states = rollout(&vehicle, initial, &inputs, [0.0; N_RESIDUAL]);
            let found = estimated_load(&vehicle, &controls, &states, 0.1).unwrap().unwrap();
            let [px, py] = found.force.impulse_n_s();
            let moment = found.force.cumulative().angular_n_m_s.unwrap();
            let off = [px - impulse[0], py - impulse[1], moment.last().unwrap() - angular];
            assert!(
                off.iter().all(|off| off.abs() < 0.02),
                "{impulse:?} {angular} {steer_rad}: {off:?}"
            );
        }
        assert!(
            estimated_load(&vehicle, &Controls::default(), &[initial; 3], 0.1).unwrap().is_none()
        );
    }
}
