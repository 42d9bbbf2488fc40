//! Background work: a computation on a named thread, with progress, an estimate of the time left
//! and cancelling. A panic of the computation becomes a message. This module knows neither what is
//! computed nor the window; loading files, simulating whole data sets and training networks all run
//! through [`Job`].
//!
//! A long computation takes one callback, through which it reports its progress and learns whether
//! to go on:
//!
//! ```
//! use impactlab_core::jobs::{Job, Progress, Update};
//! use std::ops::ControlFlow;
//!
//! let mut job = Job::spawn("sum", || {}, |report| {
//!     let mut sum = 0u64;
//!     for i in 0..10 {
//!         sum += i;
//!         if report(Progress::new(i + 1, 10, "adding")).is_break() {
//!             break;
//!         }
//!     }
//!     sum
//! })
//! .expect("a thread can be started");
//! assert!(matches!(job.wait(), Update::Finished(45)));
//! ```

mod time_left;

use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, TryRecvError, channel};
use std::thread;
use std::time::{Duration, Instant};

use rayon::{ThreadPool, ThreadPoolBuilder};
use thread_priority::{ThreadPriority, set_current_thread_priority};

pub use time_left::TimeLeft;

/// The progress of a computation.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Progress {
    /// Number of units of work that are done.
    pub done: u64,
    /// How many of them were done before the computation began, by a run that it goes on with.
    pub done_before: u64,
    /// Number of all units of work; 0 while it is unknown.
    pub total: u64,
    /// Description of the current work, shown to the user.
    pub message: String,
}

/// The callback that a long computation calls to report its progress. If it breaks, the computation
/// stops as soon as possible.
pub type ProgressCallback<'a> = dyn FnMut(Progress) -> ControlFlow<()> + 'a;

impl Progress {
    /// Progress of `done` of `total` units of work, with a description of the current work; a
    /// `total` of 0 means that it is unknown.
    pub fn new(done: u64, total: u64, message: impl Into<String>) -> Self {
        Self { done, done_before: 0, total, message: message.into() }
    }

    /// The same of a computation that goes on with a run, in which some units of work were done.
    #[must_use]
    pub fn going_on_from(self, done_before: u64) -> Self {
        Self { done_before, ..self }
    }

    /// The share of the work that is done, 0 to 1; `None` while the total is unknown.
    pub fn fraction(&self) -> Option<f32> {
        (self.total > 0).then(|| (self.done as f32 / self.total as f32).min(1.0))
    }

    /// The estimated time left, if the rest of the work goes on at the same speed:
    ///
    /// ```text
    /// time left = elapsed · (total − done) / (done − done before)
    /// ```
    ///
    /// - `elapsed`: time since the start of the computation.
    /// - returns `None` if nothing is done yet or the total is unknown.
    pub fn time_left(&self, elapsed: Duration) -> Option<Duration> {
        let left = self.total.checked_sub(self.done)?;
        let done = self.done.checked_sub(self.done_before)?;
        (done > 0).then(|| elapsed.mul_f64(left as f64 / done as f64))
    }
}

/// The state of a [`Job`] when it is polled.
#[derive(Debug)]
pub enum Update<T> {
    /// The computation is still running; [`Job::progress`] is its latest progress.
    Running,
    /// The computation returned this value. It returns a value after a cancellation too.
    Finished(T),
    /// The computation panicked with this message.
    Panicked(String),
    /// The job has ended and its result was taken by an earlier call.
    Gone,
}

impl<T> Update<Result<T, String>> {
    /// The result of the computation, with a panic as an error; `None` while it is running.
    ///
    /// - `who`: description of the job, such as “the loader”, for the error if the result was taken
    ///   before.
    pub fn into_result(self, who: &str) -> Option<Result<T, String>> {
        match self {
            Self::Running => None,
            Self::Finished(result) => Some(result),
            Self::Panicked(text) => Some(Err(format!("internal error: {text}"))),
            Self::Gone => Some(Err(format!("{who} is gone"))),
        }
    }
}

/// A message from the thread of a job.
enum JobMessage<T> {
    /// The computation has reported its progress, at a time since its start.
    Progress(Progress, Duration),
    /// The computation has ended.
    End(Update<T>),
}

/// A computation on a thread of its own. Dropping the job cancels the computation.
#[derive(Debug)]
pub struct Job<T> {
    name: String,
    started: Instant,
    progress: Progress,
    time_left: TimeLeft,
    cancel: Arc<AtomicBool>,
    receiver: Receiver<JobMessage<T>>,
    ended: bool,
}

/// Creates a pool of as many threads as there are cores, with the lowest priority. If the operating
/// system refuses the priority, the threads have the normal one.
///
/// # Errors
/// The error of the operating system if the threads cannot be started.
fn background_threads(name: &str) -> std::io::Result<ThreadPool> {
    let name = name.to_owned();
    ThreadPoolBuilder::new()
        .thread_name(move |idx| format!("{name} {idx}"))
        .start_handler(|_| {
            let _ = set_current_thread_priority(ThreadPriority::Min);
        })
        .build()
        .map_err(std::io::Error::other)
}

impl<T: Send + 'static> Job<T> {
    /// Starts a computation on a new thread of normal priority, for results that the user waits
    /// for.
    ///
    /// - `name`: name of the thread.
    /// - `wake`: called after every report and at the end, so that a window that is idle polls the
    ///   job.
    /// - `work`: the computation, which receives the callback for its progress.
    ///
    /// # Errors
    /// The error of the operating system if the thread cannot be started.
    pub fn spawn(
        name: &str,
        wake: impl Fn() + Send + 'static,
        work: impl FnOnce(&mut ProgressCallback<'_>) -> T + Send + 'static,
    ) -> std::io::Result<Self> {
        Self::start(name, wake, work, |run| run())
    }

    /// Starts a computation that takes minutes on threads of its own with the lowest priority, so
    /// that the window remains responsive. What `work` computes in parallel by `rayon` runs on
    /// these threads too. The arguments are those of [`Job::spawn`].
    ///
    /// # Errors
    /// The error of the operating system if the threads cannot be started.
    pub fn spawn_in_background(
        name: &str,
        wake: impl Fn() + Send + 'static,
        work: impl FnOnce(&mut ProgressCallback<'_>) -> T + Send + 'static,
    ) -> std::io::Result<Self> {
        let threads = background_threads(name)?;
        Self::start(name, wake, work, move |run| threads.install(run))
    }

    /// Starts a computation on a new thread.
    ///
    /// - `on_threads`: runs the computation that it is given, on the current thread or on others.
    fn start(
        name: &str,
        wake: impl Fn() + Send + 'static,
        work: impl FnOnce(&mut ProgressCallback<'_>) -> T + Send + 'static,
        on_threads: impl FnOnce(Box<dyn FnOnce() + Send>) + Send + 'static,
    ) -> std::io::Result<Self> {
        let cancel = Arc::new(AtomicBool::new(false));
        let (sender, receiver) = channel();
        let cancelled = Arc::clone(&cancel);
        let started = Instant::now();
        let run = move || {
            let mut report = |progress: Progress| {
                // Sending fails only after the job was dropped, which has set the flag that is
                // tested below.
                let _ = sender.send(JobMessage::Progress(progress, started.elapsed()));
                wake();
                if cancelled.load(Ordering::Relaxed) {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            };
            let end = match catch_unwind(AssertUnwindSafe(|| work(&mut report))) {
                Ok(value) => Update::Finished(value),
                Err(payload) => Update::Panicked(panic_message(&*payload)),
            };
            let _ = sender.send(JobMessage::End(end));
            wake();
        };
        thread::Builder::new().name(name.to_owned()).spawn(move || on_threads(Box::new(run)))?;
        Ok(Self {
            name: name.to_owned(),
            started,
            progress: Progress::default(),
            time_left: TimeLeft::default(),
            cancel,
            receiver,
            ended: false,
        })
    }

    /// Takes all messages since the last call without waiting and returns the state of the job.
    pub fn poll(&mut self) -> Update<T> {
        loop {
            match self.receiver.try_recv() {
                Ok(message) => match self.take_in(message) {
                    Update::Running => {}
                    end => return end,
                },
                Err(TryRecvError::Empty) if !self.ended => return Update::Running,
                Err(_) => return Update::Gone,
            }
        }
    }

    /// Waits until the computation ends and returns its result, or [`Update::Gone`] if an earlier
    /// call has taken it.
    pub fn wait(&mut self) -> Update<T> {
        loop {
            match self.wait_for(Duration::from_secs(3600)) {
                Update::Running => {}
                end => return end,
            }
        }
    }

    /// Waits until the next report or the end of the computation, but no longer than `timeout`.
    pub fn wait_for(&mut self, timeout: Duration) -> Update<T> {
        if self.ended {
            return Update::Gone;
        }
        match self.receiver.recv_timeout(timeout) {
            Ok(message) => self.take_in(message),
            Err(RecvTimeoutError::Timeout) => Update::Running,
            Err(RecvTimeoutError::Disconnected) => Update::Gone,
        }
    }

    fn take_in(&mut self, message: JobMessage<T>) -> Update<T> {
        match message {
            JobMessage::Progress(progress, at) => {
                self.time_left.take(at, &progress);
                self.progress = progress;
                Update::Running
            }
            JobMessage::End(end) => {
                self.ended = true;
                end
            }
        }
    }
}

impl<T> Job<T> {
    /// The name with which the job was started.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The latest progress that [`Job::poll`], [`Job::wait`] or [`Job::wait_for`] has received.
    pub fn progress(&self) -> &Progress {
        &self.progress
    }

    /// Time since the start of the job.
    pub fn elapsed(&self) -> Duration {
        self.started.elapsed()
    }

    /// The estimated time left ([`TimeLeft`]).
    pub fn time_left(&self) -> Option<Duration> {
        self.time_left.at(self.started.elapsed())
    }

    /// Asks the computation to stop at its next report. The job still ends with the value that the
    /// computation returns.
    pub fn cancel(&self) {
        self.cancel.store(true, Ordering::Relaxed);
    }

    /// Whether [`Job::cancel`] was called.
    pub fn is_cancelled(&self) -> bool {
        self.cancel.load(Ordering::Relaxed)
    }
}

impl<T> Drop for Job<T> {
    fn drop(&mut self) {
        self.cancel();
    }
}

fn panic_message(payload: &(dyn std::any::Any + Send)) -> String {
    let text = payload.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| payload.downcast_ref::<String>().cloned())
        .unwrap_or_else(|| "a panic without a message".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn count_until_cancelled(report: &mut ProgressCallback<'_>) -> u64 {
        for step in 1.. {
            if report(Progress::new(step, 0, "counting")).is_break() {
                return step;
            }
            thread::sleep(Duration::from_millis(1));
        }
        0
    }

    #[test]
    fn a_cancelled_job_ends_with_its_value() {
        let mut job = Job::spawn("count", || {}, count_until_cancelled).unwrap();
        while job.progress().done < 3 {
            assert!(matches!(job.wait_for(Duration::from_secs(10)), Update::Running));
        }
        job.cancel();
        assert!(matches!(job.wait(), Update::Finished(steps) if steps >= 3));
        assert!(matches!(job.poll(), Update::Gone));
    }

    #[test]
    fn dropping_a_job_cancels_it() {
        let (sender, receiver) = channel();
        let job = Job::spawn(
            "count",
            || {},
            move |report| {
                let _ = sender.send(count_until_cancelled(report));
            },
        );
        drop(job);
        // A computation that does not stop would block the test here.
        assert!(receiver.recv().is_ok());
    }

    #[test]
    fn a_panic_becomes_a_message() {
        let jobs: [Job<()>; 2] = [
            Job::spawn("bad", || {}, |_| panic!("row {}", 7)).unwrap(),
            Job::spawn_in_background("bad", || {}, |_| panic!("row {}", 7)).unwrap(),
        ];
        for mut job in jobs {
            assert!(matches!(job.wait(), Update::Panicked(text) if text == "row 7"));
        }
    }

    #[test]
    fn work_in_the_background_stays_on_threads_of_its_own() {
        use rayon::prelude::*;
        let names = |_: &mut ProgressCallback<'_>| -> Vec<String> {
            let name = |_| thread::current().name().unwrap_or_default().to_owned();
            (0..64).into_par_iter().map(name).collect()
        };
        let mut job = Job::spawn_in_background("train", || {}, names).unwrap();
        let Update::Finished(names) = job.wait() else { panic!("no names") };
        assert!(names.iter().all(|name| name.starts_with("train ")), "{names:?}");
    }

    #[test]
    fn time_left_extrapolates() {
        let progress = Progress::new(25, 100, "");
        assert_eq!(progress.time_left(Duration::from_secs(10)), Some(Duration::from_secs(30)));
        assert_eq!(progress.fraction(), Some(0.25));
        assert_eq!(Progress::new(5, 0, "").time_left(Duration::from_secs(1)), None);
        let resumed = progress.going_on_from(20);
        assert_eq!(resumed.time_left(Duration::from_secs(10)), Some(Duration::from_secs(150)));
        let first = resumed.going_on_from(25);
        assert_eq!(first.time_left(Duration::from_secs(10)), None, "nothing was done yet");
    }
}
