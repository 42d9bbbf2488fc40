//! How wide the regions of motions have to be: calibrated on trajectories of cars that are asked about as if
//! nothing were known of them.
//!
//! A distribution of two widths is the mixture of two distributions of one, so each motion is forecast with
//! every scale once, and every pair of scales is tried with the same forecasts:
//!
//! ```text
//! p(x; widening, ratio) = ½ p(x; widening/√ratio) + ½ p(x; widening √ratio)
//! ```
//!
//! They are of as many motions as the forecasts that are made for a person, so that regions are of one width
//! for both, with the same random numbers at every scale.
//!
//! Widths are those of motions in which no wheel is braked, and by the others comes the factor on them while
//! one is. Where there are few of either, all have one width.

use std::ops::ControlFlow;

use rayon::prelude::*;

use crate::learning::{FitSteps, LearningError, TrainingProgress};
use crate::response::train::fleet::cars_of;
use crate::response::{
    LEAST_MOTIONS, MotionDomain, ResponseCase, ResponseModel, StrengthPopulation, Widths,
};
use impactlab_core::uncertainty::PlanarMixture;
use impactlab_core::vehicle::{VehicleInput, VehicleState};

/// Growths of all deviations, and scales of them, that are tried.
const GROWTHS: [f64; 3] = [0.0, 0.5, 1.5];
const SCALES: [f64; 10] = [0.10, 0.14, 0.20, 0.28, 0.39, 0.54, 0.76, 1.06, 1.49, 2.08];
/// Factors while a wheel is braked that are tried.
const BRAKED: [f64; 8] = [0.7, 0.85, 1.0, 1.2, 1.4, 1.7, 2.0, 2.5];
/// Largest ratio of two scales that make the widths of a distribution.
const MOST_RATIO: f64 = 10.0;
/// The levels at which the regions shall be right.
const LEVELS: [f64; 2] = [0.5, 0.9];
/// How many times what the larger regions hold too little counts: regions that are too narrow mislead,
/// those that are too wide do not.
const SHORTFALL: f64 = 3.0;
/// Steps from one instant at which the regions are looked at to the next: 1 s, up to 12 s, which is as
/// long as the recordings of a fleet.
const STRIDE_STEPS: usize = 100;
const MOST_STRIDES: usize = 12;
/// The first instant, 0.5 s: where motions are short, what comes before the first second is a good part of
/// them.
const FIRST_STEPS: usize = 50;
const N_INSTANTS: usize = MOST_STRIDES + 1;
/// Motions that are asked about, of all cars: some from each.
const MOST_MOTIONS: usize = 240;
/// Paths of 4 s that take as long to compute as 1 s of the forecast of a motion.
const PATHS_PER_STRIDE: usize = LEAST_MOTIONS / 4;
/// Fewest motions with a braked wheel, and without one, by which widths are told apart.
const LEAST_APART: usize = 20;
/// Motions for each thread between two reports.
const MOTIONS_PER_THREAD: usize = 2;

/// Trajectories that a model is asked about.
pub(super) struct AskedCases<'a> {
    model: ResponseModel,
    /// What it knows of the cars.
    population: StrengthPopulation,
    cases: Vec<&'a ResponseCase>,
}

impl<'a> AskedCases<'a> {
    /// - `domain`: of the model that is used in the end, whose forecasts these stand for.
    pub fn new(
        model: &ResponseModel,
        domain: &MotionDomain,
        population: StrengthPopulation,
        cases: Vec<&'a ResponseCase>,
    ) -> Result<Self, LearningError> {
        let mut model = model.copied()?;
        model.set_domain(domain.clone());
        Ok(Self { model, population, cases })
    }

    /// The model with other widths.
    fn with(&self, widths: Widths) -> Result<ResponseModel, LearningError> {
        let mut population = self.population.clone();
        population.set_widths(widths);
        let mut model = self.model.copied()?;
        model.set_population(population);
        Ok(model)
    }
}

/// Which motions are looked at.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Looked {
    All,
    /// Those without a braked wheel.
    Free,
    /// Those in which a wheel is braked at some time.
    Braked,
}

impl Looked {
    fn at(self, case: &ResponseCase) -> bool {
        match self {
            Self::All => true,
            Self::Free => !has_braked_wheel(case),
            Self::Braked => has_braked_wheel(case),
        }
    }
}

/// Whether there are enough motions with a braked wheel and without one to tell their widths apart.
fn are_told_apart<'a>(cases: impl Iterator<Item = &'a ResponseCase>) -> bool {
    let (braked, free): (Vec<_>, Vec<_>) = cases.partition(|case| has_braked_wheel(case));
    braked.len().min(free.len()) >= LEAST_APART
}

fn has_braked_wheel(case: &ResponseCase) -> bool {
    case.inputs.iter().any(VehicleInput::is_braked)
}

/// At most [`MOST_MOTIONS`] of the trajectories of several parts: every n-th, so that each car has its say.
pub(super) fn spread_over_cars<'a, P>(parts: impl Iterator<Item = P>) -> Vec<Vec<&'a ResponseCase>>
where
    P: Iterator<Item = &'a ResponseCase>,
{
    let all: Vec<Vec<&ResponseCase>> = parts.map(Iterator::collect).collect();
    let stride = all.iter().map(Vec::len).sum::<usize>().div_ceil(MOST_MOTIONS).max(1);
    all.into_iter().map(|cases| cases.into_iter().step_by(stride).collect()).collect()
}

/// How many steps [`calibrated`] reports: paths of 4 s, or what takes as long.
pub(super) fn n_calibration_steps<'a>(
    cases: impl Iterator<Item = &'a ResponseCase> + Clone,
) -> usize {
    let is_apart = are_told_apart(cases.clone());
    let of_case = |case: &ResponseCase| match is_apart && has_braked_wheel(case) {
        true => BRAKED.len() * n_steps_of_forecast(case),
        false => GROWTHS.len() * SCALES.len() * n_steps_of_forecast(case),
    };
    cases.map(of_case).sum()
}

/// The same of one forecast of a motion.
fn n_steps_of_forecast(case: &ResponseCase) -> usize {
    let n_strides = case.inputs.len().min(MOST_STRIDES * STRIDE_STEPS).div_ceil(STRIDE_STEPS);
    n_strides * PATHS_PER_STRIDE
}

/// Calibrates anew how wide the regions of cars are that a model has not seen, and of those it has learned
/// a few motions of. The network and what it knows of cars stay as they are, and so do the regions of a
/// car that is well known.
///
/// Every car is asked about as if nothing were known of it, though the network has learned from it all the
/// same.
///
/// - `cases`: trajectories; those that the model has not learned from are left alone, so that they can
///   still judge it.
///
/// # Errors
/// [`LearningError::NoPopulation`] for a model that does not know how cars differ,
/// [`LearningError::TooFewCases`] if none of the trajectories is one that it has learned from,
/// [`LearningError::Network`].
pub fn recalibrate(
    model: &mut ResponseModel,
    cases: &[ResponseCase],
    report: &mut TrainingProgress<'_>,
) -> Result<(), LearningError> {
    let population = model.population().ok_or(LearningError::NoPopulation)?.clone();
    let learned: Vec<ResponseCase> =
        cases.iter().filter(|case| model.is_trained_on(case)).cloned().collect();
    let is_asked = |numbers: &Vec<usize>| {
        let first = numbers.first().and_then(|idx| learned.get(*idx));
        let car = first.and_then(|case| population.known(&case.vehicle));
        car.is_none_or(|car| car.strengths.widths == population.widths())
    };
    let asked: Vec<usize> = cars_of(&learned).into_iter().filter(is_asked).flatten().collect();
    let asked = asked.iter().filter_map(|idx| learned.get(*idx));
    let cases = spread_over_cars(std::iter::once(asked)).into_iter().flatten().collect::<Vec<_>>();
    if cases.is_empty() {
        return Err(LearningError::TooFewCases { n_cases: 0, least: 1 });
    }
    let n_steps = n_calibration_steps(cases.iter().copied());
    let mut steps = FitSteps::new(report, true, n_steps);
    let unknown = population.clone().without_cars();
    let part = AskedCases { model: model.copied()?, population: unknown, cases };
    let what = "how wide the regions of other cars are";
    let Some(widths) = calibrated(&[part], what, &mut steps)? else { return Ok(()) };
    model.set_population(population.with_new_widths(widths));
    Ok(())
}

/// The widths with which the regions hold as many of the recorded positions as they say, early and late
/// in the motions, with no wheel braked and with one. `None` if it was broken off.
///
/// - `what`: what is calibrated, for a person.
pub(super) fn calibrated(
    asked: &[AskedCases<'_>],
    what: &str,
    steps: &mut FitSteps<'_, '_>,
) -> Result<Option<Widths>, LearningError> {
    let pairs = pairs_of_scales();
    let is_apart = are_told_apart(asked.iter().flat_map(|part| part.cases.iter().copied()));
    let (first, n_rounds) =
        if is_apart { (Looked::Free, GROWTHS.len() + 1) } else { (Looked::All, GROWTHS.len()) };
    let mut best = (f64::INFINITY, Widths::NORMAL);
    for (number, growth) in GROWTHS.into_iter().enumerate() {
        steps.name(format!("{what}, {} of {n_rounds}", number + 1));
        let Some(held) = held_with(asked, first, (growth, &pairs), steps)? else { return Ok(None) };
        for (pair, held) in pairs.iter().zip(&held) {
            let off = off(held);
            if off < best.0 {
                best = (off, pair.widths(growth));
            }
        }
    }
    if !is_apart {
        return Ok(Some(best.1));
    }
    steps.name(format!("{what}, {n_rounds} of {n_rounds}"));
    let tried = BRAKED.map(|braked| Widths { braked, ..best.1 });
    let Some(held) = held_braked(asked, &tried, steps)? else { return Ok(None) };
    let found = held.iter().map(off).zip(tried).min_by(|a, b| a.0.total_cmp(&b.0));
    Ok(found.map(|(_, widths)| widths))
}

/// Two scales, by their numbers, the narrower first.
#[derive(Debug, Clone, Copy)]
struct ScalePair([usize; 2]);

impl ScalePair {
    fn widths(self, growth: f64) -> Widths {
        let [narrow, wide] = self.0.map(|idx| SCALES[idx]);
        let (widening, tail_ratio) = ((narrow * wide).sqrt(), wide / narrow);
        Widths { widening, tail_ratio, growth, ..Widths::NORMAL }
    }
}

fn pairs_of_scales() -> Vec<ScalePair> {
    let pairs = (0..SCALES.len()).flat_map(|i| (i..SCALES.len()).map(move |j| ScalePair([i, j])));
    pairs.filter(|pair| pair.widths(0.0).tail_ratio <= MOST_RATIO).collect()
}

/// The recorded positions that the regions hold at each instant, with each pair of scales; `None` if it
/// was broken off.
///
/// - `looked`: at which motions.
fn held_with(
    asked: &[AskedCases<'_>],
    looked: Looked,
    (growth, pairs): (f64, &[ScalePair]),
    steps: &mut FitSteps<'_, '_>,
) -> Result<Option<Vec<HeldByTime>>, LearningError> {
    let tried = SCALES.map(|widening| Widths { widening, growth, ..Widths::NORMAL });
    let mut counts = Counts(vec![HeldByTime::default(); pairs.len()]);
    for part in asked {
        let count = |models: &[ResponseModel], case: &ResponseCase| -> Result<_, LearningError> {
            let forecasts = Forecasts::new(models, case)?;
            let mixed = |idx: usize, &ScalePair([narrow, wide]): &ScalePair| {
                PlanarMixture::mixed([
                    &forecasts.positions[narrow][idx],
                    &forecasts.positions[wide][idx],
                ])
            };
            Ok(forecasts.held(pairs, mixed))
        };
        if counts.add(part, (&tried, looked), steps, count)?.is_break() {
            return Ok(None);
        }
    }
    Ok(Some(counts.0))
}

/// The same of motions in which a wheel is braked, with each of some widths.
fn held_braked(
    asked: &[AskedCases<'_>],
    tried: &[Widths],
    steps: &mut FitSteps<'_, '_>,
) -> Result<Option<Vec<HeldByTime>>, LearningError> {
    let numbers: Vec<usize> = (0..tried.len()).collect();
    let mut counts = Counts(vec![HeldByTime::default(); tried.len()]);
    for part in asked {
        let count = |models: &[ResponseModel], case: &ResponseCase| -> Result<_, LearningError> {
            let forecasts = Forecasts::new(models, case)?;
            let own = |idx: usize, number: &usize| forecasts.positions[*number][idx].clone();
            Ok(forecasts.held(&numbers, own))
        };
        if counts.add(part, (tried, Looked::Braked), steps, count)?.is_break() {
            return Ok(None);
        }
    }
    Ok(Some(counts.0))
}

/// The positions that are held by each of what is tried.
struct Counts(Vec<HeldByTime>);

impl Counts {
    /// Adds those of the motions of a part.
    ///
    /// - `(tried, looked)`: widths that each motion is forecast with, and which motions are looked at;
    /// - `count`: the positions of one motion, by its forecasts with these widths.
    fn add(
        &mut self,
        part: &AskedCases<'_>,
        (tried, looked): (&[Widths], Looked),
        steps: &mut FitSteps<'_, '_>,
        count: impl Fn(&[ResponseModel], &ResponseCase) -> Result<Vec<HeldByTime>, LearningError> + Sync,
    ) -> Result<ControlFlow<()>, LearningError> {
        let models: Vec<ResponseModel> =
            tried.iter().map(|widths| part.with(*widths)).collect::<Result<_, _>>()?;
        let n_together = MOTIONS_PER_THREAD * rayon::current_num_threads();
        let cases: Vec<&ResponseCase> =
            part.cases.iter().copied().filter(|case| looked.at(case)).collect();
        for cases in cases.chunks(n_together) {
            let of_cases: Vec<Vec<HeldByTime>> =
                cases.par_iter().map(|case| count(&models, case)).collect::<Result<_, _>>()?;
            for of_case in &of_cases {
                for (sums, at) in self.0.iter_mut().zip(of_case) {
                    sums.iter_mut().zip(at).for_each(|(sum, at)| sum.add(*at));
                }
            }
            let n_steps = cases.iter().map(|case| n_steps_of_forecast(case)).sum::<usize>();
            if steps.advance(n_steps * tried.len()).is_break() {
                return Ok(ControlFlow::Break(()));
            }
        }
        Ok(ControlFlow::Continue(()))
    }
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

/// Forecasts of one motion with several models, and where it was, at every instant that it reaches.
struct Forecasts {
    recorded: Vec<[f64; 2]>,
    /// Of each model, at each instant.
    positions: Vec<Vec<PlanarMixture>>,
}

impl Forecasts {
    fn new(models: &[ResponseModel], case: &ResponseCase) -> Result<Self, LearningError> {
        let Some(initial) = case.states.first() else {
            return Ok(Self { recorded: Vec::new(), positions: vec![Vec::new(); models.len()] });
        };
        let inputs = &case.inputs[..case.inputs.len().min(MOST_STRIDES * STRIDE_STEPS)];
        let strides = (1..=MOST_STRIDES).map(|stride| stride * STRIDE_STEPS);
        let steps = std::iter::once(FIRST_STEPS).chain(strides);
        let resolution_m = case.resolution_m();
        let recorded: Vec<(usize, &VehicleState<f64>)> = steps
            .filter(|at| *at <= inputs.len())
            .map_while(|at| Some((at, case.states.get(at)?)))
            .collect();
        // The draws of one model at a time are in memory.
        let positions_with = |model: &ResponseModel| -> Result<Vec<PlanarMixture>, LearningError> {
            let forecast = model.predictor(&case.vehicle)?.forecast(initial, inputs);
            let position = |(at, _): &(usize, _)| forecast.position(*at).recorded_to(resolution_m);
            Ok(recorded.iter().map(position).collect())
        };
        let positions = models.iter().map(positions_with).collect::<Result<_, _>>()?;
        Ok(Self {
            recorded: recorded.iter().map(|(_, state)| [state.x_m, state.y_m]).collect(),
            positions,
        })
    }

    /// The recorded positions that are held with each of what is tried.
    ///
    /// - `distribution`: of the position at an instant, by one of these.
    fn held<T>(
        &self,
        tried: &[T],
        distribution: impl Fn(usize, &T) -> PlanarMixture,
    ) -> Vec<HeldByTime> {
        let mut held = vec![HeldByTime::default(); tried.len()];
        for (instant, recorded) in self.recorded.iter().enumerate() {
            for (held, tried) in held.iter_mut().zip(tried) {
                let level = distribution(instant, tried).level_of(*recorded);
                let inside = LEVELS.map(|limit| usize::from(level <= limit));
                held[instant] = Held { inside, all: 1 };
            }
        }
        held
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::vehicle::{Preset, WheelEffort};

    fn case(name: usize) -> ResponseCase {
        ResponseCase {
            name: name.to_string(),
            vehicle: Preset::Reference.parameters(),
            states: Vec::new(),
            inputs: Vec::new(),
            spins: false,
            digest: String::new(),
        }
    }

    #[test]
    fn pairs_of_scales_are_widths_about_their_geometric_mean() {
        let pairs = pairs_of_scales();
        assert!(pairs.iter().all(|pair| pair.0[0] <= pair.0[1]));
        let widths = ScalePair([1, 5]).widths(0.5);
        assert!((widths.widening - (0.14_f64 * 0.54).sqrt()).abs() < 1e-12);
        assert!((widths.widening / widths.tail_ratio.sqrt() - 0.14).abs() < 1e-12);
        assert!((widths.widening * widths.tail_ratio.sqrt() - 0.54).abs() < 1e-12);
        assert!(widths.growth == 0.5 && pairs.iter().any(|pair| pair.0 == [9, 9]));
    }

    #[test]
    fn what_ninety_percent_regions_hold_too_little_counts_three_times() {
        let held = |inside| Held { inside, all: 100 };
        assert!(held([50, 90]).off() < 1e-12);
        assert!((held([60, 95]).off() - 0.15).abs() < 1e-12);
        assert!((held([60, 85]).off() - 0.25).abs() < 1e-12);
        let mut by_time = HeldByTime::default();
        (by_time[0], by_time[5]) = (held([50, 90]), Held { inside: [20, 30], all: 300 });
        assert!((off(&by_time) - 0.75 * (0.5 - 20.0 / 300.0 + 3.0 * 0.8)).abs() < 1e-12);
    }

    #[test]
    fn motions_with_a_braked_wheel_are_told_apart_where_there_are_enough() {
        let braked = [WheelEffort { braking_n: 500.0, ..WheelEffort::FREE }; 4];
        let case = |wheels| ResponseCase {
            inputs: vec![VehicleInput { wheels, ..VehicleInput::RELEASED }; 100],
            ..case(0)
        };
        let mut cases = vec![case(None); LEAST_APART];
        cases.extend(vec![case(Some(braked)); LEAST_APART - 1]);
        // Wheels that roll freely are not braked.
        cases.push(case(Some([WheelEffort::FREE; 4])));
        assert!(!are_told_apart(cases.iter()));
        let of_one = PATHS_PER_STRIDE * GROWTHS.len() * SCALES.len();
        assert_eq!(n_calibration_steps(cases.iter()), 2 * LEAST_APART * of_one);
        cases.push(case(Some(braked)));
        assert!(are_told_apart(cases.iter()));
        let n_looked = |looked: Looked| cases.iter().filter(|case| looked.at(case)).count();
        assert_eq!([Looked::All, Looked::Free, Looked::Braked].map(n_looked), [41, 21, 20]);
        let of_braked = PATHS_PER_STRIDE * BRAKED.len();
        assert_eq!(n_calibration_steps(cases.iter()), 21 * of_one + 20 * of_braked);
    }

    #[test]
    fn every_car_has_its_say_among_the_motions_that_are_asked_about() {
        let cases: Vec<ResponseCase> = (0..3 * MOST_MOTIONS).map(case).collect();
        let [few, many] = [&cases[..40], &cases[40..]].map(<[ResponseCase]>::iter);
        let asked = spread_over_cars([few, many].into_iter());
        let n: usize = asked.iter().map(Vec::len).sum();
        assert!(n <= MOST_MOTIONS + 1 && asked[0].len() == 14, "{n}, {}", asked[0].len());
        assert_eq!(asked[0][1].name, "3");
        assert_eq!(spread_over_cars(std::iter::once(cases[..5].iter()))[0].len(), 5);
    }
}
