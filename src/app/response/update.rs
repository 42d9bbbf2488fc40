//! Background work and commands of the response network.

use std::path::PathBuf;
use std::sync::Arc;

use egui::Context;

use crate::app::archive::{ArchiveEntry, keep_trained};
use crate::app::command::{ComparisonCommand, wake};
use crate::app::force::WITHOUT_MODEL;
use crate::app::found::Found;
use crate::app::response::comparison::write_comparison_folder;
use crate::app::response::{
    DensityChoice, DensityQuestion, MotionAnswer, MotionQuestion, ResponseSession,
};
use crate::app::state::{Session, State};
use impactlab_core::data::{Existing, Severity};
use impactlab_core::error_chain;

impl State {
    /// Receives the results of the loader, the training, the comparison and the forecast, and asks
    /// for a new forecast and a new density if their questions have changed.
    pub(in crate::app) fn update_response(&mut self, context: &Context) {
        let Session { response, library, tasks, .. } = &mut self.session;
        response.model.update(&self.project.predict_motion.response_model, library, tasks);
        response.comparison.poll();
        if let Some((question, answer)) = response.comparison.take_finished() {
            self.keep_comparison(question, &answer);
        }
        self.poll_response_training();
        self.session.response.forecast.poll();
        self.ask_for_motion(context);
        self.session.response.density.poll();
        self.ask_for_density(context);
    }

    fn poll_response_training(&mut self) {
        let was_running = self.session.response.training.run.is_running();
        let may_be_used = self.takes_trained(self.session.response.training.n_cases);
        let Session { response, library, archive, tasks, .. } = &mut self.session;
        match response.training.poll() {
            None => {}
            Some(Ok((model, is_complete))) => {
                let record = model.record();
                let name = match record.train.len() {
                    0 => format!("pre-trained on {} simulations", record.detail.n_simulated),
                    n => format!("trained on {n} trajectories of {}", record.data),
                };
                let draft = response.training.archive_note(&model, name.clone(), is_complete);
                let used = (is_complete && may_be_used)
                    .then_some(&mut self.project.predict_motion.response_model);
                let taken = response.model.take_trained(model, name.clone(), library, used);
                let draft = draft.map(|draft| ArchiveEntry { name: taken.1, ..draft });
                let ResponseSession { model: status, training, .. } = response;
                keep_trained(status, training, taken.0, draft, archive.folder(), tasks);
                let (reached, n_cases) = (training.reached(), training.n_cases);
                self.say_of_training(&name, is_complete, reached, n_cases);
            }
            Some(Err(problem)) => self.say(Severity::Error, format!("training: {problem}")),
        }
        let training = &self.session.response.training;
        if was_running && !training.run.is_running() {
            if training.has_no_model() {
                self.say(Severity::Info, WITHOUT_MODEL);
            }
            self.read_unfinished();
        }
    }

    /// Asks for the motion of the struck vehicle, if the question has changed. It waits until the
    /// simulation of the subject is finished, and drops the forecast if there is none, or if that has no
    /// struck vehicle: what is left would be of something else.
    fn ask_for_motion(&mut self, context: &Context) {
        let analysis = &self.session.analysis;
        if analysis.is_waiting() {
            return;
        }
        if analysis.ok().is_none_or(|simulated| simulated.analysis.struck.is_none()) {
            self.session.response.forecast.forget();
            return;
        }
        let Some(request) = self.motion_request() else { return };
        let Session { response, library, analysis, .. } = &mut self.session;
        let question = MotionQuestion { request };
        response.forecast.ask_after(analysis, question, library, wake(context));
    }

    /// Asks for the density of the predicted position at the chosen times, if the question has
    /// changed.
    fn ask_for_density(&mut self, context: &Context) {
        let view = &self.view.response;
        let window_s = match view.density {
            DensityChoice::Hidden => return,
            DensityChoice::Moment => [self.session.playback.time_s; 2],
            DensityChoice::Window => view.window_s,
        };
        let (response, library) = (&mut self.session.response, &self.session.library);
        let Some(motion) = response.forecast.ok().cloned() else {
            response.density.forget();
            return;
        };
        let question = DensityQuestion { motion, window_s, gpu: response.gpu.clone() };
        response.density.ask(question, library, wake(context));
    }

    /// Starts or cancels a comparison or an evaluation, or opens a comparison.
    pub(in crate::app) fn compare(&mut self, command: ComparisonCommand, context: &Context) {
        let Session { response, tasks, .. } = &mut self.session;
        match command {
            ComparisonCommand::Start => self.start_comparison(context),
            ComparisonCommand::Evaluate => self.evaluate_response(context),
            ComparisonCommand::Cancel => response.comparison.cancel(),
            ComparisonCommand::Open(path) => response.comparison.open(path, tasks),
            ComparisonCommand::Read(result) => response.comparison.take(result.map(Found::take)),
        }
    }

    /// Starts to write the comparison that is shown into a folder.
    pub(in crate::app) fn save_comparison(&mut self, folder: PathBuf, existing: Existing) {
        let Some(Ok(answer)) = self.session.response.comparison.shown.clone() else {
            return self.say(Severity::Error, "there is no comparison to save");
        };
        self.start_writing(folder, move |to| {
            write_comparison_folder(to, existing, &answer.report)
                .map_err(|error| error_chain(&error))
        });
    }

    /// Starts a comparison on the chosen data set.
    fn start_comparison(&mut self, context: &Context) {
        let request = match self.compare_request() {
            Ok(request) => request,
            Err(problem) => return self.say(Severity::Warning, problem),
        };
        let (comparison, library) = (&mut self.session.response.comparison, &self.session.library);
        if let Err(error) = comparison.start(request, library, wake(context)) {
            self.say(Severity::Error, error.to_string());
        }
    }

    /// Starts an evaluation of the current response model on the chosen data set.
    fn evaluate_response(&mut self, context: &Context) {
        let request = match self.evaluate_response_request() {
            Ok(request) => request,
            Err(problem) => return self.say(Severity::Warning, problem),
        };
        let (comparison, library) = (&mut self.session.response.comparison, &self.session.library);
        if let Err(error) = comparison.evaluate(request, library, wake(context)) {
            self.say(Severity::Error, error.to_string());
        }
    }

    /// Returns the latest predicted motion, if there is one. While a newer one is awaited, it
    /// belongs to an earlier question.
    pub fn motion_forecast(&self) -> Option<&MotionAnswer> {
        self.session.response.forecast.ok().map(Arc::as_ref)
    }
}
