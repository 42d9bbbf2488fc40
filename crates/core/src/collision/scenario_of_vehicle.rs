//! What a scenario and the data of a vehicle both say of it: mass, yaw inertia and outline.

use crate::collision::{Scenario, ScenarioVehicle};
use crate::units::Quantity;
use crate::vehicle::VehicleParameters;

/// Relative difference up to which two numbers are the same one, which was written or rounded.
const SAME: f64 = 1e-9;

/// Which of the two vehicles of a collision.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// The one that is struck.
    Struck,
    /// The one that strikes.
    Striking,
}

impl Role {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Struck, Self::Striking];

    /// Their words in reports, errors and random streams.
    pub const WORDS: [&'static str; 2] = ["struck", "striking"];

    /// What it is called.
    pub const fn label(self) -> &'static str {
        match self {
            Self::Struck => "struck vehicle",
            Self::Striking => "striking vehicle",
        }
    }
}

/// A number that both a scenario and the data of a vehicle say.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SharedNumber {
    /// What it is called.
    pub name: &'static str,
    /// Its key in a vehicle file.
    pub key: &'static str,
    /// Its quantity.
    pub quantity: Quantity,
    /// Value of the scenario, SI.
    pub in_scenario: f64,
    /// Value of the vehicle, SI. The yaw inertia is that of the vehicle with the mass of the scenario, so
    /// that a load is no second difference.
    pub in_vehicle: f64,
}

impl SharedNumber {
    /// Whether the scenario says something else than the vehicle.
    pub fn differs(&self) -> bool {
        (self.in_scenario - self.in_vehicle).abs() > SAME * self.in_vehicle.abs()
    }
}

impl ScenarioVehicle {
    /// The numbers that a vehicle says, too, each with both values.
    pub fn beside(&self, vehicle: &VehicleParameters) -> [SharedNumber; 5] {
        let mut of_vehicle = self.clone();
        of_vehicle.take(vehicle);
        let loaded = vehicle.clone().with_mass(self.mass_kg, None);
        of_vehicle.yaw_inertia_kg_m2 = loaded.mass.yaw_inertia_kg_m2;
        let number = |name, key, quantity, value: fn(&Self) -> f64| SharedNumber {
            name,
            key,
            quantity,
            in_scenario: value(self),
            in_vehicle: value(&of_vehicle),
        };
        let length = Quantity::Length;
        [
            number("mass", "mass.mass_kg", Quantity::Mass, |of| of.mass_kg),
            number("yaw inertia", "mass.yaw_inertia_kg_m2", Quantity::MomentOfInertia, |of| {
                of.yaw_inertia_kg_m2
            }),
            number("length", "geometry.outer_length_m", length, |of| of.length_m),
            number("width", "geometry.outer_width_m", length, |of| of.width_m),
            number("CG behind the front", "geometry.cg_to_front_end_m", length, |of| {
                of.cg_from_front_m
            }),
        ]
    }

    /// Takes over mass, yaw inertia and outline of a vehicle, also in place of a fixed object. Where it is and how it moves stays.
    pub fn take(&mut self, vehicle: &VehicleParameters) {
        self.fixed = None;
        let (mass, geometry) = (&vehicle.mass, &vehicle.geometry);
        self.mass_kg = mass.mass_kg;
        self.yaw_inertia_kg_m2 = mass.yaw_inertia_kg_m2;
        self.length_m = geometry.outer_length_m;
        self.width_m = geometry.outer_width_m;
        self.cg_from_front_m = geometry.cg_to_front_end_m.min(self.length_m);
    }

    /// Follows a vehicle whose data were edited: what was as that had it is as it has it now, and what the
    /// scenario says otherwise stays.
    pub fn follow(&mut self, before: &VehicleParameters, now: &VehicleParameters) {
        if self.fixed.is_some() {
            return;
        }
        let differs = self.beside(before).map(|number| number.differs());
        let own = self.clone();
        self.take(now);
        let values = [
            (&mut self.mass_kg, own.mass_kg),
            (&mut self.yaw_inertia_kg_m2, own.yaw_inertia_kg_m2),
            (&mut self.length_m, own.length_m),
            (&mut self.width_m, own.width_m),
            (&mut self.cg_from_front_m, own.cg_from_front_m),
        ];
        for ((value, own), _) in values.into_iter().zip(differs).filter(|(_, differs)| *differs) {
            *value = own;
        }
        if differs[0] && !differs[1] {
            let loaded = now.clone().with_mass(own.mass_kg, None);
            self.yaw_inertia_kg_m2 = loaded.mass.yaw_inertia_kg_m2;
        }
        // The CG of one and the length of the other.
        self.cg_from_front_m = self.cg_from_front_m.min(self.length_m);
    }
}

impl Scenario {
    /// One of the vehicles.
    pub fn vehicle(&self, role: Role) -> &ScenarioVehicle {
        match role {
            Role::Struck => &self.struck,
            Role::Striking => &self.striking,
        }
    }

    /// The same, to be edited.
    pub fn vehicle_mut(&mut self, role: Role) -> &mut ScenarioVehicle {
        match role {
            Role::Struck => &mut self.struck,
            Role::Striking => &mut self.striking,
        }
    }

    /// The name of a vehicle that comes with the program, if the scenario names one.
    pub fn vehicle_name(&self, role: Role) -> Option<&str> {
        match role {
            Role::Struck => self.struck_vehicle.as_deref(),
            Role::Striking => self.striking_vehicle.as_deref(),
        }
    }

    /// Names another vehicle, or none.
    pub fn name_vehicle(&mut self, role: Role, name: Option<String>) {
        match role {
            Role::Struck => self.struck_vehicle = name,
            Role::Striking => self.striking_vehicle = name,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vehicle::built_in_vehicle;

    #[test]
    fn a_role_is_called_by_its_word() {
        let labels = Role::WORDS.map(|word| format!("{word} vehicle"));
        assert_eq!(Role::ALL.map(Role::label), labels.each_ref().map(String::as_str));
    }

    fn names(of: &ScenarioVehicle, vehicle: &VehicleParameters) -> Vec<&'static str> {
        let shared = of.beside(vehicle).into_iter().filter(SharedNumber::differs);
        shared.map(|number| number.name).collect()
    }

    #[test]
    fn a_vehicle_gives_what_it_is_and_not_how_it_moves() {
        let corolla = built_in_vehicle("toyota-corolla-2020").unwrap();
        let mut scenario = Scenario::example();
        let before = scenario.struck.clone();
        assert_eq!(names(&before, &corolla).len(), 5, "{before:?}");
        scenario.vehicle_mut(Role::Struck).take(&corolla);
        let car = &scenario.struck;
        assert_eq!(names(car, &corolla), [""; 0]);
        assert_eq!(car.mass_kg, corolla.mass.mass_kg);
        assert_eq!([car.vx_world_m_s, car.heading_rad], [before.vx_world_m_s, before.heading_rad]);
        // A load changes the inertia, which is no second difference.
        let mut loaded = car.clone();
        loaded.mass_kg += 150.0;
        loaded.yaw_inertia_kg_m2 *= loaded.mass_kg / car.mass_kg;
        assert_eq!(names(&loaded, &corolla), ["mass"]);
    }

    #[test]
    fn what_was_said_otherwise_stays_when_a_vehicle_is_edited() {
        let before = built_in_vehicle("toyota-corolla-2020").unwrap();
        let mut now = before.clone().with_mass(1500.0, None);
        now.geometry.outer_width_m = 1.9;
        let mut car = Scenario::example().struck;
        car.take(&before);
        car.length_m = 4.4;
        car.follow(&before, &now);
        assert_eq!([car.mass_kg, car.length_m, car.width_m], [1500.0, 4.4, 1.9]);
        assert_eq!(names(&car, &now), ["length"]);
        let mut short = Scenario::example().struck;
        short.length_m = 1.8;
        short.cg_from_front_m = before.geometry.cg_to_front_end_m;
        short.follow(&before, &now);
        assert_eq!([short.length_m, short.cg_from_front_m], [1.8, 1.8], "within its outline");
        // A mass of the scenario stays, and the inertia goes with it.
        car.mass_kg = 1700.0;
        car.yaw_inertia_kg_m2 = before.clone().with_mass(1700.0, None).mass.yaw_inertia_kg_m2;
        car.follow(&now, &before);
        assert_eq!(names(&car, &before), ["mass", "length"]);
    }
}
