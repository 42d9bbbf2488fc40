//! What trainings, evaluations and comparisons of the response network will cost.

use std::ops::ControlFlow;

use crate::ask::cost::force::mean_without_first;
use crate::ask::cost::{Cost, Watch};
use crate::ask::inputs::data_name;
use crate::questions::train::response::TrainingNotes;
use crate::{
    CompareRequest, EvaluateResponseRequest, Event, FineTuneRequest, Learning, Library, Observer,
    Question, StudyError, TrainResponseRequest,
};
use impactlab_core::data::Outcome;
use impactlab_core::jobs::Progress;
use impactlab_core::uncertainty::Caveats;
use impactlab_networks::learning::{TEST_SHARE, TrainingReport};
use impactlab_networks::response::evaluate::evaluate_motion_model;
use impactlab_networks::response::{
    ImpactRecord, ResponseCase, ResponseConfig, ResponseModel, ResponseStage,
    ResponseTrainSettings, ResponseTrainingSet, Tuning, condition, fine_tune, pretrain,
};

/// Epochs of each stage that are measured; the first one, which is slower, does not count.
const MEASURED_EPOCHS: usize = 2;
/// Trajectories on which a car is conditioned to measure it.
const MEASURED_TRAJECTORIES: usize = 2;
/// Moves of the swarm that are measured; the swarm is evaluated once before the first move.
const MEASURED_MOVES: u64 = 2;

/// Settings with few epochs and without calibration, whose stages take as long as those of the
/// settings given.
fn measured(config: &ResponseConfig) -> ResponseConfig {
    let mut measured = config.clone();
    let least = |n: &mut usize| *n = (*n).min(MEASURED_EPOCHS);
    least(&mut measured.pretraining.epochs);
    least(&mut measured.single_steps.epochs);
    least(&mut measured.rollouts.epochs);
    measured.calibration.folds = 0;
    measured
}

/// The durations of epochs by stage, in the order of the stages, and what else a training took.
#[derive(Default)]
struct Stages {
    seconds: Vec<(String, Vec<f64>)>,
    is_broken: bool,
}

impl Stages {
    fn take(&mut self, report: &TrainingReport, observer: &mut Observer<'_>) -> ControlFlow<()> {
        if let TrainingReport::Epoch(epoch) = report {
            let stage = epoch.summary.stage.clone().unwrap_or_default();
            let seconds = epoch.summary.seconds.unwrap_or_default();
            match self.seconds.last_mut().filter(|(name, _)| *name == stage) {
                Some((_, of_stage)) => of_stage.push(seconds),
                None => self.seconds.push((stage, vec![seconds])),
            }
        }
        let flow = observer(Event::Progress(Progress::new(0, 0, "measuring epochs")));
        self.is_broken |= flow.is_break();
        flow
    }

    /// Adds the epochs of every stage and what else a training takes.
    fn add_to(&self, cost: &mut Cost, config: &ResponseConfig, total_s: f64) {
        let in_epochs_s: f64 = self.seconds.iter().flat_map(|(_, seconds)| seconds).sum();
        cost.add("preparation", 1.0, (total_s - in_epochs_s).max(0.0));
        for (stage, seconds) in &self.seconds {
            let n = match stage {
                name if *name == ResponseStage::Pretraining.to_string() => {
                    config.pretraining.epochs
                }
                name if *name == ResponseStage::SingleSteps.to_string() => {
                    config.single_steps.epochs
                }
                _ => config.rollouts.epochs,
            };
            cost.add(format!("epochs of {stage}"), n as f64, mean_without_first(seconds));
        }
    }
}

/// Measures a pre-training. `None` if the observer has broken.
fn pretraining_cost(
    name: &str,
    records: &[ImpactRecord],
    config: &ResponseConfig,
    seed: u64,
    observer: &mut Observer<'_>,
) -> Result<Option<(Cost, ResponseModel)>, StudyError> {
    let settings = ResponseTrainSettings::unsaved(measured(config), seed);
    let (mut stages, watch) = (Stages::default(), Watch::start());
    let model = pretrain(name, records, &settings, &mut |report| stages.take(report, observer))?;
    if stages.is_broken {
        return Ok(None);
    }
    let mut cost = Cost::default();
    stages.add_to(&mut cost, config, watch.seconds());
    Ok(Some((cost, model)))
}

/// Measures a fine-tuning, with the trainings for its calibration. `None` if the observer has
/// broken.
fn fine_tuning_cost(
    start: Option<&ResponseModel>,
    set: &ResponseTrainingSet,
    config: &ResponseConfig,
    seed: u64,
    observer: &mut Observer<'_>,
) -> Result<Option<Cost>, StudyError> {
    let settings = ResponseTrainSettings::unsaved(measured(config), seed);
    let (mut stages, watch) = (Stages::default(), Watch::start());
    fine_tune(start, set, &settings, &mut |report| stages.take(report, observer))?;
    if stages.is_broken {
        return Ok(None);
    }
    let mut cost = Cost::default();
    stages.add_to(&mut cost, config, watch.seconds());
    let n_folds = config.calibration.folds.min(set.train.len());
    if n_folds > 1 {
        // Each leaves out its part of the trajectories: together as much as one less than there are.
        let training = cost.clone();
        cost.add_all("calibration", &training, (n_folds - 1) as f64);
    }
    Ok(Some(cost))
}

impl TrainResponseRequest {
    /// Measures the simulations and some epochs.
    pub(super) fn cost(
        &self,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<Cost>, StudyError> {
        self.check()?;
        let records = self.records(&mut TrainingNotes::default(), library, observer)?;
        let Outcome::Complete(records) = records else { return Ok(Outcome::Cancelled) };
        let (config, name) = (self.settings()?, data_name(&self.data));
        let seed = self.training.seed;
        let measured = pretraining_cost(&name, &records, &config, seed, observer)?;
        Ok(measured.map_or(Outcome::Cancelled, |(cost, _)| Outcome::Complete(cost)))
    }
}

impl FineTuneRequest {
    /// Measures some epochs of each stage, or the conditioning on some trajectories.
    pub(super) fn cost(
        &self,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<Option<Cost>>, StudyError> {
        self.check()?;
        let (config, start) = self.settings(library)?;
        let set = self.training_set(&mut TrainingNotes::default(), library, observer)?;
        let Outcome::Complete(set) = set else { return Ok(Outcome::Cancelled) };
        let cost = match (self.learning, start.as_deref()) {
            (Learning::Fleet, _) => return Ok(Outcome::Complete(None)),
            (Learning::Network, start) => {
                let seed = self.choice.unwrap_or(self.training.seed);
                fine_tuning_cost(start, &set, &config, seed, observer)?
            }
            (Learning::Strengths, Some(start)) => Some(conditioning_cost(start, set)?),
            (Learning::Strengths, None) => return Err(StudyError::NoStart),
        };
        Ok(cost.map_or(Outcome::Cancelled, |cost| Outcome::Complete(Some(cost))))
    }
}

fn conditioning_cost(start: &ResponseModel, set: ResponseTrainingSet) -> Result<Cost, StudyError> {
    let mut train: Vec<ResponseCase> =
        set.train.into_iter().filter(|case| !start.is_trained_on(case)).collect();
    let n = train.len();
    train.truncate(MEASURED_TRAJECTORIES);
    let n_measured = train.len().max(1);
    let (watch, mut cost) = (Watch::start(), Cost::default());
    condition(start, &ResponseTrainingSet { train, ..ResponseTrainingSet::default() })?;
    cost.add("trajectories", n as f64, watch.seconds() / n_measured as f64);
    Ok(cost)
}

impl EvaluateResponseRequest {
    /// Measures as many cases as there are cores.
    pub(super) fn cost(
        &self,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<Cost>, StudyError> {
        let model = library.response_model(&self.model)?;
        let cases = self.cases(&model, &mut Caveats::default(), library, observer)?;
        let Outcome::Complete(usable) = cases else { return Ok(Outcome::Cancelled) };
        let cases = usable.cases;
        let n = rayon::current_num_threads().min(cases.len());
        let chosen: Vec<&ResponseCase> = cases.iter().take(n).collect();
        let (watch, mut cost) = (Watch::start(), Cost::default());
        let n_trained = model.record().train.len();
        evaluate_motion_model("", &chosen, &Self::motion_model(&model)?, n_trained, self.seed)?;
        cost.add("trajectories", cases.len() as f64, watch.seconds() / n.max(1) as f64);
        Ok(Outcome::Complete(cost))
    }
}

impl CompareRequest {
    /// Measures some epochs of each network and some moves of the swarm, for every number of
    /// trajectories.
    pub(super) fn cost(
        &self,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<Cost>, StudyError> {
        self.check()?;
        let (config, given) = self.settings(library)?;
        let cases = self.cases(&mut Caveats::default(), library, observer)?;
        let Outcome::Complete(usable) = cases else { return Ok(Outcome::Cancelled) };
        let name = data_name(&self.data);
        let all = ResponseTrainingSet::from_split(&name, &usable.cases, self.seed, TEST_SHARE);
        let records: Vec<ImpactRecord> =
            all.train.iter().filter_map(ResponseCase::impact).collect();
        let (mut cost, mut starts) = (Cost::default(), Vec::new());
        for (label, config) in [("PINN", config.clone()), ("NN-only", config.plain())] {
            let measured = pretraining_cost(&name, &records, &config, self.seed, observer)?;
            let Some((pretraining, model)) = measured else { return Ok(Outcome::Cancelled) };
            match given.as_deref().filter(|_| starts.is_empty()) {
                Some(given) => starts.push((label, config, given.copied()?)),
                None => {
                    cost.add_all(&format!("{label}, pre-training"), &pretraining, 1.0);
                    starts.push((label, config, model));
                }
            }
        }
        for n in &self.trajectories {
            let set = all.clone().choose(Some(*n), self.seed)?;
            let (cases, watch): (Vec<&ResponseCase>, _) =
                (set.train.iter().collect(), Watch::start());
            let mut tuning = config.tuning;
            tuning.iterations = tuning.iterations.min(MEASURED_MOVES);
            Tuning::fit(&cases, tuning, self.seed, &mut |_, _| ControlFlow::Continue(()));
            let move_s = watch.seconds() / (tuning.iterations + 1) as f64;
            let n_moves = self.choices * (config.tuning.iterations + 1);
            cost.add(format!("4DOF tuned on {n}, moves"), n_moves as f64, move_s);
            for (label, config, start) in &starts {
                let of_one = fine_tuning_cost(Some(start), &set, config, self.seed, observer)?;
                let Some(of_one) = of_one else { return Ok(Outcome::Cancelled) };
                cost.add_all(&format!("{label} on {n}"), &of_one, self.choices as f64);
            }
        }
        Ok(Outcome::Complete(cost))
    }
}
