//! The data of a training of the response network, as its epochs use them.

use crate::response::network::one_step::{MotionView, OneStepData};
use crate::response::network::rollout_loss::RolloutCase;
use crate::response::train::physics_points::PhysicsPoints;
use crate::response::train::simulated::{ImpactRecord, SimulatedMotion};
use crate::response::{ResponseCase, ResponseConfig};

/// The data of a training.
pub(super) struct TrainingData<'a> {
    /// Instants of the motions, each with the state that follows.
    pub instants: OneStepData,
    /// Instants away from the data; none for pre-training.
    pub physics_points: Option<PhysicsPoints>,
    /// Trajectories for rollouts; none for pre-training.
    pub rollouts: Vec<RolloutCase<'a>>,
}

impl<'a> TrainingData<'a> {
    pub(super) fn from_simulations(motions: &[SimulatedMotion], config: &ResponseConfig) -> Self {
        let views: Vec<MotionView<'_>> = motions.iter().map(SimulatedMotion::view).collect();
        let instants = OneStepData::from_motions(&views, &config.network);
        Self { instants, physics_points: None, rollouts: Vec::new() }
    }

    pub(super) fn from_trajectories(
        cases: &'a [ResponseCase],
        config: &ResponseConfig,
        seed: u64,
    ) -> Self {
        let view = |case: &'a ResponseCase| MotionView {
            centre: &case.vehicle,
            vehicle: &case.vehicle,
            states: &case.states,
            inputs: &case.inputs,
        };
        let views: Vec<MotionView<'_>> = cases.iter().map(view).collect();
        let instants = OneStepData::from_motions(&views, &config.network);
        let records: Vec<ImpactRecord> = cases.iter().filter_map(ResponseCase::impact).collect();
        let physics_points = (config.loss.physics > 0.0 && config.physics.batch_instants > 0)
            .then(|| PhysicsPoints::about(&instants, &records, config, seed));
        let rollouts = cases
            .iter()
            .map(|case| RolloutCase { case, vehicle: case.vehicle.clone().into() })
            .collect();
        Self { instants, physics_points, rollouts }
    }
}
