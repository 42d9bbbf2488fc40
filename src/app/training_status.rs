//! What the window knows of a training, under way or over, of either network.

use std::sync::Arc;
use std::time::Duration;

use crate::app::network::TrainedModel;
use crate::app::training::{TrainingEnd, TrainingSlot, time_left};
use crate::learning::{EpochSummary, TrainingReport};
use crate::study::{Library, Question, Request};

/// A training of a model of type `M`, under way or over.
pub struct TrainingStatus<M: TrainedModel> {
    /// The training under way.
    pub run: TrainingSlot<M::Answer>,
    /// What was asked for.
    pub request: Option<Request>,
    /// What is told of the training in the end.
    pub report: Option<M::Report>,
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
}

impl<M: TrainedModel> Default for TrainingStatus<M> {
    fn default() -> Self {
        Self {
            run: TrainingSlot::default(),
            request: None,
            report: None,
            latest: None,
            is_over: false,
            history: Vec::new(),
            best_epoch: None,
            seconds: Vec::new(),
            problem: None,
            data: String::new(),
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
    pub fn start<Q: Question<Answer = M::Answer> + Into<Request>>(
        &mut self,
        question: Q,
        (data, library): (String, &Arc<Library>),
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<()> {
        *self = Self { data, request: Some(question.clone().into()), ..Self::default() };
        self.run.start(question, library, wake)
    }

    /// Takes in what was reported; in the end the model, and whether the training was completed and
    /// not cancelled.
    pub fn poll(&mut self) -> Option<Result<(M, bool), String>> {
        let (reports, end) = self.run.poll();
        for report in reports {
            self.take(report);
        }
        let end = end?;
        self.is_over = true;
        let is_complete = matches!(end, TrainingEnd::Complete(_));
        match end {
            TrainingEnd::Complete(answer) | TrainingEnd::Cancelled(Some(answer)) => {
                let (model, report) = M::of_answer(answer);
                // A resumed training has epochs from before it.
                self.history = model.history();
                self.best_epoch = model.best_epoch();
                self.report = Some(report);
                Some(Ok((model, is_complete)))
            }
            TrainingEnd::Cancelled(None) => None,
            TrainingEnd::Failed(problem) => {
                self.problem = Some(problem.clone());
                Some(Err(problem))
            }
        }
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
