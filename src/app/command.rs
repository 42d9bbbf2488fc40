//! What the user can do, and the one place where it is done.

use std::path::PathBuf;

use egui::Context;

use crate::app::dialogs::{FileDialog, MappingDialog, Purpose};
use crate::app::export;
use crate::app::network::Network;
use crate::app::panes::{Pane, default_layout, show_pane};
use crate::app::state::{Session, State, Subject};
use crate::data::{ColumnMap, Severity, write_atomically};
use crate::error_chain;
use crate::figure::Figure;
use crate::study::SimulateAnswer;

/// Step of the arrow keys in the scene, s.
const TIME_STEP_S: f64 = 0.05;

/// Something the user asks for.
#[derive(Debug, Clone)]
pub enum Command {
    /// Open files or folders.
    Open(Vec<PathBuf>),
    /// Close what was opened under this path.
    Close(PathBuf),
    /// Ask for a path.
    Ask(Purpose),
    /// Show and simulate something.
    Select(Subject),
    /// Select the next (1) or previous (−1) case of the list.
    SelectNeighbour(isize),
    /// List the cases of a dataset.
    List(PathBuf),
    /// Ask which column of a file is which.
    AskMapping(PathBuf),
    /// Read a file with the user's columns.
    OpenMapped(PathBuf, ColumnMap),
    /// Close the mapping dialog.
    CancelMapping,
    /// Simulate every case of a dataset.
    ReplayDataset(PathBuf),
    /// Stop simulating a dataset.
    CancelReplay(PathBuf),
    /// Go to a moment, s.
    SetTime(f64),
    /// Go forward by this many small steps; back if negative.
    StepTime(f64),
    /// Let time run, or stop it.
    TogglePlay,
    /// Fit all plots to their data.
    FitPlots,
    /// Write a figure, as PNG or CSV by the path's ending.
    Export(Box<Figure>, PathBuf),
    /// Put a figure's numbers on the clipboard.
    CopyNumbers(Box<Figure>),
    /// Write the scenario to a file.
    SaveScenario(PathBuf),
    /// Predict the force of the selected case.
    PredictCase,
    /// Predict the force of the scenario panel's scenario.
    PredictScenario,
    /// Use the model of this file; without a path the shipped one.
    UseModel(Network, Option<PathBuf>),
    /// Use the model that a cancelled training has left.
    UseTrained(Network),
    /// Write a model to a file.
    SaveModel(Network, PathBuf),
    /// Train a model.
    Train(Network, TrainingCommand),
    /// Compare response models, or evaluate the current one.
    Compare(ComparisonCommand),
    /// Evaluate the force model on a data set.
    Evaluate,
    /// Stop evaluating.
    CancelEvaluation,
    /// Bring a pane to the front.
    Show(Pane),
    /// Bring the training of a network to the front.
    ShowTraining(Network),
    /// Put all panes back.
    ResetLayout,
    /// Tell the user something.
    Say(Severity, String),
    /// Forget the messages.
    DismissMessages,
    /// Go back a step.
    Undo,
    /// Repeat the step that was undone.
    Redo,
}

/// What to do with a training.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TrainingCommand {
    /// Begin.
    Start,
    /// Pause it (`true`), or let it go on.
    Pause(bool),
    /// End it with the weights so far.
    Cancel,
}

/// What to do with a comparison.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ComparisonCommand {
    /// Train response models and compare them.
    Start,
    /// Evaluate the current response model.
    Evaluate,
    /// Stop.
    Cancel,
    /// Read one from a file.
    Open(PathBuf),
    /// Write it into a folder.
    Save(PathBuf),
}

impl State {
    /// Does what was asked for. [`Command::Undo`] and [`Command::Redo`] are the app's, which keeps
    /// the past.
    pub fn apply(&mut self, command: Command, context: &Context) {
        match command {
            Command::Open(paths) => self.open(paths, context),
            Command::Close(path) => self.close(&path),
            Command::Ask(purpose) => self.ask(purpose, context),
            Command::Select(subject) => self.select(subject),
            Command::SelectNeighbour(step) => self.select_neighbour(step),
            Command::List(path) => self.view.listed = Some(path),
            Command::AskMapping(path) => match MappingDialog::open(path) {
                Ok(dialog) => self.session.mapping = Some(dialog),
                Err(error) => self.say(Severity::Error, error_chain(&error)),
            },
            Command::OpenMapped(path, map) => {
                self.session.mapping = None;
                self.load(path, Some(map), context);
            }
            Command::CancelMapping => self.session.mapping = None,
            Command::ReplayDataset(path) => self.replay(path, context),
            Command::CancelReplay(path) => {
                if let Some(replay) = self.session.replays.get(&path) {
                    replay.cancel();
                }
            }
            Command::SetTime(time_s) => self.session.time_s = time_s,
            Command::StepTime(steps) => self.step_time(steps),
            Command::TogglePlay => self.toggle_play(),
            Command::FitPlots => self.session.fit_plots = true,
            Command::Export(figure, path) => {
                match export::spawn(*figure, path, self.view.dark, wake(context)) {
                    Ok(job) => self.session.exports.push(job),
                    Err(error) => self.say(Severity::Error, error.to_string()),
                }
            }
            Command::CopyNumbers(figure) => match export::numbers(&figure) {
                Ok(text) => context.copy_text(text),
                Err(error) => self.say(Severity::Error, error),
            },
            Command::SaveScenario(path) => {
                let text = self.project.scenario.to_toml();
                let written = write_atomically(&path, |out| out.write_all(text.as_bytes()));
                match written {
                    Ok(()) => self.say(Severity::Info, format!("{} written", path.display())),
                    Err(error) => self.say(Severity::Error, error_chain(&error)),
                }
            }
            Command::PredictCase => self.predict_case(),
            Command::PredictScenario => self.predict_scenario(),
            Command::UseModel(network, path) => self.use_model(network, path),
            Command::UseTrained(network) => self.use_trained(network),
            Command::SaveModel(network, path) => self.save_model(network, path, context),
            Command::Train(Network::Force, command) => self.train_force(command, context),
            Command::Train(Network::Response, command) => self.train_response(command, context),
            Command::Compare(command) => self.compare(command, context),
            Command::Evaluate => self.evaluate(context),
            Command::CancelEvaluation => self.session.force.evaluation.cancel(),
            Command::ShowTraining(network) => {
                self.view.trained = network;
                show_pane(&mut self.view.layout, Pane::Training);
            }
            Command::Show(pane) => show_pane(&mut self.view.layout, pane),
            Command::ResetLayout => self.view.layout = default_layout(),
            Command::Say(severity, text) => self.say(severity, text),
            Command::DismissMessages => self.session.messages.clear(),
            Command::Undo | Command::Redo => {}
        }
    }

    fn ask(&mut self, purpose: Purpose, context: &Context) {
        match FileDialog::open(purpose, wake(context)) {
            Ok(dialog) => self.session.file_dialog = Some(dialog),
            Err(error) => self.say(Severity::Error, error.to_string()),
        }
    }

    /// Shows something from its beginning.
    pub(super) fn select(&mut self, subject: Subject) {
        if let Subject::Case { dataset, .. } = &subject {
            self.view.listed = Some(dataset.clone());
        }
        if self.project.subject.as_ref() != Some(&subject) {
            self.project.subject = Some(subject);
            self.session.time_s = 0.0;
            self.session.fit_plots = true;
            if self.view.force.follow_case {
                self.predict_case();
            }
        }
    }

    fn select_neighbour(&mut self, step: isize) {
        let Session { cases, sources, replays, .. } = &self.session;
        let Some(table) = cases.table(sources, replays, &self.view) else { return };
        let current = match &self.project.subject {
            Some(Subject::Case { case, .. }) => table.position(case),
            _ => None,
        };
        let next = match current {
            Some(index) => index.checked_add_signed(step),
            None => Some(0),
        };
        let row = next.and_then(|index| table.row(index));
        if let (Some(row), Some(dataset)) = (row, &self.view.listed) {
            let subject = Subject::Case { dataset: dataset.clone(), case: row.name.to_owned() };
            self.select(subject);
        }
    }

    fn replay(&mut self, path: PathBuf, context: &Context) {
        let question = self.replay_request(path.clone());
        let replay = self.session.replays.entry(path).or_default();
        if let Err(error) = replay.start(question, &self.session.library, wake(context)) {
            self.say(Severity::Error, error.to_string());
        }
    }

    fn step_time(&mut self, steps: f64) {
        let end = self.end_time_s();
        self.session.playing = false;
        self.session.time_s = (self.session.time_s + steps * TIME_STEP_S).clamp(0.0, end);
    }

    fn toggle_play(&mut self) {
        let at_end = self.session.time_s >= self.end_time_s();
        self.session.playing = !self.session.playing;
        if self.session.playing && at_end {
            self.session.time_s = 0.0;
        }
    }

    /// The last moment of what is shown, s.
    pub fn end_time_s(&self) -> f64 {
        let last = |SimulateAnswer { analysis, .. }: &SimulateAnswer| {
            let simulation = analysis.simulation.as_ref().map(|motion| &motion.series);
            let series = simulation.or(analysis.reference.as_ref())?;
            series.time_s().last().copied()
        };
        self.analysis().and_then(last).unwrap_or(0.0)
    }
}

/// Wakes the window from another thread.
pub fn wake(context: &Context) -> impl Fn() + Send + 'static {
    let context = context.clone();
    move || context.request_repaint()
}
