//! The pre-training of the response network: `train response`; and what is told of any training of
//! it.

use crate::caveats::assumed;
use std::path::PathBuf;
use std::time::Instant;

use impactlab_core::uncertainty::{CaveatSubject, Caveats};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::caveats::restrictions;

use crate::ask::inputs::{OpenVehicle, data_name, force_cases, response_cases, struck_vehicle};
use crate::ask::provenance::RESPONSE_NETWORK;
use crate::{
    Answer, Event, Library, LogReport, Observer, Provenance, Question, StudyError, TrainingOptions,
    VehicleChoice,
};
use impactlab_core::data::write::ModelDigest;
use impactlab_core::data::{DatasetKind, Outcome};
use impactlab_core::vehicle::VehicleParameters;
use impactlab_networks::force::ForceCase;
use impactlab_networks::learning::{TEST_SHARE, TrainingCase, split};
use impactlab_networks::response::{
    ImpactRecord, LatentScales, ResponseCase, ResponseConfig, ResponseLossTerms, ResponseModel,
    ResponseTrainSettings, pretrain,
};

/// Asks for a response network that has learned from simulations under recorded forces.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TrainResponseRequest {
    /// A force or trajectory data set: its forces drive the simulations; a share of its cases is
    /// left out, so that they can serve as a test later.
    pub data: PathBuf,
    /// The struck vehicle.
    #[serde(default)]
    pub vehicle: VehicleChoice,
    /// The plain network of the comparison instead: no 4DOF model, no guard, no physics.
    #[serde(default)]
    pub plain: bool,
    /// Settings, seed, checkpoint.
    #[serde(flatten)]
    pub training: TrainingOptions,
}

/// What was trained.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ResponseTrainingReport {
    /// What the data are called.
    pub data: String,
    /// SHA-256 over the cases learned from.
    pub data_digest: String,
    /// Seed of all draws but the split's.
    pub seed: u64,
    /// Simulated motions that were learned from.
    pub n_simulated: usize,
    /// Names of the trajectories learned from.
    pub train: Vec<String>,
    /// Trajectories kept apart for the test.
    pub n_test: usize,
    /// Weights of the network.
    pub n_parameters: usize,
    /// How long it took, s.
    pub seconds: f64,
    /// Epochs in all.
    pub epochs: usize,
    /// Losses of the last epoch.
    pub loss: Option<ResponseLossTerms>,
    /// Share of the data in the loss of the last epoch.
    pub balance: Option<f64>,
    /// How uncertain the latent factors are.
    pub latents: LatentScales,
    /// Whether they were kept from the model before.
    pub keeps_latents: bool,
    /// What was made of each log.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub logs: Vec<LogReport>,
    /// Cases that were left out, and why.
    pub left_out: Vec<String>,
}

/// A trained response network.
#[derive(Debug)]
pub struct ResponseTrainingAnswer {
    /// What is told, with what restricts it and where it comes from.
    pub report: Answer<ResponseTrainingReport>,
    /// The network.
    pub model: ResponseModel,
}

impl TrainResponseRequest {
    /// The settings that it trains with.
    ///
    /// # Errors
    /// [`StudyError::Learning`] with what is wrong with the file.
    pub fn settings(&self) -> Result<ResponseConfig, StudyError> {
        let config = self.training.config.response(None)?;
        Ok(if self.plain { config.plain() } else { config })
    }

    /// The forces of the cases that are not kept for a test.
    pub(crate) fn records(
        &self,
        notes: &mut TrainingNotes,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<Vec<ImpactRecord>>, StudyError> {
        if DatasetKind::from_folder(&self.data) == Some(DatasetKind::Trajectory) {
            let caveats = &mut notes.caveats;
            let cases = response_cases(
                &self.data,
                &self.vehicle,
                self.training.bad_cases,
                caveats,
                library,
                observer,
            )?;
            return Ok(cases.map(|usable| {
                notes.left_out = usable.left_out;
                let learned = self.learned_from(&usable.cases);
                learned.filter_map(ResponseCase::impact).collect()
            }));
        }
        let vehicle =
            struck_vehicle(&self.vehicle, &OpenVehicle::OfDataset(None), &mut notes.caveats)?;
        let medians = assumed::medians(CaveatSubject::VehicleParameter, &vehicle);
        notes.caveats.extend(medians);
        let cases = force_cases(&self.data, self.training.bad_cases, library, observer)?;
        Ok(cases.map(|usable| {
            notes.left_out = usable.left_out;
            let learned = self.learned_from(&usable.cases);
            learned.filter_map(|case| impact_record(case, &vehicle)).collect()
        }))
    }

    fn learned_from<'a, C: TrainingCase>(&self, cases: &'a [C]) -> impl Iterator<Item = &'a C> {
        split(cases, self.training.seed, TEST_SHARE)
            .train
            .into_iter()
            .filter_map(|idx| cases.get(idx))
    }
}

/// The impact of a case of a force data set; `None` where it does not say where the contact was.
fn impact_record(case: &ForceCase, vehicle: &VehicleParameters) -> Option<ImpactRecord> {
    let scenario = &case.scenario;
    let contact_m = scenario.contact_m?;
    let vehicle = vehicle.clone().with_mass(scenario.mass_kg[0], scenario.yaw_inertia_kg_m2[0]);
    let force = case.curve.to_history();
    Some(ImpactRecord::under_force(vehicle, scenario.struck_velocity_m_s, contact_m, force))
}

/// What a person should know about the data of a training.
#[derive(Debug, Default)]
pub(crate) struct TrainingNotes {
    pub(crate) logs: Vec<LogReport>,
    pub(crate) left_out: Vec<String>,
    pub(crate) caveats: Caveats,
    /// The network from which the training starts, if it starts from one.
    pub(crate) start: Option<ModelDigest>,
}

impl Question for TrainResponseRequest {
    type Answer = ResponseTrainingAnswer;
    type Report = Answer<ResponseTrainingReport>;
    const NAME: &'static str = "train";

    fn check(&self) -> Result<(), StudyError> {
        Ok(())
    }

    fn report(answer: &Self::Answer) -> &Self::Report {
        &answer.report
    }

    fn solve(
        &self,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<ResponseTrainingAnswer>, StudyError> {
        // Held until the training is over.
        let _claim = self.training.claim()?;
        let settings = ResponseTrainSettings {
            config: self.settings()?,
            seed: self.training.seed,
            checkpoint: self.training.checkpoint.clone(),
            resume: self.training.resume,
        };
        let mut notes = TrainingNotes::default();
        let records = self.records(&mut notes, library, observer)?;
        let Outcome::Complete(records) = records else { return Ok(Outcome::Cancelled) };
        let (started, name) = (Instant::now(), data_name(&self.data));
        let model =
            pretrain(&name, &records, &settings, &mut |report| observer(Event::Training(report)))?;
        let answer = ResponseTrainingAnswer::new(model, started.elapsed().as_secs_f64(), notes)?;
        Ok(Outcome::Complete(answer))
    }
}

impl ResponseTrainingAnswer {
    pub(crate) fn new(
        model: ResponseModel,
        seconds: f64,
        notes: TrainingNotes,
    ) -> Result<Self, StudyError> {
        // The report has the seed already.
        let provenance = Provenance::default().with_models(notes.start);
        let provenance = provenance.with_trained(RESPONSE_NETWORK, &model)?;
        let mut caveats = notes.caveats;
        caveats.extend(restrictions::left_out_caveat(notes.left_out.len(), "cases"));
        let report = ResponseTrainingReport::new(&model, seconds, (notes.logs, notes.left_out));
        let report = Answer { report, caveats, provenance };
        Ok(Self { report, model })
    }
}

impl ResponseTrainingReport {
    /// What is told of a model, the logs it has learned from, and why cases are left out.
    pub(crate) fn new(
        model: &ResponseModel,
        seconds: f64,
        (logs, left_out): (Vec<LogReport>, Vec<String>),
    ) -> Self {
        let record = model.record();
        let last = record.history.last();
        Self {
            data: record.data.clone(),
            data_digest: record.data_digest.clone(),
            seed: record.seed,
            n_simulated: record.detail.n_simulated,
            train: record.train.iter().map(|case| case.name.clone()).collect(),
            n_test: record.test.len(),
            n_parameters: model.n_parameters(),
            seconds,
            epochs: record.history.len(),
            loss: last.map(|epoch| epoch.detail.loss),
            balance: last.map(|epoch| epoch.detail.balance),
            latents: *model.latents(),
            keeps_latents: record.detail.keeps_latents,
            logs,
            left_out,
        }
    }
}
