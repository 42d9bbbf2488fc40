//! A scenario takes over the vehicles that are chosen for it: one vehicle has one mass.

use impactlab_core::collision::{Role, Scenario};
use impactlab_core::units::UnitSystem;

use crate::caveats::other_vehicle::taken_over;
use crate::{MotionSource, ScenarioChoice, SimulateRequest, StudyError, VehicleChoice};

/// Gives a vehicle of a scenario the mass, yaw inertia and outline of the one that is chosen for it. One that
/// is left open, or that the scenario names itself, stays as the scenario has it.
///
/// - `units`: in which it is told;
/// - returns what is another value than before, in words; `None` if nothing is.
///
/// # Errors
/// [`StudyError`] if there is no such vehicle, or its file or sheet is wrong.
pub fn take_vehicle(
    scenario: &mut Scenario,
    role: Role,
    choice: &VehicleChoice,
    units: UnitSystem,
) -> Result<Option<String>, StudyError> {
    let name = match choice {
        VehicleChoice::Preset(id) => Some(id.clone()),
        VehicleChoice::Automatic | VehicleChoice::File(_) | VehicleChoice::Sheet(_) => None,
    };
    let is_named = name.is_some() && scenario.vehicle_name(role) == name.as_deref();
    let Some(vehicle) = choice.chosen()?.filter(|_| !is_named) else { return Ok(None) };
    let told = taken_over(scenario, role, &vehicle, units);
    scenario.vehicle_mut(role).take(&vehicle);
    scenario.name_vehicle(role, name);
    Ok(told)
}

impl SimulateRequest {
    /// Gives the vehicles of the scenario, if it is about one, the mass, yaw inertia and outline of those that
    /// are chosen. The question then has the scenario in it, in place of its file.
    ///
    /// - returns what is another value than before, in words, with SI units.
    ///
    /// # Errors
    /// [`StudyError`] if the scenario or a vehicle cannot be read.
    pub fn take_vehicles(&mut self) -> Result<Vec<String>, StudyError> {
        let choices = [&self.vehicle, &self.striking];
        let MotionSource::Scenario { scenario: choice, .. } = &mut self.source else {
            return Ok(Vec::new());
        };
        if choices.iter().all(|choice| **choice == VehicleChoice::Automatic) {
            return Ok(Vec::new());
        }
        let mut scenario = choice.load()?;
        let mut told = Vec::new();
        for (role, choice) in Role::ALL.into_iter().zip(choices) {
            told.extend(take_vehicle(&mut scenario, role, choice, UnitSystem::Si)?);
        }
        *choice = ScenarioChoice::Inline(Box::new(scenario));
        Ok(told)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::PulseSetup;

    fn question(vehicle: VehicleChoice) -> SimulateRequest {
        let scenario = ScenarioChoice::File("pit-right-rear".into());
        let source = MotionSource::Scenario { scenario, pulse: PulseSetup::default() };
        SimulateRequest { vehicle, ..SimulateRequest::new(source) }
    }

    fn scenario(question: &SimulateRequest) -> &Scenario {
        match &question.source {
            MotionSource::Scenario { scenario, .. } => scenario.inline().unwrap(),
            _ => unreachable!("it is about a scenario"),
        }
    }

    #[test]
    fn a_chosen_car_gives_its_mass_once_and_an_override_stays() {
        let mut asked = question(VehicleChoice::named("toyota-corolla-2020"));
        let told = asked.take_vehicles().unwrap();
        assert_eq!(told.len(), 1);
        assert!(told[0].contains("mass 1") && told[0].contains("instead of 2000"), "{told:?}");
        let car = scenario(&asked).struck.clone();
        assert!(car.mass_kg < 1500.0 && scenario(&asked).striking.mass_kg == 2000.0, "{car:?}");
        assert_eq!(asked.take_vehicles().unwrap(), [""; 0], "once is enough");
        let MotionSource::Scenario { scenario: of, .. } = &mut asked.source else { return };
        of.inline_mut().unwrap().struck.mass_kg = 1800.0;
        assert_eq!(asked.take_vehicles().unwrap(), [""; 0]);
        assert_eq!(scenario(&asked).struck.mass_kg, 1800.0, "what a person said of it");
        asked.vehicle = VehicleChoice::named("ford-explorer-2004");
        assert!(asked.take_vehicles().unwrap()[0].contains("instead of 1800"));
    }

    #[test]
    fn what_is_left_open_stays_a_file() {
        let mut asked = question(VehicleChoice::Automatic);
        assert_eq!(asked.take_vehicles().unwrap(), [""; 0]);
        assert_eq!(asked, question(VehicleChoice::Automatic));
        let mut asked = question(VehicleChoice::named("no-such-car"));
        assert!(asked.take_vehicles().is_err());
    }
}
