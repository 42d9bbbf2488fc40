//! The distribution of strengths over cars, and the directions in which a prediction is uncertain by
//! it.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::nn::NnError;
use crate::response::network::response_network::ResponseNetwork;
use crate::response::physics::effects::is_of_collision;
use crate::response::population::linearized::{
    Linearized, N_ROWS, PATHS_PER_LINEARIZATION, Predicted,
};
use crate::response::population::strengths::Evidence;
use crate::response::predict::{Latents, N_OF_COLLISION};
use crate::response::{CarStrengths, N_EFFECTS, N_LATENTS, ResponseCase, Widths, vehicle_tokens};
use impactlab_core::vehicle::VehicleParameters;

/// Degrees of freedom of Student's distribution, by which windows that are far off count less.
const DEGREES_OF_FREEDOM: f64 = 4.0;
/// Steps of the windows by which a car is told by its trajectories. Over 2 s a drag that is off shows
/// where over 1 s the yaw rate outweighs it.
const CAR_WINDOW_STEPS: usize = 200;
/// Share of what these windows say of a car that counts: they are off by more than those of
/// [`FIT_WINDOW_STEPS`](super::fit::FIT_WINDOW_STEPS), from which the noise is known, and what the effects
/// cannot explain is not independent from row to row, window to window and motion to motion.
///
/// Steps and share were chosen on the 15 cars of the second design that are learned from, by a network
/// that had not seen them (four choices of the motions): mean error over 4 s, m, after 1, 5 and 9
/// trajectories.
///
/// | steps | share | 1 | 5 | 9 |
/// | --- | --- | --- | --- | --- |
/// | 100 | 0.15, as in the fit | 0.61 | 0.55 | 0.57 |
/// | 200 | 0.05 | 0.57 | 0.49 | 0.49 |
/// | 200 | 0.15 | 0.62 | 0.50 | 0.49 |
/// | 400 | 0.02 | 0.55 | 0.50 | 0.51 |
/// | 400 | 0.05 | 0.56 | 0.49 | 0.50 |
///
/// With Σ_within as a further error of each motion, they come out worse (0.59, 0.58, 0.54 with 200 steps
/// and 0.15). Regions hold as many with 200 steps as with 100.
const CAR_SHARE: f64 = 0.05;
/// Rounds of linearisation about what the last one found.
const N_ROUNDS: usize = 3;
/// Steps of a trajectory that are learned from: 4 s.
pub(super) const LEARNED_STEPS: usize = 400;
/// Place of the friction of the road among the tokens of the tires: it is not the car's.
const FRICTION_TOKEN: [usize; 2] = [2, 2];
/// Difference of tokens below which two vehicles are the same.
const SAME_TOKENS: f64 = 1e-6;

/// The distribution of what is added to the strengths of a network, over cars and over the motions of a
/// car.
#[derive(Debug, Clone, PartialEq)]
pub struct StrengthPopulation {
    /// Mean over cars of all the strengths, those of a network included, `[N_EFFECTS]`.
    pub(super) mean: DVector<f64>,
    /// Share of the remainder of a network that holds for cars that it has not learned from.
    pub(super) remainder: f64,
    /// Σ_between.
    pub(super) between: DMatrix<f64>,
    /// Second moment over cars of all the strengths, those of the network included: how far the bare
    /// physics errs.
    pub(super) bare: DMatrix<f64>,
    /// Mean over windows of `JᵀJ` of the position at their ends: how much a change of strengths moves
    /// the vehicle.
    pub(super) importance: DMatrix<f64>,
    /// Σ_within.
    pub(super) within: DMatrix<f64>,
    /// R: variances of X, Y, ψ, v_x, v_y, r in the middle and at the end of a window about what the
    /// strengths of the car say.
    pub(super) noise: [f64; N_ROWS],
    /// How wide the distributions of motions are, of cars that a network has not learned from.
    pub(super) widths: Widths,
    /// Factor on the standard deviation of each step's noise.
    pub(super) step_noise: f64,
    /// Cars of which trajectories are known.
    pub(super) cars: Vec<KnownCar>,
}

/// A car of which trajectories are known.
#[derive(Debug, Clone, PartialEq)]
pub struct KnownCar {
    /// Its parameters; the friction is that of one of its trajectories.
    pub vehicle: VehicleParameters,
    /// Trajectories that were learned from.
    pub n_trajectories: usize,
    /// What they say of its strengths.
    pub strengths: CarStrengths,
}

impl KnownCar {
    /// Whether a vehicle is this car, on whatever road.
    pub fn is(&self, vehicle: &VehicleParameters) -> bool {
        is_same_car(&self.vehicle, vehicle)
    }
}

/// Weight of each window by how many variances its rows are off.
///
/// - `left`: row after row of every window.
pub(super) fn window_weights(left: &DVector<f64>, noise: &[f64; N_ROWS]) -> Vec<f64> {
    let weight = |rows: &[f64]| {
        let squares: f64 = rows.iter().zip(noise).map(|(left, noise)| left * left / noise).sum();
        (DEGREES_OF_FREEDOM + 1.0) / (DEGREES_OF_FREEDOM + squares / N_ROWS as f64)
    };
    left.as_slice().chunks_exact(N_ROWS).map(weight).collect()
}

/// Whether two vehicles are the same car, on whatever roads.
pub fn is_same_car(one: &VehicleParameters, other: &VehicleParameters) -> bool {
    let [mut one, mut other] = [one, other].map(vehicle_tokens);
    let [group, number] = FRICTION_TOKEN;
    (one[group][number], other[group][number]) = (0.0, 0.0);
    one.iter().flatten().zip(other.iter().flatten()).all(|(a, b)| (a - b).abs() < SAME_TOKENS)
}

impl StrengthPopulation {
    /// The car that a vehicle is, if trajectories of it are known.
    pub fn known(&self, vehicle: &VehicleParameters) -> Option<&KnownCar> {
        self.cars.iter().rev().find(|car| car.is(vehicle))
    }

    /// The cars of which trajectories are known.
    pub fn cars(&self) -> &[KnownCar] {
        &self.cars
    }

    /// The strengths of a car.
    ///
    /// - `of_network`: strengths of the network.
    pub fn car_strengths(
        &self,
        vehicle: &VehicleParameters,
        of_network: &[f64; N_EFFECTS],
    ) -> CarStrengths {
        self.known(vehicle).map_or_else(|| self.prior(of_network), |car| car.strengths.clone())
    }

    /// How much is still open of a car, 0 to 1: how far its strengths may move it, over that of a car that
    /// nobody has measured.
    ///
    /// ```text
    /// s = tr(Σ G)/tr(Σ_between G)
    /// ```
    ///
    /// A motion that excites no effect leaves it at 1.
    pub(crate) fn open_share(&self, car: &CarStrengths) -> f64 {
        let moves = |covariance: &DMatrix<f64>| covariance.component_mul(&self.importance).sum();
        let of_any = moves(&self.between);
        if of_any > 0.0 { (moves(&car.covariance) / of_any).clamp(0.0, 1.0) } else { 1.0 }
    }

    /// Share of the remainder of a network that holds for cars that it has not learned from.
    pub fn remainder(&self) -> f64 {
        self.remainder
    }

    /// How wide the distributions of motions are, of cars that a network has not learned from.
    pub fn widths(&self) -> Widths {
        self.widths
    }

    /// Replaces how wide the distributions of motions are, also those of the known cars.
    pub(crate) fn set_widths(&mut self, widths: Widths) {
        self.widths = widths;
        for car in &mut self.cars {
            car.strengths.widths = widths;
        }
    }

    /// The same distribution, with other widths for cars that are not known, and for those that are no
    /// better known than that.
    #[must_use]
    pub(crate) fn with_new_widths(mut self, widths: Widths) -> Self {
        let before = std::mem::replace(&mut self.widths, widths);
        for car in self.cars.iter_mut().filter(|car| car.strengths.widths == before) {
            car.strengths.widths = widths;
        }
        self
    }

    /// The same distribution, with no car known.
    #[must_use]
    pub(crate) fn without_cars(mut self) -> Self {
        self.cars.clear();
        self
    }

    /// The strengths of a car that nobody has measured: those of the network give way to the mean over
    /// cars.
    pub(super) fn prior(&self, of_network: &[f64; N_EFFECTS]) -> CarStrengths {
        CarStrengths {
            mean: &self.mean - DVector::from_row_slice(of_network),
            covariance: self.between.clone(),
            remainder: self.remainder,
            widths: self.widths,
        }
    }

    /// How many paths of [`LEARNED_STEPS`] are computed to learn the strengths of a car.
    pub(crate) fn n_paths_of_car(n_cases: usize) -> usize {
        N_ROUNDS * n_cases * PATHS_PER_LINEARIZATION
    }

    /// The strengths of a car after trajectories.
    ///
    /// - `prior`: before them.
    fn posterior(
        &self,
        prior: &CarStrengths,
        network: &ResponseNetwork,
        cases: &[&ResponseCase],
    ) -> Result<CarStrengths, NnError> {
        let predicted: Vec<Predicted<'_>> = cases
            .iter()
            .map(|case| Predicted::new(case, network, prior.remainder))
            .collect::<Result<_, _>>()?;
        let mut posterior = prior.clone();
        for _ in 0..N_ROUNDS {
            let evidence: Vec<Evidence> = predicted
                .par_iter()
                .map(|one| {
                    let linearized =
                        one.linearized(&posterior.mean, LEARNED_STEPS, CAR_WINDOW_STEPS);
                    self.evidence(&linearized, &posterior.mean)
                })
                .collect();
            posterior = prior.updated(&Evidence::sum(evidence).times(CAR_SHARE));
        }
        Ok(posterior)
    }

    /// The same distribution with a car that the network itself has learned from: what trajectories add
    /// to its strengths is in the network already, and only how well they are known is new.
    ///
    /// - `widths`: how wide the distribution of a motion of this car is.
    ///
    /// # Errors
    /// [`NnError`] if a tensor cannot be read.
    pub(crate) fn with_learned_car(
        mut self,
        network: &ResponseNetwork,
        widths: Widths,
        cases: &[&ResponseCase],
    ) -> Result<Self, NnError> {
        let Some(first) = cases.first() else { return Ok(self) };
        let mean = DVector::zeros(N_EFFECTS);
        let of_network = network.mean_strengths()?;
        let prior = self.prior(&of_network);
        let prior = CarStrengths { mean: mean.clone(), remainder: 1.0, widths, ..prior };
        let strengths = CarStrengths { mean, ..self.posterior(&prior, network, cases)? };
        self.remember(first, cases.len(), strengths);
        Ok(self)
    }

    /// The same distribution after trajectories of one car, which are new.
    ///
    /// # Errors
    /// [`NnError`] if a tensor cannot be read.
    pub(crate) fn with_car(
        mut self,
        network: &ResponseNetwork,
        cases: &[&ResponseCase],
    ) -> Result<Self, NnError> {
        let Some(first) = cases.first() else { return Ok(self) };
        let strengths = self.posterior(
            &self.car_strengths(&first.vehicle, &network.mean_strengths()?),
            network,
            cases,
        )?;
        let n_known = self.known(&first.vehicle).map_or(0, |car| car.n_trajectories);
        self.remember(first, n_known + cases.len(), strengths);
        Ok(self)
    }

    /// Makes a car known.
    ///
    /// - `first`: one of its trajectories.
    fn remember(&mut self, first: &ResponseCase, n_trajectories: usize, strengths: CarStrengths) {
        self.cars.retain(|car| !car.is(&first.vehicle));
        let vehicle = VehicleParameters { sheet: None, ..first.vehicle.clone() };
        self.cars.push(KnownCar { vehicle, n_trajectories, strengths });
    }

    /// Strengths, those of the network included, after trajectories.
    ///
    /// # Errors
    /// [`NnError`] if a tensor cannot be read.
    pub(crate) fn strengths_of(
        &self,
        network: &ResponseNetwork,
        cases: &[&ResponseCase],
    ) -> Result<Vec<f64>, NnError> {
        let Some(first) = cases.first() else { return Ok(vec![0.0; N_EFFECTS]) };
        let of_network = network.mean_strengths()?;
        let prior = self.car_strengths(&first.vehicle, &of_network);
        let added = self.posterior(&prior, network, cases)?.mean;
        Ok(of_network.iter().zip(&added).map(|(of_network, added)| of_network + added).collect())
    }

    /// What one trajectory says. Windows that are far off, as where a wheel lifts, count less (Student's
    /// distribution).
    ///
    /// - `mean`: strengths about which that is judged.
    pub(super) fn evidence(&self, linearized: &Linearized, mean: &DVector<f64>) -> Evidence {
        let left = &linearized.target - &linearized.by_strengths * mean;
        let mut weighted = linearized.by_strengths.clone();
        for (window, weight) in window_weights(&left, &self.noise).into_iter().enumerate() {
            for row in window * N_ROWS..(window + 1) * N_ROWS {
                weighted.row_mut(row).scale_mut(weight / self.noise[row % N_ROWS]);
            }
        }
        let evidence = Evidence {
            precision: weighted.tr_mul(&linearized.by_strengths),
            weighted: weighted.tr_mul(&linearized.target),
        };
        // Where a window is not finite, the trajectory says nothing.
        if evidence.is_finite() { evidence } else { Evidence::none() }
    }

    /// The directions in which a prediction is uncertain.
    ///
    /// - `strengths`: of the car;
    /// - `applicability`: 1 where it is like what was learned from, 0 where only the bare physics is
    ///   left; `beyond`: how far outside, in units of what was learned from.
    pub(crate) fn latents(
        &self,
        strengths: &CarStrengths,
        [applicability, beyond]: [f64; 2],
    ) -> Latents {
        let mut covariance = strengths.covariance.clone();
        if applicability < 1.0 {
            let fading = 1.0 - applicability * applicability;
            let growth = (1.0 + beyond).powi(2);
            covariance *= applicability * applicability;
            covariance += &self.bare * (fading * growth);
        }
        covariance += &self.within;
        covariance *= strengths.widths.widening.powi(2);
        Latents {
            directions: self.principal(&covariance),
            shared_out: 0,
            step_noise: self.step_noise,
            tail_ratio: strengths.widths.tail_ratio,
            growth: strengths.widths.growth,
            braked: strengths.widths.braked,
        }
    }

    /// The directions that move the vehicle most, of vehicle and road and of the collision apart:
    /// with L Lᵀ the covariance and V the eigenvectors of `Lᵀ G L`, the first columns of `L V`. What
    /// the others would move it is put on them in proportion.
    fn principal(&self, covariance: &DMatrix<f64>) -> [[f64; N_EFFECTS]; N_LATENTS] {
        let mut all = [[0.0; N_EFFECTS]; N_LATENTS];
        let (of_vehicle, of_collision) = all.split_at_mut(N_LATENTS - N_OF_COLLISION);
        for (slots, is_collision) in [(of_vehicle, false), (of_collision, true)] {
            let places: Vec<usize> =
                (0..N_EFFECTS).filter(|k| is_of_collision(*k) == is_collision).collect();
            let part = |matrix: &DMatrix<f64>| matrix.select_rows(&places).select_columns(&places);
            let floor = DMatrix::identity(places.len(), places.len()) * 1e-12;
            let Some(root) = (part(covariance) + floor).cholesky() else { continue };
            let root = root.unpack();
            let moved = root.transpose() * part(&self.importance) * &root;
            let eigen = moved.symmetric_eigen();
            let mut order: Vec<usize> = (0..places.len()).collect();
            order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
            let retained: f64 = order.iter().take(slots.len()).map(|i| eigen.eigenvalues[*i]).sum();
            let total: f64 = eigen.eigenvalues.iter().sum();
            let scale = if retained > 0.0 { (total / retained).max(1.0).sqrt() } else { 1.0 };
            for (slot, i) in slots.iter_mut().zip(order) {
                let direction = &root * eigen.eigenvectors.column(i) * scale;
                for (place, value) in places.iter().zip(direction.iter()) {
                    slot[*place] = *value;
                }
            }
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A log of a calm drive made a car as well known as one that had spun.
    #[test]
    fn a_car_is_known_as_far_as_its_motions_say_what_moves_it() {
        let mut population = StrengthPopulation::guess();
        population.importance = DMatrix::identity(N_EFFECTS, N_EFFECTS);
        let mut car = population.prior(&[0.0; N_EFFECTS]);
        let open = |car: &CarStrengths| population.open_share(car);
        assert!((open(&car) - 1.0).abs() < 1e-12);
        assert!((open(&car.updated(&Evidence::none())) - 1.0).abs() < 1e-9, "a calm drive");
        let mut evidence = Evidence::none();
        let mut last = 1.0;
        for strength in 0..N_EFFECTS {
            evidence.precision[(strength, strength)] = 1e6;
            let share = open(&car.updated(&evidence));
            assert!(share < last, "strength {strength}: {share}, before {last}");
            last = share;
        }
        assert!(last < 0.01, "{last}");
        car.covariance *= 0.25;
        assert!((open(&car) - 0.25).abs() < 1e-12);
    }
}
