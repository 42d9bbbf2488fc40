//! Where a model of the motion holds: the vehicles, roads and impacts that it has learned from.
//!
//! ```text
//! d_q = max(low_q − q, q − high_q, 0)/s_q        s_q = max(high_q − low_q, the least of the quantity)/2
//! D²  = Σ_q d_q²       applicability = 1/(1 + (D/0.5)⁴)
//! ```
//!
//! Of a car of which motions are known, D of the car, not of its road, counts by how much they leave open of
//! it, so that a calm drive makes no car known.
//! Distance and power are chosen, not fitted. Within the ranges the applicability is 1; half of half a range beyond one of them it is a half.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::nn::{Expected, NnError, check_numbers};
use crate::response::{ResponseCase, STEP_S};
use impactlab_core::units::STANDARD_GRAVITY_M_S2;
use impactlab_core::vehicle::{CollisionForce, VehicleInput, VehicleParameters, VehicleState};

/// D at which the applicability is a half.
const HALF_DISTANCE: f64 = 0.5;

/// Applicability from which on a car of which motions are known counts as known, whatever its sheet says.
const WELL_KNOWN: f64 = 0.995;

/// A quantity by which vehicles and impacts are compared with those that were learned from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct DomainQuantity {
    /// Name with unit, for a person.
    name: &'static str,
    /// Smallest width of a range, by which a model of one car is compared with others.
    least_width: Width,
}

/// A width: as it is, or a share of the middle of the range.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Width {
    /// In thousandths of the unit.
    Thousandths(u32),
    /// In percent of the middle.
    Percent(u32),
}

const fn quantity(name: &'static str, least_width: Width) -> DomainQuantity {
    DomainQuantity { name, least_width }
}

/// Quantities of the vehicle, the friction of its road last.
const OF_VEHICLE: [DomainQuantity; 11] = [
    quantity("mass [kg]", Width::Percent(20)),
    quantity("wheelbase [m]", Width::Percent(15)),
    quantity("track width [m]", Width::Percent(15)),
    quantity("CG height [m]", Width::Percent(20)),
    quantity("front axle load share", Width::Thousandths(100)),
    quantity("dynamic index", Width::Thousandths(250)),
    quantity("front cornering coefficient [1/rad]", Width::Percent(40)),
    quantity("rear cornering coefficient [1/rad]", Width::Percent(40)),
    quantity("sliding friction ratio", Width::Thousandths(200)),
    quantity("roll gradient [rad/g]", Width::Percent(60)),
    quantity("friction", Width::Thousandths(200)),
];

/// Quantities of the impact and the motion.
const OF_MOTION: [DomainQuantity; 5] = [
    quantity("speed [m/s]", Width::Thousandths(15_000)),
    quantity("sideslip speed before the impact [m/s]", Width::Thousandths(2_000)),
    quantity("yaw rate before the impact [rad/s]", Width::Thousandths(500)),
    quantity("velocity change by the impact [m/s]", Width::Thousandths(5_000)),
    quantity("yaw rate change by the impact [rad/s]", Width::Thousandths(2_000)),
];

/// Numbers of a motion: those by which motions are compared, and the duration.
const N_OF_MOTION: usize = OF_MOTION.len() + 1;

/// How long the motions were that a model has learned from, where its file does not say it, s: as in
/// the trajectory data sets of one car.
const USUAL_DURATION_S: f64 = 4.0;

/// The ranges that a model has learned from.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MotionDomain {
    /// Smallest and largest of each quantity of the vehicle.
    vehicle: Vec<[f64; 2]>,
    /// Smallest and largest of each quantity of the motion, last the duration, s.
    motion: Vec<[f64; 2]>,
}

/// A quantity that lies outside of what a model has learned from.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct OutsideDomain {
    /// The quantity, with its unit.
    pub quantity: &'static str,
    /// Its value.
    pub value: f64,
    /// The range that the model has learned from.
    pub range: [f64; 2],
}

/// How far a model holds for an answer.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Applicability {
    /// 1 within what was learned from, towards 0 far from it.
    pub value: f64,
    /// D: distance from the ranges, in half widths.
    #[serde(skip)]
    pub distance: f64,
    /// What lies outside.
    pub outside: Vec<OutsideDomain>,
}

impl Applicability {
    /// Everything within the ranges.
    pub fn whole() -> Self {
        Self::new(0.0, Vec::new())
    }

    fn new(distance: f64, outside: Vec<OutsideDomain>) -> Self {
        let value = 1.0 / (1.0 + (distance / HALF_DISTANCE).powi(4));
        Self { value, distance, outside }
    }

    /// Both together.
    #[must_use]
    pub fn and(&self, other: &Self) -> Self {
        let outside = self.outside.iter().chain(&other.outside).cloned().collect();
        Self::new(self.distance.hypot(other.distance), outside)
    }
}

impl MotionDomain {
    /// The ranges of trajectories.
    pub(crate) fn from_cases<'a>(cases: impl IntoIterator<Item = &'a ResponseCase>) -> Self {
        let mut domain = Self::default();
        for case in cases {
            widen(&mut domain.vehicle, vehicle_quantities(&case.vehicle));
            if let Some(initial) = case.states.first() {
                widen(&mut domain.motion, motion_quantities(&case.vehicle, initial, &case.inputs));
            }
        }
        domain
    }

    /// How long the longest motion was that the model has learned from, s.
    pub(crate) fn duration_s(&self) -> f64 {
        self.motion.get(OF_MOTION.len()).map_or(USUAL_DURATION_S, |[_, longest_s]| *longest_s)
    }

    /// Checks ranges from a file.
    ///
    /// # Errors
    /// [`NnError::StoredNumber`].
    pub(crate) fn check(&self) -> Result<(), NnError> {
        for range in self.vehicle.iter().chain(&self.motion) {
            check_numbers("domain", range, Expected::Magnitude(1e9))?;
        }
        Ok(())
    }

    /// How far the model holds for a vehicle on its road.
    ///
    /// - `open`: how much of the vehicle is not known by its motions: 1 without any, 0 if nothing.
    pub(crate) fn vehicle_applicability(
        &self,
        vehicle: &VehicleParameters,
        open: f64,
    ) -> Applicability {
        const OF_CAR: usize = OF_VEHICLE.len() - 1;
        let quantities = vehicle_quantities(vehicle);
        let (cars, road) = self.vehicle.split_at(OF_CAR.min(self.vehicle.len()));
        let road = applicability(&[OF_VEHICLE[OF_CAR]], road, [quantities[OF_CAR]]);
        let of_car: [DomainQuantity; OF_CAR] = std::array::from_fn(|i| OF_VEHICLE[i]);
        let car = applicability(&of_car, cars, std::array::from_fn(|i| quantities[i]));
        let known = Applicability::new(open * car.distance, car.outside);
        // What hardly counts any more is not told as lying outside.
        if open < 1.0 && known.value > WELL_KNOWN { road } else { known.and(&road) }
    }

    /// How far the model holds for a motion.
    pub(crate) fn motion_applicability(
        &self,
        vehicle: &VehicleParameters,
        initial: &VehicleState<f64>,
        inputs: &[VehicleInput<f64>],
    ) -> Applicability {
        // Beyond their duration the learned part fades along the motion, not as a whole.
        let numbers = motion_quantities(vehicle, initial, inputs);
        applicability(&OF_MOTION, &self.motion, std::array::from_fn(|i| numbers[i]))
    }
}

fn widen<const N: usize>(ranges: &mut Vec<[f64; 2]>, values: [f64; N]) {
    ranges.resize(N, [f64::INFINITY, f64::NEG_INFINITY]);
    for ([low, high], value) in ranges.iter_mut().zip(values) {
        (*low, *high) = (low.min(value), high.max(value));
    }
}

fn applicability<const N: usize>(
    quantities: &[DomainQuantity; N],
    ranges: &[[f64; 2]],
    values: [f64; N],
) -> Applicability {
    let (mut squares, mut outside) = (0.0, Vec::new());
    for ((quantity, &[low, high]), value) in quantities.iter().zip(ranges).zip(values) {
        let least = match quantity.least_width {
            Width::Thousandths(width) => f64::from(width) / 1e3,
            Width::Percent(share) => f64::from(share) / 1e2 * ((low + high) / 2.0).abs(),
        };
        let off = (low - value).max(value - high).max(0.0);
        // Rounding of what is at the end of a range is not outside.
        if off > 1e-9 * (1.0 + value.abs()) {
            squares += (off / (high - low).max(least).max(1e-9) * 2.0).powi(2);
            outside.push(OutsideDomain { quantity: quantity.name, value, range: [low, high] });
        }
    }
    Applicability::new(squares.sqrt(), outside)
}

fn vehicle_quantities(vehicle: &VehicleParameters) -> [f64; OF_VEHICLE.len()] {
    let VehicleParameters { mass, geometry, suspension, tires, .. } = vehicle;
    let [front, rear] = [geometry.cg_to_front_axle_m, geometry.cg_to_rear_axle_m];
    let weight_moment = mass.sprung_mass_kg * STANDARD_GRAVITY_M_S2 * suspension.roll_arm_m;
    [
        mass.mass_kg,
        geometry.wheelbase_m(),
        geometry.track_width_m,
        geometry.cg_height_m,
        rear / geometry.wheelbase_m(),
        mass.yaw_inertia_kg_m2 / (mass.mass_kg * front * rear),
        tires.cornering_coefficient_front_per_rad,
        tires.cornering_coefficient_rear_per_rad,
        tires.sliding_friction_ratio,
        weight_moment / (suspension.roll_stiffness_n_m_rad - weight_moment).max(1e-9),
        tires.friction,
    ]
}

fn motion_quantities(
    vehicle: &VehicleParameters,
    initial: &VehicleState<f64>,
    inputs: &[VehicleInput<f64>],
) -> [f64; N_OF_MOTION] {
    let (mut impulse, mut spin) = ([0.0; 2], 0.0);
    for collision in inputs.iter().filter_map(|input| input.collision) {
        let CollisionForce { force_n: [fx, fy], yaw_moment_n_m, contact, .. } = collision;
        impulse = [impulse[0] + fx * STEP_S, impulse[1] + fy * STEP_S];
        // In world axes the arm turns with the vehicle; over an impact that is little.
        let moment = yaw_moment_n_m.unwrap_or(contact.x_body_m * fy - contact.y_body_m * fx);
        spin += moment * STEP_S;
    }
    [
        initial.vx_body_m_s.hypot(initial.vy_body_m_s),
        initial.vy_body_m_s.abs(),
        initial.yaw_rate_rad_s.abs(),
        impulse[0].hypot(impulse[1]) / vehicle.mass.mass_kg,
        spin.abs() / vehicle.mass.yaw_inertia_kg_m2,
        inputs.len() as f64 * STEP_S,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::vehicle::Preset;

    fn case(friction: f64, speed_m_s: f64) -> ResponseCase {
        let vehicle = Preset::Reference.parameters().with_friction(friction);
        let states = vec![VehicleState::driving_straight(speed_m_s); 11];
        let inputs = vec![VehicleInput::released(); 10];
        ResponseCase::from_motion(String::new(), vehicle, states, inputs)
    }

    #[test]
    fn what_lies_outside_is_named_with_value_and_range() {
        let cases = [case(0.5, 15.0), case(0.9, 25.0)];
        let domain = MotionDomain::from_cases(&cases);
        let applicability = |case: &ResponseCase| {
            domain.vehicle_applicability(&case.vehicle, 1.0).and(&domain.motion_applicability(
                &case.vehicle,
                &case.states[0],
                &case.inputs,
            ))
        };
        assert_eq!(applicability(&case(0.7, 20.0)), Applicability::whole());
        assert_eq!(applicability(&cases[1]), Applicability::whole());
        let slick = applicability(&case(0.1, 20.0));
        assert!(slick.value < 0.01, "{slick:?}");
        let named = OutsideDomain { quantity: "friction", value: 0.1, range: [0.5, 0.9] };
        assert_eq!(slick.outside, [named]);
        let both = applicability(&case(0.45, 80.0));
        assert!(both.value < 0.01 && both.outside.len() == 2, "{both:?}");
        // Half of half the range beyond its end.
        let edge = applicability(&case(1.0, 20.0));
        assert!((edge.value - 0.5).abs() < 1e-9, "{edge:?}");
    }

    #[test]
    fn a_model_of_one_car_does_not_know_others() {
        let domain = MotionDomain::from_cases(&[case(0.5, 15.0), case(0.9, 25.0)]);
        let own = Preset::Reference.parameters().with_friction(0.8);
        assert_eq!(domain.vehicle_applicability(&own, 1.0), Applicability::whole());
        let lighter = domain.vehicle_applicability(&own.clone().with_mass(1200.0, None), 1.0);
        assert!(lighter.value < 0.01 && lighter.outside[0].quantity == "mass [kg]", "{lighter:?}");
        let little = domain.vehicle_applicability(&own.with_mass(1960.0, None), 1.0);
        assert!(little.value > 0.4 && little.value < 1.0, "{little:?}");
    }

    /// A calm log lifted the applicability of a car outside of the fleet from 0.76 to 1.
    #[test]
    fn a_car_outside_counts_by_what_its_motions_leave_open_and_its_road_in_full() {
        let domain = MotionDomain::from_cases(&[case(0.5, 15.0), case(0.9, 25.0)]);
        let own = Preset::Reference.parameters().with_friction(0.8).with_mass(1900.0, None);
        let at = |open: f64| domain.vehicle_applicability(&own, open);
        let unknown = at(1.0);
        assert!(unknown.value < 0.9 && unknown.outside[0].quantity == "mass [kg]", "{unknown:?}");
        let calm = at(0.98);
        assert!(calm.value - unknown.value < 0.03 && calm.outside == unknown.outside, "{calm:?}");
        for (more, less) in [(1.0, 0.9), (0.9, 0.5), (0.5, 0.2), (0.2, 0.0)] {
            assert!(at(less).value >= at(more).value, "{less} {more}");
        }
        assert_eq!(at(0.0), Applicability::whole());
        let on_ice = own.with_friction(0.1);
        let of_ice = domain.vehicle_applicability(&on_ice, 0.0);
        assert!(of_ice.value < 0.01 && of_ice.outside[0].quantity == "friction", "{of_ice:?}");
    }
}
