//! Trains a response network on the cars of a fleet, so that it holds for a car that nobody has
//! measured, and says how far.
//!
//! The cars are divided into parts. A training leaves out each part, and predicts it: from this the
//! distribution of the strengths over cars is learned, and how wide the regions have to be. A car with
//! many more trajectories than the others is left out of none: without it there would be little to
//! learn from. Instead a share of its trajectories is left out of each, by which the regions of a car
//! that is well known are calibrated. What is used is a training on all cars, whose trajectories make
//! them known.

use std::borrow::Cow;
use std::iter;

use crate::learning::{LearningError, TrainingProgress, TrainingReport};
use crate::response::train::side_by_side::{Training, fine_tune_side_by_side};
use crate::response::train::strengths_over_cars::{UnseenCars, learn_population};
use crate::response::{
    ResponseCase, ResponseModel, ResponseTrainSettings, ResponseTrainingSet, is_same_car,
};

/// Parts of the fleet.
const N_PARTS: usize = 4;
/// A car with more than this many times the trajectories of the median car is left out of no training.
const MANY: usize = 2;

/// Trains a network on a fleet.
///
/// - `start`: a pre-trained model;
/// - `set`: trajectories of several cars;
/// - `report`: called after each epoch, then while the distribution of the strengths over cars is learned;
///   if it breaks, the model does not know how cars differ.
///
/// # Errors
/// [`LearningError::TooFewCases`] for fewer cars than parts, and those of the trainings.
pub fn train_fleet(
    start: &ResponseModel,
    set: &ResponseTrainingSet,
    settings: &ResponseTrainSettings,
    report: &mut TrainingProgress<'_>,
) -> Result<ResponseModel, LearningError> {
    let mut is_cut = false;
    let mut on_progress = |progress: &TrainingReport| {
        let flow = report(progress);
        is_cut |= flow.is_break();
        flow
    };
    let left_out = fleet_parts(set, settings)?;
    // The model itself comes first: where the training is broken off, it has come furthest.
    let whole = Training { set: Cow::Borrowed(set), settings: settings.clone() };
    let trainings: Vec<Training<'_>> =
        iter::once(whole).chain(trainings_of(&left_out, set, settings)).collect();
    let mut models = fine_tune_side_by_side(start, &trainings, &mut on_progress)?.into_iter();
    let mut model = models.next().ok_or(LearningError::TooFewCases { n_cases: 0, least: 1 })?;
    if is_cut {
        return Ok(model);
    }
    let parts = parts_with_models(left_out, models);
    let unseen: Vec<UnseenCars<'_>> = parts.iter().map(|part| part.unseen(set)).collect();
    learn_population(&mut model, &unseen, &set.train, report)?;
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

/// Trains a network for each part of a fleet, on what the part does not leave out, side by side. Each has a
/// checkpoint of its own beside that of the training.
///
/// # Errors
/// [`LearningError::TooFewCases`] for fewer cars than parts, and those of the trainings.
pub(crate) fn train_parts(
    start: &ResponseModel,
    set: &ResponseTrainingSet,
    settings: &ResponseTrainSettings,
    report: &mut TrainingProgress<'_>,
) -> Result<Vec<FleetPart>, LearningError> {
    let left_out = fleet_parts(set, settings)?;
    let trainings: Vec<Training<'_>> = trainings_of(&left_out, set, settings).collect();
    let models = fine_tune_side_by_side(start, &trainings, report)?;
    Ok(parts_with_models(left_out, models))
}

/// The parts of a fleet that can be trained on with these settings.
///
/// # Errors
/// Those of the settings, and [`LearningError::TooFewCases`] for fewer cars than parts.
fn fleet_parts(
    set: &ResponseTrainingSet,
    settings: &ResponseTrainSettings,
) -> Result<Vec<LeftOut>, LearningError> {
    settings.config.check()?;
    settings.config.check_memory()?;
    let parts = parts_of(&cars_of(&set.train));
    if parts.iter().any(|part| part.cars.is_empty()) {
        let n_cases = parts.iter().map(|part| part.cars.len()).sum();
        return Err(LearningError::TooFewCases { n_cases, least: N_PARTS });
    }
    Ok(parts)
}

/// The training of each part, on what it does not leave out.
fn trainings_of<'a>(
    parts: &'a [LeftOut],
    set: &'a ResponseTrainingSet,
    settings: &'a ResponseTrainSettings,
) -> impl Iterator<Item = Training<'a>> {
    parts.iter().enumerate().map(move |(part, left_out)| {
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
        Training { set: Cow::Owned(set.part(&train)), settings }
    })
}

fn parts_with_models(
    left_out: Vec<LeftOut>,
    models: impl IntoIterator<Item = ResponseModel>,
) -> Vec<FleetPart> {
    let part = |(left_out, model)| FleetPart { left_out, model };
    left_out.into_iter().zip(models).map(part).collect()
}

/// The trajectories of each car, in the order in which the cars come first.
pub(crate) fn cars_of(cases: &[ResponseCase]) -> Vec<Vec<usize>> {
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
