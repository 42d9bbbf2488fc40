//! The response model: the tuned 4DOF vehicle and the network around it.

use std::ops::ControlFlow;
use std::sync::Arc;

use candle_core::{Device, Tensor};

use crate::nn::random_stream;
use crate::response::network::ResponseNetwork;
use crate::response::one_step::OneStepData;
use crate::response::rollout_training::train_rollouts;
use crate::response::step_operations::{Row, feature_rows, step_rows};
use crate::response::train::train_single_steps;
use crate::response::{
    N_TOKEN_NUMBERS, N_TOKENS, ResponseCase, ResponseConfig, ResponseError, ResponseProgress,
    STEP_S, Tuning, vehicle_tokens,
};
use crate::vehicle::{N_STATE, VehicleInput, VehicleParameters, VehicleState};

/// A fitted response model.
#[derive(Debug)]
pub struct ResponseModel {
    config: ResponseConfig,
    tuning: Tuning,
    network: ResponseNetwork,
}

/// Where the vehicle goes by one component of the mixture.
#[derive(Debug, Clone, PartialEq)]
pub struct ComponentPath {
    /// Mean probability of the component along the path.
    pub weight: f64,
    /// States every [`STEP_S`].
    pub states: Vec<VehicleState<f64>>,
}

impl ResponseModel {
    /// Tunes the 4DOF model, then trains the network on the same trajectories: on single steps, then on rollouts.
    ///
    /// - `report`: is told of both; breaking ends what is under way where it is.
    ///
    /// # Errors
    /// [`ResponseError::NoCases`], [`ResponseError::Network`].
    pub fn fit(
        cases: &[&ResponseCase],
        config: &ResponseConfig,
        seed: u64,
        report: &mut dyn FnMut(ResponseProgress) -> ControlFlow<()>,
    ) -> Result<Self, ResponseError> {
        if !cases.iter().any(|case| case.states.len() > 1 && !case.inputs.is_empty()) {
            return Err(ResponseError::NoCases);
        }
        let tuning = Tuning::fit(cases, config.tuning, seed, &mut |done, cost| {
            report(ResponseProgress::Tuning { done, of: config.tuning.iterations, cost })
        });
        let mut rng = random_stream(seed, "response network", 0);
        let network = ResponseNetwork::new(&config.network, &mut rng)?;
        let data = OneStepData::of(cases, &tuning);
        train_single_steps(&network, &data, (config, seed), report)?;
        train_rollouts(&network, (cases, &tuning), (config, seed), report)?;
        Ok(Self { config: config.clone(), tuning, network })
    }

    /// The parameters of the 4DOF model inside.
    pub fn tuning(&self) -> &Tuning {
        &self.tuning
    }

    /// The paths of all components from one state.
    ///
    /// - `inputs`: over each step.
    ///
    /// # Errors
    /// [`ResponseError::Network`].
    pub fn paths(
        &self,
        vehicle: &VehicleParameters,
        initial: VehicleState<f64>,
        inputs: &[VehicleInput<f64>],
    ) -> Result<Vec<ComponentPath>, ResponseError> {
        let n = self.config.network.components;
        let vehicle = Arc::new(self.tuning.apply(vehicle));
        let tokens: Vec<f64> = vehicle_tokens(&vehicle).as_flattened().to_vec();
        let tokens = Tensor::from_vec(tokens, (1, N_TOKENS, N_TOKEN_NUMBERS), &Device::Cpu)?;
        let mut paths = vec![ComponentPath { weight: 0.0, states: vec![initial] }; n];
        for (i, input) in inputs.iter().enumerate() {
            let row = Row { vehicle: vehicle.clone(), input: *input, time_s: i as f64 * STEP_S };
            let rows = Arc::new(vec![row; n]);
            let latest = paths.iter().filter_map(|path| path.states.last());
            let x: Vec<f64> = latest.flat_map(|state| state.to_array()).collect();
            let x = Tensor::from_vec(x, (n, N_STATE), &Device::Cpu)?;
            let seen = feature_rows(&x, &rows)?.unsqueeze(0)?;
            let output = self.network.forward_frozen(&seen, &tokens)?;
            // Of each path its own component.
            let own = |j: usize| output.residual.get(0)?.get(j)?.get(j);
            let residual: Vec<Tensor> = (0..n).map(own).collect::<Result<_, _>>()?;
            let next = step_rows(&x, &Tensor::stack(&residual, 0)?, &rows)?.to_vec2::<f64>()?;
            let weights = crate::nn::softmax(&output.logits, 1.0)?.mean(1)?.to_vec2::<f64>()?;
            let weights = weights.into_iter().flatten();
            for ((path, next), weight) in paths.iter_mut().zip(next).zip(weights) {
                let state = std::array::from_fn(|i| next.get(i).copied().unwrap_or(f64::NAN));
                path.states.push(VehicleState::from_array(state));
                path.weight += weight / inputs.len() as f64;
            }
        }
        Ok(paths)
    }

    /// Mean of the paths, each with its probability.
    ///
    /// # Errors
    /// As for [`ResponseModel::paths`].
    pub fn mean_path(
        &self,
        vehicle: &VehicleParameters,
        initial: VehicleState<f64>,
        inputs: &[VehicleInput<f64>],
    ) -> Result<Vec<VehicleState<f64>>, ResponseError> {
        let paths = self.paths(vehicle, initial, inputs)?;
        let mean = |i: usize| {
            let mut sum = [0.0; N_STATE];
            for path in &paths {
                let state = path.states.get(i).map(|state| state.to_array()).unwrap_or_default();
                sum.iter_mut().zip(state).for_each(|(sum, value)| *sum += path.weight * value);
            }
            VehicleState::from_array(sum)
        };
        let later = (1..=inputs.len()).map(mean);
        Ok(std::iter::once(initial).chain(later).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::response::{TuningConfig, average_error_m, rollout};
    use crate::vehicle::Preset;

    /// A car that was set turning, and whose tyres roll less freely than its data sheet says.
    fn case(yaw_rate_rad_s: f64) -> ResponseCase {
        let vehicle = Preset::Reference.parameters();
        let mut truth = vehicle.clone();
        truth.tires.rolling_resistance *= 4.0;
        let initial = VehicleState { yaw_rate_rad_s, ..VehicleState::driving_straight(20.0) };
        let inputs = vec![VehicleInput::released(); 200];
        let states = rollout(&truth, initial, &inputs, |_, _| [0.0; 4]);
        let name = format!("{yaw_rate_rad_s}");
        ResponseCase { name, vehicle, states, inputs, spins: false, digest: String::new() }
    }

    fn small() -> ResponseConfig {
        let mut config = ResponseConfig::default();
        config.network.components = 2;
        config.training.steps = 500;
        config.training.batch_instants = 64;
        config.rollouts.lengths = vec![5];
        config.rollouts.steps = 3;
        config.tuning = TuningConfig { particles: 2, iterations: 1, ..TuningConfig::default() };
        config
    }

    #[test]
    fn what_the_data_sheet_lacks_is_learned() {
        let cases = [case(0.2), case(-0.5), case(0.8)];
        let go_on = &mut |_| ControlFlow::Continue(());
        let model = ResponseModel::fit(&cases.each_ref(), &small(), 3, go_on).unwrap();
        let unseen = case(0.5);
        let (start, inputs) = (unseen.states[0], &unseen.inputs);
        let plain = rollout(&unseen.vehicle, start, inputs, |_, _| [0.0; 4]);
        let path = model.mean_path(&unseen.vehicle, start, inputs).unwrap();
        let [before, after] = [plain, path].map(|path| average_error_m(&path, &unseen.states));
        assert!(after < 0.3 * before, "{before} m before, {after} m after");
        let paths = model.paths(&unseen.vehicle, start, inputs).unwrap();
        let weights: f64 = paths.iter().map(|path| path.weight).sum();
        assert!((weights - 1.0).abs() < 1e-9, "{weights}");
    }

    #[test]
    fn nothing_is_learned_from_nothing() {
        let fitted = ResponseModel::fit(&[], &small(), 0, &mut |_| ControlFlow::Continue(()));
        assert!(matches!(fitted, Err(ResponseError::NoCases)));
    }
}
