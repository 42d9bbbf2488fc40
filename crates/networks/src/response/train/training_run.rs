//! The epochs of a training of the response network, one stage after the other.

use std::time::Instant;

use candle_core::{DType, Tensor};
use rand::RngExt;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

use crate::learning::{EpochLoop, EpochRecord, EpochReport, LearningError, SavedTraining};
use crate::nn::{AdamW, AdamWConfig, Checkpoint, ModelKind, NnError, Schedule};
use crate::response::network::loss::{ResponseLoss, boundary, diversity, single_step_terms};
use crate::response::network::response_network::{Gradients, ResponseNetwork};
use crate::response::network::rollout_loss::{RolloutWindow, rollout_loss};
use crate::response::train::training_data::TrainingData;
use crate::response::{
    ResponseConfig, ResponseEpoch, ResponseLossTerms, ResponseStage, ResponseTrainSettings,
};
use impactlab_core::numerics::random_stream;

/// Kind and version of the checkpoints of a training.
pub const RESPONSE_CHECKPOINT: ModelKind =
    ModelKind { name: "training of a response network", version: 1 };

/// Share of the optimiser's steps over which the learning rate of single steps rises.
const WARMUP_SHARE: f64 = 0.1;
/// Epochs between two checkpoints.
const CHECKPOINT_EPOCHS: usize = 5;
/// Share of the windows of a rollout that start with the impact.
const IMPACT_SHARE: f64 = 0.5;

/// A stage of a training and its number of epochs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Planned {
    pub stage: ResponseStage,
    pub n_epochs: usize,
}

/// A training under way.
pub(super) struct TrainingRun<'a> {
    settings: &'a ResponseTrainSettings,
    network: ResponseNetwork,
    data: TrainingData<'a>,
    plan: Vec<Planned>,
    /// Optimiser of the stage under way.
    optimizer: AdamW,
    /// Epochs of this training and of those before it.
    history: Vec<EpochRecord<ResponseEpoch>>,
    /// Number of epochs of the trainings before it.
    n_before: usize,
}

impl<'a> TrainingRun<'a> {
    /// A training that starts.
    ///
    /// - `history`: epochs of the training from which this one starts.
    pub(super) fn new(
        settings: &'a ResponseTrainSettings,
        network: ResponseNetwork,
        data: TrainingData<'a>,
        plan: Vec<Planned>,
        history: Vec<EpochRecord<ResponseEpoch>>,
    ) -> Result<Self, LearningError> {
        let optimizer = AdamW::new(AdamWConfig::default(), network.parameters())?;
        let n_before = history.len();
        Ok(Self { settings, network, data, plan, optimizer, history, n_before })
    }

    /// Goes on from the point at which a checkpoint was written.
    pub(super) fn resume(
        &mut self,
        saved: SavedTraining<ResponseEpoch>,
    ) -> Result<(), LearningError> {
        self.network.parameters().import(&saved.parameters)?;
        self.history = saved.history;
        // Every stage starts with an optimiser of its own.
        if let Some((planned, 1..)) = self.stage_under_way() {
            self.optimizer = AdamW::new(self.optimizer_config(planned), self.network.parameters())?;
            self.optimizer.import(&saved.optimizer)?;
        }
        Ok(())
    }

    /// The network as it is, and every epoch.
    pub(super) fn finish(self) -> (ResponseNetwork, Vec<EpochRecord<ResponseEpoch>>) {
        (self.network, self.history)
    }

    /// The stage of the next epoch, and how many of its epochs are over; `None` after the last.
    fn stage_under_way(&self) -> Option<(Planned, usize)> {
        let mut n_done = self.history.len().saturating_sub(self.n_before);
        for planned in &self.plan {
            if n_done < planned.n_epochs {
                return Some((*planned, n_done));
            }
            n_done -= planned.n_epochs;
        }
        None
    }

    fn optimizer_config(&self, planned: Planned) -> AdamWConfig {
        let ResponseConfig { pretraining, single_steps, rollouts, .. } = &self.settings.config;
        let (n, batch_size) = self.samples_and_batch_size(planned.stage);
        let total_steps = (n.div_ceil(batch_size) * planned.n_epochs) as u64;
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

    /// Number of instants or trajectories that a stage learns from, and of those in a batch.
    fn samples_and_batch_size(&self, stage: ResponseStage) -> (usize, usize) {
        let config = &self.settings.config;
        match stage {
            ResponseStage::Pretraining | ResponseStage::SingleSteps => {
                (self.data.instants.rows().len(), config.single_steps.batch_instants)
            }
            ResponseStage::Rollouts { .. } => {
                (self.data.rollouts.len(), config.rollouts.batch_windows)
            }
        }
    }

    /// Passes once over the instants or trajectories of a stage.
    fn pass(&mut self, stage: ResponseStage) -> Result<EpochReport, LearningError> {
        let started = Instant::now();
        let epoch = self.history.len() + 1;
        let physics_weight = self.physics_weight(stage);
        let mut rng =
            random_stream(self.settings.seed, "epochs of the response network", epoch as u64);
        let (n, batch_size) = self.samples_and_batch_size(stage);
        let mut order: Vec<usize> = (0..n).collect();
        order.shuffle(&mut rng);
        let (mut terms, mut gradient_norm, mut learning_rate) = (Vec::new(), 0.0_f64, 0.0);
        for batch in order.chunks(batch_size) {
            let loss = match stage {
                ResponseStage::Pretraining | ResponseStage::SingleSteps => {
                    self.single_step_loss(batch, stage, &mut rng)?
                }
                ResponseStage::Rollouts { length } => {
                    self.rollout_batch_loss(batch, length, &mut rng)?
                }
            };
            let (total, values) = loss.total(&self.settings.config.loss, physics_weight)?;
            if !values.total.is_finite() {
                return Err(LearningError::Diverged { loss: values.total, epoch });
            }
            let gradients = total.backward()?;
            let step = self.optimizer.step(self.network.parameters(), &gradients)?;
            gradient_norm = gradient_norm.max(step.gradient_norm);
            learning_rate = step.learning_rate;
            terms.push(values);
        }
        let loss = ResponseLossTerms::mean(&terms);
        let of_physics = self.settings.config.loss.physics * physics_weight * loss.physics;
        let balance = if of_physics > 0.0 { loss.data / (loss.data + of_physics) } else { 1.0 };
        let seconds = Some(started.elapsed().as_secs_f64());
        let detail = ResponseEpoch { stage, loss, physics_weight, balance };
        let record = EpochRecord { epoch, detail, learning_rate, gradient_norm, seconds };
        self.history.push(record);
        Ok(self.report_of(&record))
    }

    /// λ_physics of the next epoch.
    fn physics_weight(&self, stage: ResponseStage) -> f64 {
        let balance = self.history.last().map_or(1.0, |record| record.detail.balance);
        let in_training = self.history.len() + 1 - self.n_before;
        match stage {
            ResponseStage::Pretraining => 0.0,
            _ => self.settings.config.physics.weight(in_training, balance),
        }
    }

    fn report_of(&self, record: &EpochRecord<ResponseEpoch>) -> EpochReport {
        let n_planned: usize = self.plan.iter().map(|planned| planned.n_epochs).sum();
        EpochReport {
            summary: record.summary(),
            n_before: self.n_before,
            n_epochs: self.n_before + n_planned,
            best_epoch: None,
            training_idx: 0,
            n_trainings: 1,
            n_done_elsewhere: 0,
            rounds_left: None,
        }
    }

    /// The loss of rollouts in a window of each trajectory, which starts with the impact or anywhere.
    fn rollout_batch_loss(
        &self,
        batch: &[usize],
        length: usize,
        rng: &mut ChaCha8Rng,
    ) -> Result<ResponseLoss, LearningError> {
        let n_steps = |case_idx: usize| self.data.rollouts[case_idx].case.inputs.len();
        // No further than the shortest record of the batch.
        let shortest = batch.iter().map(|&case_idx| n_steps(case_idx)).min();
        let length = length.min(shortest.unwrap_or(length));
        let window = |&case_idx: &usize| {
            let last = n_steps(case_idx).saturating_sub(length);
            let is_first = rng.random_bool(IMPACT_SHARE);
            let start = if is_first { 0 } else { rng.random_range(0..=last) };
            RolloutWindow { case_idx, start }
        };
        let windows: Vec<RolloutWindow> = batch.iter().map(window).collect();
        let lengths = [length, self.settings.config.rollouts.truncation];
        Ok(rollout_loss(&self.network, &self.data.rollouts, &windows, lengths)?)
    }

    fn single_step_loss(
        &self,
        batch: &[usize],
        stage: ResponseStage,
        rng: &mut ChaCha8Rng,
    ) -> Result<ResponseLoss, LearningError> {
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
        let [data, likelihood] =
            single_step_terms(&output, &batch.targets, network.unit, change, network.min_std)?;
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
        let zero = Tensor::zeros((), DType::F64, output.residual.device())?;
        Ok(ResponseLoss {
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

impl EpochLoop for TrainingRun<'_> {
    type Error = LearningError;

    fn epoch(&mut self) -> Result<Option<EpochReport>, LearningError> {
        let Some((planned, n_done)) = self.stage_under_way() else { return Ok(None) };
        if n_done == 0 {
            self.optimizer = AdamW::new(self.optimizer_config(planned), self.network.parameters())?;
        }
        self.pass(planned.stage).map(Some)
    }

    /// A checkpoint is due at the end of each stage, and every few epochs in it.
    fn is_checkpoint_due(&self) -> bool {
        self.stage_under_way().is_none_or(|(_, n_done)| n_done.is_multiple_of(CHECKPOINT_EPOCHS))
    }

    fn put(&self, file: &mut Checkpoint) -> Result<(), NnError> {
        let saved = SavedTraining {
            parameters: self.network.parameters().export()?,
            optimizer: self.optimizer.export(),
            history: self.history.clone(),
        };
        saved.put(file)
    }
}
