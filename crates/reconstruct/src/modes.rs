//! Kinds of events that the posterior leaves open, apart from each other.

use std::collections::BTreeMap;

use crate::sampler::Particles;
use impactlab_core::numerics::{ClusterError, Clusters, share_standard_error};

/// Mean silhouette from which clusters count as separate. One normal distribution that is cut into
/// pieces stays below it.
const SEPARATE_SILHOUETTE: f64 = 0.7;

/// Largest number of particles that clusters are searched in; the silhouette takes its square.
const MAX_CLUSTERED: usize = 500;

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

/// Number of the cluster of each particle by quantities that the caller chooses; 0 for all where the
/// clusters are not separate. Clusters of up to 5 % of the particles belong to the nearest.
///
/// - `rows`: the quantities of each particle, `[n][n_quantities]`;
/// - `seed`: seed of the clustering.
///
/// # Errors
/// [`ClusterError`] if there are too few rows, or a value is not finite.
pub fn cluster_keys(rows: &[Vec<f64>], seed: u64) -> Result<Vec<usize>, ClusterError> {
    let stride = rows.len().div_ceil(MAX_CLUSTERED).max(1);
    let some: Vec<Vec<f64>> = rows.iter().step_by(stride).cloned().collect();
    let clusters = Clusters::fit(&some, seed)?;
    if clusters.silhouette < SEPARATE_SILHOUETTE {
        return Ok(vec![0; rows.len()]);
    }
    Ok(rows.iter().map(|row| clusters.nearest(row)).collect())
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
        let rows: Vec<Vec<f64>> = particles.z.iter().map(|z| vec![z[0], z[1] - z[2]]).collect();
        let clusters = cluster_keys(&rows, 0).unwrap();
        let modes = modes_by(&particles, |idx| clusters[idx]);
        assert_eq!(modes.len(), 2);
        assert!((modes[0].probability - 0.8).abs() < 0.04, "{}", modes[0].probability);
        assert!(modes[0].members.iter().all(|idx| particles.z[*idx][0] > 0.0));
        let error = modes[0].standard_error;
        assert!((0.003..0.04).contains(&error), "{error}");
        assert!((modes[0].probability + modes[1].probability - 1.0).abs() < 1e-12);
    }

    #[test]
    fn one_narrow_normal_is_one_mode() {
        let particles = posterior(&LinearGaussian::narrow());
        let rows: Vec<Vec<f64>> = particles.z.iter().map(|z| z[..2].to_vec()).collect();
        assert!(cluster_keys(&rows, 0).unwrap().iter().all(|cluster| *cluster == 0));
        let all = modes_by(&particles, |_| "all");
        assert_eq!(all[0].probability, 1.0);
        // Something that happens in none of 1000 independent draws may have a probability of 0.3 %.
        let error = all[0].standard_error;
        assert!((0.001..0.003).contains(&error), "{error}");
    }
}
