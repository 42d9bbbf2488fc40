//! One coherent draw of one scenario: both vehicles through all contacts to rest.
//!
//! It is a draw of a forecast of both vehicles by itself: force of the first contact, vehicles, road,
//! faces, drivers and latent factors are drawn together from one seed. Medians, bands and centres are
//! left out, so that many scenarios can be drawn once each.

use rand::RngExt as _;

use crate::analysis::contact_pair::{ContactPair, manoeuvres};
use crate::analysis::motion_forecast::{ended, in_world};
use crate::analysis::pair_forecast::{SEED_OF_STRIKING, opposite};
use crate::analysis::scenario::starts;
use crate::analysis::{AnalysisError, MotionForecastError, PulseSetup, Settings, StruckVehicle};
use impactlab_core::collision::contact::PairError;
use impactlab_core::collision::{Footprint, Regime, Scenario, ScenarioError, Side};
use impactlab_core::data::{ContactOutside, ForceHistory, check_contact_within};
use impactlab_core::numerics::random_stream;
use impactlab_core::ranges::{OutOfRange, REST_LIMIT};
use impactlab_core::vehicle::{
    Integrator, Manoeuvre, MotionFlag, RoadDraws, VehicleDraws, VehicleInput, VehicleParameters,
};
use impactlab_networks::force::{ForceError, ForceModel, ForceScenario};
use impactlab_networks::learning::LearningError;
use impactlab_networks::pair::{DrawnVehicle, PairDraw, PairQuestion, PairScatter, PairSettings};
use impactlab_networks::response::{Applicability, ResponseModel, STEP_S};

/// Depth from which on a dent is one, m.
const LEAST_DENT_M: f64 = 1e-3;

/// Half of a wheel arch along the vehicle, m: the doors lie between the arches.
const HALF_ARCH_M: f64 = 0.4;

/// A scenario of which one draw is asked.
#[derive(Debug, Clone, Copy)]
pub struct PairRowQuestion<'a> {
    /// The scenario, with what both drivers do.
    pub scenario: &'a Scenario,
    /// Struck and striking vehicle on the road of the scenario. Mass, inertia and outline are those of the
    /// scenario.
    pub vehicles: [&'a VehicleParameters; 2],
    /// Standard deviation of the friction of the road; 0 where it is known.
    pub road_sigma: f64,
    /// Time after which the motion is followed no further, s.
    pub limit_s: f64,
    /// Seed of all that is drawn.
    pub seed: u64,
}

/// One draw.
#[derive(Debug, Clone, PartialEq)]
pub struct PairRow {
    /// Motions and contacts of both vehicles.
    pub draw: PairDraw,
    /// Outlines of the struck and of the striking vehicle.
    pub footprints: [Footprint; 2],
    /// Their masses as drawn, kg.
    pub masses_kg: [f64; 2],
    /// Whether a door of the struck vehicle is dented.
    pub is_door_dented: bool,
    /// Whether a wheel of the struck vehicle lifts off the road.
    pub lifts_wheel: bool,
    /// How far the force network applies, 0 to 1.
    pub force_applicability: f64,
    /// How far the response network applies to the struck vehicle, 0 to 1.
    pub response_applicability: f64,
}

/// Reason why a draw cannot be computed.
#[derive(Debug, thiserror::Error)]
pub enum PairRowError {
    /// The scenario has no start.
    #[error(transparent)]
    Analysis(#[from] AnalysisError),
    /// The vehicles move apart where they touch.
    #[error("the vehicles do not approach each other where they touch")]
    NotApproaching,
    /// The motion cannot be followed.
    #[error(transparent)]
    Forecast(Box<MotionForecastError>),
}

impl From<MotionForecastError> for PairRowError {
    fn from(error: MotionForecastError) -> Self {
        Self::Forecast(Box::new(error))
    }
}

/// Draws a scenario once. The result depends on the question and the networks alone.
///
/// # Errors
/// [`PairRowError`] if the vehicles do not meet, a number is out of range, or the motion cannot be followed.
pub fn pair_row(
    question: &PairRowQuestion<'_>,
    force_model: &ForceModel,
    response: &ResponseModel,
) -> Result<PairRow, PairRowError> {
    let scenario = question.scenario;
    let limit_s = REST_LIMIT.check(question.limit_s).map_err(out_of_range)?;
    let pulse = PulseSetup::default();
    let ([struck, mut striking], normal_rad) = starts(scenario, &pulse, &question.settings())?;
    let pair = ContactPair::new([&struck, &striking])?;
    pair.close_gap(&struck, &mut striking, normal_rad);
    let (force, force_applicability) = question.first_force(&struck, force_model)?;
    let solved = scenario.solve().map_err(no_scenario)?;
    if solved.regime == Regime::NotApproaching {
        return Err(PairRowError::NotApproaching);
    }
    let usual = match &force {
        Some(force) => force.clone(),
        None => pulse.history(solved.impulse_world_n_s)?,
    };
    check_contact_within(&usual, limit_s).map_err(outside)?;
    let seeds = [question.seed, question.seed ^ SEED_OF_STRIKING];
    let (of_struck, applicability) = question.drawn(&struck, &usual, seeds[0], response)?;
    let (of_striking, _) = question.drawn(&striking, &opposite(&usual), seeds[1], response)?;
    let manoeuvres = manoeuvres([&struck, &striking], force.as_ref(), limit_s, true);
    let of_pair = PairQuestion {
        vehicles: [&struck.vehicle, &striking.vehicle],
        manoeuvres: [&manoeuvres[0], &manoeuvres[1]],
        outlines: [&pair.outlines[0], &pair.outlines[1]],
        faces: pair.faces,
        conditions: pair.conditions,
        predictors: [None; 2],
        drawn: [std::slice::from_ref(&of_struck), std::slice::from_ref(&of_striking)],
        first_forces: &[],
    };
    let scatter = PairScatter::default();
    let settings = PairSettings { n_draws: 1, seed: question.seed, scatter };
    let motion = of_pair.single_draw(&settings).map_err(not_followed)?;
    let is_lift = |flag: &MotionFlag| matches!(flag, MotionFlag::WheelLift { .. });
    Ok(PairRow {
        footprints: [scenario.struck.footprint(), scenario.striking.footprint()],
        masses_kg: [&of_struck, &of_striking].map(|it| it.vehicle.mass.mass_kg),
        is_door_dented: is_door_dented(&pair, &of_struck.vehicle, &motion.dents_m[0]),
        lifts_wheel: motion.motions[0].flags.iter().any(is_lift),
        draw: PairDraw::from_motion(0, motion),
        force_applicability,
        response_applicability: applicability.value,
    })
}

fn out_of_range(error: OutOfRange) -> MotionForecastError {
    error.into()
}

fn outside(error: ContactOutside) -> MotionForecastError {
    error.into()
}

fn no_scenario(error: ScenarioError) -> AnalysisError {
    error.into()
}

fn no_force(error: ForceError) -> MotionForecastError {
    error.into()
}

fn no_response(error: LearningError) -> MotionForecastError {
    error.into()
}

fn not_followed(error: PairError) -> MotionForecastError {
    error.into()
}

impl PairRowQuestion<'_> {
    fn settings(&self) -> Settings {
        let [struck, striking] = self.vehicles.map(VehicleParameters::clone);
        Settings {
            struck,
            striking,
            ending: self.scenario.ending.clone().unwrap_or_default(),
            integrator: Integrator::default(),
            duration_s: self.limit_s,
            ends_at_rest: true,
            one_contact: false,
            friction_zones: Vec::new(),
        }
    }

    /// The force of the first contact, as often as the network applies, and how far it does. The network
    /// itself is asked only where its force is drawn. Where it is not, the contact law follows from the start,
    /// and beyond pushes on a flank in every other draw the momentum solution with its errors, as in a forecast.
    fn first_force(
        &self,
        struck: &StruckVehicle,
        model: &ForceModel,
    ) -> Result<(Option<ForceHistory>, f64), PairRowError> {
        let collision = ForceScenario::from_scenario(self.scenario).map_err(no_scenario)?;
        let applicability = model.applicability(&collision).map_err(no_force)?;
        let heading_rad = struck.initial.yaw_rad;
        let mut rng = random_stream(self.seed, "force curves", 0);
        if rng.random::<f64>() < applicability {
            let learned = model.learned(&collision).map_err(no_force)?;
            let curve = learned.sample(1, &mut rng).pop();
            return Ok((curve.map(|curve| in_world(&curve, heading_rad)), applicability));
        }
        let mut rng = random_stream(self.seed, "momentum pulses", 0);
        if collision.is_push_on_flank() || rng.random::<bool>() {
            return Ok((None, applicability));
        }
        let bare = model.predict(&collision).map_err(no_force)?.bare;
        let pulse = bare.and_then(|pulses| pulses.sample(1, &mut rng).pop());
        Ok((pulse.map(|pulse| in_world(&ended(&pulse), heading_rad)), applicability))
    }

    /// A vehicle as drawn, with its response network, and how far that applies.
    ///
    /// - `usual`: a force on it of about the size that acts.
    fn drawn(
        &self,
        start: &StruckVehicle,
        usual: &ForceHistory,
        seed: u64,
        response: &ResponseModel,
    ) -> Result<(DrawnVehicle, Applicability), MotionForecastError> {
        // What is uncertain of a car whose motions are known is in the network's strengths.
        let is_known = response.known_car(&start.vehicle).is_some();
        let road = (self.road_sigma > 0.0)
            .then_some(RoadDraws { sigma: self.road_sigma, seed: self.seed });
        let draws = VehicleDraws::new(&start.vehicle, !is_known, road, 1, seed);
        let drawn = if draws.is_empty() { None } else { draws.vehicles(&start.vehicle).pop() };
        let is_whole = drawn.is_some() && !is_known && start.vehicle.sheet.is_some();
        let vehicle = drawn.unwrap_or_else(|| start.vehicle.clone());
        let predictor = response.predictor(&vehicle).map_err(no_response)?;
        let inputs = impact_inputs(start, usual);
        let applicability = predictor.applicability(&start.initial, &inputs);
        // As in a forecast, a network of one car has seen coasting vehicles alone.
        let is_corrected = start.controls.is_coasting() || response.population().is_some();
        let predictor = is_corrected.then(|| predictor.fitted(&start.initial, &inputs));
        Ok((DrawnVehicle { vehicle, predictor, is_whole }, applicability))
    }
}

/// Inputs over the impact alone, by which it is judged how far the response network applies.
fn impact_inputs(start: &StruckVehicle, force: &ForceHistory) -> Vec<VehicleInput<f64>> {
    let end_s = force.time_s.last().copied().unwrap_or(0.0) + STEP_S;
    let manoeuvre = Manoeuvre {
        initial: start.initial,
        contact_load: Some(start.load(force)),
        duration_s: end_s,
        ..Manoeuvre::default()
    };
    manoeuvre.inputs(STEP_S, (end_s / STEP_S).ceil() as usize)
}

/// Whether the side of a vehicle is dented between its wheel arches.
fn is_door_dented(pair: &ContactPair, vehicle: &VehicleParameters, dents_m: &[f64]) -> bool {
    let geometry = &vehicle.geometry;
    let doors_m =
        HALF_ARCH_M - geometry.cg_to_rear_axle_m..=geometry.cg_to_front_axle_m - HALF_ARCH_M;
    pair.outlines[0].elements().iter().zip(dents_m).any(|(element, &dent_m)| {
        let is_side = matches!(element.face, Side::Left | Side::Right);
        is_side && dent_m > LEAST_DENT_M && doors_m.contains(&element.point_body_m[0])
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Library, ModelChoice};
    use impactlab_core::vehicle::{Ending, Preset, StabilityControl};

    #[test]
    fn a_seed_gives_the_same_draw_and_another_seed_another_one() {
        let library = Library::default();
        let force = library.force_model(&ModelChoice::default()).unwrap();
        let response = library.response_model(&ModelChoice::default()).unwrap();
        let mut scenario = Scenario::example();
        let esc = Some(StabilityControl::default());
        scenario.ending = Some(Ending { esc, ..Ending::default() });
        let vehicles = [Preset::Target.parameters(), Preset::Bullet2000.parameters()];
        let row = |seed| {
            let question = PairRowQuestion {
                scenario: &scenario,
                vehicles: [&vehicles[0], &vehicles[1]],
                road_sigma: 0.06,
                limit_s: 30.0,
                seed,
            };
            pair_row(&question, &force, &response).unwrap()
        };
        let first = row(3);
        assert_eq!(first, row(3));
        assert_ne!(first.draw, row(4).draw);
        assert!(!first.draw.phases.is_empty(), "the cars meet");
        assert!((0.0..=1.0).contains(&first.response_applicability), "{first:?}");
        let mut apart = scenario.clone();
        apart.striking.vy_world_m_s = -apart.striking.vy_world_m_s;
        let question = PairRowQuestion {
            scenario: &apart,
            vehicles: [&vehicles[0], &vehicles[1]],
            road_sigma: 0.0,
            limit_s: 30.0,
            seed: 1,
        };
        assert!(pair_row(&question, &force, &response).is_err());
    }

    /// A sweep had the contact law alone in every row of a T-bone, of which a forecast has it in half.
    #[test]
    fn beyond_flanks_every_other_row_has_the_momentum_solution() {
        let model = Library::default().force_model(&ModelChoice::default()).unwrap();
        let vehicles = [Preset::Target.parameters(), Preset::Bullet2000.parameters()];
        let mut scenario = Scenario::example();
        scenario.striking.heading_rad = std::f64::consts::FRAC_PI_2;
        scenario.striking.vx_world_m_s = 0.0;
        scenario.striking.vy_world_m_s = 25.0;
        let first_force = |seed| {
            let question = PairRowQuestion {
                scenario: &scenario,
                vehicles: [&vehicles[0], &vehicles[1]],
                road_sigma: 0.0,
                limit_s: 5.0,
                seed,
            };
            let starts = starts(&scenario, &PulseSetup::default(), &question.settings());
            let ([struck, _], _) = starts.unwrap();
            question.first_force(&struck, &model).unwrap()
        };
        let all: Vec<_> = (0..32).map(first_force).collect();
        assert!(all.iter().all(|(_, applicability)| *applicability < 0.05));
        let n_known = all.iter().filter(|(force, _)| force.is_some()).count();
        assert!((7..=25).contains(&n_known), "{n_known}");
    }
}
