//! What a question is: something plain that can be asked, watched while it is answered, and
//! cancelled.

use std::ops::ControlFlow;

use serde::Serialize;

use crate::ask::finite::{NotFinite, first_not_finite};
use crate::{Library, StudyError};
use impactlab_core::data::Outcome;
use impactlab_core::jobs::Progress;
use impactlab_networks::learning::TrainingReport;
use impactlab_reconstruct::ReconstructionTarget;

/// What happens while a question is answered.
#[derive(Debug)]
pub enum Event<'a> {
    /// Work of known length goes on.
    Progress(Progress),
    /// A training goes on.
    Training(&'a TrainingReport),
    /// The particles of a reconstruction have moved.
    Sampling(Sampling<'a>),
}

/// The particles of a reconstruction while they move towards the posterior. They are not the answer.
#[derive(Debug, Clone, Copy)]
pub struct Sampling<'a> {
    /// The posterior.
    pub target: &'a ReconstructionTarget,
    /// Power of the likelihood that they have reached, 0 to 1.
    pub temperature: f64,
    /// The present particles, `[n][dim]`: their number varies.
    pub z: &'a [Vec<f64>],
}

/// The callback that is told of every [`Event`] and says whether to go on.
pub type Observer<'a> = dyn FnMut(Event<'_>) -> ControlFlow<()> + 'a;

/// A question with everything that its answer depends on, files excepted.
///
/// The same question, asked of the same files, has the same answer: seeds are part of the question.
pub trait Question: Clone + PartialEq + Send + 'static {
    /// The answer: its report, and what the report was made from.
    type Answer: Send + Sync + 'static;

    /// What is told of the answer.
    type Report: Serialize;

    /// What is being done, for the name of a thread.
    const NAME: &'static str;

    /// Checks every number of the question against the table of [`ranges`](impactlab_core::ranges), without
    /// reading a file.
    ///
    /// # Errors
    /// [`StudyError::OutOfRange`] with the first number that is out of range.
    fn check(&self) -> Result<(), StudyError>;

    /// Computes the answer of a question that was checked. [`Question::answer`] calls it.
    ///
    /// # Errors
    /// [`StudyError`] says what is wrong with the question or with a file.
    fn solve(
        &self,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<Self::Answer>, StudyError>;

    /// The same question with a coarser answer that comes much sooner, for a person to see until this
    /// one is answered; `None` if there is none.
    fn coarse(&self) -> Option<Self>
    where
        Self: Sized,
    {
        None
    }

    /// Whether a coarse answer is a part of the full one, right in all that it says: it then stands for
    /// the full one until that comes.
    const IS_COARSE_PART: bool = false;

    /// The report of an answer.
    fn report(answer: &Self::Answer) -> &Self::Report;

    /// Whether the answer says of what was asked that something is wrong with it, such as of a data set that
    /// cases of it cannot be read: a program that asks is told so beside the answer.
    fn has_problems(_report: &Self::Report) -> bool {
        false
    }

    /// Checks the question, answers it, and checks that every number of the report is finite.
    ///
    /// - `library`: models and data that are in memory already; an empty one reads everything from
    ///   files;
    /// - `observer`: is told what happens; when it breaks, a long answer ends as
    ///   [`Outcome::Cancelled`] or, for a training, with the weights so far.
    ///
    /// # Errors
    /// [`StudyError`] says what is wrong with the question or with a file;
    /// [`StudyError::NotFinite`] which number of the report is not finite.
    fn answer(
        &self,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<Self::Answer>, StudyError> {
        self.check()?;
        let answer = self.solve(library, observer)?;
        if let Outcome::Complete(answer) = &answer
            && let Some(NotFinite { field, value }) = first_not_finite(Self::report(answer))
        {
            return Err(StudyError::NotFinite { question: Self::NAME, field, value });
        }
        Ok(answer)
    }
}

/// The observer as the callback that computations take which know progress only.
pub(crate) fn progress_of<'a>(
    observer: &'a mut Observer<'_>,
) -> impl FnMut(Progress) -> ControlFlow<()> + 'a {
    |progress| observer(Event::Progress(progress))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ask::checks::check;
    use impactlab_core::ranges::SPEED;

    /// Asks for the quotient of two speeds, which each lie in their range.
    #[derive(Clone, PartialEq)]
    struct Ratio(f64, f64);

    #[derive(Serialize)]
    struct RatioReport {
        speeds_m_s: [f64; 2],
        ratio: f64,
    }

    impl Question for Ratio {
        type Answer = RatioReport;
        type Report = RatioReport;
        const NAME: &'static str = "ratio";

        fn check(&self) -> Result<(), StudyError> {
            check("first", &SPEED, self.0)?;
            check("second", &SPEED, self.1)
        }

        fn report(answer: &RatioReport) -> &RatioReport {
            answer
        }

        fn solve(
            &self,
            _library: &Library,
            _observer: &mut Observer<'_>,
        ) -> Result<Outcome<RatioReport>, StudyError> {
            let speeds_m_s = [self.0, self.1];
            Ok(Outcome::Complete(RatioReport { speeds_m_s, ratio: self.0 / self.1 }))
        }
    }

    fn answer(question: &Ratio) -> Result<f64, String> {
        let answer = question.answer(&Library::default(), &mut |_| ControlFlow::Continue(()));
        let report =
            answer.map_err(|error| impactlab_core::error_chain(&error))?.complete().unwrap();
        Ok(report.ratio * report.speeds_m_s[1])
    }

    #[test]
    fn a_question_is_checked_before_and_its_report_after() {
        assert_eq!(answer(&Ratio(20.0, 10.0)), Ok(20.0));
        let error = answer(&Ratio(20.0, 200.0)).unwrap_err();
        assert!(error.starts_with("second: speed is 200 m/s, expected -150 to 150"), "{error}");
        for (question, value) in [(Ratio(1.0, 0.0), "inf"), (Ratio(0.0, 0.0), "NaN")] {
            let error = answer(&question).unwrap_err();
            assert!(
                error.starts_with(&format!("ratio: ratio of the answer is {value}")),
                "{error}"
            );
        }
    }
}
