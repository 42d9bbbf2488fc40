//! What the models of both networks have in common in the window.

use std::path::Path;
use std::sync::Arc;

use crate::app::archive::{Fact, differences};
use crate::app::command::Command;
use crate::app::found::Found;
use crate::app::model::ModelEvent;
use crate::app::network::kind::Network;
use impactlab_core::data::Existing;
use impactlab_core::error_chain;
use impactlab_core::uncertainty::Caveats;
use impactlab_core::units::significant;
use impactlab_networks::force::{ForceConfig, ForceModel};
use impactlab_networks::learning::{EpochRecord, EpochSummary, ModelFile};
use impactlab_networks::response::{ResponseConfig, ResponseModel};
use impactlab_study::{
    Answer, Library, ModelChoice, ResponseTrainingAnswer, ResponseTrainingReport, StudyError,
    TrainForceAnswer, TrainForceReport,
};

/// A trained model of either network, which can be stored in a file, held in a library and come out
/// of a training.
pub trait TrainedModel: Sized + Send + Sync + 'static {
    /// The network that the model belongs to.
    const NETWORK: Network;

    /// The answer of a training of this network, which contains the model.
    type Answer: Send + 'static;

    /// The report of a training of this network.
    type Report;

    /// The command that hands over what a task has made of a model.
    fn command(event: ModelEvent<Self>) -> Command;

    /// Returns the model to which questions refer by `choice`; it is read from its file if it is
    /// not in memory.
    ///
    /// # Errors
    /// [`StudyError`] if the model cannot be read.
    fn from_library(library: &Library, choice: &ModelChoice) -> Result<Arc<Self>, StudyError>;

    /// Keeps the model in the library, where questions refer to it by `choice`.
    fn hold(library: &Library, choice: ModelChoice, model: Arc<Self>);

    /// Writes the model to a file.
    ///
    /// - `existing`: what happens to a file that exists already.
    ///
    /// # Errors
    /// A message for the user, if the file cannot be written.
    fn write(&self, path: &Path, existing: Existing) -> Result<(), String>;

    /// Separates the answer of a training into the model and the report.
    fn from_answer(answer: Self::Answer) -> (Self, Self::Report);

    /// Returns the cases that the training left out, each with its reason, and the assumptions of
    /// the training.
    fn notes(report: &Self::Report) -> (&[String], &Caveats);

    /// Returns the duration of a training, s.
    fn seconds(report: &Self::Report) -> f64;

    /// Returns the SHA-256 of the file that [`write`](Self::write) writes, hexadecimal.
    ///
    /// # Errors
    /// A message for the user, if the content of the file cannot be made.
    fn digest(&self) -> Result<String, String>;

    /// Returns what is known of the training in numbers.
    fn facts(&self) -> Vec<Fact>;

    /// Returns the settings that are not the usual ones.
    fn settings(&self) -> Vec<Fact>;

    /// Returns the name of the data that the model was trained on.
    fn data(&self) -> &str;

    /// Returns a summary of each epoch of the training.
    fn history(&self) -> Vec<EpochSummary>;

    /// Returns the epoch, from 1, from which the weights were taken; `None` if they are those of
    /// the last epoch.
    fn best_epoch(&self) -> Option<usize>;
}

impl TrainedModel for ForceModel {
    const NETWORK: Network = Network::Force;

    type Answer = TrainForceAnswer;
    type Report = Answer<TrainForceReport>;

    fn command(event: ModelEvent<Self>) -> Command {
        Command::ForceModel(Found::new(event))
    }

    fn from_library(library: &Library, choice: &ModelChoice) -> Result<Arc<Self>, StudyError> {
        library.force_model(choice)
    }

    fn hold(library: &Library, choice: ModelChoice, model: Arc<Self>) {
        library.hold_force_model(choice, model);
    }

    fn write(&self, path: &Path, existing: Existing) -> Result<(), String> {
        self.save(path, existing).map_err(|error| error_chain(&error))
    }

    fn from_answer(answer: TrainForceAnswer) -> (Self, Self::Report) {
        (answer.model, answer.report)
    }

    fn notes(report: &Self::Report) -> (&[String], &Caveats) {
        (&report.left_out, &report.caveats)
    }

    fn seconds(report: &Self::Report) -> f64 {
        report.seconds
    }

    fn digest(&self) -> Result<String, String> {
        self.sha256().map_err(|error| error_chain(&error))
    }

    fn facts(&self) -> Vec<Fact> {
        let record = self.record();
        let (n_train, n_validation) = (record.train.len(), record.detail.validation.len());
        let best = record.detail.best_epoch.checked_sub(1).and_then(|idx| record.history.get(idx));
        let loss = best
            .map(|epoch| Fact::new("Validation loss", significant(epoch.detail.validation.total)));
        let mut facts = vec![
            Fact::new("Cases learned from", n_train),
            Fact::new("Cases for validation", n_validation),
            Fact::new("Cases kept for the test", record.test.len()),
            Fact::new(
                "Best epoch",
                format!("{} of {}", record.detail.best_epoch, record.history.len()),
            ),
        ];
        facts.extend(loss);
        facts.push(Fact::new("Weights", self.n_parameters()));
        facts.push(Fact::new("Seed", record.seed));
        facts.push(Fact::new("Program", &record.version));
        facts
    }

    fn settings(&self) -> Vec<Fact> {
        differences(self.config(), &ForceConfig::default())
    }

    fn data(&self) -> &str {
        &self.record().data
    }

    fn history(&self) -> Vec<EpochSummary> {
        self.record().history.iter().map(EpochRecord::summary).collect()
    }

    fn best_epoch(&self) -> Option<usize> {
        Some(self.record().detail.best_epoch)
    }
}

impl TrainedModel for ResponseModel {
    const NETWORK: Network = Network::Response;

    type Answer = ResponseTrainingAnswer;
    type Report = Answer<ResponseTrainingReport>;

    fn command(event: ModelEvent<Self>) -> Command {
        Command::ResponseModel(Found::new(event))
    }

    fn from_library(library: &Library, choice: &ModelChoice) -> Result<Arc<Self>, StudyError> {
        library.response_model(choice)
    }

    fn hold(library: &Library, choice: ModelChoice, model: Arc<Self>) {
        library.hold_response_model(choice, model);
    }

    fn write(&self, path: &Path, existing: Existing) -> Result<(), String> {
        self.save(path, existing).map_err(|error| error_chain(&error))
    }

    fn from_answer(answer: ResponseTrainingAnswer) -> (Self, Self::Report) {
        (answer.model, answer.report)
    }

    fn notes(report: &Self::Report) -> (&[String], &Caveats) {
        (&report.left_out, &report.caveats)
    }

    fn seconds(report: &Self::Report) -> f64 {
        report.seconds
    }

    fn digest(&self) -> Result<String, String> {
        self.sha256().map_err(|error| error_chain(&error))
    }

    fn facts(&self) -> Vec<Fact> {
        let record = self.record();
        let mut facts = vec![
            Fact::new("Simulations learned from", record.detail.n_simulated),
            Fact::new("Trajectories learned from", record.train.len()),
            Fact::new("Trajectories kept for the test", record.test.len()),
        ];
        // What is uncertain is known of a fleet by its cars, of a single car by its trajectories.
        facts.push(match (self.population(), self.latents().n_calibrated) {
            (Some(population), _) => Fact::new("Cars that it knows", population.cars().len()),
            (None, 0) => Fact::new("Uncertainty", "not calibrated"),
            (None, n) if record.detail.keeps_latents => {
                Fact::new("Uncertainty calibrated on", format!("{n} trajectories, model before"))
            }
            (None, n) => Fact::new("Uncertainty calibrated on", format!("{n} trajectories")),
        });
        facts.push(Fact::new("Epochs", record.history.len()));
        let last = record.history.last().map(|epoch| significant(epoch.detail.loss.total));
        facts.extend(last.map(|loss| Fact::new("Last loss", loss)));
        facts.push(Fact::new("Weights", self.n_parameters()));
        facts.push(Fact::new("Seed", record.seed));
        facts.push(Fact::new("Program", &record.version));
        facts
    }

    fn settings(&self) -> Vec<Fact> {
        differences(self.config(), &ResponseConfig::default())
    }

    fn data(&self) -> &str {
        &self.record().data
    }

    fn history(&self) -> Vec<EpochSummary> {
        self.record().history.iter().map(EpochRecord::summary).collect()
    }

    fn best_epoch(&self) -> Option<usize> {
        None
    }
}
