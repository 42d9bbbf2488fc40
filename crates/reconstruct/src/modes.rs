//! Kinds of events that the posterior leaves open, apart from each other.

use std::collections::BTreeMap;

use crate::sampler::Particles;
use impactlab_core::numerics::share_standard_error;

/// Particles of one kind.
#[derive(Debug, Clone, PartialEq)]
pub struct ParticleMode<K> {
    /// What its particles have in common.
    pub key: K,
    /// Its share of the particles, 0 to 1.
    pub probability: f64,
    /// Standard error of the probability, from how often each draw is among the particles. It is not
    /// nothing where all of them are of this kind.
    pub standard_error: f64,
    /// Indices of its particles.
    pub members: Vec<usize>,
}

/// Divides particles by a key, such as the locked wheel and the number of turns. The most probable
/// mode is the first.
///
/// - `key`: the key of the particle of an index.
pub fn modes_by<K: Ord + Clone>(
    particles: &Particles,
    key: impl Fn(usize) -> K,
) -> Vec<ParticleMode<K>> {
    let n = particles.z.len();
    let mut members: BTreeMap<K, Vec<usize>> = BTreeMap::new();
    for idx in 0..n {
        members.entry(key(idx)).or_default().push(idx);
    }
    let mode = |(key, members): (K, Vec<usize>)| {
        let mut indicator = vec![0.0; n];
        members.iter().for_each(|idx| indicator[*idx] = 1.0);
        let probability = members.len() as f64 / n as f64;
        let ess = particles.effective_sample_size(&indicator);
        let ess = ess.unwrap_or_else(|| particles.effective_draws());
        let standard_error = share_standard_error(probability, ess);
        ParticleMode { key, probability, standard_error, members }
    };
    let mut modes: Vec<ParticleMode<K>> = members.into_iter().map(mode).collect();
    modes.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    modes
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use super::*;
    use crate::sampler::test_targets::{LinearGaussian, bimodal};
    use crate::sampler::{SamplerSettings, Target, sample};

    fn posterior(target: &impl Target) -> Particles {
        let settings = SamplerSettings { seed: 11, ..SamplerSettings::default() };
        sample(target, &settings, None, &mut |_| ControlFlow::Continue(())).unwrap()
    }

    #[test]
    fn two_modes_have_their_probabilities_and_standard_errors() {
        let particles = posterior(&bimodal());
        let modes = modes_by(&particles, |idx| particles.z[idx][0] > 0.0);
        assert_eq!((modes.len(), modes[0].key), (2, true));
        assert!((modes[0].probability - 0.8).abs() < 0.04, "{}", modes[0].probability);
        assert!(modes[0].members.iter().all(|idx| particles.z[*idx][0] > 0.0));
        let error = modes[0].standard_error;
        assert!((0.003..0.04).contains(&error), "{error}");
        assert!((modes[0].probability + modes[1].probability - 1.0).abs() < 1e-12);
    }

    #[test]
    fn what_all_particles_have_in_common_has_a_standard_error() {
        let particles = posterior(&LinearGaussian::narrow());
        let all = modes_by(&particles, |_| "all");
        assert_eq!(all[0].probability, 1.0);
        // Something that happens in none of 1000 independent draws may have a probability of 0.3 %.
        let error = all[0].standard_error;
        assert!((0.001..0.003).contains(&error), "{error}");
    }
}
