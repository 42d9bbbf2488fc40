//! The state of the application. The project and the view are saved between runs, the session is
//! not.

use std::path::PathBuf;
use std::sync::Arc;

use impactlab_core::uncertainty::Caveats;
use serde::{Deserialize, Serialize};

use crate::app::case::OpenCase;
use crate::app::case_table::CaseList;
use crate::app::cost::Costs;
use crate::app::dialog::Dialogs;
use crate::app::force::{ForceSession, ForceView};
use crate::app::frame_times::FrameTimes;
use crate::app::ground::GroundSession;
use crate::app::import::ColumnMaps;
use crate::app::kept::KeptStatus;
use crate::app::latest::Latest;
use crate::app::network::Network;
use crate::app::project::Project;
use crate::app::reconstruction::{ReconstructionSession, ReconstructionView};
use crate::app::replay::Replays;
use crate::app::report::{ReportSession, ReportView};
use crate::app::response::{DensityChoice, ResponseSession, ResponseView};
use crate::app::scene::{SceneSession, SceneSettings};
use crate::app::source::Source;
use crate::app::tasks::Tasks;
use crate::app::unfinished::UnfinishedTrainings;
use crate::app::variants::OtherVariants;
use crate::app::widgets::BetweenCursors;
use crate::app::workspaces::Workspaces;
use impactlab_core::data::{Channel, DatasetKind, Severity};
use impactlab_core::units::UnitSystem;
use impactlab_document::figure::MOTION_CHANNELS;
use impactlab_study::{ImpactRequest, Library, SimulateAnswer, SimulateReport, SimulateRequest};

/// Version of the format in which the state is saved. A state of another version is not read.
const SAVED_VERSION: u32 = 2;

/// The whole state of the application.
#[derive(Default)]
pub struct State {
    /// What the user works on. Undo and redo change this part alone.
    pub project: Project,
    /// The case to whose variant that is shown the project belongs.
    pub case: OpenCase,
    /// How the project is shown.
    pub view: View,
    /// Loaded data, answers and running work.
    pub session: Session,
}

/// The case, file or scenario that is shown and simulated.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Subject {
    /// A case of a data set.
    Case {
        /// Folder of the data set.
        dataset: PathBuf,
        /// Name of the case.
        case: String,
    },
    /// A single file, by its path.
    File(PathBuf),
    /// A start without any file, which only the command line makes.
    Manoeuvre,
    /// The scenario in the scenario pane.
    Scenario,
}

impl Subject {
    /// Whether it leaves open what happens to the wheels after the impact.
    pub(in crate::app) fn takes_ending(&self, sources: &[Source]) -> bool {
        match self {
            Self::Case { dataset, .. } => {
                let source = sources.iter().find(|source| source.path == *dataset);
                let kind = source.and_then(Source::dataset).map(|checked| checked.dataset.kind);
                kind == Some(DatasetKind::Force)
            }
            Self::File(_) | Self::Manoeuvre => true,
            Self::Scenario => false,
        }
    }
}

/// How the project is shown.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct View {
    /// The system of units in which all quantities are shown.
    pub units: UnitSystem,
    /// Whether the theme is dark.
    pub dark: bool,
    /// Filter of the case table, as the user typed it.
    pub filter: String,
    /// Key of the column by which the cases are sorted; `None` keeps the order of the data set.
    pub sort_column: Option<String>,
    /// Whether the sorting is reversed, so that the largest number comes first.
    pub sort_descending: bool,
    /// Folder of the data set whose cases are listed.
    pub listed: Option<PathBuf>,
    /// How the force network is shown.
    pub force: ForceView,
    /// How the response network is shown.
    pub response: ResponseView,
    /// How the reconstruction is shown.
    pub reconstruction: ReconstructionView,
    /// How reports are written.
    pub report: ReportView,
    /// The network that the training pane shows.
    pub trained: Network,
    /// The cases that were opened or saved last, the latest first.
    pub recent: Vec<PathBuf>,
    /// The column maps of earlier files, by their headers.
    pub column_maps: ColumnMaps,
    /// Seconds of the motion that are played in a second.
    pub playback_speed: f64,
    /// The curves of the motion pane.
    pub motion_channels: Vec<Channel>,
    /// Whether the answers of all variants are shown, not only those of the one in the forms.
    pub shows_all_variants: bool,
    /// From where the scene is seen.
    pub scene: SceneSettings,
    /// The arrangement of the panes in each workspace.
    pub workspaces: Workspaces,
}

impl Default for View {
    fn default() -> Self {
        Self {
            units: UnitSystem::default(),
            dark: false,
            filter: String::new(),
            sort_column: None,
            sort_descending: false,
            listed: None,
            force: ForceView::default(),
            response: ResponseView::default(),
            reconstruction: ReconstructionView::default(),
            report: ReportView::default(),
            trained: Network::default(),
            recent: Vec::new(),
            column_maps: ColumnMaps::default(),
            playback_speed: 1.0,
            motion_channels: MOTION_CHANNELS.to_vec(),
            shows_all_variants: true,
            scene: SceneSettings::default(),
            workspaces: Workspaces::default(),
        }
    }
}

/// Loaded data, answers and running work, which are not saved.
#[derive(Default)]
pub struct Session {
    /// The work on other threads that ends by itself.
    pub tasks: Tasks,
    /// The data and models in memory to which questions refer.
    pub library: Arc<Library>,
    /// The sources that are open, in the order of opening.
    pub sources: Vec<Source>,
    /// The simulation of the subject.
    pub analysis: Latest<SimulateRequest>,
    /// The impulse solution of the scenario in the scenario pane.
    pub impact: Latest<ImpactRequest>,
    /// The answers of the variants that are not in the forms.
    pub other_variants: OtherVariants,
    /// The simulations of whole data sets.
    pub replays: Replays,
    /// Model, forecast, training and evaluation of the force network.
    pub force: ForceSession,
    /// Model, forecast, training and comparison of the response network.
    pub response: ResponseSession,
    /// Evidence, run and answer of the reconstruction.
    pub reconstruction: ReconstructionSession,
    /// The report of the case.
    pub report: ReportSession,
    /// Models, comparisons and evaluations that are kept in the user's data folder.
    pub kept: KeptStatus,
    /// Trainings that have not ended and can go on.
    pub unfinished: UnfinishedTrainings,
    /// What the work of the forms will cost.
    pub costs: Costs,
    /// The cases that the case table lists, in their order.
    pub cases: CaseList,
    /// The ground of the scene.
    pub ground: GroundSession,
    /// The scene that is shown, and its picture.
    pub scene: SceneSession,
    /// The time that is shown in the scene, s.
    pub time_s: f64,
    /// The two cursors of the figures over time.
    pub between: BetweenCursors,
    /// Whether the playback is running.
    pub playing: bool,
    /// Messages for the user that were not dismissed, the newest last.
    pub messages: Vec<Message>,
    /// All messages since the program was started, each with the time of day in UTC, the newest last.
    pub log: Vec<(String, Message)>,
    /// The dialogs that are open in the window.
    pub dialogs: Dialogs,
    /// Whether the window may close without a question.
    pub may_close: bool,
    /// Whether what was done before cannot be undone any more: the project is of another variant.
    pub history_ends: bool,
    /// Whether the three ways to begin are shown in the place of the panes.
    pub shows_doors: bool,
    /// The path that the user opened last. Its first case or file is selected once it is loaded.
    pub select_when_loaded: Option<PathBuf>,
    /// The path in the text field of the data pane, as the user has typed it so far.
    pub typed_path: String,
    /// How long the window takes to draw itself.
    pub frame_times: FrameTimes,
    /// Whether that is shown.
    pub shows_frame_times: bool,
    /// Whether the plots fit their axes to their data in this frame.
    pub fit_plots: bool,
}

impl Session {
    /// Whether an answer is awaited.
    pub fn is_waiting(&self) -> bool {
        self.analysis.is_waiting()
            || self.impact.is_waiting()
            || self.force.forecast.is_waiting()
            || self.response.forecast.is_waiting()
    }

    /// Whether the simulation that is shown is not of what is asked any more.
    pub fn is_simulation_late(&self) -> bool {
        self.analysis.is_late() || self.impact.is_late()
    }

    /// What restricts the simulation that is shown.
    pub fn simulation_caveats(&self, report: &SimulateReport) -> Caveats {
        let caveats = report.caveats.clone();
        caveats.outdated_if(self.analysis.is_waiting())
    }

    /// Whether the forecast of the motion, or its density over a window of time, is awaited.
    pub fn is_motion_awaited(&self, density: DensityChoice) -> bool {
        let response = &self.response;
        self.analysis.is_waiting()
            || response.forecast.is_waiting()
            || (density == DensityChoice::Window && response.density.is_waiting())
    }

    /// Whether the forecast of the motion that is shown is not of what is asked any more. It is asked
    /// once the simulation is there.
    pub fn is_motion_late(&self) -> bool {
        self.analysis.is_late() || self.response.forecast.is_late()
    }
}

/// A message for the user.
#[derive(Debug, Clone, PartialEq)]
pub struct Message {
    /// Severity of the message, which gives its colour.
    pub severity: Severity,
    /// Text of the message.
    pub text: String,
}

/// The part of the state that is stored between runs.
#[derive(Serialize, Deserialize)]
pub struct Saved {
    version: u32,
    project: Project,
    #[serde(default)]
    case: OpenCase,
    view: View,
    sources: Vec<PathBuf>,
}

/// The version in which a state was saved.
#[derive(Deserialize)]
struct SavedBy {
    version: u32,
}

/// The reason why a saved state cannot be restored.
#[derive(Debug, thiserror::Error)]
pub enum RestoreError {
    /// It is not what [`State::save`] writes.
    #[error("it is damaged")]
    Damaged(#[from] serde_json::Error),
    /// It was saved by another version of the program.
    #[error("it has the version {version}, expected {SAVED_VERSION}")]
    Version {
        /// The version in which it was saved.
        version: u32,
    },
}

impl RestoreError {
    /// Whether a later version of the program has saved the state.
    pub fn is_of_later_version(&self) -> bool {
        matches!(self, Self::Version { version } if *version > SAVED_VERSION)
    }
}

impl State {
    /// Returns the project, the view and the opened paths as JSON; `None` if they cannot be written
    /// as such.
    pub fn save(&self) -> Option<String> {
        let saved = Saved {
            version: SAVED_VERSION,
            project: self.project.clone(),
            case: self.case.clone(),
            view: self.view.clone(),
            sources: self.session.sources.iter().map(|source| source.opened.clone()).collect(),
        };
        serde_json::to_string(&saved).ok()
    }

    /// Reads the state that [`save`](Self::save) has written and returns it with the paths that
    /// were open. A workspace that lacks a pane gets its default arrangement.
    ///
    /// # Errors
    /// [`RestoreError`] if the text is damaged or of another version; the application then starts
    /// with the default state.
    pub fn restore(text: &str) -> Result<(Self, Vec<PathBuf>), RestoreError> {
        let SavedBy { version } = serde_json::from_str(text)?;
        if version != SAVED_VERSION {
            return Err(RestoreError::Version { version });
        }
        let mut saved: Saved = serde_json::from_str(text)?;
        saved.view.workspaces.complete();
        saved.project.forget_held_models();
        let Saved { project, case, view, mut sources, .. } = saved;
        let state = Self { project, case, view, session: Session::default() };
        sources.dedup();
        Ok((state, sources))
    }

    /// Returns the latest simulation of the subject. While a newer one is awaited, it may belong to
    /// an earlier subject.
    pub fn analysis(&self) -> Option<&SimulateAnswer> {
        self.session.analysis.ok().map(Arc::as_ref)
    }

    /// Adds a message for the user.
    pub fn say(&mut self, severity: Severity, text: impl Into<String>) {
        let message = Message { severity, text: text.into() };
        let now = humantime::format_rfc3339_seconds(std::time::SystemTime::now()).to_string();
        self.session.log.push((now, message.clone()));
        self.session.messages.push(message);
    }
}
