//! From a force to the distribution of the motion after the impact: `predict`.

use std::path::PathBuf;
use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::analysis::{
    Analysis, MotionForecast, MotionForecastSettings, MotionOutcome, RestOutcome, Rival,
    RivalForce, SecondContacts, Sensitivity, StruckVehicle, forecast_collision, forecast_forces,
};
use crate::ask::checks::{check, check_count};
use crate::caveats::assumed::contact_default;
use crate::caveats::restrictions;
use crate::caveats::unused::{
    by_force_network, by_forecast, contact_by_force_network, drivers_by_network, zones_by_network,
};
use crate::questions::simulate::dataset::take_case;
use crate::{
    Answer, DEFAULT_DURATION_S, FlagReport, ImpliedContactReport, Library, ModelChoice,
    MotionSource, Observer, Provenance, Question, SeriesFile, SimulateAnswer, SimulateRequest,
    StudyError, VehicleChoice,
};
use impactlab_core::data::{ColumnMap, DatasetKind, ForceHistory, Outcome, check_contact_within};
use impactlab_core::ranges::{DRAWS, FORECAST_DURATION, REST_LIMIT};
use impactlab_core::uncertainty::{Caveat, CaveatKind, CaveatSubject, Caveats};
use impactlab_networks::force::{ForceModel, ForceScenario, OutsideTraining};
use impactlab_networks::response::OutsideDomain;

/// Force curves drawn from a predicted force where nobody says how many: so many that chance moves the
/// ends of the 90 % intervals of the example by less than a tenth of their width.
pub const DEFAULT_DRAWS: usize = 100;

/// How many force curves and vehicles the coarse answer draws.
pub const COARSE_DRAWS: usize = 5;

/// Asks where the struck vehicle goes, by the response network, and how sure that is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
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

/// Which force drives a motion.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ForceSource {
    /// What a force network says of the collision.
    Predicted(ModelChoice),
    /// That of the motion's own source: a record, or the pulse of a scenario.
    Given,
    /// A file.
    File(PathBuf),
}

/// Where the struck vehicle goes, SI units.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct PredictMotionReport {
    /// The scenario, case or file.
    pub scenario: String,
    /// The struck vehicle.
    pub vehicle: String,
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
    /// Probability that the striking vehicle's corner stays caught, of a predicted force.
    pub hooking_probability: Option<f64>,
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
            motion: SimulateRequest {
                vehicle_draws: DEFAULT_DRAWS,
                ..SimulateRequest::new(source)
            },
            force,
            force_map: None,
            response_model: ModelChoice::default(),
            draws: DEFAULT_DRAWS,
            seed: 0,
        }
    }

    /// The force network and the collision that it is asked about.
    fn predicted(
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

    /// Fewer draws; `None` for a forecast to rest, which is made of draws alone, and where neither the
    /// force nor a vehicle that was chosen may be drawn.
    fn coarse(&self) -> Option<Self> {
        let motion = SimulateRequest {
            vehicle_draws: self.motion.vehicle_draws.min(COARSE_DRAWS),
            ..self.motion.clone()
        };
        let coarse = Self { draws: self.draws.min(COARSE_DRAWS), motion, ..self.clone() };
        let is_drawn = matches!(self.force, ForceSource::Predicted(_))
            || self.motion.vehicle != VehicleChoice::Automatic;
        (coarse != *self && is_drawn && !self.motion.until_rest).then_some(coarse)
    }

    fn report(answer: &Self::Answer) -> &Self::Report {
        &answer.report
    }

    fn solve(
        &self,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<PredictMotionAnswer>, StudyError> {
        // The vehicles are drawn for the forecast, not for the simulation beside it.
        let mut simulation =
            SimulateRequest { vehicle_draws: 0, alone: true, ..self.motion.clone() };
        if self.is_recorded() && self.motion.until_rest {
            // The record has its own duration; what goes on to rest is the forecast.
            (simulation.until_rest, simulation.duration_s) = (false, DEFAULT_DURATION_S);
        }
        let Outcome::Complete(simulated) = simulation.answer(library, observer)? else {
            return Ok(Outcome::Cancelled);
        };
        let SimulateAnswer { report: simulated, analysis } = simulated;
        let mut unused = by_forecast(self);
        if let (ForceSource::Predicted(_), MotionSource::Scenario { scenario, .. }) =
            (&self.force, &self.motion.source)
        {
            unused.extend(by_force_network(scenario, &scenario.load()?)?);
        }
        let name = || self.motion.source.name();
        let (Some(struck), Some(own_force)) = (&analysis.struck, &analysis.force) else {
            return Err(StudyError::NoForce { name: name() });
        };
        unused.extend(zones_by_network(struck));
        unused.extend(drivers_by_network(struck));
        let model = library.response_model(&self.response_model)?;
        // A fleet has braked and dragged wheels, none that are steered or driven.
        let controls = &struck.controls;
        let is_like_fleet =
            model.population().is_some() && !(controls.is_steered() || controls.is_driven());
        if !controls.is_coasting() && !is_like_fleet {
            return Err(StudyError::NotCoasting { name: name() });
        }
        let settings = MotionForecastSettings {
            n_curves: self.draws,
            n_vehicles: self.motion.vehicle_draws,
            duration_s: match self.motion.until_rest {
                true => self.motion.duration_s,
                false => simulated.duration_s,
            },
            until_rest: self.motion.until_rest,
            seed: self.seed,
        };
        let mut of_force = Vec::new();
        let forecast = match &self.force {
            ForceSource::Given => {
                let own = Some(own_force).filter(|_| self.motion.source.is_recorded());
                of_force.extend(own.and_then(restrictions::cut_record_caveat));
                forecast_forces(std::slice::from_ref(own_force), &model, struck, &settings)
            }
            ForceSource::File(path) => {
                let file = SeriesFile { path: path.clone(), map: self.force_map.clone() };
                let force =
                    given_force(&file, struck, settings.duration_s, library, &mut of_force)?;
                forecast_forces(&[force], &model, struck, &settings)
            }
            ForceSource::Predicted(choice) => {
                let predicted = self.predicted(choice, library, observer)?;
                let Outcome::Complete((force_model, collision)) = predicted else {
                    return Ok(Outcome::Cancelled);
                };
                forecast_collision(&collision, &force_model, &model, struck, &settings)
            }
        };
        let forecast = forecast
            .map_err(|source| StudyError::Forecast { name: name(), source: Box::new(source) })?;
        let holds_here = |caveat: &Caveat| self.rests_on(caveat);
        let mut caveats: Caveats = simulated.caveats.into_iter().filter(holds_here).collect();
        caveats.extend(unused);
        let provenance = self.provenance(library)?;
        caveats.extend(self.contact_caveats(&forecast)?);
        let predicted = forecast.force.as_ref().map_or(&[][..], |force| &force.caveats);
        let report = PredictMotionReport {
            implied_contact: self.implied_contact(&forecast)?,
            flags: self.second_contact(&forecast, &analysis).into_iter().collect(),
            rival: Rival::from_simulation(&forecast, &analysis, self.rival_force()),
            ..self.report(&analysis.name, struck, &forecast)
        };
        caveats.extend(restrictions::predicted_motion_caveats(&report, predicted));
        caveats.extend(of_force);
        let report = report.without_probabilities_after_contact();
        let report = Answer { report, caveats, provenance };
        Ok(Outcome::Complete(PredictMotionAnswer { report, analysis, forecast }))
    }
}

/// The force of a file. Where it acts without a yaw moment of its own, the source of the motion says.
///
/// - `duration_s`: duration of the motion, s, within which the contact lies;
/// - `caveats`: gets what is wrong with the file.
fn given_force(
    file: &SeriesFile,
    struck: &StruckVehicle,
    duration_s: f64,
    library: &Library,
    caveats: &mut Vec<Caveat>,
) -> Result<ForceHistory, StudyError> {
    let path = &file.path;
    let loaded = library.series(file).map_err(|error| error.of_option("--force-map"))?;
    let name = path.display().to_string();
    caveats.extend(restrictions::doubtful_data_caveats(&name, &loaded));
    let force = ForceHistory::from_series(&loaded.series, loaded.force_sampling())
        .map_err(|source| StudyError::Series { path: path.to_owned(), source })?;
    // A recorded yaw moment acts about the CG: it does not say where another force acts.
    let has_contact = [struck.contact.x_body_m, struck.contact.y_body_m] != [0.0; 2];
    if force.mz_n_m.is_none() && !has_contact {
        return Err(StudyError::NoYawMoment { path: path.to_owned() });
    }
    check_contact_within(&force, duration_s)
        .map_err(|outside| StudyError::ContactOutside { name, outside })?;
    caveats.extend(restrictions::cut_record_caveat(&force));
    Ok(force)
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
        let striking = analysis.striking.as_ref()?;
        let is_own = self.force == ForceSource::Given;
        let met = SecondContacts::find(forecast, analysis.footprint, striking, is_own)?;
        Some(FlagReport::from(&met))
    }

    /// Whether what holds for the simulation holds for the motion of the struck vehicle, too.
    fn rests_on(&self, caveat: &Caveat) -> bool {
        match (caveat.kind, caveat.subject) {
            (CaveatKind::Overlap | CaveatKind::Note | CaveatKind::NotUsed, _) => true,
            // That of a record, where it is a record that moves the vehicle.
            (CaveatKind::DoubtfulData, _) => self.force == ForceSource::Given,
            (CaveatKind::Assumed, Some(subject)) => match subject {
                CaveatSubject::Striking | CaveatSubject::StrikingParameter => false,
                CaveatSubject::Pulse | CaveatSubject::Restitution => {
                    self.force == ForceSource::Given
                }
                _ => true,
            },
            _ => false,
        }
    }

    /// The seed and the networks that answer.
    fn provenance(&self, library: &Library) -> Result<Provenance, StudyError> {
        let force = match &self.force {
            ForceSource::Predicted(model) => Some(library.force_model_digest(model)?),
            ForceSource::Given | ForceSource::File(_) => None,
        };
        let response = library.response_model_digest(&self.response_model)?;
        Ok(Provenance::from_seed(self.seed).with_models(force.into_iter().chain([response])))
    }

    fn report(
        &self,
        name: &str,
        struck: &StruckVehicle,
        forecast: &MotionForecast,
    ) -> PredictMotionReport {
        let predicted = forecast.force.as_ref();
        PredictMotionReport {
            scenario: name.to_owned(),
            vehicle: struck.vehicle.name.clone(),
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
            flags: Vec::new(),
            rival: None,
            implied_contact: None,
            force_applicability: predicted.map(|force| force.applicability),
            outside_training: predicted.map_or_else(Vec::new, |force| force.outside.clone()),
            applicability: forecast.applicability.value,
            outside_domain: forecast.applicability.outside.clone(),
        }
    }
}
