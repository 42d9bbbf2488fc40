//! The force of a case or a file as it was recorded.

use crate::caveats::restrictions;
use crate::questions::simulate::dataset::take_case;
use crate::{Library, MotionSource, Observer, Question, SeriesFile, StudyError};
use impactlab_core::data::{ForceHistory, Outcome};
use impactlab_core::uncertainty::{Caveat, CaveatKind, Caveats};

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
    /// What restricts it.
    pub caveats: Caveats,
}

impl RecordedForceAnswer {
    fn new(name: String, force: ForceHistory, notes: Vec<String>) -> Self {
        let notes = notes.into_iter().map(|text| Caveat::new(CaveatKind::Note, text));
        let caveats = restrictions::cut_record_caveat(&force).into_iter().chain(notes).collect();
        Self { name, force, caveats }
    }
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
                let answer = RecordedForceAnswer::new(case.clone(), force, Vec::new());
                return Ok(Outcome::Complete(answer));
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
        Ok(Outcome::Complete(RecordedForceAnswer::new(file.title(), force, notes)))
    }
}
