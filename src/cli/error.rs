//! Why a command failed, in one line.

use std::io;
use std::path::PathBuf;

use impactlab_core::collision::FilterError;
use impactlab_core::collision::contact::FaceLawError;
use impactlab_core::data::{DataError, SeriesError};
use impactlab_core::ranges::OutOfRange;
use impactlab_core::site::SiteError;
use impactlab_core::units::TypedError;
use impactlab_document::exchange::ExchangeError;
use impactlab_document::report::{FormatError, WriteError};
use impactlab_document::scene::FilmTimingError;
use impactlab_networks::force::ForceError;
use impactlab_networks::learning::LearningError;
use impactlab_study::StudyError;
use impactlab_study::case_file::{CaseError, Reach};
use impactlab_sweep::SweepError;
use impactlab_sweep::atlas::AtlasError;

/// A command that could not do its work.
#[derive(Debug, thiserror::Error)]
pub enum CliError {
    /// A case cannot be read, written or packed.
    #[error(transparent)]
    Case(Box<CaseError>),
    /// A case does more than read files in its own folder, and nobody has said that it may.
    #[error(
        "{}: {reach}; --trust allows this, for a case of which you know who made it", path.display()
    )]
    Untrusted {
        /// The case.
        path: PathBuf,
        /// What it does.
        reach: Box<Reach>,
    },
    /// A checkpoint has the name of a file of the results.
    #[error(
        "{}: is a file of the results in --out, so it cannot be the checkpoint; choose another name for \
         --checkpoint",
        path.display()
    )]
    IsResult {
        /// The checkpoint.
        path: PathBuf,
    },
    /// Standard output is closed or full.
    #[error("the output cannot be written")]
    Output(#[from] io::Error),
    /// JSON cannot hold the name of a file.
    #[error("the name of a file is not Unicode, which JSON cannot hold; rename it")]
    NotUnicode(#[source] serde_json::Error),
    /// A question has no answer.
    #[error(transparent)]
    Study(Box<StudyError>),
    /// A sweep cannot be planned, run or merged.
    #[error(transparent)]
    Sweep(Box<SweepError>),
    /// The ground of a scene cannot be read.
    #[error(transparent)]
    Site(#[from] SiteError),
    /// A file cannot be read or written.
    #[error(transparent)]
    Data(#[from] DataError),
    /// The torques at the wheels do not fit the motion.
    #[error("the torques at the wheels do not fit the motion")]
    Torques(#[from] SeriesError),
    /// The scenario is not said.
    #[error("nothing to predict: say which scenario with --scenario FILE")]
    NothingToPredict,
    /// A force is given, and not what it acts on.
    #[error(
        "{}: a force alone does not say which vehicle it acts on and how fast that is: name the collision whose \
         force it replaces with --scenario FILE, or with --dataset DIR and --case NAME, or a recorded motion \
         with --trajectory FILE.csv; for one vehicle under this force: impactlab simulate --force {} --speed 72km/h",
        path.display(),
        path.display()
    )]
    ForceAlone {
        /// The file of the force.
        path: PathBuf,
    },
    /// Nothing of a file can be used.
    #[error("{}: nothing of it can be used: {why}", path.display())]
    NothingImported {
        /// The file.
        path: PathBuf,
        /// Why.
        why: String,
    },
    /// An input that a method by hand does not have.
    #[error("{name:?} is no input of the method; it takes {known}")]
    HandInput {
        /// What was said.
        name: String,
        /// Its inputs.
        known: String,
    },
    /// An input of a method by hand that is no number of its quantity.
    #[error("{name}={text}")]
    HandValue {
        /// The input.
        name: String,
        /// What was said.
        text: String,
        /// What is expected.
        source: TypedError,
    },
    /// An input of a method by hand that is given twice.
    #[error("{name} is given twice")]
    HandTwice {
        /// The input.
        name: String,
    },
    /// A test against a barrier that says nothing of a face.
    #[error("no stiffness follows from this test")]
    Stiffness(#[from] FaceLawError),
    /// A steering-wheel angle that the road wheels cannot follow.
    #[error("the steering-wheel angle over the steering ratio is no angle of a road wheel")]
    SteeringWheel(#[from] OutOfRange),
    /// A wheel that is locked or dragged at two places.
    #[error("--locked and --dragged: {name} is given twice; give what holds it once")]
    WheelTwice {
        /// The wheel.
        name: String,
    },
    /// A ground is given for a data set.
    #[error(
        "the cases of a trajectory data set are simulated on the road of their vehicle; leave out --site"
    )]
    SiteOfDataset,
    /// Drawn vehicles are asked for of a data set whose cases are simulated once each.
    #[error(
        "each case of a trajectory data set is simulated once, with the vehicle as it is; leave out \
         --vehicle-draws"
    )]
    DrawsOfDataset,
    /// What happens to the wheels is said for a data set whose cases say it themselves.
    #[error(
        "the cases of a trajectory data set say themselves what happens to the wheels and how long \
         they last; leave out the options of the ending and --until-rest"
    )]
    EndingOfDataset,
    /// A request file holds no request.
    #[error("{}: is no request", path.display())]
    Request {
        /// The file.
        path: PathBuf,
        /// What is wrong, with line and column.
        source: serde_json::Error,
    },
    /// A force cannot be filtered.
    #[error("{name}: cannot be filtered")]
    Filter {
        /// The file or case.
        name: String,
        /// Why.
        source: FilterError,
    },
    /// A data set is given where one case is needed.
    #[error("{}: is a data set; say which case with --case NAME", path.display())]
    CaseNeeded {
        /// The data set.
        path: PathBuf,
    },
    /// A case of a single file is asked for.
    #[error("{}: is a single file and has no case {case:?}", path.display())]
    CaseOfFile {
        /// The file.
        path: PathBuf,
        /// The name asked for.
        case: String,
    },
    /// Columns are assigned to a scenario.
    #[error("{}: is a scenario, which has no columns; leave out --map", path.display())]
    MapOfScenario {
        /// The scenario.
        path: PathBuf,
    },
    /// An option of a simulation is given for evidence.
    #[error("{}: is the evidence of a collision, which is reconstructed without {option}; leave it out",
            path.display())]
    OptionOfSimulation {
        /// The evidence.
        path: PathBuf,
        /// The option.
        option: &'static str,
    },
    /// An option of a reconstruction is given for something else.
    #[error("{}: is no evidence of a collision; leave out {option}", path.display())]
    OptionOfEvidence {
        /// The case, file or scenario.
        path: PathBuf,
        /// The option.
        option: &'static str,
    },
    /// An option of a ground is given for a file that does not take it.
    #[error("{}: is no file that takes {option}; leave it out", path.display())]
    OptionOfGround {
        /// The file.
        path: PathBuf,
        /// The option.
        option: &'static str,
    },
    /// The record of a recorder is for the evidence of a single car.
    #[error(
        "{name}: is the evidence of a single car, which has no record of a crash; give the speed as a \
        [[recorded_speed]]"
    )]
    RecorderOfSingleCar {
        /// The case.
        name: String,
    },
    /// A figure of a collision is asked of a single car.
    #[error("{name}: is of a single car, of which there is no {quantity}")]
    NotOfSingleCar {
        /// The case.
        name: String,
        /// What the figure should show.
        quantity: &'static str,
    },
    /// There is no motion for a file, since the record lacks what a simulation starts from.
    #[error(
        "{}: is not written, as there is no simulated motion; the notes of the answer say what the record lacks",
        path.display()
    )]
    NotSimulated {
        /// The file.
        path: PathBuf,
    },
    /// Nothing of what a figure shows is known.
    #[error("{name}: nothing is known of {channel} over time")]
    NothingToShow {
        /// The file or case.
        name: String,
        /// What the figure should show.
        channel: &'static str,
    },
    /// Nothing acts on the wheels in the way that a figure would show.
    #[error("{name}: {input}: zero throughout, nothing to show")]
    NoInput {
        /// The file or case.
        name: String,
        /// What the figure should show.
        input: &'static str,
    },
    /// A moment lies outside the recorded motion.
    #[error("{option} is {time_s} s, expected between {start_s} s and {end_s} s")]
    TimeOutside {
        /// The option.
        option: &'static str,
        /// As given, s.
        time_s: f64,
        /// First sample, s.
        start_s: f64,
        /// Last sample, s.
        end_s: f64,
    },
    /// A window of time ends after the predicted motion.
    #[error("--window ends at {to_s} s, after the motion, which ends at {end_s} s")]
    WindowOutside {
        /// End of the window as given, s.
        to_s: f64,
        /// Last instant of the motion, s.
        end_s: f64,
    },
    /// No range has such a name.
    #[error("no range has {word:?} in its name; `impactlab ranges` lists all")]
    NoRange {
        /// The word that was looked for.
        word: String,
    },
    /// No question has such a name.
    #[error("no question is called {name:?}; `impactlab schema` lists all")]
    NoSchema {
        /// The name as given.
        name: String,
    },
    /// An output file is of an unknown kind.
    #[error("{}: cannot be made; expected a name that ends in .png or .csv", path.display())]
    OutputKind {
        /// As given.
        path: PathBuf,
    },
    /// What is exported is of an unknown kind.
    #[error(
        "{}: cannot be made; expected a name that ends in .dxf, .kml, .geojson, .glb, .csv or .parquet, or --format",
        path.display()
    )]
    ExportKind {
        /// As given.
        path: PathBuf,
    },
    /// Moments for outlines are given for something that has none.
    #[error("--at says when a drawing shows outlines; leave it out, or write a drawing (.dxf)")]
    OutlinesOfDrawing,
    /// Nothing can be written for another program.
    #[error(transparent)]
    Exchange(#[from] ExchangeError),
    /// A film is of an unknown kind.
    #[error("{}: cannot be made; expected a name that ends in .mp4, or a folder", path.display())]
    FilmKind {
        /// As given.
        path: PathBuf,
    },
    /// An atlas cannot be read, made or written.
    #[error(transparent)]
    Atlas(Box<AtlasError>),
    /// No atlas is shipped, and no other one is named.
    #[error(
        "no atlas comes with this program; --atlas FILE reads one, and `impactlab atlas make` makes it \
         of the rows of a sweep"
    )]
    NoAtlas,
    /// The atlas has no axis of a name.
    #[error("the atlas has no axis {name:?}, expected one of {known}")]
    NoAxis {
        /// As given.
        name: String,
        /// Those that there are.
        known: String,
    },
    /// One axis is given for both sides of a map.
    #[error("--x and --y both name the axis {name:?}")]
    AxisTwice {
        /// The axis.
        name: String,
    },
    /// An axis is held at two places.
    #[error("--set {name}: the axis is set twice; leave one of them out")]
    AxisSetTwice {
        /// The axis.
        name: String,
    },
    /// An axis of a map is held.
    #[error(
        "--set {name}: the map goes over that axis; leave it out, or name another one for --x or --y"
    )]
    AxisOfMapSet {
        /// The axis.
        name: String,
    },
    /// A value of an axis cannot be read.
    #[error("--set {name}: {text:?} cannot be read")]
    AxisValue {
        /// The axis.
        name: String,
        /// As given.
        text: String,
        /// Why.
        source: TypedError,
    },
    /// A value lies outside of an axis.
    #[error("--set {name}: {text:?} lies outside of the atlas, which has {expected}")]
    OutsideAtlas {
        /// The axis.
        name: String,
        /// As given.
        text: String,
        /// What the axis has.
        expected: String,
    },
    /// The atlas has no outcome of a name.
    #[error("the atlas has no outcome {name:?}, expected one of {known}")]
    NoOutcome {
        /// As given.
        name: String,
        /// Those that there are.
        known: String,
    },
    /// The atlas has no Sobol indices.
    #[error(
        "this atlas has no Sobol indices; `impactlab atlas make` takes them of --saltelli ROWS"
    )]
    NoIndices,
    /// A film shows instants that the motion does not have.
    #[error(transparent)]
    FilmTiming(#[from] FilmTimingError),
    /// A film could not be made.
    #[error(transparent)]
    Film(#[from] impactlab_draw::film::FilmError),
    /// A report is of an unknown kind.
    #[error(transparent)]
    ReportFormat(#[from] FormatError),
    /// Settings of a reconstruction are given for the report of a case.
    #[error("{}: is a case, which says itself how many particles there are, their seed and their \
             ground; leave out --particles, --seed and --site", path.display())]
    ReportOfCase {
        /// The case.
        path: PathBuf,
    },
    /// The input of a report has no absolute path.
    #[error("{}: cannot be found", path.display())]
    ReportInput {
        /// As given.
        path: PathBuf,
        /// The error of the operating system.
        source: io::Error,
    },
    /// A report cannot be written.
    #[error("{}: cannot be written", path.display())]
    Report {
        /// The file.
        path: PathBuf,
        /// Why.
        source: WriteError,
    },
    /// The clock tells no day.
    #[error("the clock of this machine tells no day; say it with --date YYYY-MM-DD")]
    NoClock,
    /// A picture could not be made.
    #[error(transparent)]
    Render(#[from] impactlab_draw::RenderError),
    /// A window could not be opened.
    #[error(transparent)]
    Window(#[from] crate::app::WindowError),
    /// Nothing can show a window.
    #[error(
        "there is no display to open a window on (DISPLAY and WAYLAND_DISPLAY are not set); \
         without one, try `impactlab check datasets` or `impactlab render`"
    )]
    NoDisplay,
    /// The work was cancelled.
    #[error("cancelled")]
    Cancelled,
}

impl From<CaseError> for CliError {
    fn from(error: CaseError) -> Self {
        Self::Case(Box::new(error))
    }
}

impl From<StudyError> for CliError {
    fn from(error: StudyError) -> Self {
        Self::Study(Box::new(error))
    }
}

impl From<SweepError> for CliError {
    fn from(error: SweepError) -> Self {
        Self::Sweep(Box::new(error))
    }
}

impl From<AtlasError> for CliError {
    fn from(error: AtlasError) -> Self {
        Self::Atlas(Box::new(error))
    }
}

impl From<ForceError> for CliError {
    fn from(error: ForceError) -> Self {
        StudyError::from(error).into()
    }
}

impl From<LearningError> for CliError {
    fn from(error: LearningError) -> Self {
        StudyError::from(error).into()
    }
}
