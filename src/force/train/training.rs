//! Trains the force network: physics first, then the network around it.

use std::time::Instant;

use candle_core::DType;
use rand::seq::SliceRandom;

use crate::force::network::{ForceNetwork, OpenFeatures, Standardisation, features};
use crate::force::physics::{CentreCurve, CentreModel, ResidualModel};
use crate::force::train::batch::CaseTensors;
use crate::force::train::loss::{Loss, LossTerms};
use crate::force::train::{ForceModel, VarianceFactors};
use crate::force::{
    CentreFit, ForceCase, ForceConfig, ForceEpoch, ForceError, ForceRecord, ForceTraining,
};
use crate::learning::{
    CaseId, EpochLoop, EpochRecord, EpochReport, LearningError, SavedTraining, TrainSettings,
    TrainingFile, TrainingProgress, TrainingReport, TrainingSet, run_epochs, split,
};
use crate::nn::{
    AdamW, AdamWConfig, Checkpoint, ModelKind, NamedTensors, NnError, Schedule, random_stream,
};
use crate::uncertainty::{CurveComponent, CurveMixture};

/// Checkpoints of a training.
const CHECKPOINT_KIND: ModelKind = ModelKind { name: "training of a force network", version: 1 };
/// Fewest cases to learn from: below, a fold of the crush model has no case of each kind.
const LEAST_CASES: usize = 8;
/// Contact points that stand for their distribution where a scenario leaves it open.
const N_OPEN_CONTACTS: usize = 8;
/// Fewest validation cases on which the spread is calibrated.
const LEAST_CALIBRATION_CASES: usize = 30;

/// Cases to train a force network on.
pub type ForceTrainingSet = TrainingSet<ForceCase>;

/// How to train a force network.
pub type ForceTrainSettings = TrainSettings<ForceConfig>;

/// Trains a model on the cases to learn from.
///
/// A training that was killed goes on from its checkpoint to the same weights as if it had not been.
///
/// # Errors
/// [`ForceError`].
pub fn train(
    set: &ForceTrainingSet,
    settings: &ForceTrainSettings,
    report: &mut TrainingProgress<'_>,
) -> Result<ForceModel, ForceError> {
    settings.config.check()?;
    set.check_size(LEAST_CASES)?;
    let mut file = training_file(set, settings);
    let training = match file.read(SavedForceTraining::take)? {
        Some(saved) => ForceTrainingRun::resumed(set, settings, saved)?,
        None => {
            let mut is_cut = false;
            let mut told = |fit: &TrainingReport| {
                let flow = report(fit);
                is_cut |= flow.is_break();
                flow
            };
            let physics = fit_physics(set, settings, &mut told)?;
            if is_cut {
                // Nothing that a later training should go on from.
                file.disable();
            }
            ForceTrainingRun::around(set, settings, physics)?
        }
    };
    search(training, set, &file, report)
}

/// [`train`] around a physics that was fitted before, by [`fit_physics`] on the same set.
///
/// # Errors
/// [`ForceError`].
pub fn train_around(
    physics: (CentreModel, Vec<CentreCurve>),
    set: &ForceTrainingSet,
    settings: &ForceTrainSettings,
    report: &mut TrainingProgress<'_>,
) -> Result<ForceModel, ForceError> {
    settings.config.check()?;
    let training = ForceTrainingRun::around(set, settings, physics)?;
    search(training, set, &training_file(set, settings), report)
}

/// Fits the physics in the centre: the model, and for each training case the curve of a part of it
/// that has not seen the case.
///
/// # Errors
/// [`ForceError`].
pub fn fit_physics(
    set: &ForceTrainingSet,
    settings: &ForceTrainSettings,
    report: &mut TrainingProgress<'_>,
) -> Result<(CentreModel, Vec<CentreCurve>), ForceError> {
    let (kind, crush) = (settings.config.network.centre, settings.config.crush);
    let mut told = |fit: CentreFit| {
        let (done, n_fits) = fit.progress();
        report(&TrainingReport::Fit { what: fit.to_string(), done, n_fits })
    };
    CentreModel::fit(&set.train, (kind, crush), settings.seed, &mut told)
}

fn search(
    mut training: ForceTrainingRun<'_>,
    set: &ForceTrainingSet,
    file: &TrainingFile<ForceConfig>,
    report: &mut TrainingProgress<'_>,
) -> Result<ForceModel, ForceError> {
    run_epochs(&mut training, file, report)?;
    training.finish(set)
}

/// The checkpoint of a training. More epochs or more patience do not change the epochs that were.
fn training_file(
    set: &ForceTrainingSet,
    settings: &ForceTrainSettings,
) -> TrainingFile<ForceConfig> {
    let mut config = settings.config.clone();
    config.training.epochs = 0;
    config.training.patience = 0;
    config.training.checkpoint_epochs = 0;
    TrainingFile::new(CHECKPOINT_KIND, settings, config, set.digest())
}

/// What a checkpoint holds.
struct SavedForceTraining {
    common: SavedTraining<ForceEpoch>,
    centre: CentreModel,
    centres: Vec<CentreCurve>,
    best_parameters: NamedTensors,
    best_epoch: usize,
}

impl SavedForceTraining {
    fn take(file: &mut Checkpoint) -> Result<Self, NnError> {
        Ok(Self {
            common: SavedTraining::take(file)?,
            centre: file.get("centre")?,
            centres: file.get("centres")?,
            best_parameters: file.take_group("best"),
            best_epoch: file.get("best_epoch")?,
        })
    }
}

struct ForceTrainingRun<'a> {
    settings: &'a ForceTrainSettings,
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
    history: Vec<EpochRecord<ForceEpoch>>,
}

impl<'a> ForceTrainingRun<'a> {
    fn around(
        set: &ForceTrainingSet,
        settings: &'a ForceTrainSettings,
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
        set: &ForceTrainingSet,
        settings: &'a ForceTrainSettings,
        saved: SavedForceTraining,
    ) -> Result<Self, ForceError> {
        let mut training = Self::around(set, settings, (saved.centre, saved.centres))?;
        training.network.parameters().import(&saved.common.parameters)?;
        training.optimizer.import(&saved.common.optimizer)?;
        training.best_parameters = saved.best_parameters;
        training.best_epoch = saved.best_epoch;
        training.history = saved.common.history;
        Ok(training)
    }

    fn is_over(&self) -> bool {
        let limits = self.settings.config.training;
        let done = self.history.len();
        let is_stuck = !self.validation.is_empty() && done >= self.best_epoch + limits.patience;
        done >= limits.epochs || is_stuck
    }

    /// One pass over the cases.
    fn pass(&mut self) -> Result<EpochRecord<ForceEpoch>, ForceError> {
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
                return Err(LearningError::Diverged { loss: values.total, epoch }.into());
            }
            let gradients = loss.total.backward()?;
            let step = self.optimizer.step(self.network.parameters(), &gradients)?;
            gradient_norm = gradient_norm.max(step.gradient_norm);
            learning_rate = step.learning_rate;
            batches.push((batch.len(), values));
        }
        let train = LossTerms::mean(&batches);
        let validation = self.validate()?;
        let seconds = started.elapsed().as_secs_f64();
        let detail = ForceEpoch { train, validation };
        Ok(EpochRecord { epoch, detail, learning_rate, gradient_norm, seconds })
    }

    /// Keeps an epoch, and its weights if they are the best so far.
    fn keep(&mut self, record: EpochRecord<ForceEpoch>) -> Result<(), ForceError> {
        let score = |record: &EpochRecord<ForceEpoch>| match self.validation.is_empty() {
            true => record.detail.train.total,
            false => record.detail.validation.total,
        };
        let best = self.best_epoch.checked_sub(1).and_then(|idx| self.history.get(idx));
        if best.is_none_or(|best| score(&record) < score(best)) {
            self.best_epoch = record.epoch;
            self.best_parameters = self.network.parameters().export()?;
        }
        self.history.push(record);
        Ok(())
    }

    fn validate(&self) -> Result<LossTerms, ForceError> {
        if self.validation.is_empty() {
            return Ok(LossTerms::default());
        }
        let (input, targets) = self.tensors.select(&self.validation)?;
        let output = self.network.forward_frozen(&input)?;
        Loss::of(&output, &targets, &self.settings.config.loss)?.values()
    }

    fn finish(self, set: &ForceTrainingSet) -> Result<ForceModel, ForceError> {
        self.network.parameters().import(&self.best_parameters)?;
        let variance_factors = self.variance_factors(set)?;
        let ids = |indices: &[usize]| -> Vec<CaseId> {
            indices.iter().filter_map(|&idx| set.train.get(idx)).map(CaseId::of).collect()
        };
        let detail = ForceTraining {
            validation: ids(&self.validation),
            best_epoch: self.best_epoch,
            variance_factors,
        };
        let record = ForceRecord {
            train: ids(&self.learned),
            ..ForceRecord::of(set, self.settings, detail, self.history)
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
    fn variance_factors(&self, set: &ForceTrainingSet) -> Result<VarianceFactors, ForceError> {
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

impl EpochLoop for ForceTrainingRun<'_> {
    type Error = ForceError;

    fn epoch(&mut self) -> Result<Option<EpochReport>, ForceError> {
        if self.is_over() {
            return Ok(None);
        }
        let record = self.pass()?;
        self.keep(record)?;
        Ok(Some(EpochReport {
            summary: record.summary(),
            n_before: 0,
            n_epochs: self.settings.config.training.epochs,
            best_epoch: Some(self.best_epoch),
            training_idx: 0,
            n_trainings: 1,
        }))
    }

    fn is_checkpoint_due(&self) -> bool {
        let every = self.settings.config.training.checkpoint_epochs;
        self.history.len().is_multiple_of(every) || self.is_over()
    }

    fn put(&self, file: &mut Checkpoint) -> Result<(), NnError> {
        file.put("centre", &self.centre)?;
        file.put("centres", &self.centres)?;
        file.put("best_epoch", &self.best_epoch)?;
        file.put_group("best", self.best_parameters.clone());
        let common = SavedTraining {
            parameters: self.network.parameters().export()?,
            optimizer: self.optimizer.export(),
            history: self.history.clone(),
        };
        common.put(file)
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
