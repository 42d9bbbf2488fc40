//! The questions of the window: those of the project as they are asked of the data and models that are
//! open, and those of trainings.
//!
//! What the project leaves open stays open in the question, so that [`study`](impactlab_study) decides
//! it as it does for the command line.

use std::path::{Path, PathBuf};

use crate::app::force::ForceTrainingForm;
use crate::app::model::CurrentModel;
use crate::app::response::{ComparisonForm, ResponseTrainingForm, TrainingMode};
use crate::app::source::{Content, OpenDataset, Source};
use crate::app::state::{State, Subject};
use impactlab_core::data::{DatasetKind, FileKind};
use impactlab_networks::shipped::ModelSource;
use impactlab_study::{
    CompareRequest, ConfigChoice, DEFAULT_LOG_DURATION_S, Drive, EvaluateForceRequest,
    EvaluateResponseRequest, FineTuneRequest, ForceQuestion, ForceSource, ImpactRequest, Learning,
    ModelChoice, MotionLogs, MotionSource, PredictForceRequest, PredictMotionRequest, SeriesFile,
    SimulateDatasetRequest, SimulateRequest, TrainForceRequest, TrainResponseRequest,
    TrainingOptions,
};

impl State {
    /// Returns the question for the impulse solution of the scenario in the scenario pane.
    pub fn impact_request(&self) -> ImpactRequest {
        self.project.impact.clone()
    }

    /// Returns the question for the simulation of what is selected; `None` if nothing is or its data are
    /// not open.
    pub fn simulate_request(&self) -> Option<SimulateRequest> {
        let is_open = match self.project.subject()? {
            Subject::Case { dataset, case } => {
                let checked = self.open_source(&dataset).and_then(Source::dataset);
                checked.is_some_and(|checked| checked.dataset.case(&case).is_some())
            }
            Subject::File(path) => {
                let source = self.open_source(&path);
                source.is_some_and(|source| matches!(source.content, Content::File(_)))
            }
            Subject::Manoeuvre | Subject::Scenario => true,
        };
        is_open.then(|| self.project.simulate.clone())
    }

    /// Returns the question for the simulation of all cases of a data set.
    pub(in crate::app) fn replay_request(&self, dataset: PathBuf) -> SimulateDatasetRequest {
        let SimulateRequest { vehicle, equations, integrator, .. } = &self.project.simulate;
        SimulateDatasetRequest {
            dataset,
            case: None,
            vehicle: vehicle.clone(),
            equations: *equations,
            integrator: *integrator,
        }
    }

    /// Returns the question for the force of the collision in the force prediction pane, of the model
    /// that is in use; `None` if there is none or the data set of the collision is not open.
    pub fn force_request(&self) -> Option<PredictForceRequest> {
        let request = &self.project.predict_force;
        if let ForceQuestion::Case { dataset, .. } = &request.collision {
            self.open_source(dataset)?.dataset()?;
        }
        let model = choice(self.session.force.model.current.as_ref())?;
        Some(PredictForceRequest { model, ..request.clone() })
    }

    /// Returns the question for the motion of the struck vehicle that the force causes, of the models
    /// that are in use; `None` if no response model is loaded or there is nothing to simulate.
    pub fn motion_request(&self) -> Option<PredictMotionRequest> {
        let request = &self.project.predict_motion;
        let force_model = choice(self.session.force.model.current.as_ref());
        let force = match (self.driving_force(), force_model) {
            (ForceSource::Predicted(_), Some(model)) => ForceSource::Predicted(model),
            (ForceSource::Predicted(_), None) => ForceSource::Given,
            (force, _) => force,
        };
        let SimulateRequest { vehicle_draws, seed, .. } = request.motion;
        Some(PredictMotionRequest {
            motion: SimulateRequest { vehicle_draws, seed, ..self.simulate_request()? },
            force,
            response_model: choice(self.session.response.model.current.as_ref())?,
            ..request.clone()
        })
    }

    /// The force that drives the forecast: that of the subject where its collision is not known, so that
    /// no force can be predicted.
    pub(in crate::app) fn driving_force(&self) -> ForceSource {
        let is_known = match self.project.subject() {
            Some(Subject::Case { dataset, .. }) => {
                let checked = self.open_source(&dataset).and_then(Source::dataset);
                checked.is_none_or(|checked| checked.dataset.kind == DatasetKind::Force)
            }
            Some(Subject::Scenario) => true,
            Some(Subject::File(_) | Subject::Manoeuvre) | None => false,
        };
        match &self.project.predict_motion.force {
            ForceSource::Predicted(_) if !is_known => ForceSource::Given,
            force => force.clone(),
        }
    }

    /// Whether a subject leaves open what happens to the wheels after the impact.
    pub(in crate::app) fn takes_ending(&self, subject: Option<&Subject>) -> bool {
        subject.is_some_and(|subject| subject.takes_ending(&self.session.sources))
    }

    fn open_source(&self, path: &Path) -> Option<&Source> {
        self.session.sources.iter().find(|source| source.path == *path)
    }

    /// What drives the motion of a subject, with what was entered for it before.
    pub(in crate::app) fn source_of(&self, subject: Subject) -> MotionSource {
        let project = &self.project;
        match subject {
            Subject::Case { dataset, case } => MotionSource::Case { dataset, case },
            Subject::File(path) => {
                let open = self.open_source(&path);
                let kind = match open.map(|source| &source.content) {
                    Some(Content::File(file)) => file.loaded.kind,
                    _ => FileKind::Force,
                };
                let file = open.map_or_else(|| SeriesFile::new(&path), Source::series_file);
                MotionSource::from_file(file, kind, project.beside.start.clone())
            }
            Subject::Manoeuvre => project.simulate.source.clone(),
            Subject::Scenario => MotionSource::Scenario {
                scenario: project.impact.scenario.clone(),
                pulse: project.beside.pulse,
            },
        }
    }

    /// Brings the questions in step, with files as they are open: with the columns that the user has
    /// assigned, and as what they are about.
    pub(in crate::app) fn keep_questions_in_step(&mut self) {
        let open = |path: &PathBuf| match &self.open_source(path)?.content {
            Content::File(file) => Some((self.open_source(path)?.series_file(), file.loaded.kind)),
            _ => None,
        };
        let own = match self.project.subject() {
            Some(Subject::File(path)) => open(&path),
            _ => None,
        };
        let beside = |file: &Option<SeriesFile>| open(&file.as_ref()?.path).map(|(file, _)| file);
        let (steer, wheels) = (&self.project.start().steer, &self.project.start().wheels);
        let (steer, wheels) = (beside(steer), beside(wheels));
        let start = self.project.start_mut();
        start.steer = steer.or(start.steer.take());
        start.wheels = wheels.or(start.wheels.take());
        if let Some((file, kind)) = own {
            let start = Drive { force: None, ..start.clone() };
            if kind == FileKind::Trajectory {
                self.project.beside.start.clone_from(&start);
            }
            self.project.simulate.source = MotionSource::from_file(file, kind, start);
        }
        self.project.keep_in_step();
    }

    /// Returns the question that trains the force network.
    ///
    /// - `chosen`: the data set of which a part is kept for the test;
    /// - `extra`: other data sets, from which all cases are used for training.
    pub(in crate::app) fn train_force_request(
        &self,
        chosen: &OpenDataset<'_>,
        extra: &[OpenDataset<'_>],
    ) -> TrainForceRequest {
        let form: &ForceTrainingForm = &self.project.force_training;
        TrainForceRequest {
            data: chosen.path.to_owned(),
            extra: extra.iter().map(|of| of.path.to_owned()).collect(),
            paper: false,
            epochs: form.epochs,
            training: TrainingOptions {
                config: config(&form.config),
                seed: form.seed,
                bad_cases: form.bad_cases,
                ..TrainingOptions::default() // The window chooses the checkpoint at the start.
            },
        }
    }

    /// Returns the question that pre-trains the response network on simulations with the forces of
    /// a data set.
    pub(in crate::app) fn train_response_request(&self, data: PathBuf) -> TrainResponseRequest {
        let form: &ResponseTrainingForm = &self.project.response_training;
        TrainResponseRequest {
            data,
            vehicle: self.project.simulate.vehicle.clone(),
            plain: false,
            training: TrainingOptions {
                config: config(&form.config),
                seed: form.seed,
                bad_cases: form.bad_cases,
                ..TrainingOptions::default() // The window chooses the checkpoint at the start.
            },
        }
    }

    /// The log that the response network is to learn from instead of a data set; `None` if none is
    /// chosen, or if its file is not open any more.
    pub(in crate::app) fn log_to_learn_from(&self) -> Option<MotionLogs> {
        let form = &self.project.response_training;
        let source_of = |path: &PathBuf| self.session.sources.iter().find(|of| of.path == *path);
        let log = form.log.as_ref().filter(|_| form.mode.takes_log()).and_then(source_of)?;
        let force = form.log_force.as_ref().and_then(source_of);
        Some(MotionLogs {
            logs: vec![log.path.clone()],
            forces: force.map(|source| source.path.clone()).into_iter().collect(),
            map: log.map.clone(),
            contact: force.and(self.project.start().contact),
            impact_s: None,
            duration_s: DEFAULT_LOG_DURATION_S,
        })
    }

    /// Returns the question that fine-tunes the response network on data sets or a log; `None` if the
    /// current model is to be fine-tuned and there is none.
    pub(in crate::app) fn fine_tune_request(
        &self,
        data: Vec<PathBuf>,
        logs: Option<MotionLogs>,
    ) -> Option<FineTuneRequest> {
        let form: &ResponseTrainingForm = &self.project.response_training;
        let model = match form.mode {
            TrainingMode::FineTuneShipped => Some(ModelSource::ShippedPretrained.into()),
            TrainingMode::FineTuneCurrent | TrainingMode::Condition => {
                Some(choice(self.session.response.model.current.as_ref())?)
            }
            TrainingMode::FromScratch | TrainingMode::Pretrain => None,
        };
        let learning = match form.mode {
            TrainingMode::Condition => Learning::Strengths,
            _ => Learning::Network,
        };
        Some(FineTuneRequest {
            learning,
            model,
            data,
            logs,
            trajectories: form.n_trajectories,
            vehicle: self.project.simulate.vehicle.clone(),
            choice: form.choice,
            training: TrainingOptions {
                config: config(&form.config),
                seed: form.seed,
                bad_cases: form.bad_cases,
                ..TrainingOptions::default() // The window chooses the checkpoint at the start.
            },
            ..FineTuneRequest::default()
        })
    }

    /// Returns the question that evaluates the current force model on a data set; `None` if no
    /// model is loaded.
    pub(in crate::app) fn evaluate_force_request(
        &self,
        data: PathBuf,
    ) -> Option<EvaluateForceRequest> {
        let view = &self.view.force;
        let model = choice(self.session.force.model.current.as_ref())?;
        Some(EvaluateForceRequest {
            split: view.evaluated_cases,
            bad_cases: view.bad_cases,
            for_figures: true,
            ..EvaluateForceRequest::new(model, data)
        })
    }

    /// Returns the question that evaluates the current response model on a data set; `None` if no
    /// model is loaded.
    pub(in crate::app) fn evaluate_response_request(
        &self,
        data: PathBuf,
    ) -> Option<EvaluateResponseRequest> {
        let form: &ComparisonForm = &self.project.comparison;
        Some(EvaluateResponseRequest {
            model: choice(self.session.response.model.current.as_ref())?,
            data,
            split: form.evaluated_cases,
            vehicle: self.project.simulate.vehicle.clone(),
            seed: form.seed,
            bad_cases: form.bad_cases,
        })
    }

    /// Returns the question that compares response models on a data set.
    ///
    /// # Errors
    /// A message for the user, if the form does not list positive numbers of trajectories.
    pub(in crate::app) fn compare_request(&self, data: PathBuf) -> Result<CompareRequest, String> {
        let form: &ComparisonForm = &self.project.comparison;
        Ok(CompareRequest {
            trajectories: trajectories(&form.trajectories)?,
            choices: form.n_choices,
            seed: form.seed,
            vehicle: self.project.simulate.vehicle.clone(),
            config: config(&form.config),
            bad_cases: form.bad_cases,
            ..CompareRequest::new(data)
        })
    }
}

/// Returns the reference to the current model in questions.
fn choice<M>(current: Option<&CurrentModel<M>>) -> Option<ModelChoice> {
    current.map(|current| current.choice.clone())
}

/// Returns the settings file whose path the user typed. An empty text means the settings of the
/// model that is trained on, or the defaults.
fn config(typed: &str) -> ConfigChoice {
    let path = typed.trim();
    (!path.is_empty()).then(|| PathBuf::from(path)).into()
}

/// Reads a list of positive numbers separated by commas, such as `5, 20`.
fn trajectories(text: &str) -> Result<Vec<usize>, String> {
    let number = |part: &str| match part.trim().parse::<usize>() {
        Ok(n) if n > 0 => Ok(n),
        _ => Err(format!("{part:?} is no number of trajectories, expected such as 5, 20")),
    };
    text.split(',').map(number).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_trajectories_are_read_or_refused() {
        assert_eq!(trajectories("5, 20"), Ok(vec![5, 20]));
        assert!(trajectories("5, x").unwrap_err().contains("\" x\""));
        assert!(trajectories("0").is_err() && trajectories("").is_err());
    }
}
