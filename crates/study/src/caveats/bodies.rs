//! Numbers of vehicles, of a scenario or of a data sheet, that hardly are those of vehicles.

use crate::caveats::restrictions;
use impactlab_core::collision::{Role, Scenario};
use impactlab_core::uncertainty::{Caveat, CaveatKind, CaveatSubject};
use impactlab_core::units::{Phrase, PhraseValue, Quantity};
use impactlab_core::vehicle::sheet::Unusual;
use impactlab_core::vehicle::{BuiltInVehicle, VehicleParameters};

/// Radius of gyration about the vertical axis as a share of the length. Of cars, vans and trucks it is 0.25 to
/// 0.33: those of the library have 0.28 to 0.32, and an even rod has 0.29.
const GYRATION_OF_LENGTH: [f64; 2] = [0.2, 0.4];

/// Distance of the CG from the front end as a share of the length. Of cars, vans and trucks it is 0.4 to 0.55; beyond
/// is one from the front axle, or from the rear end.
const CG_OF_LENGTH: [f64; 2] = [0.33, 0.67];

/// Mass from which a body stands for a barrier, whose inertia is as large as one likes, kg.
const BARRIER_KG: f64 = 1e5;

/// What the numbers of both vehicles say that a slip of the hand or of a unit explains better.
pub(crate) fn doubtful(scenario: &Scenario) -> Vec<Caveat> {
    let is_vehicle = |role: &Role| {
        let vehicle = scenario.vehicle(*role);
        vehicle.fixed.is_none() && vehicle.mass_kg < BARRIER_KG
    };
    let found = Role::ALL.into_iter().filter(is_vehicle).flat_map(|role| {
        uneven_caveat(scenario, role).into_iter().chain(cg_caveat(scenario, role))
    });
    restrictions::backwards(scenario)
        .into_iter()
        .chain(found)
        .chain(odd_numbers(scenario))
        .collect()
}

/// Numbers of the file that are hardly meant in their units. A wall is as wide as it is.
fn odd_numbers(scenario: &Scenario) -> impl Iterator<Item = Caveat> {
    let is_fixed = scenario.striking.fixed.is_some() || scenario.striking.mass_kg >= BARRIER_KG;
    scenario.ranges().into_iter().filter_map(move |(key, value, range)| {
        let is_striking = key.starts_with("bullet");
        let text = range.odd(&key, value).filter(|_| !(is_fixed && key.starts_with("bullet.")))?;
        let subject = match is_striking {
            true => CaveatSubject::Striking,
            false => CaveatSubject::Vehicle,
        };
        let caveat = Caveat::new(CaveatKind::DoubtfulData, text);
        Some(Caveat { subject: Some(subject), ..caveat })
    })
}

/// What the data sheet of a vehicle states and no car of its other figures has, and what is hardly meant in its unit.
///
/// - `subject`: which vehicle of the question it is.
pub(crate) fn unusual(
    vehicle: &VehicleParameters,
    subject: CaveatSubject,
) -> impl Iterator<Item = Caveat> {
    let caveat = move |text: Phrase| Caveat {
        subject: Some(subject),
        ..Caveat::new(CaveatKind::DoubtfulData, text)
    };
    unusual_phrases(vehicle).into_iter().map(caveat)
}

/// The same in words.
pub(crate) fn unusual_phrases(vehicle: &VehicleParameters) -> Vec<Phrase> {
    let phrase = |unusual: &Unusual| {
        let Unusual { quantity, stated, by_rule } = *unusual;
        let unit = Quantity::from_si_symbol(quantity.unit()).unwrap_or(Quantity::Ratio);
        Phrase::new(
            "{0}: {1} {2}, where a car of its other figures has about {3}; it may be in another unit, or twice \
             or half of what is meant",
            "{0}: {1} {2}, wo ein Fahrzeug mit den übrigen Angaben etwa {3} hat; vielleicht eine andere Einheit, \
             oder das Doppelte oder die Hälfte des Gemeinten",
        )
        .with(BuiltInVehicle::name_in_phrase(&vehicle.name))
        .with(PhraseValue::Term(quantity.label().to_owned()))
        .with(PhraseValue::three_digits(unit, stated))
        .with(PhraseValue::three_digits(unit, by_rule))
    };
    let unusual = vehicle.sheet.as_ref().map_or_else(Vec::new, |sheet| sheet.unusual());
    unusual.iter().map(phrase).chain(vehicle.odd_numbers()).collect()
}

/// A vehicle in words, and as what an answer is about.
fn named(role: Role) -> (Phrase, CaveatSubject) {
    match role {
        Role::Struck => {
            (Phrase::new("the struck vehicle", "beim gestoßenen Fahrzeug"), CaveatSubject::Vehicle)
        }
        Role::Striking => (
            Phrase::new("the striking vehicle", "beim stoßenden Fahrzeug"),
            CaveatSubject::Striking,
        ),
    }
}

/// A CG that lies where no vehicle of that length has it.
fn cg_caveat(scenario: &Scenario, role: Role) -> Option<Caveat> {
    let vehicle = scenario.vehicle(role);
    let [low, high] = CG_OF_LENGTH;
    let share = vehicle.cg_from_front_m / vehicle.length_m;
    if (low..=high).contains(&share) {
        return None;
    }
    let (which, subject) = named(role);
    let text = Phrase::new(
        "of {0}, the CG is {1} behind the front end of {2} of length, and of cars at 40 to 55 % of it; it may have been \
         measured from an axle or from the rear",
        "{0} liegt der Schwerpunkt {1} hinter dem vorderen Ende bei {2} Länge, bei Fahrzeugen bei 40 bis 55 % davon; \
         vielleicht ist von einer Achse oder von hinten gemessen",
    )
    .with(PhraseValue::phrase(which))
    .with(PhraseValue::three_digits(Quantity::Length, vehicle.cg_from_front_m))
    .with(PhraseValue::three_digits(Quantity::Length, vehicle.length_m));
    let caveat = Caveat::new(CaveatKind::DoubtfulData, text)
        .with_value("distance of the CG from the front over the length", share)
        .with_range(CG_OF_LENGTH);
    Some(Caveat { subject: Some(subject), ..caveat })
}

/// A yaw inertia that no vehicle of that mass and length has.
fn uneven_caveat(scenario: &Scenario, role: Role) -> Option<Caveat> {
    let vehicle = scenario.vehicle(role);
    let [low, high] = GYRATION_OF_LENGTH;
    let share = (vehicle.yaw_inertia_kg_m2 / vehicle.mass_kg).sqrt() / vehicle.length_m;
    if (low..=high).contains(&share) {
        return None;
    }
    let (which, subject) = named(role);
    let text = Phrase::new(
        "of {0}, a yaw inertia of {1} does not fit a mass of {2} and a length of {3}: the radius of gyration is \
         {4} of the length, and of cars 25 to 33 %; one of the three may be in another unit",
        "{0} passt das Gierträgheitsmoment von {1} nicht zur Masse von {2} und zur Länge von {3}: Der \
         Trägheitsradius beträgt {4} der Länge, bei Fahrzeugen sind es 25 bis 33 %; eine der drei Angaben hat \
         vielleicht eine andere Einheit",
    )
    .with(PhraseValue::phrase(which))
    .with(PhraseValue::three_digits(Quantity::MomentOfInertia, vehicle.yaw_inertia_kg_m2))
    .with(PhraseValue::three_digits(Quantity::Mass, vehicle.mass_kg))
    .with(PhraseValue::three_digits(Quantity::Length, vehicle.length_m))
    .with(PhraseValue::Share(share));
    let caveat = Caveat::new(CaveatKind::DoubtfulData, text)
        .with_value("radius of gyration over the length", share)
        .with_range(GYRATION_OF_LENGTH);
    Some(Caveat { subject: Some(subject), ..caveat })
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::collision::ScenarioSkid;
    use impactlab_core::vehicle::{
        Braking, DataSheet, Ending, SheetQuantity, VehicleClass, built_in_vehicle,
    };
    use std::path::Path;

    #[test]
    fn an_inertia_that_does_not_fit_mass_and_length_is_named() {
        assert!(doubtful(&Scenario::example()).is_empty());
        let change = |change: fn(&mut Scenario)| {
            let mut scenario = Scenario::example();
            change(&mut scenario);
            doubtful(&scenario)
        };
        // Tonnes as kilograms, kilograms as pounds, an inertia in another unit, feet as metres, which lets the CG lie
        // ahead of the rest, and a CG that was measured from the front axle.
        let slips: [fn(&mut Scenario); 5] = [
            |scenario| scenario.striking.mass_kg /= 1000.0,
            |scenario| scenario.striking.mass_kg *= 0.453_592_37,
            |scenario| scenario.striking.yaw_inertia_kg_m2 /= 1.355_817_9,
            |scenario| scenario.striking.length_m /= 0.3048,
            |scenario| scenario.struck.cg_from_front_m = 1.25,
        ];
        let found = slips.map(change);
        for (at, n) in [(0, 1), (1, 1), (2, 0), (3, 2), (4, 1)] {
            assert_eq!(found[at].len(), n, "{at}: {:?}", found[at]);
        }
        let light = &found[0][0];
        assert!(light.is_warning());
        assert_eq!(light.subject, Some(CaveatSubject::Striking));
        let words =
            "of the striking vehicle, a yaw inertia of 3600 kg m² does not fit a mass of 2 kg and";
        assert!(light.text.starts_with(words), "{light}");
    }

    /// A brake after 350 s never acts in a motion of seconds, and nobody saw it.
    #[test]
    fn numbers_of_a_scenario_in_another_unit_are_named() {
        let brake = Braking {
            start_s: 350.0,
            share_of_friction: 0.8,
            rise_s: 0.3,
            front_share: None,
            lock_delay_s: 0.0,
            abs: None,
        };
        let skid = ScenarioSkid { length_m: 20.0, drag_factor: 1.9 };
        let mut scenario = Scenario::example();
        scenario.ending = Some(Ending { brake: Some(brake), ..Ending::default() });
        scenario.striking.skid = Some(skid);
        let found = doubtful(&scenario);
        assert_eq!(found.len(), 2, "{found:?}");
        assert_eq!(found[0].subject, Some(CaveatSubject::Striking));
        assert!(
            found[0].text.starts_with("bullet.skid_drag_factor is 1.9, and of"),
            "{}",
            found[0]
        );
        assert!(found[1].text.starts_with("ending.brake.start_s is 350 s, and of"), "{}", found[1]);
        assert!(found[1].text.ends_with("is it in ms?"), "{}", found[1]);
    }

    #[test]
    fn a_data_sheet_with_a_figure_in_another_unit_is_named() {
        let vehicle = DataSheet::new("my car", VehicleClass::Car)
            .with(SheetQuantity::Mass, 680.0)
            .with(SheetQuantity::Length, 4.7)
            .with(SheetQuantity::Width, 1.8)
            .vehicle();
        let found: Vec<Caveat> = unusual(&vehicle, CaveatSubject::Striking).collect();
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].is_warning() && found[0].subject == Some(CaveatSubject::Striking));
        let words = "my car: mass 680 kg, where a car of its other figures has about 1574 kg;";
        assert!(found[0].text.starts_with(words), "{}", found[0]);
    }

    #[test]
    fn a_vehicle_whose_friction_no_road_has_is_named() {
        let mut vehicle = built_in_vehicle("toyota-corolla-2020").unwrap();
        vehicle.tires.friction = 1.9;
        let found: Vec<Caveat> = unusual(&vehicle, CaveatSubject::Vehicle).collect();
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].text.starts_with("tires.friction is 1.9, and of"), "{}", found[0]);
    }

    #[test]
    fn cars_and_barriers_are_as_they_are() {
        let barrier = Scenario::preset_or_file(Path::new("carpenter-welcher-barrier"));
        assert!(doubtful(&barrier.unwrap()).is_empty());
        for name in ["toyota-corolla-2020", "ford-explorer-2004"] {
            let vehicle = built_in_vehicle(name).unwrap();
            let mut scenario = Scenario::example();
            scenario.struck.take(&vehicle);
            assert!(doubtful(&scenario).is_empty(), "{name}");
        }
    }
}
