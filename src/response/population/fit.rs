//! Expectation maximisation of the distribution of strengths over cars.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::nn::NnError;
use crate::response::network::response_network::ResponseNetwork;
use crate::response::population::distribution::{LEARNED_STEPS, window_weight};
use crate::response::population::linearized::{Linearized, N_ROWS, Predicted};
use crate::response::population::strengths::Evidence;
use crate::response::{CarStrengths, N_EFFECTS, ResponseCase, StrengthPopulation};

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
/// First guess of the factor on the noise of the steps.
const STEP_NOISE: f64 = 0.1;

/// Trajectories of one car, and a network that has not seen them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct UnseenCar<'a> {
    pub cases: &'a [&'a ResponseCase],
    pub network: &'a ResponseNetwork,
}

/// A car of the fit.
struct Car<'a> {
    predicted: Vec<Predicted<'a>>,
    /// Strengths of its network, `[N_EFFECTS]`.
    of_network: DVector<f64>,
    linearized: Vec<Linearized>,
    strengths: CarStrengths,
}

/// Second moments of one motion: of its strengths about those of the car, and of the rows of its
/// windows.
struct Motion {
    within: DMatrix<f64>,
    noise: [f64; N_ROWS],
    n_windows: f64,
}

impl StrengthPopulation {
    /// The distribution over the cars of a fleet, each predicted by a network that has not seen it.
    ///
    /// # Errors
    /// [`NnError`] if a tensor cannot be read.
    pub(crate) fn fit(cars: &[UnseenCar<'_>]) -> Result<Self, NnError> {
        let mut population = Self::guess();
        let mut fitted = cars.iter().map(Car::new).collect::<Result<Vec<Car<'_>>, NnError>>()?;
        for _ in 0..N_LINEARIZATIONS {
            for car in &mut fitted {
                let mean = &car.strengths.mean;
                car.linearized =
                    car.predicted.par_iter().map(|of| of.linearized(mean, LEARNED_STEPS)).collect();
            }
            for _ in 0..N_ITERATIONS {
                population.expect(&mut fitted);
                population.maximise(&fitted);
            }
        }
        population.bare = bare(&fitted);
        population.importance = importance(&fitted);
        Ok(population)
    }

    /// A guess before any car is seen.
    pub(super) fn guess() -> Self {
        let between = DMatrix::identity(N_EFFECTS, N_EFFECTS) * PRIOR_STD.powi(2);
        Self {
            bare: between.clone(),
            importance: DMatrix::identity(N_EFFECTS, N_EFFECTS),
            between,
            within: DMatrix::identity(N_EFFECTS, N_EFFECTS) * PRIOR_WITHIN_STD.powi(2),
            noise: [FIRST_NOISE; N_ROWS],
            widening: 1.0,
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
                .map(|of| self.evidence(of, &car.strengths.mean))
                .collect();
            car.strengths = self.prior().updated(&Evidence::sum(evidence));
        }
    }

    /// The distribution over cars, given the strengths of every car.
    fn maximise(&mut self, cars: &[Car<'_>]) {
        let mut between =
            DMatrix::identity(N_EFFECTS, N_EFFECTS) * (PRIOR_STD.powi(2) * PRIOR_CARS);
        for car in cars {
            let CarStrengths { mean, covariance } = &car.strengths;
            between += covariance + mean * mean.transpose();
        }
        self.between = between / (PRIOR_CARS + cars.len() as f64);
        let motions: Vec<Motion> = cars
            .iter()
            .flat_map(|car| car.linearized.iter().map(move |of| (car, of)))
            .collect::<Vec<_>>()
            .par_iter()
            .filter_map(|(car, of)| self.motion(&car.strengths, of))
            .collect();
        let mut within =
            DMatrix::identity(N_EFFECTS, N_EFFECTS) * (PRIOR_WITHIN_STD.powi(2) * PRIOR_MOTIONS);
        let (mut noise, mut n_windows) = ([0.0; N_ROWS], 0.0);
        for motion in &motions {
            within += &motion.within;
            noise.iter_mut().zip(motion.noise).for_each(|(sum, of)| *sum += of);
            n_windows += motion.n_windows;
        }
        self.within = within / (PRIOR_MOTIONS + motions.len() as f64);
        self.noise = noise.map(|sum| (sum / f64::max(n_windows, 1.0)).max(LEAST_NOISE));
    }

    /// Second moments of what the strengths of the car leave of one motion.
    fn motion(&self, car: &CarStrengths, of: &Linearized) -> Option<Motion> {
        let left = &of.target - &of.by_strengths * &car.mean;
        let weights = DVector::from_fn(of.n_rows(), |row, _| 1.0 / self.noise[row % N_ROWS]);
        let weighted = DMatrix::from_diagonal(&weights) * &of.by_strengths;
        let precision =
            self.within.clone().cholesky()?.inverse() + weighted.tr_mul(&of.by_strengths);
        let root = precision.cholesky()?;
        let mean = root.solve(&weighted.tr_mul(&left));
        let covariance = root.inverse();
        let left = left - &of.by_strengths * &mean;
        let uncertain = &of.by_strengths * (&covariance + &car.covariance);
        let n_windows = of.n_rows() / N_ROWS;
        let mut noise = [0.0; N_ROWS];
        for window in 0..n_windows {
            let rows = window * N_ROWS..(window + 1) * N_ROWS;
            let distance: f64 = rows.clone().map(|row| left[row].powi(2) * weights[row]).sum();
            let distance = distance / N_ROWS as f64;
            let weight = window_weight(distance);
            for (noise, row) in noise.iter_mut().zip(rows) {
                let by_strengths = uncertain.row(row).dot(&of.by_strengths.row(row));
                *noise += weight * left[row].powi(2) + by_strengths;
            }
        }
        let within = &mean * mean.transpose() + covariance;
        let is_finite = noise.iter().chain(&within).all(|value| value.is_finite());
        is_finite.then_some(Motion { within, noise, n_windows: n_windows as f64 })
    }
}

impl<'a> Car<'a> {
    fn new(of: &UnseenCar<'a>) -> Result<Self, NnError> {
        let predicted: Vec<Predicted<'a>> = of
            .cases
            .iter()
            .map(|case| Predicted::new(case, of.network))
            .collect::<Result<_, _>>()?;
        let zero = DVector::zeros(N_EFFECTS);
        Ok(Self {
            of_network: predicted.first().map_or_else(|| zero.clone(), |of| of.strengths.clone()),
            predicted,
            linearized: Vec::new(),
            strengths: CarStrengths {
                mean: zero,
                covariance: DMatrix::identity(N_EFFECTS, N_EFFECTS),
            },
        })
    }
}

/// Second moment over cars of all their strengths.
fn bare(cars: &[Car<'_>]) -> DMatrix<f64> {
    let mut sum = DMatrix::zeros(N_EFFECTS, N_EFFECTS);
    for car in cars {
        let all = &car.of_network + &car.strengths.mean;
        sum += &car.strengths.covariance + &all * all.transpose();
    }
    sum / cars.len().max(1) as f64
}

/// Mean over windows of `JᵀJ` of the position at their ends.
fn importance(cars: &[Car<'_>]) -> DMatrix<f64> {
    let mut sum = DMatrix::zeros(N_EFFECTS, N_EFFECTS);
    let mut n = 0.0;
    for of in cars.iter().flat_map(|car| &car.linearized) {
        for row in 0..of.n_rows() {
            // X and Y at the end of a window.
            if row % N_ROWS == N_ROWS / 2 || row % N_ROWS == N_ROWS / 2 + 1 {
                let by = of.by_strengths.row(row);
                if by.iter().all(|value| value.is_finite()) {
                    sum += by.transpose() * by;
                    n += 1.0;
                }
            }
        }
    }
    sum / f64::max(n, 1.0)
}
