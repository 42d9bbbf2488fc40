//! Answers questions on a thread of its own, so that the window keeps its pace: while a slider
//! moves, only the latest question is answered, and the last answer stays until the next one comes.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

use crate::jobs::{Job, Progress, Update};

/// Something to compute.
pub trait Question: Clone + Send + 'static {
    /// What comes out.
    type Answer: Send + 'static;
    /// Name of the thread.
    const NAME: &'static str;

    /// Whether the answer would be the same.
    fn is_same(&self, other: &Self) -> bool;

    /// Computes.
    ///
    /// # Errors
    /// A message for the user.
    fn answer(&self) -> Result<Self::Answer, String>;
}

/// The latest question and the latest answer.
pub struct Latest<Q: Question> {
    thread: Option<Thread<Q>>,
    /// What was asked last.
    pub asked: Option<Q>,
    /// The latest answer, or why there is none.
    pub answer: Option<Result<Arc<Q::Answer>, String>>,
}

struct Thread<Q: Question> {
    job: Job<()>,
    questions: Sender<Q>,
    answers: Receiver<Result<Q::Answer, String>>,
}

impl<Q: Question> Default for Latest<Q> {
    fn default() -> Self {
        Self { thread: None, asked: None, answer: None }
    }
}

impl<Q: Question> Latest<Q> {
    /// Takes in what was answered.
    pub fn poll(&mut self) {
        if let Some(answer) = self.thread.as_mut().and_then(Thread::answer) {
            self.answer = Some(answer.map(Arc::new));
        }
    }

    /// Asks, unless it was the last question. `wake` is called after every answer.
    pub fn ask(&mut self, question: Q, wake: impl Fn() + Send + 'static) {
        if self.asked.as_ref().is_some_and(|asked| asked.is_same(&question)) {
            return;
        }
        let is_asked = self.thread.as_ref().is_some_and(|thread| thread.ask(question.clone()));
        if !is_asked {
            match Thread::spawn(wake) {
                Ok(thread) => {
                    thread.ask(question.clone());
                    self.thread = Some(thread);
                }
                Err(error) => self.answer = Some(Err(error.to_string())),
            }
        }
        self.asked = Some(question);
    }

    /// Forgets question and answer.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    /// The answer, if there is one.
    pub fn ok(&self) -> Option<&Arc<Q::Answer>> {
        self.answer.as_ref()?.as_ref().ok()
    }
}

impl<Q: Question> Thread<Q> {
    fn spawn(wake: impl Fn() + Send + 'static) -> std::io::Result<Self> {
        let (questions, asked) = channel::<Q>();
        let (answer, answers) = channel();
        let job = Job::spawn(Q::NAME, wake, move |report| {
            let mut n_answers = 0;
            while let Ok(mut question) = asked.recv() {
                while let Ok(newer) = asked.try_recv() {
                    question = newer;
                }
                n_answers += 1;
                let progress = Progress::new(n_answers, 0, Q::NAME);
                if answer.send(question.answer()).is_err() || report(progress).is_break() {
                    break;
                }
            }
        })?;
        Ok(Self { job, questions, answers })
    }

    /// `false` if the thread is gone.
    fn ask(&self, question: Q) -> bool {
        self.questions.send(question).is_ok()
    }

    /// The latest answer since the last call. A panic comes as the inner error, after which the
    /// thread is gone.
    fn answer(&mut self) -> Option<Result<Q::Answer, String>> {
        let latest = self.answers.try_iter().last();
        match self.job.poll() {
            Update::Panicked(text) => Some(Err(format!("internal error: {text}"))),
            _ => latest,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[derive(Clone)]
    struct Halve(i32);

    impl Question for Halve {
        type Answer = i32;
        const NAME: &'static str = "halve";

        fn is_same(&self, other: &Self) -> bool {
            self.0 == other.0
        }

        fn answer(&self) -> Result<i32, String> {
            assert!(self.0 >= 0, "negative");
            if self.0 % 2 == 0 { Ok(self.0 / 2) } else { Err(format!("{} is odd", self.0)) }
        }
    }

    fn settled(latest: &mut Latest<Halve>) -> Option<Result<Arc<i32>, String>> {
        for _ in 0..1000 {
            latest.poll();
            if latest.answer.is_some() {
                return latest.answer.take();
            }
            std::thread::sleep(Duration::from_millis(2));
        }
        None
    }

    #[test]
    fn answers_problems_and_panics_come_back_and_questions_go_on() {
        let mut latest = Latest::default();
        latest.ask(Halve(8), || {});
        assert_eq!(settled(&mut latest), Some(Ok(Arc::new(4))));
        latest.ask(Halve(8), || {});
        latest.poll();
        assert!(latest.answer.is_none(), "the same question is not asked again");
        latest.ask(Halve(7), || {});
        assert_eq!(settled(&mut latest), Some(Err("7 is odd".to_owned())));
        latest.ask(Halve(-1), || {});
        let problem = settled(&mut latest).unwrap().unwrap_err();
        assert!(problem.contains("internal error"), "{problem}");
        latest.ask(Halve(2), || {});
        assert_eq!(settled(&mut latest), Some(Ok(Arc::new(1))));
    }
}
