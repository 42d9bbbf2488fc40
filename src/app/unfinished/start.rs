//! Starts, pauses and cancels trainings, and goes on with those that have not ended.

use std::path::{Path, PathBuf};

use egui::Context;

use crate::app::command::{TrainingCommand, wake};
use crate::app::network::Network;
use crate::app::state::{Session, State};
use crate::app::unfinished::diary::TrainingDiary;
use crate::app::unfinished::note::{TrainingNote, training_options};
use impactlab_core::data::Severity;
use impactlab_study::Request;

impl State {
    /// Starts, pauses or cancels the training of a network.
    pub(in crate::app) fn train(
        &mut self,
        network: Network,
        command: TrainingCommand,
        context: &Context,
    ) {
        let (force, response) = (&self.session.force.training, &self.session.response.training);
        let question = match (command, network) {
            (TrainingCommand::Start, Network::Force) => self.train_force_request(),
            (TrainingCommand::Start, Network::Response) => self.train_response_request(),
            (TrainingCommand::Pause(pause), Network::Force) => return force.run.set_paused(pause),
            (TrainingCommand::Pause(pause), Network::Response) => {
                return response.run.set_paused(pause);
            }
            (TrainingCommand::Cancel, Network::Force) => return force.run.cancel(),
            (TrainingCommand::Cancel, Network::Response) => return response.run.cancel(),
        };
        match question {
            Ok((question, data)) => self.start_training(question, network, data, context),
            Err(problem) => self.say(Severity::Warning, problem),
        }
    }

    /// Starts a training.
    ///
    /// - `data`: name of the data, shown to the user.
    fn start_training(
        &mut self,
        mut question: Request,
        network: Network,
        data: String,
        context: &Context,
    ) {
        let checkpoint = self.session.unfinished.new_checkpoint(network);
        if let Some(options) = training_options(&mut question) {
            options.checkpoint = checkpoint.clone();
        }
        let note = TrainingNote::new(network, question.clone(), data);
        self.run_training(question, checkpoint, note, context);
    }

    /// Goes on with a training that has not ended.
    pub(in crate::app) fn resume_training(&mut self, checkpoint: &Path, context: &Context) {
        let mut trainings = self.session.unfinished.list.trainings.iter();
        let Some(of) = trainings.find(|of| of.checkpoint == checkpoint) else { return };
        let is_running = match of.note.network {
            Network::Force => self.session.force.training.run.is_running(),
            Network::Response => self.session.response.training.run.is_running(),
        };
        if is_running {
            let text = format!("a {} is being trained; wait or cancel it", of.note.network.model());
            return self.say(Severity::Warning, text);
        }
        let note = TrainingNote { is_cancelled: false, ..of.note.clone() };
        let mut question = note.question.clone();
        if let Some(options) = training_options(&mut question) {
            (options.checkpoint, options.resume) = (Some(checkpoint.to_owned()), true);
        }
        self.view.trained = note.network;
        self.session.unfinished.list.trainings.retain(|of| of.checkpoint != checkpoint);
        self.run_training(question, Some(checkpoint.to_owned()), note, context);
    }

    fn run_training(
        &mut self,
        question: Request,
        checkpoint: Option<PathBuf>,
        note: TrainingNote,
        context: &Context,
    ) {
        let (data, network) = (note.data.clone(), note.network);
        let diary = checkpoint.map(|checkpoint| TrainingDiary::new(checkpoint, note));
        let Session { force, response, library, n_cases, .. } = &mut self.session;
        let started = match question {
            Request::TrainForce(question) => {
                force.training.start(*question, diary, data, library, wake(context))
            }
            Request::TrainResponse(question) => {
                response.training.start(*question, diary, data, library, wake(context))
            }
            Request::FineTune(question) => {
                response.training.start(*question, diary, data, library, wake(context))
            }
            _ => return,
        };
        match network {
            Network::Force => force.training.n_cases = *n_cases,
            Network::Response => response.training.n_cases = *n_cases,
        }
        if let Err(error) = started {
            self.say(Severity::Error, error.to_string());
        }
    }
}
