//! Opening and closing: data, models, vehicles, scenarios, comparisons.

use std::path::{Path, PathBuf};

use egui::Context;

use crate::app::command::{ComparisonCommand, wake};
use crate::app::dialogs::MODEL_ENDING;
use crate::app::network::Network;
use crate::app::panes::{Pane, show_pane};
use crate::app::source::Source;
use crate::app::state::{State, Subject};
use crate::collision::Scenario;
use crate::data::{ColumnMap, Severity};
use crate::error_chain;
use crate::learning::ModelFile;
use crate::nn::kind_of_file;
use crate::response::ResponseModel;
use crate::study::VehicleChoice;
use crate::vehicle::VehicleParameters;

impl State {
    pub(super) fn open(&mut self, paths: Vec<PathBuf>, context: &Context) {
        for path in paths {
            if path.extension().is_some_and(|ending| ending == "toml") {
                self.open_model(path);
                continue;
            }
            if path.extension().is_some_and(|ending| ending == MODEL_ENDING) {
                self.open_trained(path);
                continue;
            }
            if path.extension().is_some_and(|ending| ending == "json") {
                self.compare(ComparisonCommand::Open(path), context);
                show_pane(&mut self.view.layout, Pane::ModelComparison);
                continue;
            }
            self.load(path, None, context);
        }
    }

    /// Starts to load a data set, a folder of data sets or a file; what was loaded from the path
    /// before is forgotten.
    ///
    /// - `map`: the user's columns of a file, where its header does not say.
    pub(super) fn load(&mut self, path: PathBuf, map: Option<ColumnMap>, context: &Context) {
        self.forget_sources(|source| source.opened == path || source.path == path);
        self.session.select_when_loaded = Some(path.clone());
        let source = Source::load(path, map, &self.session.library, wake(context));
        self.session.sources.push(source);
    }

    /// Closes sources, and lets the library read them again if they are asked about later.
    fn forget_sources(&mut self, is_closed: impl Fn(&Source) -> bool) {
        let session = &mut self.session;
        session.sources.retain(|source| {
            let is_kept = !is_closed(source);
            if !is_kept {
                session.library.forget(&source.path);
                session.replays.remove(&source.path);
            }
            is_kept
        });
        session.force.recorded = None;
    }

    /// Lets every question be asked again, because what it refers to has changed.
    pub(super) fn ask_again(&mut self) {
        let session = &mut self.session;
        session.analysis.ask_again();
        session.force.forecast.ask_again();
        session.response.forecast.ask_again();
    }

    /// Takes a model file for the network that it says it is of.
    fn open_trained(&mut self, path: PathBuf) {
        match kind_of_file(&path).as_deref() {
            Ok(kind) if kind == ResponseModel::KIND.name => {
                self.use_model(Network::Response, Some(path))
            }
            // Says what is wrong with it, if something is.
            Ok(_) => self.use_model(Network::Force, Some(path)),
            Err(error) => self.say(Severity::Error, error_chain(error)),
        }
    }

    /// Uses the model of a file, or the shipped one. A file is read again even if its model is in
    /// use already, and what was asked of it is asked again.
    pub(super) fn use_model(&mut self, network: Network, path: Option<PathBuf>) {
        if let Some(path) = &path {
            self.session.library.forget(path);
            self.session.force.forecast.ask_again();
            self.session.response.forecast.ask_again();
        }
        match network {
            Network::Force => {
                self.project.force.model = path;
                self.session.force.model.reload();
            }
            Network::Response => {
                self.project.response.model = path;
                self.session.response.model.reload();
            }
        }
    }

    /// Lets the model that a cancelled training left answer.
    pub(super) fn use_trained(&mut self, network: Network) {
        match network {
            Network::Force => self.session.force.model.use_trained(),
            Network::Response => self.session.response.model.use_trained(),
        }
    }

    pub(super) fn save_model(&mut self, network: Network, path: PathBuf, context: &Context) {
        let started = match network {
            Network::Force => self.session.force.model.save(path, wake(context)),
            Network::Response => self.session.response.model.save(path, wake(context)),
        };
        if let Err(problem) = started {
            self.say(Severity::Warning, problem);
        }
    }

    /// Tells the user what went wrong, if something did.
    pub(super) fn say_problem(&mut self, problem: Option<String>) {
        if let Some(problem) = problem {
            self.say(Severity::Error, problem);
        }
    }

    /// Tells the user what became of a file that was to be written.
    pub(super) fn say_of_file(&mut self, written: Option<Result<PathBuf, String>>) {
        match written {
            None => {}
            Some(Ok(path)) => self.say(Severity::Info, format!("{} written", path.display())),
            Some(Err(problem)) => self.say(Severity::Error, problem),
        }
    }

    /// Takes a TOML file for a vehicle if it is one, else for a scenario. Such files are small.
    fn open_model(&mut self, path: PathBuf) {
        if let Ok(vehicle) = VehicleParameters::load(&path) {
            self.project.vehicle = VehicleChoice::File(path);
            self.ask_again();
            self.say(Severity::Info, format!("struck vehicle: {}", vehicle.name));
            return;
        }
        match Scenario::load(&path) {
            Ok(scenario) => {
                self.project.scenario = scenario;
                self.select(Subject::Scenario);
            }
            Err(error) => self.say(Severity::Error, error_chain(&error)),
        }
    }

    pub(super) fn close(&mut self, path: &Path) {
        self.forget_sources(|source| source.opened == path || source.path == path);
        let is_open = |open: &Path| self.session.sources.iter().any(|s| s.path == *open);
        let closed = match &self.project.subject {
            Some(Subject::Case { dataset, .. }) => !is_open(dataset),
            Some(Subject::File(file)) => !is_open(file),
            Some(Subject::Scenario) | None => false,
        };
        if closed {
            self.project.subject = None;
        }
    }
}
