//! How far the critical speed is off on marks of the 4DOF model: the same mark, the same friction and the formula,
//! against a speed that is known.
//!
//! A car drives straight ahead, its front wheels turn within 0.4 s to an angle at which they slide sideways, and
//! stay there; no driver brakes. The marks are those of [`tire_marks`], the radius is that of the first 15 m of the
//! mark of the outer front wheel, the drag factor that of locked wheels, and the true speed that of the CG where the
//! mark begins. So the number says how the formula does where nothing is wrong but the formula: a real driver brakes,
//! real roads are uneven, and real marks are found in part.

use impactlab_core::data::Channel;
use impactlab_core::ranges::ROAD_FRICTION;
use impactlab_core::vehicle::{
    ControlledVehicle, Controls, Integrator, Manoeuvre, Motion, Preset, SteerHistory, TireMark,
    VehicleParameters, VehicleState, Wheel, tire_marks,
};
use schemars::JsonSchema;
use serde::Serialize;

use crate::hand::MarkCircle;
use crate::hand::yaw_mark::{MARK_TO_CG_M, critical_speed_m_s};

/// The car whose marks are computed.
const VEHICLE: Preset = Preset::Reference;
/// Speeds of the runs over that which is asked about.
const SPEED_SHARES: [f64; 3] = [0.8, 1.0, 1.2];
/// Speeds at which runs are made, m/s.
const SPEEDS_M_S: [f64; 2] = [12.0, 50.0];
/// Angles of the front wheels, rad.
const STEER_RAD: [f64; 2] = [0.2, 0.3];
/// Time in which the front wheels turn, s.
const RISE_S: f64 = 0.4;
/// Length of a mark over which its radius is taken, and the least that it needs, m.
const CHORD_M: f64 = 15.0;
const LEAST_CHORD_M: f64 = 8.0;
/// How long a run is, s.
const DURATION_S: f64 = 4.0;

/// How far the critical speed is off on marks of the 4DOF model.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct YawMarkBias {
    /// The car.
    pub vehicle: &'static str,
    /// Drag factor of its locked wheels.
    pub friction: f64,
    /// The runs that left a mark.
    pub runs: Vec<YawMarkRun>,
    /// Mean of the speed by the mark over the true one.
    pub mean_ratio: f64,
    /// Smallest and largest of the same.
    pub range: [f64; 2],
}

/// A run of the 4DOF model that left a mark.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct YawMarkRun {
    /// Angle to which the front wheels turn, rad.
    pub steer_rad: f64,
    /// True speed where the mark begins, m/s.
    pub true_speed_m_s: f64,
    /// Radius of the mark, m.
    pub radius_m: f64,
    /// Critical speed by the mark, m/s.
    pub mark_speed_m_s: f64,
}

impl YawMarkBias {
    /// Runs the model about a speed on a road; `None` if no run leaves a mark of one radius.
    ///
    /// - `friction`: drag factor of locked wheels;
    /// - `speed_m_s`: the critical speed that is asked about.
    pub fn compute(friction: f64, speed_m_s: f64) -> Option<Self> {
        let vehicle = VEHICLE.parameters();
        let peak = friction / vehicle.tires.sliding_friction_ratio;
        let peak = peak.clamp(ROAD_FRICTION.low, ROAD_FRICTION.high);
        let vehicle = vehicle.with_friction(peak);
        let friction = peak * vehicle.tires.sliding_friction_ratio;
        let speeds = SPEED_SHARES.map(|share| {
            let [low, high] = SPEEDS_M_S;
            (share * speed_m_s).clamp(low, high)
        });
        let cases = speeds.into_iter().flat_map(|speed| STEER_RAD.map(|steer| (speed, steer)));
        let runs: Vec<YawMarkRun> =
            cases.filter_map(|(speed, steer)| run(&vehicle, friction, speed, steer)).collect();
        let ratios = || runs.iter().map(|run| run.mark_speed_m_s / run.true_speed_m_s);
        let range = ratios().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], ratio| {
            [low.min(ratio), high.max(ratio)]
        });
        let mean_ratio = ratios().sum::<f64>() / runs.len() as f64;
        (!runs.is_empty()).then_some(Self {
            vehicle: VEHICLE.id(),
            friction,
            runs,
            mean_ratio,
            range,
        })
    }
}

/// A run; `None` if it leaves no mark of one radius.
fn run(
    vehicle: &VehicleParameters,
    friction: f64,
    speed_m_s: f64,
    steer_rad: f64,
) -> Option<YawMarkRun> {
    let steer = SteerHistory { time_s: vec![0.0, RISE_S], steer_rad: vec![0.0, steer_rad] };
    let controls = Controls { steer: Some(steer), ..Controls::default() };
    let manoeuvre = Manoeuvre {
        initial: VehicleState::driving_straight(speed_m_s),
        controls,
        duration_s: DURATION_S,
        ..Manoeuvre::default()
    };
    let motion = vehicle.simulate(&manoeuvre, Integrator::Rk4).ok()?;
    let controls = &manoeuvre.controls;
    let marks =
        tire_marks(&motion.series, ControlledVehicle { vehicle, controls, friction_zones: &[] });
    // A turn to the left loads the right wheels.
    let outer = marks.iter().find(|mark| mark.wheel == Wheel::FrontRight)?;
    let circle = MarkCircle::fit(&first_part_m(outer)?)?;
    let true_speed_m_s = speed_at_m_s(&motion, outer.points.first()?.time_s)?;
    let radius_m = circle.radius_m;
    let mark_speed_m_s = critical_speed_m_s(friction, radius_m - MARK_TO_CG_M);
    let is_known = mark_speed_m_s.is_finite() && true_speed_m_s > 0.0;
    is_known.then_some(YawMarkRun { steer_rad, true_speed_m_s, radius_m, mark_speed_m_s })
}

/// The points of the start of a mark; `None` if it is too short.
fn first_part_m(mark: &TireMark) -> Option<Vec<[f64; 2]>> {
    let first = mark.points.first()?.place_m;
    let from_first = |place: [f64; 2]| (place[0] - first[0]).hypot(place[1] - first[1]);
    let places = mark.points.iter().map(|point| point.place_m);
    let part: Vec<[f64; 2]> = places.take_while(|place| from_first(*place) <= CHORD_M).collect();
    let length_m = part.last().map(|place| from_first(*place))?;
    (length_m >= LEAST_CHORD_M).then_some(part)
}

/// Speed of the CG at a time, m/s.
fn speed_at_m_s(motion: &Motion, time_s: f64) -> Option<f64> {
    let series = &motion.series;
    let at = series.time_s().iter().position(|t| *t >= time_s - 1e-9)?;
    let [vx, vy] = [Channel::Vx, Channel::Vy].map(|channel| series.get(channel)?.get(at).copied());
    Some(vx?.hypot(vy?))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The formula is a rough one even where nothing else is wrong, and errs by less than a third.
    #[test]
    fn the_critical_speed_of_marks_of_the_model_is_near_the_truth() {
        for friction in [0.5, 0.7] {
            let bias = YawMarkBias::compute(friction, 22.0).unwrap();
            assert!(bias.runs.len() >= 3, "{bias:?}");
            assert!((bias.friction - friction).abs() < 1e-9, "{bias:?}");
            assert!((0.75..1.35).contains(&bias.mean_ratio), "{bias:?}");
            let [low, high] = bias.range;
            assert!(low <= bias.mean_ratio && bias.mean_ratio <= high, "{bias:?}");
        }
    }

    #[test]
    fn the_same_question_has_the_same_bias() {
        assert_eq!(YawMarkBias::compute(0.6, 20.0), YawMarkBias::compute(0.6, 20.0));
    }
}
