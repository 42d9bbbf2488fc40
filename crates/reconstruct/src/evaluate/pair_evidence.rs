//! Evidence of both cars of a recorded pair with the errors of an investigator, and its truth, in the
//! form of the staged collisions.
//!
//! World axes: origin at the CG of the struck car at first contact, X along its heading then. What had
//! happened is said at first contact, as the striking car may turn in before.
//!
//! What is found and how well, standard deviations: as `datasets/staged/README.md` says, for each of the
//! cars. Rest 0.15 m each axis and 2°; points of marks 0.10 m each axis; friction 0.04; masses 2 %; place
//! of the damage 0.08 m; each car has a recorder with 50 %, which tells its speed (4 %) or its change of
//! velocity until 0.25 s (up to 8 % off, with bounds of 10 %). The wheels turn as somebody found out; what
//! the drivers did is not known. Not said: Δv and yaw rate at the end of the contact, since cars that push
//! each other have no one such end.

use rand::{Rng, RngExt};
use rand_distr::{Distribution, StandardNormal};
use toml::{Table, Value};

use crate::evaluate::recorded_car::RecordedCar;
use crate::evidence::{
    After, CarEvidence, Damage, Edr, Evidence, Mark, MarkKind, Measured, RestPose, Road,
};
use impactlab_core::collision::{Pose, Side};
use impactlab_core::compare::PairCase;
use impactlab_core::data::{Channel, SeriesError};
use impactlab_core::numerics::{interpolate, nearest_multiple, random_stream, wrap_angle_rad};
use impactlab_core::ranges::ROAD_FRICTION;
use impactlab_core::vehicle::{TireMark, TireMarkKind, VehicleParameters};

const REST_SIGMA_M: f64 = 0.15;
const HEADING_SIGMA_RAD: f64 = 0.0349;
const MARK_SIGMA_M: f64 = 0.10;
const FRICTION_SIGMA: f64 = 0.04;
const MASS_SHARE: f64 = 0.02;
const DAMAGE_SIGMA_M: f64 = 0.08;
const SPEED_SHARE: f64 = 0.04;
/// Largest error of a recorded change of velocity, and half the width of its bounds, as shares of it.
const DELTA_V_SHARES: [f64; 2] = [0.08, 0.10];
/// End of the record of the change of velocity, s after the first contact: 49 CFR 563 asks for 0.25 s.
const RECORD_END_S: f64 = 0.25;
/// Distance of the points of a mark, m, within the bounds of their number.
const POINT_DISTANCE_M: f64 = 3.0;
const MARK_POINTS: [usize; 2] = [3, 8];

/// What is found of a recorded pair, and what had happened.
#[derive(Debug, Clone, PartialEq)]
pub struct PairEvidence {
    /// What is found.
    pub evidence: Evidence,
    /// The text of a file of what had happened, see
    /// [`TrueQuantities`](crate::evaluate::TrueQuantities).
    pub truth: String,
}

/// Reason why a recorded pair leaves no evidence.
#[derive(Debug, thiserror::Error)]
pub enum PairEvidenceError {
    /// The record lacks what the axes or the damage depend on.
    #[error("{case}: the record does not say {lacking}")]
    Lacking {
        /// The case.
        case: String,
        /// What it lacks.
        lacking: &'static str,
    },
    /// The motions.
    #[error("{case}")]
    Series {
        /// The case.
        case: String,
        /// What is wrong with them.
        #[source]
        source: SeriesError,
    },
}

impl PairEvidence {
    /// Evidence of a recorded pair. A car that still moves at the end of the record has no place of rest,
    /// and no marks that the end cuts off.
    ///
    /// - `seed`: of the errors; the stream of a case is that of its name.
    ///
    /// # Errors
    /// [`PairEvidenceError`] if the record says neither when nor where the cars meet, or ends before.
    pub fn from_record(case: &PairCase, seed: u64) -> Result<Self, PairEvidenceError> {
        let lacking = |lacking| PairEvidenceError::Lacking { case: case.name.clone(), lacking };
        let in_case = |source| PairEvidenceError::Series { case: case.name.clone(), source };
        let first_s = case.contact.first_s.ok_or_else(|| lacking("when the cars meet"))?;
        let place_m = case.contact.place_m.ok_or_else(|| lacking("where the cars meet"))?;
        let origin = struck_at(case, first_s).map_err(in_case)?;
        let car = |idx| {
            let car = RecordedCar::new(case, idx, first_s, &origin).map_err(in_case)?;
            car.ok_or_else(|| lacking("what happens after the contact"))
        };
        let cars = [car(0)?, car(1)?];
        let stream = |number| random_stream(seed, &case.name, number);
        let mut scene = Errors(stream(0));
        let mut evidence = Evidence {
            case: case.name.clone(),
            friction: Some(scene.road(cars[0].vehicle.tires.friction)),
            struck_car: scene.car(cars[0].vehicle),
            striking_car: scene.car(cars[1].vehicle),
            damage: scene.damage(place_m, cars[0].vehicle),
            after: found_turning(),
            striking_after: found_turning(),
            ..Evidence::default()
        };
        let [struck, striking] = &cars;
        let rest = |car: &RecordedCar<'_>, number| {
            car.rest().map(|pose| Errors(stream(number)).rest(pose))
        };
        (evidence.rest, evidence.striking_rest) = (rest(struck, 1), rest(striking, 2));
        let marks = |car: &RecordedCar<'_>, number| {
            let mut errors = Errors(stream(number));
            let marks = car.marks().map_err(in_case)?;
            Ok(marks.iter().map(|mark| errors.mark(mark)).collect::<Vec<Mark>>())
        };
        (evidence.marks, evidence.striking_marks) = (marks(struck, 3)?, marks(striking, 4)?);
        evidence.edr = Errors(stream(5)).edr(struck);
        evidence.striking_edr = Errors(stream(6)).edr(striking);
        Ok(Self { evidence, truth: truth(case, &cars) })
    }
}

/// The struck car at a time, in the axes of the record.
fn struck_at(case: &PairCase, time_s: f64) -> Result<Pose, SeriesError> {
    let motion = &case.motions[0];
    let at = |channel| {
        let values = motion.require(channel)?;
        Ok(interpolate(motion.time_s(), values, time_s).unwrap_or(f64::NAN))
    };
    Ok(Pose { x_m: at(Channel::X)?, y_m: at(Channel::Y)?, yaw_rad: at(Channel::Yaw)? })
}

/// Nobody knows what the driver did; all wheels were found to turn.
fn found_turning() -> After {
    After { blocked_wheels: Some(Vec::new()), ..After::default() }
}

/// Draws what an investigator states.
struct Errors<R>(R);

impl<R: Rng> Errors<R> {
    fn normal(&mut self, value: f64, sigma: f64) -> f64 {
        let error: f64 = StandardNormal.sample(&mut self.0);
        value + sigma * error
    }

    fn road(&mut self, friction: f64) -> Road {
        let value = self.normal(friction, FRICTION_SIGMA);
        let value = nearest_multiple(value, 0.001).clamp(ROAD_FRICTION.low, ROAD_FRICTION.high);
        Road { value: Some(value), sigma: Some(FRICTION_SIGMA), ..Road::default() }
    }

    fn car(&mut self, vehicle: &VehicleParameters) -> CarEvidence {
        let (geometry, true_kg) = (&vehicle.geometry, vehicle.mass.mass_kg);
        let value = nearest_multiple(self.normal(true_kg, MASS_SHARE * true_kg), 1.0);
        let mass = Measured { value, sigma: nearest_multiple(MASS_SHARE * value, 1.0) };
        let length = |value: f64| Some(nearest_multiple(value, 0.001));
        CarEvidence {
            mass_kg: Some(mass.into()),
            cg_to_front_axle_m: length(geometry.cg_to_front_axle_m),
            cg_to_rear_axle_m: length(geometry.cg_to_rear_axle_m),
            track_m: length(geometry.track_width_m),
            cg_height_m: length(geometry.cg_height_m),
            length_m: length(geometry.outer_length_m),
            width_m: length(geometry.outer_width_m),
            yaw_inertia_kg_m2: None,
        }
    }

    /// - `place_m`: where the car is touched, body axes.
    fn damage(&mut self, place_m: [f64; 2], vehicle: &VehicleParameters) -> Damage {
        let side = touched_side(place_m, vehicle);
        let [x_m, y_m] = place_m;
        let geometry = &vehicle.geometry;
        let (along_m, depth_m) = match side {
            Side::Left => (x_m, geometry.outer_width_m / 2.0),
            Side::Right => (x_m, -geometry.outer_width_m / 2.0),
            Side::Front => (y_m, geometry.cg_to_front_end_m),
            Side::Rear => (y_m, geometry.cg_to_front_end_m - geometry.outer_length_m),
        };
        let value = nearest_multiple(self.normal(along_m, DAMAGE_SIGMA_M), 0.001);
        let along = Measured { value, sigma: DAMAGE_SIGMA_M };
        let depth_m = Some(nearest_multiple(depth_m, 0.001));
        Damage { side: Some(side), along_m: Some(along.into()), depth_m, angle_rad: None }
    }

    fn rest(&mut self, [x_m, y_m, yaw_rad]: [f64; 3]) -> RestPose {
        let [x_m, y_m] =
            [x_m, y_m].map(|value| nearest_multiple(self.normal(value, REST_SIGMA_M), 0.01));
        let value = wrap_angle_rad(self.normal(yaw_rad, HEADING_SIGMA_RAD));
        let heading = Measured { value: nearest_multiple(value, 0.001), sigma: HEADING_SIGMA_RAD };
        RestPose {
            x_m: Some(x_m),
            y_m: Some(y_m),
            position_sigma_m: Some(REST_SIGMA_M),
            heading_rad: Some(heading.into()),
            stopped_by: None,
        }
    }

    fn mark(&mut self, mark: &TireMark) -> Mark {
        let kind = match mark.kind() {
            TireMarkKind::Locked => MarkKind::Locked,
            TireMarkKind::SideSlip => MarkKind::SideSlip,
        };
        let points_m = points_along(mark)
            .into_iter()
            .map(|at_m| at_m.map(|value| nearest_multiple(self.normal(value, MARK_SIGMA_M), 0.01)))
            .collect();
        Mark { wheel: mark.wheel, kind: Some(kind), points_m, sigma_m: Some(MARK_SIGMA_M) }
    }

    /// The record of a car, if it has a recorder.
    fn edr(&mut self, car: &RecordedCar<'_>) -> Option<Edr> {
        let (has_recorder, says_speed) = (self.0.random_bool(0.5), self.0.random_bool(0.5));
        if !has_recorder {
            return None;
        }
        if says_speed {
            let ([x, y], _) = car.before();
            let speed_m_s = x.hypot(y);
            let value =
                nearest_multiple(self.normal(speed_m_s, SPEED_SHARE * speed_m_s).max(0.0), 0.01);
            let speed =
                Measured { value, sigma: nearest_multiple((SPEED_SHARE * value).max(0.01), 0.01) };
            return Some(Edr { speed_before_m_s: Some(speed.into()), ..Edr::default() });
        }
        let [error, half] = DELTA_V_SHARES;
        let [x, y] = car.recorded_delta_v_m_s(RECORD_END_S)?.map(|delta_v_m_s| {
            let value = delta_v_m_s * self.0.random_range(1.0 - error..=1.0 + error);
            let low = nearest_multiple(value - half * value.abs(), 0.001);
            Some([Some(low), Some(nearest_multiple(value + half * value.abs(), 0.001))])
        });
        let ends_s = Some(RECORD_END_S);
        Some(Edr { delta_v_x_m_s: x, delta_v_y_m_s: y, ends_s, ..Edr::default() })
    }
}

/// The side whose edge is nearest to a place on the car, body axes.
fn touched_side([x_m, y_m]: [f64; 2], vehicle: &VehicleParameters) -> Side {
    let geometry = &vehicle.geometry;
    let to_edge_m = |side: &Side| match side {
        Side::Front => (geometry.cg_to_front_end_m - x_m).abs(),
        Side::Rear => (x_m - geometry.cg_to_front_end_m + geometry.outer_length_m).abs(),
        Side::Left => (geometry.outer_width_m / 2.0 - y_m).abs(),
        Side::Right => (geometry.outer_width_m / 2.0 + y_m).abs(),
    };
    let nearest = Side::ALL.into_iter().min_by(|a, b| to_edge_m(a).total_cmp(&to_edge_m(b)));
    nearest.unwrap_or(Side::Right)
}

/// Places along a mark at even distances, from where it starts to where it ends, m.
fn points_along(mark: &TireMark) -> Vec<[f64; 2]> {
    let mut travelled_m = vec![0.0];
    for pair in mark.points.windows(2) {
        let ([x0, y0], [x1, y1]) = (pair[0].place_m, pair[1].place_m);
        travelled_m.push(travelled_m[travelled_m.len() - 1] + (x1 - x0).hypot(y1 - y0));
    }
    let length_m = mark.length_m();
    let [fewest, most] = MARK_POINTS;
    let n = ((length_m / POINT_DISTANCE_M).round() as usize).clamp(fewest, most);
    let places = [0, 1].map(|axis| mark.points.iter().map(|at| at.place_m[axis]).collect());
    let [x_m, y_m]: [Vec<f64>; 2] = places;
    let at = |values: &[f64], idx: usize| {
        let place_m = length_m * idx as f64 / (n - 1) as f64;
        interpolate(&travelled_m, values, place_m).unwrap_or(f64::NAN)
    };
    (0..n).map(|idx| [at(&x_m, idx), at(&y_m, idx)]).collect()
}

/// The file of what had happened.
fn truth(case: &PairCase, cars: &[RecordedCar<'_>; 2]) -> String {
    let mut file = Table::new();
    file.insert("case".to_owned(), Value::from(case.name.as_str()));
    let names = ["struck_car", "striking_car"];
    for ((key, car), vehicle) in names.into_iter().zip(cars).zip(&case.attributes.cars) {
        let (velocity_m_s, heading_rad) = car.before();
        let [x, y] = velocity_m_s;
        let mut table = Table::new();
        let mut set = |key: &str, value: Value| table.insert(key.to_owned(), value);
        set("vehicle", Value::from(vehicle.as_str()));
        set("mass_kg", Value::from(car.vehicle.mass.mass_kg));
        set("speed_before_m_s", Value::from(x.hypot(y)));
        set("velocity_before_m_s", Value::from(velocity_m_s.to_vec()));
        set("yaw_rate_before_rad_s", Value::from(car.path.points[0].yaw_rate_rad_s));
        set("at_rest", Value::from(car.rest().is_some()));
        if key == "striking_car" {
            set("heading_rad", Value::from(heading_rad));
        }
        if let Some([x_m, y_m, yaw_rad]) = car.rest() {
            set("rest_x_m", Value::from(x_m));
            set("rest_y_m", Value::from(y_m));
            set("rest_yaw_rad", Value::from(yaw_rad));
        }
        file.insert(key.to_owned(), Value::from(table));
    }
    let mut road = Table::new();
    road.insert("mu".to_owned(), Value::from(cars[0].vehicle.tires.friction));
    file.insert("road".to_owned(), Value::from(road));
    file.to_string()
}

#[cfg(test)]
#[path = "pair_evidence_tests.rs"]
mod tests;
