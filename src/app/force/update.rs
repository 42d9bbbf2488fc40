//! Background work and commands of the force network.

use std::path::Path;
use std::sync::Arc;

use egui::Context;

use crate::app::archive::{ArchiveEntry, keep_trained};
use crate::app::command::wake;
use crate::app::force::ForceSession;
use crate::app::force::recorded::RecordedCase;
use crate::app::source::Source;
use crate::app::state::{Session, State, Subject};
use impactlab_core::data::{DatasetKind, Severity};
use impactlab_core::error_chain;
use impactlab_networks::force::{ForceCase, ForceScenario};
use impactlab_study::{ForceQuestion, PredictForceAnswer};

/// What is said of a training that was cancelled before there was anything to keep.
pub(in crate::app) const WITHOUT_MODEL: &str = "training cancelled before it had a model";

impl State {
    /// Receives the results of the loader, the training, the evaluation and the forecast, and asks
    /// for a new forecast if the question has changed.
    pub(in crate::app) fn update_force(&mut self, context: &Context) {
        let Session { force, library, tasks, .. } = &mut self.session;
        force.model.update(&self.project.predict_force.model, library, tasks);
        self.find_recorded_case();
        self.poll_training();
        if self.session.force.evaluation.poll() {
            self.keep_force_evaluation();
        }
        self.session.force.forecast.poll();
        self.ask_for_force(context);
    }

    fn poll_training(&mut self) {
        let was_running = self.session.force.training.run.is_running();
        let may_be_used = self.takes_trained(self.session.force.training.n_cases);
        let Session { force, library, archive, tasks, .. } = &mut self.session;
        match force.training.poll() {
            None => {}
            Some(Ok((model, is_complete))) => {
                let record = model.record();
                let name =
                    format!("trained on {}, epoch {}", record.data, record.detail.best_epoch);
                let of = format!("{name}, the best of {}", record.history.len());
                let draft = force.training.archive_note(&model, name.clone(), is_complete);
                let used =
                    (is_complete && may_be_used).then_some(&mut self.project.predict_force.model);
                let taken = force.model.take_trained(model, name, library, used);
                let draft = draft.map(|draft| ArchiveEntry { name: taken.1, ..draft });
                let ForceSession { model: status, training, .. } = force;
                keep_trained(status, training, taken.0, draft, archive.folder(), tasks);
                let (reached, n_cases) = (training.reached(), training.n_cases);
                self.say_of_training(&of, is_complete, reached, n_cases);
            }
            Some(Err(problem)) => self.say(Severity::Error, format!("training: {problem}")),
        }
        let training = &self.session.force.training;
        if was_running && !training.run.is_running() {
            if training.has_no_model() {
                self.say(Severity::Info, WITHOUT_MODEL);
            }
            self.read_unfinished();
        }
    }

    /// Whether the network of a completed training is put into use by itself: not where it would change the
    /// answers about a scenario, or of a case that was opened meanwhile, which were asked with another one.
    ///
    /// - `n_cases`: that of the training.
    pub(in crate::app) fn takes_trained(&self, n_cases: u64) -> bool {
        self.project.subject() != Some(Subject::Scenario) && n_cases == self.session.n_cases
    }

    /// Tells the user that a training has ended.
    ///
    /// - `name`: description of the trained model;
    /// - `is_complete`: whether the training was completed; otherwise it was cancelled;
    /// - `reached`: how far it had got;
    /// - `n_cases`: that of the training.
    pub(in crate::app) fn say_of_training(
        &mut self,
        name: &str,
        is_complete: bool,
        reached: Option<String>,
        n_cases: u64,
    ) {
        let text = match is_complete {
            true if self.takes_trained(n_cases) => {
                format!("training over: {name}, which is in use now")
            }
            true if n_cases != self.session.n_cases => format!(
                "training over: {name}, which changes no answer of this case, opened meanwhile, until \
                 it is put into use (Training, or Models)"
            ),
            true => format!(
                "training over: {name}, which changes no answer about the scenario until it is put \
                 into use (Training, or Models)"
            ),
            false => {
                let at = reached.map_or(String::new(), |reached| format!(" ({reached})"));
                format!("training cancelled{at}: {name}, which is not in use")
            }
        };
        self.say(Severity::Info, text);
    }

    /// Asks for the force of the collision, if the question has changed. What was predicted before is dropped
    /// where nothing can be asked: it is of another collision.
    fn ask_for_force(&mut self, context: &Context) {
        let Some(question) = self.force_request() else {
            self.session.force.forecast.drop_answer();
            return;
        };
        let (force, library) = (&mut self.session.force, &self.session.library);
        force.forecast.ask(question, library, wake(context));
    }

    /// Finds the recorded force of the selected case, if a case is selected and it is not the one
    /// found before.
    fn find_recorded_case(&mut self) {
        let Some(Subject::Case { dataset, case }) = &self.project.subject() else {
            self.session.force.recorded = None;
            return;
        };
        let recorded = &self.session.force.recorded;
        if recorded.as_ref().is_some_and(|r| r.dataset == *dataset && r.case == *case) {
            return;
        }
        self.session.force.recorded = force_case(&self.session.sources, dataset, case);
    }

    /// Takes the collision of the selected case into the force prediction, if the case has a
    /// recorded force.
    pub(in crate::app) fn predict_case(&mut self) {
        self.find_recorded_case();
        if let Some(recorded) = &self.session.force.recorded {
            let (dataset, case) = (recorded.dataset.clone(), recorded.case.clone());
            self.project.predict_force.collision = ForceQuestion::Case { dataset, case };
            self.session.fit_plots = true;
        }
    }

    /// Takes the collision of the scenario pane into the force prediction.
    pub(in crate::app) fn predict_scenario(&mut self) {
        match self.project.scenario().map(ForceScenario::from_scenario) {
            Some(Err(error)) => self.say(Severity::Error, error_chain(&error)),
            Some(Ok(_)) | None => {
                let scenario = self.project.impact.scenario.clone();
                self.project.predict_force.collision = ForceQuestion::Scenario(scenario);
                self.session.fit_plots = true;
            }
        }
    }

    /// Starts an evaluation of the current force model on the chosen data set.
    pub(in crate::app) fn evaluate(&mut self, context: &Context) {
        let Some(request) = self.evaluate_force_request() else {
            self.say(Severity::Warning, "an evaluation needs a force model and a force data set");
            return;
        };
        let (force, library) = (&mut self.session.force, &self.session.library);
        if let Err(error) = force.evaluation.start(request, library, wake(context)) {
            self.say(Severity::Error, error.to_string());
        }
    }

    /// Returns the latest predicted force, if there is one. While a newer one is awaited, it
    /// belongs to an earlier question.
    pub fn force_forecast(&self) -> Option<&PredictForceAnswer> {
        self.session.force.forecast.ok().map(Arc::as_ref)
    }
}

/// Returns the case of an open force data set with its recorded force; `None` if it is not open or
/// cannot be used.
fn force_case(sources: &[Source], path: &Path, name: &str) -> Option<RecordedCase> {
    let source = sources.iter().find(|source| source.path == path)?;
    let checked = source.dataset().filter(|c| c.dataset.kind == DatasetKind::Force)?;
    let case = checked.dataset.case(name)?;
    let canonical = ForceCase::from_case(case).ok()?;
    Some(RecordedCase {
        dataset: path.to_owned(),
        case: name.to_owned(),
        scenario: ForceScenario::from_case(case).ok()?,
        curve: canonical.as_recorded(&canonical.curve),
        canonical,
    })
}
