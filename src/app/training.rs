//! Runs a training in the background, with reports while it runs, and with pause and cancel.
//!
//! A training question has a single observer. Here the observer sends the reports to the window and
//! blocks the thread while the training is paused.

use std::ops::ControlFlow;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use crate::app::unfinished::TrainingDiary;
use impactlab_core::data::Outcome;
use impactlab_core::error_chain;
use impactlab_core::jobs::{Job, Progress, ProgressCallback};
use impactlab_networks::learning::TrainingReport;
use impactlab_study::{Event, Library, Question};

/// Number of the latest epochs from whose durations the remaining time is estimated.
const PACE_EPOCHS: usize = 10;

/// A running training. It sends reports and ends with an answer of type `A`.
pub struct Training<A> {
    job: Job<Result<Outcome<A>, String>>,
    reports: Receiver<TrainingReport>,
    gate: Arc<Gate>,
}

/// The end of a training.
pub enum TrainingEnd<A> {
    /// The training was completed.
    Complete(A),
    /// The user cancelled the training. It holds the answer with the weights reached so far, if
    /// there are any.
    Cancelled(Option<A>),
    /// The training failed, with a message for the user.
    Failed(String),
}

/// Blocks a thread while the gate is closed, which pauses a training.
#[derive(Default)]
struct Gate {
    state: Mutex<GateState>,
    changed: Condvar,
}

#[derive(Default)]
struct GateState {
    is_closed: bool,
    /// Whether the user has cancelled the training, as opposed to closing the window.
    is_given_up: bool,
    /// Whether a thread is waiting at the gate.
    is_held: bool,
}

impl Gate {
    fn state(&self) -> MutexGuard<'_, GateState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn set_closed(&self, is_closed: bool) {
        self.state().is_closed = is_closed;
        self.changed.notify_all();
    }

    /// Opens the gate for a training that the user has cancelled.
    fn give_up(&self) {
        self.state().is_given_up = true;
        self.set_closed(false);
    }

    fn is_given_up(&self) -> bool {
        self.state().is_given_up
    }

    fn is_closed(&self) -> bool {
        self.state().is_closed
    }

    /// Whether a thread is waiting at the closed gate.
    fn is_holding(&self) -> bool {
        self.state().is_held
    }

    /// Returns at once if the gate is open, otherwise when it is opened.
    fn pass(&self) {
        let mut state = self.state();
        while state.is_closed {
            state.is_held = true;
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        state.is_held = false;
    }
}

impl<A> Drop for Training<A> {
    fn drop(&mut self) {
        self.job.cancel();
        self.gate.set_closed(false);
    }
}

impl<A: Send + 'static> Training<A> {
    fn start<Q: Question<Answer = A>>(
        question: Q,
        mut diary: Option<TrainingDiary>,
        library: Arc<Library>,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<Self> {
        let (sender, reports) = channel();
        let gate = Arc::new(Gate::default());
        let own_gate = Arc::clone(&gate);
        let job = Job::spawn_in_background(Q::NAME, wake, move |report| {
            if let Some(diary) = &diary {
                diary.begin()?;
            }
            let mut observer = |event: Event<'_>| {
                if let (Event::Training(report), Some(diary)) = (&event, &mut diary) {
                    diary.record(report);
                }
                tell(&event, &sender, &own_gate, report)
            };
            let answer = question.answer(&library, &mut observer);
            if let Some(diary) = diary {
                diary.end(own_gate.is_given_up());
            }
            answer.map_err(|error| error_chain(&error))
        })?;
        Ok(Self { job, reports, gate })
    }

    /// Returns the reports since the last call, and the end, if the training has ended.
    fn poll(&mut self) -> (Vec<TrainingReport>, Option<TrainingEnd<A>>) {
        // The job is polled before the reports are read, so that none before its end is lost.
        let update = self.job.poll();
        let end = update.into_result("the training").map(|result| match result {
            Ok(Outcome::Complete(answer)) if self.job.is_cancelled() => {
                TrainingEnd::Cancelled(Some(answer))
            }
            Ok(Outcome::Complete(answer)) => TrainingEnd::Complete(answer),
            Ok(Outcome::Cancelled) => TrainingEnd::Cancelled(None),
            Err(problem) => TrainingEnd::Failed(problem),
        });
        (self.reports.try_iter().collect(), end)
    }
}

/// The training of one network, if one is running.
pub struct TrainingSlot<A>(Option<Training<A>>);

impl<A> Default for TrainingSlot<A> {
    fn default() -> Self {
        Self(None)
    }
}

impl<A> TrainingSlot<A> {
    /// Whether a training is running, paused or not.
    pub fn is_running(&self) -> bool {
        self.0.is_some()
    }

    /// Whether the training was asked to pause. It continues until its next report, which usually
    /// is at the end of the current epoch.
    pub fn is_paused(&self) -> bool {
        self.0.as_ref().is_some_and(|training| training.gate.is_closed())
    }

    /// Whether the training has stopped after it was asked to pause.
    pub fn is_at_rest(&self) -> bool {
        self.0.as_ref().is_some_and(|training| training.gate.is_holding())
    }

    /// Whether the training was told to end.
    pub fn is_cancelled(&self) -> bool {
        self.0.as_ref().is_some_and(|training| training.job.is_cancelled())
    }

    /// Pauses the training at its next report, or resumes it.
    pub fn set_paused(&self, is_paused: bool) {
        if let Some(training) = &self.0 {
            training.gate.set_closed(is_paused);
        }
    }

    /// Ends the training at its next report; it keeps the weights reached so far. A paused training
    /// is resumed so that it can end.
    pub fn cancel(&self) {
        if let Some(training) = &self.0 {
            training.job.cancel();
            training.gate.give_up();
        }
    }
}

impl<A: Send + 'static> TrainingSlot<A> {
    /// Starts a training. A training that is still running is cancelled and its result dropped.
    ///
    /// - `diary`: writes the note beside the checkpoint; `None` if there is no checkpoint;
    /// - `wake`: called after every report and at the end.
    ///
    /// # Errors
    /// The error of the operating system, if the thread cannot be started.
    pub fn start<Q: Question<Answer = A>>(
        &mut self,
        question: Q,
        diary: Option<TrainingDiary>,
        library: &Arc<Library>,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<()> {
        self.0 = Some(Training::start(question, diary, Arc::clone(library), wake)?);
        Ok(())
    }

    /// Returns the reports since the last call, and the end, if the training has ended; the slot is
    /// empty afterwards.
    pub fn poll(&mut self) -> (Vec<TrainingReport>, Option<TrainingEnd<A>>) {
        let Some(training) = &mut self.0 else { return (Vec::new(), None) };
        let (reports, end) = training.poll();
        if end.is_some() {
            self.0 = None;
        }
        (reports, end)
    }
}

/// Passes an event of the training on to the window, waits while the training is paused, and
/// returns whether to continue. It asks once more after the pause, because the user may have
/// cancelled meanwhile.
fn tell(
    event: &Event<'_>,
    sender: &Sender<TrainingReport>,
    gate: &Gate,
    report: &mut ProgressCallback<'_>,
) -> ControlFlow<()> {
    let progress = match event {
        Event::Progress(progress) => progress.clone(),
        Event::Training(report) => {
            // The send fails only if the receiver has been dropped with the training, which is
            // cancelled then.
            let _ = sender.send((*report).clone());
            Progress::default()
        }
        Event::Sampling(_) => Progress::default(),
    };
    if report(progress.clone()).is_break() {
        return ControlFlow::Break(());
    }
    gate.pass();
    report(progress)
}

/// Estimates the remaining time from the mean duration of the latest epochs.
///
/// - `seconds`: durations of the epochs so far in their order, s;
/// - `n_left`: number of epochs still to come.
pub fn time_left(seconds: impl DoubleEndedIterator<Item = f64>, n_left: usize) -> Option<Duration> {
    let latest: Vec<f64> = seconds.rev().take(PACE_EPOCHS).collect();
    let pace_s = latest.iter().sum::<f64>() / latest.len().max(1) as f64;
    Duration::try_from_secs_f64(pace_s * n_left as f64).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::jobs::Update;

    #[test]
    fn a_closed_gate_holds_until_it_is_opened() {
        let gate = Arc::new(Gate::default());
        gate.pass();
        gate.set_closed(true);
        let inner = Arc::clone(&gate);
        let mut job = Job::spawn("wait", || {}, move |_| inner.pass()).unwrap();
        while !gate.is_holding() {
            assert!(matches!(job.poll(), Update::Running));
            std::thread::yield_now();
        }
        assert!(gate.is_closed());
        gate.set_closed(false);
        assert!(matches!(job.wait(), Update::Finished(())));
        assert!(!gate.is_holding());
    }

    #[test]
    fn the_pace_is_that_of_the_latest_epochs() {
        let seconds = (0..100).map(|i| if i < 90 { 9.0 } else { 2.0 });
        assert_eq!(time_left(seconds, 3), Some(Duration::from_secs(6)));
    }
}
