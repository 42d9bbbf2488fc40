//! From a force to the distribution of the motion after the impact: `predict`.

use std::path::PathBuf;
use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::analysis::{
    Analysis, ContactsOutcome, MotionForecast, MotionForecastSettings, MotionOutcome, PlaceChance,
    RestOutcome, Rival, RivalForce, SecondContacts, Sensitivity, StruckVehicle,
};
use crate::ask::checks::{check, check_count};
use crate::caveats::assumed::{self, contact_default};
use crate::caveats::driver::open_drivers;
use crate::caveats::restrictions;
use crate::caveats::unused::{by_forecast, contact_by_force_network, slope_by_network};
use crate::questions::predict::both_vehicles::{Both, with_contact_law};
use crate::questions::predict::recorded_impulse::RecordedImpulse;
use crate::questions::simulate::dataset::take_case;
use crate::{
    Answer, DEFAULT_DURATION_S, FlagReport, ForceSource, ImpliedContactReport, ImpulseRival,
    Library, ModelChoice, MotionSource, Observer, Provenance, Question, SimulateAnswer,
    SimulateRequest, StudyError, TriedMotion,
};
use impactlab_core::data::write::ModelDigest;
use impactlab_core::data::{ColumnMap, DatasetKind, Outcome};
use impactlab_core::ranges::{DRAWS, FORECAST_DURATION, REST_LIMIT};
use impactlab_core::uncertainty::{Caveat, CaveatKind, CaveatSubject, Caveats};
use impactlab_networks::force::{ForceModel, ForceScenario, OutsideTraining};
use impactlab_networks::pair::CourseShare;
use impactlab_networks::response::OutsideDomain;

/// Force curves drawn from a predicted force where nobody says how many: so many that chance moves the
/// ends of the 90 % intervals of the example by less than a tenth of their width.
pub const DEFAULT_DRAWS: usize = 200;

/// Vehicles that a forecast of the struck vehicle by itself draws where nobody says how many. Each is
/// followed in several whole motions, and not in a single one as in a forecast of both vehicles.
pub const ONE_VEHICLE_DRAWS: usize = 32;

/// How many force curves and vehicles the coarse answer draws.
pub const COARSE_DRAWS: usize = 5;

/// Asks where the struck vehicle goes, by the response network, and how sure that is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PredictMotionRequest {
    /// The struck vehicle, its start, and the force that it takes.
    pub motion: SimulateRequest,
    /// Which force drives the motion.
    pub force: ForceSource,
    /// Which column of the force's file is what; without it, the header says.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force_map: Option<ColumnMap>,
    /// The response network.
    #[serde(default)]
    pub response_model: ModelChoice,
    /// Whole force curves to draw from a predicted force.
    #[serde(default = "default_draws")]
    pub draws: usize,
    /// Seed of all draws.
    #[serde(default)]
    pub seed: u64,
}

fn default_draws() -> usize {
    DEFAULT_DRAWS
}

/// Where the struck vehicle goes, SI units.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct PredictMotionReport {
    /// The scenario, case or file.
    pub scenario: String,
    /// The struck vehicle.
    pub vehicle: String,
    /// Like which of the motions that were tried it is, by which it is told how often intervals held.
    pub tried_motion: TriedMotion,
    /// The force file, where the force is one.
    pub force: Option<PathBuf>,
    /// The force network, where the force is predicted.
    pub force_model: Option<String>,
    /// The response network.
    pub response_model: String,
    /// Forces that drive the motion, each as likely as the others.
    pub n_forces: usize,
    /// Vehicles that were drawn from what the data sheet leaves open; 0 if it leaves nothing open.
    pub n_vehicles: usize,
    /// How the motion ends.
    pub outcome: MotionOutcome,
    /// Where, when and after what distance the vehicle comes to rest; none unless the question asks for
    /// it.
    pub rest: Option<RestOutcome>,
    /// How long the motions were that the response network has learned from, s: what comes after that
    /// is the physics with the strengths that it knows.
    pub learned_duration_s: f64,
    /// Where the 4DOF model ends without a network: do the methods agree?
    pub rival: Option<Rival>,
    /// Which estimates of the vehicle the end depends on, the one that moves it most first.
    pub sensitivity: Vec<Sensitivity>,
    /// Restitution and impulse ratio with which a momentum solution would give the predicted impulse,
    /// beside the one with the values of the scenario; none for another force.
    pub implied_contact: Option<ImpliedContactReport>,
    /// The striking vehicle, where both vehicles were followed through all contacts.
    pub striking: Option<StrikingReport>,
    /// What becomes of the struck vehicle, the likeliest first; likewise.
    pub courses: Vec<CourseShare>,
    /// When and how the vehicles are in contact; likewise.
    pub contacts: Option<ContactsOutcome>,
    /// How likely the vehicles come to the lanes of the site and cross its kerbs; likewise.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub places: Vec<PlaceChance>,
    /// Probability that the striking vehicle's corner stays caught, of a predicted force.
    pub hooking_probability: Option<f64>,
    /// The impulse of the first contact of a scenario, or of a case of a force data set, by momentum solution
    /// and force network; none where the network has nothing of its own to say.
    pub impulses: Option<ImpulseRival>,
    /// The force that was recorded, beside these; none where nothing was.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub recorded: Option<RecordedImpulse>,
    /// A second contact of the vehicles in the 4DOF simulation of the same collision; the forecast
    /// does not know of it.
    pub flags: Vec<FlagReport>,
    /// How far the force network applies to the collision, 0 to 1; none for another force.
    pub force_applicability: Option<f64>,
    /// Where the collision lies outside what the force network has learned from.
    pub outside_training: Vec<OutsideTraining>,
    /// How far the response network holds for this motion, 0 to 1: as it falls, the forecast goes
    /// over to the 4DOF model, and its bands to the error of that.
    pub applicability: f64,
    /// Where vehicle, road or impact lie outside what the response network has learned from.
    pub outside_domain: Vec<OutsideDomain>,
}

/// Where the striking vehicle goes, SI units.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct StrikingReport {
    /// The vehicle.
    pub vehicle: String,
    /// How its motion ends.
    pub outcome: MotionOutcome,
    /// Where, when and after what distance it comes to rest; none unless the question asks for it.
    pub rest: Option<RestOutcome>,
    /// How far the response network holds for its motion, 0 to 1.
    pub applicability: f64,
    /// Where it lies outside what the response network has learned from.
    pub outside_domain: Vec<OutsideDomain>,
}

/// What is found out along the way and said with the answer.
#[derive(Debug)]
pub(super) struct Noted {
    /// What of the question is not used, and what is drawn.
    pub unused: Vec<Caveat>,
    /// What is wrong with a given force.
    pub of_force: Vec<Caveat>,
}

/// A predicted motion.
#[derive(Debug)]
pub struct PredictMotionAnswer {
    /// What is told, with what restricts it and where it comes from.
    pub report: Answer<PredictMotionReport>,
    /// The 4DOF simulation, the record and the force of the same source.
    pub analysis: Analysis,
    /// The distribution of the motion.
    pub forecast: MotionForecast,
}

impl PredictMotionRequest {
    /// A forecast in which nothing is said but the source and which force drives it.
    pub fn new(source: MotionSource, force: ForceSource) -> Self {
        Self {
            motion: SimulateRequest::new(source),
            force,
            force_map: None,
            response_model: ModelChoice::default(),
            draws: DEFAULT_DRAWS,
            seed: 0,
        }
    }

    /// Whether the question is about both vehicles of a scenario, through all their contacts.
    pub(crate) fn is_of_both(&self) -> bool {
        matches!(self.motion.source, MotionSource::Scenario { .. }) && !self.motion.one_contact
    }

    /// How many vehicles are drawn at the least; 0 for the medians alone.
    pub(super) fn n_vehicles(&self) -> usize {
        let usual = if self.is_of_both() { DEFAULT_DRAWS } else { ONE_VEHICLE_DRAWS };
        self.motion.vehicle_draws.unwrap_or(usual)
    }

    /// The force network and the collision that it is asked about.
    pub(super) fn predicted(
        &self,
        model: &ModelChoice,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<(Arc<ForceModel>, ForceScenario)>, StudyError> {
        let source = &self.motion.source;
        let collision = match source {
            MotionSource::Scenario { scenario: choice, .. } => {
                let scenario = choice.load()?;
                let numbers = ForceScenario::from_scenario(&scenario);
                numbers.map_err(|source| choice.unsolved(source))?
            }
            MotionSource::Case { dataset, case } => {
                let Outcome::Complete(dataset) = library.dataset(dataset, observer)? else {
                    return Ok(Outcome::Cancelled);
                };
                if dataset.kind != DatasetKind::Force {
                    return Err(StudyError::NoCollision { name: source.name() });
                }
                ForceScenario::from_case(take_case(&dataset, case)?)?
            }
            MotionSource::Trajectory { .. } | MotionSource::Drive(_) => {
                return Err(StudyError::NoCollision { name: source.name() });
            }
        };
        Ok(Outcome::Complete((library.force_model(model)?, collision)))
    }
}

impl Question for PredictMotionRequest {
    type Answer = PredictMotionAnswer;
    type Report = Answer<PredictMotionReport>;
    const NAME: &'static str = "predict motion";

    fn check(&self) -> Result<(), StudyError> {
        self.motion.check()?;
        // A recorded motion has its own duration.
        let is_open =
            matches!(self.motion.source, MotionSource::Scenario { .. } | MotionSource::Drive(_));
        if self.motion.until_rest {
            check("motion.duration_s", &REST_LIMIT, self.motion.duration_s)?;
        } else if is_open {
            check("motion.duration_s", &FORECAST_DURATION, self.motion.duration_s)?;
        }
        check_count("draws", &DRAWS, self.draws)
    }

    /// Fewer draws; `None` for a forecast to rest, which is made of draws alone.
    fn coarse(&self) -> Option<Self> {
        let motion = SimulateRequest {
            vehicle_draws: Some(self.n_vehicles().min(COARSE_DRAWS)),
            ..self.motion.clone()
        };
        let coarse = Self { draws: self.draws.min(COARSE_DRAWS), motion, ..self.clone() };
        let is_coarser = coarse.draws < self.draws || self.n_vehicles() > COARSE_DRAWS;
        (is_coarser && !self.motion.until_rest).then_some(coarse)
    }

    fn report(answer: &Self::Answer) -> &Self::Report {
        &answer.report
    }

    fn solve(
        &self,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<PredictMotionAnswer>, StudyError> {
        if let MotionSource::Scenario { scenario, .. } = &self.motion.source {
            scenario.refuse_fixed()?;
        }
        // The vehicles are drawn for the forecast, not for the simulation beside it.
        let mut simulation =
            SimulateRequest { vehicle_draws: Some(0), alone: true, ..self.motion.clone() };
        if self.is_recorded() && self.motion.until_rest {
            // The record has its own duration; what goes on to rest is the forecast.
            (simulation.until_rest, simulation.duration_s) = (false, DEFAULT_DURATION_S);
        }
        let Outcome::Complete(simulated) = simulation.answer(library, observer)? else {
            return Ok(Outcome::Cancelled);
        };
        let SimulateAnswer { report: simulated, analysis } = simulated;
        let Some(struck) = analysis.struck.as_ref().filter(|_| analysis.force.is_some()) else {
            return Err(StudyError::NoForce { name: self.motion.source.name() });
        };
        let model = library.response_model(&self.response_model)?;
        let settings = MotionForecastSettings {
            n_curves: self.draws,
            n_vehicles: self.n_vehicles(),
            duration_s: match self.motion.until_rest {
                true => self.motion.duration_s,
                false => simulated.duration_s,
            },
            until_rest: self.motion.until_rest,
            road: self.motion.road(&struck.vehicle, self.seed),
            seed: self.seed,
        };
        let mut noted = Noted { unused: by_forecast(self), of_force: Vec::new() };
        noted.unused.extend(slope_by_network(struck));
        noted.unused.extend(restrictions::slope_caveat(&struck.vehicle.slope));
        let forecast = match Both::of_simulation(&analysis) {
            Some(both) => {
                self.of_both_vehicles(&both, &model, &settings, (library, observer), &mut noted)?
            }
            None => {
                self.of_one_vehicle(&analysis, &model, &settings, (library, observer), &mut noted)?
            }
        };
        let Outcome::Complete(forecast) = forecast else { return Ok(Outcome::Cancelled) };
        let follows_both = forecast.both.is_some();
        let holds_here = |caveat: &Caveat| self.rests_on(caveat, follows_both);
        let mut caveats: Caveats = simulated.caveats.into_iter().filter(holds_here).collect();
        caveats.extend(noted.unused);
        if forecast.n_vehicles > 0 {
            caveats.extend(assumed::road(&self.motion, &struck.vehicle));
        }
        if follows_both && settings.n_vehicles > 0 {
            caveats.extend(assumed::zones(&struck.friction_zones));
        }
        let Outcome::Complete(beside) = self.impulses(struck, library, observer)? else {
            return Ok(Outcome::Cancelled);
        };
        let provenance = self.provenance(beside.model, library)?;
        caveats.extend(beside.caveats);
        caveats.extend(open_drivers(&self.motion)?);
        caveats.extend(self.contact_caveats(&forecast)?);
        let predicted = forecast.force.as_ref().map_or(&[][..], |force| &force.caveats);
        let of_forecast = self.report(&analysis, struck, &forecast);
        let has_pulses = of_forecast.n_momentum_pulses() > 0;
        let predicted = match &forecast.both {
            Some(_) => with_contact_law(predicted, has_pulses),
            None => predicted.to_vec(),
        };
        // What half of the draws follow is no other method.
        let rival = Rival::from_simulation(&forecast, &analysis, self.rival_force());
        let report = PredictMotionReport {
            implied_contact: self.implied_contact(&forecast)?,
            flags: self.second_contact(&forecast, &analysis).into_iter().collect(),
            impulses: beside.rival,
            recorded: self.recorded(&analysis, struck, &forecast),
            rival: rival.filter(|_| !has_pulses),
            places: self.places(&forecast, &analysis, &mut caveats)?,
            tried_motion: self.tried_motion(struck, follows_both)?,
            ..of_forecast
        };
        caveats.extend(restrictions::predicted_motion_caveats(&report, &predicted));
        caveats.extend(noted.of_force);
        let report = report.without_probabilities_after_contact();
        let report = Answer { report, caveats, provenance };
        Ok(Outcome::Complete(PredictMotionAnswer { report, analysis, forecast }))
    }
}

impl PredictMotionRequest {
    /// What the predicted force of a scenario implies of the contact.
    fn implied_contact(
        &self,
        forecast: &MotionForecast,
    ) -> Result<Option<ImpliedContactReport>, StudyError> {
        let (Some(prediction), MotionSource::Scenario { scenario: choice, .. }) =
            (&forecast.force, &self.motion.source)
        else {
            return Ok(None);
        };
        let scenario = choice.load()?;
        let impact = scenario.impact().map_err(|source| choice.unsolved(source))?;
        let heading_rad = scenario.struck.heading_rad;
        Ok(ImpliedContactReport::from_prediction(prediction, &impact, heading_rad, self.seed))
    }

    /// The force of the 4DOF simulation of the same source.
    fn rival_force(&self) -> RivalForce {
        match self.force {
            ForceSource::Given => RivalForce::Same,
            ForceSource::Predicted(_) | ForceSource::File(_) => RivalForce::Momentum,
        }
    }

    /// What a predicted force does not use of what the scenario says of the contact, and what stands for
    /// what it leaves open.
    fn contact_caveats(&self, forecast: &MotionForecast) -> Result<Vec<Caveat>, StudyError> {
        let (Some(force), MotionSource::Scenario { scenario, .. }) =
            (&forecast.force, &self.motion.source)
        else {
            return Ok(Vec::new());
        };
        let collision = scenario.load()?;
        let impact = collision.impact().map_err(|source| scenario.unsolved(source))?;
        let open = contact_default(&collision, &impact).filter(|_| force.applicability < 1.0);
        let unused = contact_by_force_network(&collision.contact, force.applicability);
        Ok(unused.into_iter().chain(open).collect())
    }

    /// Whether the motion of the source is a recorded one.
    fn is_recorded(&self) -> bool {
        match &self.motion.source {
            MotionSource::Trajectory { .. } => true,
            MotionSource::Case { dataset, .. } => {
                DatasetKind::from_folder(dataset) == Some(DatasetKind::Trajectory)
            }
            MotionSource::Scenario { .. } | MotionSource::Drive(_) => false,
        }
    }

    /// Whether the vehicles meet again, over the draws. The striking vehicle moves as in the
    /// simulation where the force is that of the simulation.
    fn second_contact(&self, forecast: &MotionForecast, analysis: &Analysis) -> Option<FlagReport> {
        let striking = analysis.striking.as_ref().filter(|_| forecast.both.is_none())?;
        let is_own = self.force == ForceSource::Given;
        let met = SecondContacts::find(forecast, analysis.footprint, striking, is_own)?;
        Some(FlagReport::from(&met))
    }

    /// Whether what holds for the simulation holds for the forecast, too.
    ///
    /// - `follows_both`: whether that is of both vehicles.
    fn rests_on(&self, caveat: &Caveat, follows_both: bool) -> bool {
        match (caveat.kind, caveat.subject) {
            (CaveatKind::Overlap | CaveatKind::Note | CaveatKind::NotUsed, _) => true,
            (CaveatKind::OtherVehicle, of) => follows_both || of == Some(CaveatSubject::Vehicle),
            // That of a record, where it is a record that moves the vehicle.
            (CaveatKind::DoubtfulData, _) => self.force == ForceSource::Given,
            (CaveatKind::Assumed, Some(subject)) => match subject {
                CaveatSubject::Striking => follows_both,
                // What its data sheet leaves open is drawn with the rest.
                CaveatSubject::StrikingParameter => follows_both && self.n_vehicles() == 0,
                CaveatSubject::Pulse | CaveatSubject::Restitution => {
                    self.force == ForceSource::Given
                }
                _ => true,
            },
            _ => false,
        }
    }

    /// The seed and the networks that answer.
    ///
    /// - `beside`: a force network that was asked beside a given force.
    fn provenance(
        &self,
        beside: Option<ModelDigest>,
        library: &Library,
    ) -> Result<Provenance, StudyError> {
        let force = match &self.force {
            ForceSource::Predicted(model) => Some(library.force_model_digest(model)?),
            ForceSource::Given | ForceSource::File(_) => beside,
        };
        let response = library.response_model_digest(&self.response_model)?;
        Ok(Provenance::from_seed(self.seed).with_models(force.into_iter().chain([response])))
    }

    fn report(
        &self,
        analysis: &Analysis,
        struck: &StruckVehicle,
        forecast: &MotionForecast,
    ) -> PredictMotionReport {
        let predicted = forecast.force.as_ref();
        let (both, striking) = (forecast.both.as_deref(), analysis.striking.as_ref());
        PredictMotionReport {
            scenario: analysis.name.clone(),
            vehicle: struck.vehicle.name.clone(),
            tried_motion: TriedMotion::Coasting,
            force: match &self.force {
                ForceSource::File(path) => Some(path.clone()),
                ForceSource::Given => self.motion.source.force_file().cloned(),
                ForceSource::Predicted(_) => None,
            },
            force_model: match &self.force {
                ForceSource::Predicted(model) => Some(model.to_string()),
                ForceSource::Given | ForceSource::File(_) => None,
            },
            response_model: self.response_model.to_string(),
            n_forces: forecast.forces.len(),
            n_vehicles: forecast.n_vehicles,
            outcome: forecast.outcome.clone(),
            rest: forecast.rest.clone(),
            learned_duration_s: forecast.learned_s,
            sensitivity: forecast.sensitivity.clone(),
            hooking_probability: predicted.and_then(|force| force.hooking_probability),
            striking: both.map(|both| StrikingReport {
                vehicle: striking
                    .map_or_else(String::new, |track| track.start.vehicle.name.clone()),
                outcome: both.striking_outcome.clone(),
                rest: both.striking_rest.clone(),
                applicability: both.striking_applicability.value,
                outside_domain: both.striking_applicability.outside.clone(),
            }),
            courses: both.map_or_else(Vec::new, |both| both.courses.clone()),
            contacts: both.map(|both| both.contacts.clone()),
            places: Vec::new(),
            flags: Vec::new(),
            rival: None,
            impulses: None,
            recorded: None,
            implied_contact: None,
            force_applicability: predicted.map(|force| force.applicability),
            outside_training: predicted.map_or_else(Vec::new, |force| force.outside.clone()),
            applicability: forecast.applicability.value,
            outside_domain: forecast.applicability.outside.clone(),
        }
    }
}
