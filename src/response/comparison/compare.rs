//! Trains all models on the same trajectories and asks them about the same others.

use std::cell::Cell;
use std::ops::ControlFlow;

use rayon::prelude::*;
use serde::Serialize;

use crate::data::TEST_SHARE;
use crate::force::{ImpulseClusters, ImpulseFeatures};
use crate::jobs::{Progress, Report};
use crate::response::comparison::{CaseFigures, ModelFigures, Rival, RivalKind};
use crate::response::{
    ImpactRecord, ResponseCase, ResponseConfig, ResponseError, ResponseModel,
    ResponseTrainSettings, ResponseTrainingSet, Tuning, fine_tune, pretrain,
};
use crate::vehicle::VehicleState;

/// What to compare.
#[derive(Debug, Clone, PartialEq)]
pub struct ComparisonSettings {
    /// Sizes, weights and rates of the networks.
    pub config: ResponseConfig,
    /// Numbers of fine-tune trajectories.
    pub trajectories: Vec<usize>,
    /// Choices of the trajectories for each number.
    pub n_choices: u64,
    /// Of the split into training and test, and of the first choice.
    pub seed: u64,
}

/// A model with its figures.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ComparedModel {
    /// Such as `PINN`.
    pub name: &'static str,
    /// Its kind.
    pub kind: RivalKind,
    /// Trajectories it was fine-tuned on; 0 for none.
    pub trajectories: usize,
    /// Over all trajectories asked about.
    #[serde(flatten)]
    pub figures: ModelFigures,
    /// Mean average error of each choice of the fine-tune trajectories, m.
    pub average_error_by_choice_m: Vec<f64>,
    /// Seconds that a training took, mean over the choices.
    pub training_s: f64,
}

/// One model on one trajectory.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ComparedCase {
    /// Name of the trajectory.
    pub case: String,
    /// Its cluster by impulse.
    pub cluster: usize,
    /// The model.
    pub model: &'static str,
    /// Its kind.
    pub kind: RivalKind,
    /// Trajectories it was fine-tuned on.
    pub trajectories: usize,
    /// Which choice of them.
    pub choice: u64,
    /// Its figures.
    #[serde(flatten)]
    pub figures: CaseFigures,
    /// Where it says the vehicle goes.
    #[serde(skip)]
    pub states: Vec<VehicleState<f64>>,
}

/// The models on one cluster of trajectories.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ClusterRow {
    /// Such as `C0`, by rising impulse.
    pub name: String,
    /// Trajectories in it.
    pub n: usize,
    /// Impulse at its centre, N s.
    pub impulse_n_s: Option<f64>,
    /// Name, trajectories and figures of each model.
    pub models: Vec<(&'static str, usize, ModelFigures)>,
}

/// All models on the same trajectories.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// What the data are called.
    pub data: String,
    /// Of the split and the first choice.
    pub seed: u64,
    /// Choices for each number of trajectories.
    pub n_choices: u64,
    /// Names of the trajectories asked about.
    pub test: Vec<String>,
    /// The models.
    pub models: Vec<ComparedModel>,
    /// By cluster.
    pub clusters: Vec<ClusterRow>,
    /// By trajectory.
    pub cases: Vec<ComparedCase>,
}

/// The callback of a comparison.
pub type ComparisonProgress<'a> = Report<'a>;

/// Trains the models of every number and choice of trajectories and compares them on the trajectories
/// kept for the test. `None` if it was broken off.
///
/// - `start`: a pre-trained response network; `None` to pre-train one here.
///
/// # Errors
/// [`ResponseError`].
pub fn compare_models(
    (name, cases): (&str, &[ResponseCase]),
    start: Option<&ResponseModel>,
    settings: &ComparisonSettings,
    report: &mut ComparisonProgress<'_>,
) -> Result<Option<Comparison>, ResponseError> {
    let all = ResponseTrainingSet::choose(name, cases, None, (settings.seed, TEST_SHARE, 0))?;
    let test: Vec<&ResponseCase> =
        cases.iter().filter(|case| all.test.iter().any(|id| id.digest == case.digest)).collect();
    let clusters = clusters(&test, settings.seed);
    let mut work = Work::new(settings, report);
    let Some(starts) = work.pretrained(&all, start)? else { return Ok(None) };
    let mut rows = answers((&Rival::Untuned, 0, settings.seed), &test, &clusters)?;
    let mut times = Vec::new();
    for &n in &settings.trajectories {
        for choice in settings.seed..settings.seed + settings.n_choices {
            let split = (settings.seed, TEST_SHARE, choice);
            let set = ResponseTrainingSet::choose(name, cases, Some(n), split)?;
            let Some(rivals) = work.trained(&set, &starts, choice)? else { return Ok(None) };
            for (rival, seconds) in rivals {
                times.push((rival.kind(), n, seconds));
                rows.extend(answers((&rival, n, choice), &test, &clusters)?);
            }
        }
    }
    Ok(Some(Comparison::of((name, settings), &test, &clusters, rows, &times)))
}

/// One model on trajectories, as a comparison of one.
///
/// # Errors
/// [`ResponseError`].
pub fn evaluate_rival(
    (name, cases): (&str, &[&ResponseCase]),
    rival: &Rival,
    (trajectories, seed): (usize, u64),
) -> Result<Comparison, ResponseError> {
    let clusters = clusters(cases, seed);
    let rows = answers((rival, trajectories, seed), cases, &clusters)?;
    let settings = ComparisonSettings {
        config: ResponseConfig::default(),
        trajectories: vec![trajectories],
        n_choices: 1,
        seed,
    };
    Ok(Comparison::of((name, &settings), cases, &clusters, rows, &[]))
}

/// Cluster of each trajectory, and the clusters, if there are any.
struct CaseClusters {
    of_case: Vec<usize>,
    clusters: Option<ImpulseClusters>,
}

fn clusters(cases: &[&ResponseCase], seed: u64) -> CaseClusters {
    let features: Vec<Option<ImpulseFeatures>> =
        cases.iter().map(|case| ImpulseFeatures::of(&case.force_history())).collect();
    let known: Vec<ImpulseFeatures> = features.iter().flatten().copied().collect();
    // Too few trajectories to cluster make one cluster.
    let clusters = ImpulseClusters::fit(&known, seed).ok();
    let of = |features: &Option<ImpulseFeatures>| match (&clusters, features) {
        (Some(clusters), Some(features)) => clusters.of(features),
        _ => 0,
    };
    CaseClusters { of_case: features.iter().map(of).collect(), clusters }
}

fn answers(
    (rival, trajectories, choice): (&Rival, usize, u64),
    cases: &[&ResponseCase],
    clusters: &CaseClusters,
) -> Result<Vec<ComparedCase>, ResponseError> {
    let kind = rival.kind();
    let answer = |(case, cluster): (&&ResponseCase, &usize)| {
        let (figures, states) = CaseFigures::of(rival, case)?;
        Ok(ComparedCase {
            case: case.name.clone(),
            cluster: *cluster,
            model: kind.label(),
            kind,
            trajectories,
            choice,
            figures,
            states,
        })
    };
    cases.par_iter().zip(&clusters.of_case).map(answer).collect()
}

/// Trainings, one after the other, under one progress.
struct Work<'a, 'b> {
    settings: &'a ComparisonSettings,
    report: &'a mut ComparisonProgress<'b>,
    is_broken: Cell<bool>,
    done: u64,
    total: u64,
}

impl<'a, 'b> Work<'a, 'b> {
    fn new(settings: &'a ComparisonSettings, report: &'a mut ComparisonProgress<'b>) -> Self {
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
    ) -> Result<Option<[ResponseModel; 2]>, ResponseError> {
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
                    let settings = self.training_settings(config, self.settings.seed);
                    pretrain((&set.name, &records), &settings, &mut |told| {
                        let share = told.record.epoch as f64 / told.n_epochs.max(1) as f64;
                        self.tell(share, message)
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

    fn training_settings(&self, config: ResponseConfig, seed: u64) -> ResponseTrainSettings {
        ResponseTrainSettings { config, seed, checkpoint: None, resume: false }
    }

    /// The models of one set, with the seconds that each took.
    fn trained(
        &mut self,
        set: &ResponseTrainingSet,
        [start, plain_start]: &[ResponseModel; 2],
        choice: u64,
    ) -> Result<Option<Vec<(Rival, f64)>>, ResponseError> {
        let n = set.train.len();
        let mut rivals = Vec::new();
        let config = self.settings.config.clone();
        let started = std::time::Instant::now();
        let cases: Vec<&ResponseCase> = set.train.iter().collect();
        let tuning = Tuning::fit(&cases, config.tuning, choice, &mut |done, _| {
            let share = done as f64 / config.tuning.iterations.max(1) as f64;
            self.tell(share.min(1.0), &format!("4DOF tuned on {n} trajectories"))
        });
        rivals.push((Rival::Tuned(tuning), started.elapsed().as_secs_f64()));
        if self.is_broken() {
            return Ok(None);
        }
        let of = [(config.clone(), start, "PINN"), (config.plain(), plain_start, "NN-only")];
        for (idx, (config, start, label)) in of.into_iter().enumerate() {
            let started = std::time::Instant::now();
            let settings = self.training_settings(config, choice);
            let model = fine_tune(Some(start), set, &settings, &mut |told| {
                let in_training = told.record.epoch as f64 / told.n_epochs.max(1) as f64;
                let share = (told.training_idx as f64 + in_training) / told.n_trainings as f64;
                self.tell(share, &format!("{label} on {n} trajectories, {}", told.record.stage))
            })?;
            let model = Box::new(model);
            let rival = if idx == 0 { Rival::Network(model) } else { Rival::Plain(model) };
            rivals.push((rival, started.elapsed().as_secs_f64()));
            if self.is_broken() {
                return Ok(None);
            }
        }
        Ok(Some(rivals))
    }
}

impl Comparison {
    fn of(
        (name, settings): (&str, &ComparisonSettings),
        test: &[&ResponseCase],
        clusters: &CaseClusters,
        cases: Vec<ComparedCase>,
        times: &[(RivalKind, usize, f64)],
    ) -> Self {
        let mut kinds: Vec<(RivalKind, usize)> =
            cases.iter().map(|row| (row.kind, row.trajectories)).collect();
        kinds.sort_by_key(|(kind, n)| (*n, *kind));
        kinds.dedup();
        let of_kind = |(kind, n): (RivalKind, usize)| -> Vec<&ComparedCase> {
            cases.iter().filter(|row| row.kind == kind && row.trajectories == n).collect()
        };
        let model = |&(kind, n): &(RivalKind, usize)| {
            let rows = of_kind((kind, n));
            let figures: Vec<&CaseFigures> = rows.iter().map(|row| &row.figures).collect();
            let mut choices: Vec<u64> = rows.iter().map(|row| row.choice).collect();
            choices.sort_unstable();
            choices.dedup();
            let mean = |choice: &u64| {
                let of = rows.iter().filter(|row| row.choice == *choice);
                let errors: Vec<f64> = of.map(|row| row.figures.error.average_error_m).collect();
                errors.iter().sum::<f64>() / errors.len().max(1) as f64
            };
            let of_times = times.iter().filter(|(k, m, _)| (*k, *m) == (kind, n));
            let seconds: Vec<f64> = of_times.map(|(_, _, seconds)| *seconds).collect();
            ComparedModel {
                name: kind.label(),
                kind,
                trajectories: n,
                figures: ModelFigures::of(&figures),
                average_error_by_choice_m: choices.iter().map(mean).collect(),
                training_s: seconds.iter().sum::<f64>() / seconds.len().max(1) as f64,
            }
        };
        let models: Vec<ComparedModel> = kinds.iter().map(model).collect();
        let n_clusters = clusters.clusters.as_ref().map_or(1, ImpulseClusters::n_clusters);
        let cluster = |cluster: usize| {
            let of_model = |&(kind, n): &(RivalKind, usize)| {
                let rows = of_kind((kind, n));
                let figures: Vec<&CaseFigures> = rows
                    .iter()
                    .filter(|row| row.cluster == cluster)
                    .map(|row| &row.figures)
                    .collect();
                (kind.label(), n, ModelFigures::of(&figures))
            };
            ClusterRow {
                name: ImpulseClusters::label(cluster),
                n: clusters.of_case.iter().filter(|of| **of == cluster).count(),
                impulse_n_s: clusters.clusters.as_ref().and_then(|of| of.impulse_n_s(cluster)),
                models: kinds.iter().map(of_model).collect(),
            }
        };
        let clusters: Vec<ClusterRow> =
            (0..n_clusters).map(cluster).filter(|cluster| cluster.n > 0).collect();
        Self {
            data: name.to_owned(),
            seed: settings.seed,
            n_choices: settings.n_choices,
            test: test.iter().map(|case| case.name.clone()).collect(),
            models,
            clusters,
            cases,
        }
    }
}
