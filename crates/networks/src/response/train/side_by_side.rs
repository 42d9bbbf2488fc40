//! Several trainings of the response network side by side, one on a core.
//!
//! A training follows its own path of random numbers, so that it gives the same network however many run
//! beside it.

use std::borrow::Cow;
use std::num::NonZero;
use std::ops::ControlFlow;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};
use std::thread;

use crate::learning::{EpochReport, LearningError, TrainingProgress, TrainingReport};
use crate::response::memory::n_trainings_in_memory;
use crate::response::train::stages::fine_tune_once;
use crate::response::{ResponseModel, ResponseTrainSettings, ResponseTrainingSet};

/// A training: on which trajectories, and how.
pub(super) struct Training<'a> {
    pub set: Cow<'a, ResponseTrainingSet>,
    pub settings: ResponseTrainSettings,
}

/// What a training has to say.
enum Message {
    /// How far training `idx` is; it waits for whether it goes on.
    Progress { idx: usize, report: TrainingReport, answer: SyncSender<ControlFlow<()>> },
    /// What training `idx` has come to.
    End { idx: usize, result: Box<Result<ResponseModel, LearningError>> },
    /// A training has panicked.
    Panic,
}

/// Says of a thread that it panics, so that the others do not train on for nothing.
struct Alarm<'a>(&'a Sender<Message>);

impl Drop for Alarm<'_> {
    fn drop(&mut self) {
        if thread::panicking() {
            // Where nobody listens any more, the others end anyway.
            let _ = self.0.send(Message::Panic);
        }
    }
}

/// Fine-tunes a network on each set, as many at once as there are cores and memory for.
///
/// - `report`: called in this thread, with the number of the training and the epochs of all of them. Once it
///   breaks, every training ends after the epoch under way, and none begins any more.
/// - returns the networks in the order of the trainings; of those that have begun, if it was broken off, the
///   first one among them.
///
/// # Errors
/// That of the first training which fails; the others end as if it was broken off.
///
/// # Panics
/// As a training or `report` does, once the others have ended.
pub(super) fn fine_tune_side_by_side(
    start: &ResponseModel,
    trainings: &[Training<'_>],
    report: &mut TrainingProgress<'_>,
) -> Result<Vec<ResponseModel>, LearningError> {
    let n_in_memory =
        trainings.iter().map(|training| n_trainings_in_memory(&training.set.train)).min();
    let n_at_once = thread::available_parallelism()
        .map_or(1, NonZero::get)
        .min(trainings.len())
        .min(n_in_memory.unwrap_or(1));
    let next = AtomicUsize::new(0);
    let (sender, messages) = channel();
    thread::scope(|scope| {
        let spawn = |_| {
            let (sender, next) = (sender.clone(), &next);
            scope.spawn(move || work(start, trainings, next, &sender))
        };
        let threads: Vec<_> = (0..n_at_once).map(spawn).collect();
        drop(sender);
        let result = listen(messages, &next, [trainings.len(), n_at_once], report);
        for thread in threads {
            if let Err(panic) = thread.join() {
                resume_unwind(panic);
            }
        }
        result
    })
}

/// Carries out one training after the other until none is left.
fn work(
    start: &ResponseModel,
    trainings: &[Training<'_>],
    next: &AtomicUsize,
    sender: &Sender<Message>,
) {
    let _alarm = Alarm(sender);
    loop {
        let idx = next.fetch_add(1, Ordering::Relaxed);
        let Some(Training { set, settings }) = trainings.get(idx) else { return };
        let mut on_progress = |report: &TrainingReport| {
            let (answer, flow) = sync_channel(1);
            let message = Message::Progress { idx, report: report.clone(), answer };
            let is_heard = sender.send(message).is_ok();
            is_heard.then(|| flow.recv().ok()).flatten().unwrap_or(ControlFlow::Break(()))
        };
        let result = fine_tune_once(Some(start), set, settings, &mut on_progress);
        if sender.send(Message::End { idx, result: Box::new(result) }).is_err() {
            return;
        }
    }
}

/// Passes on what the trainings report until all have ended.
///
/// - `messages`: dropped where `report` panics, so that no training waits for an answer;
/// - `next`: the training that begins next.
fn listen(
    messages: Receiver<Message>,
    next: &AtomicUsize,
    [n_trainings, n_at_once]: [usize; 2],
    report: &mut TrainingProgress<'_>,
) -> Result<Vec<ResponseModel>, LearningError> {
    let mut flow = ControlFlow::Continue(());
    let mut failure = None;
    let mut n_done = vec![Some(0); n_trainings];
    let mut models: Vec<Option<ResponseModel>> = (0..n_trainings).map(|_| None).collect();
    for message in messages {
        match message {
            Message::Progress { idx, report: progress, answer } => {
                if flow.is_continue() {
                    flow = report(&numbered(progress, idx, n_at_once, &mut n_done));
                }
                // A training that no longer waits has ended.
                let _ = answer.send(flow);
            }
            Message::End { idx, result } => {
                n_done[idx] = None;
                match *result {
                    Ok(model) => models[idx] = Some(model),
                    Err(error) => {
                        flow = ControlFlow::Break(());
                        failure.get_or_insert(error);
                    }
                }
            }
            Message::Panic => flow = ControlFlow::Break(()),
        }
        if flow.is_break() {
            next.store(n_trainings, Ordering::Relaxed);
        }
    }
    failure.map_or_else(|| Ok(models.into_iter().flatten().collect()), Err)
}

/// A report of a training, which says which one it is and how far all are.
///
/// - `n_done`: epochs of each training that are over; `None` of one that has ended, which reported none if
///   its checkpoint had them all.
fn numbered(
    report: TrainingReport,
    training_idx: usize,
    n_at_once: usize,
    n_done: &mut [Option<usize>],
) -> TrainingReport {
    match report {
        TrainingReport::Epoch(epoch) => {
            n_done[training_idx] = Some(epoch.epoch_in_training());
            let of_each = n_done.iter().map(|n| n.unwrap_or(epoch.n_in_training()));
            let n_done_elsewhere = of_each.sum::<usize>() - epoch.epoch_in_training();
            TrainingReport::Epoch(EpochReport {
                training_idx,
                n_trainings: n_done.len(),
                n_done_elsewhere,
                rounds_left: Some(rounds_left(n_done, epoch.n_in_training(), n_at_once)),
                ..epoch
            })
        }
        fit @ TrainingReport::Fit(_) => fit,
    }
}

/// Epochs still to come one after the other of trainings that begin in their order, each as soon as one that
/// is under way has ended.
///
/// - `n_done`: epochs of each training that are over; `None` of one that has ended;
/// - `n_epochs`: epochs of each training.
fn rounds_left(n_done: &[Option<usize>], n_epochs: usize, n_at_once: usize) -> usize {
    let mut threads = vec![0; n_at_once.max(1)];
    for done in n_done.iter().flatten() {
        if let Some(first_free) = threads.iter_mut().min() {
            *first_free += n_epochs.saturating_sub(*done);
        }
    }
    threads.into_iter().max().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use std::panic::{AssertUnwindSafe, catch_unwind};
    use std::sync::mpsc::RecvError;

    use super::*;
    use crate::learning::EpochSummary;

    /// An epoch of ten.
    fn epoch(epoch: usize) -> TrainingReport {
        let summary = EpochSummary {
            epoch,
            stage: None,
            losses: Vec::new(),
            physics: None,
            learning_rate: 1e-3,
            gradient_norm: 1.0,
            seconds: None,
        };
        TrainingReport::Epoch(EpochReport {
            summary,
            n_before: 0,
            n_epochs: 10,
            best_epoch: None,
            training_idx: 0,
            n_trainings: 1,
            n_done_elsewhere: 0,
            rounds_left: None,
        })
    }

    /// A report of a training, and where that waits for the answer.
    fn progress(idx: usize) -> (Message, Receiver<ControlFlow<()>>) {
        let (answer, flow) = sync_channel(1);
        (Message::Progress { idx, report: epoch(1), answer }, flow)
    }

    /// Those that had not begun ran an epoch each after a training had failed or was broken off.
    #[test]
    fn once_one_fails_or_is_broken_off_none_begins_any_more() {
        let error = LearningError::TooFewCases { n_cases: 0, least: 1 };
        for failure in [Some(error), None] {
            let (sender, messages) = channel();
            let (next, fails) = (AtomicUsize::new(2), failure.is_some());
            if let Some(error) = failure {
                sender.send(Message::End { idx: 0, result: Box::new(Err(error)) }).unwrap();
            }
            let (message, flow) = progress(1);
            sender.send(message).unwrap();
            drop(sender);
            let mut n_told = 0;
            let mut report = |_: &TrainingReport| {
                n_told += 1;
                ControlFlow::Break(())
            };
            let result = listen(messages, &next, [5, 2], &mut report);
            assert_eq!(result.is_err(), fails);
            assert_eq!(n_told, usize::from(!fails));
            assert_eq!(flow.recv(), Ok(ControlFlow::Break(())));
            assert_eq!(next.into_inner(), 5);
        }
    }

    /// The last of several trainings was said to take a fraction of its time, as if others shared its epochs.
    #[test]
    fn a_training_that_is_left_alone_takes_all_of_its_epochs() {
        for (n_done, expected) in [
            (vec![Some(0); 4], 20),
            (vec![Some(5), Some(3), Some(0)], 15),
            (vec![None, None, Some(4)], 6),
            (vec![None, Some(10), None], 0),
        ] {
            assert_eq!(rounds_left(&n_done, 10, 2), expected, "{n_done:?}");
        }
    }

    #[test]
    fn a_report_that_panics_leaves_no_training_waiting() {
        let (sender, messages) = channel();
        let (first, _first_flow) = progress(0);
        let (second, flow) = progress(1);
        sender.send(first).unwrap();
        sender.send(second).unwrap();
        let next = AtomicUsize::new(2);
        let mut report =
            |_: &TrainingReport| -> ControlFlow<()> { panic!("standard output is closed") };
        let listening = || listen(messages, &next, [5, 2], &mut report).is_ok();
        assert!(catch_unwind(AssertUnwindSafe(listening)).is_err());
        assert_eq!(flow.recv(), Err(RecvError));
        let (third, _flow) = progress(0);
        assert!(sender.send(third).is_err());
    }

    #[test]
    fn a_training_that_panics_ends_the_others() {
        let (sender, messages) = channel();
        let panicking = AssertUnwindSafe(|| -> bool {
            let _alarm = Alarm(&sender);
            panic!("a training");
        });
        assert!(catch_unwind(panicking).is_err());
        let (message, flow) = progress(1);
        sender.send(message).unwrap();
        drop(sender);
        let next = AtomicUsize::new(2);
        let mut report = |_: &TrainingReport| ControlFlow::Continue(());
        assert!(listen(messages, &next, [5, 2], &mut report).is_ok());
        assert_eq!(flow.recv(), Ok(ControlFlow::Break(())));
        assert_eq!(next.into_inner(), 5);
    }

    /// The share that was done stayed below one where a checkpoint had all epochs of a part.
    #[test]
    fn a_training_that_reported_nothing_counts_once_it_has_ended() {
        let mut n_done = [Some(0), None, Some(4)];
        let TrainingReport::Epoch(told) = numbered(epoch(6), 0, 2, &mut n_done) else {
            panic!("no epoch");
        };
        assert_eq!(told.progress(), (20, 30));
        assert_eq!(n_done, [Some(6), None, Some(4)]);
    }
}
