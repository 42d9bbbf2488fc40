//! A training in the background: live losses, pause, resume, cancel.
//!
//! The core knows one callback. Here it sends the news to the window and blocks while the training
//! is paused.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::time::Duration;

use crate::app::force::TrainingForm;
use crate::app::source::CheckedDataset;
use crate::error_chain;
use crate::force::{
    CentreFit, EpochRecord, ForceCase, ForceConfig, ForceModel, TrainSettings, TrainingReport,
    TrainingSet, train,
};
use crate::jobs::{Job, Progress, Report, Update};

/// Latest epochs by whose pace the time left is estimated.
const PACE_EPOCHS: usize = 10;

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
    run: Option<Run>,
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

struct Run {
    job: Job<Result<ForceModel, String>>,
    news: Receiver<News>,
    gate: Arc<Gate>,
}

enum News {
    Phase(Phase),
    /// A case that is left out.
    LeftOut(String),
    Epoch {
        record: EpochRecord,
        n_epochs: usize,
        is_best: bool,
    },
}

/// Holds a thread up while it is closed.
#[derive(Default)]
struct Gate {
    is_closed: Mutex<bool>,
    changed: Condvar,
}

impl Gate {
    fn set_closed(&self, is_closed: bool) {
        *self.is_closed.lock().unwrap_or_else(PoisonError::into_inner) = is_closed;
        self.changed.notify_all();
    }

    fn is_closed(&self) -> bool {
        *self.is_closed.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn pass(&self) {
        let mut is_closed = self.is_closed.lock().unwrap_or_else(PoisonError::into_inner);
        while *is_closed {
            is_closed = self.changed.wait(is_closed).unwrap_or_else(PoisonError::into_inner);
        }
    }
}

impl Drop for Run {
    fn drop(&mut self) {
        self.job.cancel();
        self.gate.set_closed(false);
    }
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
        let (sender, news) = channel();
        let gate = Arc::new(Gate::default());
        let (form, own_gate, name) = (form.clone(), Arc::clone(&gate), data.name.clone());
        let job = Job::spawn_in_background("train", wake, move |report| {
            run(data, (&form, checkpoint), &mut |news| tell(news, (&sender, &own_gate), report))
        })?;
        *self = Self { run: Some(Run { job, news, gate }), data: name, ..Self::default() };
        Ok(())
    }

    /// Takes in what was reported; the model in the end.
    pub fn poll(&mut self) -> Option<Result<ForceModel, String>> {
        let run = self.run.as_mut()?;
        let update = run.job.poll(); // before the news: what it ends with comes after them
        for news in run.news.try_iter() {
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
        let result = match update {
            Update::Running => return None,
            Update::Finished(result) => result,
            Update::Panicked(text) => Err(format!("internal error: {text}")),
            Update::Gone => Err("the training is gone".to_owned()),
        };
        (self.run, self.phase) = (None, Phase::Ended);
        self.problem = result.as_ref().err().cloned();
        if let Ok(model) = &result {
            // A resumed training has epochs from before it.
            self.history = model.record().history.clone();
            self.best_epoch = Some(model.record().best_epoch);
        }
        Some(result)
    }

    /// Whether a training is under way, paused or not.
    pub fn is_running(&self) -> bool {
        self.run.is_some()
    }

    /// Whether it waits.
    pub fn is_paused(&self) -> bool {
        self.run.as_ref().is_some_and(|run| run.gate.is_closed())
    }

    /// Whether it was told to stop.
    pub fn is_cancelled(&self) -> bool {
        self.run.as_ref().is_some_and(|run| run.job.is_cancelled())
    }

    /// Stops before the next report, or goes on.
    pub fn set_paused(&self, is_paused: bool) {
        if let Some(run) = &self.run {
            run.gate.set_closed(is_paused);
        }
    }

    /// Ends it at the next report, with the best weights so far.
    pub fn cancel(&self) {
        if let Some(run) = &self.run {
            run.job.cancel();
            run.gate.set_closed(false);
        }
    }

    /// Share done, 0 to 1, and the time left at the pace of the latest epochs.
    pub fn progress(&self) -> (Option<f32>, Option<Duration>) {
        let Phase::Epochs(done, n_epochs) = self.phase else { return (None, None) };
        let latest: Vec<f64> =
            self.history.iter().rev().take(PACE_EPOCHS).map(|record| record.seconds).collect();
        let pace_s = latest.iter().sum::<f64>() / latest.len().max(1) as f64;
        let left_s = pace_s * n_epochs.saturating_sub(done) as f64;
        let fraction = done as f32 / n_epochs.max(1) as f32;
        (Some(fraction), Duration::try_from_secs_f64(left_s).ok())
    }
}

/// Sends news to the window, waits while paused, and asks whether to go on.
fn tell(
    news: News,
    (sender, gate): (&Sender<News>, &Gate),
    report: &mut Report<'_>,
) -> ControlFlow<()> {
    let progress = match &news {
        News::Phase(_) | News::LeftOut(_) => Progress::default(),
        News::Epoch { record, n_epochs, .. } => {
            Progress::new(record.epoch as u64, *n_epochs as u64, "training")
        }
    };
    // A receiver that is gone means a dropped training, which is cancelled.
    let _ = sender.send(news);
    if report(progress.clone()).is_break() {
        return ControlFlow::Break(());
    }
    gate.pass();
    report(progress)
}

/// # Errors
/// A message for the user.
fn run(
    data: TrainingData,
    (form, checkpoint): (&TrainingForm, Option<PathBuf>),
    tell: &mut dyn FnMut(News) -> ControlFlow<()>,
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
            let _ = tell(News::LeftOut(error_chain(&problem)));
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
        TrainingReport::Centre(fit) => tell(News::Phase(Phase::Centre(fit))),
        TrainingReport::Epoch { record, n_epochs, is_best } => {
            tell(News::Epoch { record: *record, n_epochs, is_best })
        }
    };
    train(&set, &settings, &mut report).map_err(|error| error_chain(&error))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_closed_gate_holds_until_it_is_opened() {
        let gate = Arc::new(Gate::default());
        gate.pass();
        gate.set_closed(true);
        let inner = Arc::clone(&gate);
        let mut job = Job::spawn("wait", || {}, move |_| inner.pass()).unwrap();
        assert!(matches!(job.wait_for(Duration::from_millis(30)), Update::Running));
        assert!(gate.is_closed());
        gate.set_closed(false);
        assert!(matches!(job.wait(), Update::Finished(())));
    }
}
