//! A training of the response network in the background: live losses, pause, resume, cancel.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use crate::app::network::TrainedModel;
use crate::app::response::{Course, ResponseTrainingForm};
use crate::app::source::CheckedDataset;
use crate::app::training::{Tell, Training, TrainingSlot, time_left};
use crate::data::{TEST_SHARE, split};
use crate::error_chain;
use crate::jobs::Progress;
use crate::response::{
    ImpactRecord, ResponseCase, ResponseConfig, ResponseEpoch, ResponseModel, ResponseReport,
    ResponseTrainSettings, ResponseTrainingSet, fine_tune, pretrain,
};
use crate::shipped::ModelSource;
use crate::vehicle::VehicleParameters;

/// What a training is doing.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum ResponsePhase {
    /// Reads settings, models and saved state, chooses the trajectories.
    #[default]
    Preparing,
    /// Epochs of one of several trainings.
    Epochs {
        /// Those that are over.
        done: usize,
        /// Those of a training.
        n_epochs: usize,
        /// Which training: 0 for the model itself, then those for the calibration.
        training_idx: usize,
        /// How many trainings.
        n_trainings: usize,
    },
    /// It is over.
    Ended,
}

/// A training, under way or over.
#[derive(Default)]
pub struct ResponseTrainingStatus {
    /// Under way.
    pub run: TrainingSlot<ResponseModel, News>,
    /// What it is doing.
    pub phase: ResponsePhase,
    /// Every epoch of the model itself so far, those of a pre-training before it left out.
    pub history: Vec<ResponseEpoch>,
    /// How long each epoch of all trainings took, s.
    seconds: Vec<f64>,
    /// Why there is no model, in the end.
    pub problem: Option<String>,
    /// On what it is trained.
    pub data: String,
    /// Cases that are left out, and why.
    pub left_out: Vec<String>,
}

/// What a training learns from.
pub struct ResponseTrainingData {
    /// What a person calls it.
    pub name: String,
    /// The trajectories.
    pub dataset: Arc<CheckedDataset>,
    /// The struck vehicle.
    pub vehicle: VehicleParameters,
    /// The current model.
    pub current: Option<Arc<ResponseModel>>,
}

/// What a training tells.
pub enum News {
    /// A case that is left out.
    LeftOut(String),
    Epoch {
        record: ResponseEpoch,
        phase: ResponsePhase,
    },
}

impl ResponseTrainingStatus {
    /// Starts a training; one that is under way is dropped.
    ///
    /// # Errors
    /// The operating system's, if no thread can be started.
    pub fn start(
        &mut self,
        data: ResponseTrainingData,
        (form, checkpoint): (&ResponseTrainingForm, Option<PathBuf>),
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<()> {
        let (form, name) = (form.clone(), data.name.clone());
        let run = Training::start(wake, move |tell| run(&data, (&form, checkpoint), tell))?;
        *self = Self { run: run.into(), data: name, ..Self::default() };
        Ok(())
    }

    /// Takes in what was reported; the model in the end.
    pub fn poll(&mut self) -> Option<Result<ResponseModel, String>> {
        let (news, result) = self.run.poll();
        for news in news {
            match news {
                News::LeftOut(why) => self.left_out.push(why),
                News::Epoch { record, phase } => {
                    self.phase = phase;
                    self.seconds.push(record.seconds);
                    if matches!(phase, ResponsePhase::Epochs { training_idx: 0, .. }) {
                        self.history.push(record);
                    }
                }
            }
        }
        let result = result?;
        self.phase = ResponsePhase::Ended;
        self.problem = result.as_ref().err().cloned();
        if let Ok(model) = &result {
            // A resumed training has epochs from before it.
            self.history.clone_from(&model.record().history);
        }
        Some(result)
    }

    /// Share done, 0 to 1, and the time left at the pace of the latest epochs.
    pub fn progress(&self) -> (Option<f32>, Option<Duration>) {
        let ResponsePhase::Epochs { done, n_epochs, training_idx, n_trainings } = self.phase else {
            return (None, None);
        };
        let (all, over) = (n_epochs * n_trainings, n_epochs * training_idx + done);
        let left = time_left(self.seconds.iter().copied(), all.saturating_sub(over));
        (Some(over as f32 / all.max(1) as f32), left)
    }
}

/// # Errors
/// A message for the user.
fn run(
    data: &ResponseTrainingData,
    (form, checkpoint): (&ResponseTrainingForm, Option<PathBuf>),
    tell: &mut Tell<'_, News>,
) -> Result<ResponseModel, String> {
    let (cases, problems) = ResponseCase::of_dataset(&data.dataset.dataset, &data.vehicle);
    for problem in problems {
        // Cancelling takes effect at the first report of the training itself.
        let _ = tell(News::LeftOut(error_chain(&problem)), Progress::default());
    }
    let mut report = |told: ResponseReport<'_>| {
        let before = told.n_before;
        let phase = ResponsePhase::Epochs {
            done: told.record.epoch.saturating_sub(before),
            n_epochs: told.n_epochs.saturating_sub(before),
            training_idx: told.training_idx,
            n_trainings: told.n_trainings,
        };
        let progress = Progress::new(told.record.epoch as u64, told.n_epochs as u64, "training");
        tell(News::Epoch { record: *told.record, phase }, progress)
    };
    let start = start_of(data, form.course)?;
    let config = config_of(form, start.as_deref())?;
    let settings =
        ResponseTrainSettings { config, seed: form.choice, checkpoint, resume: form.resume };
    let trained = match form.course {
        Course::Pretrain => {
            let kept = split(&cases, form.seed, TEST_SHARE).train;
            let records: Vec<ImpactRecord> = kept
                .into_iter()
                .filter_map(|idx| cases.get(idx).and_then(ResponseCase::impact))
                .collect();
            pretrain((&data.name, &records), &settings, &mut report)
        }
        _ => {
            let wanted = (form.n_trajectories > 0).then_some(form.n_trajectories);
            let seeds = (form.seed, TEST_SHARE, form.choice);
            ResponseTrainingSet::choose(data.name.clone(), &cases, wanted, seeds)
                .and_then(|set| fine_tune(start.as_deref(), &set, &settings, &mut report))
        }
    };
    trained.map_err(|error| error_chain(&error))
}

/// The model that is fine-tuned.
fn start_of(
    data: &ResponseTrainingData,
    course: Course,
) -> Result<Option<Arc<ResponseModel>>, String> {
    Ok(match course {
        Course::FineTuneShipped => {
            Some(Arc::new(ResponseModel::read(&ModelSource::ShippedPretrained)?))
        }
        Course::FineTuneCurrent => {
            let current = data.current.clone();
            Some(current.ok_or_else(|| "there is no current response model".to_owned())?)
        }
        Course::FromScratch | Course::Pretrain => None,
    })
}

fn config_of(
    form: &ResponseTrainingForm,
    start: Option<&ResponseModel>,
) -> Result<ResponseConfig, String> {
    match (form.config.trim(), start) {
        ("", Some(start)) => Ok(start.config().clone()),
        ("", None) => Ok(ResponseConfig::default()),
        (path, _) => ResponseConfig::load(Path::new(path)).map_err(|error| error_chain(&error)),
    }
}
