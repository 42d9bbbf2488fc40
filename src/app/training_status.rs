//! The state of a training of either network, as the window shows it.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::app::archive::{ArchiveEntry, ArchiveKind, StoredFact};
use crate::app::network::TrainedModel;
use crate::app::training::{TrainingEnd, TrainingSlot, time_left};
use crate::app::unfinished::{TrainingDiary, training_options};
use crate::app::widgets::duration_text;
use impactlab_core::jobs::TimeLeft;
use impactlab_networks::learning::{EpochReport, EpochSummary, FitReport, TrainingReport};
use impactlab_study::{Library, Question, Request};

/// The training of a model of type `M`, running or finished.
pub struct TrainingStatus<M: TrainedModel> {
    /// The running training.
    pub run: TrainingSlot<M::Answer>,
    /// The question that started the training.
    pub request: Option<Request>,
    /// The report of the training, once it has given a model.
    pub report: Option<M::Report>,
    /// The latest report; `None` before the first fit or epoch.
    pub latest: Option<TrainingReport>,
    /// The latest epoch of the model itself, beside which trainings for the calibration may run.
    own_epoch: Option<EpochReport>,
    /// Whether the training has ended.
    pub is_over: bool,
    /// Summaries of the epochs of the model itself so far, without those of the calibration's
    /// trainings. Once the training is over, they include those before it was resumed; those of the
    /// model from which it started never belong to them.
    pub history: Vec<EpochSummary>,
    /// Epochs of the model from which the training started; `None` before its first epoch.
    n_before: Option<usize>,
    /// The epoch with the best weights so far, from 1; `None` for a network that keeps the last
    /// weights.
    pub best_epoch: Option<usize>,
    /// Durations of the epochs of all trainings, including those for the calibration, s.
    seconds: Vec<f64>,
    /// When the training began.
    started: Instant,
    /// The time that the fits before the first epoch or after the last one still take, as of the latest
    /// of their reports.
    fits_left: (TimeLeft, Duration),
    /// The reason why the training gave no model.
    pub problem: Option<String>,
    /// The name of the data, shown to the user.
    pub data: String,
    /// The checkpoint of the training, if this window stores any.
    pub checkpoint: Option<PathBuf>,
    /// How many cases had been open before the one in which it was started.
    pub n_cases: u64,
}

impl<M: TrainedModel> Default for TrainingStatus<M> {
    fn default() -> Self {
        Self {
            run: TrainingSlot::default(),
            request: None,
            report: None,
            latest: None,
            own_epoch: None,
            is_over: false,
            history: Vec::new(),
            n_before: None,
            best_epoch: None,
            seconds: Vec::new(),
            started: Instant::now(),
            fits_left: (TimeLeft::default(), Duration::ZERO),
            problem: None,
            data: String::new(),
            checkpoint: None,
            n_cases: 0,
        }
    }
}

impl<M: TrainedModel> TrainingStatus<M> {
    /// Starts a training. A training that is still running is cancelled and its result dropped.
    ///
    /// - `data`: name of the data, shown to the user;
    /// - `diary`: writes the note beside the checkpoint; `None` if there is no checkpoint;
    /// - `wake`: called after every report and at the end.
    ///
    /// # Errors
    /// The error of the operating system, if the thread cannot be started.
    pub fn start<Q: Question<Answer = M::Answer> + Into<Request>>(
        &mut self,
        question: Q,
        diary: Option<TrainingDiary>,
        data: String,
        library: &Arc<Library>,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<()> {
        let checkpoint = diary.as_ref().map(|diary| diary.checkpoint().to_owned());
        let request = Some(question.clone().into());
        *self = Self { data, request, checkpoint, ..Self::default() };
        self.run.start(question, diary, library, wake)
    }

    /// Receives the reports. When the training has ended, returns the model and whether the
    /// training was completed, `true`, or cancelled, `false`; or the reason why it failed. Returns
    /// `None` while it runs, and when it was cancelled without any weights.
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
                let (model, report) = M::from_answer(answer);
                self.take_epochs_of(&model);
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

    /// Takes the epochs of this training from its model: the reports lack those before it was resumed.
    fn take_epochs_of(&mut self, model: &M) {
        let Some(n_before) = self.n_before else { return };
        self.history = model.history();
        self.history.retain(|summary| summary.epoch > n_before);
        self.best_epoch = model.best_epoch();
    }

    fn take(&mut self, report: TrainingReport) {
        match &report {
            TrainingReport::Fit(_) => {
                let (left, at) = &mut self.fits_left;
                *at = self.started.elapsed();
                left.take(*at, &report.progress());
            }
            TrainingReport::Epoch(epoch) => {
                self.seconds.extend(epoch.summary.seconds);
                if epoch.training_idx == 0 {
                    self.n_before = Some(epoch.n_before);
                    self.best_epoch = epoch.best_epoch;
                    self.history.push(epoch.summary.clone());
                    self.own_epoch = Some(epoch.clone());
                }
            }
        }
        self.latest = Some(report);
    }

    /// How far the training of the model has got, such as “epoch 3 of 100”, and once that is over, those
    /// for its calibration; `None` before the first report.
    pub fn reached(&self) -> Option<String> {
        Some(match self.latest.as_ref()? {
            TrainingReport::Fit(fit) => fit.to_string(),
            TrainingReport::Epoch(latest) => {
                let is_under_way =
                    |own: &&EpochReport| own.epoch_in_training() < own.n_in_training();
                let epoch = self.own_epoch.as_ref().filter(is_under_way).unwrap_or(latest);
                let part = epoch.part().map_or(String::new(), |part| format!("{part}, "));
                let (done, n_epochs) = (epoch.epoch_in_training(), epoch.n_in_training());
                format!("{part}epoch {done} of {n_epochs}")
            }
        })
    }

    /// Whether the training was cancelled before there was a model.
    pub fn has_no_model(&self) -> bool {
        self.is_over && self.report.is_none() && self.problem.is_none()
    }

    /// Returns the note with which a model that the training has just given is kept.
    ///
    /// - `name`: what the model is called;
    /// - `is_complete`: whether the training was completed; otherwise it was cancelled.
    pub fn archive_note(&self, model: &M, name: String, is_complete: bool) -> Option<ArchiveEntry> {
        let (report, mut question) = (self.report.as_ref()?, self.request.clone()?);
        if let Some(options) = training_options(&mut question) {
            (options.checkpoint, options.resume) = (None, false); // Those of a finished training.
        }
        let kind = ArchiveKind::from(M::NETWORK);
        let mut entry = ArchiveEntry::new(kind, name, model.data().to_owned(), question);
        entry.is_cancelled = !is_complete;
        entry.figures = StoredFact::from_table(&model.facts());
        if let Some(reached) = self.reached().filter(|_| !is_complete) {
            // The facts of the model know the epochs that were run, and not those that were planned.
            entry.figures.insert(0, StoredFact::new("reached", reached));
        }
        entry.settings = model.settings().as_ref().map_or_else(Vec::new, StoredFact::from_table);
        let time = Duration::try_from_secs_f64(M::seconds(report)).unwrap_or_default();
        entry.figures.push(StoredFact::new("computing time", duration_text(time)));
        Some(entry)
    }

    /// What is being fitted before the first epoch or after the last one.
    pub fn fit(&self) -> Option<&FitReport> {
        match &self.latest {
            Some(TrainingReport::Fit(fit)) if !self.is_over => Some(fit),
            _ => None,
        }
    }

    /// Returns the share that is done, 0 to 1, and the remaining time: of the fits before the first
    /// epoch, then of the epochs at the pace of the latest ones, then of the fits after them; `None` for
    /// both before the first fit or epoch, once it was cancelled, and after the end.
    pub fn progress(&self) -> (Option<f32>, Option<Duration>) {
        match self.latest.as_ref().filter(|_| !self.is_over && !self.run.is_cancelled()) {
            None => (None, None),
            Some(report @ TrainingReport::Fit(_)) => {
                let (left, at) = &self.fits_left;
                (report.progress().fraction(), left.at(*at))
            }
            Some(TrainingReport::Epoch(epoch)) => {
                let left = time_left(self.seconds.iter().copied(), epoch.n_in_a_row());
                (Some(epoch.share_done() as f32), left)
            }
        }
    }

    /// Returns a description of what the training is doing, shown to the user.
    pub fn doing(&self) -> String {
        let what = match self.run.is_cancelled() {
            true => "ending".to_owned(),
            false => self.reached().unwrap_or_else(|| "preparing".to_owned()),
        };
        if self.run.is_paused() { format!("paused: {what}") } else { what }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_networks::force::ForceModel;
    use impactlab_networks::shipped::ModelSource;

    #[test]
    fn fits_before_and_after_the_epochs_have_a_share_and_a_time_left() {
        let mut status = TrainingStatus::<ForceModel>::default();
        assert_eq!(status.progress(), (None, None));
        let what = "fitting crush law 1 of 5".to_owned();
        let mut fit = FitReport { what, n_steps: 50, ..FitReport::default() };
        status.take(TrainingReport::Fit(fit.clone()));
        assert_eq!(status.progress(), (Some(0.0), None));
        fit.done = 20;
        status.take(TrainingReport::Fit(fit.clone()));
        let (share, left) = status.progress();
        assert!(share == Some(0.4) && left.is_some(), "{share:?} {left:?}");
        assert!(status.fit().is_some_and(|fit| !fit.is_after_epochs));
        assert_eq!(status.doing(), "before the epochs: fitting crush law 1 of 5");
        fit = FitReport { is_after_epochs: true, done: 0, n_steps: 900, ..fit };
        status.take(TrainingReport::Fit(fit));
        assert_eq!(status.progress(), (Some(0.0), None));
        assert!(status.doing().starts_with("after the epochs: "));
    }

    /// “epoch 1 of 1” was told of a training of 100 epochs that was cancelled after the first one.
    #[test]
    fn an_epoch_is_told_with_those_that_were_planned() {
        let model = ModelSource::Shipped.force_model().unwrap();
        let first = model.history()[0].clone();
        let mut status = TrainingStatus::<ForceModel>::default();
        assert_eq!(status.reached(), None);
        status.take(TrainingReport::Epoch(EpochReport {
            summary: first,
            n_before: 0,
            n_epochs: 100,
            best_epoch: Some(1),
            training_idx: 0,
            n_trainings: 1,
            n_done_elsewhere: 0,
            rounds_left: None,
        }));
        status.is_over = true;
        assert_eq!(status.reached().as_deref(), Some("epoch 1 of 100"));
    }

    /// A model of one epoch was kept with what a training beside it had reached.
    #[test]
    fn trainings_beside_that_of_the_model_are_told_once_it_is_over() {
        let model = ModelSource::Shipped.force_model().unwrap();
        let mut status = TrainingStatus::<ForceModel>::default();
        let mut take = |epoch: usize, training_idx: usize| {
            status.take(TrainingReport::Epoch(EpochReport {
                summary: EpochSummary { epoch, ..model.history()[0].clone() },
                n_before: 0,
                n_epochs: 3,
                best_epoch: None,
                training_idx,
                n_trainings: 5,
                n_done_elsewhere: 0,
                rounds_left: None,
            }));
            status.reached().unwrap()
        };
        assert_eq!(take(1, 0), "epoch 1 of 3");
        assert_eq!(take(2, 1), "epoch 1 of 3");
        take(2, 0);
        assert_eq!(take(3, 0), "epoch 3 of 3");
        assert_eq!(take(3, 1), "calibration 1 of 4, epoch 3 of 3");
    }

    /// Those of the shipped network stood under the name of a log that was learned from.
    #[test]
    fn epochs_of_the_model_from_which_a_training_starts_are_not_its_own() {
        let model = ModelSource::Shipped.force_model().unwrap();
        let all = model.history();
        let last = all.last().unwrap().clone();
        let mut status = TrainingStatus::<ForceModel>::default();
        status.take_epochs_of(&model);
        assert!(status.history.is_empty());
        status.take(TrainingReport::Epoch(EpochReport {
            summary: last.clone(),
            n_before: all.len() - 2,
            n_epochs: all.len(),
            best_epoch: None,
            training_idx: 0,
            n_trainings: 1,
            n_done_elsewhere: 0,
            rounds_left: None,
        }));
        assert_eq!(status.history, std::slice::from_ref(&last));
        status.take_epochs_of(&model);
        assert_eq!(status.history, all[all.len() - 2..]);
    }
}
