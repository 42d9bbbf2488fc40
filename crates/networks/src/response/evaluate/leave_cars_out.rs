//! How far models err on cars that they have not seen, or of which they know a few trajectories.
//!
//! The cars are divided into parts. For each part a network is trained on the cars of the others; how
//! its strengths are distributed over cars is learned from the other parts, each predicted by the
//! network that has not seen it. What is asked is a quarter of the trajectories of each car, which are
//! never learned from; n of the others condition the network, and the 4DOF model is tuned on the same.
//!
//! A network that knows how cars differ is asked as it is, about cars that are all new to it.

use std::cell::Cell;
use std::ops::ControlFlow;

use crate::learning::{LearningError, TEST_SHARE, TrainSettings, TrainingReport, TrainingSet};
use crate::response::evaluate::compare::{CaseClusters, answers, clusters};
use crate::response::evaluate::{ComparedCase, Comparison, ComparisonSettings, MotionModel};
use crate::response::train::{cars_of, train_parts};
use crate::response::{
    ResponseCase, ResponseModel, ResponseTrainingSet, Tuning, UnseenCars, condition,
    learn_population,
};
use impactlab_core::jobs::{Progress, ProgressCallback};

/// Compares the network with tuned and untuned 4DOF model on cars that it has not seen. `None` if it
/// was broken off.
///
/// - `set`: trajectories of several cars;
/// - `start`: a pre-trained network, from which one is trained for each part of the cars; or one that
///   knows how cars differ, which is asked as it is.
///
/// # Errors
/// [`LearningError`], with [`LearningError::SeenCar`] of a car that a network which is asked as it is has
/// learned from.
pub fn compare_on_unseen_cars(
    set: &ResponseTrainingSet,
    start: &ResponseModel,
    settings: &ComparisonSettings,
    report: &mut ProgressCallback<'_>,
) -> Result<Option<Comparison>, LearningError> {
    let is_broken = Cell::new(false);
    let mut tell = |done: f64, message: &str| {
        let flow = report(Progress::new((done * 1000.0) as u64, 1000, message));
        is_broken.set(is_broken.get() || flow.is_break());
        flow
    };
    let mut compared = ComparedCars { settings, test: Vec::new(), rows: Vec::new() };
    match start.population() {
        Some(population) => {
            let is_seen = |case: &&ResponseCase| {
                start.is_trained_on(case) || population.known(&case.vehicle).is_some()
            };
            if let Some(seen) = set.train.iter().find(is_seen) {
                return Err(LearningError::SeenCar { case: seen.name.clone() });
            }
            compared.compare_each(start, &set.train, &mut tell)?;
        }
        None => compared.compare_parts(start, set, &mut tell)?,
    }
    if is_broken.get() {
        return Ok(None);
    }
    let ComparedCars { test, mut rows, .. } = compared;
    let test: Vec<&ResponseCase> = test.iter().collect();
    let clusters = clusters(&test, settings.seed);
    for row in &mut rows {
        row.cluster = clusters.of_case.get(row.cluster).copied().unwrap_or_default();
    }
    Ok(Some(Comparison::new(&set.name, settings, &test, &clusters, rows, &[])))
}

/// Receives the share that is done and what is being done, and may break off.
type Tell<'a> = dyn FnMut(f64, &str) -> ControlFlow<()> + 'a;

/// The answers of every model about cars that were left out.
struct ComparedCars<'a> {
    settings: &'a ComparisonSettings,
    test: Vec<ResponseCase>,
    rows: Vec<ComparedCase>,
}

impl ComparedCars<'_> {
    /// Asks a network that knows how cars differ about each car.
    ///
    /// - `tell`: receives the share that is done; what it returns may break off.
    fn compare_each(
        &mut self,
        model: &ResponseModel,
        cases: &[ResponseCase],
        tell: &mut Tell<'_>,
    ) -> Result<(), LearningError> {
        let cars = cars_of(cases);
        for (number, car) in cars.iter().enumerate() {
            if tell(number as f64 / cars.len() as f64, "cars that are new to it").is_break() {
                return Ok(());
            }
            let cases: Vec<&ResponseCase> = car.iter().filter_map(|idx| cases.get(*idx)).collect();
            self.compare(model, &cases)?;
        }
        Ok(())
    }

    /// Trains a network for each part of the cars on those of the others, and asks it about the part.
    ///
    /// - `tell`: as above.
    fn compare_parts(
        &mut self,
        start: &ResponseModel,
        set: &ResponseTrainingSet,
        tell: &mut Tell<'_>,
    ) -> Result<(), LearningError> {
        let training = TrainSettings::unsaved(self.settings.config.clone(), self.settings.seed);
        let mut is_broken = false;
        let mut on_progress = |progress: &TrainingReport| {
            let TrainingReport::Epoch(epoch) = progress else { return ControlFlow::Continue(()) };
            let flow = tell(0.8 * epoch.share_done(), "training on other cars");
            is_broken |= flow.is_break();
            flow
        };
        let parts = train_parts(start, set, &training, &mut on_progress)?;
        if is_broken {
            return Ok(());
        }
        for (number, part) in parts.iter().enumerate() {
            let mut model = part.model.copied()?;
            let others = parts.iter().enumerate().filter(|(other, _)| *other != number);
            let unseen: Vec<UnseenCars<'_>> = others.map(|(_, other)| other.unseen(set)).collect();
            let is_learned = |case: &&ResponseCase| part.model.is_trained_on(case);
            let train: Vec<ResponseCase> = set.train.iter().filter(is_learned).cloned().collect();
            let done = |share: f64| 0.8 + 0.2 * (number as f64 + share) / parts.len() as f64;
            let mut on_fit = |report: &TrainingReport| {
                let TrainingReport::Fit(_) = report else { return ControlFlow::Continue(()) };
                let share = f64::from(report.progress().fraction().unwrap_or(0.0));
                let flow = tell(done(share), "cars that were left out");
                is_broken |= flow.is_break();
                flow
            };
            learn_population(&mut model, &unseen, &train, &mut on_fit)?;
            if is_broken {
                return Ok(());
            }
            for cases in part.unseen(set).cars {
                self.compare(&model, &cases)?;
            }
            if tell(done(1.0), "cars that were left out").is_break() {
                return Ok(());
            }
        }
        Ok(())
    }

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
        // Each is a cluster of its own until those of all cars can be clustered.
        let of_case = (self.test.len()..self.test.len() + test.len()).collect();
        let clusters = CaseClusters { of_case, clusters: None };
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
