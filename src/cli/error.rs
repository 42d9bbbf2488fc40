//! Why a command failed, in one line.

use std::io;
use std::path::PathBuf;

use crate::analysis::{AnalysisError, MotionForecastError};
use crate::collision::{FilterError, ScenarioError};
use crate::compare::ReplayError;
use crate::data::{DataError, SeriesError, TomlError};
use crate::force::{EvaluateError, ForceError};
use crate::learning::{LearningError, LoadError};
use crate::response::LogError;
use crate::vehicle::SimulationError;

/// A command that could not do its work.
#[derive(Debug, thiserror::Error)]
pub enum CliError {
    /// Standard output is closed or full.
    #[error("the output cannot be written")]
    Output(#[from] io::Error),
    /// A file of data.
    #[error(transparent)]
    Data(#[from] DataError),
    /// A data set whose cases a network cannot learn from.
    #[error(transparent)]
    Cases(Box<LoadError>),
    /// Training, opening or asking a force network.
    #[error(transparent)]
    Force(Box<ForceError>),
    /// A log of an impact.
    #[error(transparent)]
    Log(Box<LogError>),
    /// Not a force for every log.
    #[error("{n_forces} force files for {n_logs} logs, expected one for each or none")]
    ForcesOfLogs {
        /// How many there are.
        n_forces: usize,
        /// How many logs.
        n_logs: usize,
    },
    /// A folder without logs.
    #[error("{}: holds no file that ends in .csv", path.display())]
    NoLogs {
        /// The folder.
        path: PathBuf,
    },
    /// Training, opening or asking a response network, or a training set of either network.
    #[error(transparent)]
    Learning(Box<LearningError>),
    /// A motion that cannot be predicted.
    #[error("{}: the motion cannot be predicted", path.display())]
    Forecast {
        /// The scenario file.
        path: PathBuf,
        /// Why.
        source: Box<MotionForecastError>,
    },
    /// No scenario.
    #[error("nothing to predict: say which scenario with --scenario FILE")]
    NothingToPredict,
    /// Nothing to test on.
    #[error("{}: the model was trained on every case; --split all evaluates them all the same", path.display())]
    NoTestCase {
        /// The data set.
        path: PathBuf,
    },
    /// An evaluation that cannot be made.
    #[error("the evaluation failed")]
    Evaluation(#[source] Box<EvaluateError>),
    /// A vehicle or scenario file.
    #[error(transparent)]
    TomlFile(#[from] TomlError),
    /// A scenario without a solution.
    #[error("{}: cannot be solved", path.display())]
    Scenario {
        /// The scenario file.
        path: PathBuf,
        /// Why.
        source: ScenarioError,
    },
    /// A file that lacks a column.
    #[error("{}: does not have what this needs", path.display())]
    Series {
        /// The file or data set.
        path: PathBuf,
        /// What it lacks.
        source: SeriesError,
    },
    /// A force that cannot be filtered.
    #[error("{}: cannot be filtered", path.display())]
    Filter {
        /// The file or data set.
        path: PathBuf,
        /// Why.
        source: FilterError,
    },
    /// A simulation that did not come to its end.
    #[error("the simulation failed")]
    Simulation(#[from] SimulationError),
    /// A case that cannot be simulated.
    #[error(transparent)]
    Replay(#[from] ReplayError),
    /// A case or file that cannot be analysed.
    #[error("{}: cannot be analysed", path.display())]
    Analysis {
        /// The file or data set.
        path: PathBuf,
        /// Why.
        source: Box<AnalysisError>,
    },
    /// A vehicle that is neither a preset nor a file.
    #[error("{name:?} is no vehicle; expected a vehicle file or one of {}", presets.join(", "))]
    UnknownVehicle {
        /// As given.
        name: String,
        /// The presets.
        presets: Vec<&'static str>,
    },
    /// Nothing says which vehicle it is.
    #[error("{}: has no vehicle.toml; say which vehicle it is with --vehicle", path.display())]
    NoVehicle {
        /// The file or data set.
        path: PathBuf,
    },
    /// A case that the data set does not have.
    #[error("{}: has no case {case:?}; its {n_cases} cases start with {first:?}", path.display())]
    NoSuchCase {
        /// The data set.
        path: PathBuf,
        /// The name asked for.
        case: String,
        /// How many there are.
        n_cases: usize,
        /// A name that would do.
        first: String,
    },
    /// A data set where one case is needed.
    #[error("{}: is a data set; say which case with --case NAME", path.display())]
    CaseNeeded {
        /// The data set.
        path: PathBuf,
    },
    /// A case of a single file.
    #[error("{}: is a single file and has no case {case:?}", path.display())]
    CaseOfFile {
        /// The file.
        path: PathBuf,
        /// The name asked for.
        case: String,
    },
    /// Forces where motions are needed, or the other way round.
    #[error("{}: holds {got}, expected {expected}", path.display())]
    WrongKind {
        /// The file or data set.
        path: PathBuf,
        /// What it is.
        got: String,
        /// What is needed.
        expected: &'static str,
    },
    /// A mapping of columns for a folder.
    #[error("{}: is a folder; --map is for single files", path.display())]
    MapOfFolder {
        /// The folder.
        path: PathBuf,
    },
    /// Neither a moment nor a contact point.
    #[error(
        "{}: has no yaw moment (mz); say where the force acts with --contact x,y,z",
        path.display()
    )]
    NoYawMoment {
        /// The force file.
        path: PathBuf,
    },
    /// Contact outside the simulated time.
    #[error(
        "{}: contact from {start_s} s to {end_s} s, expected between 0 s and the end at \
         {duration_s} s; shift the time column or change --duration",
        path.display()
    )]
    ContactOutside {
        /// The force file.
        path: PathBuf,
        /// First touch, s.
        start_s: f64,
        /// Last separation, s.
        end_s: f64,
        /// Duration of the simulation, s.
        duration_s: f64,
    },
    /// No force, so that nothing can be forecast.
    #[error("{}: has no force on a vehicle to forecast a motion from", path.display())]
    NoForce {
        /// The file or data set.
        path: PathBuf,
    },
    /// Nothing of what a figure shows is known.
    #[error("{}: nothing is known of {channel} over time", path.display())]
    NothingToShow {
        /// The file or data set.
        path: PathBuf,
        /// What the figure should show.
        channel: &'static str,
    },
    /// A moment outside the recorded motion.
    #[error("--time is {time_s} s, expected between {start_s} s and {end_s} s")]
    TimeOutside {
        /// As given, s.
        time_s: f64,
        /// First sample, s.
        start_s: f64,
        /// Last sample, s.
        end_s: f64,
    },
    /// A folder that cannot be made.
    #[error("{}: cannot be made", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// An output file of an unknown kind.
    #[error("{}: cannot be made; expected a name that ends in .png or .csv", path.display())]
    OutputKind {
        /// As given.
        path: PathBuf,
    },
    /// A picture from a build without drawing.
    #[error("this build draws no pictures; --out FILE.csv writes the figure's numbers")]
    NoDrawing,
    /// A picture that could not be made.
    #[cfg(feature = "gui")]
    #[error(transparent)]
    Render(#[from] crate::render::RenderError),
    /// A window that could not be opened.
    #[cfg(feature = "gui")]
    #[error(transparent)]
    Window(#[from] crate::app::WindowError),
    /// A window from a build without one.
    #[error(
        "this build has no window; use impactlab check, impact, simulate, render or vehicles \
         (see impactlab --help)"
    )]
    NoWindow,
    /// A window where nothing can show it.
    #[error(
        "there is no display to open a window on (DISPLAY and WAYLAND_DISPLAY are not set); \
         without one, try `impactlab check datasets` or `impactlab render`"
    )]
    NoDisplay,
    /// The work was cancelled.
    #[error("cancelled")]
    Cancelled,
}

impl From<LoadError> for CliError {
    fn from(error: LoadError) -> Self {
        Self::Cases(Box::new(error))
    }
}

impl From<LogError> for CliError {
    fn from(error: LogError) -> Self {
        Self::Log(Box::new(error))
    }
}

impl From<LearningError> for CliError {
    fn from(error: LearningError) -> Self {
        Self::Learning(Box::new(error))
    }
}

impl From<ForceError> for CliError {
    fn from(error: ForceError) -> Self {
        Self::Force(Box::new(error))
    }
}

impl From<EvaluateError> for CliError {
    fn from(error: EvaluateError) -> Self {
        Self::Evaluation(Box::new(error))
    }
}
