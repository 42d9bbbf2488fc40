//! The commands of the user interface, which
//! [`State::apply`](crate::app::state::State::apply) carries out.
//!
//! A pane edits its own settings directly. For everything else, menus, keys and panes put a
//! [`Command`] into a list, which is applied after the frame has been drawn.

use std::path::PathBuf;

use egui::Context;

use crate::app::archive::{ArchiveEntry, ArchiveEvent, ModelsDialog, Removal};
use crate::app::atlas::AtlasCommand;
use crate::app::case::{CaseCommand, VariantCommand};
use crate::app::cost::CostPlace;
use crate::app::crash_test::CrashTestCommand;
use crate::app::dialog::Purpose;
use crate::app::film::FilmCommand;
use crate::app::found::Found;
use crate::app::ground::GroundCommand;
use crate::app::import::ImportAnswer;
use crate::app::model::ModelEvent;
use crate::app::network::Network;
use crate::app::output::Output;
use crate::app::panes::Pane;
use crate::app::playback::PlaybackCommand;
use crate::app::reconstruction::ReconstructionCommand;
use crate::app::recorder::RecorderCommand;
use crate::app::report::ReportCommand;
use crate::app::source::OpenedPath;
use crate::app::state::Subject;
use crate::app::sweep::SweepCommand;
use crate::app::workspaces::Workspace;
use impactlab_core::collision::Role;
use impactlab_core::data::{ColumnMap, Outcome, Severity};
use impactlab_document::figure::Figure;
use impactlab_networks::force::ForceModel;
use impactlab_networks::response::ResponseModel;
use impactlab_networks::response::evaluate::Comparison;
use impactlab_study::{Cost, Request, VehicleChoice};

/// An action that the user requests.
#[derive(Debug, Clone)]
pub enum Command {
    /// Open files or folders: data, models, vehicles, scenarios or comparisons.
    Open(Vec<PathBuf>),
    /// Close the sources that were opened under this path, or whose own path it is.
    Close(PathBuf),
    /// Ask the user for a path with a native file dialog.
    Ask(Purpose),
    /// Select a case, a file or the scenario, so that it is shown and simulated.
    Select(Subject),
    /// Move the selection in the case table by this many rows; negative values move up.
    SelectNeighbour(isize),
    /// List the cases of the data set in this folder.
    List(PathBuf),
    /// Open the dialog in which the user assigns channels and units to the columns of a file.
    AskMapping(PathBuf),
    /// Read a file with the columns that the user assigned.
    OpenMapped(PathBuf, ColumnMap),
    /// Close the uppermost dialog and leave everything as it is.
    CloseDialog,
    /// Show the licences of third parties.
    ShowLicences,
    /// Simulate every case of the data set in this folder.
    ReplayDataset(PathBuf),
    /// Cancel the simulation of the data set in this folder.
    CancelReplay(PathBuf),
    /// Set the time that is shown, or let it run.
    Playback(PlaybackCommand),
    /// Fit the axes of all plots to their data.
    FitPlots,
    /// Make a film of a scene.
    Film(FilmCommand),
    /// Copy the numbers of a figure to the clipboard, as CSV.
    CopyNumbers(Box<Figure>),
    /// Save the case, or leave it.
    Case(CaseCommand),
    /// Show, copy, rename or remove a variant of the case.
    Variant(VariantCommand),
    /// Ask the user for a path within the window.
    AskPath(Purpose),
    /// Write something to a file or a folder, after asking if something would be replaced.
    Write(Output, PathBuf),
    /// Write something to a file or a folder, and replace what is there.
    Replace(Output, PathBuf),
    /// Leave what was opened beside the variant.
    DeclineOffer,
    /// Choose a vehicle, from which the scenario takes over what it is.
    ChooseVehicle(Role, Box<VehicleChoice>),
    /// Predict the force of the selected case.
    PredictCase,
    /// Predict the force of the collision in the scenario pane.
    PredictScenario,
    /// Use the model in this file; `None` is the shipped model.
    UseModel(Network, Option<PathBuf>),
    /// Use the model of the last training, which has been set aside.
    UseTrained(Network),
    /// Start, pause or cancel the training of a network.
    Train(Network, TrainingCommand),
    /// Compare response models, evaluate the current one, or open a comparison.
    Compare(ComparisonCommand),
    /// Act on what is kept of models, comparisons and trainings.
    Models(ModelsCommand),
    /// Evaluate the current force model on the chosen data set.
    Evaluate,
    /// Cancel the evaluation of the force model.
    CancelEvaluation,
    /// Act on the ground of the scene.
    Ground(GroundCommand),
    /// Act on the reconstruction.
    Reconstruct(ReconstructionCommand),
    /// Take something of a crash test that was opened.
    CrashTest(CrashTestCommand),
    /// Take something of a recorder that was opened.
    Recorder(RecorderCommand),
    /// Make the report of the case, or show a part of it.
    Report(ReportCommand),
    /// Act on the atlas.
    Atlas(AtlasCommand),
    /// Act on the sweep.
    Sweep(SweepCommand),
    /// Bring a pane to the front.
    Show(Pane),
    /// Bring the training pane to the front and show this network in it.
    ShowTraining(Network),
    /// Show a workspace.
    ShowWorkspace(Workspace),
    /// Show the three ways to begin.
    ShowDoors,
    /// Restore the default layout of the panes of the workspace that is shown.
    ResetLayout,
    /// Take what was found at a path that was opened.
    Opened(PathBuf, Result<Outcome<Found<OpenedPath>>, String>),
    /// Say that a file or folder has been written, or why it could not be.
    Written(Result<PathBuf, String>),
    /// Take what was read for the import dialog of a file.
    ImportRead(PathBuf, Result<Found<ImportAnswer>, String>),
    /// Take what a form with this question will cost.
    Measured(CostPlace, Box<Request>, Result<Outcome<Option<Cost>>, String>),
    /// Take what has become of a model of the force network.
    ForceModel(Found<ModelEvent<ForceModel>>),
    /// Take what has become of a model of the response network.
    ResponseModel(Found<ModelEvent<ResponseModel>>),
    /// Take what has become of what is kept.
    Archive(Found<ArchiveEvent>),
    /// Show a message in the status line.
    Say(Severity, String),
    /// Take the latest message out of the status line. It stays in the list of all messages.
    DismissMessage,
    /// Show the list of all messages.
    ShowMessages,
    /// Undo the last change of the project.
    Undo,
    /// Redo the change of the project that was undone last.
    Redo,
}

/// An action on the training of a network.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TrainingCommand {
    /// Start the training with the settings of the form.
    Start,
    /// Pause the training (`true`) or resume it (`false`).
    Pause(bool),
    /// End the training and keep the weights reached so far.
    Cancel,
}

/// An action on models, comparisons and evaluations that are kept, and on trainings that have not
/// ended.
#[derive(Debug, Clone, PartialEq)]
pub enum ModelsCommand {
    /// Ask the user for a name or whether to remove something.
    Ask(ModelsDialog),
    /// Give something another name.
    Rename(Box<ArchiveEntry>, String),
    /// Remove files.
    Remove(Removal),
    /// Show a comparison or an evaluation again.
    Open(Box<ArchiveEntry>),
    /// Go on with the training of this checkpoint.
    Resume(PathBuf),
    /// Do not speak of interrupted trainings in the status line any more.
    HideInterrupted,
}

/// An action on the comparison of response models.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ComparisonCommand {
    /// Train response models and compare them.
    Start,
    /// Evaluate the current response model alone.
    Evaluate,
    /// Cancel the comparison or the evaluation.
    Cancel,
    /// Read a comparison from a `comparison.json` file.
    Open(PathBuf),
    /// Show the comparison that was read, or why there is none.
    Read(Result<Found<Comparison>, String>),
}

impl Command {
    /// Whether it saves or copies a figure that is not of what is asked any more.
    pub(in crate::app) fn exports_outdated(&self) -> bool {
        match self {
            Self::Ask(Purpose::Save(output)) | Self::Write(output, _) => output.is_outdated(),
            Self::CopyNumbers(figure) => figure.caveats.is_outdated(),
            Self::Film(FilmCommand::Ask(picture, _)) => picture.scene.caveats.is_outdated(),
            _ => false,
        }
    }
}

/// Returns a callback with which another thread requests a new frame of the window.
pub fn wake(context: &Context) -> impl Fn() + Send + 'static {
    let context = context.clone();
    move || context.request_repaint()
}
