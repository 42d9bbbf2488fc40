//! The motion of one struck vehicle by the 4DOF model: `simulate`.

use std::path::PathBuf;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::analysis::{
    Analysis, AnalysisError, DriveSetup, PulseSetup, Settings, analyse_case, analyse_drive,
    analyse_recording, analyse_scenario,
};
use crate::collision::Scenario;
use crate::data::{
    Case, Channel, ContactOutside, DatasetKind, FileKind, ForceAttributes, ForceHistory, Loaded,
    Outcome, Sampling, SeriesError, TIME_TOLERANCE_S, read_force_file, read_steer_file,
};
use crate::ranges::{
    CONTACT_HEIGHT, PULSE_DURATION, ROAD_FRICTION, SIMULATED_DURATION, SPEED, VEHICLE_DRAWS,
    YAW_RATE,
};
use crate::study::checks::{check, check_all, check_contact, check_count, check_given};
use crate::study::inputs::{OpenVehicle, striking_vehicle, struck_vehicle};
use crate::study::simulate_dataset::take_case;
use crate::study::unused::by_simulation;
use crate::study::vehicle_uncertainty::vehicle_uncertainty;
use crate::study::{
    AssumedQuantity, Assumption, Library, MomentumReport, Observer, Provenance, Question,
    ScenarioChoice, SeriesFile, SimulateReport, StudyError, VehicleChoice, badges, word,
};
use crate::uncertainty::Badge;
use crate::vehicle::{
    ContactPoint, Ending, Equations, Integrator, SteerHistory, VehicleParameters, VehicleState,
};

/// Speed of the struck vehicle before the impact where nothing says it, m/s: 72 km/h.
pub const ASSUMED_SPEED_M_S: f64 = 20.0;

/// Where a force acts where nothing says it: the right rear quarter of a car, where a PIT begins.
pub const ASSUMED_CONTACT: ContactPoint = ContactPoint { x_m: -1.5, y_m: -0.9, height_m: 0.52 };

/// Asks where the struck vehicle goes, by the 4DOF model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SimulateRequest {
    /// What drives the motion.
    pub source: MotionSource,
    /// The struck vehicle.
    #[serde(default)]
    pub vehicle: VehicleChoice,
    /// The striking vehicle, where it is simulated.
    #[serde(default)]
    pub bullet: VehicleChoice,
    /// Which equations of motion; those of the vehicle file if not given.
    #[serde(default)]
    pub equations: Option<Equations>,
    /// How they are integrated.
    #[serde(default)]
    pub integrator: Integrator,
    /// Peak friction of the road instead of the vehicle's.
    #[serde(default)]
    pub friction: Option<f64>,
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
    /// How many vehicles are drawn from what the data sheet of the struck vehicle leaves open.
    #[serde(default = "default_vehicle_draws")]
    pub vehicle_draws: usize,
    /// Seed of these draws.
    #[serde(default)]
    pub seed: u64,
}

/// Vehicles that are drawn where nobody says how many.
pub const DEFAULT_VEHICLE_DRAWS: usize = 100;

fn default_vehicle_draws() -> usize {
    DEFAULT_VEHICLE_DRAWS
}

/// Duration of a simulation where nobody says it, s: that of the trajectory data sets.
pub const DEFAULT_DURATION_S: f64 = 4.0;

fn default_duration_s() -> f64 {
    DEFAULT_DURATION_S
}

/// What drives a motion.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MotionSource {
    /// A case of a data set, with its recorded start and force.
    Case {
        /// The data set.
        dataset: PathBuf,
        /// Name of the case.
        case: String,
    },
    /// A recorded motion, simulated from its first sample if it records its force.
    Trajectory {
        /// The file.
        file: SeriesFile,
        /// Where the force acts; without it, the file's own yaw moment.
        #[serde(default)]
        contact: Option<ContactPoint>,
    },
    /// A start, a force and a steer angle.
    Drive(Drive),
    /// Two vehicles that meet; the impulse is spread over a classic pulse.
    Scenario {
        /// The scenario.
        scenario: ScenarioChoice,
        /// How the impulse is spread over time.
        #[serde(default)]
        pulse: PulseSetup,
    },
}

/// How a vehicle starts and what pushes and steers it.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Drive {
    /// Forward speed at the start, m/s.
    pub speed_m_s: Option<f64>,
    /// Leftward speed at the start, m/s.
    pub vy_m_s: f64,
    /// Yaw rate at the start, rad/s.
    pub yaw_rate_rad_s: f64,
    /// The force on the vehicle.
    pub force: Option<SeriesFile>,
    /// What a force sample stands for; without it, as the columns suggest.
    pub sampling: Option<Sampling>,
    /// Where the force acts; without it, the file's own yaw moment.
    pub contact: Option<ContactPoint>,
    /// The road-wheel angle.
    pub steer: Option<SeriesFile>,
}

/// A simulated motion.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulateAnswer {
    /// What is told.
    pub report: SimulateReport,
    /// Motion, force and record.
    pub analysis: Analysis,
}

impl SimulateRequest {
    /// A simulation of `source` in which nothing else is said.
    pub fn new(source: MotionSource) -> Self {
        Self {
            source,
            vehicle: VehicleChoice::default(),
            bullet: VehicleChoice::default(),
            equations: None,
            integrator: Integrator::default(),
            friction: None,
            duration_s: DEFAULT_DURATION_S,
            vehicle_draws: DEFAULT_VEHICLE_DRAWS,
            seed: 0,
            ending: None,
            until_rest: false,
        }
    }

    fn settings(
        &self,
        (open, named_bullet): (&OpenVehicle<'_>, Option<&str>),
        assumptions: &mut Vec<Assumption>,
    ) -> Result<Settings, StudyError> {
        let mut target = struck_vehicle(&self.vehicle, open, assumptions)?;
        if let Some(equations) = self.equations {
            target = target.with_equations(equations);
        }
        if let Some(friction) = self.friction {
            target = target.with_friction(friction);
        }
        let has_bullet = match &self.source {
            MotionSource::Scenario { .. } => true,
            MotionSource::Case { dataset, .. } => {
                DatasetKind::of_folder(dataset) == Some(DatasetKind::Force)
            }
            MotionSource::Trajectory { .. } | MotionSource::Drive(_) => false,
        };
        let mut unused = Vec::new();
        let assumed = if has_bullet { assumptions } else { &mut unused };
        let bullet = striking_vehicle(&self.bullet, named_bullet, assumed)?;
        assumed.extend(Assumption::medians(AssumedQuantity::BulletParameter, &bullet));
        Ok(Settings {
            target,
            bullet,
            ending: self.ending.clone().unwrap_or_default(),
            integrator: self.integrator,
            duration_s: self.duration_s,
            ends_at_rest: self.until_rest,
        })
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

impl Question for SimulateRequest {
    type Answer = SimulateAnswer;
    type Report = SimulateReport;
    const NAME: &'static str = "simulate";

    fn check(&self) -> Result<(), StudyError> {
        check_given("friction", &ROAD_FRICTION, self.friction)?;
        check("duration_s", &SIMULATED_DURATION, self.duration_s)?;
        check_count("vehicle_draws", &VEHICLE_DRAWS, self.vehicle_draws)?;
        let of_ending = self.ending.iter().flat_map(Ending::ranges);
        check_all(of_ending.map(|(key, value, range)| (format!("ending.{key}"), value, range)))?;
        self.source.check()
    }

    fn report(answer: &Self::Answer) -> &SimulateReport {
        &answer.report
    }

    fn solve(
        &self,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<SimulateAnswer>, StudyError> {
        let (mut assumptions, mut momentum, mut overlap) = (Vec::new(), None, None);
        let (settings, analyse): (Settings, Box<Analyse<'_>>) = match &self.source {
            MotionSource::Case { dataset, case } => {
                let Outcome::Complete(dataset) = library.dataset(dataset, observer)? else {
                    return Ok(Outcome::Cancelled);
                };
                let case = take_case(&dataset, case)?;
                if let (DatasetKind::Trajectory, Some(_)) = (case.kind, self.friction) {
                    return Err(StudyError::FrictionOfCase { case: case.name.clone() });
                }
                assumptions.extend(by_simulation(self, case.kind == DatasetKind::Trajectory));
                if case.kind == DatasetKind::Force {
                    assumptions.extend(contact_height_assumption(case)?);
                }
                let own = OpenVehicle::OfDataset(dataset.vehicle_file.as_deref());
                let (settings, case) =
                    (self.settings((&own, None), &mut assumptions)?, case.clone());
                (settings, Box::new(move |settings| analyse_case(&case, settings)))
            }
            MotionSource::Trajectory { file, contact } => {
                let settings = self.settings((&OpenVehicle::Unknown, None), &mut assumptions)?;
                let loaded = trajectory(library, file)?;
                assumptions.extend(by_simulation(self, true));
                let force = recorded_force(&loaded, file)?;
                if force.is_some() {
                    assumptions.extend(start_of_record(&loaded));
                }
                let load = force.map(|force| {
                    let vehicle = &settings.target;
                    acting_force(force, (*contact, vehicle), &mut assumptions)
                });
                let title = file.title();
                let analyse = move |settings: &Settings| {
                    analyse_recording(&title, &loaded, load.clone(), settings)
                };
                (settings, Box::new(analyse))
            }
            MotionSource::Drive(drive) => {
                let settings = self.settings((&OpenVehicle::Unknown, None), &mut assumptions)?;
                assumptions.extend(by_simulation(self, false));
                let setup = drive.setup(&settings, library, &mut assumptions)?;
                let name = drive.name();
                let analyse =
                    move |settings: &Settings| analyse_drive(&name, setup.clone(), settings);
                (settings, Box::new(analyse))
            }
            MotionSource::Scenario { scenario, pulse } => {
                assumptions.extend(pulse_assumptions(pulse));
                let scenario = scenario.load()?;
                let open = OpenVehicle::OfScenario(scenario.target_vehicle.as_deref());
                let vehicles = (&open, scenario.bullet_vehicle.as_deref());
                let mut settings = self.settings(vehicles, &mut assumptions)?;
                if let (None, Some(ending)) = (&self.ending, &scenario.ending) {
                    settings.ending.clone_from(ending);
                }
                (momentum, overlap) = contact_of(&scenario, &mut assumptions);
                (settings, Box::new(move |settings| analyse_scenario(&scenario, pulse, settings)))
            }
        };
        let failed = |source| match source {
            AnalysisError::ContactOutside(outside) => self.contact_outside(outside),
            source => StudyError::Analysis { name: self.source.name(), source: Box::new(source) },
        };
        let analysis = analyse(&settings).map_err(failed)?;
        refuse_contact_off_vehicle(&analysis)?;
        assumptions.extend(Assumption::estimates(&analysis.vehicle));
        let mut report = SimulateReport::of(self, &analysis, assumptions)
            .map_err(|source| failed(AnalysisError::Series(source)))?;
        report.momentum = momentum;
        let asked = (self.vehicle_draws, self.seed);
        report.uncertainty = vehicle_uncertainty(asked, (&settings, &analysis), &analyse);
        if report.uncertainty.is_some() {
            report.provenance = Provenance::of_seed(self.seed);
        }
        report.badges = badges::of_simulation(&report, self.until_rest);
        report.badges.extend(overlap);
        Ok(Outcome::Complete(SimulateAnswer { report, analysis }))
    }
}

impl MotionSource {
    /// The source of a file that was opened, by what the file is about.
    ///
    /// - `start`: speed and contact point that the user gave; the file is filled in here.
    pub fn of_file(file: SeriesFile, kind: FileKind, start: Drive) -> Self {
        match kind {
            FileKind::Trajectory => Self::Trajectory { file, contact: start.contact },
            FileKind::Force => Self::Drive(Drive { force: Some(file), ..start }),
            FileKind::Steer => Self::Drive(Drive { steer: Some(file), ..start }),
        }
    }

    /// Checks every number of the source.
    pub(super) fn check(&self) -> Result<(), StudyError> {
        match self {
            Self::Case { .. } => Ok(()),
            Self::Trajectory { contact, .. } => check_contact(contact.as_ref()),
            Self::Drive(drive) => {
                check_given("speed_m_s", &SPEED, drive.speed_m_s)?;
                check("vy_m_s", &SPEED, drive.vy_m_s)?;
                check("yaw_rate_rad_s", &YAW_RATE, drive.yaw_rate_rad_s)?;
                check_contact(drive.contact.as_ref())
            }
            Self::Scenario { scenario, pulse } => {
                check("pulse.duration_s", &PULSE_DURATION, pulse.duration_s)?;
                check("pulse.contact_height_m", &CONTACT_HEIGHT, pulse.contact_height_m)?;
                scenario.check()
            }
        }
    }

    /// What a title calls it.
    pub fn name(&self) -> String {
        match self {
            Self::Case { case, .. } => case.clone(),
            Self::Trajectory { file, .. } => file.path.display().to_string(),
            Self::Drive(drive) => drive.name(),
            Self::Scenario { scenario, .. } => scenario.name(),
        }
    }

    /// The file of the force, where the force is one.
    pub(super) fn force_file(&self) -> Option<&PathBuf> {
        match self {
            Self::Drive(drive) => drive.force.as_ref().map(|file| &file.path),
            Self::Trajectory { file, .. } => Some(&file.path),
            Self::Case { .. } | Self::Scenario { .. } => None,
        }
    }
}

impl Drive {
    fn name(&self) -> String {
        let file = self.force.as_ref().or(self.steer.as_ref());
        file.map_or_else(|| "manoeuvre".to_owned(), SeriesFile::title)
    }

    fn setup(
        &self,
        settings: &Settings,
        library: &Library,
        assumptions: &mut Vec<Assumption>,
    ) -> Result<DriveSetup, StudyError> {
        let speed_m_s = self.speed_m_s.unwrap_or_else(|| {
            let reason = "the speed before the impact is not known; another one: --speed";
            let value = format!("{ASSUMED_SPEED_M_S} m/s");
            assumptions.push(Assumption::new(AssumedQuantity::Speed, value, reason));
            ASSUMED_SPEED_M_S
        });
        let mut notes = Vec::new();
        let load = match &self.force {
            Some(file) => {
                let loaded = library.series(file)?;
                notes.extend(loaded.notes.iter().map(ToString::to_string));
                let force = force_of(&loaded, self.sampling, file)?;
                Some(acting_force(force, (self.contact, &settings.target), assumptions))
            }
            None => None,
        };
        let steer = self.steer.as_ref().map(steer_history).transpose()?;
        let held = steer.as_ref().and_then(|steer| held_steer(steer, settings.duration_s));
        assumptions.extend(held);
        let initial = VehicleState {
            vy_m_s: self.vy_m_s,
            yaw_rate_rad_s: self.yaw_rate_rad_s,
            ..VehicleState::driving_straight(speed_m_s)
        };
        Ok(DriveSetup { initial, load, steer, notes })
    }
}

/// The momentum solution of a scenario, and whether its outlines overlap. Where there is no geometry
/// or solution, the analysis says why.
fn contact_of(
    scenario: &Scenario,
    assumptions: &mut Vec<Assumption>,
) -> (Option<MomentumReport>, Option<Badge>) {
    let geometry = scenario.geometry().ok();
    assumptions.extend(geometry.as_ref().and_then(Assumption::first_touch));
    let overlap = geometry.as_ref().and_then(badges::of_overlap);
    let Ok(impact) = scenario.impact() else { return (None, overlap) };
    assumptions.extend(Assumption::contact_default(scenario, &impact));
    (MomentumReport::of(&impact, 0.0), overlap)
}

/// Refuses a force that acts at a point far off the struck vehicle.
fn refuse_contact_off_vehicle(analysis: &Analysis) -> Result<(), StudyError> {
    let Some(struck) = &analysis.struck else { return Ok(()) };
    let ContactPoint { x_m, y_m, .. } = struck.contact;
    analysis.footprint.check_contact([x_m, y_m]).map_err(|source| StudyError::ContactOffVehicle {
        name: analysis.name.clone(),
        vehicle: struck.vehicle.name.clone(),
        source,
    })
}

/// A recorded motion; another kind of file is refused, since its speed is not known.
fn trajectory(library: &Library, file: &SeriesFile) -> Result<Arc<Loaded>, StudyError> {
    let loaded = library.series(file)?;
    if loaded.kind == FileKind::Trajectory {
        return Ok(loaded);
    }
    Err(StudyError::WrongKind {
        path: file.path.clone(),
        got: format!("a {} file", word(&loaded.kind)),
        expected: "a trajectory; `impactlab simulate --out FILE.csv` makes one",
    })
}

/// The force of a recorded motion; `None` if it records none. One component alone is no force.
fn recorded_force(loaded: &Loaded, file: &SeriesFile) -> Result<Option<ForceHistory>, StudyError> {
    let components = [Channel::Fx, Channel::Fy, Channel::FxBody, Channel::FyBody];
    if components.iter().all(|component| loaded.series.get(*component).is_none()) {
        return Ok(None);
    }
    match ForceHistory::from_series(&loaded.series, loaded.force_sampling()) {
        Ok(force) => Ok(Some(force)),
        Err(source) => Err(StudyError::Series { path: file.path.clone(), source }),
    }
}

/// The force of a file, under its own meaning of a sample or a given one.
fn force_of(
    loaded: &Loaded,
    sampling: Option<Sampling>,
    file: &SeriesFile,
) -> Result<ForceHistory, StudyError> {
    let sampling = sampling.unwrap_or_else(|| loaded.force_sampling());
    match ForceHistory::from_series(&loaded.series, sampling) {
        Ok(force) => Ok(force),
        Err(source) => {
            // Read as a force file it gives the error that says where and what to do.
            read_force_file(&file.path, file.map.as_ref())?;
            Err(StudyError::Series { path: file.path.clone(), source })
        }
    }
}

/// A force with the point where it acts.
///
/// A given contact point overrules a recorded yaw moment; a recorded yaw moment acts about the CG;
/// without either, the contact point is assumed.
pub(super) fn acting_force(
    mut force: ForceHistory,
    (contact, vehicle): (Option<ContactPoint>, &VehicleParameters),
    assumptions: &mut Vec<Assumption>,
) -> (ForceHistory, ContactPoint) {
    if let Some(contact) = contact {
        force.mz_n_m = None;
        return (force, contact);
    }
    if force.mz_n_m.is_some() {
        let height_m = vehicle.geometry.cg_height_m;
        return (force, ContactPoint { x_m: 0.0, y_m: 0.0, height_m });
    }
    let reason = "the force has no yaw moment (mz) and nothing says where it acts; another point: \
                  --contact";
    assumptions.push(Assumption::contact_point(ASSUMED_CONTACT, reason));
    (force, ASSUMED_CONTACT)
}

/// What stands for the steer angle where its recording does not reach.
fn held_steer(steer: &SteerHistory, duration_s: f64) -> Option<Assumption> {
    let (&start_s, &end_s) = (steer.time_s.first()?, steer.time_s.last()?);
    let (&first_rad, &last_rad) = (steer.steer_rad.first()?, steer.steer_rad.last()?);
    let mut held = Vec::new();
    if start_s > TIME_TOLERANCE_S && first_rad != 0.0 {
        held.push(format!("{first_rad} rad before {start_s} s"));
    }
    if end_s < duration_s - TIME_TOLERANCE_S && last_rad != 0.0 {
        held.push(format!("{last_rad} rad after {end_s} s"));
    }
    let reason = "the recording of the steer angle does not reach further; its ends are held";
    let is_held = !held.is_empty();
    is_held.then(|| Assumption::new(AssumedQuantity::Steer, held.join(", "), reason))
}

/// What stands for the rates and the roll with which a recorded motion starts, if it does not say
/// them.
fn start_of_record(loaded: &Loaded) -> Option<Assumption> {
    let is_missing = |channel: &Channel| loaded.series.get(*channel).is_none();
    let missing = [Channel::YawRate, Channel::Roll, Channel::RollRate].into_iter();
    let zeros: Vec<String> =
        missing.filter(is_missing).map(|channel| format!("{} = 0", channel.header())).collect();
    let is_assumed = !zeros.is_empty();
    is_assumed.then(|| {
        let reason = "the file does not record them";
        Assumption::new(AssumedQuantity::StartOfRecord, zeros.join(", "), reason)
    })
}

/// What stands for the contact height of a force case that does not state it.
fn contact_height_assumption(case: &Case) -> Result<Option<Assumption>, StudyError> {
    let is_known = ForceAttributes::read(&case.attributes)?.contact_height_m.is_some();
    Ok((!is_known).then(|| {
        let reason = "the case does not say how high the vehicles touch";
        Assumption::new(AssumedQuantity::ContactHeight, "that of the CG", reason)
    }))
}

/// What the pulse of a scenario adds to what the momentum solution says.
fn pulse_assumptions(pulse: &PulseSetup) -> Vec<Assumption> {
    if *pulse != PulseSetup::default() {
        return Vec::new();
    }
    let shape = format!("{} of {:.0} ms", pulse.shape.label(), pulse.duration_s * 1e3);
    let height = format!("{} m above the ground", pulse.contact_height_m);
    vec![
        Assumption::new(
            AssumedQuantity::Pulse,
            shape,
            "the momentum solution gives the impulse, not the force over time",
        ),
        Assumption::new(
            AssumedQuantity::ContactHeight,
            height,
            "a scenario does not say how high the vehicles touch",
        ),
    ]
}

/// The road-wheel angle of a file: that of the front axle, or the mean of its wheels.
fn steer_history(file: &SeriesFile) -> Result<SteerHistory, StudyError> {
    let series = read_steer_file(&file.path, file.map.as_ref())?.series;
    let in_file = |source: SeriesError| StudyError::Series { path: file.path.clone(), source };
    let steer_rad = match series.get(Channel::Steer) {
        Some(steer) => steer.to_vec(),
        None => {
            let left = series.require(Channel::SteerFl).map_err(in_file)?;
            let right = series.require(Channel::SteerFr).map_err(in_file)?;
            let mean = |(left, right): (&f64, &f64)| (left + right) / 2.0;
            left.iter().zip(right).map(mean).collect()
        }
    };
    Ok(SteerHistory { time_s: series.time_s().to_vec(), steer_rad })
}
