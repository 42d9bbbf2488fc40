//! Answers questions that take seconds to minutes, in the background: with progress, with a way to
//! cancel, and with the latest answer kept beside the question that it belongs to.

use std::ops::ControlFlow;
use std::sync::Arc;

use crate::app::latest::AnswerResult;
use impactlab_core::data::Outcome;
use impactlab_core::error_chain;
use impactlab_core::jobs::Job;
use impactlab_study::{Event, Library, Question};

/// A question with its answer, or with the reason why there is none.
pub struct Answered<Q: Question> {
    /// The question that was asked.
    pub question: Q,
    /// The answer, or the reason why there is none.
    pub answer: AnswerResult<Q>,
}

/// The thread that answers a question.
type AnswerJob<Q> = Job<Result<Outcome<<Q as Question>::Answer>, String>>;

/// A question that is being answered, and the latest one that has been answered.
pub struct QuestionJob<Q: Question> {
    running: Option<(Q, AnswerJob<Q>)>,
    /// The latest question that was answered or could not be answered. A question that was
    /// cancelled does not replace it.
    pub latest: Option<Answered<Q>>,
}

impl<Q: Question> Default for QuestionJob<Q> {
    fn default() -> Self {
        Self { running: None, latest: None }
    }
}

impl<Q: Question> QuestionJob<Q> {
    /// Starts to answer a question. A question that is still being answered is cancelled.
    ///
    /// - `wake`: called after every report of progress and at the end.
    ///
    /// # Errors
    /// The error of the operating system, if the thread cannot be started.
    pub fn start(
        &mut self,
        question: Q,
        library: &Arc<Library>,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<()> {
        self.start_watched(question, library, wake, |_| {})
    }

    /// The same with all that happens told to a watcher, on the thread that answers the question.
    ///
    /// # Errors
    /// The error of the operating system, if the thread cannot be started.
    pub fn start_watched(
        &mut self,
        question: Q,
        library: &Arc<Library>,
        wake: impl Fn() + Send + 'static,
        mut watch: impl FnMut(&Event<'_>) + Send + 'static,
    ) -> std::io::Result<()> {
        let (request, library) = (question.clone(), Arc::clone(library));
        let job = Job::spawn_in_background(Q::NAME, wake, move |report| {
            let mut observer = |event: Event<'_>| {
                watch(&event);
                match event {
                    Event::Progress(progress) => report(progress),
                    Event::Training(_) | Event::Sampling(_) => ControlFlow::Continue(()),
                }
            };
            request.answer(&library, &mut observer).map_err(|error| error_chain(&error))
        })?;
        self.running = Some((question, job));
        Ok(())
    }

    /// Returns the running job, which knows its progress.
    pub fn job(&self) -> Option<&AnswerJob<Q>> {
        self.running.as_ref().map(|(_, job)| job)
    }

    /// Whether a question is being answered.
    pub fn is_running(&self) -> bool {
        self.running.is_some()
    }

    /// Cancels the running question. The latest answer is kept.
    pub fn cancel(&self) {
        if let Some(job) = self.job() {
            job.cancel();
        }
    }

    /// Receives the result, if the job has ended. Returns whether there is a new answer or a new
    /// problem; a cancelled question gives neither.
    pub fn poll(&mut self) -> bool {
        let Some((_, job)) = &mut self.running else { return false };
        let Some(result) = job.poll().into_result("the answer") else { return false };
        let Some((question, _)) = self.running.take() else { return false };
        let answer = match result {
            Ok(Outcome::Cancelled) => return false,
            Ok(Outcome::Complete(answer)) => Ok(Arc::new(answer)),
            Err(problem) => Err(problem),
        };
        self.latest = Some(Answered { question, answer });
        true
    }

    /// Returns the latest answer, if it is not an error.
    pub fn ok(&self) -> Option<&Arc<Q::Answer>> {
        self.latest.as_ref()?.answer.as_ref().ok()
    }

    /// Returns the reason why the latest question has no answer.
    pub fn problem(&self) -> Option<&str> {
        self.latest.as_ref()?.answer.as_ref().err().map(String::as_str)
    }
}
