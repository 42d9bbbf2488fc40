//! Motions simulated with the 4DOF model under recorded forces, with vehicles, frictions and speeds
//! drawn at random: what pre-training learns from, and the instants away from the data at which
//! fine-tuning asks for physics.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;
use rayon::prelude::*;

use crate::response::network::one_step::MotionView;
use crate::response::{N_RESIDUAL, STEP_S, rollout};
use impactlab_core::data::ForceHistory;
use impactlab_core::numerics::random_stream;
use impactlab_core::vehicle::{
    ContactLoad, ContactPoint, Manoeuvre, VehicleInput, VehicleParameters, VehicleState,
};

/// A driving state and the forces that follow.
#[derive(Debug, Clone, PartialEq)]
pub struct ImpactRecord {
    /// The struck vehicle by its data sheet.
    pub vehicle: VehicleParameters,
    /// State at the start of the impact.
    pub initial: VehicleState<f64>,
    /// Input over each step.
    pub inputs: Vec<VehicleInput<f64>>,
}

impl ImpactRecord {
    /// A vehicle that drives straight on until a force strikes it, for 4 s from the start of the
    /// impact.
    ///
    /// - `velocity_m_s`: forward and to the left, before the impact;
    /// - `contact_m`: where the force acts, x forward and y to the left of the centre of gravity.
    pub fn under_force(
        vehicle: VehicleParameters,
        velocity_m_s: [f64; 2],
        contact_m: [f64; 2],
        force: ForceHistory,
    ) -> Self {
        let [vx_body_m_s, vy_body_m_s] = velocity_m_s;
        let [x_body_m, y_body_m] = contact_m;
        let initial = VehicleState { vx_body_m_s, vy_body_m_s, ..VehicleState::default() };
        let contact = ContactPoint { x_body_m, y_body_m, height_m: vehicle.geometry.cg_height_m };
        let load = ContactLoad { force, contact, recorded_moment: false };
        let duration_s = N_STEPS as f64 * STEP_S;
        let manoeuvre =
            Manoeuvre { initial, contact_load: Some(load), duration_s, ..Manoeuvre::default() };
        let inputs = manoeuvre.inputs(STEP_S, N_STEPS);
        Self { vehicle, initial, inputs }
    }
}

/// Steps of a motion that is simulated from a force alone: 4 s.
const N_STEPS: usize = 400;

/// A simulated motion.
#[derive(Debug, Clone)]
pub(crate) struct SimulatedMotion {
    /// Vehicle of the record.
    pub data_sheet: VehicleParameters,
    /// Vehicle that was simulated.
    pub vehicle: VehicleParameters,
    pub states: Vec<VehicleState<f64>>,
    pub inputs: Vec<VehicleInput<f64>>,
}

/// Ranges that are drawn from evenly.
const SPEED_FACTOR: [f64; 2] = [0.5, 1.4];
const FORCE_FACTOR: [f64; 2] = [0.3, 1.8];
const FRICTION: [f64; 2] = [0.4, 1.0];
const SLIDING_RATIO: [f64; 2] = [0.7, 1.0];
/// Standard deviation of the logarithm of other parameters.
const PARAMETER_SPREAD: f64 = 0.15;

impl SimulatedMotion {
    pub(crate) fn view(&self) -> MotionView<'_> {
        MotionView {
            centre: &self.data_sheet,
            vehicle: &self.vehicle,
            states: &self.states,
            inputs: &self.inputs,
        }
    }
}

/// Simulates `n` motions, each from one of the records.
///
/// - `varies`: whether the vehicle is another than the record's.
pub(crate) fn simulate(
    records: &[ImpactRecord],
    n: usize,
    varies: bool,
    seed: u64,
) -> Vec<SimulatedMotion> {
    let one = |idx: usize| {
        let mut rng = random_stream(seed, "simulated motions", idx as u64);
        let record = records.get(rng.random_range(0..records.len().max(1)))?;
        let speed = rng.random_range(SPEED_FACTOR[0]..SPEED_FACTOR[1]);
        let force = rng.random_range(FORCE_FACTOR[0]..FORCE_FACTOR[1]);
        let vehicle =
            if varies { varied(&record.vehicle, &mut rng) } else { record.vehicle.clone() };
        let initial =
            VehicleState { vx_body_m_s: record.initial.vx_body_m_s * speed, ..record.initial };
        let inputs: Vec<VehicleInput<f64>> =
            record.inputs.iter().map(|input| scaled(input, force)).collect();
        let states = rollout(&vehicle, initial, &inputs, [0.0; N_RESIDUAL]);
        let data_sheet = record.vehicle.clone();
        Some(SimulatedMotion { data_sheet, vehicle, states, inputs })
    };
    (0..n).into_par_iter().filter_map(one).collect()
}

fn scaled(input: &VehicleInput<f64>, factor: f64) -> VehicleInput<f64> {
    let mut input = *input;
    if let Some(collision) = &mut input.collision {
        collision.force_n = collision.force_n.map(|force| force * factor);
        collision.yaw_moment_n_m = collision.yaw_moment_n_m.map(|moment| moment * factor);
    }
    input
}

fn varied(vehicle: &VehicleParameters, rng: &mut ChaCha8Rng) -> VehicleParameters {
    let mut factor =
        |spread: f64| (spread * rng.sample::<f64, _>(StandardNormal)).clamp(-0.5, 0.5).exp();
    let mass_kg = vehicle.mass.mass_kg * factor(PARAMETER_SPREAD);
    let mut varied = vehicle.clone().scaled_to_mass(mass_kg, None);
    varied.mass.yaw_inertia_kg_m2 *= factor(PARAMETER_SPREAD / 2.0);
    let (tires, suspension) = (&mut varied.tires, &mut varied.suspension);
    tires.cornering_coefficient_front_per_rad *= factor(PARAMETER_SPREAD);
    tires.cornering_coefficient_rear_per_rad *= factor(PARAMETER_SPREAD);
    suspension.roll_stiffness_n_m_rad *= factor(PARAMETER_SPREAD);
    suspension.roll_damping_n_m_s_rad *= factor(PARAMETER_SPREAD);
    tires.friction = rng.random_range(FRICTION[0]..FRICTION[1]);
    tires.sliding_friction_ratio = rng.random_range(SLIDING_RATIO[0]..SLIDING_RATIO[1]);
    varied
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::vehicle::Preset;

    #[test]
    fn motions_differ_by_vehicle_and_speed_and_repeat_by_seed() {
        let vehicle = Preset::Reference.parameters();
        let initial = VehicleState { yaw_rate_rad_s: 0.5, ..VehicleState::driving_straight(20.0) };
        let inputs = vec![VehicleInput::released(); 100];
        let record = ImpactRecord { vehicle: vehicle.clone(), initial, inputs };
        let motions = simulate(std::slice::from_ref(&record), 20, true, 3);
        let again = simulate(std::slice::from_ref(&record), 20, true, 3);
        assert_eq!(motions.len(), 20);
        for (a, b) in motions.iter().zip(&again) {
            assert_eq!((a.states.last(), &a.vehicle), (b.states.last(), &b.vehicle));
            assert!(a.states.iter().all(|state| state.to_array().iter().all(|v| v.is_finite())));
        }
        let frictions: Vec<f64> = motions.iter().map(|m| m.vehicle.tires.friction).collect();
        assert!(frictions.iter().any(|f| *f < 0.6) && frictions.iter().any(|f| *f > 0.8));
        assert!(simulate(&[], 5, true, 3).is_empty());
        assert_eq!(simulate(&[record], 1, false, 3)[0].vehicle, vehicle);
    }
}
