//! Why a question has no answer.

use std::path::PathBuf;

use crate::InputKind;
use crate::analysis::{AnalysisError, MotionForecastError};
use impactlab_core::collision::{OffOutline, ScenarioError};
use impactlab_core::compare::ReplayError;
use impactlab_core::data::{ContactOutside, DataError, SeriesError, TomlError};
use impactlab_core::ranges::OutOfRange;
use impactlab_core::site::SiteError;
use impactlab_core::vehicle::{Preset, SimulationError};
use impactlab_networks::force::{EvaluateError, ForceError};
use impactlab_networks::learning::{LearningError, LoadError};
use impactlab_networks::response::LogError;
use impactlab_reconstruct::hand::HandError;
use impactlab_reconstruct::sampler::SamplerError;

/// A question that cannot be answered.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// The ground cannot be read.
    #[error(transparent)]
    Site(#[from] SiteError),
    /// A number of the question is out of range.
    #[error("{field}")]
    OutOfRange {
        /// Where the number stands in the question.
        field: String,
        /// The number and its range.
        source: OutOfRange,
    },
    /// A number of the report is not finite: numbers of the question that each lie in their range
    /// do not go together.
    #[error(
        "{question}: {field} of the answer is {value}, which is no number to rely on; \
         some numbers of the question do not go together"
    )]
    NotFinite {
        /// What was asked.
        question: &'static str,
        /// Where the number stands in the report.
        field: String,
        /// The number.
        value: f64,
    },
    /// A window of time ends before it starts.
    #[error("window: {from_s} s to {to_s} s, expected a start that is not after the end")]
    Window {
        /// Start, s.
        from_s: f64,
        /// End, s.
        to_s: f64,
    },
    /// A contact point lies off the vehicle.
    #[error(
        "{name}: the force does not act on {vehicle}; correct the point or take another vehicle"
    )]
    ContactOffVehicle {
        /// The file, case or scenario.
        name: String,
        /// The vehicle.
        vehicle: String,
        /// How far the point lies off.
        source: OffOutline,
    },
    /// More folds are asked for than there are cases.
    #[error(
        "cross_validate: {n_folds} folds of {n_cases} training cases, expected at most {n_cases}"
    )]
    TooManyFolds {
        /// Number of folds.
        n_folds: usize,
        /// Number of cases that the model was trained on.
        n_cases: usize,
    },
    /// A file holds angles of a steering wheel, and the steering ratio is not said.
    #[error(
        "{}: holds angles of the steering wheel; say the steering ratio (--steering-ratio, 12 to \
         20 in cars)",
        path.display()
    )]
    NoSteeringRatio {
        /// The file.
        path: PathBuf,
    },
    /// A steering ratio is said for angles of the road wheels.
    #[error(
        "{}: holds angles of the road wheels, to which the steering ratio does not apply; angles \
         of the steering wheel have the header steering_wheel, or a map such as \
         time=1:s,steering_wheel=2:deg",
        path.display()
    )]
    NoSteeringWheel {
        /// The file.
        path: PathBuf,
    },
    /// An angle of a steering wheel over the steering ratio is none of a road wheel.
    #[error("{}: an angle of the steering wheel over the ratio {ratio}", path.display())]
    RoadWheel {
        /// The file.
        path: PathBuf,
        /// The steering ratio.
        ratio: f64,
        /// The angle and its range.
        source: OutOfRange,
    },
    /// The car on which a force of a finite-element run acts drives in a direction that is not taken for its
    /// heading.
    #[error(
        "{}: the parts on which the force acts begin with ({vx_m_s:.2}, {vy_m_s:.2}) m/s along the axes of the \
         model, and the vehicle of a force heads along x: give the force along its own axes, such as with \
         --map fx=-2,fy=-3 where it drives against x, and its speed with --speed",
        path.display()
    )]
    ModelHeading {
        /// The file.
        path: PathBuf,
        /// Velocity along x of the model, m/s.
        vx_m_s: f64,
        /// Velocity along y of the model, m/s.
        vy_m_s: f64,
    },
    /// Two things control the vehicle alike.
    #[error("{name}: more than one of file, fishhook and ending {what} the vehicle, expected one")]
    TwoControls {
        /// The file or manoeuvre.
        name: String,
        /// What they do.
        what: &'static str,
    },
    /// The steering angle of a fishhook does not exist for a vehicle.
    #[error(
        "{vehicle}: the fishhook is 6.5 times the road-wheel angle at which the vehicle turns \
         with 0.3 g at 50 mph; by its axle loads and cornering stiffnesses that is {angle_rad:.4} \
         rad, expected more than 0 and at most 0.138"
    )]
    NoFishhook {
        /// The vehicle.
        vehicle: String,
        /// The angle, rad.
        angle_rad: f64,
    },
    /// A file is of another kind than is needed.
    #[error("{}: is {found}, expected {expected}", path.display())]
    OtherKind {
        /// The file.
        path: PathBuf,
        /// What it holds.
        found: InputKind,
        /// What is needed.
        expected: InputKind,
    },
    /// A file or data set cannot be read.
    #[error(transparent)]
    Data(#[from] DataError),
    /// A data set is not what is needed.
    #[error(transparent)]
    Cases(Box<LoadError>),
    /// A data set has a case that cannot be read.
    #[error(
        "{problem} (in {}; leave out cases that cannot be used with --bad-cases leave-out)",
        path.display()
    )]
    BadCase {
        /// The data set.
        path: PathBuf,
        /// What is wrong with the first such case.
        problem: String,
    },
    /// The case that is asked about cannot be read.
    #[error("{problem}")]
    CaseUnreadable {
        /// The data set.
        path: PathBuf,
        /// What is wrong with the case.
        problem: String,
    },
    /// A force network cannot be trained, opened or asked.
    #[error(transparent)]
    Force(Box<ForceError>),
    /// A response network, or a training set of either network, cannot be used.
    #[error(transparent)]
    Learning(Box<LearningError>),
    /// A model is not in memory.
    #[error("there is no model {name:?}")]
    NotHeld {
        /// What it was called.
        name: String,
    },
    /// The log of an impact cannot be used.
    #[error(transparent)]
    Log(Box<LogError>),
    /// Nothing was struck, and yet a force or a first contact is given.
    #[error("without_impact: nothing was struck, expected neither forces nor impact_s")]
    ImpactOfDrive,
    /// There is not a force for every log.
    #[error("{n_forces} force files for {n_logs} logs, expected one for each or none")]
    ForcesOfLogs {
        /// Number of force files.
        n_forces: usize,
        /// Number of logs.
        n_logs: usize,
    },
    /// A folder holds no logs.
    #[error("{}: holds no logs, expected files that end in .csv, and no data set", path.display())]
    NoLogs {
        /// The folder.
        path: PathBuf,
    },
    /// A motion cannot be predicted.
    #[error("{name}: the motion cannot be predicted")]
    Forecast {
        /// The scenario or case.
        name: String,
        /// Why.
        source: Box<MotionForecastError>,
    },
    /// A model has been trained on every case that it should be evaluated on.
    #[error(
        "{}: the model was trained on every case; --split all evaluates them all the same",
        path.display()
    )]
    NoTestCase {
        /// The data set.
        path: PathBuf,
    },
    /// No staged collision is asked about.
    #[error("{}: no case is chosen; expected cases in evidence/ that --cases and --only both name", path.display())]
    NoStagedCase {
        /// The folder.
        path: PathBuf,
    },
    /// What had happened in a staged collision is not known.
    #[error("{}: is not there, and without it the case cannot be evaluated", path.display())]
    NoTruth {
        /// The file.
        path: PathBuf,
    },
    /// An evaluation failed.
    #[error("the evaluation failed")]
    Evaluation(#[source] Box<EvaluateError>),
    /// A vehicle or scenario file cannot be read.
    #[error(transparent)]
    TomlFile(#[from] TomlError),
    /// A vehicle is neither a preset, nor one of the library, nor a file.
    #[error(
        "{name:?} is no vehicle; expected a vehicle file, a vehicle of the library (impactlab \
         vehicles lists them), or one of {}",
        presets.join(", ")
    )]
    UnknownVehicle {
        /// As given.
        name: String,
        /// The presets.
        presets: Vec<&'static str>,
    },
    /// Evidence of a form that has not been filled in.
    #[error("{name}: the evidence is not complete: {missing}")]
    IncompleteEvidence {
        /// The evidence.
        name: String,
        /// What is missing.
        missing: String,
    },
    /// No motion goes with the evidence.
    #[error("{name}: cannot be reconstructed")]
    Reconstruction {
        /// The evidence.
        name: String,
        /// Why.
        source: Box<SamplerError>,
    },
    /// Nothing follows from the inputs of a method by hand.
    #[error(transparent)]
    Hand(#[from] HandError),
    /// A scenario has no solution.
    #[error("{name}: cannot be solved")]
    Scenario {
        /// The scenario.
        name: String,
        /// Why.
        source: ScenarioError,
    },
    /// A file lacks a column.
    #[error("{}: does not have what this needs", path.display())]
    Series {
        /// The file or data set.
        path: PathBuf,
        /// What it lacks.
        source: SeriesError,
    },
    /// A simulation did not come to its end.
    #[error("the simulation failed")]
    Simulation(#[from] SimulationError),
    /// A case cannot be simulated.
    #[error(transparent)]
    Replay(#[from] ReplayError),
    /// A case or file cannot be analysed.
    #[error("{name}: cannot be analysed")]
    Analysis {
        /// The file, case or scenario.
        name: String,
        /// Why.
        source: Box<AnalysisError>,
    },
    /// A data set does not have the case.
    #[error("{}: has no case {case:?}; its {n_cases} cases start with {first:?}", path.display())]
    NoSuchCase {
        /// The data set.
        path: PathBuf,
        /// The name asked for.
        case: String,
        /// How many cases there are.
        n_cases: usize,
        /// A name that would do.
        first: String,
    },
    /// Forces are given where motions are needed, or the other way round.
    #[error("{}: holds {got}, expected {expected}", path.display())]
    WrongKind {
        /// The file or data set.
        path: PathBuf,
        /// What it is.
        got: String,
        /// What is needed.
        expected: &'static str,
    },
    /// A column map is given for a folder.
    #[error("{}: is a folder; --map is for single files", path.display())]
    MapOfFolder {
        /// The folder.
        path: PathBuf,
    },
    /// A force that is to be learned from does not say where it acts.
    #[error(
        "{}: has no yaw moment (mz); say where the force acts with --contact x,y,z",
        path.display()
    )]
    NoYawMoment {
        /// The force file.
        path: PathBuf,
    },
    /// What steers, brakes or drives a vehicle is recorded for another time than the motion.
    #[error(
        "{}: the recording runs from {start_s} s to {end_s} s, the motion from 0 s to {duration_s} s, \
         so that nothing of it would act; give its clock a shift in the map of its columns, such as \
         shift={shift_s}:s", path.display()
    )]
    ControlsOutside {
        /// The file.
        path: PathBuf,
        /// Start of the recording, s.
        start_s: f64,
        /// End of the recording, s.
        end_s: f64,
        /// Duration of the motion, s.
        duration_s: f64,
        /// The shift with which the recording begins with the motion, s.
        shift_s: f64,
    },
    /// The contact lies outside the time of the motion.
    #[error("{name}: {outside}")]
    ContactOutside {
        /// The force file, case or scenario.
        name: String,
        /// When the vehicles touch, and the duration of the motion.
        outside: ContactOutside,
    },
    /// A recorded motion has the friction of its own case.
    #[error(
        "case {case}: its friction is recorded; another friction would compare the motion with \
         another road"
    )]
    FrictionOfCase {
        /// Name of the case.
        case: String,
    },
    /// A forecast is asked of a vehicle that meets an object which does not move.
    #[error(
        "{name}: the struck vehicle meets a {object}, which does not move, and the networks have learned from \
         two cars; ask impact or simulate, which use momentum and the contact law"
    )]
    FixedPartner {
        /// The scenario.
        name: String,
        /// What it meets.
        object: &'static str,
    },
    /// The slope of the road is given twice.
    #[error(
        "{name}: [road] gives another slope than the site; take it out of one of them, or give both the \
         same"
    )]
    TwoSlopes {
        /// The scenario or the evidence.
        name: String,
    },
    /// There is no force, so that nothing can be forecast.
    #[error("{name}: has no force on a vehicle to forecast a motion from")]
    NoForce {
        /// The file or case.
        name: String,
    },
    /// It is not known how the vehicles met, so that the force cannot be predicted.
    #[error(
        "{name}: does not say how the vehicles met, so its force cannot be predicted; its own force \
         drives the motion with --given-force"
    )]
    NoCollision {
        /// The file or case.
        name: String,
    },
    /// A training was begun where another one should be.
    #[error(
        "{}: holds a training; --resume goes on with it, --overwrite begins anew and replaces it",
        path.display()
    )]
    TrainingExists {
        /// The state of the training that is there.
        path: PathBuf,
    },
    /// A reconstruction was begun where another one should be saved.
    #[error("{}: exists already; --resume goes on with the reconstruction in it", path.display())]
    ReconstructionExists {
        /// The checkpoint.
        path: PathBuf,
    },
    /// Wheels are steered, braked, dragged or locked, of which the response network knows nothing.
    #[error(
        "{name}: wheels are steered, braked, dragged or locked, and the response network has learned \
         from vehicles that coast; impactlab simulate takes it in, with the 4DOF model"
    )]
    NotCoasting {
        /// The scenario or case.
        name: String,
    },
    /// Nothing says what should be learned from.
    #[error("nothing to learn from: say which data set with --data, or which log with --log")]
    NothingToLearnFrom,
    /// What is to be learned takes a network to start from.
    #[error("a network to start from is needed: say which with --model")]
    NoStart,
}

impl StudyError {
    /// The error for a name that is no vehicle.
    pub fn unknown_vehicle(name: &str) -> Self {
        let presets = Preset::ALL.iter().map(|preset| preset.id()).collect();
        Self::UnknownVehicle { name: name.to_owned(), presets }
    }

    /// The same error where the map of a file is given by another option than `--map`.
    ///
    /// - `option`: with its dashes.
    pub(crate) fn of_option(self, option: &'static str) -> Self {
        match self {
            Self::Data(error) => Self::Data(error.of_option(option)),
            other => other,
        }
    }

    /// Whether the saved run of a reconstruction is at fault, and not the question.
    pub fn is_of_checkpoint(&self) -> bool {
        match self {
            Self::Reconstruction { source, .. } => source.is_of_checkpoint(),
            _ => false,
        }
    }

    /// Whether another run is writing the saved run of a reconstruction.
    pub fn is_checkpoint_in_use(&self) -> bool {
        match self {
            Self::Reconstruction { source, .. } => source.is_in_use(),
            _ => false,
        }
    }
}

macro_rules! boxed {
    ($($error:ty => $variant:ident,)+) => {
        $(impl From<$error> for StudyError {
            fn from(error: $error) -> Self {
                Self::$variant(Box::new(error))
            }
        })+
    };
}

boxed! {
    LoadError => Cases,
    LogError => Log,
    LearningError => Learning,
    ForceError => Force,
    EvaluateError => Evaluation,
}
