//! A training in the background: reports while it runs, pause, cancel.
//!
//! A training question knows one observer. Here it sends the reports to the window and blocks while
//! the training is paused.

use std::ops::ControlFlow;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use crate::data::Outcome;
use crate::error_chain;
use crate::jobs::{Job, Progress, ProgressCallback};
use crate::learning::TrainingReport;
use crate::study::{Event, Library, Question};

/// Latest epochs by whose pace the time left is estimated.
const PACE_EPOCHS: usize = 10;

/// A training under way: it gives an answer of type `A` in the end, and reports before.
pub struct Training<A> {
    job: Job<Result<Outcome<A>, String>>,
    reports: Receiver<TrainingReport>,
    gate: Arc<Gate>,
}

/// How a training ended.
pub enum TrainingEnd<A> {
    /// As it was asked for.
    Complete(A),
    /// Early, because the user cancelled it: with the weights so far, if there were any.
    Cancelled(Option<A>),
    /// With an error, for the user.
    Failed(String),
}

/// Holds a thread up while it is closed.
#[derive(Default)]
struct Gate {
    state: Mutex<GateState>,
    changed: Condvar,
}

#[derive(Default)]
struct GateState {
    is_closed: bool,
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

    fn is_closed(&self) -> bool {
        self.state().is_closed
    }

    /// Whether a thread is being held up.
    fn is_holding(&self) -> bool {
        self.state().is_held
    }

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
        library: Arc<Library>,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<Self> {
        let (sender, reports) = channel();
        let gate = Arc::new(Gate::default());
        let own_gate = Arc::clone(&gate);
        let job = Job::spawn_in_background(Q::NAME, wake, move |report| {
            let mut observer = |event: Event<'_>| tell(&event, (&sender, &own_gate), report);
            question.answer(&library, &mut observer).map_err(|error| error_chain(&error))
        })?;
        Ok(Self { job, reports, gate })
    }

    /// What was reported since the last time, and the end, if it has come.
    fn poll(&mut self) -> (Vec<TrainingReport>, Option<TrainingEnd<A>>) {
        let update = self.job.poll(); // before the reports: what it ends with comes after them
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

/// A training, if one is under way.
pub struct TrainingSlot<A>(Option<Training<A>>);

impl<A> Default for TrainingSlot<A> {
    fn default() -> Self {
        Self(None)
    }
}

impl<A> TrainingSlot<A> {
    /// Whether a training is under way, paused or not.
    pub fn is_running(&self) -> bool {
        self.0.is_some()
    }

    /// Whether it was asked to pause: the epoch under way comes to its end first.
    pub fn is_paused(&self) -> bool {
        self.0.as_ref().is_some_and(|training| training.gate.is_closed())
    }

    /// Whether it has come to rest after it was asked to pause.
    pub fn is_at_rest(&self) -> bool {
        self.0.as_ref().is_some_and(|training| training.gate.is_holding())
    }

    /// Whether it was told to stop.
    pub fn is_cancelled(&self) -> bool {
        self.0.as_ref().is_some_and(|training| training.job.is_cancelled())
    }

    /// Stops before the next report, or goes on.
    pub fn set_paused(&self, is_paused: bool) {
        if let Some(training) = &self.0 {
            training.gate.set_closed(is_paused);
        }
    }

    /// Ends it at the next report, with the weights so far.
    pub fn cancel(&self) {
        if let Some(training) = &self.0 {
            training.job.cancel();
            training.gate.set_closed(false);
        }
    }
}

impl<A: Send + 'static> TrainingSlot<A> {
    /// Starts a training; one that is under way is dropped.
    ///
    /// # Errors
    /// The operating system's, if no thread can be started.
    pub fn start<Q: Question<Answer = A>>(
        &mut self,
        question: Q,
        library: &Arc<Library>,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<()> {
        self.0 = Some(Training::start(question, Arc::clone(library), wake)?);
        Ok(())
    }

    /// What was reported since the last time; with the end, if it has come, after which the slot is
    /// empty.
    pub fn poll(&mut self) -> (Vec<TrainingReport>, Option<TrainingEnd<A>>) {
        let Some(training) = &mut self.0 else { return (Vec::new(), None) };
        let (reports, end) = training.poll();
        if end.is_some() {
            self.0 = None;
        }
        (reports, end)
    }
}

/// Sends reports to the window, waits while paused, and asks whether to go on.
fn tell(
    event: &Event<'_>,
    (sender, gate): (&Sender<TrainingReport>, &Gate),
    report: &mut ProgressCallback<'_>,
) -> ControlFlow<()> {
    let progress = match event {
        Event::Progress(progress) => progress.clone(),
        Event::Training(told) => {
            // A receiver that is gone means a dropped training, which is cancelled.
            let _ = sender.send((*told).clone());
            Progress::default()
        }
    };
    if report(progress.clone()).is_break() {
        return ControlFlow::Break(());
    }
    gate.pass();
    report(progress)
}

/// The time left at the pace of the latest epochs.
///
/// - `seconds`: of the epochs so far, the last one last; `n_left`: epochs to come.
pub fn time_left(seconds: impl DoubleEndedIterator<Item = f64>, n_left: usize) -> Option<Duration> {
    let latest: Vec<f64> = seconds.rev().take(PACE_EPOCHS).collect();
    let pace_s = latest.iter().sum::<f64>() / latest.len().max(1) as f64;
    Duration::try_from_secs_f64(pace_s * n_left as f64).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::jobs::Update;

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
