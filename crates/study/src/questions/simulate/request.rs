//! The motion of one struck vehicle by the 4DOF model: `simulate`.

use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::analysis::{
    Analysis, AnalysisError, PulseSetup, Settings, analyse_case, analyse_drive,
    analyse_recorded_pair, analyse_recording, analyse_scenario,
};
use crate::ask::checks::{check, check_all, check_count, check_given};
use crate::ask::inputs::{OpenVehicle, striking_vehicle, struck_vehicle};
use crate::caveats::driver::open_drivers;
use crate::caveats::other_vehicle::other_vehicles;
use crate::caveats::unused::{
    self, by_recorded_pair, by_simulation, contact_at_medians, integrator_of_pair, vehicle_of_fixed,
};
use crate::caveats::{assumed, bodies, restrictions};
use crate::questions::predict::impulse_rival::Beside;
use crate::questions::recorded_pair::load_pair;
use crate::questions::simulate::dataset::take_case;
use crate::questions::simulate::motion_source::{
    acting_force, contact_height_assumption, pulse_assumptions, recorded_force,
    refuse_contact_off_vehicle, start_of_record, trajectory,
};
use crate::questions::simulate::vehicle_uncertainty::{VehicleUncertainty, vehicle_uncertainty};
use crate::{
    Answer, InputKind, Library, ModelChoice, MomentumReport, MotionSource, Observer, Provenance,
    Question, SimulateReport, StudyError, VehicleChoice,
};
use impactlab_core::collision::Scenario;
use impactlab_core::compare::{PairCase, PairRecords};
use impactlab_core::data::write::ModelDigest;
use impactlab_core::data::{Channel, ContactOutside, DatasetKind, Outcome};
use impactlab_core::ranges::{
    ROAD_FRICTION, ROAD_FRICTION_SIGMA, SIMULATED_DURATION, VEHICLE_DRAWS,
};
use impactlab_core::site::Site;
use impactlab_core::uncertainty::{Caveat, CaveatKind, CaveatSubject, Caveats};
use impactlab_core::vehicle::{
    Ending, Equations, FrictionZone, Integrator, RoadDraws, RoadSlope, VehicleParameters,
    usual_road_sigma,
};

/// Asks where the struck vehicle goes, by the 4DOF model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SimulateRequest {
    /// What drives the motion.
    pub source: MotionSource,
    /// The struck vehicle.
    #[serde(default)]
    pub vehicle: VehicleChoice,
    /// The striking vehicle, where it is simulated.
    #[serde(default)]
    #[serde(rename = "bullet")]
    pub striking: VehicleChoice,
    /// Which equations of motion; those of the vehicle file if not given.
    #[serde(default)]
    pub equations: Option<Equations>,
    /// How they are integrated.
    #[serde(default)]
    pub integrator: Integrator,
    /// Peak friction of the road instead of the vehicle's.
    #[serde(default)]
    pub friction: Option<f64>,
    /// Standard deviation of the friction of the road, which is drawn with the vehicles. If not given,
    /// [`usual_road_sigma`] of the friction; that of a recorded motion of a data set is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction_sigma: Option<f64>,
    /// The ground: a site file, whose zones have their own friction.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub site: Option<PathBuf>,
    /// Duration, s; a recorded motion has its own.
    #[serde(default = "default_duration_s")]
    pub duration_s: f64,
    /// What happens to the wheels of the struck vehicle after the first contact. If not given, it is
    /// as the scenario says, and else the vehicle coasts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ending: Option<Ending>,
    /// Whether the simulation ends where the vehicle has come to rest, at the latest after the
    /// duration.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub until_rest: bool,
    /// Whether the vehicles of a scenario move after their first contact as if each were alone. Otherwise
    /// both are followed through all contacts.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub one_contact: bool,
    /// How many vehicles are drawn from what the data sheet of the struck vehicle and the road leave open;
    /// if not given, as many as the answer needs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub vehicle_draws: Option<usize>,
    /// Seed of these draws.
    #[serde(default)]
    pub seed: u64,
    /// Whether the impulse of a scenario stands alone, without the force network beside it.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub alone: bool,
}

/// Vehicles that a simulation draws where nobody says how many.
const DEFAULT_VEHICLE_DRAWS: usize = 100;

/// Duration of a simulation where nobody says it, s: that of the trajectory data sets.
pub const DEFAULT_DURATION_S: f64 = 4.0;

fn default_duration_s() -> f64 {
    DEFAULT_DURATION_S
}

/// A simulated motion.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulateAnswer {
    /// What is told, with what restricts it and where it comes from.
    pub report: Answer<SimulateReport>,
    /// Motion, force and record.
    pub analysis: Analysis,
}

impl SimulateRequest {
    /// A simulation of `source` in which nothing else is said.
    pub fn new(source: MotionSource) -> Self {
        Self {
            source,
            vehicle: VehicleChoice::default(),
            striking: VehicleChoice::default(),
            equations: None,
            integrator: Integrator::default(),
            friction: None,
            friction_sigma: None,
            site: None,
            duration_s: DEFAULT_DURATION_S,
            vehicle_draws: None,
            seed: 0,
            alone: false,
            ending: None,
            until_rest: false,
            one_contact: false,
        }
    }

    /// A vehicle on the road and with the equations of the question, which are those of both vehicles.
    fn as_asked(&self, mut vehicle: VehicleParameters) -> VehicleParameters {
        if let Some(equations) = self.equations {
            vehicle = vehicle.with_equations(equations);
        }
        if let Some(friction) = self.friction {
            vehicle = vehicle.with_friction(friction);
        }
        vehicle
    }

    fn settings(
        &self,
        open: &OpenVehicle<'_>,
        named_striking: Option<&str>,
        caveats: &mut Caveats,
    ) -> Result<Settings, StudyError> {
        let struck = self.as_asked(struck_vehicle(&self.vehicle, open, caveats)?);
        let (friction_zones, slope) = self.ground()?;
        let has_striking = match &self.source {
            MotionSource::Scenario { scenario, .. } => scenario.load()?.striking.fixed.is_none(),
            MotionSource::Case { dataset, .. } => {
                DatasetKind::from_folder(dataset) == Some(DatasetKind::Force)
            }
            MotionSource::Trajectory { .. } | MotionSource::Drive(_) => false,
        };
        let mut unused = Caveats::default();
        let assumed = if has_striking { caveats } else { &mut unused };
        let striking = self.as_asked(striking_vehicle(&self.striking, named_striking, assumed)?);
        assumed.extend(assumed::medians(CaveatSubject::StrikingParameter, &striking));
        Ok(Settings {
            struck: struck.on_slope(slope),
            striking: striking.on_slope(slope),
            ending: self.ending.clone().unwrap_or_default(),
            integrator: self.integrator,
            duration_s: self.duration_s,
            ends_at_rest: self.until_rest,
            one_contact: self.one_contact,
            friction_zones,
        })
    }

    /// The settings of a scenario, with what its pulse assumes.
    fn scenario_settings(
        &self,
        scenario: &Scenario,
        pulse: &PulseSetup,
        caveats: &mut Caveats,
    ) -> Result<Settings, StudyError> {
        let open = OpenVehicle::OfScenario(scenario.struck_vehicle.as_deref());
        let striking = scenario.striking_vehicle.as_deref();
        caveats.extend(pulse_assumptions(pulse, pulse.height_m(scenario)));
        let mut settings = self.settings(&open, striking, caveats)?;
        caveats.extend(vehicle_of_fixed(scenario, &self.striking));
        let choices = [&self.vehicle, &self.striking];
        caveats.extend(other_vehicles(scenario, choices, [&settings.struck, &settings.striking]));
        if let (None, Some(ending)) = (&self.ending, &scenario.ending) {
            settings.ending.clone_from(ending);
        }
        if let Some(slope) = scenario.road {
            let of_site = settings.struck.slope;
            if !of_site.is_level() && of_site != slope {
                return Err(StudyError::TwoSlopes { name: self.source.name() });
            }
            for vehicle in [&mut settings.struck, &mut settings.striking] {
                vehicle.slope = slope;
            }
        }
        Ok(settings)
    }

    /// A recorded pair, which has its own vehicles, with its settings and what it does not use.
    fn recorded_pair(
        &self,
        dataset: &Path,
        name: &str,
        caveats: &mut Caveats,
    ) -> Result<(Settings, PairCase), StudyError> {
        let case = load_pair(dataset, name)?;
        if self.states_friction() {
            return Err(StudyError::FrictionOfCase { case: case.name });
        }
        caveats.extend(by_recorded_pair(self));
        let (friction_zones, slope) = self.ground()?;
        let vehicle = |i: usize| self.as_asked(case.vehicles[i].clone()).on_slope(slope);
        let settings = Settings {
            struck: vehicle(0),
            striking: vehicle(1),
            ending: Ending::default(),
            integrator: self.integrator,
            duration_s: self.duration_s,
            ends_at_rest: false,
            one_contact: false,
            friction_zones,
        };
        Ok((settings, case))
    }

    /// Whether it says what a record knows itself.
    fn states_friction(&self) -> bool {
        self.friction.or(self.friction_sigma).is_some()
    }

    /// How the friction of the road is drawn; `None` where it is known.
    ///
    /// - `vehicle`: the struck vehicle, with the friction of the question if that says one.
    pub(crate) fn road(&self, vehicle: &VehicleParameters, seed: u64) -> Option<RoadDraws> {
        let is_of_record = match &self.source {
            MotionSource::Case { dataset, .. } => {
                PairRecords::is_at(dataset)
                    || DatasetKind::from_folder(dataset) == Some(DatasetKind::Trajectory)
            }
            MotionSource::Scenario { .. }
            | MotionSource::Trajectory { .. }
            | MotionSource::Drive(_) => false,
        };
        let sigma = self.friction_sigma.unwrap_or_else(|| usual_road_sigma(vehicle.tires.friction));
        (!is_of_record && sigma > 0.0).then_some(RoadDraws { sigma, seed })
    }

    /// How the end varies with what is not known of vehicle and road.
    fn uncertainty(
        &self,
        settings: &Settings,
        analysis: &Analysis,
        analyse: &Analyse<'_>,
        caveats: &mut Caveats,
    ) -> Option<VehicleUncertainty> {
        caveats.extend(unused::friction_not_drawn(self).filter(|_| !self.alone));
        caveats.extend(unused::vehicles_not_drawn(self, &settings.struck));
        // A vehicle without estimates moves once, unless the question says how well the road is known.
        let is_open = settings.struck.sheet.is_some() || self.friction_sigma.is_some();
        let n_draws = if is_open { self.vehicle_draws.unwrap_or(DEFAULT_VEHICLE_DRAWS) } else { 0 };
        let draws = (n_draws, self.seed, self.road(&settings.struck, self.seed));
        let uncertainty = vehicle_uncertainty(draws, settings, analysis, analyse)?;
        caveats.extend(assumed::road(self, &settings.struck));
        caveats.extend(assumed::zones(&settings.friction_zones));
        Some(uncertainty)
    }

    /// The zones and the slope of the site; none and level without one.
    fn ground(&self) -> Result<(Vec<FrictionZone>, RoadSlope), StudyError> {
        let load = |path| InputKind::Site.explain(path, Site::load(path));
        let site = self.site.as_deref().map(load).transpose()?;
        let ground = |site: Site| (site.friction_zones, site.slope.unwrap_or_default());
        Ok(site.map_or_else(Default::default, ground))
    }

    fn contact_outside(&self, outside: ContactOutside) -> StudyError {
        let name = match self.source.force_file() {
            Some(path) => path.display().to_string(),
            None => self.source.name(),
        };
        StudyError::ContactOutside { name, outside }
    }
}

/// Makes the analysis with given vehicles and settings.
type Analyse<'a> = dyn Fn(&Settings) -> Result<Analysis, AnalysisError> + Sync + 'a;

impl SimulateRequest {
    /// The force network beside the impulse of a scenario; nothing where that has none, which the
    /// analysis says.
    fn beside(
        &self,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<Beside>, StudyError> {
        let nothing = Ok(Outcome::Complete(Beside::default()));
        let MotionSource::Scenario { scenario: choice, .. } = &self.source else { return nothing };
        let scenario = choice.load()?;
        match scenario.solve() {
            Ok(solution) if !self.alone => {
                let network = (ModelChoice::default(), self.seed);
                Beside::ask((choice, &scenario), &solution, network, library, observer)
            }
            _ => nothing,
        }
    }

    /// The seed, where anything was drawn, and the network that was asked.
    fn provenance(&self, report: &SimulateReport, model: Option<ModelDigest>) -> Provenance {
        let has_draws = report.uncertainty.is_some() || model.is_some();
        let seed = has_draws.then_some(self.seed);
        Provenance { seed, ..Provenance::default() }.with_models(model)
    }

    /// What nobody has said of the drivers. That of the simulation beside a forecast is said with the forecast.
    fn open_drivers(&self) -> Result<Vec<Caveat>, StudyError> {
        if self.alone { Ok(Vec::new()) } else { open_drivers(self) }
    }

    /// What restricts the answer.
    ///
    /// - `overlap`: that the outlines of the scenario overlap, if they do.
    fn restrictions(
        &self,
        report: &SimulateReport,
        analysis: &Analysis,
        overlap: Option<Caveat>,
    ) -> impl Iterator<Item = Caveat> {
        let recorded = analysis.force.as_ref().filter(|_| self.source.is_recorded());
        let cut = recorded.and_then(restrictions::cut_record_caveat);
        let simulated = restrictions::simulation_caveats(report, self.until_rest);
        let is_fixed =
            analysis.striking.as_ref().is_some_and(|it| it.start.vehicle.fixed.is_some());
        let at_medians =
            analysis.pair.as_ref().filter(|_| !self.alone).map(|_| contact_at_medians(is_fixed));
        let slope = restrictions::slope_caveat(&analysis.vehicle.slope);
        simulated.into_iter().chain(overlap).chain(cut).chain(slope).chain(at_medians)
    }
}

impl Question for SimulateRequest {
    type Answer = SimulateAnswer;
    type Report = Answer<SimulateReport>;
    const NAME: &'static str = "simulate";

    fn check(&self) -> Result<(), StudyError> {
        check_given("friction", &ROAD_FRICTION, self.friction)?;
        check_given("friction_sigma", &ROAD_FRICTION_SIGMA, self.friction_sigma)?;
        check("duration_s", &SIMULATED_DURATION, self.duration_s)?;
        if let Some(n_draws) = self.vehicle_draws {
            check_count("vehicle_draws", &VEHICLE_DRAWS, n_draws)?;
        }
        let of_ending = self.ending.iter().flat_map(Ending::ranges);
        check_all(of_ending.map(|(key, value, range)| (format!("ending.{key}"), value, range)))?;
        self.source.check()
    }

    /// Without the force network, which takes longer than all else.
    fn coarse(&self) -> Option<Self> {
        let has_rival = !self.alone && matches!(self.source, MotionSource::Scenario { .. });
        has_rival.then(|| Self { alone: true, ..self.clone() })
    }

    const IS_COARSE_PART: bool = true;

    fn report(answer: &Self::Answer) -> &Self::Report {
        &answer.report
    }

    fn solve(
        &self,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<SimulateAnswer>, StudyError> {
        let (mut caveats, mut momentum, mut overlap) = (Caveats::default(), None, None);
        let (settings, analyse): (Settings, Box<Analyse<'_>>) = match &self.source {
            MotionSource::Case { dataset, case } if PairRecords::is_at(dataset) => {
                let (settings, case) = self.recorded_pair(dataset, case, &mut caveats)?;
                (settings, Box::new(move |settings| analyse_recorded_pair(&case, settings)))
            }
            MotionSource::Case { dataset, case } => {
                let Outcome::Complete(dataset) = library.dataset(dataset, observer)? else {
                    return Ok(Outcome::Cancelled);
                };
                let case = take_case(&dataset, case)?;
                if case.kind == DatasetKind::Trajectory && self.states_friction() {
                    return Err(StudyError::FrictionOfCase { case: case.name.clone() });
                }
                caveats.extend(restrictions::doubtful_case_caveats(case));
                caveats.extend(by_simulation(self, case.kind == DatasetKind::Trajectory));
                if case.kind == DatasetKind::Force {
                    caveats.extend(contact_height_assumption(case)?);
                }
                let own = OpenVehicle::OfDataset(dataset.vehicle_file.as_deref());
                let (settings, case) = (self.settings(&own, None, &mut caveats)?, case.clone());
                (settings, Box::new(move |settings| analyse_case(&case, settings)))
            }
            MotionSource::Trajectory { file, contact } => {
                let settings = self.settings(&OpenVehicle::Unknown, None, &mut caveats)?;
                let loaded = trajectory(library, file)?;
                caveats.extend(restrictions::doubtful_data_caveats(&file.title(), &loaded));
                caveats.extend(by_simulation(self, true));
                let force = recorded_force(&loaded, file)?;
                if force.is_some() {
                    caveats.extend(start_of_record(&loaded));
                }
                let load = force.map(|force| {
                    let yaw_rad = loaded.series.get(Channel::Yaw).and_then(|yaw| yaw.first());
                    let yaw_rad = yaw_rad.copied().unwrap_or(0.0);
                    acting_force(force, *contact, &settings.struck, yaw_rad, &mut caveats)
                });
                let title = file.title();
                let analyse = move |settings: &Settings| {
                    analyse_recording(&title, &loaded, load.clone(), settings)
                };
                (settings, Box::new(analyse))
            }
            MotionSource::Drive(drive) => {
                let settings = self.settings(&drive.open_vehicle(), None, &mut caveats)?;
                caveats.extend(by_simulation(self, false));
                let setup = drive.setup(&settings, library, &mut caveats)?;
                let name = drive.name();
                (settings, Box::new(move |of| analyse_drive(&name, setup.clone(), of)))
            }
            MotionSource::Scenario { scenario, pulse } => {
                let scenario = scenario.load()?;
                let settings = self.scenario_settings(&scenario, pulse, &mut caveats)?;
                (momentum, overlap) = contact_of(&scenario, &mut caveats);
                caveats.extend(integrator_of_pair(self.integrator).filter(|_| !self.one_contact));
                let median = settings.struck.clone();
                let analyse = move |of: &Settings| analyse_drawn(&scenario, &median, pulse, of);
                (settings, Box::new(analyse))
            }
        };
        let failed = |source| match source {
            AnalysisError::ContactOutside(outside) => self.contact_outside(outside),
            source => StudyError::Analysis { name: self.source.name(), source: Box::new(source) },
        };
        let analysis = analyse(&settings).map_err(failed)?;
        refuse_contact_off_vehicle(&analysis)?;
        let notes = analysis.notes.iter().map(|text| Caveat::new(CaveatKind::Note, text));
        caveats.extend(assumed::estimates(&analysis.vehicle).into_iter().chain(notes));
        let mut report = SimulateReport::new(self, &analysis)
            .map_err(|source| failed(AnalysisError::Series(source)))?;
        let Outcome::Complete(beside) = self.beside(library, observer)? else {
            return Ok(Outcome::Cancelled);
        };
        (report.momentum, report.rival) = (momentum, beside.rival);
        report.uncertainty = self.uncertainty(&settings, &analysis, &analyse, &mut caveats);
        let provenance = self.provenance(&report, beside.model);
        caveats.extend(self.open_drivers()?);
        caveats.extend(self.restrictions(&report, &analysis, overlap).chain(beside.caveats));
        let report = Answer { report, caveats, provenance };
        Ok(Outcome::Complete(SimulateAnswer { report, analysis }))
    }
}

/// The momentum solution of a scenario, and whether its outlines overlap. Where there is no geometry
/// or solution, the analysis says why.
fn contact_of(
    scenario: &Scenario,
    caveats: &mut Caveats,
) -> (Option<MomentumReport>, Option<Caveat>) {
    let geometry = scenario.geometry().ok();
    caveats.extend(bodies::doubtful(scenario));
    caveats.extend(geometry.as_ref().and_then(assumed::first_touch));
    let overlap = geometry.as_ref().and_then(restrictions::overlap_caveat);
    let Ok(impact) = scenario.impact() else { return (None, overlap) };
    caveats.extend(assumed::contact_default(scenario, &impact));
    (MomentumReport::from_impact(&impact, 0.0), overlap)
}

/// The analysis of a scenario with a vehicle that was drawn, and what the scenario has of it.
///
/// - `median`: the vehicle with everything at its median.
fn analyse_drawn(
    scenario: &Scenario,
    median: &VehicleParameters,
    pulse: &PulseSetup,
    settings: &Settings,
) -> Result<Analysis, AnalysisError> {
    let mut drawn = scenario.clone();
    drawn.struck.follow(median, &settings.struck);
    analyse_scenario(&drawn, pulse, settings)
}
