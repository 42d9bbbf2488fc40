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
use impactlab_core::vehicle::{
    ContactLoad, ContactPoint, ControlledVehicle, Controls, FrictionZone, Manoeuvre, RoadDraws,
    Sensitivity, VehicleDraws, VehicleInput, VehicleParameters, VehicleState,
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
    /// Probability that the change of heading is at least 90° to either side at that time.
    pub p_quarter_turn: f64,
    /// Probability that the change of heading is at least 180° to either side at that time.
    pub p_half_turn: f64,
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

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;
    use std::ops::ControlFlow;

    use super::*;
    use crate::analysis::MotionBands;
    use crate::{Event, ForceSource, Library, MotionSource, PredictMotionRequest, Question};
    use impactlab_core::data::Sampling;
    use impactlab_core::vehicle::{DataSheet, Preset, SheetQuantity};
    use impactlab_networks::response::{RESISTANCE_SCATTER, RestSearch, SettledMotion};
    use impactlab_networks::shipped::ModelSource;

    /// The forecast of a car that is pushed to the side at its rear, by forces of 16 to 24 kN.
    fn pushed(n_forces: usize) -> MotionForecast {
        pushed_car(Preset::Reference.parameters(), n_forces, 0)
    }

    /// The same of some car.
    fn pushed_car(
        vehicle: VehicleParameters,
        n_forces: usize,
        n_vehicles: usize,
    ) -> MotionForecast {
        let force = |i: usize| ForceHistory {
            axes: ForceAxes::World,
            sampling: Sampling::Instant,
            time_s: vec![0.0, 0.05, 0.1],
            fx_n: vec![0.0; 3],
            fy_n: vec![0.0, 16e3 + 8e3 * (i as f64 + 0.5) / n_forces as f64, 0.0],
            mz_n_m: None,
        };
        let struck = StruckVehicle {
            vehicle,
            initial: VehicleState::driving_straight(15.0),
            contact: ContactPoint { x_body_m: -1.5, y_body_m: -0.8, height_m: 0.5 },
            controls: Controls::default(),
            friction_zones: Vec::new(),
        };
        let settings = MotionForecastSettings {
            n_curves: n_forces,
            n_vehicles,
            duration_s: 2.0,
            until_rest: false,
            road: None,
            seed: 1,
        };
        let forces: Vec<ForceHistory> = (0..n_forces).map(force).collect();
        let model = ModelSource::Shipped.response_model().unwrap();
        forecast_forces(&forces, &model, &struck, &settings).unwrap()
    }

    #[test]
    fn several_motions_under_each_force_say_what_one_under_each_of_many_says() {
        let [few, many] = [60, 240].map(pushed);
        let end = few.distribution.n_instants() - 1;
        assert_eq!(many.distribution.n_instants() - 1, end);
        let planar = |forecast: &MotionForecast| forecast.distribution.mean(end).planar();
        let off = planar(&few).into_iter().zip(planar(&many));
        let covariances = [&few, &many].map(|forecast| forecast.distribution.covariance(end));
        for (axis, (few, many)) in off.enumerate().take(3) {
            let [of_few, std] = covariances.map(|covariance| covariance[(axis, axis)].sqrt());
            // Four standard errors of the difference of 240 draws each: 0.37 and 0.26 of a deviation.
            assert!((many - few).abs() < 0.37 * std, "{axis}: {few} {many}, deviation {std}");
            assert!((of_few / std - 1.0).abs() < 0.3, "{axis}: deviations {of_few}, {std}");
        }
    }

    /// “front cornering coefficient 14.36” was told of a car that has another by its sheet: it was that of a draw.
    #[test]
    fn what_lies_outside_is_told_of_the_car_and_not_of_a_draw() {
        let heavy = DataSheet::default().with(SheetQuantity::Mass, 4500.0).vehicle();
        let [known, drawn] = [0, 20].map(|n| pushed_car(heavy.clone(), 1, n));
        assert_eq!((known.n_vehicles, drawn.n_vehicles), (0, 20));
        assert!(!known.applicability.outside.is_empty());
        assert_eq!(drawn.applicability.outside, known.applicability.outside);
    }

    #[test]
    fn bands_end_with_the_intervals_of_the_outcome() {
        let MotionForecast { distribution, outcome, .. } = pushed(5);
        let bands = MotionBands::new(&distribution, 50);
        let [x_m, y_m, ..] = *bands.intervals.last().unwrap();
        assert_eq!(x_m, [outcome.x_m.ninety(), outcome.x_m.half()]);
        assert_eq!(y_m, [outcome.y_m.ninety(), outcome.y_m.half()]);
    }

    #[test]
    fn the_number_of_threads_changes_nothing() {
        let [one, many] = [1, 3].map(|n_threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads).build().unwrap();
            pool.install(|| pushed(7))
        });
        assert_eq!(one.distribution, many.distribution);
        assert_eq!((one.outcome, one.paths), (many.outcome, many.paths));
    }

    /// A stable car far outside of what the network learned from. By the unscented transform of its state it
    /// turned with a probability of 1e-8.
    #[test]
    fn a_car_that_spins_in_few_motions_does_so_as_often_as_in_many_more() {
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../datasets/fea-road");
        let source = MotionSource::Case { dataset: root, case: "d002".to_owned() };
        let mut request = PredictMotionRequest::new(source, ForceSource::Given);
        request.motion.vehicle_draws = Some(0);
        let mut go_on = |_: Event<'_>| ControlFlow::Continue(());
        let answer = request.answer(&Library::default(), &mut go_on).unwrap().complete().unwrap();
        let (struck, force) = (answer.analysis.struck.unwrap(), &answer.forecast.forces[0]);
        let inputs = struck.inputs(force, request.motion.duration_s).unwrap();
        let predictor =
            ModelSource::Shipped.response_model().unwrap().predictor(&struck.vehicle).unwrap();
        let search = RestSearch { seed: 1, resistance_scatter: RESISTANCE_SCATTER };
        let numbers: Vec<usize> = (0..2000).collect();
        let many = predictor.settled(&struck.initial, &inputs, &numbers, &search).draws;
        let has_turned = |motion: &&SettledMotion| {
            let end_rad = motion.states.last().unwrap().yaw_rad;
            (end_rad - struck.initial.yaw_rad).abs() >= FRAC_PI_2
        };
        let expected = many.iter().filter(has_turned).count() as f64 / 2000.0;
        let share = answer.report.report.outcome.p_quarter_turn;
        let error = (expected * (1.0 - expected) * (1.0 / 240.0 + 1.0 / 2000.0)).sqrt();
        assert!(share > 0.0 && expected > 0.01, "{share} {expected}");
        assert!((share - expected).abs() < 4.0 * error, "{share} {expected}");
    }

    #[test]
    fn a_force_is_turned_into_world_axes() {
        let curve = ForceCurve { fx_n: vec![0.0; 250], fy_n: vec![1e3; 250], duration_s: 0.1 };
        let history = in_world(&curve, std::f64::consts::FRAC_PI_2);
        assert!((history.fx_n[3] + 1e3).abs() < 1e-9 && history.fy_n[3].abs() < 1e-9);
    }
}
