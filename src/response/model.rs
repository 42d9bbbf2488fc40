//! A trained response network and its file.

use std::path::Path;
use std::sync::Arc;

use candle_core::{DType, Device, Tensor};

use crate::nn::{Checkpoint, ModelKind, random_stream, softmax};
use crate::response::network::{Gradients, ResponseNetwork};
use crate::response::one_step::token_tensor;
use crate::response::step_operations::{Row, effect_rows, feature_rows, step_rows};
use crate::response::{
    N_RESIDUAL, ResponseCase, ResponseConfig, ResponseError, ResponseRecord, STEP_S,
};
use crate::vehicle::{N_STATE, VehicleInput, VehicleParameters, VehicleState};

const KIND: ModelKind = ModelKind { name: "response network", version: 1 };

/// A trained response network with all it takes to predict.
#[derive(Debug)]
pub struct ResponseModel {
    config: ResponseConfig,
    network: ResponseNetwork,
    record: ResponseRecord,
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
    pub(crate) fn new(
        config: ResponseConfig,
        network: ResponseNetwork,
        record: ResponseRecord,
    ) -> Self {
        Self { config, network, record }
    }

    /// The configuration it was trained with.
    pub fn config(&self) -> &ResponseConfig {
        &self.config
    }

    /// How it came to be.
    pub fn record(&self) -> &ResponseRecord {
        &self.record
    }

    /// How many weights it has.
    pub fn n_parameters(&self) -> usize {
        self.network.parameters().n_values()
    }

    /// Whether a trajectory was seen in training, whatever it is called now.
    pub fn is_trained_on(&self, case: &ResponseCase) -> bool {
        self.record.train.iter().any(|known| known.digest == case.digest)
    }

    pub(crate) fn network(&self) -> &ResponseNetwork {
        &self.network
    }

    /// Writes the model, whole or not at all.
    ///
    /// # Errors
    /// [`ResponseError::Network`].
    pub fn save(&self, path: &Path) -> Result<(), ResponseError> {
        let mut file = Checkpoint::new(KIND);
        file.put("config", &self.config)?;
        file.put("record", &self.record)?;
        file.put_group("network", self.network.parameters().export()?);
        Ok(file.write(path)?)
    }

    /// Reads a model.
    ///
    /// # Errors
    /// [`ResponseError::Network`] that says what is wrong with the file.
    pub fn load(path: &Path) -> Result<Self, ResponseError> {
        Self::from_checkpoint(Checkpoint::read(path, KIND)?)
    }

    /// Takes a model that is part of the program.
    ///
    /// # Errors
    /// As for [`ResponseModel::load`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, ResponseError> {
        Self::from_checkpoint(Checkpoint::from_bytes(bytes, KIND)?)
    }

    fn from_checkpoint(mut file: Checkpoint) -> Result<Self, ResponseError> {
        let config: ResponseConfig = file.get("config")?;
        config.check()?;
        let record = file.get("record")?;
        let mut rng = random_stream(0, "response network", 0);
        let network = ResponseNetwork::new(&config.network, &mut rng)?;
        network.parameters().import(&file.take_group("network"))?;
        file.check_all_taken()?;
        Ok(Self { config, network, record })
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
        let network = &self.network;
        let n = network.n_components();
        let tokens = token_tensor(vehicle)?;
        let vehicle = Arc::new(vehicle.clone());
        let mut paths = vec![ComponentPath { weight: 0.0, states: vec![initial] }; n];
        for (i, input) in inputs.iter().enumerate() {
            let row = Row { vehicle: vehicle.clone(), input: *input, time_s: i as f64 * STEP_S };
            let rows = Arc::new(vec![row; n]);
            let latest = paths.iter().filter_map(|path| path.states.last());
            let x: Vec<f64> = latest.flat_map(|state| state.to_array()).collect();
            let x = Tensor::from_vec(x, (n, N_STATE), &Device::Cpu)?;
            let seen = feature_rows(&x, &rows)?.unsqueeze(0)?;
            let effects = if self.config.network.effects {
                effect_rows(&x, &network.strengths().detach(), &rows)?
            } else {
                Tensor::zeros((n, N_RESIDUAL), DType::F64, &Device::Cpu)?
            };
            let effects = effects.reshape((1, n, 1, N_RESIDUAL))?;
            let output = network.forward(Gradients::None, [&seen, &tokens, &effects])?;
            // Of each path its own component.
            let own = |j: usize| output.residual.get(0)?.get(j)?.get(j);
            let value: Vec<Tensor> = (0..n).map(own).collect::<Result<_, candle_core::Error>>()?;
            let value = Tensor::stack(&value, 0)?;
            let correction = self.config.network.correction;
            let next = step_rows(correction, [&x, &value], &rows)?.to_vec2::<f64>()?;
            let weights = softmax(&output.logits, 1.0)?.mean(1)?.to_vec2::<f64>()?;
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
