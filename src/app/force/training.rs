//! A training of the force network in the background: live losses, pause, resume, cancel.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use crate::app::force::TrainingForm;
use crate::app::source::CheckedDataset;
use crate::app::training::{Tell, Training, TrainingSlot, time_left};
use crate::error_chain;
use crate::force::{
    CentreFit, EpochRecord, ForceCase, ForceConfig, ForceModel, TrainSettings, TrainingReport,
    TrainingSet, train,
};
use crate::jobs::Progress;

/// What a training is doing.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum Phase {
    /// Reads settings and saved state, splits the cases.
    #[default]
    Preparing,
    /// Fits the physics in the centre.
    Centre(CentreFit),
    /// Epochs: the last one that is over, and how many at most.
    Epochs(usize, usize),
    /// It is over.
    Ended,
}

/// A training, under way or over.
#[derive(Default)]
pub struct TrainingStatus {
    /// Under way.
    pub run: TrainingSlot<ForceModel, News>,
    /// What it is doing.
    pub phase: Phase,
    /// Every epoch so far.
    pub history: Vec<EpochRecord>,
    /// The epoch with the best weights so far.
    pub best_epoch: Option<usize>,
    /// Why there is no model, in the end.
    pub problem: Option<String>,
    /// On what it is trained.
    pub data: String,
    /// Cases that are left out, and why.
    pub left_out: Vec<String>,
}

/// What a training learns from.
pub struct TrainingData {
    /// What a person calls it.
    pub name: String,
    /// Of these cases some are kept for the test.
    pub dataset: Arc<CheckedDataset>,
    /// All of these cases are learned from.
    pub extra: Vec<Arc<CheckedDataset>>,
}

/// What a training tells.
pub enum News {
    Phase(Phase),
    /// A case that is left out.
    LeftOut(String),
    Epoch {
        record: EpochRecord,
        n_epochs: usize,
        is_best: bool,
    },
}

impl TrainingStatus {
    /// Starts a training; one that is under way is dropped.
    ///
    /// # Errors
    /// The operating system's, if no thread can be started.
    pub fn start(
        &mut self,
        data: TrainingData,
        (form, checkpoint): (&TrainingForm, Option<PathBuf>),
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<()> {
        let (form, name) = (form.clone(), data.name.clone());
        let run = Training::start(wake, move |tell| run(data, (&form, checkpoint), tell))?;
        *self = Self { run: run.into(), data: name, ..Self::default() };
        Ok(())
    }

    /// Takes in what was reported; the model in the end.
    pub fn poll(&mut self) -> Option<Result<ForceModel, String>> {
        let (news, result) = self.run.poll();
        for news in news {
            match news {
                News::Phase(phase) => self.phase = phase,
                News::LeftOut(why) => self.left_out.push(why),
                News::Epoch { record, n_epochs, is_best } => {
                    self.phase = Phase::Epochs(record.epoch, n_epochs);
                    if is_best {
                        self.best_epoch = Some(record.epoch);
                    }
                    self.history.push(record);
                }
            }
        }
        let result = result?;
        self.phase = Phase::Ended;
        self.problem = result.as_ref().err().cloned();
        if let Ok(model) = &result {
            // A resumed training has epochs from before it.
            self.history = model.record().history.clone();
            self.best_epoch = Some(model.record().best_epoch);
        }
        Some(result)
    }

    /// Share done, 0 to 1, and the time left at the pace of the latest epochs.
    pub fn progress(&self) -> (Option<f32>, Option<Duration>) {
        let Phase::Epochs(done, n_epochs) = self.phase else { return (None, None) };
        let fraction = done as f32 / n_epochs.max(1) as f32;
        let seconds = self.history.iter().map(|record| record.seconds);
        (Some(fraction), time_left(seconds, n_epochs.saturating_sub(done)))
    }
}

/// # Errors
/// A message for the user.
fn run(
    data: TrainingData,
    (form, checkpoint): (&TrainingForm, Option<PathBuf>),
    tell: &mut Tell<'_, News>,
) -> Result<ForceModel, String> {
    let mut config = match form.config.trim() {
        "" => ForceConfig::default(),
        path => ForceConfig::load(Path::new(path)).map_err(|error| error_chain(&error))?,
    };
    config.training.epochs = form.epochs;
    let mut read = |checked: &CheckedDataset| {
        let (cases, problems) = ForceCase::of_dataset(&checked.dataset);
        for problem in problems {
            // Cancelling takes effect at the first report of the training itself.
            let _ = tell(News::LeftOut(error_chain(&problem)), Progress::default());
        }
        cases
    };
    let cases = read(&data.dataset);
    let extra: Vec<ForceCase> = data.extra.iter().flat_map(|checked| read(checked)).collect();
    let split = (form.seed, config.training.test_share);
    let set =
        TrainingSet::new(data.name, &cases, &extra, split).map_err(|error| error_chain(&error))?;
    let settings = TrainSettings { config, seed: form.seed, checkpoint, resume: form.resume };
    let mut report = |report: TrainingReport<'_>| match report {
        TrainingReport::Centre(fit) => tell(News::Phase(Phase::Centre(fit)), Progress::default()),
        TrainingReport::Epoch { record, n_epochs, is_best } => {
            let done = Progress::new(record.epoch as u64, n_epochs as u64, "training");
            tell(News::Epoch { record: *record, n_epochs, is_best }, done)
        }
    };
    train(&set, &settings, &mut report).map_err(|error| error_chain(&error))
}
