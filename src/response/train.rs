//! Trains the response network: on simulations, then on trajectories, on single steps and on
//! rollouts of growing length.

use std::cell::Cell;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::Instant;

use candle_core::Tensor;
use rand::RngExt;
use rand::seq::SliceRandom;
use rand_distr::StandardNormal;

use crate::data::{Split, folds};
use crate::force::CaseId;
use crate::nn::{
    AdamW, AdamWConfig, NamedTensors, OptimizerState, Schedule, StepReport, random_stream,
};
use crate::response::calibration::{Unseen, calibrate};
use crate::response::effects_fit::fit_strengths;
use crate::response::loss::{Loss, boundary, diversity, single_step_terms};
use crate::response::model::ResponseModel;
use crate::response::network::{Gradients, ResponseNetwork};
use crate::response::one_step::{MotionView, OneStepData};
use crate::response::physics_points::PhysicsPoints;
use crate::response::record::case_id;
use crate::response::rollout_loss::{RolloutCase, Window, rollout_loss};
use crate::response::simulated::{ImpactRecord, SimulatedMotion, simulate};
use crate::response::training_file::TrainingFile;
use crate::response::{
    Correction, ResponseCase, ResponseConfig, ResponseEpoch, ResponseError, ResponseLossTerms,
    ResponseRecord, ResponseStage, ResponseTrainingSet,
};

/// Share of the optimiser's steps over which the learning rate of single steps rises.
const WARMUP_SHARE: f64 = 0.1;
/// Epochs between two checkpoints.
const CHECKPOINT_EPOCHS: usize = 5;
/// Share of the windows of a rollout that start with the impact.
const IMPACT_SHARE: f64 = 0.5;

/// What to train and how.
#[derive(Debug, Clone, PartialEq)]
pub struct ResponseTrainSettings {
    /// Sizes, weights and rates.
    pub config: ResponseConfig,
    /// All draws come from it.
    pub seed: u64,
    /// Where the training is saved every few epochs.
    pub checkpoint: Option<PathBuf>,
    /// Whether to go on from that file, if it is there.
    pub resume: bool,
}

/// How far a training has come: an epoch is over.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ResponseReport<'a> {
    /// Its losses.
    pub record: &'a ResponseEpoch,
    /// Epochs in all.
    pub n_epochs: usize,
    /// Which training of several it is: 0 for the model itself, then those for the calibration.
    pub training_idx: usize,
    /// How many trainings there are.
    pub n_trainings: usize,
}

/// The callback of a training: breaking ends it with the weights as they are.
pub type ResponseProgress<'a> = dyn FnMut(ResponseReport<'_>) -> ControlFlow<()> + 'a;

/// Pre-trains a network on simulations of the 4DOF model under recorded forces.
///
/// - `records`: vehicles, driving states and forces; no motion after the impact is looked at.
///
/// # Errors
/// [`ResponseError`].
pub fn pretrain(
    (name, records): (&str, &[ImpactRecord]),
    settings: &ResponseTrainSettings,
    report: &mut ResponseProgress<'_>,
) -> Result<ResponseModel, ResponseError> {
    settings.config.check()?;
    let config = &settings.config;
    let motions = simulate(records, config.pretraining.motions, (true, settings.seed));
    if motions.is_empty() {
        return Err(ResponseError::NoCases);
    }
    let network = fresh_network(settings)?;
    // The last state: the whole motion led there.
    let last: Vec<Vec<u8>> = motions.iter().map(bytes_of_last).collect();
    let identity = crate::nn::sha256_hex(last.iter().map(Vec::as_slice));
    let data = Data::of_simulations(&motions, config);
    let set = ResponseTrainingSet { name: name.to_owned(), ..ResponseTrainingSet::default() };
    let plan =
        vec![Planned { stage: ResponseStage::Pretraining, n_epochs: config.pretraining.epochs }];
    let file = TrainingFile::new(settings, identity.clone());
    let training = Training::new(settings, (network, data, plan), Vec::new())?;
    let (network, history) = training.run(&file, report)?;
    let record = record((&set, identity), settings, (motions.len(), history));
    Ok(ResponseModel::new(config.clone(), network, record))
}

/// Fine-tunes a network on trajectories, and calibrates how uncertain it is.
///
/// - `start`: a pre-trained model, whose first layers stay as they are; `None` for a fresh network,
///   all of whose layers are trained.
///
/// A training that was killed goes on from its checkpoint to the same weights as if it had not been.
///
/// # Errors
/// [`ResponseError`].
pub fn fine_tune(
    start: Option<&ResponseModel>,
    set: &ResponseTrainingSet,
    settings: &ResponseTrainSettings,
    report: &mut ResponseProgress<'_>,
) -> Result<ResponseModel, ResponseError> {
    settings.config.check()?;
    let folds = calibration_folds(set, settings);
    let n_trainings = folds.len() + 1;
    let (training_idx, is_cut) = (Cell::new(0), Cell::new(false));
    let mut told = |told: ResponseReport<'_>| {
        let flow = report(ResponseReport { training_idx: training_idx.get(), n_trainings, ..told });
        is_cut.set(is_cut.get() || flow.is_break());
        flow
    };
    let mut model = fine_tune_once(start, set, settings, &mut told)?;
    let mut unseen = Vec::new();
    for fold in &folds {
        if is_cut.get() {
            return Ok(model);
        }
        training_idx.set(training_idx.get() + 1);
        let part = part_of(set, &fold.train);
        let quiet = ResponseTrainSettings { checkpoint: None, ..settings.clone() };
        let member = fine_tune_once(start, &part, &quiet, &mut told)?;
        for case in fold.test.iter().filter_map(|&idx| set.train.get(idx)) {
            unseen.push(Unseen { case, predictor: member.predictor(&case.vehicle)? });
        }
    }
    if !is_cut.get() && !unseen.is_empty() {
        model.set_latents(calibrate(&unseen, settings.config.calibration.prior_std));
    }
    Ok(model)
}

/// The trajectories that each of the trainings for the calibration leaves out.
fn calibration_folds(set: &ResponseTrainingSet, settings: &ResponseTrainSettings) -> Vec<Split> {
    let n_folds = settings.config.calibration.folds.min(set.train.len());
    match n_folds {
        0 | 1 => Vec::new(),
        n_folds => folds(&set.train, n_folds, settings.seed),
    }
}

fn part_of(set: &ResponseTrainingSet, indices: &[usize]) -> ResponseTrainingSet {
    let train = indices.iter().filter_map(|&idx| set.train.get(idx).cloned()).collect();
    ResponseTrainingSet { train, ..set.clone() }
}

fn fine_tune_once(
    start: Option<&ResponseModel>,
    set: &ResponseTrainingSet,
    settings: &ResponseTrainSettings,
    report: &mut ResponseProgress<'_>,
) -> Result<ResponseModel, ResponseError> {
    let config = &settings.config;
    if !set.train.iter().any(|case| case.states.len() > 1 && !case.inputs.is_empty()) {
        return Err(ResponseError::NoCases);
    }
    let mut network = fresh_network(settings)?;
    let (mut n_simulated, mut history) = (0, Vec::new());
    if let Some(start) = start {
        network.parameters().import(&start.network().parameters().export()?)?;
        if config.network.correction != Correction::Whole {
            network.silence()?;
        }
        network.freeze(config.single_steps.frozen_share);
        n_simulated = start.record().n_simulated;
        history.clone_from(&start.record().history);
    } else {
        network.freeze(0.0);
    }
    let data = Data::of_trajectories(&set.train, config, settings.seed);
    if config.network.effects {
        let rows: Vec<_> =
            data.instants.rows().iter().map(|row| (&*row.effects, row.target)).collect();
        network.set_strengths(&fit_strengths(&rows, config.network.unit, config.effects))?;
    }
    let mut plan =
        vec![Planned { stage: ResponseStage::SingleSteps, n_epochs: config.single_steps.epochs }];
    plan.extend(config.rollouts.lengths.iter().map(|&length| Planned {
        stage: ResponseStage::Rollouts { length },
        n_epochs: config.rollouts.epochs,
    }));
    let start_digest = start.map_or(String::new(), |start| start.record().data_digest.clone());
    let identity = crate::nn::sha256_hex([set.digest().as_bytes(), start_digest.as_bytes()]);
    let file = TrainingFile::new(settings, identity);
    let training = Training::new(settings, (network, data, plan), history)?;
    let (network, history) = training.run(&file, report)?;
    let record = record((set, set.digest()), settings, (n_simulated, history));
    Ok(ResponseModel::new(config.clone(), network, record))
}

fn fresh_network(settings: &ResponseTrainSettings) -> Result<ResponseNetwork, ResponseError> {
    let mut rng = random_stream(settings.seed, "response network", 0);
    Ok(ResponseNetwork::new(&settings.config.network, &mut rng)?)
}

fn bytes_of_last(motion: &SimulatedMotion) -> Vec<u8> {
    let last = motion.states.last().copied().unwrap_or_default().to_array();
    last.iter().flat_map(|value| value.to_le_bytes()).collect()
}

fn record(
    (set, data_digest): (&ResponseTrainingSet, String),
    settings: &ResponseTrainSettings,
    (n_simulated, history): (usize, Vec<ResponseEpoch>),
) -> ResponseRecord {
    let train: Vec<CaseId> = set.train.iter().map(case_id).collect();
    ResponseRecord {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        data: set.name.clone(),
        data_digest,
        seed: settings.seed,
        n_simulated,
        train,
        test: set.test.clone(),
        history,
    }
}

/// Some epochs of one kind.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Planned {
    stage: ResponseStage,
    n_epochs: usize,
}

/// What is learned from.
struct Data<'a> {
    instants: OneStepData,
    /// Away from the data; none for pre-training.
    physics_points: Option<PhysicsPoints>,
    rollouts: Vec<RolloutCase<'a>>,
}

impl<'a> Data<'a> {
    fn of_simulations(motions: &[SimulatedMotion], config: &ResponseConfig) -> Self {
        let views: Vec<MotionView<'_>> = motions.iter().map(SimulatedMotion::view).collect();
        let instants = OneStepData::of(&views, &config.network);
        Self { instants, physics_points: None, rollouts: Vec::new() }
    }

    fn of_trajectories(cases: &'a [ResponseCase], config: &ResponseConfig, seed: u64) -> Self {
        let view = |case: &'a ResponseCase| MotionView {
            centre: &case.vehicle,
            vehicle: &case.vehicle,
            states: &case.states,
            inputs: &case.inputs,
        };
        let views: Vec<MotionView<'_>> = cases.iter().map(view).collect();
        let instants = OneStepData::of(&views, &config.network);
        let records: Vec<ImpactRecord> = cases.iter().filter_map(ResponseCase::impact).collect();
        let physics_points = (config.loss.physics > 0.0 && config.physics.batch_instants > 0)
            .then(|| PhysicsPoints::about(&instants, &records, (config, seed)));
        let rollouts = cases
            .iter()
            .map(|case| RolloutCase { case, vehicle: case.vehicle.clone().into() })
            .collect();
        Self { instants, physics_points, rollouts }
    }
}

/// What a checkpoint holds.
pub(super) struct SavedTraining {
    pub parameters: NamedTensors,
    pub moments: NamedTensors,
    pub step: u64,
    pub history: Vec<ResponseEpoch>,
}

struct Training<'a> {
    settings: &'a ResponseTrainSettings,
    network: ResponseNetwork,
    data: Data<'a>,
    plan: Vec<Planned>,
    /// Of the stage under way.
    optimizer: AdamW,
    /// Of this training and those before.
    history: Vec<ResponseEpoch>,
    /// Epochs of those before.
    n_before: usize,
}

impl<'a> Training<'a> {
    fn new(
        settings: &'a ResponseTrainSettings,
        (network, data, plan): (ResponseNetwork, Data<'a>, Vec<Planned>),
        history: Vec<ResponseEpoch>,
    ) -> Result<Self, ResponseError> {
        let optimizer = AdamW::new(AdamWConfig::default(), network.parameters())?;
        let n_before = history.len();
        Ok(Self { settings, network, data, plan, optimizer, history, n_before })
    }

    /// All epochs that are left.
    fn run(
        mut self,
        file: &TrainingFile,
        report: &mut ResponseProgress<'_>,
    ) -> Result<(ResponseNetwork, Vec<ResponseEpoch>), ResponseError> {
        let n_epochs: usize = self.plan.iter().map(|planned| planned.n_epochs).sum();
        let saved = file.read()?;
        let mut skip =
            saved.as_ref().map_or(0, |saved| saved.history.len().saturating_sub(self.n_before));
        let mut moments = None;
        if let Some(saved) = saved {
            self.network.parameters().import(&saved.parameters)?;
            moments = Some(OptimizerState { step: saved.step, moments: saved.moments });
            self.history = saved.history;
        }
        for planned in self.plan.clone() {
            if skip >= planned.n_epochs {
                skip -= planned.n_epochs;
                continue;
            }
            self.optimizer = AdamW::new(self.optimizer_config(planned), self.network.parameters())?;
            if let Some(moments) = moments.take().filter(|_| skip > 0) {
                self.optimizer.import(&moments)?;
            }
            for in_stage in std::mem::take(&mut skip)..planned.n_epochs {
                self.epoch(planned.stage)?;
                let Some(record) = self.history.last() else { continue };
                let is_broken = report(ResponseReport {
                    record,
                    n_epochs: self.n_before + n_epochs,
                    training_idx: 0,
                    n_trainings: 1,
                })
                .is_break();
                let is_last = in_stage + 1 == planned.n_epochs;
                if is_broken || is_last || (in_stage + 1).is_multiple_of(CHECKPOINT_EPOCHS) {
                    file.write(&self.saved()?)?;
                }
                if is_broken {
                    return Ok((self.network, self.history));
                }
            }
        }
        Ok((self.network, self.history))
    }

    fn saved(&self) -> Result<SavedTraining, ResponseError> {
        let OptimizerState { step, moments } = self.optimizer.export()?;
        let parameters = self.network.parameters().export()?;
        Ok(SavedTraining { parameters, moments, step, history: self.history.clone() })
    }

    fn optimizer_config(&self, planned: Planned) -> AdamWConfig {
        let ResponseConfig { pretraining, single_steps, rollouts, .. } = &self.settings.config;
        let n_batches = self.batches_per_epoch(planned.stage);
        let total_steps = (n_batches * planned.n_epochs) as u64;
        let warmup = |share: f64| (total_steps as f64 * share) as u64;
        let (learning_rate, warmup_steps) = match planned.stage {
            ResponseStage::Pretraining => (pretraining.learning_rate, warmup(WARMUP_SHARE)),
            ResponseStage::SingleSteps => (single_steps.learning_rate, warmup(WARMUP_SHARE)),
            ResponseStage::Rollouts { .. } => (rollouts.learning_rate, 0),
        };
        AdamWConfig {
            learning_rate,
            weight_decay: single_steps.weight_decay,
            max_gradient_norm: Some(single_steps.max_gradient_norm),
            schedule: Schedule::WarmupCosine { warmup_steps, total_steps, final_share: 0.01 },
            ..AdamWConfig::default()
        }
    }

    fn batches_per_epoch(&self, stage: ResponseStage) -> usize {
        let config = &self.settings.config;
        match stage {
            ResponseStage::Pretraining | ResponseStage::SingleSteps => {
                self.data.instants.rows().len().div_ceil(config.single_steps.batch_instants)
            }
            ResponseStage::Rollouts { .. } => {
                self.data.rollouts.len().div_ceil(config.rollouts.batch_windows)
            }
        }
    }

    fn epoch(&mut self, stage: ResponseStage) -> Result<(), ResponseError> {
        let started = Instant::now();
        let config = &self.settings.config;
        let epoch = self.history.len() + 1;
        let balance = self.history.last().map_or(1.0, |record| record.balance);
        let in_training = epoch - self.n_before;
        let physics_weight = match stage {
            ResponseStage::Pretraining => 0.0,
            _ => config.physics.weight(in_training, balance),
        };
        let (mut terms, mut gradient_norm, mut learning_rate) = (Vec::new(), 0.0_f64, 0.0);
        let mut take = |loss: Loss, network: &ResponseNetwork, optimizer: &mut AdamW| {
            let (total, values) = loss.total(&config.loss, physics_weight)?;
            if !values.total.is_finite() {
                return Err(ResponseError::Diverged { loss: values.total, epoch });
            }
            let gradients = total.backward()?;
            let step: StepReport = optimizer.step(network.parameters(), &gradients)?;
            gradient_norm = gradient_norm.max(step.gradient_norm);
            learning_rate = step.learning_rate;
            terms.push(values);
            Ok(())
        };
        let mut rng =
            random_stream(self.settings.seed, "epochs of the response network", epoch as u64);
        match stage {
            ResponseStage::Pretraining | ResponseStage::SingleSteps => {
                let mut order: Vec<usize> = (0..self.data.instants.rows().len()).collect();
                order.shuffle(&mut rng);
                for batch in order.chunks(config.single_steps.batch_instants) {
                    let loss = self.single_step_loss(batch, stage, &mut rng)?;
                    take(loss, &self.network, &mut self.optimizer)?;
                }
            }
            ResponseStage::Rollouts { length } => {
                let mut order: Vec<usize> = (0..self.data.rollouts.len()).collect();
                order.shuffle(&mut rng);
                for batch in order.chunks(config.rollouts.batch_windows) {
                    let window = |&case_idx: &usize| {
                        let n_steps = self.data.rollouts[case_idx].case.inputs.len();
                        let last = n_steps.saturating_sub(length);
                        let is_first = rng.random_bool(IMPACT_SHARE);
                        let start = if is_first { 0 } else { rng.random_range(0..=last) };
                        Window { case_idx, start }
                    };
                    let windows: Vec<Window> = batch.iter().map(window).collect();
                    let lengths = [length, config.rollouts.truncation];
                    let loss = rollout_loss(&self.network, &self.data.rollouts, &windows, lengths)?;
                    take(loss, &self.network, &mut self.optimizer)?;
                }
            }
        }
        let loss = ResponseLossTerms::mean(&terms);
        let of_physics = config.loss.physics * physics_weight * loss.physics;
        let balance = if of_physics > 0.0 { loss.data / (loss.data + of_physics) } else { 1.0 };
        let seconds = started.elapsed().as_secs_f64();
        self.history.push(ResponseEpoch {
            epoch,
            stage,
            loss,
            physics_weight,
            balance,
            learning_rate,
            gradient_norm,
            seconds,
        });
        Ok(())
    }

    fn single_step_loss(
        &self,
        batch: &[usize],
        stage: ResponseStage,
        rng: &mut rand_chacha::ChaCha8Rng,
    ) -> Result<Loss, ResponseError> {
        let config = &self.settings.config;
        let gradients = match stage {
            ResponseStage::Pretraining => Gradients::All,
            _ => Gradients::FineTuned,
        };
        let batch = self.data.instants.select(batch)?;
        let noise = config.single_steps.feature_noise;
        let noise: Vec<f64> = (0..batch.features.elem_count())
            .map(|_| noise * rng.sample::<f64, _>(StandardNormal))
            .collect();
        let noise = Tensor::from_vec(noise, batch.features.shape(), batch.features.device())?;
        let features = (&batch.features + noise)?;
        // Single steps leave the strengths as least squares found them.
        let effects = batch.correction(&self.network.strengths().detach())?;
        let output = self.network.forward(gradients, [&features, &batch.tokens, &effects])?;
        let network = &config.network;
        let change = network.correction.change_per_unit();
        let scales = (network.unit, change, network.min_std);
        let [data, likelihood] = single_step_terms(&output, &batch.targets, scales)?;
        let factor = config.physics.quality_factor(1.0);
        let mut physics = (output.remainder.sqr()?.mean_all()? * factor)?;
        if let Some(points) =
            self.data.physics_points.as_ref().filter(|_| stage != ResponseStage::Pretraining)
        {
            let far = points.draw(config.physics.batch_instants, rng)?;
            let none = Tensor::zeros_like(&effects.narrow(0, 0, 1)?.narrow(2, 0, 1)?)?;
            let output = self.network.forward(gradients, [&far.features, &far.tokens, &none])?;
            let squares = output.remainder.sqr()?.mean((1, 2, 3))?;
            physics = (physics + (squares * &far.factors)?.mean_all()?)?;
        }
        let unit = Tensor::new(&network.unit, output.residual.device())?;
        let standardised = output.residual.broadcast_div(&unit)?.squeeze(1)?;
        let zero = Tensor::zeros((), candle_core::DType::F64, output.residual.device())?;
        Ok(Loss {
            data,
            likelihood,
            physics,
            diversity: diversity(&standardised)?,
            trajectory: zero.clone(),
            smoothness: zero,
            boundary: boundary(&batch.states, &self.network.boundary_scale()?)?,
        })
    }
}
