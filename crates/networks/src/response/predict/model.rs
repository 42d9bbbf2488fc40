//! A trained response network and its file.

use std::sync::Arc;

use crate::learning::{CaseId, LearningError, ModelFile};
use crate::nn::{Checkpoint, ModelKind, parameter_budget};
use crate::response::network::response_network::ResponseNetwork;
use crate::response::network::vehicle_network::VehicleNetwork;
use crate::response::predict::predictor::{PredictorSource, SourceStrengths};
use crate::response::{
    KnownCar, LatentScales, MotionDomain, Predictor, ResponseCase, ResponseConfig, ResponseRecord,
    StrengthPopulation,
};
use impactlab_core::numerics::{random_stream, sha256_hex};
use impactlab_core::vehicle::VehicleParameters;

/// A trained response network with all it takes to predict.
#[derive(Debug)]
pub struct ResponseModel {
    config: ResponseConfig,
    network: ResponseNetwork,
    latents: LatentScales,
    /// How the strengths are distributed over cars, if that was learned.
    population: Option<Arc<StrengthPopulation>>,
    /// What was learned from, if trajectories were.
    domain: Option<MotionDomain>,
    record: ResponseRecord,
}

impl ResponseModel {
    pub(crate) fn new(
        config: ResponseConfig,
        network: ResponseNetwork,
        record: ResponseRecord,
    ) -> Self {
        let latents = LatentScales::default();
        Self { config, network, latents, population: None, domain: None, record }
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
        let (population, domain) = (self.population.clone(), self.domain.clone());
        Ok(Self { config, network, latents: self.latents, population, domain, record })
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

    /// How the strengths are distributed over cars, if that was learned.
    pub fn population(&self) -> Option<&StrengthPopulation> {
        self.population.as_deref()
    }

    /// Replaces how the strengths are distributed over cars.
    pub(crate) fn set_population(&mut self, population: StrengthPopulation) {
        self.population = Some(Arc::new(population));
    }

    /// Says what was learned from.
    pub(crate) fn set_domain(&mut self, domain: MotionDomain) {
        self.domain = Some(domain);
    }

    /// Adds trajectories to those that were learned from.
    pub(crate) fn add_to_record(&mut self, data: &str, cases: &[ResponseCase]) {
        let record = &mut self.record;
        record.data = format!("{}, {data}", record.data);
        record.train.extend(cases.iter().map(CaseId::from_case));
        record.data_digest = sha256_hex(record.train.iter().map(|case| case.digest.as_bytes()));
    }

    /// The car that a vehicle is, if trajectories of it are known.
    pub fn known_car(&self, vehicle: &VehicleParameters) -> Option<&KnownCar> {
        self.population()?.known(vehicle)
    }

    /// The model for one vehicle.
    ///
    /// # Errors
    /// [`LearningError::Network`].
    pub fn predictor(&self, vehicle: &VehicleParameters) -> Result<Predictor, LearningError> {
        let domain = self.domain.clone().unwrap_or_default();
        let network = VehicleNetwork::new(&self.network, vehicle)?.learned_for(domain.duration_s());
        let strengths = match &self.population {
            Some(population) => {
                let of_car = population.car_strengths(vehicle, &network.mean_strengths());
                SourceStrengths::Population(Arc::clone(population), of_car)
            }
            None => SourceStrengths::OneCar(self.latents),
        };
        let open = self.population().map(|population| match population.known(vehicle) {
            Some(car) => population.open_share(&car.strengths),
            None => 1.0,
        });
        let of_vehicle = domain.vehicle_applicability(vehicle, open.unwrap_or(1.0));
        let source = PredictorSource { network, strengths, domain, of_vehicle };
        Ok(Predictor::from_source(vehicle.clone(), source))
    }
}

impl ModelFile for ResponseModel {
    const KIND: ModelKind = ModelKind { name: "response network", version: 1 };

    type Error = LearningError;

    fn put(&self, file: &mut Checkpoint) -> Result<(), LearningError> {
        file.put("config", &self.config)?;
        file.put("latents", &self.latents)?;
        file.put("record", &self.record)?;
        if let Some(domain) = &self.domain {
            file.put("domain", domain)?;
        }
        if let Some(population) = &self.population {
            population.put(file)?;
        }
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
        let domain: Option<MotionDomain> = file.find("domain")?;
        if let Some(domain) = &domain {
            domain.check()?;
        }
        let population = StrengthPopulation::take(file)?.map(Arc::new);
        Ok(Self { config, network, latents, population, domain, record: file.get("record")? })
    }
}
