//! Several trainings of the response network side by side, one on a core.
//!
//! A training follows its own path of random numbers, so that it gives the same network however many run
//! beside it.

use std::borrow::Cow;
use std::num::NonZero;
use std::ops::ControlFlow;
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
}

/// Fine-tunes a network on each set, as many at once as there are cores and memory for.
///
/// - `report`: called in this thread, with the number of the training and the epochs of all of them. Once it
///   breaks, every training ends after the epoch under way.
///
/// # Errors
/// That of the first training which fails; the others end after the epoch under way.
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
        for _ in 0..n_at_once {
            let (sender, next) = (sender.clone(), &next);
            scope.spawn(move || work(start, trainings, next, &sender));
        }
        drop(sender);
        listen(&messages, trainings.len(), n_at_once, report)
    })
}

/// Carries out one training after the other until none is left.
fn work(
    start: &ResponseModel,
    trainings: &[Training<'_>],
    next: &AtomicUsize,
    sender: &Sender<Message>,
) {
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
fn listen(
    messages: &Receiver<Message>,
    n_trainings: usize,
    n_at_once: usize,
    report: &mut TrainingProgress<'_>,
) -> Result<Vec<ResponseModel>, LearningError> {
    let mut flow = ControlFlow::Continue(());
    let mut failure = None;
    let mut n_done = vec![0; n_trainings];
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
            Message::End { idx, result } => match *result {
                Ok(model) => models[idx] = Some(model),
                Err(error) => {
                    flow = ControlFlow::Break(());
                    failure.get_or_insert(error);
                }
            },
        }
    }
    failure.map_or_else(|| Ok(models.into_iter().flatten().collect()), Err)
}

/// A report of a training, which says which one it is and how far all are.
fn numbered(
    report: TrainingReport,
    training_idx: usize,
    n_at_once: usize,
    n_done: &mut [usize],
) -> TrainingReport {
    match report {
        TrainingReport::Epoch(epoch) => {
            n_done[training_idx] = epoch.epoch_in_training();
            let n_done_elsewhere = n_done.iter().sum::<usize>() - epoch.epoch_in_training();
            TrainingReport::Epoch(EpochReport {
                training_idx,
                n_trainings: n_done.len(),
                n_done_elsewhere,
                n_at_once,
                ..epoch
            })
        }
        fit @ TrainingReport::Fit(_) => fit,
    }
}
