//! The distribution of a motion against coherent draws and the paper's formula.

use std::ops::ControlFlow;

use nalgebra::{Matrix2, SMatrix, SVector, Vector2};

use crate::response::predict::propagate::StateDistribution;
use crate::response::{
    LatentScales, Predictor, ResponseCase, ResponseConfig, ResponseTrainSettings,
    ResponseTrainingSet, fine_tune, rollout,
};
use impactlab_core::uncertainty::Unscented;
use impactlab_core::vehicle::{Preset, VehicleInput, VehicleState};

fn predictor() -> Predictor {
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

fn released(n: usize) -> Vec<VehicleInput<f64>> {
    vec![VehicleInput::released(); n]
}

fn driving(yaw_rate_rad_s: f64) -> VehicleState<f64> {
    VehicleState { yaw_rate_rad_s, vy_body_m_s: -1.0, ..VehicleState::driving_straight(22.0) }
}

#[test]
fn it_agrees_with_ten_thousand_coherent_draws() {
    let n = 300;
    let cases = [
        (driving(0.3), 1.0, 0.0),
        (driving(2.5), 1.0, 0.0),
        (driving(0.3), 4.0, 0.0),
        (driving(0.3), 1.0, 1.0),
    ];
    for (start, tail_ratio, growth) in cases {
        let mut predictor = predictor();
        predictor.latents.tail_ratio = tail_ratio;
        predictor.latents.growth = growth;
        let inputs = released(n);
        let motion = predictor.motion(&start, &inputs);
        let draws = predictor.sample(&start, &inputs, 10_000, 5);
        for at in [100, n] {
            let positions: Vec<[f64; 3]> = draws
                .iter()
                .map(|states| [states[at].x_m, states[at].y_m, states[at].yaw_rad])
                .collect();
            let mean = motion.mean(at);
            let covariance = motion.covariance(at);
            let moments = |axis: usize| {
                let n = positions.len() as f64;
                let mean = positions.iter().map(|p| p[axis]).sum::<f64>() / n;
                let square = positions.iter().map(|p| (p[axis] - mean).powi(2)).sum::<f64>() / n;
                (mean, square.sqrt())
            };
            let path_m = 22.0 * at as f64 * 0.01;
            for (axis, expected) in [mean.x_m, mean.y_m, mean.yaw_rad].into_iter().enumerate() {
                let (mean, std) = moments(axis);
                let scale = if axis < 2 { path_m } else { 1.0 };
                assert!(
                    (mean - expected).abs() < 0.01 * scale,
                    "{axis} at {at}: {mean} {expected}"
                );
                let ratio = covariance[(axis, axis)].sqrt() / std;
                assert!((ratio - 1.0).abs() < 0.15, "{axis} at {at}: deviation off by {ratio}");
            }
            // The tails are as long as those of the draws.
            let position = motion.position(at);
            let levels: Vec<f64> =
                positions[..2000].iter().map(|&[x, y, _]| position.level_of([x, y])).collect();
            for level in [0.5, 0.9] {
                let held =
                    levels.iter().filter(|reached| **reached <= level).count() as f64 / 2000.0;
                assert!((held - level).abs() < 0.05, "{level} at {at}: {held} of the draws");
            }
        }
    }
}

#[test]
fn covariances_stay_positive_definite_through_a_spin() {
    let scales = LatentScales { step_noise: 0.003, ..LatentScales::default() };
    let predictor = predictor().with_latents(scales.widened(3.0));
    let motion = predictor.motion(&driving(4.5), &released(400));
    assert!(motion.mean(400).yaw_rad > 3.0, "no spin: {:?}", motion.mean(400));
    let positive = |state: &StateDistribution| {
        state.covariance.iter().all(|value| value.is_finite())
            && state.covariance.symmetric_eigenvalues().min() > -1e-12
    };
    assert!(motion.components.iter().flat_map(|c| &c.states).all(positive));
    let weights: f64 = motion.components.iter().map(|component| component.weight).sum();
    assert!((weights - 1.0).abs() < 1e-12);
}

/// `X⁺ = X + (v_x cos ψ − v_y sin ψ) Δt` with a certain pose: the paper's formula.
#[test]
fn with_a_certain_pose_it_is_the_papers_formula() {
    let predictor = predictor();
    let scales = LatentScales { scales: [0.0; 4], step_noise: 1.0, ..LatentScales::default() };
    let predictor = predictor.with_latents(scales);
    let start = VehicleState { yaw_rad: 0.7, ..driving(0.0) };
    // One step makes the velocities uncertain, the next carries that into the position.
    let motion = predictor.motion(&start, &released(2));
    for component in &motion.components {
        let velocity: StateDistribution = component.states[1];
        let (sin, cos) = velocity.mean.yaw_rad.sin_cos();
        let mean = SVector::<f64, 2>::new(velocity.mean.vx_body_m_s, velocity.mean.vy_body_m_s);
        let p: SMatrix<f64, 2, 2> = velocity.covariance.fixed_view::<2, 2>(3, 3).into_owned();
        let turn = Matrix2::new(cos, -sin, sin, cos);
        let origin = Vector2::new(velocity.mean.x_m, velocity.mean.y_m);
        let step = |v: &SVector<f64, 2>| origin + turn * v * 0.01;
        for unscented in [Unscented::default(), Unscented::paper()] {
            let (expected, spread) = unscented.transform(&mean, &p, step).unwrap();
            let after = component.states[2];
            let off = Vector2::new(after.mean.x_m, after.mean.y_m) - expected;
            assert!(off.norm() < 2e-3, "{off}");
            let got: SMatrix<f64, 2, 2> = after.covariance.fixed_view::<2, 2>(0, 0).into_owned();
            assert!((got - spread).norm() < 0.03 * spread.norm(), "{got} {spread}");
        }
    }
}
