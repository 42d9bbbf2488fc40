//! Where the numbers of a collision are not those of the vehicle that was chosen for it.

use impactlab_core::collision::{Scenario, ScenarioVehicle};
use impactlab_core::uncertainty::{Caveat, CaveatKind, CaveatSubject};
use impactlab_core::vehicle::VehicleParameters;

use crate::VehicleChoice;
use crate::caveats::assumed::three_digits;

/// Relative difference beyond which a value is another one: of a mass, a passenger; of a yaw inertia,
/// more than the mass explains; of an outline, more than a bumper is worth.
const MASS_TOLERANCE: f64 = 0.03;
const INERTIA_TOLERANCE: f64 = 0.15;
const LENGTH_TOLERANCE: f64 = 0.04;

/// What a scenario says otherwise than the vehicles that were chosen for it by name. The motion is that
/// of the numbers of the scenario on the tires of the vehicle: it is the motion of neither car.
///
/// - `choices`: the struck vehicle and the striking one, as the question names them;
/// - `vehicles`: the same, before they take over the numbers of the scenario.
pub(crate) fn other_vehicles(
    scenario: &Scenario,
    choices: [&VehicleChoice; 2],
    vehicles: [&VehicleParameters; 2],
) -> Vec<Caveat> {
    let names = [&scenario.struck_vehicle, &scenario.striking_vehicle];
    let collision = [&scenario.struck, &scenario.striking];
    let other = |(i, subject): (usize, CaveatSubject)| {
        let is_named = *choices[i] != VehicleChoice::Automatic || names[i].is_some();
        is_named.then(|| other_than(subject, collision[i], vehicles[i])).flatten()
    };
    let subjects = [(0, CaveatSubject::Vehicle), (1, CaveatSubject::Striking)];
    subjects.into_iter().filter_map(other).collect()
}

fn other_than(
    subject: CaveatSubject,
    collision: &ScenarioVehicle,
    vehicle: &VehicleParameters,
) -> Option<Caveat> {
    let mass_kg = collision.mass_kg;
    // The inertia that this mass gives the vehicle, so that a load alone is not listed twice.
    let of_mass = vehicle.clone().with_mass(mass_kg, None);
    let (geometry, mass) = (&vehicle.geometry, &vehicle.mass);
    let rows = [
        ("mass", "mass.mass_kg", [mass_kg, mass.mass_kg], "kg", MASS_TOLERANCE),
        (
            "yaw inertia",
            "mass.yaw_inertia_kg_m2",
            [collision.yaw_inertia_kg_m2, of_mass.mass.yaw_inertia_kg_m2],
            "kg m²",
            INERTIA_TOLERANCE,
        ),
        (
            "length",
            "geometry.outer_length_m",
            [collision.length_m, geometry.outer_length_m],
            "m",
            LENGTH_TOLERANCE,
        ),
        (
            "width",
            "geometry.outer_width_m",
            [collision.width_m, geometry.outer_width_m],
            "m",
            LENGTH_TOLERANCE,
        ),
    ];
    // What is an estimate of the vehicle is no word against the collision.
    let is_other = |key: &str, [collision, vehicle_has]: [f64; 2], tolerance: f64| {
        !vehicle.estimates.contains_key(key) && (collision / vehicle_has - 1.0).abs() > tolerance
    };
    let others: Vec<String> = rows
        .into_iter()
        .filter(|(_, key, values, _, tolerance)| is_other(key, *values, *tolerance))
        .map(|(name, _, values, unit, _)| {
            let [collision, vehicle] = values.map(three_digits);
            format!("{name} {collision} {unit} instead of {vehicle}")
        })
        .collect();
    if others.is_empty() {
        return None;
    }
    let text = format!("{} as the collision has it: {}", vehicle.name, others.join(", "));
    Some(Caveat { subject: Some(subject), ..Caveat::new(CaveatKind::OtherVehicle, text) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::vehicle::built_in_vehicle;

    #[test]
    fn a_car_with_the_mass_of_another_one_is_named_with_both() {
        let vehicle = built_in_vehicle("toyota-corolla-2020").unwrap();
        let mut collision = Scenario::example().struck;
        let caveat = other_than(CaveatSubject::Vehicle, &collision, &vehicle).unwrap();
        assert!(caveat.is_warning());
        let mass = three_digits(vehicle.mass.mass_kg);
        assert!(caveat.text.contains(&format!("mass 2000 kg instead of {mass}")), "{caveat}");
        collision.mass_kg = vehicle.mass.mass_kg + 30.0;
        collision.yaw_inertia_kg_m2 = vehicle.mass.yaw_inertia_kg_m2;
        collision.length_m = vehicle.geometry.outer_length_m;
        collision.width_m = vehicle.geometry.outer_width_m;
        assert_eq!(other_than(CaveatSubject::Vehicle, &collision, &vehicle), None);
        // The outline of this one is an estimate.
        let reference = built_in_vehicle("reference-2000").unwrap();
        let example = Scenario::example().struck;
        assert!((example.length_m / reference.geometry.outer_length_m - 1.0).abs() > 0.05);
        assert_eq!(other_than(CaveatSubject::Vehicle, &example, &reference), None);
    }
}
