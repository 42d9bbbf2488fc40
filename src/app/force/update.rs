//! What happens between frames, and what the user asks for, about the force network.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::Context;

use crate::app::command::{TrainingCommand, wake};
use crate::app::source::{OpenDataset, Source, chosen_dataset, open_datasets};
use crate::app::state::{State, Subject};
use crate::data::{DatasetKind, Severity};
use crate::error_chain;
use crate::force::{ForceCase, ForceScenario};
use crate::study::PredictForceAnswer;
use crate::uncertainty::ForceCurve;

/// The force that was recorded in the selected case, in the case's own axes.
pub struct RecordedCase {
    dataset: PathBuf,
    /// Name of the case.
    pub case: String,
    /// What was known before it.
    pub scenario: ForceScenario,
    /// The force.
    pub curve: ForceCurve,
    /// As models see it.
    pub canonical: ForceCase,
}

impl State {
    /// Takes in what loader, predictor and training report, and asks for what is due.
    pub(in crate::app) fn update_force(&mut self, context: &Context) {
        let (force, library) = (&mut self.session.force, &self.session.library);
        let problem = force.model.update(&self.project.force.model, library, wake(context));
        let saved = force.model.poll_saving(library);
        if let Some(Ok(path)) = &saved {
            self.project.force.model = Some(path.clone());
        }
        self.say_problem(problem);
        self.say_of_file(saved);
        self.find_recorded_case();
        self.poll_training();
        self.session.force.evaluation.poll();
        self.session.force.forecast.poll();
        self.ask_for_force(context);
    }

    fn poll_training(&mut self) {
        let (force, library) = (&mut self.session.force, &self.session.library);
        match force.training.poll() {
            None => {}
            Some(Ok((model, is_complete))) => {
                let record = model.record();
                let name =
                    format!("trained on {}, epoch {}", record.data, record.detail.best_epoch);
                let of = format!("{name} of {}", record.history.len());
                force.model.take_trained(model, name, (library, is_complete));
                self.say_of_training(&of, is_complete);
            }
            Some(Err(problem)) => self.say(Severity::Error, format!("training: {problem}")),
        }
    }

    /// Tells the user that a training is over.
    ///
    /// - `name`: of its model.
    pub(in crate::app) fn say_of_training(&mut self, name: &str, is_complete: bool) {
        self.say(
            Severity::Info,
            match is_complete {
                true => format!("training over: {name}"),
                false => format!("training cancelled: {name}, which is not in use"),
            },
        );
    }

    /// Asks if anything has changed since the last question.
    fn ask_for_force(&mut self, context: &Context) {
        let Some(question) = self.force_request() else { return };
        let (force, library) = (&mut self.session.force, &self.session.library);
        force.forecast.ask(question, library, wake(context));
    }

    /// Looks up the force of the selected case once it is selected.
    fn find_recorded_case(&mut self) {
        let Some(Subject::Case { dataset, case }) = &self.project.subject else {
            self.session.force.recorded = None;
            return;
        };
        let recorded = &self.session.force.recorded;
        if recorded.as_ref().is_some_and(|r| r.dataset == *dataset && r.case == *case) {
            return;
        }
        self.session.force.recorded = force_case(&self.session.sources, (dataset, case));
    }

    /// Predicts the selected case.
    pub(in crate::app) fn predict_case(&mut self) {
        self.find_recorded_case();
        if let Some(recorded) = &self.session.force.recorded {
            self.project.force.scenario = recorded.scenario.clone();
            self.project.force.name = recorded.case.clone();
            self.session.fit_plots = true;
        }
    }

    /// Predicts the scenario of the scenario panel.
    pub(in crate::app) fn predict_scenario(&mut self) {
        match ForceScenario::from_scenario(&self.project.scenario) {
            Ok(scenario) => {
                self.project.force.scenario = scenario;
                self.project.force.name = self.project.scenario.name.clone();
                self.session.fit_plots = true;
            }
            Err(error) => self.say(Severity::Error, error_chain(&error)),
        }
    }

    /// Does what was asked for with a training.
    pub(in crate::app) fn train_force(&mut self, command: TrainingCommand, context: &Context) {
        let training = &self.session.force.training;
        match command {
            TrainingCommand::Start => self.start_force_training(context),
            TrainingCommand::Pause(pause) => training.run.set_paused(pause),
            TrainingCommand::Cancel => training.run.cancel(),
        }
    }

    /// Starts a training on the chosen data.
    fn start_force_training(&mut self, context: &Context) {
        let form = &self.project.force.training;
        let datasets = open_datasets(&self.session.sources, &[DatasetKind::Force]);
        let Some(chosen) = chosen_dataset(&datasets, form.dataset.as_deref()) else {
            self.say(Severity::Warning, "open a force data set to train on first");
            return;
        };
        let is_extra = |of: &OpenDataset<'_>| form.use_others && of.path != chosen.path;
        let extra: Vec<_> = datasets.iter().copied().filter(is_extra).collect();
        let names = std::iter::once(&chosen).chain(&extra).map(OpenDataset::name);
        let data = names.collect::<Vec<_>>().join(" + ");
        let request = self.train_force_request((&chosen, &extra));
        let (force, library) = (&mut self.session.force, &self.session.library);
        if let Err(error) = force.training.start(request, (data, library), wake(context)) {
            self.say(Severity::Error, error.to_string());
        }
    }

    /// Evaluates the current model on the chosen data.
    pub(in crate::app) fn evaluate(&mut self, context: &Context) {
        let datasets = open_datasets(&self.session.sources, &[DatasetKind::Force]);
        let chosen = chosen_dataset(&datasets, self.view.force.evaluated.as_deref());
        let request = chosen.and_then(|of| self.evaluate_force_request(of.path.to_owned()));
        let Some(request) = request else {
            self.say(Severity::Warning, "an evaluation needs a force model and a force data set");
            return;
        };
        let (force, library) = (&mut self.session.force, &self.session.library);
        if let Err(error) = force.evaluation.start(request, library, wake(context)) {
            self.say(Severity::Error, error.to_string());
        }
    }

    /// What the network says of the collision, as far as it has answered.
    pub fn force_forecast(&self) -> Option<&PredictForceAnswer> {
        self.session.force.forecast.ok().map(Arc::as_ref)
    }
}

fn force_case(sources: &[Source], (path, name): (&Path, &str)) -> Option<RecordedCase> {
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
