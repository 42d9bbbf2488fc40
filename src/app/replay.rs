//! A data set that is simulated as a whole, with its cases by name.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use crate::app::question_job::QuestionJob;
use crate::compare::MotionError;
use crate::study::{Library, SimulateDatasetAnswer, SimulateDatasetReport, SimulateDatasetRequest};

/// The simulation of a whole data set, under way or over.
#[derive(Default)]
pub struct ReplayStatus {
    /// The question, and the answer that is shown.
    pub question: QuestionJob<SimulateDatasetRequest>,
    by_case: BTreeMap<String, usize>,
}

/// The simulated data sets, by their folders.
pub type Replays = BTreeMap<PathBuf, ReplayStatus>;

impl ReplayStatus {
    /// Starts to simulate; what is under way is cancelled.
    ///
    /// # Errors
    /// The operating system's, if no thread can be started.
    pub fn start(
        &mut self,
        question: SimulateDatasetRequest,
        library: &Arc<Library>,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<()> {
        self.question.start(question, library, wake)
    }

    /// Stops what is under way.
    pub fn cancel(&self) {
        self.question.cancel();
    }

    /// Takes in the end of a simulation; what the user should be told.
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
        let told = failures.first().map(|first| {
            format!("{} cases cannot be simulated; the first: {first}", failures.len())
        });
        self.by_case = by_case;
        told
    }

    /// Whether there is nothing to show: neither a simulation under way nor a result.
    pub fn is_empty(&self) -> bool {
        !self.question.is_running() && self.report().is_none()
    }

    /// What is told of the latest simulation.
    pub fn report(&self) -> Option<&SimulateDatasetReport> {
        let answer: &SimulateDatasetAnswer = self.question.ok()?;
        Some(&answer.report)
    }

    /// How far the simulation of a case lies from its record.
    pub fn error(&self, case: &str) -> Option<&MotionError> {
        let idx = self.by_case.get(case)?;
        self.report()?.cases.get(*idx).map(|replay| &replay.error)
    }
}
