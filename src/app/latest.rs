//! Answers short questions on a separate thread, so that the window does not wait for them.
//!
//! If questions arrive faster than they are answered, as while a slider is moved, only the latest
//! one is answered. The last answer remains available until the next one arrives. A question whose
//! answer takes long is first answered coarsely ([`Question::coarse`]).

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::{Duration, Instant};

use impactlab_core::data::Outcome;
use impactlab_core::error_chain;
use impactlab_core::jobs::{Job, Progress, Update};
use impactlab_study::{Event, Library, Question};

/// The shortest time for which a person sees something.
const SEEN: Duration = Duration::from_millis(100);

/// The answer to a question, or a message that says why there is none.
pub type AnswerResult<Q> = Result<Arc<<Q as Question>::Answer>, String>;

/// The latest question of one kind and the latest answer to it.
pub struct Latest<Q: Question> {
    thread: Option<Thread<Q>>,
    n_questions: u64,
    n_answered: u64,
    /// Number of the latest question whose answer is not to be shown.
    n_dropped: u64,
    /// When the question that was asked last was asked, or the one after whose answer it was.
    question_at: Option<Instant>,
    /// Number of the question of another kind after whose answer the last one was asked.
    n_before: u64,
    /// The question that was asked last.
    pub question: Option<Q>,
    /// The latest answer, or the reason why there is none. It belongs to `question` unless
    /// [`Latest::is_waiting`].
    pub answer: Option<AnswerResult<Q>>,
    /// Number of the latest question that is answered in part, [`Question::IS_COARSE_PART`].
    n_in_part: u64,
    /// The latest coarse answer with the number of its question, until that is answered in full.
    coarse: Option<(u64, Arc<Q::Answer>)>,
}

/// An answer on its way from the thread.
enum Sent<Q: Question> {
    Coarse(Arc<Q::Answer>),
    Full(AnswerResult<Q>),
}

struct Thread<Q: Question> {
    job: Job<()>,
    questions: Sender<(u64, Q)>,
    answers: Receiver<(u64, Sent<Q>)>,
}

impl<Q: Question> Default for Latest<Q> {
    fn default() -> Self {
        Self {
            thread: None,
            n_questions: 0,
            n_answered: 0,
            n_dropped: 0,
            question_at: None,
            n_before: 0,
            question: None,
            answer: None,
            n_in_part: 0,
            coarse: None,
        }
    }
}

impl<Q: Question> Latest<Q> {
    /// Receives the answers that have arrived and keeps the latest. A panic of the thread becomes
    /// an answer with an error, and the next question starts a new thread.
    pub fn poll(&mut self) {
        let Some(thread) = &mut self.thread else { return };
        for (number, sent) in thread.answers.try_iter() {
            let is_shown = number > self.n_dropped;
            match sent {
                Sent::Coarse(answer) if is_shown && Q::IS_COARSE_PART => {
                    (self.n_in_part, self.answer) = (number, Some(Ok(answer)));
                }
                Sent::Coarse(answer) if is_shown => self.coarse = Some((number, answer)),
                Sent::Coarse(_) => {}
                Sent::Full(answer) => {
                    (self.n_answered, self.coarse) = (number, None);
                    if is_shown {
                        self.answer = Some(answer);
                    }
                }
            }
        }
        if let Update::Panicked(text) = thread.job.poll() {
            (self.thread, self.coarse) = (None, None);
            self.n_answered = self.n_questions;
            self.answer = Some(Err(format!("internal error: {text}")));
        }
    }

    /// Asks a question, unless it equals the question that was asked last.
    ///
    /// - `library`: data and models that the question refers to; the thread keeps the library with
    ///   which it was started;
    /// - `wake`: called after every answer; the thread keeps the callback with which it was
    ///   started.
    pub fn ask(&mut self, question: Q, library: &Arc<Library>, wake: impl Fn() + Send + 'static) {
        if self.question.as_ref() == Some(&question) {
            return;
        }
        self.n_questions += 1;
        self.question_at = Some(Instant::now());
        let numbered = (self.n_questions, question.clone());
        self.question = Some(question);
        let is_sent = self
            .thread
            .as_ref()
            .is_some_and(|thread| thread.questions.send(numbered.clone()).is_ok());
        if is_sent {
            return;
        }
        match Thread::spawn(Arc::clone(library), wake) {
            Ok(thread) => {
                // The send cannot fail, because the thread has just been started and waits for its
                // first question.
                let _ = thread.questions.send(numbered);
                self.thread = Some(thread);
            }
            Err(error) => {
                self.n_answered = self.n_questions;
                self.answer = Some(Err(error.to_string()));
            }
        }
    }

    /// Asks a question that follows from the answer to another one, unless it equals the question that was
    /// asked last. What is shown is out of date since that one was asked.
    ///
    /// - `before`: the other question with its answer.
    pub fn ask_after<P: Question>(
        &mut self,
        before: &Latest<P>,
        question: Q,
        library: &Arc<Library>,
        wake: impl Fn() + Send + 'static,
    ) {
        let n_questions = self.n_questions;
        self.ask(question, library, wake);
        if self.n_questions != n_questions && self.n_before != before.n_questions {
            self.question_at = before.question_at;
        }
        self.n_before = before.n_questions;
    }

    /// Whether the answer to the latest question has not arrived yet.
    pub fn is_waiting(&self) -> bool {
        self.n_questions != self.n_answered
    }

    /// Whether the answer to the latest question has not arrived for so long that a person sees it: an
    /// older answer that is still shown has to be marked then. What is shown of the latest question is
    /// not marked, though a part of it is still to come.
    pub fn is_late(&self) -> bool {
        self.is_unfinished() && self.n_in_part != self.n_questions
    }

    /// Whether all of the answer to the latest question has not arrived for so long that a person sees
    /// it: what is asked only after it, and is still shown, is not of what is asked any more.
    pub fn is_unfinished(&self) -> bool {
        self.is_waiting() && self.question_at.is_some_and(|at| at.elapsed() > SEEN)
    }

    /// The coarse answer that there is until the question is answered in full, and whether it is to the
    /// question that was asked last.
    pub fn coarse(&self) -> Option<(&Arc<Q::Answer>, bool)> {
        self.coarse.as_ref().map(|(number, answer)| (answer, *number == self.n_questions))
    }

    /// Drops the answer, and that to a question under way, which belong to something else than what is
    /// asked next.
    pub fn drop_answer(&mut self) {
        self.coarse = None;
        self.answer = None;
        self.question = None;
        self.n_dropped = self.n_questions;
    }

    /// Allows the same question to be asked again, because the files or models that it refers to
    /// have changed.
    pub fn ask_again(&mut self) {
        self.question = None;
    }

    /// Drops the question, the answer and the thread.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    /// Why there is no answer to the latest question that was answered.
    pub fn problem(&self) -> Option<&str> {
        self.answer.as_ref()?.as_ref().err().map(String::as_str)
    }

    /// Returns the latest answer, if it is not an error. While [`Latest::is_waiting`], it belongs
    /// to an earlier question.
    pub fn ok(&self) -> Option<&Arc<Q::Answer>> {
        self.answer.as_ref()?.as_ref().ok()
    }
}

impl<Q: Question> Thread<Q> {
    fn spawn(library: Arc<Library>, wake: impl Fn() + Send + 'static) -> std::io::Result<Self> {
        let (questions, received) = channel::<(u64, Q)>();
        let (answer, answers) = channel();
        let job = Job::spawn(Q::NAME, wake, move |report| {
            let mut next = None;
            while let Some(mut latest) = next.take().or_else(|| received.recv().ok()) {
                while let Ok(newer) = received.try_recv() {
                    latest = newer;
                }
                let (number, question) = latest;
                let mut observer = |event: Event<'_>| match event {
                    Event::Progress(progress) => report(progress),
                    Event::Training(_) | Event::Sampling(_) => ControlFlow::Continue(()),
                };
                // What is wrong with the question is said by the full answer.
                let coarse = question.coarse().map(|coarse| coarse.answer(&library, &mut observer));
                if let Some(Ok(Outcome::Complete(found))) = coarse {
                    let is_sent = answer.send((number, Sent::Coarse(Arc::new(found)))).is_ok();
                    if !is_sent || observer(Event::Progress(Progress::default())).is_break() {
                        break;
                    }
                    next = received.try_recv().ok();
                    if next.is_some() {
                        continue;
                    }
                }
                let result = match question.answer(&library, &mut observer) {
                    Ok(Outcome::Complete(found)) => Ok(Arc::new(found)),
                    Ok(Outcome::Cancelled) => break,
                    Err(error) => Err(error_chain(&error)),
                };
                if answer.send((number, Sent::Full(result))).is_err()
                    || report(Progress::default()).is_break()
                {
                    break;
                }
            }
        })?;
        Ok(Self { job, questions, answers })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_study::{Observer, StudyError};
    #[derive(Clone, PartialEq)]
    struct Halve(i32);

    impl Question for Halve {
        type Answer = i32;
        type Report = i32;
        const NAME: &'static str = "halve";

        fn check(&self) -> Result<(), StudyError> {
            Ok(())
        }

        fn coarse(&self) -> Option<Self> {
            (self.0 >= 100 && self.0 % 2 == 0 && self.0 % 20 != 0).then(|| Self(self.0 / 20 * 20))
        }

        fn report(answer: &i32) -> &i32 {
            answer
        }

        fn solve(
            &self,
            _library: &Library,
            _observer: &mut Observer<'_>,
        ) -> Result<Outcome<i32>, StudyError> {
            assert!(self.0 >= 0, "negative");
            if self.0 >= 100 && self.coarse().is_some() {
                std::thread::sleep(Duration::from_millis(500));
            }
            match self.0 % 2 {
                0 => Ok(Outcome::Complete(self.0 / 2)),
                _ => Err(StudyError::NotHeld { name: self.0.to_string() }),
            }
        }
    }

    /// The same, of which the coarse answer is a part of the full one.
    #[derive(Clone, PartialEq)]
    struct HalveInPart(i32);

    impl Question for HalveInPart {
        type Answer = i32;
        type Report = i32;
        const NAME: &'static str = "halve in part";
        const IS_COARSE_PART: bool = true;

        fn check(&self) -> Result<(), StudyError> {
            Ok(())
        }

        fn coarse(&self) -> Option<Self> {
            Halve(self.0).coarse().map(|Halve(number)| Self(number))
        }

        fn report(answer: &i32) -> &i32 {
            answer
        }

        fn solve(
            &self,
            library: &Library,
            observer: &mut Observer<'_>,
        ) -> Result<Outcome<i32>, StudyError> {
            Halve(self.0).solve(library, observer)
        }
    }

    /// What is shown of the latest question is not marked as late, though the rest is awaited.
    #[test]
    fn a_part_of_the_answer_stands_for_it_until_all_of_it_comes() {
        let mut latest = Latest::default();
        latest.ask(HalveInPart(146), &Arc::default(), || {});
        for _ in 0..1000 {
            latest.poll();
            if latest.ok().is_some() {
                break;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
        assert_eq!(latest.ok().map(|answer| **answer), Some(70));
        assert!(latest.is_waiting() && latest.coarse().is_none());
        std::thread::sleep(2 * SEEN);
        assert!(!latest.is_late() && latest.is_unfinished());
        for _ in 0..1000 {
            latest.poll();
            if !latest.is_waiting() {
                break;
            }
            std::thread::sleep(Duration::from_millis(2));
        }
        assert_eq!(latest.ok().map(|answer| **answer), Some(73));
        assert!(!latest.is_unfinished());
    }

    fn ask(latest: &mut Latest<Halve>, number: i32) {
        latest.ask(Halve(number), &Arc::default(), || {});
    }

    fn settled(latest: &mut Latest<Halve>) -> Option<Result<Arc<i32>, String>> {
        for _ in 0..1000 {
            latest.poll();
            if !latest.is_waiting() {
                return latest.answer.take();
            }
            std::thread::sleep(Duration::from_millis(2));
        }
        None
    }

    /// A number from 100 on is halved coarsely first: to a multiple of 10.
    #[test]
    fn a_coarse_answer_comes_first_and_goes_with_the_full_one() {
        let mut latest = Latest::default();
        ask(&mut latest, 146);
        for _ in 0..1000 {
            latest.poll();
            if latest.coarse().is_some() || !latest.is_waiting() {
                break;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
        let (answer, is_latest) = latest.coarse().expect("the coarse answer");
        assert_eq!((**answer, is_latest), (70, true));
        assert!(latest.is_waiting() && latest.ok().is_none());
        assert_eq!(settled(&mut latest), Some(Ok(Arc::new(73))));
        assert!(latest.coarse().is_none());
        // A question that cannot be answered coarsely is answered in full.
        ask(&mut latest, 147);
        assert_eq!(settled(&mut latest), Some(Err("there is no model \"147\"".to_owned())));
    }

    /// A forecast of an earlier question was shown as if it were of the present one, whenever the simulation
    /// that it waits for had come.
    #[test]
    fn what_waits_for_another_answer_is_out_of_date_since_that_was_asked_for() {
        let (mut before, mut after) = (Latest::default(), Latest::default());
        ask(&mut before, 8);
        std::thread::sleep(2 * SEEN);
        assert!(settled(&mut before).is_some());
        after.ask_after(&before, Halve(146), &Arc::default(), || {});
        assert!(after.is_late());
        after.ask_after(&before, Halve(166), &Arc::default(), || {});
        assert!(after.is_waiting() && !after.is_late(), "it has changed by itself");
    }

    #[test]
    fn answers_problems_and_panics_come_back_and_questions_go_on() {
        let mut latest = Latest::default();
        ask(&mut latest, 8);
        assert_eq!(settled(&mut latest), Some(Ok(Arc::new(4))));
        ask(&mut latest, 8);
        assert!(!latest.is_waiting(), "the same question is not asked again");
        latest.ask_again();
        ask(&mut latest, 8);
        assert!(latest.is_waiting(), "unless what it refers to has changed");
        assert_eq!(settled(&mut latest), Some(Ok(Arc::new(4))));
        ask(&mut latest, 7);
        assert_eq!(settled(&mut latest), Some(Err("there is no model \"7\"".to_owned())));
        ask(&mut latest, -1);
        let problem = settled(&mut latest).unwrap().unwrap_err();
        assert!(problem.contains("internal error"), "{problem}");
        ask(&mut latest, 2);
        assert_eq!(settled(&mut latest), Some(Ok(Arc::new(1))));
    }
}
