//! Trains the force network: physics first, then the network around it.

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::Instant;

use candle_core::DType;
use rand::seq::SliceRandom;

use crate::data::split;
use crate::force::network::{ForceNetwork, OpenFeatures, Standardisation, features};
use crate::force::physics::{CentreCurve, CentreModel, ResidualModel};
use crate::force::train::batch::CaseTensors;
use crate::force::train::loss::{Loss, LossTerms};
use crate::force::train::training_file::TrainingFile;
use crate::force::train::{ForceModel, VarianceFactors};
use crate::force::{
    CaseId, CentreFit, EpochRecord, ForceCase, ForceConfig, ForceError, TrainingRecord, TrainingSet,
};
use crate::nn::{AdamW, AdamWConfig, NamedTensors, Schedule, random_stream};
use crate::uncertainty::{CurveComponent, CurveMixture};

/// Contact points that stand for their distribution where a scenario leaves it open.
const N_OPEN_CONTACTS: usize = 8;
/// Fewest validation cases on which the spread is calibrated.
const LEAST_CALIBRATION_CASES: usize = 30;

/// What to train and how.
#[derive(Debug, Clone, PartialEq)]
pub struct TrainSettings {
    /// Sizes, weights and rates.
    pub config: ForceConfig,
    /// All draws come from it.
    pub seed: u64,
    /// Where the training is saved every few epochs.
    pub checkpoint: Option<PathBuf>,
    /// Whether to go on from that file, if it is there.
    pub resume: bool,
}

/// How far a training has come.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TrainingReport<'a> {
    /// The physics in the centre is being fitted.
    Centre(CentreFit),
    /// An epoch is over.
    Epoch {
        /// Its losses.
        record: &'a EpochRecord,
        /// Epochs at most.
        n_epochs: usize,
        /// Whether its weights are the best so far.
        is_best: bool,
    },
}

/// The callback of a training: breaking ends it, and the best weights so far are kept.
pub type TrainingProgress<'a> = dyn FnMut(TrainingReport<'_>) -> ControlFlow<()> + 'a;

/// Trains a model on the cases to learn from.
///
/// A training that was killed goes on from its checkpoint to the same weights as if it had not been.
///
/// # Errors
/// [`ForceError`].
pub fn train(
    set: &TrainingSet,
    settings: &TrainSettings,
    report: &mut TrainingProgress<'_>,
) -> Result<ForceModel, ForceError> {
    settings.config.check()?;
    let mut file = TrainingFile::new(set, settings);
    let training = match file.read()? {
        Some(saved) => Training::resumed(set, settings, saved)?,
        None => {
            let mut is_cut = false;
            let mut told = |fit: TrainingReport<'_>| {
                let flow = report(fit);
                is_cut |= flow.is_break();
                flow
            };
            let physics = fit_physics(set, settings, &mut told)?;
            if is_cut {
                // Nothing that a later training should go on from.
                file.forget();
            }
            Training::around(set, settings, physics)?
        }
    };
    search(training, set, (settings, &file), report)
}

/// [`train`] around a physics that was fitted before, by [`fit_physics`] on the same set.
///
/// # Errors
/// [`ForceError`].
pub fn train_around(
    physics: (CentreModel, Vec<CentreCurve>),
    set: &TrainingSet,
    settings: &TrainSettings,
    report: &mut TrainingProgress<'_>,
) -> Result<ForceModel, ForceError> {
    settings.config.check()?;
    let training = Training::around(set, settings, physics)?;
    search(training, set, (settings, &TrainingFile::new(set, settings)), report)
}

/// Fits the physics in the centre: the model, and for each training case the curve of a part of it
/// that has not seen the case.
///
/// # Errors
/// [`ForceError`].
pub fn fit_physics(
    set: &TrainingSet,
    settings: &TrainSettings,
    report: &mut TrainingProgress<'_>,
) -> Result<(CentreModel, Vec<CentreCurve>), ForceError> {
    let (kind, crush) = (settings.config.network.centre, settings.config.crush);
    let mut told = |fit| report(TrainingReport::Centre(fit));
    CentreModel::fit(&set.train, (kind, crush), settings.seed, &mut told)
}

fn search(
    mut training: Training<'_>,
    set: &TrainingSet,
    (settings, file): (&TrainSettings, &TrainingFile),
    report: &mut TrainingProgress<'_>,
) -> Result<ForceModel, ForceError> {
    let every = settings.config.training.checkpoint_epochs;
    while !training.is_over() {
        let is_best = training.epoch()?;
        let Some(record) = training.history.last() else { break };
        let n_epochs = settings.config.training.epochs;
        let told = report(TrainingReport::Epoch { record, n_epochs, is_best });
        if told.is_break() || record.epoch.is_multiple_of(every) || training.is_over() {
            file.write(&training.saved()?)?;
        }
        if told.is_break() {
            break;
        }
    }
    training.finish(set)
}

/// What a checkpoint holds.
pub(crate) struct SavedTraining {
    pub centre: CentreModel,
    pub centres: Vec<CentreCurve>,
    pub parameters: NamedTensors,
    pub best_parameters: NamedTensors,
    pub moments: NamedTensors,
    pub step: u64,
    pub best_epoch: usize,
    pub history: Vec<EpochRecord>,
}

struct Training<'a> {
    settings: &'a TrainSettings,
    centre: CentreModel,
    centres: Vec<CentreCurve>,
    residuals: ResidualModel,
    standardisation: Standardisation,
    tensors: CaseTensors,
    network: ForceNetwork,
    optimizer: AdamW,
    /// Indices into the training cases.
    learned: Vec<usize>,
    validation: Vec<usize>,
    best_parameters: NamedTensors,
    best_epoch: usize,
    history: Vec<EpochRecord>,
}

impl<'a> Training<'a> {
    fn around(
        set: &TrainingSet,
        settings: &'a TrainSettings,
        (centre, centres): (CentreModel, Vec<CentreCurve>),
    ) -> Result<Self, ForceError> {
        let config = &settings.config;
        let bodies = centre.bodies();
        let parts = split(&set.train, settings.seed, config.training.validation_share);
        let rows: Vec<Vec<f64>> = set
            .train
            .iter()
            .zip(&centres)
            .map(|(case, centre)| case_features(case, centre, &bodies))
            .collect();
        let seen: Vec<Vec<f64>> = parts.train.iter().map(|&idx| rows[idx].clone()).collect();
        let standardisation = Standardisation::of(&seen);
        let rows = rows.iter().map(|row| standardisation.apply(row)).collect();
        let cases: Vec<&ForceCase> = set.train.iter().collect();
        let residuals = ResidualModel::fit(&set.train, &centres, config.network.factors);
        let number_type = (&config.network, DType::F32);
        let tensors = CaseTensors::new(&cases, (&centres, &residuals), rows, number_type)?;
        let mut rng = random_stream(settings.seed, "force network", 0);
        let network = ForceNetwork::new(&config.network, bodies.len(), &mut rng, DType::F32)?;
        let optimizer = AdamW::new(optimizer_config(config), network.parameters())?;
        let best_parameters = network.parameters().export()?;
        Ok(Self {
            settings,
            centre,
            centres,
            residuals,
            standardisation,
            tensors,
            network,
            optimizer,
            learned: parts.train,
            validation: parts.test,
            best_parameters,
            best_epoch: 0,
            history: Vec::new(),
        })
    }

    fn resumed(
        set: &TrainingSet,
        settings: &'a TrainSettings,
        saved: SavedTraining,
    ) -> Result<Self, ForceError> {
        let mut training = Self::around(set, settings, (saved.centre, saved.centres))?;
        training.network.parameters().import(&saved.parameters)?;
        let state = crate::nn::OptimizerState { step: saved.step, moments: saved.moments };
        training.optimizer.import(&state)?;
        training.best_parameters = saved.best_parameters;
        training.best_epoch = saved.best_epoch;
        training.history = saved.history;
        Ok(training)
    }

    fn saved(&self) -> Result<SavedTraining, ForceError> {
        let state = self.optimizer.export()?;
        Ok(SavedTraining {
            centre: self.centre.clone(),
            centres: self.centres.clone(),
            parameters: self.network.parameters().export()?,
            best_parameters: self.best_parameters.clone(),
            moments: state.moments,
            step: state.step,
            best_epoch: self.best_epoch,
            history: self.history.clone(),
        })
    }

    fn is_over(&self) -> bool {
        let limits = self.settings.config.training;
        let done = self.history.len();
        let is_stuck = !self.validation.is_empty() && done >= self.best_epoch + limits.patience;
        done >= limits.epochs || is_stuck
    }

    /// One pass over the cases; whether it gave the best weights so far.
    fn epoch(&mut self) -> Result<bool, ForceError> {
        let started = Instant::now();
        let config = &self.settings.config;
        let epoch = self.history.len() + 1;
        let mut order = self.learned.clone();
        order.shuffle(&mut random_stream(self.settings.seed, "order of cases", epoch as u64));
        let (mut batches, mut gradient_norm, mut learning_rate) = (Vec::new(), 0.0_f64, 0.0);
        for batch in order.chunks(config.training.batch_cases) {
            let (input, targets) = self.tensors.select(batch)?;
            let output = self.network.forward(&input)?;
            let loss = Loss::of(&output, &targets, &config.loss)?;
            let values = loss.values()?;
            if !values.total.is_finite() {
                return Err(ForceError::Diverged { loss: values.total, epoch });
            }
            let gradients = loss.total.backward()?;
            let step = self.optimizer.step(self.network.parameters(), &gradients)?;
            gradient_norm = gradient_norm.max(step.gradient_norm);
            learning_rate = step.learning_rate;
            batches.push((batch.len(), values));
        }
        let train = LossTerms::mean(&batches);
        let validation = self.validate()?;
        let score = |record: &EpochRecord| match self.validation.is_empty() {
            true => record.train.total,
            false => record.validation.total,
        };
        let seconds = started.elapsed().as_secs_f64();
        let record =
            EpochRecord { epoch, train, validation, learning_rate, gradient_norm, seconds };
        let best = self.best_epoch.checked_sub(1).and_then(|idx| self.history.get(idx));
        let is_best = best.is_none_or(|best| score(&record) < score(best));
        self.history.push(record);
        if is_best {
            self.best_epoch = epoch;
            self.best_parameters = self.network.parameters().export()?;
        }
        Ok(is_best)
    }

    fn validate(&self) -> Result<LossTerms, ForceError> {
        if self.validation.is_empty() {
            return Ok(LossTerms::default());
        }
        let (input, targets) = self.tensors.select(&self.validation)?;
        let output = self.network.forward_frozen(&input)?;
        Loss::of(&output, &targets, &self.settings.config.loss)?.values()
    }

    fn finish(self, set: &TrainingSet) -> Result<ForceModel, ForceError> {
        self.network.parameters().import(&self.best_parameters)?;
        let variance_factors = self.variance_factors(set)?;
        let ids = |indices: &[usize]| {
            indices.iter().filter_map(|&idx| set.train.get(idx)).map(CaseId::of).collect()
        };
        let record = TrainingRecord {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            data: set.name.clone(),
            data_digest: set.digest(),
            seed: self.settings.seed,
            train: ids(&self.learned),
            validation: ids(&self.validation),
            test: set.test.clone(),
            best_epoch: self.best_epoch,
            variance_factors,
            history: self.history,
        };
        let open = OpenFeatures::of(&set.train, &self.centre.bodies(), N_OPEN_CONTACTS);
        Ok(ForceModel {
            config: self.settings.config.clone(),
            centre: self.centre,
            residuals: self.residuals,
            standardisation: self.standardisation,
            open,
            network: self.network,
            record,
            cases: set.train.clone(),
        })
    }

    /// Calibrated on the validation cases, which the network has not been fitted to, if there are
    /// enough of them, else on all: of the training cases the physics at least has not seen the one
    /// through whose curve it is judged. Test cases are not touched.
    fn variance_factors(&self, set: &TrainingSet) -> Result<VarianceFactors, ForceError> {
        let all: Vec<usize> = (0..self.centres.len()).collect();
        let is_enough = self.validation.len() >= LEAST_CALIBRATION_CASES;
        let chosen = if is_enough { &self.validation } else { &all };
        let (input, _) = self.tensors.select(chosen)?;
        let centres: Vec<CentreCurve> =
            chosen.iter().filter_map(|&idx| self.centres.get(idx).cloned()).collect();
        let components = self.network.forward_frozen(&input)?.components(&centres)?;
        let pair = |(idx, components): (&usize, Vec<CurveComponent>)| {
            Ok((&set.train[*idx], CurveMixture::new(components)?))
        };
        let cases: Vec<(&ForceCase, CurveMixture)> =
            chosen.iter().zip(components).map(pair).collect::<Result<_, ForceError>>()?;
        Ok(VarianceFactors::calibrated(&cases, self.settings.seed))
    }
}

/// Features of a training case, whose contact and body are known.
fn case_features(case: &ForceCase, centre: &CentreCurve, bodies: &[String]) -> Vec<f64> {
    let name = case.scenario.bullet_body.as_deref().unwrap_or_default();
    let body_idx = bodies.iter().position(|body| body == name).unwrap_or(0);
    let contact = case.scenario.contact_m.unwrap_or_default();
    features(&case.scenario, centre, (contact, body_idx, bodies.len()))
}

fn optimizer_config(config: &ForceConfig) -> AdamWConfig {
    let training = config.training;
    AdamWConfig {
        learning_rate: training.learning_rate,
        weight_decay: training.weight_decay,
        max_gradient_norm: Some(training.max_gradient_norm),
        schedule: Schedule::Constant,
        ..AdamWConfig::default()
    }
}
