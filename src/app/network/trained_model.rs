//! What the models of both networks have in common in the window.

use std::sync::Arc;

use crate::app::command::Command;
use crate::app::found::Found;
use crate::app::model::ModelEvent;
use crate::app::network::kind::Network;
use impactlab_core::uncertainty::Caveats;
use impactlab_networks::force::ForceModel;
use impactlab_networks::learning::{EpochRecord, EpochSummary, ModelFile};
use impactlab_networks::response::ResponseModel;
use impactlab_study::facts::{
    FactTable, force_model_table, force_settings_table, response_model_table,
    response_settings_table,
};
use impactlab_study::{
    Answer, Library, ModelChoice, ResponseTrainingAnswer, ResponseTrainingReport, StudyError,
    TrainForceAnswer, TrainForceReport,
};

/// A trained model of either network, which can be stored in a file, held in a library and come out
/// of a training.
pub trait TrainedModel: ModelFile + Send + Sync + 'static {
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

    /// Separates the answer of a training into the model and the report.
    fn from_answer(answer: Self::Answer) -> (Self, Self::Report);

    /// Returns the cases that the training left out, each with its reason, and the assumptions of
    /// the training.
    fn notes(report: &Self::Report) -> (&[String], &Caveats);

    /// Returns the duration of a training, s.
    fn seconds(report: &Self::Report) -> f64;

    /// Returns what is known of the model.
    fn facts(&self) -> FactTable;

    /// Returns the settings that are not the usual ones; `None` if all of them are.
    fn settings(&self) -> Option<FactTable>;

    /// Returns the name of the data that the model was trained on.
    fn data(&self) -> &str;

    /// Returns a summary of each epoch of the training.
    fn history(&self) -> Vec<EpochSummary>;

    /// Returns the epoch, from 1, from which the weights were taken; `None` if they are those of
    /// the last epoch.
    fn best_epoch(&self) -> Option<usize>;
}

/// Gives a model the interface.
///
/// - `$read`, `$hold`: how the model is taken from a library and kept there;
/// - `$facts`, `$settings`: what is known of it.
macro_rules! trained_model {
    ($network:ident, $model:ident: $answer:ident, $report:ident, $read:ident, $hold:ident,
        $facts:ident, $settings:ident, $best_epoch:expr) => {
        impl TrainedModel for $model {
            const NETWORK: Network = Network::$network;

            type Answer = $answer;
            type Report = Answer<$report>;

            fn command(event: ModelEvent<Self>) -> Command {
                Command::$model(Found::new(event))
            }

            fn from_library(
                library: &Library,
                choice: &ModelChoice,
            ) -> Result<Arc<Self>, StudyError> {
                library.$read(choice)
            }

            fn hold(library: &Library, choice: ModelChoice, model: Arc<Self>) {
                library.$hold(choice, model);
            }

            fn from_answer(answer: $answer) -> (Self, Self::Report) {
                (answer.model, answer.report)
            }

            fn notes(report: &Self::Report) -> (&[String], &Caveats) {
                (&report.left_out, &report.caveats)
            }

            fn seconds(report: &Self::Report) -> f64 {
                report.seconds
            }

            fn facts(&self) -> FactTable {
                $facts(self)
            }

            fn settings(&self) -> Option<FactTable> {
                $settings(self)
            }

            fn data(&self) -> &str {
                &self.record().data
            }

            fn history(&self) -> Vec<EpochSummary> {
                self.record().history.iter().map(EpochRecord::summary).collect()
            }

            fn best_epoch(&self) -> Option<usize> {
                let best_epoch: fn(&Self) -> Option<usize> = $best_epoch;
                best_epoch(self)
            }
        }
    };
}

trained_model!(Force, ForceModel: TrainForceAnswer, TrainForceReport, force_model,
    hold_force_model, force_model_table, force_settings_table,
    |model| Some(model.record().detail.best_epoch));
trained_model!(Response, ResponseModel: ResponseTrainingAnswer, ResponseTrainingReport,
    response_model, hold_response_model, response_model_table, response_settings_table, |_| None);
