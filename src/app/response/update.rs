//! What happens between frames, and what the user asks for, about the response network.

use std::path::Path;
use std::sync::Arc;

use egui::Context;

use crate::analysis::{Analysis, MotionForecastSettings};
use crate::app::command::{ComparisonCommand, TrainingCommand, wake};
use crate::app::response::{
    ComparisonRequest, DensityChoice, DensityQuestion, ForceChoice, MotionAnswer, MotionQuestion,
    ResponseTrainingData, run_response_training,
};
use crate::app::source::{CheckedDataset, chosen_dataset, open_datasets};
use crate::app::state::{State, Subject};
use crate::app::training::Tell;
use crate::app::update::target_vehicle;
use crate::data::{DatasetKind, Severity};
use crate::force::{ForceModel, ForceScenario};
use crate::vehicle::VehicleParameters;

impl State {
    /// Takes in what loader, forecast, training and comparison report, and asks for what is due.
    pub(in crate::app) fn update_response(&mut self, context: &Context) {
        let response = &mut self.session.response;
        let problem = response.model.update(&self.project.response.model, wake(context));
        let saved = response.model.poll_saving();
        if let Some(Ok(path)) = &saved {
            self.project.response.model = Some(path.clone());
        }
        let written = response.comparison.poll();
        self.say_of_model(problem, saved);
        self.say_of_model(None, written);
        self.poll_response_training();
        self.session.response.forecast.poll();
        self.ask_for_motion(context);
        self.session.response.density.poll();
        self.ask_for_density(context);
    }

    fn poll_response_training(&mut self) {
        let response = &mut self.session.response;
        match response.training.poll() {
            None => {}
            Some(Ok(model)) => {
                let record = model.record();
                let name = match record.train.len() {
                    0 => format!("pre-trained on {} simulations", record.detail.n_simulated),
                    n => format!("trained on {n} trajectories of {}", record.data),
                };
                let text = format!("training over: {name}");
                response.model.take_trained(model, name);
                self.say(Severity::Info, text);
            }
            Some(Err(problem)) => self.say(Severity::Error, format!("training: {problem}")),
        }
    }

    /// Asks if anything has changed since the last question.
    fn ask_for_motion(&mut self, context: &Context) {
        let Some(Ok(analysis)) = &self.session.analysis.result else { return };
        let analysis = Arc::clone(analysis);
        let predicted = match self.project.response.forecast.force {
            ForceChoice::Given => None,
            ForceChoice::Predicted => self.predicted_force(),
        };
        let response = &mut self.session.response;
        let Some(current) = &response.model.current else { return };
        if analysis.struck.is_none() {
            response.forecast.forget();
            return;
        }
        let form = &self.project.response.forecast;
        let settings = MotionForecastSettings {
            n_curves: form.n_curves,
            duration_s: duration_s(&analysis, self.project.duration_s),
            seed: form.seed,
            ..MotionForecastSettings::default()
        };
        let model = Arc::clone(&current.model);
        let question = MotionQuestion { model, analysis, predicted, settings };
        response.forecast.ask(question, wake(context));
    }

    /// The network that predicts the force of what is looked at, and what it is asked; `None` where
    /// the collision is not known.
    pub(in crate::app) fn predicted_force(&self) -> Option<(Arc<ForceModel>, ForceScenario)> {
        let force = &self.session.force;
        let scenario = match self.project.subject.as_ref()? {
            Subject::Case { .. } => force.recorded.as_ref()?.scenario.clone(),
            Subject::Scenario => ForceScenario::from_scenario(&self.project.scenario).ok()?,
            Subject::File(_) => return None,
        };
        Some((Arc::clone(&force.model.current.as_ref()?.model), scenario))
    }

    fn ask_for_density(&mut self, context: &Context) {
        let view = &self.view.response;
        let window_s = match view.density {
            DensityChoice::Hidden => return,
            DensityChoice::Moment => [self.session.time_s; 2],
            DensityChoice::Window => view.window_s,
        };
        let response = &mut self.session.response;
        let Some(motion) = response.forecast.ok().cloned() else {
            response.density.forget();
            return;
        };
        let question = DensityQuestion { motion, window_s, gpu: response.gpu.clone() };
        response.density.ask(question, wake(context));
    }

    /// Does what was asked for with a training.
    pub(in crate::app) fn train_response(&mut self, command: TrainingCommand, context: &Context) {
        let training = &self.session.response.training;
        match command {
            TrainingCommand::Start => self.start_response_training(context),
            TrainingCommand::Pause(pause) => training.run.set_paused(pause),
            TrainingCommand::Cancel => training.run.cancel(),
        }
    }

    /// Starts a training on the chosen data.
    fn start_response_training(&mut self, context: &Context) {
        let form = self.project.response.training.clone();
        let Some((name, dataset, vehicle)) = self.trajectories(form.dataset.as_deref()) else {
            return;
        };
        let response = &mut self.session.response;
        let current = response.model.current.as_ref().map(|current| Arc::clone(&current.model));
        let data = ResponseTrainingData { name, dataset, vehicle, current };
        let (checkpoint, name) = (response.checkpoint.clone(), data.name.clone());
        let work =
            move |tell: &mut Tell<'_>| run_response_training(&data, (&form, checkpoint), tell);
        if let Err(error) = response.training.start(name, wake(context), work) {
            self.say(Severity::Error, error.to_string());
        }
    }

    /// Does what was asked for with a comparison.
    pub(in crate::app) fn compare(&mut self, command: ComparisonCommand, context: &Context) {
        let comparison = &mut self.session.response.comparison;
        let problem = match command {
            ComparisonCommand::Start => return self.start_comparison(context),
            ComparisonCommand::Cancel => return comparison.cancel(),
            ComparisonCommand::Open(path) => {
                comparison.open(path, wake(context)).err().map(|error| error.to_string())
            }
            ComparisonCommand::Save(folder) => comparison.save(folder, wake(context)).err(),
        };
        if let Some(problem) = problem {
            self.say(Severity::Error, problem);
        }
    }

    /// Starts a comparison on the chosen data.
    fn start_comparison(&mut self, context: &Context) {
        let form = self.project.response.comparison.clone();
        let Some((name, dataset, vehicle)) = self.trajectories(form.dataset.as_deref()) else {
            return;
        };
        let request = ComparisonRequest { name, dataset, vehicle, form };
        let started = self.session.response.comparison.start(request, wake(context));
        if let Err(error) = started {
            self.say(Severity::Error, error.to_string());
        }
    }

    /// Name, content and struck vehicle of a trajectory data set that is open; the first of all if
    /// none is wanted. Without one, the user is told.
    fn trajectories(
        &mut self,
        wanted: Option<&Path>,
    ) -> Option<(String, Arc<CheckedDataset>, VehicleParameters)> {
        let datasets = open_datasets(&self.session.sources, DatasetKind::Trajectory);
        let chosen = chosen_dataset(&datasets, wanted);
        let Some((name, dataset)) = chosen.map(|of| (of.name(), Arc::clone(of.checked))) else {
            self.say(Severity::Warning, "open a trajectory data set first");
            return None;
        };
        match target_vehicle(&self.project, Some(&dataset)) {
            Ok(vehicle) => Some((name, dataset, vehicle)),
            Err(problem) => {
                self.say(Severity::Error, problem);
                None
            }
        }
    }

    /// Where the struck vehicle goes, as far as that is known.
    pub fn motion_forecast(&self) -> Option<&MotionAnswer> {
        self.session.response.forecast.ok().map(Arc::as_ref)
    }
}

/// As long as the recorded motion, if there is one.
fn duration_s(analysis: &Analysis, otherwise_s: f64) -> f64 {
    let recorded = analysis.reference.as_ref().and_then(|series| series.time_s().last().copied());
    recorded.unwrap_or(otherwise_s)
}
