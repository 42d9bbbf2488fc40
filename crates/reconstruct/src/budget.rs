//! The evidence budget: how much narrower a quantity would be if another one were known.
//!
//! ```text
//! y_i = x_i + σ ε_i      w_ij ∝ N(y_i − x_j; 0, σ²)      expected spread = mean over i of spread(q; w_i)
//! ```
//!
//! The particles of the posterior are the possible truths: each in turn is taken as true, x is
//! measured with an error, and all particles are weighted by how well they agree with it. No motion
//! is simulated again.

use impactlab_core::numerics::{median, quantile_of_weighted, random_stream};
use rand::RngExt;
use rand_distr::StandardNormal;

/// Number of outcomes of the measurement.
const N_OUTCOMES: usize = 200;

/// Effective sample size below which half of the spreads would rest on too few particles.
const LEAST_ESS: f64 = 50.0;

/// The spread of a quantity now, and as expected with a measurement of another one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Narrowing {
    /// Width of the 90 % interval now, in the unit of the quantity.
    pub width_90_now: f64,
    /// Expected width of the 90 % interval with the measurement.
    pub width_90_then: f64,
    /// Standard deviation now.
    pub std_now: f64,
    /// Root mean square of the standard deviation with the measurement.
    pub std_then: f64,
    /// Effective sample size of the weighted particles, the median over the outcomes.
    pub ess: f64,
}

impl Narrowing {
    /// The narrowing of a quantity by a measurement of x; `None` if there are fewer than two
    /// particles, lists of different lengths, or a σ that is not positive.
    ///
    /// - `quantity`, `x`: values for each particle, all of the same weight;
    /// - `std_x`: standard deviation σ of the measurement, in the unit of x;
    /// - `ess`: effective sample size of the particles;
    /// - `seed`: seed of the errors of the measurement.
    pub fn by(quantity: &[f64], x: (&[f64], f64), ess: f64, seed: u64) -> Option<Self> {
        let (x, std_x) = x;
        let n = quantity.len();
        if n < 2 || x.len() != n || !(std_x > 0.0 && std_x.is_finite()) {
            return None;
        }
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by(|a, b| quantity[*a].total_cmp(&quantity[*b]));
        let sorted: Vec<f64> = order.iter().map(|idx| quantity[*idx]).collect();
        let now = Spread::from_sorted(&sorted, &vec![1.0; n])?;
        let mut rng = random_stream(seed, "evidence budget", 0);
        let n_outcomes = N_OUTCOMES.min(n);
        let mut then = Vec::with_capacity(n_outcomes);
        for outcome in 0..n_outcomes {
            let truth = outcome * n / n_outcomes;
            let error: f64 = rng.sample(StandardNormal);
            let measured = x[truth] + std_x * error;
            let ln_weight = |idx: &usize| -((measured - x[*idx]) / std_x).powi(2) / 2.0;
            let weights: Vec<f64> = order.iter().map(|idx| ln_weight(idx).exp()).collect();
            // An outcome so far from every particle that all weights vanish says nothing.
            then.extend(Spread::from_sorted(&sorted, &weights));
        }
        let mean = |value: &dyn Fn(&Spread) -> f64| {
            then.iter().map(value).sum::<f64>() / then.len() as f64
        };
        Some(Self {
            width_90_now: now.width_90,
            // What a measurement adds is never less than nothing: the rest is the error of the draws.
            width_90_then: mean(&|spread| spread.width_90).min(now.width_90),
            std_now: now.variance.sqrt(),
            std_then: mean(&|spread| spread.variance).min(now.variance).sqrt(),
            ess: median(then.iter().map(|spread| spread.effective))? * (ess / n as f64).min(1.0),
        })
    }

    /// Whether enough particles agree with a typical outcome for the spread to be believed.
    pub fn believable(&self) -> bool {
        self.ess >= LEAST_ESS
    }
}

/// The spread of weighted values.
struct Spread {
    width_90: f64,
    variance: f64,
    /// Kish's effective number of values.
    effective: f64,
}

impl Spread {
    fn from_sorted(sorted: &[f64], weights: &[f64]) -> Option<Self> {
        let at = |probability| quantile_of_weighted(sorted, weights, probability);
        let [sum, square] =
            weights.iter().fold([0.0; 2], |[s, q], weight| [s + weight, q + weight * weight]);
        let pairs = || sorted.iter().zip(weights);
        let mean = pairs().map(|(value, weight)| value * weight).sum::<f64>() / sum;
        let squares = pairs().map(|(value, weight)| weight * (value - mean).powi(2)).sum::<f64>();
        Some(Self {
            width_90: at(0.95)? - at(0.05)?,
            variance: squares / sum,
            effective: sum * sum / square,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Speeds and frictions of a joint normal distribution with standard deviations 3 and 0.1.
    fn particles(correlation: f64) -> [Vec<f64>; 2] {
        let mut rng = random_stream(1, "particles", 0);
        let mut draw = || {
            let [a, b]: [f64; 2] = [(); 2].map(|()| rng.sample(StandardNormal));
            [3.0 * (correlation * a + (1.0 - correlation * correlation).sqrt() * b), 0.1 * a]
        };
        let drawn: Vec<[f64; 2]> = (0..4000).map(|_| draw()).collect();
        [0, 1].map(|j| drawn.iter().map(|pair| pair[j]).collect())
    }

    /// In closed form the variance of the speed becomes 9 (1 − r² 0.01/(0.01 + σ²)).
    #[test]
    fn a_normal_posterior_narrows_as_the_closed_form_says() {
        for (correlation, std_x) in [(0.9, 0.05), (0.9, 0.2), (0.5, 0.05), (0.0, 0.05)] {
            let [speed, friction] = particles(correlation);
            let found = Narrowing::by(&speed, (&friction, std_x), 4000.0, 2).unwrap();
            let gain = correlation * correlation * 0.01 / (0.01 + std_x * std_x);
            let expected = 3.0 * f64::sqrt(1.0 - gain);
            let case = format!("r = {correlation}, σ = {std_x}: {found:?}, expected {expected}");
            assert!((found.std_then / expected - 1.0).abs() < 0.04, "{case}");
            assert!((found.width_90_then / expected / 3.29 - 1.0).abs() < 0.05, "{case}");
            assert!((found.std_now - 3.0).abs() < 0.1 && found.believable(), "{case}");
        }
    }

    #[test]
    fn a_measurement_finer_than_the_particles_is_not_believed() {
        let [speed, friction] = particles(0.9);
        let found = Narrowing::by(&speed, (&friction, 1e-5), 4000.0, 2).unwrap();
        assert!(!found.believable(), "{found:?}");
        let few = Narrowing::by(&speed, (&friction, 0.05), 40.0, 2).unwrap();
        assert!(!few.believable(), "particles of a small effective sample size: {few:?}");
    }

    #[test]
    fn what_cannot_be_weighed_is_none() {
        for std_x in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(Narrowing::by(&[1.0, 2.0], (&[1.0, 2.0], std_x), 2.0, 0), None);
        }
        assert_eq!(Narrowing::by(&[1.0, 2.0], (&[1.0], 1.0), 2.0, 0), None);
    }
}
