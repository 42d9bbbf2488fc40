//! The simulation of all cases of a data set, and the errors of its cases by name.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use crate::app::question_job::QuestionJob;
use impactlab_core::compare::MotionError;
use impactlab_study::{
    Answer, Library, SimulateDatasetAnswer, SimulateDatasetReport, SimulateDatasetRequest,
};

/// The simulation of a data set, running or finished.
#[derive(Default)]
pub struct ReplayStatus {
    /// The question, the running job and the latest answer.
    pub question: QuestionJob<SimulateDatasetRequest>,
    /// Index of each case in the report, by the name of the case.
    by_case: BTreeMap<String, usize>,
}

/// The simulated data sets, by the path of their folder.
pub type Replays = BTreeMap<PathBuf, ReplayStatus>;

impl ReplayStatus {
    /// Starts the simulation. A simulation that is still running is cancelled.
    ///
    /// - `wake`: called after every report of progress and at the end.
    ///
    /// # Errors
    /// The error of the operating system, if the thread cannot be started.
    pub fn start(
        &mut self,
        question: SimulateDatasetRequest,
        library: &Arc<Library>,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<()> {
        self.question.start(question, library, wake)
    }

    /// Cancels the running simulation.
    pub fn cancel(&self) {
        self.question.cancel();
    }

    /// Receives the result, if the simulation has ended. Returns a message for the user if it
    /// failed or if cases could not be simulated.
    pub fn poll(&mut self) -> Option<String> {
        if !self.question.poll() {
            return None;
        }
        if let Some(problem) = self.question.problem() {
            return Some(problem.to_owned());
        }
        let report = self.report()?;
        let names = report.cases.iter().enumerate();
        let by_case = names.map(|(idx, replay)| (replay.case.clone(), idx)).collect();
        let failures = &report.failures;
        let message = failures.first().map(|first| {
            format!("{} cases cannot be simulated; the first: {first}", failures.len())
        });
        self.by_case = by_case;
        message
    }

    /// Whether there is nothing to show: no simulation is running and none has given a result.
    pub fn is_empty(&self) -> bool {
        !self.question.is_running() && self.report().is_none()
    }

    /// Returns the report of the latest simulation.
    pub fn report(&self) -> Option<&Answer<SimulateDatasetReport>> {
        let answer: &SimulateDatasetAnswer = self.question.ok()?;
        Some(&answer.report)
    }

    /// Returns the difference between the simulated and the recorded motion of a case; `None` if it
    /// is not known.
    pub fn error(&self, case: &str) -> Option<&MotionError> {
        let idx = self.by_case.get(case)?;
        self.report()?.cases.get(*idx).map(|replay| &replay.error)
    }
}
