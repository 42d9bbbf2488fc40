//! Trains a response network on the cars of a fleet, so that it holds for a car that nobody has
//! measured, and says how far.
//!
//! The cars are divided into parts. A training leaves out each part, and predicts it: from this the
//! distribution of the strengths over cars is learned, and how wide the regions have to be. A car with
//! many more trajectories than the others is left out of none: without it there would be little to
//! learn from. Instead a share of its trajectories is left out of each, by which the regions of a car
//! that is well known are calibrated. What is used is a training on all cars, whose trajectories make
//! them known.

use std::cell::Cell;

use rayon::prelude::*;

use crate::learning::{EpochReport, LearningError, TrainingProgress, TrainingReport};
use crate::response::train::stages::fine_tune_once;
use crate::response::{
    MotionDomain, ResponseCase, ResponseModel, ResponseTrainSettings, ResponseTrainingSet,
    StrengthPopulation, UnseenCar, Widths, is_same_car,
};

/// Parts of the fleet.
const N_PARTS: usize = 4;
/// A car with more than this many times the trajectories of the median car is left out of no training.
const MANY: usize = 2;
/// Growths of all deviations, factors on them, factors about the best of these, and ratios of the two
/// widths that are tried, and the levels at which the regions shall be right.
const GROWTHS: [f64; 4] = [0.0, 0.5, 1.0, 2.0];
const FACTORS: [f64; 9] = [0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0, 1.3, 2.0];
const FINE_FACTORS: [f64; 4] = [0.84, 0.92, 1.08, 1.16];
const RATIOS: [f64; 7] = [1.0, 1.5, 2.0, 3.0, 4.5, 7.0, 10.0];
const LEVELS: [f64; 2] = [0.5, 0.9];
/// How many times what the larger regions hold too little counts: regions that are too narrow mislead,
/// those that are too wide do not.
const SHORTFALL: f64 = 3.0;
/// Steps from one instant at which the regions are looked at to the next: 1 s, up to 12 s, which is as
/// long as the recordings of a fleet. Regions that were calibrated up to 4 s held 69 % of the ends at 8 s
/// instead of 90 %.
const STRIDE_STEPS: usize = 100;
const N_INSTANTS: usize = 12;

/// Trajectories of cars, and a model that has not seen them.
#[derive(Debug)]
pub struct UnseenCars<'a> {
    /// The model.
    pub model: &'a ResponseModel,
    /// The trajectories of each car.
    pub cars: Vec<Vec<&'a ResponseCase>>,
    /// Trajectories that it has not seen of cars that it has learned from.
    pub motions: Vec<&'a ResponseCase>,
}

/// Trains a network on a fleet.
///
/// - `start`: a pre-trained model;
/// - `set`: trajectories of several cars.
///
/// # Errors
/// [`LearningError::TooFewCases`] for fewer cars than parts, and those of the trainings.
pub fn train_fleet(
    start: &ResponseModel,
    set: &ResponseTrainingSet,
    settings: &ResponseTrainSettings,
    report: &mut TrainingProgress<'_>,
) -> Result<ResponseModel, LearningError> {
    let is_cut = Cell::new(false);
    let mut on_progress = |progress: &TrainingReport| {
        let flow = report(progress);
        is_cut.set(is_cut.get() || flow.is_break());
        flow
    };
    let parts = train_parts(start, set, settings, &mut on_progress)?;
    let mut last = |progress: &TrainingReport| on_progress(&numbered(progress, N_PARTS));
    let mut model = fine_tune_once(Some(start), set, settings, &mut last)?;
    if is_cut.get() {
        return Ok(model);
    }
    let unseen: Vec<UnseenCars<'_>> = parts.iter().map(|part| part.unseen(set)).collect();
    learn_population(&mut model, &unseen, &set.train)?;
    Ok(model)
}

/// A model after trajectories of one or several cars: a Gaussian update of the strengths of each, by
/// which its regions narrow. The network stays as it is. Trajectories that the model has learned from
/// already say nothing new.
///
/// # Errors
/// [`LearningError::NoPopulation`] for a model that was not trained on a fleet,
/// [`LearningError::NothingNew`], [`LearningError::Network`].
pub fn condition(
    start: &ResponseModel,
    set: &ResponseTrainingSet,
) -> Result<ResponseModel, LearningError> {
    let mut population = start.population().ok_or(LearningError::NoPopulation)?.clone();
    let new: Vec<ResponseCase> =
        set.train.iter().filter(|case| !start.is_trained_on(case)).cloned().collect();
    if new.is_empty() {
        return Err(LearningError::NothingNew);
    }
    for car in cars_of(&new) {
        let cases: Vec<&ResponseCase> = car.iter().filter_map(|idx| new.get(*idx)).collect();
        population = population.with_car(start.network(), &cases)?;
    }
    let mut model = start.copied()?;
    model.set_population(population);
    model.add_to_record(&set.name, &new);
    Ok(model)
}

/// Which trajectories a training leaves out, by their numbers.
#[derive(Debug, Clone, Default)]
struct LeftOut {
    /// Those of each car that is left out whole.
    cars: Vec<Vec<usize>>,
    /// Those of cars that are learned from.
    motions: Vec<usize>,
}

/// A part of the fleet, and the network that has not seen it.
pub(crate) struct FleetPart {
    left_out: LeftOut,
    /// The network.
    pub model: ResponseModel,
}

impl FleetPart {
    /// What the network has not seen.
    ///
    /// - `set`: the trajectories of the whole fleet.
    pub fn unseen<'a>(&'a self, set: &'a ResponseTrainingSet) -> UnseenCars<'a> {
        let chosen = |numbers: &Vec<usize>| -> Vec<&'a ResponseCase> {
            numbers.iter().filter_map(|idx| set.train.get(*idx)).collect()
        };
        UnseenCars {
            model: &self.model,
            cars: self.left_out.cars.iter().map(chosen).collect(),
            motions: chosen(&self.left_out.motions),
        }
    }
}

/// Trains a network for each part of a fleet, on what the part does not leave out. Each has a checkpoint
/// of its own beside that of the training.
///
/// # Errors
/// [`LearningError::TooFewCases`] for fewer cars than parts, and those of the trainings.
pub(crate) fn train_parts(
    start: &ResponseModel,
    set: &ResponseTrainingSet,
    settings: &ResponseTrainSettings,
    report: &mut TrainingProgress<'_>,
) -> Result<Vec<FleetPart>, LearningError> {
    settings.config.check()?;
    settings.config.check_memory()?;
    let parts = parts_of(&cars_of(&set.train));
    if parts.iter().any(|part| part.cars.is_empty()) {
        let n_cases = parts.iter().map(|part| part.cars.len()).sum();
        return Err(LearningError::TooFewCases { n_cases, least: N_PARTS });
    }
    let mut trained = Vec::new();
    for (part, left_out) in parts.into_iter().enumerate() {
        let is_left = |idx: &usize| {
            let mut left_out = left_out.cars.iter().flatten().chain(&left_out.motions);
            !left_out.any(|left_out| left_out == idx)
        };
        let train: Vec<usize> = (0..set.train.len()).filter(is_left).collect();
        let checkpoint = settings.checkpoint.as_ref().map(|path| {
            let mut name = path.as_os_str().to_owned();
            name.push(format!(".part{part}"));
            name.into()
        });
        let settings = ResponseTrainSettings { checkpoint, ..settings.clone() };
        let mut on_progress = |progress: &TrainingReport| report(&numbered(progress, part));
        let model = fine_tune_once(Some(start), &set.part(&train), &settings, &mut on_progress)?;
        trained.push(FleetPart { left_out, model });
    }
    Ok(trained)
}

/// A report of one of the trainings of a fleet, which says which.
fn numbered(report: &TrainingReport, training_idx: usize) -> TrainingReport {
    match report {
        TrainingReport::Epoch(epoch) => TrainingReport::Epoch(EpochReport {
            training_idx,
            n_trainings: N_PARTS + 1,
            ..epoch.clone()
        }),
        fit => fit.clone(),
    }
}

/// The trajectories of each car, in the order in which the cars come first.
fn cars_of(cases: &[ResponseCase]) -> Vec<Vec<usize>> {
    let mut cars: Vec<Vec<usize>> = Vec::new();
    for (idx, case) in cases.iter().enumerate() {
        let same = |car: &&mut Vec<usize>| {
            let first = car.first().and_then(|first| cases.get(*first));
            first.is_some_and(|first| is_same_car(&first.vehicle, &case.vehicle))
        };
        match cars.iter_mut().find(same) {
            Some(car) => car.push(idx),
            None => cars.push(vec![idx]),
        }
    }
    cars
}

/// What each part leaves out: every car in turn, or the trajectories of a car with many in turn.
fn parts_of(cars: &[Vec<usize>]) -> Vec<LeftOut> {
    let mut sizes: Vec<usize> = cars.iter().map(Vec::len).collect();
    sizes.sort_unstable();
    let most = MANY * sizes.get(sizes.len() / 2).copied().unwrap_or(0);
    let (well_known, others): (Vec<_>, Vec<_>) = cars.iter().partition(|car| car.len() > most);
    let mut parts = vec![LeftOut::default(); N_PARTS];
    for (number, part) in parts.iter_mut().enumerate() {
        part.cars = others.iter().skip(number).step_by(N_PARTS).copied().cloned().collect();
        let motions = well_known.iter().flat_map(|car| car.iter().skip(number).step_by(N_PARTS));
        part.motions = motions.copied().collect();
    }
    parts
}

/// Gives a model the distribution of strengths over cars, and makes cars known to it.
///
/// - `unseen`: cars, each with a model that has not seen it;
/// - `train`: the trajectories that the model has learned from.
///
/// # Errors
/// [`LearningError::Network`].
pub fn learn_population(
    model: &mut ResponseModel,
    unseen: &[UnseenCars<'_>],
    train: &[ResponseCase],
) -> Result<(), LearningError> {
    let cars: Vec<UnseenCar<'_>> = unseen
        .iter()
        .flat_map(|part| {
            part.cars.iter().map(|cases| UnseenCar { cases, network: part.model.network() })
        })
        .collect();
    let mut population = StrengthPopulation::fit(&cars)?;
    let of_unseen: Vec<UnseenCases<'_>> = unseen
        .iter()
        .map(|part| {
            let cases = part.cars.iter().flatten().copied().collect();
            Ok(UnseenCases { model: part.model.copied()?, population: population.clone(), cases })
        })
        .collect::<Result<_, LearningError>>()?;
    population.set_widths(calibrated(&of_unseen)?);
    let well_known = well_known_widths(&population, unseen, train)?;
    for car in cars_of(train) {
        let cases: Vec<&ResponseCase> = car.iter().filter_map(|idx| train.get(*idx)).collect();
        let is_of_car = |case: &&ResponseCase| {
            cases.first().is_some_and(|first| is_same_car(&first.vehicle, &case.vehicle))
        };
        let is_well_known = unseen.iter().flat_map(|part| &part.motions).any(is_of_car);
        let widths = if is_well_known { well_known } else { population.widths() };
        population = population.with_learned_car(model.network(), widths, &cases)?;
    }
    model.set_domain(MotionDomain::from_cases(train));
    model.set_population(population);
    Ok(())
}

/// Trajectories that a model has not seen, with what it knows of their cars.
struct UnseenCases<'a> {
    model: ResponseModel,
    population: StrengthPopulation,
    cases: Vec<&'a ResponseCase>,
}

/// How wide the distributions are for cars of which many trajectories are known, by trajectories of
/// theirs that were left out; as for other cars where there are none.
fn well_known_widths(
    population: &StrengthPopulation,
    unseen: &[UnseenCars<'_>],
    train: &[ResponseCase],
) -> Result<Widths, LearningError> {
    let mut unseen_cases = Vec::new();
    for part in unseen.iter().filter(|part| !part.motions.is_empty()) {
        let mut known = population.clone();
        let learned: Vec<ResponseCase> =
            train.iter().filter(|case| part.model.is_trained_on(case)).cloned().collect();
        for car in cars_of(&learned) {
            let cases: Vec<&ResponseCase> =
                car.iter().filter_map(|idx| learned.get(*idx)).collect();
            let is_of_car = |other: &&ResponseCase| {
                cases.first().is_some_and(|case| is_same_car(&case.vehicle, &other.vehicle))
            };
            if part.motions.iter().any(is_of_car) {
                known = known.with_learned_car(part.model.network(), Widths::NORMAL, &cases)?;
            }
        }
        let cases = part.motions.clone();
        unseen_cases.push(UnseenCases { model: part.model.copied()?, population: known, cases });
    }
    if unseen_cases.is_empty() { Ok(population.widths()) } else { calibrated(&unseen_cases) }
}

/// The widths with which the regions hold as many of the recorded positions as they say, early and late
/// in the motions.
fn calibrated(unseen_cases: &[UnseenCases<'_>]) -> Result<Widths, LearningError> {
    let mut best = (f64::INFINITY, Widths::NORMAL);
    let mut try_out = |widening: f64, growth: f64| -> Result<Widths, LearningError> {
        for (held, tail_ratio) in held_with(unseen_cases, widening, growth)?.iter().zip(RATIOS) {
            let off = off(held);
            if off < best.0 {
                best = (off, Widths { widening, tail_ratio, growth });
            }
        }
        Ok(best.1)
    };
    let mut found = Widths::NORMAL;
    for growth in GROWTHS {
        for widening in FACTORS {
            found = try_out(widening, growth)?;
        }
    }
    let (widening, growth) = (found.widening, found.growth);
    for factor in FINE_FACTORS {
        found = try_out(factor * widening, growth)?;
    }
    Ok(found)
}

/// The recorded positions that the regions hold at each instant, with each ratio of the widths.
fn held_with(
    unseen_cases: &[UnseenCases<'_>],
    widening: f64,
    growth: f64,
) -> Result<[HeldByTime; RATIOS.len()], LearningError> {
    let mut counts = [HeldByTime::default(); RATIOS.len()];
    for part in unseen_cases {
        let mut population = part.population.clone();
        population.set_widths(Widths { widening, growth, ..Widths::NORMAL });
        let mut model = part.model.copied()?;
        model.set_population(population);
        let of_cases: Vec<[HeldByTime; RATIOS.len()]> = part
            .cases
            .par_iter()
            .map(|case| held_positions(&model, case))
            .collect::<Result<_, _>>()?;
        for of_case in &of_cases {
            for (sums, at) in counts.iter_mut().zip(of_case) {
                sums.iter_mut().zip(at).for_each(|(sum, at)| sum.add(*at));
            }
        }
    }
    Ok(counts)
}

/// Recorded positions in the region of each level, and all of them.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Held {
    inside: [usize; LEVELS.len()],
    all: usize,
}

/// The same at each instant.
type HeldByTime = [Held; N_INSTANTS];

impl Held {
    fn add(&mut self, other: Self) {
        self.inside.iter_mut().zip(other.inside).for_each(|(sum, inside)| *sum += inside);
        self.all += other.all;
    }

    /// How far the regions are from holding as many as they say.
    fn off(&self) -> f64 {
        let [half, most] = self.inside.map(|inside| inside as f64 / f64::max(self.all as f64, 1.0));
        let short = (LEVELS[1] - most).max(0.0) * SHORTFALL;
        (half - LEVELS[0]).abs() + (most - LEVELS[1]).max(short)
    }
}

/// How far the regions are off over all instants, each as much as it has positions.
fn off(held: &HeldByTime) -> f64 {
    let all: usize = held.iter().map(|at| at.all).sum();
    held.iter().map(|at| at.all as f64 * at.off()).sum::<f64>() / f64::max(all as f64, 1.0)
}

/// The recorded positions of one motion that the regions hold with each ratio of the widths.
fn held_positions(
    model: &ResponseModel,
    case: &ResponseCase,
) -> Result<[HeldByTime; RATIOS.len()], LearningError> {
    let Some(initial) = case.states.first() else { return Ok(Default::default()) };
    let n_steps = case.inputs.len().min(N_INSTANTS * STRIDE_STEPS);
    let mut motion = model.predictor(&case.vehicle)?.motion(initial, &case.inputs[..n_steps]);
    let mut of_ratio = |tail_ratio: f64| {
        motion.components.iter_mut().for_each(|component| component.tail_ratio = tail_ratio);
        let mut held = HeldByTime::default();
        for (at, held) in (STRIDE_STEPS..=n_steps).step_by(STRIDE_STEPS).zip(&mut held) {
            let Some(state) = case.states.get(at) else { break };
            let level = motion.position(at).level_of([state.x_m, state.y_m]);
            *held = Held { inside: LEVELS.map(|limit| usize::from(level <= limit)), all: 1 };
        }
        held
    };
    Ok(RATIOS.map(&mut of_ratio))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_car_is_left_out_once_and_of_a_well_known_one_every_trajectory() {
        let mut cars: Vec<Vec<usize>> = (0..6).map(|car| vec![2 * car, 2 * car + 1]).collect();
        cars.push((12..23).collect());
        let parts = parts_of(&cars);
        let mut left_out: Vec<usize> =
            parts.iter().flat_map(|part| part.cars.iter().flatten()).copied().collect();
        left_out.sort_unstable();
        assert_eq!(left_out, (0..12).collect::<Vec<_>>());
        let mut motions: Vec<usize> =
            parts.iter().flat_map(|part| &part.motions).copied().collect();
        motions.sort_unstable();
        assert_eq!(motions, (12..23).collect::<Vec<_>>());
        let sizes: Vec<[usize; 2]> =
            parts.iter().map(|part| [part.cars.len(), part.motions.len()]).collect();
        assert_eq!(sizes, [[2, 3], [2, 3], [1, 3], [1, 2]]);
    }
}
