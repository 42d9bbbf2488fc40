//! The part of the state that is not saved: what is loaded, computed and under way.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use crate::app::archive::ArchiveStatus;
use crate::app::atlas::AtlasSession;
use crate::app::case::KnownCase;
use crate::app::case_table::CaseList;
use crate::app::cost::Costs;
use crate::app::dialog::Dialogs;
use crate::app::force::ForceSession;
use crate::app::frame_times::FrameTimes;
use crate::app::ground::GroundSession;
use crate::app::import::SaidOfFile;
use crate::app::latest::Latest;
use crate::app::motion_plots::MotionPlots;
use crate::app::playback::Playback;
use crate::app::question_job::QuestionJob;
use crate::app::reconstruction::ReconstructionSession;
use crate::app::replay::Replays;
use crate::app::report::ReportSession;
use crate::app::response::{DensityChoice, ResponseSession};
use crate::app::scene::SceneSession;
use crate::app::source::Source;
use crate::app::state::Subject;
use crate::app::sweep::SweepSession;
use crate::app::tasks::Tasks;
use crate::app::unfinished::UnfinishedTrainings;
use crate::app::variants::{OtherVariants, VariantDifferences};
use crate::app::vehicles::ChosenVehicles;
use crate::app::widgets::BetweenCursors;
use impactlab_core::data::Severity;
use impactlab_core::uncertainty::Caveats;
use impactlab_study::{
    Answer, HandRequest, ImpactRequest, Library, ReplayRequest, SimulateReport, SimulateRequest,
};

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
    /// The calculation by hand.
    pub hand: Latest<HandRequest>,
    /// The replay of a recorder.
    pub recorder_replay: QuestionJob<ReplayRequest>,
    /// What is known of the case as it is now.
    pub known_case: KnownCase,
    /// The answers of the variants that are not in the forms.
    pub other_variants: OtherVariants,
    /// What the variants ask otherwise than the first one.
    pub variant_differences: VariantDifferences,
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
    /// The atlas that is shown, with its maps.
    pub atlas: AtlasSession,
    /// The plan of the sweep, and what its folder holds.
    pub sweep: SweepSession,
    /// Models, comparisons and evaluations that are kept in the user's data folder.
    pub archive: ArchiveStatus,
    /// Trainings that have not ended and can go on.
    pub unfinished: UnfinishedTrainings,
    /// What the work of the forms will cost.
    pub costs: Costs,
    /// The vehicles that are chosen.
    pub chosen_vehicles: ChosenVehicles,
    /// The cases that the case table lists, in their order.
    pub cases: CaseList,
    /// How many cases have taken the place of the first one. What is half typed in a field is of one of them.
    pub n_cases: u64,
    /// How often a file that was in use has been opened again. A report that was made before is of what the file
    /// held then.
    pub n_reopened: u64,
    /// The ground of the scene.
    pub ground: GroundSession,
    /// The scene that is shown, and its picture.
    pub scene: SceneSession,
    /// The figures of the motion over time.
    pub motion_plots: MotionPlots,
    /// The two cursors of the figures over time.
    pub between: BetweenCursors,
    /// The time that is shown.
    pub playback: Playback,
    /// Messages for the user that were not dismissed, the newest last.
    pub messages: Vec<Message>,
    /// All messages since the program was started, each with the time of day in UTC, the newest last.
    pub log: Vec<(String, Message)>,
    /// The dialogs that are open in the window.
    pub dialogs: Dialogs,
    /// Whether the window may close without a question.
    pub may_close: bool,
    /// Whether this window keeps its state for the next start. A second one does not.
    pub keeps_state: bool,
    /// Whether what was done before cannot be undone any more: the project is of another variant.
    pub history_ends: bool,
    /// Whether the three ways to begin are shown in the place of the panes.
    pub shows_doors: bool,
    /// What was opened while the variant asks about something else.
    pub offered: Option<Subject>,
    /// What was said in the import dialog of the vehicles of files that the variant has not taken.
    pub said_of_files: BTreeMap<PathBuf, SaidOfFile>,
    /// The path that the user opened last. Its first case or file is offered to the variant once it is loaded.
    pub select_when_loaded: Option<PathBuf>,
    /// The paths that the program has opened by itself. No case of theirs is chosen unasked.
    pub opened_at_start: Vec<PathBuf>,
    /// The path in the text field of the data pane, as the user has typed it so far.
    pub typed_path: String,
    /// How long the window takes to draw itself.
    pub frame_times: FrameTimes,
    /// Whether the plots fit their axes to their data in this frame.
    pub fit_plots: bool,
}

impl Session {
    /// Whether an answer is awaited.
    pub fn is_waiting(&self) -> bool {
        self.analysis.is_waiting()
            || self.impact.is_waiting()
            || self.hand.is_waiting()
            || self.force.forecast.is_waiting()
            || self.response.forecast.is_waiting()
    }

    /// Whether the simulation that is shown is not of what is asked any more.
    pub fn is_simulation_late(&self) -> bool {
        self.analysis.is_late() || self.impact.is_late()
    }

    /// What restricts the simulation that is shown.
    pub fn simulation_caveats(&self, report: &Answer<SimulateReport>) -> Caveats {
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
    /// once all of the simulation is there.
    pub fn is_motion_late(&self) -> bool {
        self.analysis.is_unfinished() || self.response.forecast.is_late()
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
