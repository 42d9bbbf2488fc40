//! The simulation of all cases of a data set, and the errors of its cases by name.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use crate::app::question_job::QuestionJob;
use impactlab_core::compare::MotionError;
use impactlab_study::{
    Answer, Library, SimulateDatasetAnswer, SimulateDatasetReport, SimulateDatasetRequest,
    SimulateRequest,
};

/// The simulation of a data set, running or finished.
#[derive(Default)]
pub struct ReplayStatus {
    /// The question, the running job and the latest answer.
    pub question: QuestionJob<SimulateDatasetRequest>,
    /// Index of each case in the report, by the name of the case.
    by_case: BTreeMap<String, usize>,
    /// How many simulations have ended, so that two of them can be told apart.
    pub n_answers: u64,
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
        self.n_answers += 1;
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

    /// Whether the vehicle, or how its motion is computed, is not that of the latest simulation any more.
    pub fn is_outdated(&self, now: &SimulateRequest) -> bool {
        self.question.latest.as_ref().is_some_and(|latest| {
            let SimulateDatasetRequest { vehicle, equations, integrator, .. } = &latest.question;
            *vehicle != now.vehicle || *equations != now.equations || *integrator != now.integrator
        })
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::question_job::Answered;
    use impactlab_study::{MotionSource, VehicleChoice};

    /// The errors of a data set stood as those of the vehicle that had been chosen after they were found.
    #[test]
    fn errors_of_another_vehicle_are_outdated() {
        let mut now = SimulateRequest::new(MotionSource::default());
        let question = SimulateDatasetRequest {
            dataset: PathBuf::from("trajectories"),
            case: None,
            vehicle: now.vehicle.clone(),
            equations: now.equations,
            integrator: now.integrator,
        };
        let mut status = ReplayStatus::default();
        assert!(!status.is_outdated(&now), "nothing was simulated");
        status.question.latest = Some(Answered { question, answer: Err("not read".to_owned()) });
        assert!(!status.is_outdated(&now));
        now.duration_s = 2.0;
        assert!(!status.is_outdated(&now), "the recordings say how long");
        now.vehicle = VehicleChoice::named("toyota-corolla-2020");
        assert!(status.is_outdated(&now));
    }
}
