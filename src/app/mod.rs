//! The window of the program.
//!
//! It edits settings, makes questions of them and shows the answers. The questions are answered by
//! [`study`](impactlab_study), on threads that [`jobs`](impactlab_core::jobs) starts.

mod apply;
mod archive;
mod atlas;
mod case;
mod case_filter;
mod case_row;
mod case_table;
mod chain;
mod command;
mod contents;
mod cost;
mod crash_test;
mod dialog;
mod export;
mod film;
mod force;
mod found;
mod frame_times;
mod ground;
mod history;
mod import;
mod keyboard;
mod latest;
mod licences;
mod looks;
mod measure;
mod menu;
mod model;
mod motion_plots;
mod network;
mod offer;
mod open;
mod output;
mod pane;
mod panels;
mod panes;
mod playback;
mod project;
mod question_job;
mod reading;
mod reconstruction;
mod recorder;
mod recording;
mod renderer;
mod replace;
mod replay;
mod report;
mod requests;
mod response;
mod scene;
mod source;
mod state;
#[cfg(test)]
mod state_tests;
mod store;
mod sweep;
mod tasks;
mod training;
mod training_status;
mod unfinished;
mod update;
mod variants;
mod vehicles;
mod widgets;
mod workspaces;

use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock};
use std::time::Duration;

use eframe::CreationContext;
use eframe::wgpu::DeviceType;
use egui::{Context, Ui, ViewportCommand};
use egui_tiles::Tree;

use crate::app::history::EditHistory;
use crate::app::keyboard::KeyFocus;
use crate::app::reading::ReadingRecord;
use crate::app::state::StateText;
use crate::app::store::{OpenedState, Store, open_state};
use impactlab_core::data::Severity;
use impactlab_core::error_chain;
use impactlab_draw::scene::gpu::WindowDevice;
use impactlab_draw::{DensityGpu, theme};

pub use archive::{ArchiveEntry, ArchiveKind, ArchiveStatus, ModelsDialog, Removal};
pub use atlas::{AtlasCommand, AtlasSession, AtlasView, MapChoice, ShownMap};
pub use case::{CaseCommand, Leaving, LeavingStage, OpenCase, TrustedCase, VariantCommand};
pub use chain::Link;
pub use command::{Command, ComparisonCommand, ModelsCommand, TrainingCommand};
pub use contents::{ContentsEntry, Group};
pub use cost::{CostPlace, Costs};
pub use crash_test::{CrashTestCommand, CrashTestForm};
pub use dialog::{Dialog, Dialogs, Purpose};
pub use film::FilmCommand;
pub use force::{ForceSession, NamedCollision, collision_of};
pub use ground::{GroundCommand, GroundSession};
pub use latest::Latest;
pub use measure::{Measure, Measurement, Measuring};
pub use network::{Network, TrainingMode};
pub use output::Output;
pub use pane::Pane;
pub use playback::PlaybackCommand;
pub use project::{Beside, Project};
pub use question_job::{Answered, QuestionJob};
pub use reconstruction::{FollowedParticle, ReconstructionCommand, ReconstructionSession};
pub use recorder::{RecorderCommand, RecorderForm};
pub use recording::OverlaidRecording;
pub use renderer::RendererChoice;
pub use replay::ReplayStatus;
pub use report::{MadeReport, ReportCommand, ReportSession, ReportView};
pub use response::{DensityChoice, MotionAnswer, ResponseSession};
pub use scene::{SceneSession, SceneSettings, SceneSource};
pub use source::{Content, Source};
pub use state::{RestoreError, State, Subject, View};
pub use sweep::{SweepCommand, SweepSession, SweepView};
pub use tasks::{TaskKey, Tasks};
pub use unfinished::{Unfinished, UnfinishedTrainings};
pub use variants::AnsweredVariant;
pub use workspaces::{Layout, Workspace, Workspaces};

/// The icon of the window, which is also the icon of the desktop entry.
const ICON: &[u8] = include_bytes!("../../assets/desktop/impactlab.png");

/// Name of the program's folder among the user's data.
const APP_ID: &str = "impactlab";
/// Name of the file that stores the project and the view between runs.
const STATE_FILE: &str = "state.json";

/// The window could not be opened, with the message of the windowing system.
#[derive(Debug, thiserror::Error)]
#[error(
    "no window could be opened ({0}); a graphics driver may be missing: on Debian or Ubuntu, `apt-get install mesa-vulkan-drivers libvulkan1` brings a software one. Without a window: `impactlab check`, `impactlab render`"
)]
pub struct WindowError(String);

/// The application: its state, the history for undo and redo, and the file that stores the state.
pub struct App {
    state: State,
    history: EditHistory,
    store: Option<Store>,
    /// The state as it is stored.
    state_text: StateText,
    /// Whether the state could be written as JSON when it was last to be stored.
    is_storable: bool,
}

/// Opens the window and returns when the user closes it.
///
/// - `paths`: files and folders to open. If there are none, the paths that were open at the end of
///   the last run are opened, otherwise the data sets of the repository. If those are not found
///   either, the window shows the example scenario.
/// - `choice`: what draws the window.
///
/// # Errors
/// [`WindowError`] if there is no display or no graphics driver.
pub fn run(paths: Vec<PathBuf>, choice: RendererChoice) -> Result<(), WindowError> {
    let viewport = egui::ViewportBuilder::default()
        .with_icon(icon())
        .with_title("impactlab")
        .with_app_id("impactlab")
        .with_inner_size([1440.0, 900.0])
        .with_min_inner_size([900.0, 600.0])
        .with_drag_and_drop(true);
    let options = eframe::NativeOptions { viewport, ..renderer::options(choice) };
    let state_file = eframe::storage_dir(APP_ID).map(|folder| folder.join(STATE_FILE));
    let create = |cc: &CreationContext<'_>| -> Result<Box<dyn eframe::App>, _> {
        Ok(Box::new(App::new(cc, paths, state_file)))
    };
    eframe::run_native(APP_ID, options, Box::new(create))
        .map_err(|error| WindowError(error.to_string()))
}

fn icon() -> egui::IconData {
    match eframe::icon_data::from_png_bytes(ICON) {
        Ok(icon) => icon,
        Err(error) => unreachable!("the icon is bad (a test reads it): {error}"),
    }
}

impl App {
    /// Creates the application from the state that the last run has stored, and opens the paths as
    /// [`run`] describes.
    ///
    /// - `state_file`: file in which the state is stored; `None` stores nothing. If another window
    ///   keeps its state there, or if it was written by a later version of the program, nothing is
    ///   stored either, and a message says so.
    pub fn new(cc: &CreationContext<'_>, paths: Vec<PathBuf>, state_file: Option<PathBuf>) -> Self {
        impactlab_core::program::set_version(crate::VERSION);
        looks::install(&cc.egui_ctx);
        let data_folder = state_file.as_deref().and_then(Path::parent).map(Path::to_owned);
        let OpenedState { store, restored, message } = open_state(state_file);
        let (has_paths, is_restored) = (!paths.is_empty(), restored.is_some());
        let (mut state, last_open) = restored.unwrap_or_default();
        state.session.tasks.wake(cc.egui_ctx.clone());
        state.session.keeps_state = store.is_some();
        if let Some(message) = message {
            state.say(Severity::Warning, message);
        }
        let to_open = match (paths.is_empty(), last_open.is_empty()) {
            (false, _) => paths,
            (true, false) => last_open,
            (true, true) => shipped_datasets().into_iter().collect(),
        };
        let own_folder = data_folder.as_deref().filter(|_| store.is_some());
        let (record, unread) = own_folder.map(ReadingRecord::open).unwrap_or_default();
        state.session.tasks.record_reading(record);
        let to_open = match has_paths {
            true => to_open,
            false => state.leave_unread(to_open, &unread),
        };
        if let Some(folder) = data_folder {
            // Trainings are stored by the window that stores its state.
            state.open_data_folder(folder, store.is_some());
        }
        state.session.response.gpu = graphics_processor(cc);
        draw_scenes_on(cc, &mut state);
        if to_open.is_empty() && state.project.subject().is_none() {
            state.select(Subject::Scenario);
        }
        let shown = state.view.workspaces.shown;
        // What was open when the window was closed has been asked about already.
        let is_table = |path: &PathBuf| !has_paths && open::is_asked_about(path);
        let (tables, to_open): (Vec<_>, Vec<_>) = to_open.into_iter().partition(is_table);
        state.apply(Command::Open(to_open), &cc.egui_ctx);
        tables.into_iter().for_each(|path| state.load(path, None));
        if !has_paths {
            state.view.workspaces.shown = shown;
            let asks_nothing =
                state.project.subject().is_none() && state.project.reconstruct.is_none();
            state.session.shows_doors = !is_restored || (asks_nothing && shown == Workspace::Case);
        }
        if !has_paths {
            let opened = state.session.sources.iter().map(|source| source.opened.clone());
            state.session.opened_at_start = opened.collect();
        }
        if !has_paths || state.project.subject().is_some() {
            // What the last run asked stays, and the shipped data lie beside.
            state.session.select_when_loaded = None;
        }
        let (history, state_text) = (EditHistory::default(), StateText::default());
        Self { state, history, store, state_text, is_storable: true }
    }

    /// Returns the state of the application.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Returns the state of the application so that a test can change it.
    pub fn state_mut(&mut self) -> &mut State {
        &mut self.state
    }

    /// Carries out a command as if the user had asked for it, including undo and redo.
    pub fn apply(&mut self, command: Command, context: &Context) {
        match command {
            Command::Undo => {
                if let Some(project) = self.history.undo(&self.state.project) {
                    self.state.project = project.clone();
                }
            }
            Command::Redo => {
                if let Some(project) = self.history.redo(&self.state.project) {
                    self.state.project = project.clone();
                }
            }
            command => self.state.apply(command, context),
        }
    }
}

impl eframe::App for App {
    fn logic(&mut self, context: &Context, _frame: &mut eframe::Frame) {
        self.state.update(context);
        let mut commands = Vec::new();
        let session = &mut self.state.session;
        let [of_cars, of_courses] = session.reconstruction.cars.take_refusals();
        let refusals = [session.scene.view.take_refusal(), of_cars, of_courses];
        for refusal in refusals.into_iter().flatten() {
            self.state.say(Severity::Warning, scenes_on_cpu(&refusal));
        }
        let focus = KeyFocus {
            has_dialog: self.state.session.dialogs.is_any_open(),
            is_typing: self.history.is_typing(context),
        };
        keyboard::commands(context, focus, &mut commands);
        let dropped = context.input(|input| input.raw.dropped_files.clone());
        let paths: Vec<PathBuf> = dropped.into_iter().map(|file| file.path().to_owned()).collect();
        if !paths.is_empty() {
            commands.push(Command::Open(paths));
        }
        for command in commands {
            self.apply(command, context);
        }
        self.ask_before_closing(context);
        if std::mem::take(&mut self.state.session.history_ends) {
            self.history.clear();
        }
        self.history.feed(context, &self.state.project);
        self.keep_state(context);
    }

    fn ui(&mut self, ui: &mut Ui, frame: &mut eframe::Frame) {
        let now = ui.input(|input| input.time);
        self.state.session.frame_times.add(now, frame.info().cpu_usage);
        if ui.visuals().dark_mode != self.state.view.dark {
            ui.ctx().set_visuals(theme::visuals(self.state.view.dark));
        }
        let mut commands = Vec::new();
        let history = menu::History {
            can_undo: self.history.has_undo(&self.state.project),
            can_redo: self.history.has_redo(&self.state.project),
        };
        menu::menu_ui(ui, &mut self.state, history, &mut commands);
        case::case_bar_ui(ui, &mut self.state, &mut commands);
        let chain = self.state.chain();
        chain::chain_ui(ui, &self.state, &chain, &mut commands);
        offer::offer_ui(ui, &self.state, &mut commands);
        menu::status_ui(ui, &self.state, &mut commands);
        self.panes_ui(ui, &chain, &mut commands);
        dialog::dialogs_ui(ui, &mut self.state, &mut commands);
        menu::drop_hint_ui(ui);
        for command in commands {
            self.apply(command, ui.ctx());
        }
    }

    fn on_exit(&mut self, _gl: Option<&eframe::glow::Context>) {
        self.finish_writes();
        if let (Some(store), Ok(text)) = (&mut self.store, self.state.save()) {
            store.finish(&text);
        }
        self.state.session.tasks.end_reading();
    }
}

impl App {
    /// Waits until what is being written is in its file, since the end of the program ends its threads.
    fn finish_writes(&mut self) {
        const POLL: Duration = Duration::from_millis(5);
        let context = Context::default();
        while self.state.session.tasks.has_writes() {
            for command in self.state.session.tasks.poll() {
                self.state.apply(command, &context);
            }
            std::thread::sleep(POLL);
        }
    }

    /// Stores the state for the next start, and says once if it cannot be stored.
    fn keep_state(&mut self, context: &Context) {
        let Self { state, store: Some(store), state_text, is_storable, .. } = self else { return };
        let saved = state_text.update(state);
        let was_storable = std::mem::replace(is_storable, saved.is_ok());
        state.session.keeps_state = saved.is_ok() && !store.is_failing();
        match saved {
            Ok(text) => {
                if let Some(failure) = store.keep(text, context) {
                    state.say(Severity::Error, failure);
                }
            }
            Err(error) if was_storable => {
                let text = format!("what is changed in this window will not be kept ({error})");
                state.say(Severity::Warning, text);
            }
            Err(_) => {}
        }
    }

    /// - `chain`: that of [`State::chain`].
    fn panes_ui(&mut self, ui: &mut Ui, chain: &[Link], commands: &mut Vec<Command>) {
        let frame = egui::Frame::new().fill(ui.visuals().panel_fill);
        let central = egui::CentralPanel::no_frame().frame(frame);
        if self.state.session.shows_doors {
            central.show(ui, |ui| panels::doors_ui(ui, &self.state.view.recent, commands));
            return;
        }
        let (variants, contents) = (self.state.answered_variants(), self.state.contents(chain));
        let State { project, case, view, session } = &mut self.state;
        let shown = view.workspaces.shown;
        let empty = Tree::empty(egui::Id::unique("panes"));
        let mut layout = std::mem::replace(view.workspaces.layout_mut(shown), empty);
        let between = std::mem::take(&mut session.between);
        let expert = &mut case.file.expert;
        let mut panes = panes::PaneContext {
            project,
            view,
            session,
            between,
            variants,
            expert,
            contents,
            commands,
        };
        central.show(ui, |ui| layout.ui(&mut panes, ui));
        panes.between.ui(ui);
        panes.session.between = panes.between;
        *self.state.view.workspaces.layout_mut(shown) = layout;
        self.state.session.fit_plots = false;
    }

    /// Keeps the window open as long as something is being written, or would be lost that the user has not
    /// given up.
    fn ask_before_closing(&mut self, context: &Context) {
        let is_closing = context.input(|input| input.viewport().close_requested());
        if !is_closing || self.state.session.may_close {
            return;
        }
        let is_writing = self.state.session.tasks.has_writes();
        if is_writing || !self.state.reasons_to_stay(&Leaving::Quit).is_empty() {
            context.send_viewport_cmd(ViewportCommand::CancelClose);
            self.state.leave(Leaving::Quit, context);
        }
    }
}

/// Lets the window's graphics device draw the scenes, if it has one that can.
fn draw_scenes_on(cc: &CreationContext<'_>, state: &mut State) {
    let Some(window) = &cc.wgpu_render_state else { return };
    match WindowDevice::new(window) {
        Ok(device) => {
            state.session.reconstruction.cars.draw_on(&device);
            state.session.scene.view.draw_on(device);
        }
        Err(error) => state.say(Severity::Warning, scenes_on_cpu(&error_chain(&error))),
    }
}

/// Says why the graphics processor does not draw the scenes.
fn scenes_on_cpu(why: &str) -> String {
    format!("scenes are drawn by the processor, more slowly: {why}")
}

/// Returns the window's graphics processor for density maps. `None` if there is none or if it is
/// emulated in software, which is slower than the computation on all cores.
fn graphics_processor(cc: &CreationContext<'_>) -> Option<Arc<DensityGpu>> {
    let render = cc.wgpu_render_state.as_ref()?;
    let gpu = DensityGpu::new(render.device.clone(), render.queue.clone()).ok()?;
    (gpu.adapter_info().device_type != DeviceType::Cpu).then(|| Arc::new(gpu))
}

/// Returns the folder of the repository's data sets, which are too large to be part of the program.
/// It is searched below the current folder, in the folders above the program, and in the source
/// folder from which the program was built, once: panes without data ask for it in every frame.
fn shipped_datasets() -> Option<PathBuf> {
    static FOLDER: LazyLock<Option<PathBuf>> = LazyLock::new(find_shipped_datasets);
    FOLDER.clone()
}

fn find_shipped_datasets() -> Option<PathBuf> {
    let program = std::env::current_exe().unwrap_or_default();
    let roots = [PathBuf::from(".")]
        .into_iter()
        .chain(program.ancestors().skip(1).map(PathBuf::from))
        .chain([PathBuf::from(env!("CARGO_MANIFEST_DIR"))]);
    let folders = roots.map(|root| root.join("datasets"));
    folders.into_iter().find(|folder| folder.join("fea").exists())
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_icon_is_a_picture() {
        let icon = super::icon();
        assert_eq!((icon.width, icon.height, icon.rgba.len()), (256, 256, 4 * 256 * 256));
    }
}
