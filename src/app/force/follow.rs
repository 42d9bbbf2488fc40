//! The collision of the force prediction follows the scenario from which it was taken.

use crate::app::state::State;
use impactlab_networks::force::ForceScenario;

/// The collision of the scenario pane, and the variant of the case that it belongs to.
#[derive(Debug, Clone, PartialEq)]
pub struct FollowedScenario {
    variant: String,
    name: String,
    numbers: ForceScenario,
}

impl State {
    /// Takes over a change of the scenario, if the collision of the force prediction was that of the
    /// scenario before. Otherwise the force of a collision that is no longer the subject would stand
    /// beside its motion under the same name. A collision that was edited by itself stays as it is.
    pub(in crate::app) fn follow_scenario(&mut self) {
        let scenario = &self.project.scenario;
        let Ok(numbers) = ForceScenario::from_scenario(scenario) else { return };
        let (variant, name) = (self.case.file.shown.clone(), scenario.name.clone());
        let now = FollowedScenario { variant, name, numbers };
        let before = self.session.force.followed.replace(now.clone());
        let Some(before) = before.filter(|before| before.variant == now.variant) else { return };
        let form = &mut self.project.force;
        if before != now && form.name == before.name && form.scenario == before.numbers {
            (form.name, form.scenario) = (now.name, now.numbers);
        }
    }
}
