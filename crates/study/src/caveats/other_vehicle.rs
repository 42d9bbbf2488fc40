//! Where the numbers of a collision are not those of the vehicle that was chosen for it.

use impactlab_core::collision::{Role, Scenario, SharedNumber};
use impactlab_core::uncertainty::{Caveat, CaveatKind, CaveatSubject};
use impactlab_core::units::{NumberFormat, Phrase, PhraseValue, Quantity, UnitSystem};
use impactlab_core::vehicle::{BuiltInVehicle, VehicleParameters};

use crate::VehicleChoice;

/// Relative difference beyond which a value is another one: of a mass, a passenger; of a yaw inertia,
/// more than the mass explains; of an outline, more than a bumper is worth.
const MASS_TOLERANCE: f64 = 0.03;
const INERTIA_TOLERANCE: f64 = 0.15;
const LENGTH_TOLERANCE: f64 = 0.04;

/// Difference of two frictions beyond which they are not those of one road.
const FRICTION_TOLERANCE: f64 = 0.02;

/// What a scenario says otherwise than the vehicles that were chosen for it by name. The motion is that
/// of the numbers of the scenario on the tires of the vehicle: it is the motion of neither car. Last, that
/// both vehicles move on roads of their own.
///
/// - `choices`: the struck vehicle and the striking one, as the question names them;
/// - `vehicles`: the same, before they take over the numbers of the scenario.
pub(crate) fn other_vehicles(
    scenario: &Scenario,
    choices: [&VehicleChoice; 2],
    vehicles: [&VehicleParameters; 2],
) -> Vec<Caveat> {
    let of_role = |((role, choice), vehicle): ((Role, &VehicleChoice), &VehicleParameters)| {
        let is_named = *choice != VehicleChoice::Automatic || scenario.vehicle_name(role).is_some();
        is_named.then(|| other_than(scenario, role, vehicle)).flatten()
    };
    let named = Role::ALL.into_iter().zip(choices).zip(vehicles).filter_map(of_role);
    named.chain(two_frictions(scenario, vehicles)).collect()
}

/// That the files of both vehicles have the friction of different roads, and nobody said that of the road
/// on which they meet.
fn two_frictions(scenario: &Scenario, vehicles: [&VehicleParameters; 2]) -> Option<Caveat> {
    let [struck, striking] = vehicles.map(|vehicle| vehicle.tires.friction);
    let is_one = (struck - striking).abs() <= FRICTION_TOLERANCE;
    (!is_one && scenario.striking.fixed.is_none()).then(|| {
        let text = Phrase::new(
            "each moves on the friction of its own file, the struck vehicle on {0} and the striking one on \
             {1}, where one road has one; --friction says it for both",
            "Jedes Fahrzeug hat den Reibbeiwert aus seiner Datei, das gestoßene {0} und das stoßende {1}; \
             eine Fahrbahn hat nur einen, der für beide anzugeben ist",
        )
        .with(PhraseValue::three_digits(Quantity::Ratio, struck))
        .with(PhraseValue::three_digits(Quantity::Ratio, striking));
        let caveat = Caveat::new(CaveatKind::OtherVehicle, text);
        Caveat { subject: Some(CaveatSubject::Striking), ..caveat }
    })
}

fn other_than(scenario: &Scenario, role: Role, vehicle: &VehicleParameters) -> Option<Caveat> {
    let is_other = |number: &SharedNumber| {
        let tolerance = match number.key {
            "mass.mass_kg" => MASS_TOLERANCE,
            "mass.yaw_inertia_kg_m2" => INERTIA_TOLERANCE,
            _ => LENGTH_TOLERANCE,
        };
        // What is an estimate of the vehicle is no word against the collision, and a place of the centre of
        // gravity in the outline none against that of the vehicle.
        !vehicle.estimates.contains_key(number.key)
            && number.key != "geometry.cg_to_front_end_m"
            && (number.in_scenario / number.in_vehicle - 1.0).abs() > tolerance
    };
    let others: Vec<SharedNumber> =
        scenario.vehicle(role).beside(vehicle).into_iter().filter(is_other).collect();
    if others.is_empty() {
        return None;
    }
    let said = others.iter().map(|number| instead(number, number.in_scenario, number.in_vehicle));
    let text = Phrase::new(
        "{0} as the collision has it: {1}",
        "{0} weicht in der Kollision vom Datenblatt ab: {1}",
    )
    .with(BuiltInVehicle::name_in_phrase(&vehicle.name))
    .with(PhraseValue::phrase(Phrase::joined(said, ", ")));
    let subject = match role {
        Role::Struck => CaveatSubject::Vehicle,
        Role::Striking => CaveatSubject::Striking,
    };
    Some(Caveat { subject: Some(subject), ..Caveat::new(CaveatKind::OtherVehicle, text) })
}

/// What a scenario takes over from a vehicle, in words; `None` if it says the same.
pub(crate) fn taken_over(
    scenario: &Scenario,
    role: Role,
    vehicle: &VehicleParameters,
    units: UnitSystem,
) -> Option<String> {
    let before = scenario.vehicle(role);
    let mut now = before.clone();
    now.take(vehicle);
    let told = |(now, before): (SharedNumber, SharedNumber)| {
        let [now_is, before_was] = [now.in_scenario, before.in_scenario];
        (now_is != before_was).then(|| instead(&now, now_is, before_was))
    };
    let numbers = now.beside(vehicle).into_iter().zip(before.beside(vehicle));
    let format = NumberFormat::english(units);
    let said = Phrase::joined(numbers.filter_map(told), ", ").say(&format);
    let name = BuiltInVehicle::name_in_units(&vehicle.name, &vehicle.name, &format);
    (!said.is_empty())
        .then(|| format!("{}: {} as {name} has it: {said}", scenario.name, role.label()))
}

fn instead(number: &SharedNumber, value: f64, before: f64) -> Phrase {
    Phrase::new("{0} {1} instead of {2}", "{0} {1} statt {2}")
        .with(PhraseValue::Term(number.name.to_owned()))
        .with(PhraseValue::three_digits(number.quantity, value))
        .with(PhraseValue::three_digits(number.quantity, before).bare())
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::units::{Language, three_digits};
    use impactlab_core::vehicle::{Preset, built_in_vehicle};

    /// “Friction of the road 0.3” stood over a striking car on 0.8.
    #[test]
    fn vehicles_on_different_frictions_are_named() {
        let vehicle = built_in_vehicle("reference-2000").unwrap();
        let wet = vehicle.clone().with_friction(0.3);
        let found = |vehicles| two_frictions(&Scenario::example(), vehicles);
        assert_eq!(found([&vehicle, &vehicle]), None);
        let caveat = found([&wet, &vehicle]).unwrap();
        assert!(caveat.is_warning() && caveat.text.contains("struck vehicle on 0.3"), "{caveat}");
    }

    #[test]
    fn a_car_with_the_mass_of_another_one_is_named_with_both() {
        let vehicle = built_in_vehicle("toyota-corolla-2020").unwrap();
        let mut scenario = Scenario::example();
        let other = |scenario: &Scenario| other_than(scenario, Role::Struck, &vehicle);
        let caveat = other(&scenario).unwrap();
        assert_eq!(caveat.subject, Some(CaveatSubject::Vehicle));
        assert!(caveat.is_warning());
        let mass = three_digits(vehicle.mass.mass_kg);
        assert!(caveat.text.contains(&format!("mass 2000 kg instead of {mass}")), "{caveat}");
        let us = caveat.in_units(UnitSystem::Us);
        assert!(us.text.contains("mass 4409 lb instead of "), "{us}");
        let german = NumberFormat { units: UnitSystem::Si, language: Language::De };
        let german = caveat.text_in(&german, &str::to_owned).unwrap();
        assert!(german.contains(&format!("mass 2000 kg statt {mass}")), "{german}");
        let shipped = Preset::Target.parameters();
        let mut heavy = scenario.clone();
        heavy.struck.mass_kg = 2500.0;
        let caveat = other_than(&heavy, Role::Struck, &shipped).unwrap();
        assert!(caveat.text.starts_with("FEA target (2000 kg) as the collision"), "{caveat}");
        let us = caveat.in_units(UnitSystem::Us);
        assert!(us.text.starts_with("FEA target (4409 lb) as the collision"), "{us}");
        scenario.struck.take(&vehicle);
        scenario.struck.mass_kg += 30.0;
        assert_eq!(other(&scenario), None);
        // The outline of this one is an estimate.
        let reference = built_in_vehicle("reference-2000").unwrap();
        let example = Scenario::example();
        assert!((example.struck.length_m / reference.geometry.outer_length_m - 1.0).abs() > 0.05);
        assert_eq!(other_than(&example, Role::Struck, &reference), None);
    }
}
