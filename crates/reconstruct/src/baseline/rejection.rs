//! Rejection sampling: independent draws from the posterior, at a price that only tiny questions
//! can pay.
//!
//! ```text
//! z ~ N(0, I), kept with the probability L(z) / L_max
//! ```

use rand::RngExt;

use crate::sampler::{Target, standard_normals};
use impactlab_core::numerics::random_stream;

/// Number of particles in one call of the likelihood.
const BATCH: usize = 1000;

/// Draws from the posterior.
#[derive(Debug, Clone, PartialEq)]
pub struct Rejection {
    /// The draws that were kept, `[n][dim]`.
    pub z: Vec<Vec<f64>>,
    /// Number of draws from the prior.
    pub n_evaluations: usize,
    /// Estimate of the log evidence, `ln L_max + ln (kept / drawn)`; −∞ if none was kept.
    pub log_evidence: f64,
}

/// Rejection sampling fails.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum RejectionError {
    /// The bound is none, so that the draws would not be of the posterior.
    #[error("a log likelihood is {found}, above the bound of {bound}")]
    AboveBound {
        /// The log likelihood.
        found: f64,
        /// The bound.
        bound: f64,
    },
}

/// Draws from the prior and keeps draws of the posterior.
///
/// - `log_bound`: `ln L_max`, which no log likelihood exceeds;
/// - `n_evaluations`: number of draws from the prior.
///
/// # Errors
/// [`RejectionError::AboveBound`].
pub fn rejection_sample(
    target: &(impl Target + ?Sized),
    log_bound: f64,
    n_evaluations: usize,
    seed: u64,
) -> Result<Rejection, RejectionError> {
    let mut rng = random_stream(seed, "rejection", 0);
    let mut accepted = Vec::new();
    let mut left = n_evaluations;
    while left > 0 {
        let n = BATCH.min(left);
        left -= n;
        let z: Vec<Vec<f64>> = (0..n).map(|_| standard_normals(target.dim(), &mut rng)).collect();
        for (value, z) in target.log_likelihoods(&z).into_iter().zip(z) {
            if value > log_bound {
                return Err(RejectionError::AboveBound { found: value, bound: log_bound });
            }
            // NaN is less than nothing.
            if rng.random::<f64>().ln() < value - log_bound {
                accepted.push(z);
            }
        }
    }
    let share = accepted.len() as f64 / n_evaluations as f64;
    Ok(Rejection { z: accepted, n_evaluations, log_evidence: log_bound + share.ln() })
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use super::*;
    use crate::sampler::test_targets::{Function, normal};
    use crate::sampler::{SamplerSettings, sample};

    /// A speed from the distance of a slide with unknown friction, with a share of the courses that
    /// have braked: curved, with two modes, in three dimensions.
    fn slide() -> Function<impl Fn(&[f64]) -> f64 + Sync> {
        let log_likelihood = |z: &[f64]| {
            let (speed, friction) = (20.0 + 4.0 * z[0], 0.7 * (0.2 * z[1]).exp());
            let braked = if z[2] > 0.8 { 1.0 } else { 0.4 };
            normal(speed * speed / (2.0 * 9.81 * friction * braked) / 60.0, 1.0, 0.1)
        };
        Function { dim: 3, log_likelihood }
    }

    #[test]
    fn the_sampler_agrees_with_rejection_on_a_tiny_question() {
        type Value<'a> = &'a dyn Fn(&[f64]) -> f64;
        let bound = normal(1.0, 1.0, 0.1);
        let reference = rejection_sample(&slide(), bound, 200_000, 1).unwrap();
        let settings = SamplerSettings { seed: 2, ..SamplerSettings::default() };
        let found = sample(&slide(), &settings, None, &mut |_| ControlFlow::Continue(())).unwrap();
        let moments = |z: &[Vec<f64>], value: Value<'_>| {
            let mean = z.iter().map(|z| value(z)).sum::<f64>() / z.len() as f64;
            let square = z.iter().map(|z| (value(z) - mean).powi(2)).sum::<f64>();
            (mean, (square / z.len() as f64).sqrt())
        };
        let values: [Value<'_>; 4] =
            [&|z| z[0], &|z| z[1], &|z| z[0] * z[1], &|z| f64::from(u8::from(z[2] > 0.8))];
        let n = found.ess.min(found.z.len() as f64);
        for (idx, value) in values.iter().enumerate() {
            let (expected, std) = moments(&reference.z, value);
            let (mean, found_std) = moments(&found.z, value);
            let error = 5.0 * std * (1.0 / n + 1.0 / reference.z.len() as f64).sqrt();
            assert!((mean - expected).abs() < error, "{idx}: {mean} for {expected} ± {error}");
            assert!((found_std / std - 1.0).abs() < 0.2, "{idx}: {found_std} for {std}");
        }
        let difference = found.log_evidence - reference.log_evidence;
        assert!(difference.abs() < 0.15, "log evidence differs by {difference}");
    }

    #[test]
    fn a_bound_that_is_none_is_refused() {
        let error = rejection_sample(&slide(), 0.0, 1000, 1).unwrap_err();
        assert!(matches!(error, RejectionError::AboveBound { bound: 0.0, .. }), "{error}");
    }
}
