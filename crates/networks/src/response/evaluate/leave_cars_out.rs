//! How far models err on cars that they have not seen, or of which they know a few trajectories.
//!
//! The cars are divided into parts. For each part a network is trained on the cars of the others; how
//! its strengths are distributed over cars is learned from the other parts, each predicted by the
//! network that has not seen it. What is asked is a quarter of the trajectories of each car, which are
//! never learned from; n of the others condition the network, and the 4DOF model is tuned on the same.

use std::cell::Cell;
use std::ops::ControlFlow;

use crate::learning::{LearningError, TEST_SHARE, TrainSettings, TrainingReport, TrainingSet};
use crate::response::evaluate::compare::{answers, clusters};
use crate::response::evaluate::{ComparedCase, Comparison, ComparisonSettings, MotionModel};
use crate::response::train::train_parts;
use crate::response::{
    ResponseCase, ResponseModel, ResponseTrainingSet, Tuning, UnseenCars, condition,
    learn_population,
};
use impactlab_core::jobs::{Progress, ProgressCallback};

/// Compares the network with tuned and untuned 4DOF model on cars that it has not seen. `None` if it
/// was broken off.
///
/// - `set`: trajectories of several cars;
/// - `start`: a pre-trained network.
///
/// # Errors
/// [`LearningError`].
pub fn compare_on_unseen_cars(
    set: &ResponseTrainingSet,
    start: &ResponseModel,
    settings: &ComparisonSettings,
    report: &mut ProgressCallback<'_>,
) -> Result<Option<Comparison>, LearningError> {
    let training = TrainSettings::unsaved(settings.config.clone(), settings.seed);
    let is_broken = Cell::new(false);
    let mut tell = |done: f64, message: &str| {
        let flow = report(Progress::new((done * 1000.0) as u64, 1000, message));
        is_broken.set(is_broken.get() || flow.is_break());
        flow
    };
    let mut on_progress = |progress: &TrainingReport| match progress {
        TrainingReport::Epoch(epoch) => tell(0.8 * epoch.share_done(), "training on other cars"),
        TrainingReport::Fit(_) => ControlFlow::Continue(()),
    };
    let parts = train_parts(start, set, &training, &mut on_progress)?;
    if is_broken.get() {
        return Ok(None);
    }
    let mut compared = ComparedCars { settings, test: Vec::new(), rows: Vec::new() };
    for (number, part) in parts.iter().enumerate() {
        let others = parts.iter().enumerate().filter(|(other, _)| *other != number);
        let unseen: Vec<UnseenCars<'_>> = others.map(|(_, other)| other.unseen(set)).collect();
        let is_learned = |case: &&ResponseCase| part.model.is_trained_on(case);
        let train: Vec<ResponseCase> = set.train.iter().filter(is_learned).cloned().collect();
        let mut model = part.model.copied()?;
        let mut on_fit = |report: &TrainingReport| match report {
            TrainingReport::Fit(_) => {
                let share = f64::from(report.progress().fraction().unwrap_or(0.0));
                let done = 0.8 + 0.2 * (number as f64 + share) / parts.len() as f64;
                tell(done, "cars that were left out")
            }
            TrainingReport::Epoch(_) => ControlFlow::Continue(()),
        };
        learn_population(&mut model, &unseen, &train, &mut on_fit)?;
        if is_broken.get() {
            return Ok(None);
        }
        for cases in part.unseen(set).cars {
            compared.compare(&model, &cases)?;
        }
        let done = 0.8 + 0.2 * (number + 1) as f64 / parts.len() as f64;
        if tell(done, "cars that were left out").is_break() {
            return Ok(None);
        }
    }
    let ComparedCars { test, rows, .. } = compared;
    let test: Vec<&ResponseCase> = test.iter().collect();
    let clusters = clusters(&test, settings.seed);
    Ok(Some(Comparison::new(&set.name, settings, &test, &clusters, rows, &[])))
}

/// The answers of every model about cars that were left out.
struct ComparedCars<'a> {
    settings: &'a ComparisonSettings,
    test: Vec<ResponseCase>,
    rows: Vec<ComparedCase>,
}

impl ComparedCars<'_> {
    /// Asks every model about a car.
    ///
    /// - `model`: that has not seen it.
    fn compare(
        &mut self,
        model: &ResponseModel,
        cases: &[&ResponseCase],
    ) -> Result<(), LearningError> {
        let seed = self.settings.seed;
        let cases: Vec<ResponseCase> = cases.iter().copied().cloned().collect();
        let all = TrainingSet::from_split(String::new(), &cases, seed, TEST_SHARE);
        let is_test = |case: &&ResponseCase| all.test.iter().any(|id| id.digest == case.digest);
        let test: Vec<&ResponseCase> = cases.iter().filter(is_test).collect();
        let clusters = clusters(&test, seed);
        let mut add = |model: &MotionModel, n: usize, choice: u64| -> Result<(), LearningError> {
            self.rows.extend(answers(model, n, choice, &test, &clusters)?);
            Ok(())
        };
        add(&MotionModel::Untuned, 0, seed)?;
        add(&MotionModel::Network(Box::new(model.copied()?)), 0, seed)?;
        for &n in &self.settings.trajectories {
            for choice in seed..seed + self.settings.n_choices {
                let set = all.clone().choose(Some(n), choice)?;
                let learned: Vec<&ResponseCase> = set.train.iter().collect();
                let tuning =
                    Tuning::fit(&learned, self.settings.config.tuning, choice, &mut |_, _| {
                        ControlFlow::Continue(())
                    });
                add(&MotionModel::Tuned(tuning), n, choice)?;
                add(&MotionModel::Network(Box::new(condition(model, &set)?)), n, choice)?;
            }
        }
        self.test.extend(test.into_iter().cloned());
        Ok(())
    }
}
