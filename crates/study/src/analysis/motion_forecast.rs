//! Forecast of the motion of the struck vehicle with its uncertainty: motions that the response network
//! draws under forces of a distribution, or under a given one.
//!
//! The forecast consists of whole motions, at least
//! [`LEAST_MOTIONS`](impactlab_networks::response::LEAST_MOTIONS) of them. Curves drawn from the
//! distribution of the force and drawn vehicles take turns in them, so that the impulse is uncertain as a
//! whole, and not independently at each instant; each motion has latent factors and noise of the network of
//! its own.

use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

use crate::analysis::motion_to_rest::{Settled, ToRest};
use crate::analysis::{BothVehicles, MonteCarloError, RestOutcome};
use impactlab_core::collision::Pose;
use impactlab_core::collision::contact::PairError;
use impactlab_core::data::{ContactOutside, ForceAxes, ForceHistory, check_contact_within};
use impactlab_core::numerics::random_stream;
use impactlab_core::ranges::{DRAWS, FORECAST_DURATION, OutOfRange, REST_LIMIT};
use impactlab_core::uncertainty::ForceCurve;
use impactlab_core::units::Estimate;
use impactlab_core::vehicle::frames::Heading;
use impactlab_core::vehicle::{
    ContactLoad, ContactPoint, Controls, FrictionZone, Manoeuvre, RoadDraws, Sensitivity,
    VehicleDraws, VehicleInput, VehicleParameters, VehicleState,
};
use impactlab_networks::force::{ForceError, ForceModel, ForcePrediction, ForceScenario};
use impactlab_networks::learning::LearningError;
use impactlab_networks::response::{
    Applicability, MotionDistribution, Predictor, ResponseModel, STEP_S, weighted_mean,
};

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
    /// What is to steer, brake and lock the wheels: histories, and drivers and systems that act by the motion.
    pub controls: Controls,
    /// Parts of the ground with their own friction. A forecast with a network leaves them out.
    pub friction_zones: Vec<FrictionZone>,
}

/// A forecast of the motion of the struck vehicle.
#[derive(Debug, Clone)]
pub struct MotionForecast {
    /// Distribution of the motion, at intervals of [`STEP_S`].
    pub distribution: MotionDistribution,
    /// The path with the latent factors of the model at zero
    /// ([`SettledMotions::central`](impactlab_networks::response::SettledMotions::central)), averaged over
    /// the force curves.
    pub central: Vec<VehicleState<f64>>,
    /// The path with the latent factors at zero under each force, or of each vehicle where these are more:
    /// they take turns. Of both vehicles the paths of the draws. Positions of the CG and headings from first
    /// contact on, at intervals of [`STEP_S`].
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
    /// lies outside for the vehicle by its data sheet under the usual force.
    pub applicability: Applicability,
}

impl MotionForecast {
    /// Time of the last instant, s.
    pub fn end_s(&self) -> f64 {
        self.distribution.n_instants().saturating_sub(1) as f64 * STEP_S
    }
}

/// State of the vehicle at rest, or at the end of the forecast.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct MotionOutcome {
    /// Time from the start of the impact since which all draws are at rest, or duration of the forecast, s.
    pub time_s: f64,
    /// Whether the vehicle comes to rest in 95 % of the draws: after the end of the force, speed and yaw rate
    /// fall below [`REST_SPEED_M_S`](impactlab_core::vehicle::REST_SPEED_M_S) and
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
    /// Speed of the CG, m/s: mean over the draws.
    pub speed_m_s: f64,
    /// Yaw rate, rad/s, positive to the left: mean over the draws.
    pub yaw_rate_rad_s: f64,
    /// Area of the smallest region that holds the position with a probability of 90 %, m²; none after a
    /// second contact, which is not computed.
    pub region_90_m2: Option<f64>,
    /// Probability that the change of heading is at least 90° to either side at that time; likewise.
    pub p_quarter_turn: Option<f64>,
    /// Probability that the change of heading is at least 180° to either side at that time; likewise.
    pub p_half_turn: Option<f64>,
    /// How much of this is chance, because forces, vehicles and motions are drawn a limited number of
    /// times; none of a single motion.
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
/// The motions take forces and drawn vehicles in turn: motion i has force and vehicle p mod their numbers,
/// where p is i mod the larger of these.
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
    let question = ToRest {
        forces,
        predictors: &predictors,
        struck,
        has_drawn_vehicles: draws.is_some() && !is_known && struck.vehicle.sheet.is_some(),
        limit_s: duration_s,
        lasts_to_limit: !settings.until_rest,
        seed: settings.seed,
    };
    let Settled { distribution, paths, outcome, rest, applicabilities } =
        question.settle().ok_or(MotionForecastError::Diverged)?;
    let applicability = match &draws {
        Some(_) => of_drawn(&applicabilities, &by_sheet(response, &question)?),
        None => usual(applicabilities.iter().collect()),
    };
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
        paths: paths.iter().map(|path| path.iter().map(Pose::from_state).collect()).collect(),
        forces: forces.to_vec(),
        outcome,
        rest,
        learned_s: predictors.first().map_or(f64::INFINITY, Predictor::learned_s),
        force: None,
        n_vehicles: draws.map_or(0, |draws| draws.len()),
        sensitivity,
        applicability,
        both: None,
    })
}

/// What lies outside for the median of several forces and vehicles, with the mean of their values.
fn usual(mut all: Vec<&Applicability>) -> Applicability {
    all.sort_by(|a, b| a.distance.total_cmp(&b.distance));
    let mean =
        all.iter().map(|applicability| applicability.value).sum::<f64>() / all.len().max(1) as f64;
    match all.get(all.len() / 2) {
        Some(median) => Applicability { value: mean, ..(*median).clone() },
        None => Applicability::whole(),
    }
}

/// How far the network holds over the vehicles that were drawn. What lies outside is told of the vehicle as it is
/// by its data sheet: a value that was drawn is none of it.
pub(super) fn of_drawn(drawn: &[Applicability], by_sheet: &Applicability) -> Applicability {
    Applicability { outside: by_sheet.outside.clone(), ..usual(drawn.iter().collect()) }
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

/// How far the network holds for the vehicle as it is by its data sheet, under the usual force.
fn by_sheet(
    response: &ResponseModel,
    question: &ToRest<'_>,
) -> Result<Applicability, MotionForecastError> {
    let ToRest { forces, struck, limit_s, .. } = *question;
    let predictor = response.predictor(&struck.vehicle)?;
    let under = |force: &ForceHistory| {
        let inputs = struck.inputs(force, limit_s)?;
        Some(predictor.applicability(&struck.initial, &inputs))
    };
    let all: Vec<Applicability> = forces.par_iter().filter_map(under).collect();
    Ok(usual(all.iter().collect()))
}

/// Rotates a curve from axes along the struck vehicle's initial heading into world axes.
pub(crate) fn in_world(curve: &ForceCurve, heading_rad: f64) -> ForceHistory {
    let mut history = curve.to_history();
    let heading = Heading::new(heading_rad);
    for (fx, fy) in history.fx_n.iter_mut().zip(&mut history.fy_n) {
        [*fx, *fy] = heading.world_from_body([*fx, *fy]);
    }
    history.axes = ForceAxes::World;
    history
}

/// A pulse without the ripple that is drawn after its end: as long as a known force lasts, the contact law
/// does nothing.
pub(crate) fn ended(pulse: &ForceCurve) -> ForceCurve {
    let mut ended = pulse.clone();
    let forces = ended.fx_n.iter_mut().zip(&mut ended.fy_n);
    for (time_s, (fx_n, fy_n)) in pulse.time_s().into_iter().zip(forces) {
        if time_s > pulse.duration_s {
            (*fx_n, *fy_n) = (0.0, 0.0);
        }
    }
    ended
}

/// Mean state of several paths at each instant.
fn mean_of(paths: &[Vec<VehicleState<f64>>]) -> Vec<VehicleState<f64>> {
    let n_instants = paths.first().map_or(0, Vec::len);
    let weight = 1.0 / paths.len().max(1) as f64;
    let states = |i: usize| paths.iter().filter_map(move |path| Some((weight, path.get(i)?)));
    (0..n_instants).map(|i| weighted_mean(states(i))).collect()
}

#[cfg(test)]
#[path = "motion_forecast_tests.rs"]
mod tests;
