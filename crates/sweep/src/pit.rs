//! The rows of a PIT: from the inputs of a row to its scenario.
//!
//! The lane is along the heading of the struck car in the scenario of the plan. What does not vary stays as
//! the scenario has it. Where the scenario does not say what the driver of the striking car does, he turns
//! in, keeps the speed, and straightens and brakes once the struck car has turned, or after two seconds.

use impactlab_core::collision::{ContactLocation, Scenario};
use impactlab_core::numerics::{latin_normals, random_stream};
use impactlab_core::ranges::{
    CONTACT_OFFSET, REST_LIMIT, ROAD_FRICTION, ROAD_FRICTION_SIGMA, Range, SPEED, YAW_RATE,
};
use impactlab_core::vehicle::frames::Heading;
use impactlab_core::vehicle::{
    Braking, Countersteer, DEFAULT_BRAKE_RISE_S, Ending, PitDriver, PitEnd, StabilityControl,
    TurnSide, VehicleParameters, built_in_vehicle,
};
use impactlab_study::{DEFAULT_STRIKING, DEFAULT_VEHICLE};
use serde_json::Value;

use crate::plan::PitQuestion;
use crate::vary::{Distribution, Vary};

/// An input of a PIT that can vary.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, strum::VariantArray, strum::IntoStaticStr,
)]
#[strum(serialize_all = "snake_case")]
pub enum PitInput {
    /// Speed of the struck car along the lane, m/s.
    #[strum(serialize = "target_speed_m_s")]
    TargetSpeed,
    /// Speed of the striking car across the lane, towards the struck one, m/s.
    #[strum(serialize = "closing_m_s")]
    Closing,
    /// By how much the striking car is faster along the lane, m/s.
    #[strum(serialize = "faster_m_s")]
    Faster,
    /// Angle between the headings, towards the struck car, rad.
    #[strum(serialize = "angle_rad")]
    Angle,
    /// Angle from the way of the striking car to its heading, towards the struck one, rad: how far it slides.
    /// The angle between the headings follows from it.
    #[strum(serialize = "slip_rad")]
    Slip,
    /// Where the striking car touches: distance ahead of the rear axle of the struck one, m.
    #[strum(serialize = "overlap_m")]
    Overlap,
    /// Yaw rate of the striking car, towards the struck one, rad/s.
    #[strum(serialize = "yaw_rate_rad_s")]
    YawRate,
    /// Peak friction of the road.
    Friction,
    /// Place in the list of pairs, from 0.
    Pair,
    /// Whether the struck car has a stability control, 0 or 1.
    Esc,
    /// What the driver of the struck car does: 0 nothing, 1 countersteers, 2 brakes.
    Driver,
}

/// Median reaction of a driver who brakes, s, and braking force over what the road can hold.
const BRAKING: [f64; 2] = [0.8, 0.8];

/// Time after the first contact at which a driver ends the pushing of a car that does not turn, s.
const LONGEST_PUSH_S: f64 = 2.0;

impl PitInput {
    /// Its name in a plan and in a table.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// What it is called in a picture.
    pub fn label(self) -> &'static str {
        match self {
            Self::TargetSpeed => "Speed of the struck car",
            Self::Closing => "Closing speed across the lane",
            Self::Faster => "Striking car faster along the lane",
            Self::Angle => "Angle between the headings",
            Self::Slip => "Heading beyond its way",
            Self::Overlap => "Contact ahead of the rear axle",
            Self::YawRate => "Yaw rate of the striking car",
            Self::Friction => "Peak friction of the road",
            Self::Pair => "Striking car and struck car",
            Self::Esc => "Stability control",
            Self::Driver => "Driver of the struck car",
        }
    }

    /// The input of a name.
    pub fn from_name(name: &str) -> Option<Self> {
        let all = <Self as strum::VariantArray>::VARIANTS;
        all.iter().copied().find(|input| input.name() == name)
    }

    /// Its SI unit; "1" for a pure number.
    pub fn unit(self) -> &'static str {
        match self {
            Self::TargetSpeed | Self::Closing | Self::Faster => "m/s",
            Self::Angle | Self::Slip => "rad",
            Self::Overlap => "m",
            Self::YawRate => "rad/s",
            Self::Friction | Self::Pair | Self::Esc | Self::Driver => "1",
        }
    }

    /// The numbers that it may have.
    fn range(self, n_pairs: usize) -> Range {
        let last = n_pairs.saturating_sub(1) as u64;
        match self {
            Self::TargetSpeed => SPEED.within([1.0, 100.0]),
            Self::Closing => SPEED.within([0.0, 50.0]),
            Self::Faster => SPEED.within([-50.0, 50.0]),
            Self::Angle => Range::real(
                "angle",
                impactlab_core::units::Quantity::Angle,
                [0.0, std::f64::consts::FRAC_PI_2],
                "angle between the headings",
            ),
            Self::Slip => Range::real(
                "slip",
                impactlab_core::units::Quantity::Angle,
                [-0.5, 0.5],
                "angle from the way of the striking car to its heading",
            ),
            Self::Overlap => CONTACT_OFFSET.within([-5.0, 5.0]),
            Self::YawRate => YAW_RATE.within([-5.0, 5.0]),
            Self::Friction => ROAD_FRICTION,
            Self::Pair => Range::whole("pair", [0, last], "place in the list of pairs"),
            Self::Esc => Range::whole("esc", [0, 1], "stability control"),
            Self::Driver => Range::whole("driver", [0, 2], "driver of the struck car"),
        }
    }

    /// The side on which the struck car of a scenario is hit: 1 if the striking car turns to its left, −1
    /// if to its right; `None` if it is no side.
    pub(crate) fn side(scenario: &Scenario) -> Option<f64> {
        scenario.struck_from_beside().map(|(side, _)| side)
    }
}

impl PitQuestion {
    /// What is wrong with it, as the key of a plan file and what is expected; `None` if nothing is: a number out
    /// of its range, or pairs of vehicles that nobody knows or of which every row would have the first.
    ///
    /// - `varies_pair`: whether each row says which pair it has.
    pub(crate) fn fault(&self, varies_pair: bool) -> Option<(String, String)> {
        let numbers = [
            ("pit.limit_s", self.limit_s, REST_LIMIT),
            ("pit.friction_sigma", self.road_sigma, ROAD_FRICTION_SIGMA),
        ];
        if let Some((key, _, range)) = numbers.iter().find(|(_, value, of)| !of.contains(*value)) {
            return Some(((*key).to_owned(), range.expected_si()));
        }
        let mut ids = self.pairs.iter().flat_map(|pair| [&pair.struck, &pair.striking]);
        let expected = match ids.find(|id| built_in_vehicle(id).is_none()) {
            Some(id) => format!("vehicles that impactlab vehicles lists, not {id:?}"),
            None if self.pairs.len() < 2 || varies_pair => return None,
            None => {
                "one pair, or [vary.pair] with a list of places in it: every row would have the first"
                    .to_owned()
            }
        };
        Some(("pit.pairs".to_owned(), expected))
    }

    /// What is expected of an input that may not be as it is; `None` if it may.
    pub(crate) fn fault_of(&self, vary: &Vary) -> Option<String> {
        let Some(input) = PitInput::from_name(&vary.name) else {
            return Some("an input of a pit".to_owned());
        };
        let range = input.range(self.pairs.len());
        let is_within = match &vary.distribution {
            Distribution::List { values, .. } => {
                let is_good = |value: &Value| value.as_f64().is_some_and(|it| range.contains(it));
                values.iter().all(is_good)
            }
            other => {
                let [low, high] = other.support()?;
                !range.is_whole && range.contains(low) && range.contains(high)
            }
        };
        let is_open = input == PitInput::Pair && self.pairs.is_empty();
        match (is_within, is_open) {
            (true, false) => None,
            (_, true) => Some("pairs in [pit], of which one is taken".to_owned()),
            (false, false) if range.is_whole => {
                Some(format!("a list of whole numbers, {}", range.expected_si()))
            }
            (false, false) => {
                Some(format!("{} throughout, with low and high", range.expected_si()))
            }
        }
    }

    /// The scenario of some inputs.
    ///
    /// - `vehicles`: the struck and the striking vehicle of a question without pairs;
    /// - `number`: the value of an input; `None` for one that stays as the question has it;
    /// - returns `None` if there is no such pair, or the struck vehicle is not hit in a side.
    pub fn scenario_of(
        &self,
        vehicles: [VehicleParameters; 2],
        number: impl Fn(PitInput) -> Option<f64>,
    ) -> Option<Scenario> {
        let vehicles = match self.pairs.is_empty() {
            true => PitVehicles(vec![vehicles]),
            false => PitVehicles::new(self),
        };
        PitRow::new(self, &vehicles, number).map(|row| row.scenario)
    }
}

/// Vehicles of a plan, read once.
#[derive(Debug, Clone)]
pub(crate) struct PitVehicles(Vec<[VehicleParameters; 2]>);

impl PitVehicles {
    /// Those of the pairs, or of the scenario.
    pub fn new(question: &PitQuestion) -> Self {
        let scenario = &question.scenario;
        let named = |name: Option<&str>, usual: impactlab_core::vehicle::Preset| {
            name.and_then(built_in_vehicle).unwrap_or_else(|| usual.parameters())
        };
        if question.pairs.is_empty() {
            let struck = named(scenario.struck_vehicle.as_deref(), DEFAULT_VEHICLE);
            let striking = named(scenario.striking_vehicle.as_deref(), DEFAULT_STRIKING);
            return Self(vec![[struck, striking]]);
        }
        let pairs = question.pairs.iter();
        Self(
            pairs
                .map(|pair| {
                    let struck = named(Some(&pair.struck), DEFAULT_VEHICLE);
                    [struck, named(Some(&pair.striking), DEFAULT_STRIKING)]
                })
                .collect(),
        )
    }
}

/// The scenario of a row with its vehicles on its road.
pub(crate) struct PitRow {
    pub scenario: Scenario,
    pub vehicles: [VehicleParameters; 2],
}

impl PitRow {
    /// - `number`: the value of an input; `None` for one that does not vary.
    pub fn new(
        question: &PitQuestion,
        vehicles: &PitVehicles,
        number: impl Fn(PitInput) -> Option<f64>,
    ) -> Option<Self> {
        let mut scenario = question.scenario.clone();
        let pair_idx = number(PitInput::Pair).map_or(0, |idx| idx as usize);
        let mut vehicles = vehicles.0.get(pair_idx)?.clone();
        if let Some(friction) = number(PitInput::Friction) {
            vehicles = vehicles.map(|vehicle| vehicle.with_friction(friction));
        }
        if let Some(ids) = question.pairs.get(pair_idx) {
            let [struck, striking] = &vehicles;
            scenario.struck.take(struck);
            scenario.striking.take(striking);
            scenario.struck_vehicle = Some(ids.struck.clone());
            scenario.striking_vehicle = Some(ids.striking.clone());
        }
        let side = PitInput::side(&scenario)?;
        set_motion(&mut scenario, side, &number);
        if let (Some(overlap_m), ContactLocation::Side { offset_m, .. }) =
            (number(PitInput::Overlap), &mut scenario.contact.location)
        {
            let middle_m = scenario.struck.cg_from_front_m - scenario.struck.length_m / 2.0;
            *offset_m = overlap_m - vehicles[0].geometry.cg_to_rear_axle_m - middle_m;
        }
        scenario.striking_ending.get_or_insert_with(|| turning_in(side));
        let ending = scenario.ending.get_or_insert_default();
        if let Some(esc) = number(PitInput::Esc) {
            ending.esc = (esc > 0.5).then(StabilityControl::default);
        }
        if let Some(driver) = number(PitInput::Driver) {
            let [start_s, share] = BRAKING;
            ending.countersteer = (driver == 1.0).then(Countersteer::default);
            ending.brake =
                (driver == 2.0).then(|| Braking::new(start_s, share, DEFAULT_BRAKE_RISE_S));
        }
        Some(Self { scenario, vehicles })
    }

    /// The same with the reaction time of its driver who brakes drawn, as one who countersteers has it.
    ///
    /// - `seed`: of the row.
    pub fn with_drawn_reaction(mut self, seed: u64) -> Self {
        let mut rng = random_stream(seed, "reaction of a driver who brakes", 0);
        let mut z = [0.0; Countersteer::N_DRAWN];
        z.iter_mut().zip(latin_normals(1, &mut rng)).for_each(|(z, drawn)| *z = drawn);
        let brake = self.scenario.ending.as_mut().and_then(|ending| ending.brake.as_mut());
        if let (Some(brake), Some(delay_s)) = (brake, Countersteer::default().drawn(z).delay_s) {
            brake.start_s = delay_s;
        }
        self
    }
}

/// What the driver of a striking car does who turns to a side, 1 to the left and −1 to the right.
fn turning_in(side: f64) -> Ending {
    let driver = PitDriver {
        side: Some(if side > 0.0 { TurnSide::Left } else { TurnSide::Right }),
        end: Some(PitEnd::Brake),
        longest_s: Some(LONGEST_PUSH_S),
        ..PitDriver::default()
    };
    Ending { pit: Some(driver), ..Ending::default() }
}

/// Velocities and heading of both vehicles, in axes along the lane.
fn set_motion(scenario: &mut Scenario, side: f64, number: &impl Fn(PitInput) -> Option<f64>) {
    let heading_rad = scenario.struck.heading_rad;
    let lane = Heading::new(heading_rad);
    let of_struck =
        lane.body_from_world([scenario.struck.vx_world_m_s, scenario.struck.vy_world_m_s]);
    let of_striking =
        lane.body_from_world([scenario.striking.vx_world_m_s, scenario.striking.vy_world_m_s]);
    let along = number(PitInput::TargetSpeed).unwrap_or(of_struck[0]);
    let faster = number(PitInput::Faster).unwrap_or(of_striking[0] - of_struck[0]);
    let across = number(PitInput::Closing).map_or(of_striking[1], |closing| side * closing);
    let struck = lane.world_from_body([along, of_struck[1]]);
    let striking = lane.world_from_body([along + faster, across]);
    [scenario.struck.vx_world_m_s, scenario.struck.vy_world_m_s] = struck;
    [scenario.striking.vx_world_m_s, scenario.striking.vy_world_m_s] = striking;
    if let Some(angle_rad) = number(PitInput::Angle) {
        scenario.striking.heading_rad = heading_rad + side * angle_rad;
    }
    if let Some(slip_rad) = number(PitInput::Slip) {
        let way_rad = (side * across).atan2(along + faster);
        scenario.striking.heading_rad = heading_rad + side * (way_rad + slip_rad);
    }
    if let Some(rate_rad_s) = number(PitInput::YawRate) {
        scenario.striking.yaw_rate_rad_s = side * rate_rad_s;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_inputs_of_a_row_are_those_of_its_scenario() {
        let question = PitQuestion {
            scenario: Scenario::example(),
            pairs: Vec::new(),
            road_sigma: 0.0,
            limit_s: 20.0,
        };
        let vehicles = PitVehicles::new(&question);
        let unchanged = PitRow::new(&question, &vehicles, |_| None).unwrap();
        let (before, after) = (&question.scenario, &unchanged.scenario);
        assert!((before.striking.vx_world_m_s - after.striking.vx_world_m_s).abs() < 1e-12);
        assert_eq!(before.contact, after.contact);
        let value = |input| match input {
            PitInput::TargetSpeed => Some(20.0),
            PitInput::Closing => Some(3.0),
            PitInput::Faster => Some(1.0),
            PitInput::Angle => Some(0.2),
            PitInput::Overlap => Some(-0.25),
            PitInput::Friction => Some(0.5),
            PitInput::Driver => Some(2.0),
            PitInput::Esc => Some(1.0),
            PitInput::Slip | PitInput::YawRate | PitInput::Pair => None,
        };
        let row = PitRow::new(&question, &vehicles, value).unwrap();
        let scenario = &row.scenario;
        assert!((scenario.struck.vx_world_m_s - 20.0).abs() < 1e-12);
        assert!((scenario.striking.vx_world_m_s - 21.0).abs() < 1e-12);
        assert!((scenario.striking.vy_world_m_s - 3.0).abs() < 1e-12);
        assert!((scenario.striking.heading_rad - 0.2).abs() < 1e-12);
        assert!(row.vehicles.iter().all(|vehicle| vehicle.tires.friction == 0.5));
        let ending = scenario.ending.as_ref().unwrap();
        assert!(ending.esc.is_some() && ending.brake.is_some() && ending.countersteer.is_none());
        let striking = scenario.striking_ending.as_ref().unwrap().pit.unwrap();
        assert_eq!((striking.side, striking.end), (Some(TurnSide::Left), Some(PitEnd::Brake)));
        let geometry = scenario.geometry().unwrap();
        let [x_m, y_m] = geometry.struck.body_from_world(geometry.contact_point_world_m);
        let slides = |input| match input {
            PitInput::Slip => Some(0.05),
            PitInput::Angle => None,
            other => value(other),
        };
        let sliding = PitRow::new(&question, &vehicles, slides).unwrap().scenario.striking;
        assert!((sliding.heading_rad - (3.0_f64.atan2(21.0) + 0.05)).abs() < 1e-12);
        let rear_axle_m = -row.vehicles[0].geometry.cg_to_rear_axle_m;
        assert!(
            (x_m - (rear_axle_m - 0.25)).abs() < 0.01 && y_m < 0.0,
            "{x_m} {y_m} {rear_axle_m}"
        );
        let mut reactions_s: Vec<f64> = (0..1000)
            .map(|seed| {
                let row = PitRow::new(&question, &vehicles, value).unwrap();
                row.with_drawn_reaction(seed).scenario.ending.unwrap().brake.unwrap().start_s
            })
            .collect();
        reactions_s.sort_by(f64::total_cmp);
        let expected_s = [(50, 0.38), (500, 0.8), (950, 1.68)];
        for (place, expected_s) in expected_s {
            assert!((reactions_s[place] / expected_s - 1.0).abs() < 0.15, "{reactions_s:?}");
        }
    }
}
