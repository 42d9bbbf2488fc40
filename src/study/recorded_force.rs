//! The force of a case or a file as it was recorded.

use crate::data::{ForceHistory, Outcome};
use crate::study::simulate_dataset::take_case;
use crate::study::{Library, MotionSource, Observer, Question, SeriesFile, StudyError};

/// Asks for a recorded force, to be shown.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedForceRequest {
    /// What records it.
    pub source: MotionSource,
}

/// A recorded force.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedForceAnswer {
    /// The case, or the file's name without its ending.
    pub name: String,
    /// The force.
    pub force: ForceHistory,
    /// What a person should know about how the file was read.
    pub notes: Vec<String>,
}

impl Question for RecordedForceRequest {
    type Answer = RecordedForceAnswer;
    type Report = ();
    const NAME: &'static str = "read force";

    fn check(&self) -> Result<(), StudyError> {
        self.source.check()
    }

    fn report(_answer: &Self::Answer) -> &() {
        &()
    }

    fn solve(
        &self,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<RecordedForceAnswer>, StudyError> {
        let file = match &self.source {
            MotionSource::Case { dataset: root, case } => {
                let Outcome::Complete(dataset) = library.dataset(root, observer)? else {
                    return Ok(Outcome::Cancelled);
                };
                let force = take_case(&dataset, case)?.force_history();
                let force =
                    force.map_err(|source| StudyError::Series { path: root.clone(), source })?;
                let (name, notes) = (case.clone(), Vec::new());
                return Ok(Outcome::Complete(RecordedForceAnswer { name, force, notes }));
            }
            MotionSource::Trajectory { file, .. } => Some(file),
            MotionSource::Drive(drive) => drive.force.as_ref().or(drive.steer.as_ref()),
            MotionSource::Scenario { .. } => None,
        };
        let none = || StudyError::NoForce { name: self.source.name() };
        let file: &SeriesFile = file.ok_or_else(none)?;
        let loaded = library.series(file)?;
        let force = ForceHistory::from_series(&loaded.series, loaded.force_sampling())
            .map_err(|source| StudyError::Series { path: file.path.clone(), source })?;
        let notes = loaded.notes.iter().map(ToString::to_string).collect();
        Ok(Outcome::Complete(RecordedForceAnswer { name: file.title(), force, notes }))
    }
}
