//! What a question is: something plain that can be asked, watched while it is answered, and
//! cancelled.

use std::ops::ControlFlow;

use crate::data::Outcome;
use crate::jobs::Progress;
use crate::learning::TrainingReport;
use crate::study::{Library, StudyError};

/// What happens while a question is answered.
#[derive(Debug)]
pub enum Event<'a> {
    /// Work of known length goes on.
    Progress(Progress),
    /// A training goes on.
    Training(&'a TrainingReport),
}

/// The callback that is told of every [`Event`] and says whether to go on.
pub type Observer<'a> = dyn FnMut(Event<'_>) -> ControlFlow<()> + 'a;

/// A question with everything that its answer depends on, files excepted.
///
/// The same question, asked of the same files, has the same answer: seeds are part of the question.
pub trait Question: Clone + PartialEq + Send + 'static {
    /// The answer: its report, and what the report was made from.
    type Answer: Send + Sync + 'static;

    /// What is being done, for the name of a thread.
    const NAME: &'static str;

    /// Answers the question.
    ///
    /// - `library`: models and data that are in memory already; an empty one reads everything from
    ///   files;
    /// - `observer`: is told what happens; when it breaks, a long answer ends as
    ///   [`Outcome::Cancelled`] or, for a training, with the weights so far.
    ///
    /// # Errors
    /// [`StudyError`] says what is wrong with the question or with a file.
    fn answer(
        &self,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<Self::Answer>, StudyError>;
}

/// The observer as the callback that computations take which know progress only.
pub(super) fn progress_of<'a>(
    observer: &'a mut Observer<'_>,
) -> impl FnMut(Progress) -> ControlFlow<()> + 'a {
    |progress| observer(Event::Progress(progress))
}
