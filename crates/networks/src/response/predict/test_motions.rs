//! A car and its motions, for the tests of what is drawn.

use std::ops::ControlFlow;

use crate::response::{
    LatentScales, Predictor, ResponseCase, ResponseConfig, ResponseTrainSettings,
    ResponseTrainingSet, fine_tune, rollout,
};
use impactlab_core::vehicle::{Preset, VehicleInput, VehicleState};

pub(super) fn predictor() -> Predictor {
    let vehicle = Preset::Reference.parameters();
    let initial = VehicleState { yaw_rate_rad_s: 1.0, ..VehicleState::driving_straight(20.0) };
    let inputs = vec![VehicleInput::released(); 100];
    let states = rollout(&vehicle, initial, &inputs, [0.1, 0.0, 0.0, 0.0]);
    let case = ResponseCase {
        name: String::new(),
        vehicle: vehicle.clone(),
        states,
        inputs,
        spins: false,
        digest: String::new(),
    };
    let mut config = ResponseConfig::default();
    config.single_steps.epochs = 3;
    config.rollouts.lengths.clear();
    config.calibration.folds = 0;
    let settings = ResponseTrainSettings { config, seed: 1, checkpoint: None, resume: false };
    let set = ResponseTrainingSet { train: vec![case], ..ResponseTrainingSet::default() };
    let model = fine_tune(None, &set, &settings, &mut |_| ControlFlow::Continue(())).unwrap();
    // The network has hardly begun to learn, and says 1 m/s for the noise of a step.
    let scales = LatentScales { step_noise: 0.003, ..LatentScales::default() };
    model.predictor(&vehicle).unwrap().with_latents(scales)
}

pub(super) fn released(n: usize) -> Vec<VehicleInput<f64>> {
    vec![VehicleInput::released(); n]
}

pub(super) fn driving(yaw_rate_rad_s: f64) -> VehicleState<f64> {
    VehicleState { yaw_rate_rad_s, vy_body_m_s: -1.0, ..VehicleState::driving_straight(22.0) }
}
