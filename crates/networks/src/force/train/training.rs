//! Training of the force network: the physics is fitted first, then the network around it.

use std::time::Instant;

use candle_core::DType;
use rand::seq::SliceRandom;

use crate::force::network::{ForceDomain, ForceNetwork, OpenFeatures, Standardisation, features};
use crate::force::physics::{Bodies, CentreCurve, CentreModel, ResidualModel};
use crate::force::train::batch::CaseTensors;
use crate::force::train::loss::{Loss, LossTerms};
use crate::force::train::{CalibrationCase, ForceModel, VarianceCalibration};
use crate::force::{ForceCase, ForceConfig, ForceEpoch, ForceError, ForceRecord, ForceTraining};
use crate::learning::{
    CaseId, EpochLoop, EpochRecord, EpochReport, LearningError, SavedTraining, TrainSettings,
    TrainingFile, TrainingProgress, TrainingReport, TrainingSet, run_epochs, split,
};
use crate::nn::{
    AdamW, AdamWConfig, Checkpoint, Expected, ModelKind, NamedTensors, NnError, Parameters,
    Schedule, check_length, check_number,
};
use impactlab_core::numerics::random_stream;
use impactlab_core::uncertainty::{CurveComponent, CurveMixture};

/// Kind and version of the checkpoints of a training.
pub const FORCE_CHECKPOINT: ModelKind =
    ModelKind { name: "training of a force network", version: 1 };
/// Smallest number of training cases. With fewer, a fold of the crush model would not have cases of
/// each kind.
const LEAST_CASES: usize = 8;
/// Number of contact points that represent the distribution of contact points where a scenario
/// leaves it open.
const N_OPEN_CONTACTS: usize = 8;
/// Smallest number of validation cases on which the variances are calibrated.
const LEAST_CALIBRATION_CASES: usize = 30;

/// The cases for training and testing a force network.
pub type ForceTrainingSet = TrainingSet<ForceCase>;

/// The settings of the training of a force network.
pub type ForceTrainSettings = TrainSettings<ForceConfig>;

/// Trains a model on the training cases of a set: fits the physics, trains the network around it,
/// and calibrates the variances.
///
/// A training that was interrupted is resumed from its checkpoint and leads to the same weights as
/// one without interruption.
///
/// - `report`: called during the fits and after each epoch; if it breaks, the training ends after
///   the current epoch with the best parameters so far.
///
/// # Errors
/// [`ForceError::Learning`] for a setting out of range, too few cases, a loss that is not finite,
/// or a checkpoint that cannot be read or written; [`ForceError::Mixture`] if the predicted
/// mixtures are invalid; other variants of [`ForceError`] as for [`fit_physics`].
pub fn train(
    set: &ForceTrainingSet,
    settings: &ForceTrainSettings,
    report: &mut TrainingProgress<'_>,
) -> Result<ForceModel, ForceError> {
    settings.config.check()?;
    settings.config.check_memory(set.train.len())?;
    set.check_size(LEAST_CASES)?;
    let mut file = training_file(set, settings);
    let resumed = file.read(|checkpoint| {
        let saved = SavedForceTraining::take(checkpoint)?;
        ForceTrainingRun::resumed(set, settings, saved)
    })?;
    let was_resumed = resumed.is_some();
    let training = match resumed {
        Some(training) => training,
        None => {
            let mut is_cut = false;
            let mut on_fit = |fit: &TrainingReport| {
                let flow = report(fit);
                is_cut |= flow.is_break();
                flow
            };
            let (centre, centres) = fit_physics(set, settings, &mut on_fit)?;
            if is_cut {
                // A later training must not be resumed from physics whose fit was interrupted.
                file.disable();
            }
            ForceTrainingRun::around(set, settings, centre, centres)?
        }
    };
    file.named(was_resumed, search(training, set, &file, report))
}

/// Trains a model as [`train`] does, around physics that [`fit_physics`] has fitted to the same
/// set. A checkpoint is written but not read.
///
/// - `physics`: result of [`fit_physics`] for `set` and `settings`.
/// - `report`: called after each epoch; if it breaks, the training ends after the current epoch
///   with the best parameters so far.
///
/// # Errors
/// [`ForceError`] as for [`train`].
pub fn train_around(
    physics: (CentreModel, Vec<CentreCurve>),
    set: &ForceTrainingSet,
    settings: &ForceTrainSettings,
    report: &mut TrainingProgress<'_>,
) -> Result<ForceModel, ForceError> {
    settings.config.check()?;
    settings.config.check_memory(set.train.len())?;
    let (centre, centres) = physics;
    let training = ForceTrainingRun::around(set, settings, centre, centres)?;
    search(training, set, &training_file(set, settings), report)
}

/// Fits the physics on which the network is based.
///
/// - `report`: called during the fits; if it breaks, the fits end where they are.
/// - returns the model of the physics and, for each training case, the curve of those parts of the
///   model that were fitted without the case.
///
/// # Errors
/// [`ForceError::Learning`] for too few cases, [`ForceError::NoCrushFit`],
/// [`ForceError::Regression`], [`ForceError::Impact`].
pub fn fit_physics(
    set: &ForceTrainingSet,
    settings: &ForceTrainSettings,
    report: &mut TrainingProgress<'_>,
) -> Result<(CentreModel, Vec<CentreCurve>), ForceError> {
    let (kind, crush) = (settings.config.network.centre, settings.config.crush);
    CentreModel::fit(&set.train, kind, crush, settings.seed, report)
}

/// Runs the epochs that are left and builds the model.
fn search(
    mut training: ForceTrainingRun<'_>,
    set: &ForceTrainingSet,
    file: &TrainingFile<ForceConfig>,
    report: &mut TrainingProgress<'_>,
) -> Result<ForceModel, ForceError> {
    run_epochs(&mut training, file, report)?;
    training.finish(set)
}

/// The checkpoint file of a training. The numbers of epochs, of epochs without improvement and of
/// epochs between checkpoints are not part of its identity, because they do not change earlier
/// epochs.
fn training_file(
    set: &ForceTrainingSet,
    settings: &ForceTrainSettings,
) -> TrainingFile<ForceConfig> {
    let mut config = settings.config.clone();
    config.training.epochs = 0;
    config.training.patience = 0;
    config.training.checkpoint_epochs = 0;
    TrainingFile::new(FORCE_CHECKPOINT, settings, config, set.digest())
}

/// The content of a checkpoint.
struct SavedForceTraining {
    /// What the checkpoints of both networks contain.
    common: SavedTraining<ForceEpoch>,
    centre: CentreModel,
    centres: Vec<CentreCurve>,
    /// Parameters of the network after the best epoch.
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

    /// Checks what the training divides by or counts with.
    ///
    /// # Errors
    /// [`NnError`] with the first number or list that is refused.
    fn check(&self, n_cases: usize) -> Result<(), NnError> {
        self.centre.check()?;
        check_length("centres", self.centres.len(), n_cases)?;
        for (i, centre) in self.centres.iter().enumerate() {
            centre.check(&format!("centres[{i}]"))?;
        }
        let n_epochs = self.common.history.len();
        check_number("best_epoch", self.best_epoch as f64, Expected::Magnitude(n_epochs as f64))
    }
}

/// A training of the force network between two epochs.
struct ForceTrainingRun<'a> {
    settings: &'a ForceTrainSettings,
    /// The physics around which the network is trained.
    centre: CentreModel,
    /// The curve of the physics for each training case.
    centres: Vec<CentreCurve>,
    residuals: ResidualModel,
    standardisation: Standardisation,
    tensors: CaseTensors,
    network: ForceNetwork,
    optimizer: AdamW,
    /// Indices of the training cases that the network is fitted to.
    learned: Vec<usize>,
    /// Indices of the training cases for validation.
    validation: Vec<usize>,
    /// Parameters of the network after the best epoch.
    best_parameters: NamedTensors,
    /// The best epoch, counted from 1; 0 before the first epoch.
    best_epoch: usize,
    history: Vec<EpochRecord<ForceEpoch>>,
}

impl<'a> ForceTrainingRun<'a> {
    /// Prepares a training around the fitted physics, with the parameters of the network at their
    /// initial values.
    fn around(
        set: &ForceTrainingSet,
        settings: &'a ForceTrainSettings,
        centre: CentreModel,
        centres: Vec<CentreCurve>,
    ) -> Result<Self, ForceError> {
        let config = &settings.config;
        let (bodies, struck_bodies) = (centre.bodies(), centre.struck_bodies());
        let parts = split(&set.train, settings.seed, config.training.validation_share);
        let rows: Vec<Vec<f64>> = set
            .train
            .iter()
            .zip(&centres)
            .map(|(case, centre)| case_features(case, centre, [&bodies, &struck_bodies]))
            .collect();
        let seen: Vec<Vec<f64>> = parts.train.iter().map(|&idx| rows[idx].clone()).collect();
        let standardisation = Standardisation::from_rows(&seen);
        let rows = rows.iter().map(|row| standardisation.apply(row)).collect();
        let n_more = bodies.len() + struck_bodies.len() + standardisation.n_turning();
        let cases: Vec<&ForceCase> = set.train.iter().collect();
        let residuals = ResidualModel::fit(&set.train, &centres, config.network.factors);
        let tensors =
            CaseTensors::new(&cases, &centres, &residuals, rows, &config.network, DType::F32)?;
        let mut rng = random_stream(settings.seed, "force network", 0);
        let network = {
            let parameters = Parameters::new(DType::F32);
            ForceNetwork::new(&config.network, n_more, &mut rng, parameters)?
        };
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

    /// Prepares a training in the state of a checkpoint.
    fn resumed(
        set: &ForceTrainingSet,
        settings: &'a ForceTrainSettings,
        saved: SavedForceTraining,
    ) -> Result<Self, ForceError> {
        saved.check(set.train.len())?;
        let mut training = Self::around(set, settings, saved.centre, saved.centres)?;
        // Parameters that are finite may still predict what is not.
        for parameters in [&saved.best_parameters, &saved.common.parameters] {
            training.network.parameters().import(parameters)?;
            training.mixtures(set, &training.all())?;
        }
        training.optimizer.import(&saved.common.optimizer)?;
        training.best_parameters = saved.best_parameters;
        training.best_epoch = saved.best_epoch;
        training.history = saved.common.history;
        Ok(training)
    }

    /// Whether all epochs are done, or the validation loss has not improved for as many epochs as
    /// the settings permit.
    fn is_over(&self) -> bool {
        let limits = self.settings.config.training;
        let done = self.history.len();
        let is_stuck = !self.validation.is_empty() && done >= self.best_epoch + limits.patience;
        done >= limits.epochs || is_stuck
    }

    /// Trains the network for one epoch, on the cases that it is fitted to, in random order and in
    /// batches.
    ///
    /// # Errors
    /// [`LearningError::Diverged`] if the loss is not finite.
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
            let loss = Loss::new(&output, &targets, &config.loss)?;
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
        let seconds = Some(started.elapsed().as_secs_f64());
        let detail = ForceEpoch { train, validation };
        Ok(EpochRecord { epoch, detail, learning_rate, gradient_norm, seconds })
    }

    /// Adds an epoch to the history and keeps its parameters if its loss is the smallest so far.
    /// The loss is that of the validation cases, or of the training cases if there is no validation
    /// case.
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

    /// Losses over the validation cases; all are zero without validation cases.
    fn validate(&self) -> Result<LossTerms, ForceError> {
        if self.validation.is_empty() {
            return Ok(LossTerms::default());
        }
        let (input, targets) = self.tensors.select(&self.validation)?;
        let output = self.network.forward_frozen(&input)?;
        Loss::new(&output, &targets, &self.settings.config.loss)?.values()
    }

    /// Builds the model with the parameters of the best epoch and calibrates its variances.
    fn finish(self, set: &ForceTrainingSet) -> Result<ForceModel, ForceError> {
        self.network.parameters().import(&self.best_parameters)?;
        let domain = ForceDomain::from_cases(&self.standardisation, &set.train);
        let variance_factors = self.variance_factors(set, &domain)?;
        let ids = |indices: &[usize]| -> Vec<CaseId> {
            indices.iter().filter_map(|&idx| set.train.get(idx)).map(CaseId::from_case).collect()
        };
        let detail = ForceTraining {
            validation: ids(&self.validation),
            best_epoch: self.best_epoch,
            variance_factors,
        };
        let record = ForceRecord {
            train: ids(&self.learned),
            ..ForceRecord::new(set, self.settings, detail, self.history)
        };
        let bodies = [&*self.centre.bodies(), &*self.centre.struck_bodies()];
        let open = OpenFeatures::from_cases(&set.train, bodies, N_OPEN_CONTACTS);
        Ok(ForceModel {
            config: self.settings.config.clone(),
            centre: self.centre,
            residuals: self.residuals,
            domain,
            standardisation: self.standardisation,
            open,
            network: self.network,
            record,
            cases: set.train.clone(),
        })
    }

    /// Calibrates the variances on the validation cases, to which the network was not fitted, if
    /// there are enough of them, and otherwise on all training cases. The curve of the physics for
    /// each of them comes from parts that were fitted without the case. Test cases are not used.
    fn variance_factors(
        &self,
        set: &ForceTrainingSet,
        domain: &ForceDomain,
    ) -> Result<VarianceCalibration, ForceError> {
        let is_enough = self.validation.len() >= LEAST_CALIBRATION_CASES;
        let chosen = if is_enough { self.validation.clone() } else { self.all() };
        let mixtures = self.mixtures(set, &chosen)?.into_iter();
        let cases = mixtures.map(|(case, mixture)| CalibrationCase {
            case,
            mixture,
            distance: domain.distance_of_case(case),
        });
        Ok(VarianceCalibration::of_cases(cases.collect(), self.settings.seed))
    }

    /// Indices of all training cases.
    fn all(&self) -> Vec<usize> {
        (0..self.centres.len()).collect()
    }

    /// Training cases with their predictions by the present parameters.
    ///
    /// # Errors
    /// [`ForceError::Mixture`] if a prediction is no distribution.
    fn mixtures<'s>(
        &self,
        set: &'s ForceTrainingSet,
        chosen: &[usize],
    ) -> Result<Vec<(&'s ForceCase, CurveMixture)>, ForceError> {
        let (input, _) = self.tensors.select(chosen)?;
        let centres: Vec<CentreCurve> =
            chosen.iter().filter_map(|&idx| self.centres.get(idx).cloned()).collect();
        let components = self.network.forward_frozen(&input)?.components(&centres)?;
        let pair = |(idx, components): (&usize, Vec<CurveComponent>)| {
            Ok((&set.train[*idx], CurveMixture::new(components)?))
        };
        chosen.iter().zip(components).map(pair).collect()
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
            n_done_elsewhere: 0,
            rounds_left: None,
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

/// Features of a training case, whose contact point and bodies are known.
///
/// - `kinds`: those of the bodies of the striking and of the struck vehicle.
fn case_features(case: &ForceCase, centre: &CentreCurve, kinds: [&[String]; 2]) -> Vec<f64> {
    let scenario = &case.scenario;
    let idx = |kinds: &[String], name: &Option<String>| {
        kinds.iter().position(|kind| kind == name.as_deref().unwrap_or_default())
    };
    let [striking, struck] = kinds;
    let bodies = Bodies {
        striking: idx(striking, &scenario.striking_body).unwrap_or(0),
        struck: idx(struck, &scenario.struck_body),
    };
    let contact = scenario.contact_m.unwrap_or_default();
    features(scenario, centre, contact, bodies, kinds.map(<[String]>::len))
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
