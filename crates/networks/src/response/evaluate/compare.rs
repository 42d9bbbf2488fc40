//! Trains all models on the same trajectories and asks them about the same others.

use std::cell::Cell;
use std::ops::ControlFlow;

use crate::learning::{LearningError, TEST_SHARE, TrainSettings, TrainingReport, TrainingSet};
use crate::response::evaluate::{
    ComparedCase, Comparison, MotionCaseMetrics, MotionModel, path_of,
};
use crate::response::train::check_start;
use crate::response::{
    ImpactRecord, ResponseCase, ResponseConfig, ResponseModel, ResponseTrainingSet, Tuning,
    fine_tune, pretrain,
};
use impactlab_core::collision::{ImpulseClusters, ImpulseFeatures};
use impactlab_core::jobs::{Progress, ProgressCallback};
use rayon::prelude::*;

/// Settings of a comparison.
#[derive(Debug, Clone, PartialEq)]
pub struct ComparisonSettings {
    /// Sizes, weights and rates of the networks.
    pub config: ResponseConfig,
    /// Numbers of fine-tune trajectories.
    pub trajectories: Vec<usize>,
    /// Choices of the trajectories for each number.
    pub n_choices: u64,
    /// Seed of the split into training and test, and of the first choice.
    pub seed: u64,
}

/// Trains the models of every number and choice of trajectories and compares them on the trajectories
/// kept for the test. `None` if it was broken off.
///
/// - `start`: a pre-trained response network; `None` to pre-train one here.
///
/// # Errors
/// [`LearningError`].
pub fn compare_models(
    name: &str,
    cases: &[ResponseCase],
    start: Option<&ResponseModel>,
    settings: &ComparisonSettings,
    report: &mut ProgressCallback<'_>,
) -> Result<Option<Comparison>, LearningError> {
    let all = TrainingSet::from_split(name, cases, settings.seed, TEST_SHARE);
    // What cannot be trained is said before the hours that the trainings take.
    all.check_size(settings.trajectories.iter().copied().max().unwrap_or(1).max(1))?;
    if let Some(start) = start {
        check_start(start, &settings.config, settings.seed)?;
    }
    let test: Vec<&ResponseCase> =
        cases.iter().filter(|case| all.test.iter().any(|id| id.digest == case.digest)).collect();
    let clusters = clusters(&test, settings.seed);
    let mut work = Work::new(settings, report);
    let Some(starts) = work.pretrained(&all, start)? else { return Ok(None) };
    let mut rows = answers(&MotionModel::Untuned, 0, settings.seed, &test, &clusters)?;
    let mut times = Vec::new();
    for &n in &settings.trajectories {
        for choice in settings.seed..settings.seed + settings.n_choices {
            let set = all.clone().choose(Some(n), choice)?;
            let Some(models) = work.trained(&set, &starts, choice)? else { return Ok(None) };
            for (model, seconds) in models {
                times.push((model.kind(), n, seconds));
                rows.extend(answers(&model, n, choice, &test, &clusters)?);
            }
        }
    }
    Ok(Some(Comparison::new(name, settings, &test, &clusters, rows, &times)))
}

/// One model on trajectories, as a comparison of one.
///
/// # Errors
/// [`LearningError`].
pub fn evaluate_motion_model(
    name: &str,
    cases: &[&ResponseCase],
    model: &MotionModel,
    trajectories: usize,
    seed: u64,
) -> Result<Comparison, LearningError> {
    let clusters = clusters(cases, seed);
    let rows = answers(model, trajectories, seed, cases, &clusters)?;
    let settings = ComparisonSettings {
        config: ResponseConfig::default(),
        trajectories: vec![trajectories],
        n_choices: 1,
        seed,
    };
    Ok(Comparison::new(name, &settings, cases, &clusters, rows, &[]))
}

/// Cluster of each trajectory, and the clusters, if there are any.
pub(super) struct CaseClusters {
    pub of_case: Vec<usize>,
    pub clusters: Option<ImpulseClusters>,
}

pub(super) fn clusters(cases: &[&ResponseCase], seed: u64) -> CaseClusters {
    let features: Vec<Option<ImpulseFeatures>> =
        cases.iter().map(|case| ImpulseFeatures::from_history(&case.force_history())).collect();
    let known: Vec<ImpulseFeatures> = features.iter().flatten().copied().collect();
    // Too few trajectories to cluster make one cluster.
    let clusters = ImpulseClusters::fit(&known, seed).ok();
    let cluster = |features: &Option<ImpulseFeatures>| match (&clusters, features) {
        (Some(clusters), Some(features)) => clusters.nearest(features),
        _ => 0,
    };
    CaseClusters { of_case: features.iter().map(cluster).collect(), clusters }
}

/// What a model says of trajectories.
pub(super) fn answers(
    model: &MotionModel,
    trajectories: usize,
    choice: u64,
    cases: &[&ResponseCase],
    clusters: &CaseClusters,
) -> Result<Vec<ComparedCase>, LearningError> {
    let kind = model.kind();
    let answer = |(case, cluster): (&&ResponseCase, &usize)| {
        let (metrics, states) = MotionCaseMetrics::evaluate(model, case)?;
        Ok(ComparedCase {
            case: case.name.clone(),
            cluster: *cluster,
            is_braked: case.is_braked(),
            model: kind.label().to_owned(),
            kind,
            trajectories,
            choice,
            metrics,
            path: path_of(&states),
        })
    };
    cases.par_iter().zip(&clusters.of_case).map(answer).collect()
}

/// Trainings, one after the other, under one progress.
struct Work<'a, 'b> {
    settings: &'a ComparisonSettings,
    report: &'a mut ProgressCallback<'b>,
    is_broken: Cell<bool>,
    done: u64,
    total: u64,
}

impl<'a, 'b> Work<'a, 'b> {
    fn new(settings: &'a ComparisonSettings, report: &'a mut ProgressCallback<'b>) -> Self {
        let n_sets = settings.trajectories.len() as u64 * settings.n_choices;
        // Two pre-trainings; of each set a tuning, a network and a plain network.
        Self { settings, report, is_broken: Cell::new(false), done: 0, total: 2 + 3 * n_sets }
    }

    fn tell(&mut self, share: f64, message: &str) -> ControlFlow<()> {
        let done = self.done * 100 + (share * 100.0) as u64;
        let flow = (self.report)(Progress::new(done, self.total * 100, message));
        self.is_broken.set(self.is_broken.get() || flow.is_break());
        flow
    }

    fn is_broken(&mut self) -> bool {
        self.done += 1;
        self.is_broken.get()
    }

    /// The pre-trained network and the pre-trained plain one.
    fn pretrained(
        &mut self,
        set: &ResponseTrainingSet,
        start: Option<&ResponseModel>,
    ) -> Result<Option<[ResponseModel; 2]>, LearningError> {
        let records: Vec<ImpactRecord> =
            set.train.iter().filter_map(ResponseCase::impact).collect();
        let mut models = Vec::new();
        for (config, message) in [
            (self.settings.config.clone(), "pre-training"),
            (self.settings.config.plain(), "pre-training the plain network"),
        ] {
            let is_given = models.is_empty() && start.is_some();
            let model = match start.filter(|_| is_given) {
                Some(start) => start.copied()?,
                None => {
                    let settings = TrainSettings::unsaved(config, self.settings.seed);
                    pretrain(&set.name, &records, &settings, &mut |progress| {
                        self.tell(share_done(progress), message)
                    })?
                }
            };
            models.push(model);
            if self.is_broken() {
                return Ok(None);
            }
        }
        Ok(<[ResponseModel; 2]>::try_from(models).ok())
    }

    /// The models of one set, with the seconds that each took.
    fn trained(
        &mut self,
        set: &ResponseTrainingSet,
        [start, plain_start]: &[ResponseModel; 2],
        choice: u64,
    ) -> Result<Option<Vec<(MotionModel, f64)>>, LearningError> {
        let n = set.train.len();
        let mut models = Vec::new();
        let config = self.settings.config.clone();
        let started = std::time::Instant::now();
        let cases: Vec<&ResponseCase> = set.train.iter().collect();
        let tuning = Tuning::fit(&cases, config.tuning, choice, &mut |done, _| {
            let share = done as f64 / config.tuning.iterations.max(1) as f64;
            self.tell(share.min(1.0), &format!("4DOF tuned on {n} trajectories"))
        });
        models.push((MotionModel::Tuned(tuning), started.elapsed().as_secs_f64()));
        if self.is_broken() {
            return Ok(None);
        }
        let networks = [(config.clone(), start, "PINN"), (config.plain(), plain_start, "NN-only")];
        for (idx, (config, start, label)) in networks.into_iter().enumerate() {
            let started = std::time::Instant::now();
            let settings = TrainSettings::unsaved(config, choice);
            let model = fine_tune(Some(start), set, &settings, &mut |progress| {
                let part = match progress {
                    TrainingReport::Epoch(epoch) => epoch.part().unwrap_or_default(),
                    TrainingReport::Fit(fit) => fit.what.clone(),
                };
                self.tell(share_done(progress), &format!("{label} on {n} trajectories, {part}"))
            })?;
            let model = Box::new(model);
            let model =
                if idx == 0 { MotionModel::Network(model) } else { MotionModel::Plain(model) };
            models.push((model, started.elapsed().as_secs_f64()));
            if self.is_broken() {
                return Ok(None);
            }
        }
        Ok(Some(models))
    }
}

/// Share that is done of a training, 0 to 1.
fn share_done(progress: &TrainingReport) -> f64 {
    match progress {
        TrainingReport::Fit { .. } => 0.0,
        TrainingReport::Epoch(epoch) => epoch.share_done(),
    }
}
