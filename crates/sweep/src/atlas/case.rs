//! Where a case lies in the atlas of the PIT manoeuvre.

use std::f64::consts::FRAC_PI_3;

use crate::PitInput;
use crate::atlas::{Atlas, Axis};
use impactlab_core::collision::Scenario;
use impactlab_core::numerics::wrap_angle_rad;
use impactlab_core::units::{NumberFormat, Phrase, Quantity, UnitSystem, significant, trimmed};
use impactlab_core::vehicle::frames::Heading;
use impactlab_core::vehicle::{Ending, PitEnd, VehicleParameters};

/// Masses of the cars of the plan, kg, by how much the striking car is faster along the lane in it, m/s, and how
/// far its heading is beyond its way, rad: what the cells are averaged over, and beyond which they say nothing
/// of a case.
const MASSES_KG: [f64; 2] = [1400.0, 2600.0];
const FASTER_M_S: [f64; 2] = [0.0, 3.0];
const SLIP_RAD: [f64; 2] = [-0.1, 0.1];

/// Greatest angle between the headings of a PIT, rad.
const MOST_ANGLE_RAD: f64 = FRAC_PI_3;

/// A case as the inputs of the atlas.
#[derive(Debug, Clone, PartialEq)]
pub struct CasePlace {
    /// The inputs that the case says, with their values in SI units.
    pub values: Vec<(PitInput, f64)>,
    /// Masses of the struck and the striking car, kg.
    pub masses_kg: [f64; 2],
    /// Whether the driver of the striking car turns in and brakes at the end, as in every row of the plan.
    pub turns_in: bool,
}

/// An input of a case that lies outside of an atlas.
#[derive(Debug, Clone, PartialEq)]
pub struct OutsideInput {
    /// What it is.
    pub label: String,
    quantity: Quantity,
    /// In SI units.
    value: f64,
    /// What the atlas has, in SI units.
    ends: [f64; 2],
}

impl OutsideInput {
    /// What it is, and what the atlas has.
    pub fn text(&self, units: UnitSystem) -> String {
        let [low, high] = self.ends.map(|end| self.without_zeros(end, units));
        format!("{}: {}, the map has {low} to {high}", self.label, self.value(units))
    }

    /// Its value.
    pub fn value(&self, units: UnitSystem) -> String {
        self.without_zeros(self.value, units)
    }

    /// The ends of the atlas are round numbers, which are stated and not measured.
    fn without_zeros(&self, value_si: f64, units: UnitSystem) -> String {
        let unit = self.quantity.display_unit(units);
        let number = trimmed(significant(unit.from_si(value_si)));
        NumberFormat::english(units).with_unit(&number, unit.symbol)
    }

    /// By how much it lies beyond the nearer end, such as `5.000 km/h above`.
    pub fn beyond(&self, units: UnitSystem) -> String {
        let [low, high] = self.ends;
        match self.value < low {
            true => format!("{} below", self.quantity.shown(low - self.value, units)),
            false => format!("{} above", self.quantity.shown(self.value - high, units)),
        }
    }
}

/// How the vehicles of a scenario meet, seen from the struck one. The striking one comes from the right and
/// turns to the left.
struct Meeting {
    /// The contact along the struck vehicle, from its CG, m.
    x_m: f64,
    is_side: bool,
    /// Speeds along the struck vehicle: its own and that of the striking one, m/s.
    along_m_s: [f64; 2],
    /// Speed of the striking vehicle towards its side, m/s.
    closing_m_s: f64,
    angle_rad: f64,
}

impl Meeting {
    /// How they meet; `None` if they do not.
    fn from_scenario(scenario: &Scenario) -> Option<Self> {
        let geometry = scenario.geometry().ok()?;
        let [x_m, y_m] = geometry.struck.body_from_world(geometry.contact_point_world_m);
        // The bumper is touched further in than the sides.
        let is_side = y_m.abs() > 0.4 * scenario.struck.footprint().width_m;
        // The striking car comes from the right to the right side and turns to the left.
        let side = -y_m.signum();
        let lane = Heading::new(scenario.struck.heading_rad);
        let in_lane = |x: f64, y: f64| {
            let [along, left] = lane.body_from_world([x, y]);
            [along, side * left]
        };
        let [speed, _] = in_lane(scenario.struck.vx_world_m_s, scenario.struck.vy_world_m_s);
        let [along, closing_m_s] =
            in_lane(scenario.striking.vx_world_m_s, scenario.striking.vy_world_m_s);
        let between_rad =
            wrap_angle_rad(scenario.striking.heading_rad - scenario.struck.heading_rad);
        let angle_rad = side * between_rad;
        Some(Self { x_m, is_side, along_m_s: [speed, along], closing_m_s, angle_rad })
    }

    /// What of it is not as in a PIT; `None` if it is one.
    fn obstacle(&self) -> Option<&'static str> {
        let [speed, along] = self.along_m_s;
        let obstacles = [
            (!self.is_side, "the contact is at an end of the struck car, and not at its side"),
            (self.x_m >= 0.0, "the contact is not behind the middle of the struck car"),
            (speed <= 0.0, "the struck car does not drive ahead"),
            (along <= 0.0, "the striking car does not drive the same way"),
            (
                self.closing_m_s <= 0.0,
                "the striking car does not close in on the side of the other",
            ),
            (
                !(0.0..=MOST_ANGLE_RAD).contains(&self.angle_rad),
                "the striking car does not point towards the other at up to 60°",
            ),
        ];
        obstacles.into_iter().find_map(|(is_so, what)| is_so.then_some(what))
    }
}

/// Why a scenario has no place in the atlas of the PIT manoeuvre; `None` if it has one.
pub fn why_no_pit(scenario: &Scenario) -> Option<&'static str> {
    match Meeting::from_scenario(scenario) {
        Some(meeting) => meeting.obstacle(),
        None => Some("the vehicles do not meet"),
    }
}

/// The inputs of a case; `None` if it is no PIT: a touch of the side behind the CG of the struck car by
/// one that drives the same way at up to 60° to it and closes in.
///
/// - `struck`: the struck car, on its road.
pub fn place_of_case(scenario: &Scenario, struck: &VehicleParameters) -> Option<CasePlace> {
    let meeting =
        Meeting::from_scenario(scenario).filter(|meeting| meeting.obstacle().is_none())?;
    let Meeting { x_m, along_m_s: [speed, along], closing_m_s: closing, angle_rad, .. } = meeting;
    let ending = scenario.ending.clone().unwrap_or_default();
    let mut values = vec![
        (PitInput::TargetSpeed, speed),
        (PitInput::Closing, closing),
        (PitInput::Faster, along - speed),
        (PitInput::Angle, angle_rad),
        (PitInput::Slip, angle_rad - closing.atan2(along)),
        (PitInput::Overlap, x_m + struck.geometry.cg_to_rear_axle_m),
        (PitInput::Friction, struck.tires.friction),
        (PitInput::Esc, f64::from(u8::from(ending.esc.is_some()))),
    ];
    values.extend(driver(&ending).map(|driver| (PitInput::Driver, driver)));
    let masses_kg = [scenario.struck.mass_kg, scenario.striking.mass_kg];
    let striking = scenario.striking_ending.as_ref().and_then(|ending| ending.pit);
    let turns_in = striking.is_some_and(|driver| driver.end == Some(PitEnd::Brake));
    Some(CasePlace { values, masses_kg, turns_in })
}

/// What the driver does, as the plan counts it; `None` for what is in none of its rows.
fn driver(ending: &Ending) -> Option<f64> {
    let is_other = ending.engine.is_some()
        || ending.drive.is_some()
        || ending.steer.is_some()
        || !ending.damage.is_empty();
    match (ending.countersteer.is_some(), ending.brake.is_some()) {
        _ if is_other => None,
        (false, false) => Some(0.0),
        (true, false) => Some(1.0),
        (false, true) => Some(2.0),
        (true, true) => None,
    }
}

impl CasePlace {
    /// The value of an axis, by the name of its column.
    pub fn value(&self, name: &str) -> Option<f64> {
        self.values.iter().find(|(input, _)| input.name() == name).map(|(_, value)| *value)
    }

    /// The bin of every axis in which the case lies.
    pub fn bins(&self, atlas: &Atlas) -> Vec<Option<usize>> {
        let values: Vec<(&str, f64)> =
            self.values.iter().map(|(input, value)| (input.name(), *value)).collect();
        atlas.locate(&values)
    }

    /// What is done to the cars in this case and in no row of the map, a phrase each; empty if nothing is.
    pub fn other_drivers(&self) -> Vec<Phrase> {
        let striking = Phrase::new(
            "The driver of the striking car does something else in this case than in the atlas: it is \
             another manoeuvre, which may end otherwise.",
            "Der Fahrer des stoßenden Fahrzeugs tut in diesem Fall etwas anderes als im Atlas: Es ist ein \
             anderes Manöver, das anders ausgehen kann.",
        );
        let struck = Phrase::new(
            "The struck car is steered, driven or damaged in this case as in no row of the atlas, in which \
             its driver does nothing, countersteers or brakes: the numbers are averages over these.",
            "Das gestoßene Fahrzeug wird in diesem Fall so gelenkt, angetrieben oder beschädigt, wie es in \
             keiner Rechnung des Atlas vorkommt; dort tut sein Fahrer nichts, lenkt gegen oder bremst: Die \
             Zahlen sind Mittel darüber.",
        );
        let is_known = self.value(PitInput::Driver.name()).is_some();
        let all = [(self.turns_in, striking), (is_known, struck)];
        all.into_iter().filter(|(is_as_in_map, _)| !is_as_in_map).map(|(_, text)| text).collect()
    }

    /// What of the case lies outside of the map, a phrase each; empty if nothing does.
    pub fn outside(&self, atlas: &Atlas, units: UnitSystem) -> Vec<String> {
        self.outside_inputs(atlas).iter().map(|input| input.text(units)).collect()
    }

    /// The inputs that lie outside of the map: those of its axes, and what its cells are averaged over.
    pub fn outside_inputs(&self, atlas: &Atlas) -> Vec<OutsideInput> {
        let of_axis = |axis: &Axis| {
            let value = self.value(&axis.name)?;
            let ends = [*axis.edges.first()?, *axis.edges.last()?];
            let (label, quantity) = (axis.label.clone(), axis.quantity());
            let is_outside = axis.locate(value).is_none();
            is_outside.then_some(OutsideInput { label, quantity, value, ends })
        };
        let [struck, striking] = self.masses_kg;
        let faster = self.value(PitInput::Faster.name());
        // Where the angle is an axis, it is held as any other.
        let is_axis = |input: PitInput| atlas.axis(input.name()).is_some();
        let has_angle = is_axis(PitInput::Angle) || is_axis(PitInput::Slip);
        let slip = self.value(PitInput::Slip.name()).filter(|_| !has_angle);
        let averaged = [
            ("Mass of the struck car", Quantity::Mass, Some(struck), MASSES_KG),
            ("Mass of the striking car", Quantity::Mass, Some(striking), MASSES_KG),
            ("Speed above that of the struck car", Quantity::Speed, faster, FASTER_M_S),
            ("Heading of the striking car beyond its way", Quantity::Angle, slip, SLIP_RAD),
        ];
        let of_averaged =
            |(label, quantity, value, ends): (&str, Quantity, Option<f64>, [f64; 2])| {
                let (label, value) = (label.to_owned(), value?);
                let is_outside = !(ends[0]..=ends[1]).contains(&value);
                is_outside.then_some(OutsideInput { label, quantity, value, ends })
            };
        let axes = atlas.axes.iter().filter_map(of_axis);
        axes.chain(averaged.into_iter().filter_map(of_averaged)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::vehicle::{
        Braking, Countersteer, DEFAULT_BRAKE_RISE_S, PitDriver, Preset, built_in_vehicle,
    };

    #[test]
    fn the_example_is_a_pit_with_the_values_of_its_file() {
        let (scenario, struck) = (Scenario::example(), Preset::Reference.parameters());
        let place = place_of_case(&scenario, &struck).unwrap();
        let value = |input: PitInput| place.value(input.name()).unwrap();
        assert!((value(PitInput::TargetSpeed) - 15.0).abs() < 1e-9);
        let closing = 62.0 / 3.6 * 18_f64.to_radians().sin();
        assert!((value(PitInput::Closing) - closing).abs() < 1e-9);
        assert!((value(PitInput::Angle) - 18_f64.to_radians()).abs() < 1e-9);
        assert!(value(PitInput::Slip).abs() < 1e-9, "it drives where it points");
        assert_eq!((value(PitInput::Esc), value(PitInput::Driver)), (0.0, 0.0));
        assert_eq!(place.other_drivers().len(), 1, "the striking car coasts");
        let driver = PitDriver { end: Some(PitEnd::Brake), ..PitDriver::default() };
        let ending = Ending { pit: Some(driver), ..Ending::default() };
        let scenario = Scenario { striking_ending: Some(ending), ..scenario };
        let place = place_of_case(&scenario, &struck).unwrap();
        assert!(place.other_drivers().is_empty(), "{place:?}");
        assert!(value(PitInput::Overlap).abs() < 0.6, "{place:?}");
    }

    #[test]
    fn a_mirrored_case_has_the_same_place_and_what_is_no_pit_has_none() {
        let (scenario, struck) = (Scenario::example(), Preset::Reference.parameters());
        let place = place_of_case(&scenario, &struck).unwrap();
        let mut mirrored = scenario.clone();
        mirrored.striking.heading_rad *= -1.0;
        mirrored.striking.vy_world_m_s *= -1.0;
        let impactlab_core::collision::ContactLocation::Side { side, .. } =
            &mut mirrored.contact.location
        else {
            panic!("{:?}", mirrored.contact)
        };
        *side = impactlab_core::collision::Side::Left;
        let other = place_of_case(&mirrored, &struck).unwrap();
        for ((input, value), (_, other)) in place.values.iter().zip(&other.values) {
            assert!((value - other).abs() < 1e-9, "{input:?}: {value} {other}");
        }
        assert_eq!(why_no_pit(&scenario), None);
        let mut away = scenario.clone();
        away.striking.vy_world_m_s *= -1.0;
        assert_eq!(place_of_case(&away, &struck), None);
        assert!(why_no_pit(&away).is_some_and(|why| why.contains("does not close in")));
        let mut standing = scenario.clone();
        standing.struck.vx_world_m_s = 0.0;
        assert_eq!(place_of_case(&standing, &struck), None);
        let mut countersteers = scenario;
        let ending = Ending { countersteer: Some(Countersteer::default()), ..Ending::default() };
        countersteers.ending = Some(ending);
        let place = place_of_case(&countersteers, &struck).unwrap();
        assert_eq!(place.value(PitInput::Driver.name()), Some(1.0));
        // Nothing said that no row has a driver who does both.
        let ending = countersteers.ending.get_or_insert_default();
        ending.brake = Some(Braking::new(0.8, 0.8, DEFAULT_BRAKE_RISE_S));
        let place = place_of_case(&countersteers, &struck).unwrap();
        assert_eq!(place.value(PitInput::Driver.name()), None);
        let told = place.other_drivers();
        let format = NumberFormat::english(UnitSystem::Si);
        assert!(told.iter().any(|it| it.say(&format).contains("as in no row")), "{told:?}");
    }

    /// It was said what the map has, and not how far off the case is.
    #[test]
    fn an_input_outside_says_by_how_much() {
        let input = |value| OutsideInput {
            label: "Speed of the struck car".to_owned(),
            quantity: Quantity::Speed,
            value,
            ends: [20.0, 30.0],
        };
        assert_eq!(input(15.0).beyond(UnitSystem::Si), "18.00 km/h below");
        assert_eq!(input(35.0).beyond(UnitSystem::Si), "18.00 km/h above");
        let text = "Speed of the struck car: 54 km/h, the map has 72 km/h to 108 km/h";
        assert_eq!(input(15.0).text(UnitSystem::Si), text);
    }

    /// Every row drives as it points, and a car that slid was told of as lying within.
    #[test]
    fn a_striking_car_that_does_not_drive_as_it_points_is_outside() {
        let (atlas, struck) = (Atlas::shipped().unwrap(), Preset::Reference.parameters());
        let mut scenario = Scenario::example();
        for state in [&mut scenario.struck, &mut scenario.striking] {
            state.vx_world_m_s += 10.0;
        }
        let way_rad = scenario.striking.vy_world_m_s.atan2(scenario.striking.vx_world_m_s);
        for (slip_rad, is_outside) in [(0.0, false), (0.09, false), (0.11, true), (-0.11, true)] {
            scenario.striking.heading_rad = way_rad + slip_rad;
            let place = place_of_case(&scenario, &struck).unwrap();
            let told = place.outside(atlas, UnitSystem::Si);
            let expected = "Heading of the striking car beyond its way";
            let is_told = told.iter().any(|text| text.starts_with(expected));
            assert_eq!((is_told, !told.is_empty()), (is_outside, is_outside), "{told:?}");
        }
    }

    /// What the cells are averaged over is what the shipped plans say, and their pairs are the labels.
    #[test]
    fn the_limits_are_those_of_the_shipped_plans() {
        for text in [
            include_str!("../../../../assets/atlas/pit.toml"),
            include_str!("../../../../assets/atlas/pit-saltelli.toml"),
        ] {
            let plan: toml::Table = toml::from_str(text).unwrap();
            let numbers = |name: &str, kind: &str| -> Vec<f64> {
                let list = plan["vary"][name][kind].as_array().unwrap();
                let number = |value: &toml::Value| {
                    value.as_float().or(value.as_integer().map(|n| n as f64)).unwrap()
                };
                list.iter().map(number).collect()
            };
            assert_eq!(numbers("faster_m_s", "uniform"), FASTER_M_S);
            assert_eq!(numbers("slip_rad", "uniform"), SLIP_RAD);
            for axis in Axis::pit().unwrap() {
                if axis.is_choice() {
                    assert_eq!(numbers(&axis.name, "list").len(), axis.labels.len());
                    continue;
                }
                let ends = numbers(&axis.name, "uniform");
                for (end, edge) in ends.iter().zip([axis.edges[0], axis.edges[axis.n_bins()]]) {
                    assert!((end - edge).abs() < 1e-9, "{}: {end} {edge}", axis.name);
                    assert!(axis.locate(*end).is_some(), "{}: {end}", axis.name);
                }
            }
            for pair in plan["pit"]["pairs"].as_array().unwrap() {
                for part in ["struck", "striking"] {
                    let vehicle = built_in_vehicle(pair[part].as_str().unwrap()).unwrap();
                    let mass_kg = vehicle.mass.mass_kg;
                    assert!((MASSES_KG[0]..=MASSES_KG[1]).contains(&mass_kg), "{pair} {mass_kg}");
                }
            }
        }
    }
}
