//! What the window knows of a training, under way or over, of either network.

use std::time::Duration;

use crate::app::network::TrainedModel;
use crate::app::training::{Tell, Training, TrainingNews, TrainingSlot, time_left};
use crate::learning::{EpochSummary, TrainingReport};

/// A training of a model of type `M`, under way or over.
pub struct TrainingStatus<M> {
    /// The training under way.
    pub run: TrainingSlot<M>,
    /// What was reported last; nothing before the first fit or epoch.
    pub latest: Option<TrainingReport>,
    /// Whether the training has come to its end.
    pub is_over: bool,
    /// Every epoch of the model itself so far, those of a training before it left out.
    pub history: Vec<EpochSummary>,
    /// The epoch with the best weights so far, where the best are kept and not the last.
    pub best_epoch: Option<usize>,
    /// Duration of each epoch of all trainings, s.
    seconds: Vec<f64>,
    /// Why there is no model in the end.
    pub problem: Option<String>,
    /// What the data are called.
    pub data: String,
    /// Cases that are left out, and why.
    pub left_out: Vec<String>,
}

impl<M> Default for TrainingStatus<M> {
    fn default() -> Self {
        Self {
            run: TrainingSlot::default(),
            latest: None,
            is_over: false,
            history: Vec::new(),
            best_epoch: None,
            seconds: Vec::new(),
            problem: None,
            data: String::new(),
            left_out: Vec::new(),
        }
    }
}

impl<M: TrainedModel> TrainingStatus<M> {
    /// Starts a training; one that is under way is dropped.
    ///
    /// - `data`: what a person calls the data.
    ///
    /// # Errors
    /// The operating system's, if no thread can be started.
    pub fn start(
        &mut self,
        data: String,
        wake: impl Fn() + Send + 'static,
        work: impl FnOnce(&mut Tell<'_>) -> Result<M, String> + Send + 'static,
    ) -> std::io::Result<()> {
        let run = Training::start(wake, work)?.into();
        *self = Self { run, data, ..Self::default() };
        Ok(())
    }

    /// Takes in what was reported; the model in the end.
    pub fn poll(&mut self) -> Option<Result<M, String>> {
        let (news, result) = self.run.poll();
        for news in news {
            match news {
                TrainingNews::LeftOut(why) => self.left_out.push(why),
                TrainingNews::Report(report) => self.take(report),
            }
        }
        let result = result?;
        self.is_over = true;
        self.problem = result.as_ref().err().cloned();
        if let Ok(model) = &result {
            // A resumed training has epochs from before it.
            self.history = model.history();
            self.best_epoch = model.best_epoch();
        }
        Some(result)
    }

    fn take(&mut self, report: TrainingReport) {
        if let TrainingReport::Epoch(epoch) = &report {
            self.seconds.push(epoch.summary.seconds);
            if epoch.training_idx == 0 {
                self.best_epoch = epoch.best_epoch;
                self.history.push(epoch.summary.clone());
            }
        }
        self.latest = Some(report);
    }

    /// The share done, 0 to 1, and the time left at the pace of the latest epochs.
    pub fn progress(&self) -> (Option<f32>, Option<Duration>) {
        let Some(TrainingReport::Epoch(epoch)) = self.latest.as_ref().filter(|_| !self.is_over)
        else {
            return (None, None);
        };
        let (done, total) = epoch.progress();
        let left = time_left(self.seconds.iter().copied(), total.saturating_sub(done));
        (Some(epoch.share_done() as f32), left)
    }

    /// What the training is doing, for a person.
    pub fn doing(&self) -> String {
        let what = match &self.latest {
            _ if self.run.is_cancelled() => "ending".to_owned(),
            None => "preparing".to_owned(),
            Some(TrainingReport::Fit { what, .. }) => what.clone(),
            Some(TrainingReport::Epoch(epoch)) => {
                let part = epoch.part().map_or(String::new(), |part| format!("{part}, "));
                let (done, n_epochs) = (epoch.epoch_in_training(), epoch.n_in_training());
                format!("{part}epoch {done} of {n_epochs}")
            }
        };
        if self.run.is_paused() { format!("paused: {what}") } else { what }
    }
}
