//! A trained response network and its file.

use std::path::Path;

use crate::nn::{Checkpoint, ModelKind, random_stream};
use crate::response::network::response_network::ResponseNetwork;
use crate::response::network::vehicle_network::VehicleNetwork;
use crate::response::{
    LatentScales, Predictor, ResponseCase, ResponseConfig, ResponseError, ResponseRecord,
};
use crate::vehicle::VehicleParameters;

const KIND: ModelKind = ModelKind { name: ResponseModel::KIND_NAME, version: 1 };

/// A trained response network with all it takes to predict.
#[derive(Debug)]
pub struct ResponseModel {
    config: ResponseConfig,
    network: ResponseNetwork,
    latents: LatentScales,
    record: ResponseRecord,
}

impl ResponseModel {
    /// What its files say they hold, see [`kind_of_file`](crate::nn::kind_of_file).
    pub const KIND_NAME: &'static str = "response network";

    pub(crate) fn new(
        config: ResponseConfig,
        network: ResponseNetwork,
        record: ResponseRecord,
    ) -> Self {
        Self { config, network, latents: LatentScales::default(), record }
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

    /// The same model once more.
    ///
    /// # Errors
    /// [`ResponseError::Network`].
    pub fn copied(&self) -> Result<Self, ResponseError> {
        let mut rng = random_stream(0, "response network", 0);
        let network = ResponseNetwork::new(&self.config.network, &mut rng)?;
        network.parameters().import(&self.network.parameters().export()?)?;
        let (config, record) = (self.config.clone(), self.record.clone());
        Ok(Self { config, network, latents: self.latents, record })
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
        file.put("latents", &self.latents)?;
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
        let latents = file.get("latents")?;
        let record = file.get("record")?;
        let mut rng = random_stream(0, "response network", 0);
        let network = ResponseNetwork::new(&config.network, &mut rng)?;
        network.parameters().import(&file.take_group("network"))?;
        file.check_all_taken()?;
        Ok(Self { config, network, latents, record })
    }

    /// How uncertain it is along a motion.
    pub fn latents(&self) -> &LatentScales {
        &self.latents
    }

    /// The same model with another uncertainty.
    pub(crate) fn set_latents(&mut self, latents: LatentScales) {
        self.latents = latents;
    }

    /// Takes the uncertainty of the model that a fine-tuning started from, nowhere below the usual
    /// one: it was calibrated on other motions.
    pub(crate) fn keep_latents(&mut self, of_start: &LatentScales) {
        self.latents = of_start.at_least_usual();
        self.record.keeps_latents = true;
    }

    /// The model for one vehicle.
    ///
    /// # Errors
    /// [`ResponseError::Network`].
    pub fn predictor(&self, vehicle: &VehicleParameters) -> Result<Predictor, ResponseError> {
        let network = VehicleNetwork::new(&self.network, vehicle)?;
        Ok(Predictor::new(vehicle.clone(), network, self.latents))
    }
}
