//! A trained response network and its file.

use crate::learning::{LearningError, ModelFile};
use crate::nn::{Checkpoint, ModelKind, parameter_budget, random_stream};
use crate::response::network::response_network::ResponseNetwork;
use crate::response::network::vehicle_network::VehicleNetwork;
use crate::response::{LatentScales, Predictor, ResponseCase, ResponseConfig, ResponseRecord};
use crate::vehicle::VehicleParameters;

/// A trained response network with all it takes to predict.
#[derive(Debug)]
pub struct ResponseModel {
    config: ResponseConfig,
    network: ResponseNetwork,
    latents: LatentScales,
    record: ResponseRecord,
}

impl ResponseModel {
    pub(crate) fn new(
        config: ResponseConfig,
        network: ResponseNetwork,
        record: ResponseRecord,
    ) -> Self {
        Self { config, network, latents: LatentScales::default(), record }
    }

    /// The configuration that the model was trained with.
    pub fn config(&self) -> &ResponseConfig {
        &self.config
    }

    /// How the model came to be.
    pub fn record(&self) -> &ResponseRecord {
        &self.record
    }

    /// Number of weights.
    pub fn n_parameters(&self) -> usize {
        self.network.parameters().n_values()
    }

    /// Whether a trajectory was seen in training, whatever it is called now.
    pub fn is_trained_on(&self, case: &ResponseCase) -> bool {
        self.record.train.iter().any(|known| known.digest == case.digest)
    }

    /// A copy of the model.
    ///
    /// # Errors
    /// [`LearningError::Network`].
    pub fn copied(&self) -> Result<Self, LearningError> {
        let mut rng = random_stream(0, "response network", 0);
        let network = ResponseNetwork::new(&self.config.network, &mut rng)?;
        network.parameters().import(&self.network.parameters().export()?)?;
        let (config, record) = (self.config.clone(), self.record.clone());
        Ok(Self { config, network, latents: self.latents, record })
    }

    pub(crate) fn network(&self) -> &ResponseNetwork {
        &self.network
    }

    /// How uncertain the model is along a motion.
    pub fn latents(&self) -> &LatentScales {
        &self.latents
    }

    /// Replaces the uncertainty.
    pub(crate) fn set_latents(&mut self, latents: LatentScales) {
        self.latents = latents;
    }

    /// Takes the uncertainty of the model that a fine-tuning started from, nowhere below the usual
    /// one: it was calibrated on other motions.
    pub(crate) fn keep_latents(&mut self, of_start: &LatentScales) {
        self.latents = of_start.at_least_usual();
        self.record.detail.keeps_latents = true;
    }

    /// The model for one vehicle.
    ///
    /// # Errors
    /// [`LearningError::Network`].
    pub fn predictor(&self, vehicle: &VehicleParameters) -> Result<Predictor, LearningError> {
        let network = VehicleNetwork::new(&self.network, vehicle)?;
        Ok(Predictor::new(vehicle.clone(), network, self.latents))
    }
}

impl ModelFile for ResponseModel {
    const KIND: ModelKind = ModelKind { name: "response network", version: 1 };

    type Error = LearningError;

    fn put(&self, file: &mut Checkpoint) -> Result<(), LearningError> {
        file.put("config", &self.config)?;
        file.put("latents", &self.latents)?;
        file.put("record", &self.record)?;
        file.put_group("network", self.network.parameters().export()?);
        Ok(())
    }

    fn take(file: &mut Checkpoint) -> Result<Self, LearningError> {
        let config: ResponseConfig = file.get("config")?;
        config.check()?;
        let mut rng = random_stream(0, "response network", 0);
        let tensors = file.take_group("network");
        let network =
            ResponseNetwork::within(parameter_budget(&tensors), &config.network, &mut rng)?;
        network.parameters().import(&tensors)?;
        let latents: LatentScales = file.get("latents")?;
        latents.check()?;
        Ok(Self { config, network, latents, record: file.get("record")? })
    }
}
