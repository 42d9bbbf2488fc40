//! [`State::apply`], the one function that carries out commands.

use std::path::{Path, PathBuf};

use egui::Context;

use crate::app::command::{Command, wake};
use crate::app::dialog::{Dialog, PathDialog, Purpose, ask_for_path};
use crate::app::export;
use crate::app::found::Found;
use crate::app::panes::Pane;
use crate::app::state::{Session, State, Subject};
use crate::app::widgets::OUTDATED;
use crate::app::workspaces::Workspace;
use impactlab_core::data::{Existing, Severity};

impl State {
    /// Carries out a command.
    ///
    /// [`Command::Undo`] and [`Command::Redo`] do nothing here: [`App`](crate::app::App) carries
    /// them out, because it keeps the history of the project.
    pub fn apply(&mut self, command: Command, context: &Context) {
        match command {
            Command::Open(paths) => self.open(paths, context),
            Command::Close(path) => self.close(&path),
            command if command.exports_outdated() => self.say(Severity::Warning, OUTDATED),
            Command::Ask(purpose) => self.ask(purpose),
            Command::Select(subject) => self.select(subject),
            Command::SelectNeighbour(step) => self.select_neighbour(step),
            Command::List(path) => self.view.listed = Some(path),
            Command::AskMapping(path) => self.ask_mapping(path),
            Command::OpenMapped(path, map) => {
                self.keep_said(&path);
                self.end_mapping();
                self.load(path, Some(map));
            }
            Command::CloseDialog => self.close_dialog(),
            Command::ReplayDataset(path) => self.replay(path, context),
            Command::CancelReplay(path) => self.cancel_replay(&path),
            Command::Case(command) => self.change_case(command, context),
            Command::Variant(command) => self.change_variant(command),
            Command::AskPath(purpose) => self.ask_path(purpose),
            Command::Write(output, path) => self.write(output, path, Existing::Refuse),
            Command::Replace(output, path) => self.write(output, path, Existing::Replace),
            Command::CopyNumbers(figure) => match export::numbers(&figure) {
                Ok(text) => context.copy_text(text),
                Err(error) => self.say(Severity::Error, error),
            },
            Command::Film(command) => self.film(command),
            Command::ForceModel(event) => self.take_force_model(&event),
            Command::ResponseModel(event) => self.take_response_model(&event),
            Command::Archive(event) => self.take_archive_event(event.take(), context),
            Command::DeclineOffer => self.session.offered = None,
            Command::ChooseVehicle(role, choice) => self.choose_vehicle(role, *choice),
            Command::PredictCase => self.predict_case(),
            Command::PredictScenario => self.predict_scenario(),
            Command::UseModel(network, path) => self.use_model(network, path),
            Command::UseTrained(network) => self.use_trained(network),
            Command::Train(network, command) => self.train(network, command, context),
            Command::Compare(command) => self.compare(command, context),
            Command::Models(command) => self.change_models(command, context),
            Command::Evaluate => self.evaluate(context),
            Command::CancelEvaluation => self.session.force.evaluation.cancel(),
            Command::Ground(command) => self.change_ground(command),
            Command::Reconstruct(command) => self.reconstruct(command, context),
            Command::CrashTest(command) => self.take_crash_test(command),
            Command::Recorder(command) => self.take_recorder(command, context),
            Command::Report(command) => self.report(command),
            Command::Atlas(command) => self.change_atlas(command),
            Command::Sweep(command) => self.sweep(command),
            Command::Opened(path, result) => self.take_opened(&path, result),
            Command::Written(result) => self.say_of_file(result),
            Command::ImportRead(path, result) => {
                let dialog = self.session.dialogs.import_mut();
                if let Some(dialog) = dialog.filter(|dialog| dialog.path() == path) {
                    dialog.receive(result.map(Found::take));
                }
            }
            Command::Measured(place, question, result) => {
                self.session.costs.take(place, *question, result);
            }
            Command::ShowLicences => self.session.dialogs.open(Dialog::Licences),
            Command::Playback(command) => self.play(command),
            Command::FitPlots => self.session.fit_plots = true,
            Command::ShowTraining(network) => {
                self.view.trained = network;
                self.view.workspaces.show_pane(Pane::Training);
            }
            Command::ShowDoors => self.session.shows_doors = true,
            Command::Show(pane) => {
                self.session.shows_doors = false;
                self.view.workspaces.show_pane(pane);
            }
            Command::ResetLayout => self.view.workspaces.reset_shown(),
            Command::ShowWorkspace(workspace) => self.show_workspace(workspace),
            Command::Say(severity, text) => self.say(severity, text),
            Command::DismissMessage => drop(self.session.messages.pop()),
            Command::ShowMessages => self.session.dialogs.open(Dialog::Messages),
            Command::Undo | Command::Redo => {}
        }
    }

    fn show_workspace(&mut self, workspace: Workspace) {
        self.view.workspaces.shown = workspace;
        self.session.shows_doors = false;
    }

    fn ask_path(&mut self, purpose: Purpose) {
        self.session.dialogs.open(Dialog::Path(PathDialog::new(purpose)));
    }

    /// Asks for a path with a dialog of the desktop.
    pub(super) fn ask(&mut self, purpose: Purpose) {
        ask_for_path(purpose, &mut self.session.tasks);
    }

    /// Selects a subject and shows it from time zero. Selecting the current subject again changes
    /// nothing but the listed data set. The force of the case is predicted if the view follows the
    /// selected case.
    pub(super) fn select(&mut self, subject: Subject) {
        self.session.offered = None;
        if let Subject::Case { dataset, .. } = &subject {
            self.view.listed = Some(dataset.clone());
        }
        let before = self.project.subject();
        if before.as_ref() != Some(&subject) {
            self.project.put_aside(self.takes_ending(before.as_ref()));
            let takes_ending = self.takes_ending(Some(&subject));
            let said = match &subject {
                Subject::File(path) => self.session.said_of_files.remove(path),
                _ => None,
            };
            self.project.take_up(self.source_of(subject), takes_ending);
            if let Some(said) = said {
                self.take_said(said);
            }
            self.drop_answers();
            self.session.playback.time_s = 0.0;
            self.session.fit_plots = true;
            if self.view.force.follow_case {
                self.predict_case();
            }
        }
    }

    fn select_neighbour(&mut self, step: isize) {
        let Session { cases, sources, replays, .. } = &self.session;
        let Some(table) = cases.table(sources, replays, &self.view) else { return };
        let current = match &self.project.subject() {
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

    fn cancel_replay(&self, path: &Path) {
        if let Some(replay) = self.session.replays.get(path) {
            replay.cancel();
        }
    }
}
