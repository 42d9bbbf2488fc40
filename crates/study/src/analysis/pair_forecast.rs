//! Forecast of both vehicles through all contacts: whole draws of what is not known of them.
//!
//! A draw takes the first contact from the force network as often as that applies, else from the contact law
//! or, where that was hardly tried, in every other draw from the momentum solution; later contacts are those
//! of the law. Both vehicles are followed together, so
//! that their motions, contacts and courses of events belong to each other.

use rayon::prelude::*;

use crate::analysis::contact_pair::{ContactPair, manoeuvres};
use crate::analysis::contacts::ContactsOutcome;
use crate::analysis::motion_forecast::{drawn_vehicles, of_drawn};
use crate::analysis::motion_to_rest::SettledDraws;
use crate::analysis::{
    MotionForecast, MotionForecastError, MotionForecastSettings, MotionOutcome, RestOutcome,
    StruckVehicle,
};
use impactlab_core::collision::Pose;
use impactlab_core::data::{ForceHistory, Outcome, check_contact_within};
use impactlab_core::jobs::ProgressCallback;
use impactlab_core::ranges::{FORECAST_DURATION, REST_LIMIT};
use impactlab_core::vehicle::{
    ContactLoad, Sensitivity, VehicleDraws, VehicleInput, VehicleParameters, VehicleState,
};
use impactlab_networks::force::ForcePrediction;
use impactlab_networks::learning::LearningError;
use impactlab_networks::pair::{
    CourseShare, DrawnVehicle, PairDraw, PairForecast, PairQuestion, PairScatter, PairSettings,
    forecast_pair,
};
use impactlab_networks::response::{
    Applicability, MotionDistribution, Predictor, ResponseModel, STEP_S, SettledMotion,
};

/// By how much the seed of the striking vehicle differs.
pub(super) const SEED_OF_STRIKING: u64 = 0x9e37_79b9_7f4a_7c15;

/// Where the force of the first contact of a draw comes from.
#[derive(Debug, Clone, PartialEq)]
pub enum FirstContact {
    /// The contact law.
    Law,
    /// A curve of the force network.
    Network(ForceHistory),
    /// The momentum solution as a pulse, with a draw of its errors.
    Momentum(ForceHistory),
}

impl FirstContact {
    /// The force on the struck vehicle; `None` where it follows from the contact law.
    pub fn force(&self) -> Option<&ForceHistory> {
        match self {
            Self::Law => None,
            Self::Network(force) | Self::Momentum(force) => Some(force),
        }
    }

    /// The force, if it is that of the force network.
    pub fn network_force(&self) -> Option<&ForceHistory> {
        self.force().filter(|_| matches!(self, Self::Network(_)))
    }
}

/// The forces of the first contact, of which each draw takes one in turn.
#[derive(Debug, Clone)]
pub struct FirstForces {
    /// With everything at its median; the contact law from the start on where there is none.
    pub median: Option<ForceHistory>,
    /// Of the draws.
    pub draws: Vec<FirstContact>,
    /// What the force network says, where it was asked.
    pub prediction: Option<ForcePrediction>,
}

/// Two vehicles of which a forecast is asked; arrays are struck, striking.
#[derive(Debug, Clone, Copy)]
pub struct BothVehiclesQuestion<'a> {
    /// Outlines, faces and contact.
    pub pair: &'a ContactPair,
    /// The vehicles at first contact.
    pub vehicles: [&'a StruckVehicle; 2],
    /// The force of the first contact.
    pub first_forces: &'a FirstForces,
    /// A force of about that size, by which it is judged how far the response network applies.
    pub usual_force: &'a ForceHistory,
    /// The response network.
    pub response: &'a ResponseModel,
    /// Whether it corrects each vehicle; without it the equations of motion stand alone.
    pub is_corrected: [bool; 2],
}

/// What a forecast says of both vehicles together, and of the striking one.
#[derive(Debug, Clone)]
pub struct BothVehicles {
    /// Distribution of the motion of the striking vehicle, at intervals of [`STEP_S`].
    pub striking: MotionDistribution,
    /// Its paths in the draws, in the order of those of the struck vehicle.
    pub striking_paths: Vec<Vec<Pose>>,
    /// Its motion with everything at its median.
    pub striking_central: Vec<VehicleState<f64>>,
    /// How its motion ends.
    pub striking_outcome: MotionOutcome,
    /// Where, when and after what distance it comes to rest, of a motion that is followed to rest.
    pub striking_rest: Option<RestOutcome>,
    /// How far the response network holds for it; wholly where the equations of motion stand alone.
    pub striking_applicability: Applicability,
    /// What becomes of the struck vehicle, the likeliest first.
    pub courses: Vec<CourseShare>,
    /// When and how the vehicles are in contact.
    pub contacts: ContactsOutcome,
}

/// One vehicle over the draws.
struct OneVehicle {
    distribution: MotionDistribution,
    central: Vec<VehicleState<f64>>,
    outcome: MotionOutcome,
    rest: Option<RestOutcome>,
}

/// The vehicles that stand for one in the draws.
struct Drawn {
    /// What is not known of vehicle and road; `None` where that is nothing.
    unknown: Option<VehicleDraws>,
    vehicles: Vec<DrawnVehicle>,
    /// The network of the vehicle at its median.
    median: Predictor,
    /// How far that one holds.
    of_median: Applicability,
    applicabilities: Vec<Applicability>,
}

/// Forecast of both vehicles.
///
/// # Errors
/// [`MotionForecastError::OutOfRange`] for a duration outside of its range,
/// [`MotionForecastError::ContactOutside`] if a known force ends after the forecast,
/// [`MotionForecastError::Response`] if the response network refuses a vehicle,
/// [`MotionForecastError::Pair`] if no draw can be computed, [`MotionForecastError::Diverged`] if a motion
/// is not finite.
pub fn forecast_both(
    question: &BothVehiclesQuestion<'_>,
    settings: &MotionForecastSettings,
    report: &mut ProgressCallback<'_>,
) -> Result<Outcome<MotionForecast>, MotionForecastError> {
    let BothVehiclesQuestion { pair, vehicles, first_forces, .. } = *question;
    let range = if settings.until_rest { REST_LIMIT } else { FORECAST_DURATION };
    let duration_s = range.check(settings.duration_s)?;
    let drawn_forces = first_forces.draws.iter().filter_map(FirstContact::force);
    for force in drawn_forces.chain(&first_forces.median) {
        check_contact_within(force, duration_s)?;
    }
    let n_draws = settings.n_curves.max(1);
    let drawn = [question.drawn(0, n_draws, settings)?, question.drawn(1, n_draws, settings)?];
    let manoeuvres =
        manoeuvres(vehicles, first_forces.median.as_ref(), duration_s, settings.until_rest);
    let loads: Vec<Option<ContactLoad>> = first_forces
        .draws
        .iter()
        .map(|first| first.force().map(|force| vehicles[0].load(force)))
        .collect();
    let question_of_pair = PairQuestion {
        vehicles: vehicles.map(|it| &it.vehicle),
        manoeuvres: [&manoeuvres[0], &manoeuvres[1]],
        outlines: [0, 1].map(|i| &pair.outlines[i]),
        faces: pair.faces,
        conditions: pair.conditions,
        predictors: [0, 1].map(|i| Some(&drawn[i].median).filter(|_| question.is_corrected[i])),
        drawn: [0, 1].map(|i| drawn[i].vehicles.as_slice()),
        first_forces: &loads,
    };
    let scatter = scatter(settings.n_vehicles);
    let pair_settings = PairSettings { n_draws, seed: settings.seed, scatter };
    let Outcome::Complete(found) = forecast_pair(&question_of_pair, &pair_settings, report)? else {
        return Ok(Outcome::Cancelled);
    };
    let of_vehicle = |i: usize| {
        one_vehicle(&found, i, duration_s, settings.until_rest, vehicles[i].initial.yaw_rad)
            .ok_or(MotionForecastError::Diverged)
    };
    let (struck, striking) = (of_vehicle(0)?, of_vehicle(1)?);
    let sensitivity = sensitivities(drawn[0].unknown.as_ref(), &found);
    let paths = |i: usize| -> Vec<Vec<Pose>> {
        found
            .draws
            .iter()
            .map(|draw| draw.states[i].iter().map(Pose::from_state).collect())
            .collect()
    };
    let both = BothVehicles {
        striking_paths: paths(1),
        striking: striking.distribution,
        striking_central: striking.central,
        striking_outcome: striking.outcome,
        striking_rest: striking.rest,
        striking_applicability: match question.is_corrected[1] {
            true => of_drawn(&drawn[1].applicabilities, &drawn[1].of_median),
            false => Applicability::whole(),
        },
        courses: found.courses(),
        contacts: ContactsOutcome::new(&found, duration_s),
    };
    let forces = first_forces.draws.iter().filter_map(FirstContact::network_force).cloned();
    let forces = if first_forces.draws.is_empty() {
        first_forces.median.iter().cloned().collect()
    } else {
        forces.collect()
    };
    Ok(Outcome::Complete(MotionForecast {
        distribution: struck.distribution,
        central: struck.central,
        paths: paths(0),
        forces,
        outcome: struck.outcome,
        rest: struck.rest,
        learned_s: drawn[0].median.learned_s(),
        force: first_forces.prediction.clone(),
        n_vehicles: drawn[0].unknown.as_ref().map_or(0, VehicleDraws::len),
        sensitivity,
        applicability: of_drawn(&drawn[0].applicabilities, &drawn[0].of_median),
        both: Some(Box::new(both)),
    }))
}

/// Which estimates of the struck vehicle the end of its motion depends on; none if they were not drawn.
fn sensitivities(unknown: Option<&VehicleDraws>, found: &PairForecast) -> Vec<Sensitivity> {
    let Some(draws) = unknown else { return Vec::new() };
    let mut ends = vec![None; draws.len()];
    for draw in &found.draws {
        let end = draw.states[0].last().map(|state| [state.x_m, state.y_m, state.yaw_rad]);
        if let Some(place) = ends.get_mut(draw.number) {
            *place = end;
        }
    }
    draws.sensitivities(&ends)
}

/// What is not known of both vehicles and the ground, which is at its median where the vehicles are.
fn scatter(n_vehicles: usize) -> PairScatter {
    let usual = PairScatter::default();
    let zone_friction_log = if n_vehicles > 0 { usual.zone_friction_log } else { 0.0 };
    PairScatter { zone_friction_log, ..usual }
}

impl BothVehiclesQuestion<'_> {
    /// What stands for a vehicle in the draws.
    fn drawn(
        &self,
        vehicle_idx: usize,
        n_draws: usize,
        settings: &MotionForecastSettings,
    ) -> Result<Drawn, MotionForecastError> {
        let start = self.vehicles[vehicle_idx];
        let seed = if vehicle_idx == 0 { settings.seed } else { settings.seed ^ SEED_OF_STRIKING };
        // What is uncertain of a car whose motions are known is in the network's strengths.
        let is_known = self.response.known_car(&start.vehicle).is_some();
        // One for each draw, or none.
        let n_vehicles = settings.n_vehicles.min(n_draws);
        let of_vehicle = MotionForecastSettings { seed, n_vehicles, ..*settings };
        let unknown = drawn_vehicles(start, &of_vehicle, n_draws, !is_known);
        let is_whole = !is_known && start.vehicle.sheet.is_some();
        let inputs = self.inputs(vehicle_idx, settings.duration_s)?;
        let fitted =
            |vehicle: &VehicleParameters| -> Result<(Predictor, Applicability), LearningError> {
                let predictor = self.response.predictor(vehicle)?;
                let applicability = predictor.applicability(&start.initial, &inputs);
                Ok((predictor.fitted(&start.initial, &inputs), applicability))
            };
        let (median, of_median) = fitted(&start.vehicle)?;
        let made =
            |vehicle: VehicleParameters| -> Result<(DrawnVehicle, Applicability), LearningError> {
                let (predictor, applicability) = fitted(&vehicle)?;
                let predictor = Some(predictor).filter(|_| self.is_corrected[vehicle_idx]);
                Ok((DrawnVehicle { vehicle, predictor, is_whole }, applicability))
            };
        let all = unknown.as_ref().map_or_else(Vec::new, |draws| draws.vehicles(&start.vehicle));
        let all: Result<Vec<_>, LearningError> = all.into_par_iter().map(made).collect();
        let (vehicles, mut applicabilities): (Vec<_>, Vec<_>) = all?.into_iter().unzip();
        // Where the road alone is drawn, the network is judged on the one that is meant.
        if applicabilities.is_empty() || !is_whole {
            applicabilities = vec![of_median.clone()];
        }
        Ok(Drawn { unknown, vehicles, median, of_median, applicabilities })
    }

    /// Inputs of a vehicle under the usual force.
    fn inputs(
        &self,
        vehicle: usize,
        duration_s: f64,
    ) -> Result<Vec<VehicleInput<f64>>, MotionForecastError> {
        let force = self.usual_force;
        let inputs = match vehicle {
            0 => self.vehicles[0].inputs(force, duration_s),
            _ => self.vehicles[1].inputs(&opposite(force), duration_s),
        };
        inputs.ok_or(MotionForecastError::Diverged)
    }
}

/// The force on the striking vehicle of a force on the struck one.
pub(super) fn opposite(force: &ForceHistory) -> ForceHistory {
    ForceHistory {
        fx_n: force.fx_n.iter().map(|value| -value).collect(),
        fy_n: force.fy_n.iter().map(|value| -value).collect(),
        mz_n_m: None,
        ..force.clone()
    }
}

/// One vehicle over the draws; `None` where a motion is not finite.
fn one_vehicle(
    found: &PairForecast,
    vehicle: usize,
    duration_s: f64,
    until_rest: bool,
    start_rad: f64,
) -> Option<OneVehicle> {
    let instant = |time_s: f64| (time_s / STEP_S).round() as usize;
    let settled = |draw: &PairDraw| SettledMotion {
        states: draw.states[vehicle].clone(),
        rest: draw.rest_s[vehicle].map(instant),
    };
    let draws: Vec<SettledMotion> = found.draws.iter().map(settled).collect();
    let centre = PairDraw::from_motion(0, found.centre.clone());
    let mut central = centre.states.into_iter().nth(vehicle)?;
    let lengths = draws.iter().map(|draw| draw.states.len()).chain([central.len()]);
    let n_instants = match until_rest {
        true => lengths.max()?,
        false => instant(duration_s) + 1,
    };
    let last = *central.last()?;
    central.resize(n_instants, last);
    let SettledDraws { distribution, outcome, rest } =
        SettledDraws::new(draws, [1, 1], n_instants, duration_s, start_rad)?;
    Some(OneVehicle { distribution, central, outcome, rest: until_rest.then_some(rest) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_networks::response::OutsideDomain;

    /// “front axle load share is 0.6290” was told of a car that has 0.605 by its sheet: it was that of a draw.
    #[test]
    fn what_lies_outside_is_told_of_the_vehicle_and_not_of_a_draw() {
        let of = |value, at: Option<f64>| {
            let quantity = "front axle load share";
            let outside = at.map(|value| OutsideDomain { quantity, value, range: [0.43, 0.628] });
            Applicability { value, distance: 1.0 - value, outside: outside.into_iter().collect() }
        };
        let drawn = [of(1.0, None), of(0.8, Some(0.629)), of(0.6, Some(0.63))];
        let told = of_drawn(&drawn, &of(1.0, None));
        assert!((told.value - 0.8).abs() < 1e-12 && told.outside.is_empty(), "{told:?}");
        let by_sheet = of(0.7, Some(0.64));
        assert_eq!(of_drawn(&drawn, &by_sheet).outside, by_sheet.outside);
    }
}
