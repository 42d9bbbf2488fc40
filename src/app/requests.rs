//! The questions of the window: those of the project as they are asked of the data and models that are
//! open, and those of trainings.
//!
//! What the project leaves open stays open in the question, so that [`study`](impactlab_study) decides
//! it as it does for the command line.

use std::path::{Path, PathBuf};

use crate::app::model::{CurrentModel, file_name};
use crate::app::network::{NetworkQuestions, TrainingMode};
use crate::app::source::{Content, OpenDataset, Source, chosen_dataset, open_datasets};
use crate::app::state::{State, Subject};
use impactlab_core::data::{DatasetKind, FileKind};
use impactlab_networks::shipped::ModelSource;
use impactlab_study::{
    CompareRequest, DEFAULT_LOG_DURATION_S, Drive, EvaluateForceRequest, EvaluateResponseRequest,
    FineTuneRequest, ForceQuestion, ForceSource, ImpactRequest, Learning, ModelChoice, MotionLogs,
    MotionSource, PredictForceRequest, PredictMotionRequest, Request, SeriesFile,
    SimulateDatasetRequest, SimulateRequest, TrainForceRequest, TrainResponseRequest,
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

    /// Returns the question that trains the force network and the name of its data.
    ///
    /// # Errors
    /// What is missing, as a message for the user.
    pub(in crate::app) fn train_force_request(&self) -> Result<(Request, String), &'static str> {
        let NetworkQuestions { train_force, use_others, .. } = &self.project.networks;
        let datasets = open_datasets(&self.session.sources, &[DatasetKind::Force]);
        let chosen = chosen_dataset(&datasets, &train_force.data, self.view.listed.as_deref());
        let chosen = chosen.ok_or("open a force data set to train on first")?;
        let is_extra = |of: &&OpenDataset<'_>| *use_others && of.path != chosen.path;
        let extra: Vec<_> = datasets.iter().filter(is_extra).collect();
        let names = std::iter::once(&chosen).chain(extra.iter().copied()).map(OpenDataset::name);
        let name = names.collect::<Vec<_>>().join(" + ");
        let extra = extra.iter().map(|of| of.path.to_owned()).collect();
        let data = chosen.path.to_owned();
        Ok((TrainForceRequest { data, extra, ..train_force.clone() }.into(), name))
    }

    /// Returns the question that trains the response network and the name of its data.
    ///
    /// # Errors
    /// What is missing, as a message for the user.
    pub(in crate::app) fn train_response_request(&self) -> Result<(Request, String), &'static str> {
        let NetworkQuestions { mode, fine_tune, .. } = &self.project.networks;
        let vehicle = self.project.simulate.vehicle.clone();
        let chosen = || {
            let wanted = fine_tune.data.first().map_or(Path::new(""), PathBuf::as_path);
            let chosen = self.chosen_data(wanted, mode.data_kinds());
            chosen.ok_or("open a data set to train on first")
        };
        if *mode == TrainingMode::Pretrain {
            let ((data, name), training) = (chosen()?, fine_tune.training.clone());
            let request = TrainResponseRequest { data, vehicle, plain: false, training };
            return Ok((request.into(), name));
        }
        let logs = self.log_to_learn_from();
        let (data, name) = match logs.as_ref().and_then(|logs| logs.logs.first()) {
            Some(log) => (Vec::new(), file_name(log)),
            None => chosen().map(|(data, name)| (vec![data], name))?,
        };
        let current = || {
            let current = choice(self.session.response.model.current.as_ref());
            current.ok_or("there is no current response model").map(Some)
        };
        let (learning, model) = match mode {
            TrainingMode::FineTuneShipped => {
                (Learning::Network, Some(ModelSource::ShippedPretrained.into()))
            }
            TrainingMode::FineTuneCurrent => (Learning::Network, current()?),
            TrainingMode::Condition => (Learning::Strengths, current()?),
            TrainingMode::FromScratch | TrainingMode::Pretrain => (Learning::Network, None),
        };
        let request = FineTuneRequest { learning, model, data, logs, vehicle, ..fine_tune.clone() };
        Ok((request.into(), name))
    }

    /// The log that the response network is to learn from instead of a data set; `None` if none is
    /// chosen, or if its file is not open any more.
    fn log_to_learn_from(&self) -> Option<MotionLogs> {
        let networks = &self.project.networks;
        let NetworkQuestions { mode, log, log_force, .. } = networks;
        let log =
            log.as_ref().filter(|_| mode.takes_log()).and_then(|path| self.open_source(path))?;
        let without_impact = networks.log_is_without_impact;
        let force = log_force.as_ref().filter(|_| !without_impact);
        let force = force.and_then(|path| self.open_source(path));
        Some(MotionLogs {
            logs: vec![log.path.clone()],
            forces: force.map(|source| source.path.clone()).into_iter().collect(),
            map: log.map.clone(),
            force_map: force.and_then(|source| source.map.clone()),
            contact: force.and(self.project.start().contact),
            impact_s: None,
            without_impact,
            steering_ratio: networks.log_steering_ratio,
            duration_s: DEFAULT_LOG_DURATION_S,
        })
    }

    /// Returns the question that evaluates the current force model; `None` if there is no model or no
    /// force data set is open.
    pub(in crate::app) fn evaluate_force_request(&self) -> Option<EvaluateForceRequest> {
        let request = &self.project.networks.evaluate_force;
        let (data, _) = self.chosen_data(&request.data, &[DatasetKind::Force])?;
        let model = choice(self.session.force.model.current.as_ref())?;
        Some(EvaluateForceRequest { model, data, ..request.clone() })
    }

    /// Returns the question that evaluates the current response model.
    ///
    /// # Errors
    /// What is missing, as a message for the user.
    pub(in crate::app) fn evaluate_response_request(
        &self,
    ) -> Result<EvaluateResponseRequest, &'static str> {
        let CompareRequest { data, vehicle, seed, bad_cases, .. } = self.compare_request()?;
        let model = choice(self.session.response.model.current.as_ref());
        let model = model.ok_or("there is no response model to evaluate")?;
        let split = self.project.networks.response_cases;
        Ok(EvaluateResponseRequest { model, data, split, vehicle, seed, bad_cases })
    }

    /// Returns the question that compares response models.
    ///
    /// # Errors
    /// What is missing, as a message for the user.
    pub(in crate::app) fn compare_request(&self) -> Result<CompareRequest, &'static str> {
        let request = &self.project.networks.compare;
        let chosen = self.chosen_data(&request.data, &[DatasetKind::Trajectory]);
        let (data, _) = chosen.ok_or("open a trajectory data set first")?;
        let vehicle = self.project.simulate.vehicle.clone();
        Ok(CompareRequest { data, vehicle, ..request.clone() })
    }

    /// Returns the folder and the name of the wanted data set; if that one is not open, of the listed
    /// one or else the first open one of the given kinds; `None` if none is open.
    fn chosen_data(&self, wanted: &Path, kinds: &[DatasetKind]) -> Option<(PathBuf, String)> {
        let datasets = open_datasets(&self.session.sources, kinds);
        let chosen = chosen_dataset(&datasets, wanted, self.view.listed.as_deref())?;
        Some((chosen.path.to_owned(), chosen.name()))
    }
}

/// Returns the reference to the current model in questions.
fn choice<M>(current: Option<&CurrentModel<M>>) -> Option<ModelChoice> {
    current.map(|current| current.choice.clone())
}
