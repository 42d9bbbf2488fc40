//! A training in the background: news while it runs, pause, cancel.
//!
//! The core knows one callback. Here it sends the news to the window and blocks while the training
//! is paused.

use std::ops::ControlFlow;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use crate::jobs::{Job, Progress, Report};
use crate::learning::TrainingReport;

/// Latest epochs by whose pace the time left is estimated.
const PACE_EPOCHS: usize = 10;

/// What a training tells the window.
#[derive(Debug, Clone, PartialEq)]
pub enum TrainingNews {
    /// A case that cannot be learned from, and why.
    LeftOut(String),
    /// How far the training has come.
    Report(TrainingReport),
}

/// A training under way: it gives a model of type `M` in the end.
pub struct Training<M> {
    job: Job<Result<M, String>>,
    news: Receiver<TrainingNews>,
    gate: Arc<Gate>,
}

/// Sends news to the window and says whether to go on.
pub type Tell<'a> = dyn FnMut(TrainingNews) -> ControlFlow<()> + 'a;

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

impl<M> Drop for Training<M> {
    fn drop(&mut self) {
        self.job.cancel();
        self.gate.set_closed(false);
    }
}

impl<M: Send + 'static> Training<M> {
    /// Starts one.
    ///
    /// # Errors
    /// The operating system's, if no thread can be started.
    pub fn start(
        wake: impl Fn() + Send + 'static,
        work: impl FnOnce(&mut Tell<'_>) -> Result<M, String> + Send + 'static,
    ) -> std::io::Result<Self> {
        let (sender, news) = channel();
        let gate = Arc::new(Gate::default());
        let own_gate = Arc::clone(&gate);
        let job = Job::spawn_in_background("train", wake, move |report| {
            work(&mut |news| tell(news, (&sender, &own_gate), report))
        })?;
        Ok(Self { job, news, gate })
    }

    /// What was told since the last time, and the end, if it has come.
    fn poll(&mut self) -> (Vec<TrainingNews>, Option<Result<M, String>>) {
        let update = self.job.poll(); // before the news: what it ends with comes after them
        (self.news.try_iter().collect(), update.into_result("the training"))
    }
}

/// A training, if one is under way.
pub struct TrainingSlot<M>(Option<Training<M>>);

impl<M> Default for TrainingSlot<M> {
    fn default() -> Self {
        Self(None)
    }
}

impl<M> From<Training<M>> for TrainingSlot<M> {
    fn from(training: Training<M>) -> Self {
        Self(Some(training))
    }
}

impl<M> TrainingSlot<M> {
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

    /// Stops before the next news, or goes on.
    pub fn set_paused(&self, is_paused: bool) {
        if let Some(training) = &self.0 {
            training.gate.set_closed(is_paused);
        }
    }

    /// Ends it at the next news, with the weights so far.
    pub fn cancel(&self) {
        if let Some(training) = &self.0 {
            training.job.cancel();
            training.gate.set_closed(false);
        }
    }
}

impl<M: Send + 'static> TrainingSlot<M> {
    /// What was told since the last time; with the end, if it has come, after which the slot is empty.
    pub fn poll(&mut self) -> (Vec<TrainingNews>, Option<Result<M, String>>) {
        let Some(training) = &mut self.0 else { return (Vec::new(), None) };
        let (news, result) = training.poll();
        if result.is_some() {
            self.0 = None;
        }
        (news, result)
    }
}

/// Sends news to the window, waits while paused, and asks whether to go on.
fn tell(
    news: TrainingNews,
    (sender, gate): (&Sender<TrainingNews>, &Gate),
    report: &mut Report<'_>,
) -> ControlFlow<()> {
    // A receiver that is gone means a dropped training, which is cancelled.
    let _ = sender.send(news);
    if report(Progress::default()).is_break() {
        return ControlFlow::Break(());
    }
    gate.pass();
    report(Progress::default())
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
