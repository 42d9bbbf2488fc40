//! Trains the response network: on simulations, then on trajectories, on single steps and on
//! rollouts of growing length.

use std::cell::Cell;

use crate::learning::{
    EpochRecord, EpochReport, LearningError, SavedTraining, Split, TrainSettings, TrainingFile,
    TrainingProgress, TrainingReport, TrainingSet, folds, run_epochs,
};
use crate::response::network::response_network::ResponseNetwork;
use crate::response::physics::effects_fit::fit_strengths;
use crate::response::predict::calibration::{Unseen, calibrate};
use crate::response::train::simulated::{ImpactRecord, SimulatedMotion, simulate};
use crate::response::train::training_data::TrainingData;
use crate::response::train::training_run::{Planned, RESPONSE_CHECKPOINT, TrainingRun};
use crate::response::{
    Correction, MotionDomain, ResponseCase, ResponseConfig, ResponseEpoch, ResponseModel,
    ResponseRecord, ResponseStage, ResponseTraining,
};
use impactlab_core::numerics::{random_stream, sha256_hex};

/// Trajectories to fine-tune on.
pub type ResponseTrainingSet = TrainingSet<ResponseCase>;

/// How to train a response network.
pub type ResponseTrainSettings = TrainSettings<ResponseConfig>;

/// Pre-trains a network on simulations of the 4DOF model under recorded forces.
///
/// - `records`: vehicles, driving states and forces; no motion after the impact is looked at.
///
/// # Errors
/// [`LearningError`].
pub fn pretrain(
    name: &str,
    records: &[ImpactRecord],
    settings: &ResponseTrainSettings,
    report: &mut TrainingProgress<'_>,
) -> Result<ResponseModel, LearningError> {
    settings.config.check()?;
    settings.config.check_memory()?;
    let config = &settings.config;
    let motions = simulate(records, config.pretraining.motions, true, settings.seed);
    if motions.is_empty() {
        return Err(LearningError::TooFewCases { n_cases: 0, least: 1 });
    }
    let network = fresh_network(settings)?;
    // The last state: the whole motion led there.
    let last: Vec<Vec<u8>> = motions.iter().map(bytes_of_last).collect();
    let identity = sha256_hex(last.iter().map(Vec::as_slice));
    let data = TrainingData::from_simulations(&motions, config);
    let set = ResponseTrainingSet { name: name.to_owned(), ..ResponseTrainingSet::default() };
    let plan =
        vec![Planned { stage: ResponseStage::Pretraining, n_epochs: config.pretraining.epochs }];
    let training = TrainingRun::new(settings, network, data, plan, Vec::new())?;
    let (network, history) = run(training, settings, identity.clone(), report)?;
    let detail = ResponseTraining { n_simulated: motions.len(), keeps_latents: false };
    let record = ResponseRecord {
        data_digest: identity,
        ..ResponseRecord::new(&set, settings, detail, history)
    };
    Ok(ResponseModel::new(config.clone(), network, record))
}

/// Fine-tunes a network on trajectories, and calibrates how uncertain it is.
///
/// - `start`: a pre-trained model, whose first layers stay as they are; `None` for a fresh network,
///   all of whose layers are trained.
///
/// A training that was killed goes on from its checkpoint to the same weights as if it had not been.
///
/// A calibration takes two trajectories or more. With one the uncertainty is that of the model it
/// started from, nowhere below the usual one; the record says so.
///
/// # Errors
/// [`LearningError`].
pub fn fine_tune(
    start: Option<&ResponseModel>,
    set: &ResponseTrainingSet,
    settings: &ResponseTrainSettings,
    report: &mut TrainingProgress<'_>,
) -> Result<ResponseModel, LearningError> {
    settings.config.check()?;
    settings.config.check_memory()?;
    let folds = calibration_folds(set, settings);
    let n_trainings = folds.len() + 1;
    let (training_idx, is_cut) = (Cell::new(0), Cell::new(false));
    let mut on_progress = |progress: &TrainingReport| {
        let flow = match progress {
            TrainingReport::Epoch(epoch) => {
                let training_idx = training_idx.get();
                let n_done_elsewhere = training_idx * epoch.n_in_training();
                let epoch =
                    EpochReport { training_idx, n_trainings, n_done_elsewhere, ..epoch.clone() };
                report(&TrainingReport::Epoch(epoch))
            }
            fit => report(fit),
        };
        is_cut.set(is_cut.get() || flow.is_break());
        flow
    };
    let mut model = fine_tune_once(start, set, settings, &mut on_progress)?;
    let mut unseen = Vec::new();
    for fold in &folds {
        if is_cut.get() {
            return Ok(model);
        }
        training_idx.set(training_idx.get() + 1);
        let part = set.part(&fold.train);
        let quiet = ResponseTrainSettings { checkpoint: None, ..settings.clone() };
        let member = fine_tune_once(start, &part, &quiet, &mut on_progress)?;
        for case in fold.test.iter().filter_map(|&idx| set.train.get(idx)) {
            unseen.push(Unseen { case, predictor: member.predictor(&case.vehicle)? });
        }
    }
    if !is_cut.get() && !unseen.is_empty() {
        model.set_latents(calibrate(&unseen, settings.config.calibration.prior_std));
    } else if set.train.len() == 1
        && let Some(start) = start.filter(|start| start.latents().n_calibrated > 0)
    {
        model.keep_latents(start.latents());
    }
    if !is_cut.get() {
        model.set_domain(MotionDomain::from_cases(&set.train));
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

/// Checks that a network of this configuration can start from the weights of a model.
///
/// # Errors
/// [`LearningError::Network`] for layers of other sizes.
pub(crate) fn check_start(
    start: &ResponseModel,
    config: &ResponseConfig,
    seed: u64,
) -> Result<(), LearningError> {
    let network = fresh_network(&ResponseTrainSettings::unsaved(config.clone(), seed))?;
    Ok(network.parameters().import(&start.network().parameters().export()?)?)
}

/// Fine-tunes a network without a calibration.
pub(super) fn fine_tune_once(
    start: Option<&ResponseModel>,
    set: &ResponseTrainingSet,
    settings: &ResponseTrainSettings,
    report: &mut TrainingProgress<'_>,
) -> Result<ResponseModel, LearningError> {
    let config = &settings.config;
    if !set.train.iter().any(|case| case.states.len() > 1 && !case.inputs.is_empty()) {
        return Err(LearningError::TooFewCases { n_cases: 0, least: 1 });
    }
    let mut network = fresh_network(settings)?;
    let (mut n_simulated, mut history) = (0, Vec::new());
    if let Some(start) = start {
        network.parameters().import(&start.network().parameters().export()?)?;
        if config.network.correction != Correction::Whole && start.population().is_none() {
            network.silence()?;
        }
        network.freeze(config.single_steps.frozen_share);
        n_simulated = start.record().detail.n_simulated;
        history.clone_from(&start.record().history);
    } else {
        network.freeze(0.0);
    }
    let data = TrainingData::from_trajectories(&set.train, config, settings.seed);
    if let Some(population) = start.and_then(ResponseModel::population) {
        let cases: Vec<&ResponseCase> = set.train.iter().collect();
        if let Some(first) = cases.first() {
            let of_car = population.car_strengths(&first.vehicle, &network.mean_strengths()?);
            network.keep_remainder(of_car.remainder)?;
        }
        network.set_strengths(&population.strengths_of(&network, &cases)?)?;
    } else if config.network.effects {
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
    let identity = sha256_hex([set.digest().as_bytes(), start_digest.as_bytes()]);
    let training = TrainingRun::new(settings, network, data, plan, history)?;
    let (network, history) = run(training, settings, identity, report)?;
    let detail = ResponseTraining { n_simulated, keeps_latents: false };
    let record = ResponseRecord::new(set, settings, detail, history);
    Ok(ResponseModel::new(config.clone(), network, record))
}

/// Runs the epochs of a training, from its checkpoint on if there is one.
fn run(
    mut training: TrainingRun<'_>,
    settings: &ResponseTrainSettings,
    data_digest: String,
    report: &mut TrainingProgress<'_>,
) -> Result<(ResponseNetwork, Vec<EpochRecord<ResponseEpoch>>), LearningError> {
    let file =
        TrainingFile::new(RESPONSE_CHECKPOINT, settings, settings.config.clone(), data_digest);
    let resumed = file.read(|checkpoint| -> Result<(), LearningError> {
        training.resume(SavedTraining::take(checkpoint)?)
    })?;
    let epochs = run_epochs(&mut training, &file, report);
    file.named(resumed.is_some(), epochs)?;
    Ok(training.finish())
}

fn fresh_network(settings: &ResponseTrainSettings) -> Result<ResponseNetwork, LearningError> {
    let mut rng = random_stream(settings.seed, "response network", 0);
    Ok(ResponseNetwork::new(&settings.config.network, &mut rng)?)
}

fn bytes_of_last(motion: &SimulatedMotion) -> Vec<u8> {
    let last = motion.states.last().copied().unwrap_or_default().to_array();
    last.iter().flat_map(|value| value.to_le_bytes()).collect()
}
