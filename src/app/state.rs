//! What the app knows: the project and the view are saved, the session is not.

use std::path::PathBuf;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::analysis::PulseSetup;
use crate::app::case_table::CaseList;
use crate::app::dialogs::{FileDialog, MappingDialog};
use crate::app::force::{ForceProject, ForceSession, ForceView};
use crate::app::latest::Latest;
use crate::app::network::Network;
use crate::app::panes::{Layout, default_layout, is_complete};
use crate::app::replay::Replays;
use crate::app::response::{ResponseProject, ResponseSession, ResponseView};
use crate::app::source::Source;
use crate::collision::{ChannelClass, Scenario};
use crate::data::Severity;
use crate::jobs::Job;
use crate::study::{
    DEFAULT_DURATION_S, ImpactRequest, Library, SimulateAnswer, SimulateRequest, VehicleChoice,
};
use crate::units::UnitSystem;
use crate::vehicle::{ContactPoint, Equations, Integrator};

/// Version of the saved state; another one is not read.
const SAVED_VERSION: u32 = 1;

/// The whole state of the app.
#[derive(Default)]
pub struct State {
    /// What the user works on; undo works on this.
    pub project: Project,
    /// How the project is shown.
    pub view: View,
    /// Loaded data, answers and work under way.
    pub session: Session,
}

/// A case, file or scenario that is shown and simulated.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum Subject {
    /// A case of a dataset.
    Case {
        /// The dataset's folder.
        dataset: PathBuf,
        /// Name of the case.
        case: String,
    },
    /// A single file.
    File(PathBuf),
    /// The scenario of the scenario panel.
    Scenario,
}

/// What a single file does not say about the struck vehicle. What is left open is assumed by the
/// [`study`](crate::study).
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct FileStart {
    /// Speed before the impact, m/s.
    pub speed_m_s: Option<f64>,
    /// Where the force acts.
    pub contact: Option<ContactPoint>,
}

/// What the user works on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Project {
    /// The case, file or scenario that is shown and simulated.
    pub subject: Option<Subject>,
    /// The struck vehicle.
    pub vehicle: VehicleChoice,
    /// The striking vehicle, where it is simulated.
    pub bullet: VehicleChoice,
    /// Which equations of motion; those of the vehicle file if not given.
    pub equations: Option<Equations>,
    /// How the equations of motion are integrated.
    pub integrator: Integrator,
    /// Duration of simulations without a recorded motion, s.
    pub duration_s: f64,
    /// Channel class of the force plot.
    pub channel_class: Option<ChannelClass>,
    /// Whether classic pulses of the same impulse are drawn over the force.
    pub show_pulses: bool,
    /// The scenario of the scenario panel.
    pub scenario: Scenario,
    /// How the impulse of the scenario is spread over time.
    pub pulse: PulseSetup,
    /// Speed and contact point for single files, which do not say them.
    pub file_start: FileStart,
    /// The force network: what it is asked and how it is trained.
    pub force: ForceProject,
    /// The response network: what it is asked, how it is trained and compared.
    pub response: ResponseProject,
}

impl Default for Project {
    fn default() -> Self {
        Self {
            subject: None,
            vehicle: VehicleChoice::default(),
            bullet: VehicleChoice::default(),
            equations: None,
            integrator: Integrator::default(),
            duration_s: DEFAULT_DURATION_S,
            channel_class: None,
            show_pulses: false,
            scenario: Scenario::example(),
            pulse: PulseSetup::default(),
            file_start: FileStart::default(),
            force: ForceProject::default(),
            response: ResponseProject::default(),
        }
    }
}

/// How the project is shown.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct View {
    /// Units of everything on screen.
    pub units: UnitSystem,
    /// Dark theme.
    pub dark: bool,
    /// Filter of the case table.
    pub filter: String,
    /// Column by which cases are sorted; the table's own order without one.
    pub sort_column: Option<String>,
    /// Whether the largest value comes first.
    pub sort_descending: bool,
    /// The dataset whose cases are listed.
    pub listed: Option<PathBuf>,
    /// How the force network is shown.
    pub force: ForceView,
    /// How the response network is shown.
    pub response: ResponseView,
    /// Which network the training pane trains.
    pub trained: Network,
    /// Where the panes stand.
    pub layout: Layout,
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
            trained: Network::default(),
            layout: default_layout(),
        }
    }
}

/// Loaded data, answers and work under way; not saved.
#[derive(Default)]
pub struct Session {
    /// The data and models that questions refer to, as far as they are in memory.
    pub library: Arc<Library>,
    /// The data that are open, in the order of opening.
    pub sources: Vec<Source>,
    /// The simulation of the subject.
    pub analysis: Latest<SimulateRequest>,
    /// The impulse solution of the scenario panel's scenario.
    pub impact: Latest<ImpactRequest>,
    /// The simulations of whole datasets.
    pub replays: Replays,
    /// The force network.
    pub force: ForceSession,
    /// The response network.
    pub response: ResponseSession,
    /// Which cases of the listed data set are shown, in which order.
    pub cases: CaseList,
    /// The moment shown in the scene, s.
    pub time_s: f64,
    /// Whether time runs.
    pub playing: bool,
    /// What the user should know, newest last.
    pub messages: Vec<Message>,
    /// A native file dialog that is open.
    pub file_dialog: Option<FileDialog>,
    /// A dialog that asks which column is which.
    pub mapping: Option<MappingDialog>,
    /// Files being written.
    pub exports: Vec<Job<Result<PathBuf, String>>>,
    /// What the user opened last, to be selected once it is loaded.
    pub select_when_loaded: Option<PathBuf>,
    /// A path that is being typed.
    pub typed_path: String,
    /// Whether plots should fit their data in this frame.
    pub fit_plots: bool,
}

/// Something the user should know.
#[derive(Debug, Clone, PartialEq)]
pub struct Message {
    /// Its severity.
    pub severity: Severity,
    /// The message itself.
    pub text: String,
}

/// What survives a restart.
#[derive(Serialize, Deserialize)]
pub struct Saved {
    version: u32,
    project: Project,
    view: View,
    sources: Vec<PathBuf>,
}

impl State {
    /// What is to be saved, as text.
    pub fn save(&self) -> Option<String> {
        let saved = Saved {
            version: SAVED_VERSION,
            project: self.project.clone(),
            view: self.view.clone(),
            sources: self.session.sources.iter().map(|source| source.opened.clone()).collect(),
        };
        serde_json::to_string(&saved).ok()
    }

    /// The saved state and the paths that were open. `None` if the text is from another version or
    /// damaged: the app then starts without one.
    pub fn restore(text: &str) -> Option<(Self, Vec<PathBuf>)> {
        let mut saved: Saved = serde_json::from_str(text).ok()?;
        if !is_complete(&saved.view.layout) {
            saved.view.layout = default_layout(); // panes have been added since
        }
        let state = Self { project: saved.project, view: saved.view, session: Session::default() };
        let mut sources = saved.sources;
        sources.dedup();
        (saved.version == SAVED_VERSION).then_some((state, sources))
    }

    /// The simulation of the subject, to be shown.
    pub fn analysis(&self) -> Option<&SimulateAnswer> {
        self.session.analysis.ok().map(Arc::as_ref)
    }

    /// Tells the user something.
    pub fn say(&mut self, severity: Severity, text: impl Into<String>) {
        self.session.messages.push(Message { severity, text: text.into() });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::Pane;

    #[test]
    fn project_and_view_survive_a_restart() {
        let mut state = State::default();
        state.project.subject =
            Some(Subject::Case { dataset: PathBuf::from("d"), case: "c001".to_owned() });
        state.project.duration_s = 2.5;
        state.project.channel_class = Some(ChannelClass::Cfc60);
        state.view.units = UnitSystem::Us;
        state.view.filter = "spin=1".to_owned();
        state.project.force.scenario.mass_kg[1] = 1234.0;
        state.project.force.model = Some(PathBuf::from("mine.safetensors"));
        state.view.force.bands[0] = false;
        state.session.sources.push(Source::failed(PathBuf::from("a.csv"), "gone".to_owned()));
        let (restored, sources) = State::restore(&state.save().unwrap()).unwrap();
        assert_eq!(restored.project, state.project);
        assert_eq!(restored.view, state.view);
        assert_eq!(sources, [PathBuf::from("a.csv")]);
    }

    #[test]
    fn a_layout_without_the_newer_panes_is_put_back() {
        let mut state = State::default();
        let tiles = &mut state.view.layout.tiles;
        let pane =
            |tile: &egui_tiles::Tile<Pane>| matches!(tile, egui_tiles::Tile::Pane(Pane::Training));
        let training = tiles.iter().find(|(_, tile)| pane(tile)).map(|(id, _)| *id).unwrap();
        tiles.remove(training);
        let (restored, _) = State::restore(&state.save().unwrap()).unwrap();
        assert_eq!(restored.view.layout, default_layout());
    }

    #[test]
    fn a_damaged_or_foreign_save_is_not_read() {
        let text = State::default().save().unwrap();
        assert!(State::restore(&text[..text.len() / 2]).is_none());
        assert!(State::restore(&text.replace("\"version\":1", "\"version\":99")).is_none());
    }
}
