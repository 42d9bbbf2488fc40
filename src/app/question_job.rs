//! A question that takes a while, answered in the background: progress, cancel, and the latest
//! answer with the question that it belongs to.

use std::ops::ControlFlow;
use std::sync::Arc;

use crate::app::latest::AnswerResult;
use crate::data::Outcome;
use crate::error_chain;
use crate::jobs::Job;
use crate::study::{Event, Library, Question};

/// A question with its answer, or with the reason why there is none.
pub struct Answered<Q: Question> {
    /// What was asked.
    pub question: Q,
    /// What was answered.
    pub answer: AnswerResult<Q>,
}

type AnswerJob<Q> = Job<Result<Outcome<<Q as Question>::Answer>, String>>;

/// The question that is being answered, and the latest one that was.
pub struct QuestionJob<Q: Question> {
    running: Option<(Q, AnswerJob<Q>)>,
    /// The latest question that was answered or could not be answered. A cancelled question leaves
    /// the one before it here.
    pub latest: Option<Answered<Q>>,
}

impl<Q: Question> Default for QuestionJob<Q> {
    fn default() -> Self {
        Self { running: None, latest: None }
    }
}

impl<Q: Question> QuestionJob<Q> {
    /// Starts to answer a question; one that is being answered is cancelled.
    ///
    /// # Errors
    /// The operating system's, if no thread can be started.
    pub fn start(
        &mut self,
        question: Q,
        library: &Arc<Library>,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<()> {
        let (asked, library) = (question.clone(), Arc::clone(library));
        let job = Job::spawn_in_background(Q::NAME, wake, move |report| {
            let mut observer = |event: Event<'_>| match event {
                Event::Progress(progress) => report(progress),
                Event::Training(_) => ControlFlow::Continue(()),
            };
            asked.answer(&library, &mut observer).map_err(|error| error_chain(&error))
        })?;
        self.running = Some((question, job));
        Ok(())
    }

    /// The job that is under way, for its progress.
    pub fn job(&self) -> Option<&AnswerJob<Q>> {
        self.running.as_ref().map(|(_, job)| job)
    }

    /// Whether a question is being answered.
    pub fn is_running(&self) -> bool {
        self.running.is_some()
    }

    /// Stops answering; the latest answer stays.
    pub fn cancel(&self) {
        if let Some(job) = self.job() {
            job.cancel();
        }
    }

    /// Takes in what has come to an end; whether there is a new answer or a new problem.
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

    /// The latest answer, if there is one.
    pub fn ok(&self) -> Option<&Arc<Q::Answer>> {
        self.latest.as_ref()?.answer.as_ref().ok()
    }

    /// Why the latest question has no answer.
    pub fn problem(&self) -> Option<&str> {
        self.latest.as_ref()?.answer.as_ref().err().map(String::as_str)
    }
}
