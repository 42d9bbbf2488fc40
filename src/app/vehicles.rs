//! The vehicles that are chosen, and what the scenario takes over from them.

use std::borrow::Cow;

use crate::app::project::Project;
use crate::app::state::State;
use impactlab_core::collision::Role;
use impactlab_core::data::Severity;
use impactlab_core::error_chain;
use impactlab_core::vehicle::{DataSheet, VehicleParameters};
use impactlab_study::{VehicleChoice, take_vehicle};

/// What stands above or in front of what is of a vehicle.
pub const fn vehicle_title(role: Role) -> &'static str {
    match role {
        Role::Struck => "Struck vehicle",
        Role::Striking => "Striking vehicle",
    }
}

/// The vehicles that are chosen, read once.
#[derive(Debug, Clone, Default)]
pub struct ChosenVehicles {
    of: [(VehicleChoice, Option<VehicleParameters>); 2],
}

impl ChosenVehicles {
    /// A vehicle; `None` if it is left open or cannot be read.
    pub fn get(&self, role: Role) -> Option<&VehicleParameters> {
        self.of[role as usize].1.as_ref()
    }

    /// Reads those that have changed.
    pub(super) fn update(&mut self, project: &Project) {
        for role in Role::ALL {
            let (read, vehicle) = &mut self.of[role as usize];
            let choice = project.chosen_vehicle(role);
            if *read != *choice {
                *vehicle = choice.chosen().ok().flatten();
                *read = choice.into_owned();
            }
        }
    }
}

impl Project {
    /// The choice of a vehicle, to be edited.
    pub fn vehicle_mut(&mut self, role: Role) -> &mut VehicleChoice {
        match role {
            Role::Struck => &mut self.simulate.vehicle,
            Role::Striking => &mut self.simulate.striking,
        }
    }

    /// The vehicle that is chosen, or that the scenario names.
    pub fn chosen_vehicle(&self, role: Role) -> Cow<'_, VehicleChoice> {
        let choice = match role {
            Role::Struck => &self.simulate.vehicle,
            Role::Striking => &self.simulate.striking,
        };
        let named = self.scenario().and_then(|scenario| scenario.vehicle_name(role));
        match (choice, named) {
            (VehicleChoice::Automatic, Some(name)) => Cow::Owned(VehicleChoice::named(name)),
            _ => Cow::Borrowed(choice),
        }
    }

    /// Takes a data sheet, which begins as the vehicle that was chosen: what the scenario has of that stays.
    pub fn edit_vehicle(&mut self, role: Role, sheet: DataSheet) {
        *self.vehicle_mut(role) = VehicleChoice::Sheet(Box::new(sheet));
        if let Some(scenario) = self.scenario_mut() {
            scenario.name_vehicle(role, None);
        }
    }

    /// Lets the scenario follow a vehicle whose data were edited.
    ///
    /// - `before`: the vehicle before that.
    pub fn follow_vehicle(&mut self, role: Role, before: &VehicleParameters) {
        let now = self.chosen_vehicle(role).chosen().ok().flatten();
        if let (Some(now), Some(scenario)) = (now, self.scenario_mut()) {
            scenario.vehicle_mut(role).follow(before, &now);
        }
    }
}

impl State {
    /// Chooses a vehicle, and lets the scenario take over its mass, yaw inertia and outline. One that is left
    /// open leaves the scenario as it is.
    pub(super) fn choose_vehicle(&mut self, role: Role, choice: VehicleChoice) {
        let units = self.view.units;
        let taken = self.project.scenario_mut().map(|scenario| {
            if choice == VehicleChoice::Automatic {
                scenario.name_vehicle(role, None);
            }
            take_vehicle(scenario, role, &choice, units)
        });
        *self.project.vehicle_mut(role) = choice;
        // A file that is chosen again may have been changed.
        self.session.chosen_vehicles = ChosenVehicles::default();
        match taken {
            Some(Ok(Some(told))) => self.say(Severity::Info, told),
            Some(Err(error)) => self.say(Severity::Error, error_chain(&error)),
            Some(Ok(None)) | None => {}
        }
        self.ask_again();
    }
}
