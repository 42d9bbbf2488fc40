//! Opens and closes data, models, vehicles, scenarios and comparisons, and saves models.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::Context;

use crate::app::atlas::AtlasCommand;
use crate::app::case::Leaving;
use crate::app::command::{Command, ComparisonCommand};
use crate::app::dialog::Dialog;
use crate::app::found::Found;
use crate::app::import::ImportDialog;
use crate::app::network::Network;
use crate::app::panes::Pane;
use crate::app::question_job::QuestionJob;
use crate::app::response::MotionQuestion;
use crate::app::source::{Content, Source, read_source};
use crate::app::state::{Session, State, Subject};
use crate::app::sweep::SweepCommand;
use crate::app::tasks::TaskKey;
use crate::app::vehicles::ChosenVehicles;
use crate::app::widgets::name_in_units;
use crate::app::workspaces::Workspace;
use impactlab_core::collision::Role;
use impactlab_core::data::{ColumnMap, CrashTest, Existing, RecorderRecord, Severity};
use impactlab_networks::learning::ModelFile;
use impactlab_networks::response::ResponseModel;
use impactlab_study::{
    InputFile, InputKind, ModelChoice, ReconstructRequest, Request, ScenarioChoice,
    SimulateRequest, VehicleChoice,
};

/// Whether it is asked of a file, when a person opens it, what becomes of it beside a table.
pub(super) fn is_asked_about(path: &Path) -> bool {
    path.is_file() && (CrashTest::is_test(path) || RecorderRecord::is_record(path))
}

impl State {
    /// Opens paths as what they hold: a case, a ground, evidence, a vehicle, a scenario, a model, a
    /// comparison, an atlas, the plan of a sweep or data. A folder is shown in the Data workspace, where its cases are chosen.
    pub(super) fn open(&mut self, paths: Vec<PathBuf>, context: &Context) {
        for path in paths {
            // So that it leads there from every folder that the program is started in.
            let path = std::path::absolute(&path).unwrap_or(path);
            self.session.n_reopened += u64::from(self.files_in_use().contains(&path));
            match InputKind::from_path(&path) {
                InputKind::Case => self.leave(Leaving::Open(path), context),
                InputKind::Site | InputKind::Orthophoto | InputKind::Survey => {
                    self.open_ground(path);
                }
                InputKind::PointCloud => self.ask_cloud(path),
                InputKind::Comparison => {
                    self.compare(ComparisonCommand::Open(path), context);
                    self.view.workspaces.show_pane(Pane::ModelComparison);
                }
                InputKind::Atlas => self.change_atlas(AtlasCommand::Show(Some(path))),
                InputKind::Plan => self.sweep(SweepCommand::OpenPlan(path)),
                kind @ (InputKind::Evidence
                | InputKind::Vehicle
                | InputKind::Scenario
                | InputKind::Network
                | InputKind::Pairs
                | InputKind::Request
                | InputKind::Checkpoint
                | InputKind::Settings
                | InputKind::UnknownToml) => self.open_file(path, kind),
                InputKind::Series if CrashTest::is_test(&path) => self.read_crash_test(path),
                InputKind::Series if RecorderRecord::is_record(&path) => self.ask_recorder(path),
                InputKind::Dataset | InputKind::Folder | InputKind::Series => {
                    if path.is_dir() && self.view.workspaces.shown == Workspace::Case {
                        // Where a case of it is chosen.
                        self.view.workspaces.shown = Workspace::Data;
                    }
                    self.session.shows_doors = false;
                    self.load(path, None);
                }
            }
        }
    }

    /// Reads a small file and puts it into use. It is read on the window's thread.
    fn open_file(&mut self, path: PathBuf, kind: InputKind) {
        match InputFile::load_as(&path, kind) {
            Ok(InputFile::Evidence(evidence)) => self.open_evidence(path, *evidence),
            Ok(InputFile::Vehicle(vehicle)) => {
                let name = name_in_units(&vehicle.name, self.view.units);
                self.say(Severity::Info, format!("struck vehicle: {name}"));
                let choice = VehicleChoice::File(path);
                // An answer is of what the file said before.
                let of_it = |of: &ReconstructRequest| of.vehicle == choice || of.striking == choice;
                if self.project.reconstruct.as_ref().is_some_and(of_it) {
                    self.drop_reconstruction();
                }
                if self.project.replay.as_ref().is_some_and(|of| of.vehicle == choice) {
                    self.session.recorder_replay = QuestionJob::default();
                }
                self.choose_vehicle(Role::Struck, choice);
            }
            Ok(InputFile::Scenario(scenario)) => {
                for role in Role::ALL {
                    // It says itself which vehicle it is about.
                    if scenario.vehicle_name(role).is_some() {
                        *self.project.vehicle_mut(role) = VehicleChoice::Automatic;
                    }
                }
                self.project.impact.scenario = ScenarioChoice::Inline(scenario);
                self.select(Subject::Scenario);
            }
            Ok(InputFile::Network(kind)) if kind == ResponseModel::KIND.name => {
                self.use_model(Network::Response, Some(path));
            }
            // A file of an unknown kind goes to the loader as well, which reports what is wrong with it.
            Ok(InputFile::Network(_)) => self.use_model(Network::Force, Some(path)),
            Ok(InputFile::Pairs(_)) => {
                let command = kind.command().unwrap_or_default();
                let text = format!("{}: {kind}; use {command}", path.display());
                self.say(Severity::Warning, text);
            }
            Ok(_) => {
                let text = format!("{}: {kind} is chosen where it is used", path.display());
                self.say(Severity::Warning, text);
            }
            Err(error) => self.say(Severity::Error, error.to_string()),
        }
    }

    /// Starts to load a data set, a folder of data sets or a data file. Sources that were loaded
    /// from the same path before are closed.
    ///
    /// - `map`: the columns that the user has assigned, for a file whose header does not identify
    ///   them.
    pub(super) fn load(&mut self, path: PathBuf, map: Option<ColumnMap>) {
        self.forget_sources(|source| source.opened == path || source.path == path);
        self.session.select_when_loaded = Some(path.clone());
        // Why it could not be read before is out of date.
        let of_path = path.display().to_string();
        self.session.messages.retain(|message| !message.text.starts_with(&of_path));
        self.session.sources.push(Source::loading(path.clone(), map.clone()));
        let (maps, library) = (self.view.column_maps.clone(), Arc::clone(&self.session.library));
        let (key, opened) = (TaskKey::Load(path.clone()), path.clone());
        self.session.tasks.start(
            key,
            move |report| {
                let found = read_source(&path, map, &maps, &library, report)?;
                Ok(found.map(Found::new))
            },
            |result| Command::Opened(opened, result),
        );
    }

    /// Asks how a file is to be read; if a dialog is open that asks that, after it.
    pub(super) fn ask_mapping(&mut self, path: PathBuf) {
        let dialogs = &mut self.session.dialogs;
        if dialogs.import().is_some() {
            if !dialogs.to_import.contains(&path) {
                dialogs.to_import.push_back(path);
            }
            return;
        }
        let source = self.session.sources.iter().find(|source| source.path == path);
        let map = source.and_then(|source| source.map.clone());
        let said = (!self.asks_about_file(&path)).then(|| self.said_now());
        let dialog = ImportDialog::open(path, map, said);
        self.session.dialogs.open(Dialog::Import(Box::new(dialog)));
    }

    /// Closes the dialog and asks about the next file that waits.
    pub(super) fn end_mapping(&mut self) {
        self.session.dialogs.close_if(|dialog| matches!(dialog, Dialog::Import(_)));
        if let Some(next) = self.session.dialogs.to_import.pop_front() {
            self.ask_mapping(next);
        }
    }

    /// Closes the uppermost dialog. A file that it asked about and that could not be opened otherwise leaves
    /// nothing behind: no entry, no message, and it is not tried again when the program is started next.
    pub(super) fn close_dialog(&mut self) {
        let Some(Dialog::Import(dialog)) = self.session.dialogs.close() else { return };
        let path = dialog.path();
        self.forget_sources(|source| {
            source.path == path && matches!(source.content, Content::Failed(_))
        });
        if !self.session.sources.iter().any(|source| source.path == path) {
            let of_path = path.display().to_string();
            self.session.messages.retain(|message| !message.text.starts_with(&of_path));
        }
        self.end_mapping();
    }

    /// Closes the sources for which `is_closed` holds, together with their simulations, and removes
    /// their data from the library, so that a later question reads them again.
    fn forget_sources(&mut self, is_closed: impl Fn(&Source) -> bool) {
        let session = &mut self.session;
        session.sources.retain(|source| {
            let is_open = !is_closed(source);
            if !is_open {
                session.library.forget(&source.path);
                session.replays.remove(&source.path);
                session.tasks.stop(&TaskKey::Load(source.opened.clone()));
            }
            is_open
        });
        session.force.recorded = None;
    }

    /// Lets the files of a case that takes the place of another be read again: they may have been changed since
    /// they were read for that. Data sets and networks, which take long, stay as they were read.
    pub(super) fn forget_files_of_case(&mut self) {
        let files = self.case.file.input_files();
        let is_single = |of: &Source| matches!(of.content, Content::File(_) | Content::Failed(_));
        self.forget_sources(|source| is_single(source) && files.contains(&source.path));
        let questions = self.case.file.variants.iter().flat_map(|variant| &variant.questions);
        for file in questions.flat_map(Request::input_files) {
            self.session.library.forget(&file);
        }
        self.drop_reconstruction();
        let session = &mut self.session;
        session.reconstruction.file = None;
        session.recorder_replay = QuestionJob::default();
        session.chosen_vehicles = ChosenVehicles::default();
        session.ground.forget();
    }

    /// Allows every question to be asked again, because the data that it refers to have changed.
    pub(super) fn ask_again(&mut self) {
        let session = &mut self.session;
        session.analysis.ask_again();
        session.force.forecast.ask_again();
        session.response.forecast.ask_again();
        session.other_variants.clear();
    }

    /// Allows those questions to be asked again that name one of these paths or what lies in them, because that
    /// has been read anew. The answers to all others stand.
    pub(super) fn ask_again_about(&mut self, paths: &[PathBuf]) {
        let is_read = |named: &PathBuf| paths.iter().any(|path| named.starts_with(path));
        let names = |request: Request| request.named_paths().iter().any(is_read);
        let is_of = |question: &Option<SimulateRequest>| {
            question.clone().is_some_and(|question| names(question.into()))
        };
        let is_of_motion = |question: &Option<MotionQuestion>| {
            question.clone().is_some_and(|question| names(question.request.into()))
        };
        let Session { analysis, force, response, other_variants, .. } = &mut self.session;
        if is_of(&analysis.question) {
            analysis.ask_again();
        }
        if force.forecast.question.clone().is_some_and(|question| names(question.into())) {
            force.forecast.ask_again();
        }
        if is_of_motion(&response.forecast.question) {
            response.forecast.ask_again();
        }
        other_variants.retain(|_, answers| {
            !is_of(&answers.simulation.question) && !is_of_motion(&answers.forecast.question)
        });
    }

    /// Drops the answers about the subject that was selected, so that none of them is shown for another.
    pub(super) fn drop_answers(&mut self) {
        let session = &mut self.session;
        session.analysis.drop_answer();
        session.response.forecast.drop_answer();
    }

    /// Uses the model of a file; `None` is the shipped one. A file is read again even if its model
    /// is in use already, and the forecasts that depend on it are asked again.
    pub(super) fn use_model(&mut self, network: Network, path: Option<PathBuf>) {
        if let Some(path) = &path {
            self.session.library.forget(path);
            self.session.force.forecast.ask_again();
            self.session.response.forecast.ask_again();
            self.session.other_variants.clear();
        }
        let choice = path.map_or_else(ModelChoice::default, ModelChoice::file);
        match network {
            Network::Force => {
                self.project.predict_force.model = choice;
                self.session.force.model.reload();
            }
            Network::Response => {
                self.project.predict_motion.response_model = choice;
                self.session.response.model.reload();
            }
        }
    }

    /// Puts the model of the last training, which was set aside, into use.
    pub(super) fn use_trained(&mut self, network: Network) {
        match network {
            Network::Force => {
                self.session.force.model.use_trained(&mut self.project.predict_force.model);
            }
            Network::Response => {
                let wanted = &mut self.project.predict_motion.response_model;
                self.session.response.model.use_trained(wanted);
            }
        }
    }

    /// Starts writing the current model of a network to a file, or tells the user why that is not
    /// possible.
    pub(super) fn save_model(&mut self, network: Network, path: PathBuf, existing: Existing) {
        let Session { force, response, tasks, .. } = &mut self.session;
        let started = match network {
            Network::Force => force.model.save(path, existing, tasks),
            Network::Response => response.model.save(path, existing, tasks),
        };
        if let Err(problem) = started {
            self.say(Severity::Warning, problem);
        }
    }

    /// Shows a problem to the user, if there is one.
    pub(super) fn say_problem(&mut self, problem: Option<String>) {
        if let Some(problem) = problem {
            self.say(Severity::Error, problem);
        }
    }

    /// Closes the sources of a path. If the subject belongs to them, nothing is selected
    /// afterwards.
    pub(super) fn close(&mut self, path: &Path) {
        self.forget_sources(|source| source.opened == path || source.path == path);
        self.session.said_of_files.remove(path);
        let is_open = |open: &Path| self.session.sources.iter().any(|s| s.path == *open);
        let subject = self.project.subject();
        let closed = match &subject {
            Some(Subject::Case { dataset, .. }) => !is_open(dataset),
            Some(Subject::File(file)) => !is_open(file),
            Some(Subject::Scenario | Subject::Manoeuvre) | None => false,
        };
        if closed {
            self.project.put_aside(self.takes_ending(subject.as_ref()));
        }
    }
}
