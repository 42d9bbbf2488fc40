//! Makes questions from the project.
//!
//! What the project leaves open stays open in the question, so that [`study`](impactlab_study) decides
//! it as it does for the command line.

use std::path::{Path, PathBuf};

use crate::app::force::ForceTrainingForm;
use crate::app::model::CurrentModel;
use crate::app::response::{ComparisonForm, ForceChoice, ResponseTrainingForm, TrainingMode};
use crate::app::source::{Content, OpenDataset, Source};
use crate::app::state::{State, Subject};
use impactlab_core::data::{DatasetKind, FileKind};
use impactlab_networks::force::ForceScenario;
use impactlab_networks::shipped::ModelSource;
use impactlab_study::{
    CompareRequest, ConfigChoice, DEFAULT_DRAWS, DEFAULT_LOG_DURATION_S, Drive,
    EvaluateForceRequest, EvaluateResponseRequest, FineTuneRequest, ForceQuestion, ForceSource,
    ImpactRequest, Learning, ModelChoice, MotionLogs, MotionSource, PredictForceRequest,
    PredictMotionRequest, ScenarioChoice, SeriesFile, SimulateDatasetRequest, SimulateRequest,
    TrainForceRequest, TrainResponseRequest, TrainingOptions,
};

impl State {
    /// Returns the question for the impulse solution of the scenario in the scenario pane.
    pub fn impact_request(&self) -> ImpactRequest {
        ImpactRequest { scenario: self.scenario(), paper: false }
    }

    /// Returns the question for the simulation of the subject; `None` if nothing is selected or its
    /// data are not open.
    pub fn simulate_request(&self) -> Option<SimulateRequest> {
        let project = &self.project;
        Some(SimulateRequest {
            vehicle: project.vehicle.clone(),
            striking: project.striking.clone(),
            equations: project.equations,
            integrator: project.integrator,
            duration_s: project.duration_s,
            until_rest: project.until_rest,
            site: project.site.as_ref().map(|site| site.file.clone()),
            ending: self.says_no_ending().then(|| project.ending.clone()).flatten(),
            ..SimulateRequest::new(self.motion_source()?)
        })
    }

    /// Returns the question for the simulation of all cases of a data set.
    pub(in crate::app) fn replay_request(&self, dataset: PathBuf) -> SimulateDatasetRequest {
        SimulateDatasetRequest {
            dataset,
            case: None,
            vehicle: self.project.vehicle.clone(),
            equations: self.project.equations,
            integrator: self.project.integrator,
        }
    }

    /// Returns the question for the force of the collision in the force prediction pane; `None` if
    /// no force model is loaded.
    pub fn force_request(&self) -> Option<PredictForceRequest> {
        let view = &self.view.force;
        Some(PredictForceRequest {
            collision: self.collision(),
            model: choice(self.session.force.model.current.as_ref())?,
            body: None,
            open_contact: false,
            samples: view.n_curves,
            seed: view.seed,
        })
    }

    /// Returns the collision in the force prediction pane. As long as its numbers are those of the
    /// scenario or of the selected case from which they were taken, it is that scenario or case,
    /// which say more: outlines, restitution and friction.
    fn collision(&self) -> ForceQuestion {
        let (form, scenario) = (&self.project.force, &self.project.scenario);
        let is_taken = |(name, numbers): (&str, &ForceScenario)| {
            form.name == name && form.scenario == *numbers
        };
        let of_scenario = ForceScenario::from_scenario(scenario);
        if of_scenario.is_ok_and(|numbers| is_taken((&scenario.name, &numbers))) {
            return ForceQuestion::Scenario(self.scenario());
        }
        match &self.session.force.recorded {
            Some(of) if is_taken((&of.case, &of.scenario)) => {
                ForceQuestion::Case { dataset: of.dataset.clone(), case: of.case.clone() }
            }
            _ => ForceQuestion::Numbers {
                name: form.name.clone(),
                numbers: Box::new(form.scenario.clone()),
            },
        }
    }

    /// Returns the question for the motion of the struck vehicle that the force causes; `None` if
    /// no response model is loaded or there is nothing to simulate.
    ///
    /// The force is predicted if the user wants that, a force model is loaded and the collision of
    /// the subject is known. Otherwise it is the force that the subject gives.
    pub fn motion_request(&self) -> Option<PredictMotionRequest> {
        let form = &self.project.response.forecast;
        let force_model = choice(self.session.force.model.current.as_ref());
        let force = match (form.force, force_model) {
            (ForceChoice::Predicted, Some(model)) if self.is_collision_known() => {
                ForceSource::Predicted(model)
            }
            _ => ForceSource::Given,
        };
        Some(PredictMotionRequest {
            motion: SimulateRequest { vehicle_draws: DEFAULT_DRAWS, ..self.simulate_request()? },
            force,
            response_model: choice(self.session.response.model.current.as_ref())?,
            draws: form.n_curves,
            seed: form.seed,
        })
    }

    /// Whether the subject leaves open what happens to the wheels after the impact.
    pub(in crate::app) fn says_no_ending(&self) -> bool {
        match &self.project.subject {
            Some(Subject::Case { dataset, .. }) => {
                let source = self.session.sources.iter().find(|source| source.path == *dataset);
                let kind = source.and_then(Source::dataset).map(|checked| checked.dataset.kind);
                kind == Some(DatasetKind::Force)
            }
            Some(Subject::File(_)) => true,
            Some(Subject::Scenario) | None => false,
        }
    }

    /// Whether the subject describes the collision of the two vehicles, so that its force can be
    /// predicted.
    fn is_collision_known(&self) -> bool {
        match &self.project.subject {
            Some(Subject::Case { .. }) => self.session.force.recorded.is_some(),
            Some(Subject::Scenario) => true,
            Some(Subject::File(_)) | None => false,
        }
    }

    /// Returns the question that trains the force network.
    ///
    /// - `chosen`: the data set of which a part is kept for the test;
    /// - `extra`: other data sets, from which all cases are used for training.
    pub(in crate::app) fn train_force_request(
        &self,
        (chosen, extra): (&OpenDataset<'_>, &[OpenDataset<'_>]),
    ) -> TrainForceRequest {
        let form: &ForceTrainingForm = &self.project.force.training;
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
        let form: &ResponseTrainingForm = &self.project.response.training;
        TrainResponseRequest {
            data,
            vehicle: self.project.vehicle.clone(),
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
        let form = &self.project.response.training;
        let source_of = |path: &PathBuf| self.session.sources.iter().find(|of| of.path == *path);
        let log = form.log.as_ref().filter(|_| form.mode.takes_log()).and_then(source_of)?;
        let force = form.log_force.as_ref().and_then(source_of);
        Some(MotionLogs {
            logs: vec![log.path.clone()],
            forces: force.map(|source| source.path.clone()).into_iter().collect(),
            map: log.map.clone(),
            contact: force.and(self.project.file_start.contact),
            impact_s: None,
            duration_s: DEFAULT_LOG_DURATION_S,
        })
    }

    /// Returns the question that fine-tunes the response network on data sets or a log; `None` if the
    /// current model is to be fine-tuned and there is none.
    pub(in crate::app) fn fine_tune_request(
        &self,
        (data, logs): (Vec<PathBuf>, Option<MotionLogs>),
    ) -> Option<FineTuneRequest> {
        let form: &ResponseTrainingForm = &self.project.response.training;
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
            vehicle: self.project.vehicle.clone(),
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
        let form: &ComparisonForm = &self.project.response.comparison;
        Some(EvaluateResponseRequest {
            model: choice(self.session.response.model.current.as_ref())?,
            data,
            split: form.evaluated_cases,
            vehicle: self.project.vehicle.clone(),
            seed: form.seed,
            bad_cases: form.bad_cases,
        })
    }

    /// Returns the question that compares response models on a data set.
    ///
    /// # Errors
    /// A message for the user, if the form does not list positive numbers of trajectories.
    pub(in crate::app) fn compare_request(&self, data: PathBuf) -> Result<CompareRequest, String> {
        let form: &ComparisonForm = &self.project.response.comparison;
        Ok(CompareRequest {
            trajectories: trajectories(&form.trajectories)?,
            choices: form.n_choices,
            seed: form.seed,
            vehicle: self.project.vehicle.clone(),
            config: config(&form.config),
            bad_cases: form.bad_cases,
            ..CompareRequest::new(data)
        })
    }

    fn scenario(&self) -> ScenarioChoice {
        ScenarioChoice::Inline(Box::new(self.project.scenario.clone()))
    }

    /// Returns the source of force and motion of the subject; `None` if nothing is selected or its
    /// data are not open.
    fn motion_source(&self) -> Option<MotionSource> {
        let find = |path: &Path| self.session.sources.iter().find(|source| source.path == path);
        match self.project.subject.as_ref()? {
            Subject::Case { dataset, case } => {
                find(dataset)?.dataset()?.dataset.case(case)?;
                Some(MotionSource::Case { dataset: dataset.clone(), case: case.clone() })
            }
            Subject::File(path) => {
                let Source { content: Content::File(file), map, .. } = find(path)? else {
                    return None;
                };
                let series = SeriesFile { path: path.clone(), map: map.clone() };
                let kind = file.loaded.kind;
                let of = &self.project.file_start;
                let beside = |path: &Option<PathBuf>| {
                    let of_path = |path: &PathBuf| {
                        let map = find(path).and_then(|source| source.map.clone());
                        SeriesFile { path: path.clone(), map }
                    };
                    path.as_ref().map(of_path)
                };
                let start = Drive {
                    speed_m_s: of.speed_m_s,
                    contact: of.contact,
                    steer: beside(&of.steer),
                    wheels: beside(&of.wheels),
                    ..Drive::default()
                };
                let is_steered = kind == FileKind::Steer || start.steer.is_some();
                let steering_ratio = of.steering_ratio.filter(|_| is_steered);
                let start = Drive { steering_ratio, ..start };
                Some(MotionSource::of_file(series, kind, start))
            }
            Subject::Scenario => {
                let pulse = self.project.pulse;
                Some(MotionSource::Scenario { scenario: self.scenario(), pulse })
            }
        }
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
