//! What the drivers do, where nobody has said it, or where what is said cannot be meant.

use crate::{MotionSource, SimulateRequest, StudyError};
use impactlab_core::collision::Scenario;
use impactlab_core::uncertainty::{Caveat, CaveatKind, CaveatSubject};
use impactlab_core::units::{Phrase, PhraseValue};
use impactlab_core::vehicle::PitDriver;

/// What nobody has said of the drivers of both vehicles, and whether one of a PIT turns the wrong way.
///
/// # Errors
/// [`StudyError`] if the scenario cannot be read.
pub(crate) fn open_drivers(question: &SimulateRequest) -> Result<Vec<Caveat>, StudyError> {
    let scenario = match &question.source {
        MotionSource::Scenario { scenario, .. } => Some(scenario.load()?),
        MotionSource::Drive(_) | MotionSource::Case { .. } | MotionSource::Trajectory { .. } => {
            None
        }
    };
    let of_striking = scenario.as_ref().filter(|_| !question.one_contact);
    let of_striking = of_striking.and_then(|scenario| open_striking(scenario, question.until_rest));
    let turned = scenario.as_ref().and_then(turns_away);
    Ok(open_struck(question, scenario.as_ref())
        .into_iter()
        .chain(of_striking)
        .chain(turned)
        .collect())
}

/// A driver of a PIT who is said to turn away from the car that he strikes.
fn turns_away(scenario: &Scenario) -> Option<Caveat> {
    let driver = scenario.striking_ending.as_ref()?.pit?;
    let towards = scenario.geometry().ok()?.side_of_struck()?;
    let side = driver.side.or(Some(towards));
    let steers_rad = PitDriver { side, ..driver }.acting().steering_wheel_rad;
    (towards.sign() * steers_rad < 0.0).then(|| {
        let side = towards.word();
        let text = Phrase::new(
            "the driver of the striking vehicle turns away from the other car, which is to his {0}; \
             pit_side or the sign of pit_steering_wheel in [bullet_ending] of the scenario says to which \
             side he turns",
            "Der Fahrer des stoßenden Fahrzeugs lenkt von dem anderen Fahrzeug weg, das von ihm aus {0} \
             ist; zu prüfen ist, nach welcher Seite er lenken soll",
        )
        .with(PhraseValue::Term(side.to_owned()));
        let caveat = Caveat::new(CaveatKind::DoubtfulData, text);
        Caveat { subject: Some(CaveatSubject::Striking), ..caveat }
    })
}

/// That a motion is followed to rest although nobody has said what the driver does: whether the vehicle
/// brakes decides by far the most where it stops.
fn open_struck(question: &SimulateRequest, scenario: Option<&Scenario>) -> Option<Caveat> {
    let is_said = match &question.source {
        MotionSource::Scenario { .. } | MotionSource::Drive(_) => {
            question.ending.is_some() || scenario.is_some_and(|it| it.ending.is_some())
        }
        // A record has the driver that it has.
        MotionSource::Case { .. } | MotionSource::Trajectory { .. } => true,
    };
    (question.until_rest && !is_said).then(|| {
        let text = Phrase::new(
            "nobody has said what the driver does: the vehicle rolls to rest unbraked, over \
             distances that were compared with no record; say that it brakes (--brake 0.8), or that \
             it rolls (--coast)",
            "Zum Verhalten des Fahrers liegt keine Angabe vor: Das Fahrzeug rollt ungebremst aus, über \
             Strecken, die an keiner Aufzeichnung geprüft sind. Anzugeben ist, ob es bremst \
             (--brake 0.8) oder rollt (--coast)",
        );
        Caveat::new(CaveatKind::DriverOpen, text)
    })
}

/// That the striking vehicle coasts because nobody has said what its driver does: it may push the struck one
/// on, and where it goes hangs on that alone.
///
/// - `until_rest`: then it is a warning.
fn open_striking(scenario: &Scenario, until_rest: bool) -> Option<Caveat> {
    let is_open = scenario.striking.fixed.is_none() && scenario.striking_ending.is_none();
    is_open.then(|| {
        if until_rest {
            let text = Phrase::new(
                "nobody has said what the driver of the striking vehicle does: it coasts; one that \
                 brakes or drives on pushes the struck one in another way and ends elsewhere; \
                 [bullet_ending] of the scenario says it",
                "Zum Verhalten des Fahrers des stoßenden Fahrzeugs liegt keine Angabe vor: Es rollt \
                 ungebremst. Gebremst oder angetrieben würde es das gestoßene anders schieben und \
                 anderswo enden",
            );
            let caveat = Caveat::new(CaveatKind::DriverOpen, text);
            return Caveat { subject: Some(CaveatSubject::Striking), ..caveat };
        }
        Caveat::assumed(
            CaveatSubject::Striking,
            Phrase::new("its driver lets it roll", "sein Fahrer lässt es rollen"),
            Phrase::new(
                "nobody has said what the driver of the striking vehicle does; otherwise: \
                 [bullet_ending] of the scenario",
                "zum Verhalten des Fahrers des stoßenden Fahrzeugs liegt keine Angabe vor",
            ),
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ScenarioChoice;
    use crate::analysis::PulseSetup;
    use impactlab_core::collision::{ContactLocation, Scenario, Side};
    use impactlab_core::vehicle::{Ending, TurnSide};

    fn asked(scenario: Scenario) -> SimulateRequest {
        let scenario = ScenarioChoice::Inline(Box::new(scenario));
        let source = MotionSource::Scenario { scenario, pulse: PulseSetup::default() };
        SimulateRequest::new(source)
    }

    #[test]
    fn only_a_motion_to_rest_with_a_driver_that_nobody_named_is_warned_of() {
        let scenario = Scenario { striking_ending: Some(Ending::default()), ..Scenario::example() };
        let timed = asked(scenario);
        assert_eq!(open_drivers(&timed).unwrap(), []);
        let to_rest = SimulateRequest { until_rest: true, ..timed };
        let [open]: [Caveat; 1] = open_drivers(&to_rest).unwrap().try_into().unwrap();
        assert!(open.is_warning());
        let coasts = SimulateRequest { ending: Some(Ending::default()), ..to_rest };
        assert_eq!(open_drivers(&coasts).unwrap(), []);
    }

    #[test]
    fn a_striking_driver_of_whom_nobody_speaks_is_assumed_to_coast() {
        let timed = asked(Scenario { striking_ending: None, ..Scenario::example() });
        let [assumed]: [Caveat; 1] = open_drivers(&timed).unwrap().try_into().unwrap();
        assert!(assumed.subject == Some(CaveatSubject::Striking) && !assumed.is_warning());
        let to_rest =
            SimulateRequest { until_rest: true, ending: Some(Ending::default()), ..timed.clone() };
        let [open]: [Caveat; 1] = open_drivers(&to_rest).unwrap().try_into().unwrap();
        assert!(open.is_warning());
        let alone = SimulateRequest { one_contact: true, ..timed };
        assert_eq!(open_drivers(&alone).unwrap(), []);
    }
    /// Without a side he turned to the left, also where the struck car was to his right. He turns towards it.
    #[test]
    fn a_driver_of_a_pit_who_turns_away_from_the_other_car_is_told_of() {
        let found = |mirrored: bool, side: Option<TurnSide>| {
            let pit = Some(PitDriver { side, ..PitDriver::default() });
            let mut scenario = Scenario {
                striking_ending: Some(Ending { pit, ..Ending::default() }),
                ..Scenario::example()
            };
            if mirrored {
                scenario.striking.heading_rad *= -1.0;
                scenario.striking.vy_world_m_s *= -1.0;
                if let ContactLocation::Side { side, .. } = &mut scenario.contact.location {
                    *side = Side::Left;
                }
            }
            open_drivers(&asked(scenario)).unwrap()
        };
        for (mirrored, towards, away) in
            [(false, TurnSide::Left, TurnSide::Right), (true, TurnSide::Right, TurnSide::Left)]
        {
            assert_eq!(found(mirrored, Some(towards)), [], "{mirrored}");
            assert_eq!(found(mirrored, None), [], "{mirrored}");
            let [told]: [Caveat; 1] = found(mirrored, Some(away)).try_into().unwrap();
            assert_eq!(told.kind, CaveatKind::DoubtfulData, "{told:?}");
        }
    }
}
