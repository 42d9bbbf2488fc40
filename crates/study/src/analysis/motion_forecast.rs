//! Forecast of the motion of the struck vehicle with its uncertainty: the distribution of the
//! impact force, or a given force, is propagated through the response network to a distribution of
//! the motion.
//!
//! Each whole curve drawn from the distribution of the force gives its own distribution of motions,
//! and the forecast is the mixture of these, equally weighted. The impulse is therefore uncertain
//! as a whole, and not independently at each instant.

use std::f64::consts::{FRAC_PI_2, PI};

use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::motion_to_rest::{Settled, ToRest};
use crate::analysis::{BothVehicles, MonteCarloError, RestOutcome};
use impactlab_core::collision::Pose;
use impactlab_core::collision::contact::PairError;
use impactlab_core::data::{
    ContactOutside, ForceAxes, ForceHistory, check_contact_within, contact_interval,
};
use impactlab_core::numerics::random_stream;
use impactlab_core::ranges::{DRAWS, FORECAST_DURATION, OutOfRange, REST_LIMIT};
use impactlab_core::uncertainty::{ForceCurve, PlanarMixture};
use impactlab_core::units::Estimate;
use impactlab_core::vehicle::{
    ContactLoad, ContactPoint, ControlledVehicle, Controls, FrictionZone, Manoeuvre, Pace,
    RoadDraws, Sensitivity, VehicleDraws, VehicleInput, VehicleParameters, VehicleState,
    rest_instant,
};
use impactlab_networks::force::{ForceError, ForceModel, ForcePrediction, ForceScenario};
use impactlab_networks::learning::LearningError;
use impactlab_networks::response::{
    Applicability, ComponentMotion, MotionDistribution, Predictor, ResponseModel, STEP_S,
    weighted_mean,
};

/// Largest standard deviation of a component's heading with which its moments are propagated, rad.
/// With 1 rad the mean of a velocity that turns with the vehicle has lost 40 % of its size.
const MOST_HEADING_STD_RAD: f64 = 0.8;
/// Number of draws for the intervals of the final position.
const N_END_DRAWS: usize = 4000;

/// Settings of a motion forecast.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionForecastSettings {
    /// Number of whole force curves that are drawn; at least one is drawn.
    pub n_curves: usize,
    /// Number of vehicles that are drawn from what the data sheet of the struck vehicle leaves open;
    /// with 0 all estimates are at their medians.
    pub n_vehicles: usize,
    /// Duration of the forecast from the start of the impact, s, 0.1 to 60, or, of a motion that is
    /// followed to rest, to 120.
    pub duration_s: f64,
    /// Whether the motion is followed until the vehicle is at rest, at the latest to the duration.
    pub until_rest: bool,
    /// How the friction of the road is drawn; `None` where it is known. It is drawn with the vehicles.
    pub road: Option<RoadDraws>,
    /// Seed of all random draws.
    pub seed: u64,
}

/// Parameters and initial state of the struck vehicle, and the point where the force acts on it; or
/// of the striking one.
#[derive(Debug, Clone, PartialEq)]
pub struct StruckVehicle {
    /// Parameters of the vehicle.
    pub vehicle: VehicleParameters,
    /// State of the vehicle at the start of the impact.
    pub initial: VehicleState<f64>,
    /// Point where the force acts, in body axes.
    pub contact: ContactPoint,
    /// What steers, brakes and locks the wheels.
    pub controls: Controls,
    /// Parts of the ground with their own friction. A forecast with a network leaves them out.
    pub friction_zones: Vec<FrictionZone>,
}

/// A forecast of the motion of the struck vehicle.
#[derive(Debug, Clone)]
pub struct MotionForecast {
    /// Distribution of the motion, at intervals of [`STEP_S`].
    pub distribution: MotionDistribution,
    /// The path with the latent factors of the model at zero ([`Predictor::central_path`]),
    /// averaged over the force curves.
    pub central: Vec<VehicleState<f64>>,
    /// The path with the latent factors at zero in each draw, from first contact on: the forces and
    /// the vehicles take turns. Positions of the CG and headings at intervals of [`STEP_S`].
    pub paths: Vec<Vec<Pose>>,
    /// Force histories with which the motions were computed; the axes are those in which they were
    /// given.
    pub forces: Vec<ForceHistory>,
    /// Final position, heading and speed.
    pub outcome: MotionOutcome,
    /// Where, when and after what distance the vehicle comes to rest, of a motion that is followed to
    /// rest.
    pub rest: Option<RestOutcome>,
    /// How long the motions were that the response network has learned from, s. What comes after that
    /// is the physics with the strengths that it knows.
    pub learned_s: f64,
    /// The prediction of the force network, if the force was predicted.
    pub force: Option<ForcePrediction>,
    /// Number of vehicles that were drawn; 0 if the struck vehicle has no estimates.
    pub n_vehicles: usize,
    /// Which estimates of the vehicle the end of the motion depends on; empty if none was drawn.
    pub sensitivity: Vec<Sensitivity>,
    /// The striking vehicle and the contacts, where both vehicles are followed through all of them.
    pub both: Option<Box<BothVehicles>>,
    /// How far the response network holds for the forecast: mean over forces and vehicles, with what
    /// lies outside for the median of them.
    pub applicability: Applicability,
}

/// State of the vehicle at rest, or at the end of the forecast.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct MotionOutcome {
    /// Time from the start of the impact at which the vehicle comes to rest, or duration of the
    /// forecast, s.
    pub time_s: f64,
    /// Whether the vehicle comes to rest: after the end of the force, speed and yaw rate fall below
    /// [`REST_SPEED_M_S`](impactlab_core::vehicle::REST_SPEED_M_S) and
    /// [`REST_YAW_RATE_RAD_S`](impactlab_core::vehicle::REST_YAW_RATE_RAD_S) and stay there to the end of the
    /// forecast.
    pub is_at_rest: bool,
    /// X of the CG at that time, m.
    pub x_m: Estimate,
    /// Y of the CG at that time, m.
    pub y_m: Estimate,
    /// Change of heading since the start of the impact, rad, positive to the left. It is not
    /// wrapped: a full turn counts as 2π.
    pub heading_change_rad: Estimate,
    /// Speed of the CG, m/s: mean over the central paths under each force.
    pub speed_m_s: f64,
    /// Yaw rate, rad/s, positive to the left: mean over the central paths under each force.
    pub yaw_rate_rad_s: f64,
    /// Area of the smallest region that holds the position with a probability of 90 %, m²; none after a
    /// second contact, which is not computed.
    pub region_90_m2: Option<f64>,
    /// Probability that the change of heading is at least 90° to either side at that time.
    pub p_quarter_turn: f64,
    /// Probability that the change of heading is at least 180° to either side at that time.
    pub p_half_turn: f64,
    /// How much of this is chance, because forces and vehicles are drawn a limited number of times;
    /// none where nothing is drawn.
    pub monte_carlo: Option<MonteCarloError>,
}

/// Reason for which a forecast cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum MotionForecastError {
    /// The force network cannot predict the force.
    #[error(transparent)]
    Force(#[from] ForceError),
    /// The response network cannot predict the motion.
    #[error(transparent)]
    Response(#[from] LearningError),
    /// The duration of the forecast or the number of forces is outside its range.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
    /// The force acts outside the time of the forecast.
    #[error(transparent)]
    ContactOutside(#[from] ContactOutside),
    /// No draw of both vehicles can be followed.
    #[error("the vehicles cannot be followed through their contacts")]
    Pair(#[from] PairError),
    /// The predicted motion is not finite.
    #[error("the predicted motion diverges")]
    Diverged,
}

impl StruckVehicle {
    /// The vehicle with what acts on its wheels and the ground under them.
    pub fn controlled(&self) -> ControlledVehicle<'_> {
        ControlledVehicle {
            vehicle: &self.vehicle,
            controls: &self.controls,
            friction_zones: &self.friction_zones,
        }
    }

    /// Inputs of the vehicle at each time step under a force. Drivers and systems do what they do in the
    /// motion of the 4DOF model under this force.
    ///
    /// - returns `None` where that motion cannot be computed.
    pub(super) fn inputs(
        &self,
        force: &ForceHistory,
        duration_s: f64,
    ) -> Option<Vec<VehicleInput<f64>>> {
        let mut manoeuvre = Manoeuvre {
            initial: self.initial,
            contact_load: Some(ContactLoad {
                force: force.clone(),
                contact: self.contact,
                recorded_moment: force.mz_n_m.is_some(),
            }),
            controls: self.controls.clone(),
            duration_s,
            ends_at_rest: false,
            friction_zones: Vec::new(),
        };
        manoeuvre.controls = self.vehicle.applied_controls(&manoeuvre).ok()?;
        Some(manoeuvre.inputs(STEP_S, (duration_s / STEP_S).round() as usize))
    }
}

/// Forecast of the motion after a collision whose force is predicted by a force network.
///
/// - `collision`: the numbers of the collision that the force network takes.
/// - `struck`: the vehicle; the force acts at its contact point, and its heading defines the axes
///   of the predicted force.
///
/// # Errors
/// [`MotionForecastError::Force`] if the force network refuses the collision,
/// [`MotionForecastError::ContactOutside`] if a drawn force ends after the forecast, and the errors
/// of [`forecast_forces`].
pub fn forecast_collision(
    collision: &ForceScenario,
    force_model: &ForceModel,
    response: &ResponseModel,
    struck: &StruckVehicle,
    settings: &MotionForecastSettings,
) -> Result<MotionForecast, MotionForecastError> {
    DRAWS.check_count(settings.n_curves as u64)?;
    let prediction = force_model.predict(collision)?;
    let mut rng = random_stream(settings.seed, "force curves", 0);
    let curves = prediction.mixture.sample(settings.n_curves, &mut rng);
    let heading_rad = struck.initial.yaw_rad;
    let forces: Vec<ForceHistory> =
        curves.iter().map(|curve| in_world(curve, heading_rad)).collect();
    for force in &forces {
        check_contact_within(force, settings.duration_s)?;
    }
    let mut forecast = forecast_forces(&forces, response, struck, settings)?;
    forecast.force = Some(prediction);
    Ok(forecast)
}

/// Forecast of the motion after given forces, which are equally likely.
///
/// Vehicles that are drawn take the forces in turn, so that each part of the mixture has a force and a
/// vehicle of its own.
///
/// # Errors
/// [`MotionForecastError::OutOfRange`] for a duration outside [`FORECAST_DURATION`] or
/// [`REST_LIMIT`],
/// [`MotionForecastError::Response`] if the response network refuses the vehicle,
/// [`MotionForecastError::Diverged`] if the motion is not finite.
pub fn forecast_forces(
    forces: &[ForceHistory],
    response: &ResponseModel,
    struck: &StruckVehicle,
    settings: &MotionForecastSettings,
) -> Result<MotionForecast, MotionForecastError> {
    let range = if settings.until_rest { REST_LIMIT } else { FORECAST_DURATION };
    let duration_s = range.check(settings.duration_s)?;
    // What is uncertain of a car whose motions are known is in the network's strengths.
    let is_known = response.known_car(&struck.vehicle).is_some();
    let draws = drawn_vehicles(struck, settings, forces.len(), !is_known);
    let predictors = predictors(response, struck, draws.as_ref())?;
    let whole_motions = ToRest {
        forces,
        predictors: &predictors,
        struck,
        has_drawn_vehicles: draws.is_some() && !is_known && struck.vehicle.sheet.is_some(),
        limit_s: duration_s,
        lasts_to_limit: !settings.until_rest,
        seed: settings.seed,
    };
    let motion = match settings.until_rest {
        true => whole_motions.settle().map(ForecastMotion::from_settled),
        false => propagated(forces, &predictors, struck, settings)
            .filter(|motion| motion.is_followed_by_moments())
            .or_else(|| whole_motions.settle()?.timed(forces, settings.seed)),
    };
    let ForecastMotion { distribution, paths, outcome, rest, applicabilities } =
        motion.ok_or(MotionForecastError::Diverged)?;
    let central = mean_of(&paths);
    if !central.iter().all(|state| state.to_array().iter().all(|v| v.is_finite())) {
        return Err(MotionForecastError::Diverged);
    }
    let sensitivity = draws.as_ref().map_or_else(Vec::new, |draws| {
        let end = |path: &Vec<VehicleState<f64>>| {
            path.last().map(|state| [state.x_m, state.y_m, state.yaw_rad])
        };
        draws.sensitivities(&paths.iter().map(end).collect::<Vec<_>>())
    });
    Ok(MotionForecast {
        distribution,
        central,
        paths: paths.iter().map(|path| path.iter().map(pose).collect()).collect(),
        forces: forces.to_vec(),
        outcome,
        rest,
        learned_s: predictors.first().map_or(f64::INFINITY, Predictor::learned_s),
        force: None,
        n_vehicles: draws.map_or(0, |draws| draws.len()),
        sensitivity,
        applicability: usual(applicabilities.iter().collect()),
        both: None,
    })
}

/// A motion over all forces and vehicles.
struct ForecastMotion {
    distribution: MotionDistribution,
    paths: Vec<Vec<VehicleState<f64>>>,
    outcome: MotionOutcome,
    rest: Option<RestOutcome>,
    applicabilities: Vec<Applicability>,
}

impl ForecastMotion {
    fn from_settled(settled: Settled) -> Self {
        let Settled { distribution, paths, outcome, rest, applicabilities } = settled;
        Self { distribution, paths, outcome, rest: Some(rest), applicabilities }
    }

    /// Whether mean and covariance follow the motion: no component is so uncertain about its heading
    /// that a normal distribution of position and velocity in the axes of the vehicle means nothing.
    fn is_followed_by_moments(&self) -> bool {
        let at_end = |component: &ComponentMotion| component.states.last().copied();
        let ends = self.distribution.components.iter().filter_map(at_end);
        ends.map(|end| end.covariance[(2, 2)].sqrt()).all(|std_rad| std_rad < MOST_HEADING_STD_RAD)
    }
}

impl Settled {
    /// The same motion with its outcome at the end of the forecast, or where it has come to rest.
    fn timed(self, forces: &[ForceHistory], seed: u64) -> Option<ForecastMotion> {
        let outcome = MotionOutcome {
            monte_carlo: self.outcome.monte_carlo,
            ..timed_outcome(&self.distribution, &self.paths, forces, seed)?
        };
        Some(ForecastMotion { outcome, rest: None, ..ForecastMotion::from_settled(self) })
    }
}

/// The outcome of a motion that is followed for a given time.
fn timed_outcome(
    distribution: &MotionDistribution,
    paths: &[Vec<VehicleState<f64>>],
    forces: &[ForceHistory],
    seed: u64,
) -> Option<MotionOutcome> {
    let pace = Pace::mean_of(paths);
    let force_end_s = forces.iter().filter_map(contact_interval).map(|(_, end_s)| end_s);
    let rest = rest_instant(&pace, STEP_S, force_end_s.fold(0.0, f64::max));
    outcome(distribution, &mean_of(paths), &pace, rest, seed)
}

/// The motion over the duration, by propagation of the moments of the state; `None` where it is not
/// finite.
fn propagated(
    forces: &[ForceHistory],
    predictors: &[Predictor],
    struck: &StruckVehicle,
    settings: &MotionForecastSettings,
) -> Option<ForecastMotion> {
    let n_parts = forces.len().max(predictors.len());
    let forecast = |part: usize| {
        let (force, predictor) =
            (forces.get(part % forces.len())?, predictors.get(part % predictors.len())?);
        let inputs = struck.inputs(force, settings.duration_s)?;
        Some(Part {
            motion: predictor.motion(&struck.initial, &inputs),
            path: predictor.central_path(&struck.initial, &inputs),
            applicability: predictor.applicability(&struck.initial, &inputs),
        })
    };
    let parts: Vec<Part> = (0..n_parts).into_par_iter().filter_map(forecast).collect();
    let applicabilities = parts.iter().map(|part| part.applicability.clone()).collect();
    let (parts, paths): (Vec<MotionDistribution>, Vec<Vec<VehicleState<f64>>>) =
        parts.into_iter().map(|part| (part.motion, part.path)).unzip();
    let distribution = MotionDistribution::mixed(parts);
    let mut outcome = timed_outcome(&distribution, &paths, forces, settings.seed)?;
    let instant = (outcome.time_s / STEP_S).round() as usize;
    outcome.monte_carlo = MonteCarloError::from_mixture(&distribution, instant, paths.len());
    Some(ForecastMotion { distribution, paths, outcome, rest: None, applicabilities })
}

pub(super) fn pose(state: &VehicleState<f64>) -> Pose {
    Pose { x_m: state.x_m, y_m: state.y_m, yaw_rad: state.yaw_rad }
}

/// What lies outside for the median of several forces and vehicles, with the mean of their values.
pub(super) fn usual(mut all: Vec<&Applicability>) -> Applicability {
    all.sort_by(|a, b| a.distance.total_cmp(&b.distance));
    let mean =
        all.iter().map(|applicability| applicability.value).sum::<f64>() / all.len().max(1) as f64;
    match all.get(all.len() / 2) {
        Some(median) => Applicability { value: mean, ..(*median).clone() },
        None => Applicability::whole(),
    }
}

/// The forecast for one force and one vehicle.
struct Part {
    motion: MotionDistribution,
    path: Vec<VehicleState<f64>>,
    applicability: Applicability,
}

/// The draws of what is not known of vehicle and road, at least one for each force; `None` if that is
/// nothing or no draws are asked for.
///
/// - `uses_sheet`: whether what the data sheet leaves open is drawn, too.
pub(super) fn drawn_vehicles(
    struck: &StruckVehicle,
    settings: &MotionForecastSettings,
    n_forces: usize,
    uses_sheet: bool,
) -> Option<VehicleDraws> {
    let MotionForecastSettings { n_vehicles, road, seed, .. } = *settings;
    let n_draws = if n_vehicles > 0 { n_vehicles.max(n_forces) } else { 0 };
    let draws = VehicleDraws::new(&struck.vehicle, uses_sheet, road, n_draws, seed);
    (!draws.is_empty()).then_some(draws)
}

/// The network for each vehicle that was drawn, or for the one that is known.
fn predictors(
    response: &ResponseModel,
    struck: &StruckVehicle,
    draws: Option<&VehicleDraws>,
) -> Result<Vec<Predictor>, MotionForecastError> {
    let vehicles = match draws {
        Some(draws) => draws.vehicles(&struck.vehicle),
        None => vec![struck.vehicle.clone()],
    };
    let made: Result<Vec<Predictor>, LearningError> =
        vehicles.par_iter().map(|vehicle| response.predictor(vehicle)).collect();
    Ok(made?)
}

/// Rotates a curve from axes along the struck vehicle's initial heading into world axes.
pub(crate) fn in_world(curve: &ForceCurve, heading_rad: f64) -> ForceHistory {
    let mut history = curve.to_history();
    let (sin, cos) = heading_rad.sin_cos();
    for (fx, fy) in history.fx_n.iter_mut().zip(&mut history.fy_n) {
        (*fx, *fy) = (cos * *fx - sin * *fy, sin * *fx + cos * *fy);
    }
    history.axes = ForceAxes::World;
    history
}

/// Mean state of several paths at each instant.
fn mean_of(paths: &[Vec<VehicleState<f64>>]) -> Vec<VehicleState<f64>> {
    let n_instants = paths.first().map_or(0, Vec::len);
    let weight = 1.0 / paths.len().max(1) as f64;
    let states = |i: usize| paths.iter().filter_map(move |path| Some((weight, path.get(i)?)));
    (0..n_instants).map(|i| weighted_mean(states(i))).collect()
}

/// Outcome of a motion; `None` for an empty motion.
///
/// - `rest`: the instant at which the vehicle comes to rest, if it does.
fn outcome(
    distribution: &MotionDistribution,
    central: &[VehicleState<f64>],
    pace: &[Pace],
    rest: Option<usize>,
    seed: u64,
) -> Option<MotionOutcome> {
    let at = rest.unwrap_or(central.len().checked_sub(1)?);
    let (pace, start, end) = (pace.get(at)?, central.first()?, central.get(at)?);
    let position: PlanarMixture = distribution.position(at);
    let draws = position.sample(N_END_DRAWS, seed);
    let along = |axis: usize| Estimate::from_draws(draws.iter().map(|point| point[axis]).collect());
    let heading = distribution.heading(at)?;
    Some(MotionOutcome {
        time_s: at as f64 * STEP_S,
        is_at_rest: rest.is_some(),
        x_m: along(0),
        y_m: along(1),
        heading_change_rad: heading.estimate().mapped(|yaw_rad| yaw_rad - start.yaw_rad),
        speed_m_s: pace.speed_m_s,
        yaw_rate_rad_s: end.yaw_rate_rad_s,
        region_90_m2: Some(position.region_m2(0.9)),
        p_quarter_turn: heading.p_outside(start.yaw_rad - FRAC_PI_2, start.yaw_rad + FRAC_PI_2),
        p_half_turn: heading.p_outside(start.yaw_rad - PI, start.yaw_rad + PI),
        monte_carlo: None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_force_is_turned_into_world_axes() {
        let curve = ForceCurve { fx_n: vec![0.0; 250], fy_n: vec![1e3; 250], duration_s: 0.1 };
        let history = in_world(&curve, std::f64::consts::FRAC_PI_2);
        assert!((history.fx_n[3] + 1e3).abs() < 1e-9 && history.fy_n[3].abs() < 1e-9);
    }
}
