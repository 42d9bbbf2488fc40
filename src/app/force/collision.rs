//! The collision of the force prediction, as the form shows it.

use crate::app::source::Source;
use impactlab_networks::force::ForceScenario;
use impactlab_study::{ForceQuestion, PredictForceRequest};

/// The numbers of a collision that the force network knows, and what they are called.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedCollision {
    /// Name of the scenario, of the case or of what was edited.
    pub name: String,
    /// Masses, velocities, angle, contact point, body.
    pub numbers: ForceScenario,
}

/// The collision of a question; `None` if the vehicles of its scenario do not meet, or if the data set
/// of its case is not open.
pub fn collision_of(request: &PredictForceRequest, sources: &[Source]) -> Option<NamedCollision> {
    let (name, mut numbers) = match &request.collision {
        ForceQuestion::Scenario(choice) => {
            (choice.name(), ForceScenario::from_scenario(choice.inline()?).ok()?)
        }
        ForceQuestion::Case { dataset, case } => {
            let source = sources.iter().find(|source| source.path == *dataset)?;
            let found = source.dataset()?.dataset.case(case)?;
            (case.clone(), ForceScenario::from_case(found).ok()?)
        }
        ForceQuestion::Numbers { name, numbers } => (name.clone(), numbers.as_ref().clone()),
    };
    if request.body.is_some() {
        numbers.striking_body.clone_from(&request.body);
    }
    if request.struck_body.is_some() {
        numbers.struck_body.clone_from(&request.struck_body);
    }
    if request.open_contact {
        super::forget_contact(&mut numbers);
    }
    Some(NamedCollision { name, numbers })
}

impl NamedCollision {
    /// Makes it that of a question, with all that was open in it or said beside it.
    pub fn put_into(self, request: &mut PredictForceRequest) {
        let Self { name, numbers } = self;
        request.collision = ForceQuestion::Numbers { name, numbers: Box::new(numbers) };
        (request.body, request.struck_body, request.open_contact) = (None, None, false);
    }
}
