//! What the driver does, where the end is asked for and nobody has said it.

use crate::{MotionSource, SimulateRequest, StudyError};
use impactlab_core::uncertainty::{Caveat, CaveatKind};
use impactlab_core::units::Phrase;

/// That a motion is followed to rest although nobody has said what the driver does: whether the vehicle
/// brakes decides by far the most where it stops.
///
/// # Errors
/// [`StudyError`] if the scenario cannot be read.
pub(crate) fn open_driver(question: &SimulateRequest) -> Result<Option<Caveat>, StudyError> {
    let is_said = match &question.source {
        MotionSource::Scenario { scenario, .. } => {
            question.ending.is_some() || scenario.load()?.ending.is_some()
        }
        MotionSource::Drive(_) => question.ending.is_some(),
        // A record has the driver that it has.
        MotionSource::Case { .. } | MotionSource::Trajectory { .. } => true,
    };
    let is_open = question.until_rest && !is_said;
    Ok(is_open.then(|| {
        let text = Phrase::new(
            "nobody has said what the driver does: the vehicle rolls to rest unbraked, over \
             distances that were compared with no record; say that it brakes (--brake 0.8), or that \
             it rolls (--coast)",
            "Zum Verhalten des Fahrers liegt keine Angabe vor: Das Fahrzeug rollt ungebremst aus, über \
             Strecken, die an keiner Aufzeichnung geprüft sind. Anzugeben ist, ob es bremst \
             (--brake 0.8) oder rollt (--coast)",
        );
        Caveat::new(CaveatKind::DriverOpen, text)
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ScenarioChoice;
    use crate::analysis::PulseSetup;
    use impactlab_core::collision::Scenario;
    use impactlab_core::vehicle::Ending;

    #[test]
    fn only_a_motion_to_rest_with_a_driver_that_nobody_named_is_warned_of() {
        let scenario = ScenarioChoice::Inline(Box::new(Scenario::example()));
        let source = MotionSource::Scenario { scenario, pulse: PulseSetup::default() };
        let timed = SimulateRequest::new(source);
        assert_eq!(open_driver(&timed).unwrap(), None);
        let to_rest = SimulateRequest { until_rest: true, ..timed };
        assert!(open_driver(&to_rest).unwrap().unwrap().is_warning());
        let coasts = SimulateRequest { ending: Some(Ending::default()), ..to_rest };
        assert_eq!(open_driver(&coasts).unwrap(), None);
    }
}
