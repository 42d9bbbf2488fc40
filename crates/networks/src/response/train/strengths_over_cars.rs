//! How the strengths of the effects differ between the cars of a fleet, and how wide the regions of cars
//! have to be: learned from cars, each with a network that has not seen it.

use rayon::prelude::*;

use crate::learning::{FitSteps, LearningError, TrainingProgress};
use crate::response::train::fleet::cars_of;
use crate::response::{
    MotionDomain, ResponseCase, ResponseModel, StrengthPopulation, UnseenCar, Widths, is_same_car,
};

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
/// Widths that are tried in a calibration.
const N_TRIED: usize = GROWTHS.len() * FACTORS.len() + FINE_FACTORS.len();
/// Paths of 4 s that take as long to compute as 1 s of the distribution of a motion.
const PATHS_PER_STRIDE: usize = 4;
/// Motions for each thread between two reports.
const MOTIONS_PER_THREAD: usize = 8;

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

/// Gives a model the distribution of strengths over cars, and makes cars known to it.
///
/// - `unseen`: cars, each with a model that has not seen it;
/// - `train`: the trajectories that the model has learned from;
/// - `report`: called while it goes on; if it breaks, the model stays as it was.
///
/// # Errors
/// [`LearningError::Network`].
pub fn learn_population(
    model: &mut ResponseModel,
    unseen: &[UnseenCars<'_>],
    train: &[ResponseCase],
    report: &mut TrainingProgress<'_>,
) -> Result<(), LearningError> {
    let cars: Vec<UnseenCar<'_>> = unseen
        .iter()
        .flat_map(|part| {
            part.cars.iter().map(|cases| UnseenCar { cases, network: part.model.network() })
        })
        .collect();
    let mut steps = FitSteps::new(report, true, n_population_steps(&cars, unseen, train));
    let Some(mut population) = StrengthPopulation::fit(&cars, &mut steps)? else { return Ok(()) };
    let of_unseen: Vec<UnseenCases<'_>> = unseen
        .iter()
        .map(|part| {
            let cases = part.cars.iter().flatten().copied().collect();
            Ok(UnseenCases { model: part.model.copied()?, population: population.clone(), cases })
        })
        .collect::<Result<_, LearningError>>()?;
    let what = "how wide the regions of other cars are";
    let Some(widths) = calibrated(&of_unseen, what, &mut steps)? else { return Ok(()) };
    population.set_widths(widths);
    let well_known = well_known_widths(&population, unseen, train, &mut steps)?;
    let Some(well_known) = well_known else { return Ok(()) };
    steps.name("the strengths of the cars learned from");
    for car in cars_of(train) {
        let cases: Vec<&ResponseCase> = car.iter().filter_map(|idx| train.get(*idx)).collect();
        let is_of_car = |case: &&ResponseCase| {
            cases.first().is_some_and(|first| is_same_car(&first.vehicle, &case.vehicle))
        };
        let is_well_known = unseen.iter().flat_map(|part| &part.motions).any(is_of_car);
        let widths = if is_well_known { well_known } else { population.widths() };
        population = population.with_learned_car(model.network(), widths, &cases)?;
        if steps.advance(StrengthPopulation::n_paths_of_car(cases.len())).is_break() {
            return Ok(());
        }
    }
    model.set_domain(MotionDomain::from_cases(train));
    model.set_population(population);
    Ok(())
}

/// How many steps are reported while the distribution over cars is learned: paths of 4 s that are
/// computed, or what takes as long.
fn n_population_steps(
    cars: &[UnseenCar<'_>],
    unseen: &[UnseenCars<'_>],
    train: &[ResponseCase],
) -> usize {
    let n_known: usize =
        unseen.iter().flat_map(|part| well_known_cars(part, train)).map(|cases| cases.len()).sum();
    let of_motions: usize = unseen
        .iter()
        .flat_map(|part| part.cars.iter().flatten().chain(&part.motions))
        .map(|case| n_steps_of_motion(case))
        .sum();
    StrengthPopulation::n_fit_steps(cars)
        + N_TRIED * of_motions
        + StrengthPopulation::n_paths_of_car(n_known + train.len())
}

/// The same of the distribution of one motion.
fn n_steps_of_motion(case: &ResponseCase) -> usize {
    case.inputs.len().min(N_INSTANTS * STRIDE_STEPS).div_ceil(STRIDE_STEPS) * PATHS_PER_STRIDE
}

/// Trajectories that a model has not seen, with what it knows of their cars.
struct UnseenCases<'a> {
    model: ResponseModel,
    population: StrengthPopulation,
    cases: Vec<&'a ResponseCase>,
}

/// How wide the distributions are for cars of which many trajectories are known, by trajectories of
/// theirs that were left out; as for other cars where there are none. `None` if it was broken off.
fn well_known_widths(
    population: &StrengthPopulation,
    unseen: &[UnseenCars<'_>],
    train: &[ResponseCase],
    steps: &mut FitSteps<'_, '_>,
) -> Result<Option<Widths>, LearningError> {
    steps.name("the strengths of well-known cars");
    let mut unseen_cases = Vec::new();
    for part in unseen.iter().filter(|part| !part.motions.is_empty()) {
        let mut known = population.clone();
        for cases in well_known_cars(part, train) {
            let cases: Vec<&ResponseCase> = cases.iter().collect();
            known = known.with_learned_car(part.model.network(), Widths::NORMAL, &cases)?;
            if steps.advance(StrengthPopulation::n_paths_of_car(cases.len())).is_break() {
                return Ok(None);
            }
        }
        let cases = part.motions.clone();
        unseen_cases.push(UnseenCases { model: part.model.copied()?, population: known, cases });
    }
    match unseen_cases.is_empty() {
        true => Ok(Some(population.widths())),
        false => calibrated(&unseen_cases, "how wide the regions of well-known cars are", steps),
    }
}

/// What the model of a part has learned from of each car of which it leaves out single trajectories.
fn well_known_cars(part: &UnseenCars<'_>, train: &[ResponseCase]) -> Vec<Vec<ResponseCase>> {
    if part.motions.is_empty() {
        return Vec::new();
    }
    let learned: Vec<ResponseCase> =
        train.iter().filter(|case| part.model.is_trained_on(case)).cloned().collect();
    let is_well_known = |cases: &Vec<ResponseCase>| {
        let first = cases.first();
        let is_of_car = |other: &&ResponseCase| {
            first.is_some_and(|case| is_same_car(&case.vehicle, &other.vehicle))
        };
        part.motions.iter().any(is_of_car)
    };
    cars_of(&learned)
        .into_iter()
        .map(|car| car.iter().filter_map(|idx| learned.get(*idx)).cloned().collect())
        .filter(is_well_known)
        .collect()
}

/// The widths with which the regions hold as many of the recorded positions as they say, early and late
/// in the motions. `None` if it was broken off.
///
/// - `what`: what is calibrated, for a person.
fn calibrated(
    unseen_cases: &[UnseenCases<'_>],
    what: &str,
    steps: &mut FitSteps<'_, '_>,
) -> Result<Option<Widths>, LearningError> {
    let (mut best, mut number) = ((f64::INFINITY, Widths::NORMAL), 0);
    let mut try_out = |widening: f64, growth: f64| -> Result<Option<Widths>, LearningError> {
        number += 1;
        steps.name(format!("{what}, {number} of {N_TRIED}"));
        let held = held_with(unseen_cases, [widening, growth], steps)?;
        let Some(held) = held else { return Ok(None) };
        for (held, tail_ratio) in held.iter().zip(RATIOS) {
            let off = off(held);
            if off < best.0 {
                best = (off, Widths { widening, tail_ratio, growth });
            }
        }
        Ok(Some(best.1))
    };
    let mut found = Widths::NORMAL;
    for growth in GROWTHS {
        for widening in FACTORS {
            let Some(best) = try_out(widening, growth)? else { return Ok(None) };
            found = best;
        }
    }
    let (widening, growth) = (found.widening, found.growth);
    for factor in FINE_FACTORS {
        let Some(best) = try_out(factor * widening, growth)? else { return Ok(None) };
        found = best;
    }
    Ok(Some(found))
}

/// The recorded positions that the regions hold at each instant, with each ratio of the widths; `None` if
/// it was broken off.
fn held_with(
    unseen_cases: &[UnseenCases<'_>],
    [widening, growth]: [f64; 2],
    steps: &mut FitSteps<'_, '_>,
) -> Result<Option<[HeldByTime; RATIOS.len()]>, LearningError> {
    let mut counts = [HeldByTime::default(); RATIOS.len()];
    let n_together = MOTIONS_PER_THREAD * rayon::current_num_threads();
    for part in unseen_cases {
        let mut population = part.population.clone();
        population.set_widths(Widths { widening, growth, ..Widths::NORMAL });
        let mut model = part.model.copied()?;
        model.set_population(population);
        for cases in part.cases.chunks(n_together) {
            let of_cases: Vec<[HeldByTime; RATIOS.len()]> = cases
                .par_iter()
                .map(|case| held_positions(&model, case))
                .collect::<Result<_, _>>()?;
            for of_case in &of_cases {
                for (sums, at) in counts.iter_mut().zip(of_case) {
                    sums.iter_mut().zip(at).for_each(|(sum, at)| sum.add(*at));
                }
            }
            let n_steps = cases.iter().map(|case| n_steps_of_motion(case)).sum();
            if steps.advance(n_steps).is_break() {
                return Ok(None);
            }
        }
    }
    Ok(Some(counts))
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
