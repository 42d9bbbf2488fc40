//! Opening and closing: data, models, vehicles, scenarios, comparisons.

use std::path::PathBuf;

use egui::Context;

use crate::app::command::{ComparisonCommand, wake};
use crate::app::dialogs::MODEL_ENDING;
use crate::app::network::Network;
use crate::app::panes::{Pane, show_pane};
use crate::app::source::Source;
use crate::app::state::{State, Subject, VehicleChoice};
use crate::collision::Scenario;
use crate::data::Severity;
use crate::error_chain;
use crate::learning::ModelFile;
use crate::nn::kind_of_file;
use crate::response::ResponseModel;
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
            self.session.sources.retain(|source| source.opened != path);
            self.session.look_at = Some(path.clone());
            self.session.sources.push(Source::load(path, wake(context)));
        }
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

    pub(super) fn use_model(&mut self, network: Network, path: Option<PathBuf>) {
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

    pub(super) fn save_model(&mut self, network: Network, path: PathBuf, context: &Context) {
        let started = match network {
            Network::Force => self.session.force.model.save(path, wake(context)),
            Network::Response => self.session.response.model.save(path, wake(context)),
        };
        if let Err(problem) = started {
            self.say(Severity::Warning, problem);
        }
    }

    /// Tells the user what became of a model that was to be opened, and of one that was to be saved.
    pub(super) fn say_of_model(
        &mut self,
        problem: Option<String>,
        saved: Option<Result<PathBuf, String>>,
    ) {
        if let Some(problem) = problem {
            self.say(Severity::Error, problem);
        }
        match saved {
            None => {}
            Some(Ok(path)) => self.say(Severity::Info, format!("{} written", path.display())),
            Some(Err(problem)) => self.say(Severity::Error, problem),
        }
    }

    /// Takes a TOML file for a vehicle if it is one, else for a scenario. Such files are small.
    fn open_model(&mut self, path: PathBuf) {
        if let Ok(vehicle) = VehicleParameters::load(&path) {
            self.project.vehicle = VehicleChoice::File(path);
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

    pub(super) fn close(&mut self, path: &PathBuf) {
        self.session.sources.retain(|source| source.opened != *path && source.path != *path);
        let is_open = |open: &PathBuf| self.session.sources.iter().any(|s| s.path == *open);
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
