//! Simulation-based calibration: whether a sampler's posteriors hold the truths that they should.
//!
//! z is drawn from the prior, data from the likelihood, and particles from the posterior. The rank of
//! the true quantity among L independent particles is then uniform on 0 to L. Particles that depend
//! on each other are thinned to their effective number first.
//!
//! Source: [`Talts2018`](impactlab_core::bibliography::Talts2018).

use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::sampler::Particles;

/// Number of particles that the truth is ranked among. `RANKED + 1` is divided by several numbers of
/// bins.
const RANKED: usize = 19;

/// Ranks of a quantity over many simulated cases.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Ranks(Vec<usize>);

impl Ranks {
    /// Adds a case. Of the particles every `n/19`-th counts. Where several equal the truth, which
    /// happens to a quantity that is a class, the rank is drawn among them.
    ///
    /// - `values`: the quantity for each particle, all of the same weight;
    /// - `truth`: its true value;
    /// - `u`: uniform random number, 0 to 1.
    fn add(&mut self, values: &[f64], truth: f64, u: f64) {
        let chosen =
            (0..RANKED).filter_map(|k| values.get((2 * k + 1) * values.len() / (2 * RANKED)));
        let (mut below, mut equal) = (0, 0);
        for value in chosen {
            below += usize::from(*value < truth);
            equal += usize::from(*value == truth);
        }
        self.0.push(below + ((equal + 1) as f64 * u) as usize);
    }

    /// How many ranks fall into each of some bins.
    pub fn counts(&self, n_bins: usize) -> Vec<usize> {
        let mut counts = vec![0; n_bins];
        self.0.iter().for_each(|rank| counts[rank * n_bins / (RANKED + 1)] += 1);
        counts
    }

    /// Probability that uniform ranks differ from uniformity by as much as these, by Pearson's χ²
    /// over bins of the ranks.
    ///
    /// - `n_bins`: 2, 4, 5, 10 or 20; each should hold five cases or more on average.
    /// - returns `None` for another number of bins, or without cases.
    pub fn p_value(&self, n_bins: usize) -> Option<f64> {
        if self.0.is_empty() || n_bins < 2 || !(RANKED + 1).is_multiple_of(n_bins) {
            return None;
        }
        let expected = self.0.len() as f64 / n_bins as f64;
        let square = |n: usize| (n as f64 - expected).powi(2) / expected;
        let chi_square: f64 = self.counts(n_bins).into_iter().map(square).sum();
        Some(ChiSquared::new((n_bins - 1) as f64).ok()?.sf(chi_square))
    }
}

/// Ranks of several quantities over all cases, each of which has the same ones.
pub fn ranks_of_cases(cases: &[Vec<RankedQuantity>]) -> Vec<Ranks> {
    let mut ranks = vec![Ranks::default(); cases.first().map_or(0, Vec::len)];
    for case in cases {
        for (ranks, quantity) in ranks.iter_mut().zip(case) {
            ranks.add(&quantity.values, quantity.truth, quantity.u);
        }
    }
    ranks
}

/// A quantity of one simulated case.
#[derive(Debug, Clone, PartialEq)]
pub struct RankedQuantity {
    /// The true value.
    pub truth: f64,
    /// The value for each particle.
    pub values: Vec<f64>,
    /// Uniform random number, 0 to 1, which orders equal values.
    pub u: f64,
}

impl RankedQuantity {
    /// A quantity that is a function of z.
    pub fn new(
        particles: &Particles,
        truth: &[f64],
        u: f64,
        quantity: impl Fn(&[f64]) -> f64,
    ) -> Self {
        let values = particles.z.iter().map(|z| quantity(z)).collect();
        Self { truth: quantity(truth), values, u }
    }
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use rand::RngExt;

    use super::*;
    use crate::sampler::test_targets::{Function, normal};
    use crate::sampler::{SamplerSettings, sample, standard_normals};
    use impactlab_core::numerics::random_stream;

    /// Ranks of z₀, z₁, their product and a class over cases of two measurements; `claimed` is the
    /// factor by which the likelihood takes the noise for larger than it is.
    fn ranks(claimed: f64) -> Vec<Ranks> {
        let case = |idx: usize| {
            let mut rng = random_stream(4, "calibration", idx as u64);
            let truth = standard_normals(3, &mut rng);
            let noise = standard_normals(2, &mut rng);
            let data = [truth[0] + truth[1] + 0.1 * noise[0], truth[2] - truth[0] + 0.3 * noise[1]];
            let log_likelihood = |z: &[f64]| {
                normal(z[0] + z[1], data[0], 0.1 * claimed)
                    + normal(z[2] - z[0], data[1], 0.3 * claimed)
            };
            let settings = SamplerSettings {
                n_particles: 200,
                seed: idx as u64,
                least_ess: 60.0,
                max_evaluations: 4000,
            };
            let target = Function { dim: 3, log_likelihood };
            let particles =
                sample(&target, &settings, None, &mut |_| ControlFlow::Continue(())).unwrap();
            let mut ranked = |quantity: &dyn Fn(&[f64]) -> f64| {
                RankedQuantity::new(&particles, &truth, rng.random(), quantity)
            };
            vec![
                ranked(&|z| z[0]),
                ranked(&|z| z[0] + z[1]),
                ranked(&|z| z[1] * z[2]),
                ranked(&|z| f64::from(u8::from(z[0] > 0.3))),
            ]
        };
        ranks_of_cases(&(0..200).map(case).collect::<Vec<_>>())
    }

    #[test]
    fn the_sampler_is_calibrated_on_a_linear_question() {
        for (quantity, ranks) in ranks(1.0).iter().enumerate() {
            let p = ranks.p_value(10).unwrap();
            assert!(p > 0.01, "quantity {quantity}: p = {p}, ranks {ranks:?}");
        }
    }

    #[test]
    fn a_likelihood_that_claims_too_little_noise_is_found_out() {
        let ranks = ranks(0.4);
        let p = ranks[1].p_value(10).unwrap();
        assert!(p < 1e-3, "p = {p}");
    }

    #[test]
    fn ranks_by_hand() {
        let mut ranks = Ranks::default();
        let values: Vec<f64> = (0..19).map(f64::from).collect();
        ranks.add(&values, -1.0, 0.5);
        ranks.add(&values, 30.0, 0.5);
        ranks.add(&[5.0; 19], 5.0, 0.999);
        assert_eq!(ranks, Ranks(vec![0, 19, 19]));
        assert_eq!(ranks.p_value(3), None);
        // Two bins of one and two: χ² = 1/3 with one degree of freedom.
        assert!((ranks.p_value(2).unwrap() - 0.563_702_9).abs() < 1e-6);
    }
}
