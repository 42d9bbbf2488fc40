//! Expectation maximisation of the distribution of strengths over cars.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::learning::FitSteps;
use crate::nn::NnError;
use crate::response::network::response_network::ResponseNetwork;
use crate::response::population::distribution::{LEARNED_STEPS, window_weights};
use crate::response::population::linearized::{
    Linearized, N_ROWS, PATHS_PER_LINEARIZATION, Predicted,
};
use crate::response::population::strengths::Evidence;
use crate::response::{CarStrengths, N_EFFECTS, ResponseCase, StrengthPopulation, Widths};

/// Steps of the windows by which the distribution over cars is found.
pub(super) const FIT_WINDOW_STEPS: usize = 100;
/// Share of what trajectories say of a car of the fit that counts: what the effects cannot explain is not
/// independent from row to row, window to window and motion to motion. Chosen on coasting trajectories of
/// twelve cars left out.
const EVIDENCE_SHARE: f64 = 0.15;
/// Linearisations of every trajectory, each about what the last one found, and iterations after each.
const N_LINEARIZATIONS: usize = 2;
const N_ITERATIONS: usize = 25;
/// Standard deviation of a strength over cars before any is seen, and the number of cars that this
/// counts as much as.
const PRIOR_STD: f64 = 0.1;
const PRIOR_CARS: f64 = 2.0;
/// The same over the motions of a car.
const PRIOR_WITHIN_STD: f64 = 0.05;
const PRIOR_MOTIONS: f64 = 5.0;
/// First guess of the variance of a row of a window, and the smallest.
const FIRST_NOISE: f64 = 1e-2;
const LEAST_NOISE: f64 = 1e-6;
/// Shares of the remainder of a network that are tried for cars that it has not learned from.
const REMAINDERS: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];
/// First guess of the factor on the noise of the steps.
const STEP_NOISE: f64 = 0.1;

/// Trajectories of one car, and a network that has not seen them.
#[derive(Debug, Clone, Copy)]
pub struct UnseenCar<'a> {
    /// Trajectories of the car.
    pub cases: &'a [&'a ResponseCase],
    /// A network that was trained without them.
    pub network: &'a ResponseNetwork,
}

/// A car of the fit.
struct Car<'a> {
    predicted: Vec<Predicted<'a>>,
    /// Strengths of its network, `[N_EFFECTS]`.
    of_network: [f64; N_EFFECTS],
    linearized: Vec<Linearized>,
    strengths: CarStrengths,
}

/// Second moments of one motion: of its strengths about those of the car, and of what these leave of the
/// rows of its windows.
struct Motion {
    within: DMatrix<f64>,
    rest: Rows,
}

/// Sum over windows of the squares of their rows.
#[derive(Default)]
struct Rows {
    sum: [f64; N_ROWS],
    n_windows: f64,
}

impl Rows {
    /// Squares of what is left, with windows that are far off counting less, and the variance by what is
    /// not known.
    fn new(left: &DVector<f64>, noise: &[f64; N_ROWS], unknown: impl Fn(usize) -> f64) -> Self {
        let weights = window_weights(left, noise);
        let mut rows = Self { n_windows: weights.len() as f64, ..Self::default() };
        for (window, weight) in weights.into_iter().enumerate() {
            for (i, sum) in rows.sum.iter_mut().enumerate() {
                let row = window * N_ROWS + i;
                *sum += weight * left[row].powi(2) + unknown(row);
            }
        }
        rows
    }

    /// The mean over windows of several.
    fn mean<'a>(all: impl IntoIterator<Item = &'a Self>) -> [f64; N_ROWS] {
        let mut total = Self::default();
        for rows in all.into_iter().filter(|rows| rows.sum.iter().all(|sum| sum.is_finite())) {
            total.sum.iter_mut().zip(rows.sum).for_each(|(total, sum)| *total += sum);
            total.n_windows += rows.n_windows;
        }
        total.sum.map(|sum| (sum / f64::max(total.n_windows, 1.0)).max(LEAST_NOISE))
    }
}

impl StrengthPopulation {
    /// How many steps [`StrengthPopulation::fit`] reports: paths of [`LEARNED_STEPS`] that are computed.
    pub(crate) fn n_fit_steps(cars: &[UnseenCar<'_>]) -> usize {
        let n_cases: usize = cars.iter().map(|car| car.cases.len()).sum();
        n_cases * (REMAINDERS.len() + N_LINEARIZATIONS * PATHS_PER_LINEARIZATION)
    }

    /// The distribution over the cars of a fleet, each predicted by a network that has not seen it;
    /// `None` if it was broken off.
    ///
    /// # Errors
    /// [`NnError`] if a tensor cannot be read.
    pub(crate) fn fit(
        cars: &[UnseenCar<'_>],
        steps: &mut FitSteps<'_, '_>,
    ) -> Result<Option<Self>, NnError> {
        steps.name("how much of the network holds for other cars");
        let Some(remainder) = remainder_of(cars, steps)? else { return Ok(None) };
        let mut population = Self { remainder, ..Self::guess() };
        let mut fitted = cars
            .iter()
            .map(|unseen| Car::new(unseen, remainder))
            .collect::<Result<Vec<Car<'_>>, NnError>>()?;
        for round in 1..=N_LINEARIZATIONS {
            steps.name(format!("how cars differ, round {round} of {N_LINEARIZATIONS}"));
            for car in &mut fitted {
                let mean = &car.strengths.mean;
                car.linearized = car
                    .predicted
                    .par_iter()
                    .map(|motion| motion.linearized(mean, LEARNED_STEPS, FIT_WINDOW_STEPS))
                    .collect();
                if steps.advance(car.predicted.len() * PATHS_PER_LINEARIZATION).is_break() {
                    return Ok(None);
                }
            }
            for _ in 0..N_ITERATIONS {
                population.expect(&mut fitted);
                population.maximise(&fitted);
            }
        }
        population.spread(&fitted);
        population.bare = bare(&fitted);
        population.importance = importance(&fitted);
        Ok(Some(population))
    }

    /// A guess before any car is seen.
    pub(super) fn guess() -> Self {
        let between = DMatrix::identity(N_EFFECTS, N_EFFECTS) * PRIOR_STD.powi(2);
        Self {
            mean: DVector::zeros(N_EFFECTS),
            remainder: 1.0,
            bare: between.clone(),
            importance: DMatrix::identity(N_EFFECTS, N_EFFECTS),
            between,
            within: DMatrix::identity(N_EFFECTS, N_EFFECTS) * PRIOR_WITHIN_STD.powi(2),
            noise: [FIRST_NOISE; N_ROWS],
            widths: Widths::NORMAL,
            step_noise: STEP_NOISE,
            cars: Vec::new(),
        }
    }

    /// The strengths of every car, given the distribution over cars.
    fn expect(&self, cars: &mut [Car<'_>]) {
        for car in cars {
            let evidence: Vec<Evidence> = car
                .linearized
                .par_iter()
                .map(|linearized| self.evidence(linearized, &car.strengths.mean))
                .collect();
            car.strengths =
                self.prior(&car.of_network).updated(&Evidence::sum(evidence).times(EVIDENCE_SHARE));
        }
    }

    /// The distribution over cars, given the strengths of every car.
    fn maximise(&mut self, cars: &[Car<'_>]) {
        let n_cars = PRIOR_CARS + cars.len() as f64;
        let zero = DVector::zeros(N_EFFECTS);
        self.mean = cars.iter().fold(zero, |sum, car| sum + car.whole()) / n_cars;
        let mut between =
            DMatrix::identity(N_EFFECTS, N_EFFECTS) * (PRIOR_STD.powi(2) * PRIOR_CARS);
        for car in cars {
            let off = car.whole() - &self.mean;
            between += &car.strengths.covariance + &off * off.transpose();
        }
        self.between = between / n_cars;
        let left: Vec<Rows> = motions(cars)
            .par_iter()
            .map(|(car, linearized)| {
                let left = &linearized.target - &linearized.by_strengths * &car.mean;
                Rows::new(&left, &self.noise, |row| variance(linearized, row, &car.covariance))
            })
            .collect();
        self.noise = Rows::mean(&left);
    }

    /// How the strengths are distributed over the motions of a car, given those of every car.
    fn spread(&mut self, cars: &[Car<'_>]) {
        let mut rest = self.noise;
        for _ in 0..N_ITERATIONS {
            let found: Vec<Motion> = motions(cars)
                .par_iter()
                .filter_map(|(car, linearized)| self.motion(car, linearized, &rest))
                .collect();
            let mut within = DMatrix::identity(N_EFFECTS, N_EFFECTS)
                * (PRIOR_WITHIN_STD.powi(2) * PRIOR_MOTIONS);
            within += found.iter().map(|motion| &motion.within).sum::<DMatrix<f64>>();
            self.within = within / (PRIOR_MOTIONS + found.len() as f64);
            rest = Rows::mean(found.iter().map(|motion| &motion.rest));
        }
    }

    /// Second moments of what the strengths of the car leave of one motion.
    fn motion(
        &self,
        car: &CarStrengths,
        linearized: &Linearized,
        rest: &[f64; N_ROWS],
    ) -> Option<Motion> {
        let left = &linearized.target - &linearized.by_strengths * &car.mean;
        let weights = DVector::from_fn(linearized.n_rows(), |row, _| 1.0 / rest[row % N_ROWS]);
        let weighted = DMatrix::from_diagonal(&weights) * &linearized.by_strengths;
        let precision =
            self.within.clone().cholesky()?.inverse() + weighted.tr_mul(&linearized.by_strengths);
        let root = precision.cholesky()?;
        let mean = root.solve(&weighted.tr_mul(&left));
        let covariance = root.inverse();
        let left = left - &linearized.by_strengths * &mean;
        let unknown = &covariance + &car.covariance;
        let rest = Rows::new(&left, rest, |row| variance(linearized, row, &unknown));
        let within = &mean * mean.transpose() + covariance;
        let is_finite = rest.sum.iter().chain(&within).all(|value| value.is_finite());
        is_finite.then_some(Motion { within, rest })
    }
}

/// The motions of all cars, each with the strengths of its car.
fn motions<'a>(cars: &'a [Car<'_>]) -> Vec<(&'a CarStrengths, &'a Linearized)> {
    cars.iter()
        .flat_map(|car| car.linearized.iter().map(|linearized| (&car.strengths, linearized)))
        .collect()
}

/// Variance of a row by strengths that are not known.
fn variance(linearized: &Linearized, row: usize, covariance: &DMatrix<f64>) -> f64 {
    let by = linearized.by_strengths.row(row);
    (by * covariance).dot(&by)
}

impl<'a> Car<'a> {
    /// - `remainder`: share of the remainder of the network that holds for the car.
    fn new(unseen: &UnseenCar<'a>, remainder: f64) -> Result<Self, NnError> {
        let predicted: Vec<Predicted<'a>> = unseen
            .cases
            .iter()
            .map(|case| Predicted::new(case, unseen.network, remainder))
            .collect::<Result<_, _>>()?;
        let zero = DVector::zeros(N_EFFECTS);
        Ok(Self {
            of_network: unseen.network.mean_strengths()?,
            predicted,
            linearized: Vec::new(),
            strengths: CarStrengths {
                mean: zero,
                covariance: DMatrix::identity(N_EFFECTS, N_EFFECTS),
                remainder,
                widths: Widths::NORMAL,
            },
        })
    }

    /// All the strengths, those of the network included.
    fn whole(&self) -> DVector<f64> {
        DVector::from_row_slice(&self.of_network) + &self.strengths.mean
    }
}

/// The share of the remainder of a network that errs least on cars that the network has not learned
/// from: it learns the cars that it sees by heart, and what it says of others is partly theirs. `None` if
/// it was broken off.
fn remainder_of(
    cars: &[UnseenCar<'_>],
    steps: &mut FitSteps<'_, '_>,
) -> Result<Option<f64>, NnError> {
    // The time left is counted from this report on.
    if steps.advance(0).is_break() {
        return Ok(None);
    }
    let mut best = (f64::INFINITY, 1.0);
    for share in REMAINDERS {
        let errors_m: Vec<f64> = cars
            .par_iter()
            .flat_map_iter(|car| car.cases.iter().map(|case| (case, car.network)))
            .map(|(case, network)| Ok(Predicted::new(case, network, share)?.error_m(LEARNED_STEPS)))
            .collect::<Result<_, NnError>>()?;
        let sum: f64 = errors_m.iter().sum();
        if sum < best.0 {
            best = (sum, share);
        }
        if steps.advance(errors_m.len()).is_break() {
            return Ok(None);
        }
    }
    Ok(Some(best.1))
}

/// Second moment over cars of all their strengths.
fn bare(cars: &[Car<'_>]) -> DMatrix<f64> {
    let mut sum = DMatrix::zeros(N_EFFECTS, N_EFFECTS);
    for car in cars {
        let all = car.whole();
        sum += &car.strengths.covariance + &all * all.transpose();
    }
    sum / cars.len().max(1) as f64
}

/// Mean over windows of `JᵀJ` of the position at their ends.
fn importance(cars: &[Car<'_>]) -> DMatrix<f64> {
    let mut sum = DMatrix::zeros(N_EFFECTS, N_EFFECTS);
    let mut n = 0.0;
    for linearized in cars.iter().flat_map(|car| &car.linearized) {
        for row in 0..linearized.n_rows() {
            // X and Y at the end of a window.
            if row % N_ROWS == N_ROWS / 2 || row % N_ROWS == N_ROWS / 2 + 1 {
                let by = linearized.by_strengths.row(row);
                if by.iter().all(|value| value.is_finite()) {
                    sum += by.transpose() * by;
                    n += 1.0;
                }
            }
        }
    }
    sum / f64::max(n, 1.0)
}
