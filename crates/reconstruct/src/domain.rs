//! Vehicles, roads and damage that a reconstruction is not made for.

use crate::evidence::{Damage, Evidence, Measured};
use crate::{Car, Cars};
use impactlab_core::collision::{Footprint, OffOutline, Side};
use impactlab_core::uncertainty::{Caveat, CaveatKind};
use impactlab_core::units::{Phrase, PhraseValue, Quantity, STANDARD_GRAVITY_M_S2};
use impactlab_core::vehicle::sheet::SheetQuantity;
use impactlab_core::vehicle::{FrictionZone, VehicleParameters, hidden_zones};

/// A quantity of a vehicle with the range over which the rules of the data sheet were fitted and the
/// 4DOF model was tried: the vehicles of
/// [`Ncap2004`](impactlab_core::bibliography::Ncap2004) and of the library, and the multibody cars of the
/// fleet; cars, vans and light trucks.
struct Known {
    name: &'static str,
    unit: &'static str,
    quantity: fn(&VehicleParameters) -> f64,
    range: [f64; 2],
}

/// What is compared: the lightest is a micro car, the heaviest a large SUV, and the longest wheelbase
/// that of a pickup.
const KNOWN: [Known; 5] = [
    Known { name: "mass", unit: "kg", quantity: |car| car.mass.mass_kg, range: [900.0, 2750.0] },
    Known {
        name: "wheelbase",
        unit: "m",
        quantity: |car| car.geometry.wheelbase_m(),
        range: [2.25, 3.70],
    },
    Known {
        name: "track",
        unit: "m",
        quantity: |car| car.geometry.track_width_m,
        range: [1.34, 1.74],
    },
    Known {
        name: "load of the front axle",
        unit: "kg",
        quantity: front_load_kg,
        range: AXLE_LOAD_KG,
    },
    Known {
        name: "load of the rear axle",
        unit: "kg",
        quantity: rear_load_kg,
        range: AXLE_LOAD_KG,
    },
];

/// Load of an axle at rest as a mass, kg, of the same vehicles.
const AXLE_LOAD_KG: [f64; 2] = [350.0, 1500.0];

/// Peak friction of the roads on which the 4DOF model was tried: `datasets/trajectories-fleet` and
/// `datasets/staged`.
const ROAD_FRICTION: [f64; 2] = [0.3, 0.9];

/// Standard deviations within which a measured friction may lie on such a road.
const FRICTION_REACH: f64 = 2.0;

/// Standard deviations by which the place of the damage may be off.
const DAMAGE_REACH: f64 = 3.0;

fn front_load_kg(car: &VehicleParameters) -> f64 {
    let [left, right, ..] = car.static_loads_n();
    (left + right) / STANDARD_GRAVITY_M_S2
}

fn rear_load_kg(car: &VehicleParameters) -> f64 {
    let [.., left, right] = car.static_loads_n();
    (left + right) / STANDARD_GRAVITY_M_S2
}

/// What of a case lies outside of what rules, priors and model are known to hold for, damage off its car, and what is
/// odd about the evidence and the zones by themselves.
///
/// - `zones`: parts of the ground with their own friction.
pub fn outside_domain(evidence: &Evidence, cars: &Cars, zones: &[FrictionZone]) -> Vec<Caveat> {
    let road = road_caveat(evidence.road_friction());
    let vehicles: Vec<Caveat> = match evidence.is_single_car() {
        true => car_caveats("car", &cars.struck).collect(),
        false => vehicle_caveats(cars),
    };
    let damage = damage_off_car(&evidence.damage, cars);
    let stopped = evidence.stopped_rests().into_iter();
    let stopped = stopped.map(|text| Caveat::new(CaveatKind::SecondContact, text));
    let odd = evidence.odd().into_iter().chain(evidence.odd_rests(cars));
    let odd = odd.chain(evidence.odd_distances(cars)).chain(hidden_zones(zones));
    let odd = odd.map(|text| Caveat::new(CaveatKind::DoubtfulData, text));
    vehicles
        .into_iter()
        .chain(road)
        .chain(zone_caveats(zones))
        .chain(damage)
        .chain(stopped)
        .chain(odd)
        .collect()
}

/// What of both vehicles lies outside of what rules and model are known to hold for.
fn vehicle_caveats(cars: &Cars) -> Vec<Caveat> {
    let both = [("struck car", &cars.struck), ("striking car", &cars.striking)];
    both.into_iter().flat_map(|(which, car)| car_caveats(which, car)).collect()
}

fn car_caveats<'a>(which: &'a str, car: &'a Car) -> impl Iterator<Item = Caveat> + 'a {
    KNOWN.iter().filter_map(move |Known { name, unit, quantity, range }| {
        let value = quantity(&car.parameters);
        let [low, high] = *range;
        let quantity = Quantity::from_si_symbol(unit).unwrap_or(Quantity::Ratio);
        let number = |value| PhraseValue::significant(quantity, value);
        let text = Phrase::new(
            "{0}: {1} is {2}; what is estimated of a vehicle, how it moves and what is \
             assumed beforehand is known of cars and vans of {3} to {4}",
            "{0}: {1} beträgt {2}. Schätzregeln, Bewegungsmodell und Vorannahmen gelten für Pkw und \
             Transporter von {3} bis {4}",
        )
        .with(PhraseValue::Term(which.to_owned()))
        .with(PhraseValue::Term((*name).to_owned()))
        .with(number(value))
        .with(number(low).bare())
        .with(number(high));
        let caveat = Caveat::new(CaveatKind::OutsideDomain, text)
            .with_value(format!("{name} of the {which} [{unit}]"), value)
            .with_range(*range);
        (!(low..=high).contains(&value)).then_some(caveat)
    })
}

/// A road whose measured friction is beyond those on which the model was tried.
fn road_caveat(friction: Option<Measured>) -> Option<Caveat> {
    let Measured { value, sigma } = friction?;
    let [low, high] = ROAD_FRICTION;
    let reach = FRICTION_REACH * sigma;
    let text = Phrase::new(
        "friction of the road is {0}; how a car moves is known of roads of {1} to {2}",
        "Der Reibbeiwert der Fahrbahn beträgt {0}. Das Bewegungsmodell ist auf Fahrbahnen mit {1} bis {2} \
         erprobt",
    )
    .with(PhraseValue::significant(Quantity::Ratio, value))
    .with(PhraseValue::given(Quantity::Ratio, low))
    .with(PhraseValue::given(Quantity::Ratio, high));
    let caveat = Caveat::new(CaveatKind::OutsideDomain, text)
        .with_value("friction of the road", value)
        .with_range(ROAD_FRICTION);
    (!(low - reach..=high + reach).contains(&value)).then_some(caveat)
}

/// Zones of the ground whose friction is beyond that of the roads on which the model was tried.
fn zone_caveats(zones: &[FrictionZone]) -> impl Iterator<Item = Caveat> {
    let [low, high] = ROAD_FRICTION;
    let outside = zones.iter().filter(move |zone| !(low..=high).contains(&zone.friction));
    outside.map(move |zone| {
        let text = Phrase::new(
            "friction of the zone {0} is {1}; how a car moves is known of roads of {2} to {3}",
            "Der Reibbeiwert des Bereichs {0} beträgt {1}. Das Bewegungsmodell ist auf Fahrbahnen mit \
             {2} bis {3} erprobt",
        )
        .with(PhraseValue::Name(format!("{:?}", zone.name)))
        .with(PhraseValue::given(Quantity::Ratio, zone.friction))
        .with(PhraseValue::given(Quantity::Ratio, low))
        .with(PhraseValue::given(Quantity::Ratio, high));
        Caveat::new(CaveatKind::OutsideDomain, text)
            .with_value(format!("friction of the zone {:?}", zone.name), zone.friction)
            .with_range(ROAD_FRICTION)
    })
}

/// Checks that the struck car is where the damage is said to be, within the errors of the damage.
///
/// # Errors
/// [`OffOutline`] with the distance.
pub fn check_damage(damage: &Damage, cars: &Cars) -> Result<(), OffOutline> {
    let footprint = Footprint::from(&cars.struck.parameters.geometry);
    let Some(Measured { value, sigma }) = damage.along() else { return Ok(()) };
    let across_m = damage.depth_m.unwrap_or_else(|| cars.depth_of(damage.struck_side()));
    let reach_m = DAMAGE_REACH * sigma;
    let along_m = value - value.clamp(-reach_m, reach_m);
    let point = |along_m: f64| match damage.struck_side() {
        Side::Left | Side::Right => [along_m, across_m],
        Side::Front | Side::Rear => [across_m, along_m],
    };
    match footprint.check_contact(point(along_m)) {
        Ok(()) => Ok(()),
        Err(_) => footprint.check_contact(point(value)),
    }
}

/// Damage that lies off the struck car by more than the errors of both, though not so far that it is refused.
fn damage_off_car(damage: &Damage, cars: &Cars) -> Option<Caveat> {
    let Measured { value, sigma } = damage.along()?;
    let geometry = &cars.struck.parameters.geometry;
    let (size, size_m, high) = match damage.struck_side() {
        Side::Left | Side::Right => {
            (SheetQuantity::Length, geometry.outer_length_m, geometry.cg_to_front_end_m)
        }
        Side::Front | Side::Rear => {
            (SheetQuantity::Width, geometry.outer_width_m, geometry.outer_width_m / 2.0)
        }
    };
    let low = high - size_m;
    let off_m = (low - value).max(value - high);
    let text = Phrase::new(
        "the damage lies {0} off the struck car, which reaches from {1} to {2} along that side: check the place of \
         the damage, or state length and width of the car",
        "Der Schaden liegt {0} außerhalb des gestoßenen Fahrzeugs, das auf dieser Seite von {1} bis {2} reicht: Lage \
         des Schadens prüfen oder Länge und Breite des Fahrzeugs angeben",
    )
    .with(PhraseValue::fixed(Quantity::Length, off_m, 2))
    .with(PhraseValue::fixed(Quantity::Length, low, 2).bare())
    .with(PhraseValue::fixed(Quantity::Length, high, 2));
    let caveat = Caveat::new(CaveatKind::DoubtfulData, text)
        .with_value("damage along the side [m]", value)
        .with_range([low, high]);
    let size_sigma_m = size_m * cars.struck.scatter(size).unwrap_or(0.0);
    (off_m > sigma.hypot(size_sigma_m)).then_some(caveat)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evidence::CarEvidence;
    use crate::evidence::examples::{SPIN, read};
    use impactlab_core::vehicle::LibraryVehicle;

    fn outside(evidence: &Evidence) -> Vec<(String, f64)> {
        let caveats = vehicle_caveats(&Cars::new(evidence, None, None));
        caveats
            .into_iter()
            .map(|caveat| (caveat.quantity.unwrap(), caveat.value.unwrap()))
            .collect()
    }

    #[test]
    fn a_lorry_is_named_with_what_is_too_heavy_and_a_toy_with_what_is_too_short() {
        let mut evidence = read(SPIN);
        assert_eq!(outside(&evidence), []);
        evidence.struck_car.mass_kg = Some(Measured { value: 20_170.0, sigma: 100.0 }.into());
        let lorry = outside(&evidence);
        let names: Vec<&str> = lorry.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(
            names,
            [
                "mass of the struck car [kg]",
                "load of the front axle of the struck car [kg]",
                "load of the rear axle of the struck car [kg]",
            ]
        );
        assert_eq!(lorry[0].1, 20_170.0);
        assert!((lorry[1].1 + lorry[2].1 - 20_170.0).abs() < 1e-6, "{lorry:?}");
        evidence.struck_car.mass_kg = None;
        evidence.striking_car.cg_to_front_axle_m = Some(0.4);
        evidence.striking_car.cg_to_rear_axle_m = Some(0.5);
        evidence.striking_car.track_m = Some(2.4);
        let toy = outside(&evidence);
        let expected = ["wheelbase of the striking car [m]", "track of the striking car [m]"];
        assert_eq!(toy.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>(), expected);
    }

    #[test]
    fn ice_and_glue_are_roads_that_nobody_tried() {
        let outside = |value| road_caveat(Some(Measured { value, sigma: 0.04 })).is_some();
        assert_eq!([0.15, 0.3, 0.95, 1.59].map(outside), [true, false, false, true]);
        assert_eq!(road_caveat(None), None);
    }

    #[test]
    fn no_vehicle_of_the_library_lies_outside() {
        let evidence = Evidence { striking_car: CarEvidence::default(), ..read(SPIN) };
        for vehicle in LibraryVehicle::ALL {
            let cars = Cars::new(&evidence, None, Some(&vehicle.parameters()));
            assert_eq!(vehicle_caveats(&cars), [], "{}", vehicle.id());
        }
    }

    #[test]
    fn damage_lies_at_the_car_within_its_errors() {
        let mut evidence = read(SPIN);
        let check = |evidence: &Evidence| {
            check_damage(&evidence.damage, &Cars::new(evidence, None, None))
                .map_err(|off| off.x_body_m)
        };
        assert_eq!(check(&evidence), Ok(()));
        evidence.damage.along_m = Some(Measured { value: -8.0, sigma: 0.1 }.into());
        assert_eq!(check(&evidence), Err(-8.0));
        evidence.damage.along_m = Some(Measured { value: -8.0, sigma: 2.0 }.into());
        assert_eq!(check(&evidence), Ok(()));
    }

    /// The rear of a car of which nothing is known is 2.7 m behind its CG, give or take 0.4 m.
    #[test]
    fn damage_a_little_off_the_car_is_named() {
        let mut evidence = read(SPIN);
        let mut off = |value: f64, sigma: f64, length_m: Option<f64>| {
            evidence.damage.along_m = Some(Measured { value, sigma }.into());
            evidence.struck_car.length_m = length_m;
            damage_off_car(&evidence.damage, &Cars::new(&evidence, None, None)).is_some()
        };
        assert!(!off(-1.7, 0.1, None));
        assert!(off(-3.2, 0.1, None));
        assert!(!off(-3.2, 2.0, None));
        assert!(!off(-3.2, 0.1, Some(6.5)));
    }
}
