//! Latin hypercube sampling: as many draws as strata in every dimension, one in each.
//!
//! Each draw has the distribution that it would have by itself, while a mean over the draws has less
//! chance in it. Source: [`McKay1979`](crate::bibliography::McKay1979).

use rand::seq::SliceRandom as _;
use rand::{Rng, RngExt as _};

use crate::numerics::normal_quantile;

/// One dimension of n draws that are uniform between 0 and 1: one in each of n equal parts, in random
/// order.
pub fn latin_uniforms(n: usize, rng: &mut impl Rng) -> Vec<f64> {
    let mut draws: Vec<f64> = (0..n).map(|i| (i as f64 + rng.random::<f64>()) / n as f64).collect();
    draws.shuffle(rng);
    draws
}

/// One dimension of n standard normal draws, one in each of n equally probable parts.
pub fn latin_normals(n: usize, rng: &mut impl Rng) -> Vec<f64> {
    let normal = |u: f64| normal_quantile(u.clamp(f64::EPSILON, 1.0 - f64::EPSILON));
    latin_uniforms(n, rng).into_iter().map(normal).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::random_stream;

    #[test]
    fn each_part_has_one_draw_and_the_mean_hardly_any_chance() {
        let mut rng = random_stream(3, "test", 0);
        let mut parts: Vec<usize> =
            latin_uniforms(50, &mut rng).iter().map(|u| (u * 50.0) as usize).collect();
        assert!(parts.windows(2).any(|pair| pair[0] > pair[1]), "in order");
        parts.sort_unstable();
        assert_eq!(parts, (0..50).collect::<Vec<_>>());
        let mean = |draws: &[f64]| draws.iter().sum::<f64>() / draws.len() as f64;
        for seed in 0..20 {
            let draws = latin_normals(100, &mut random_stream(seed, "test", 1));
            let squares: Vec<f64> = draws.iter().map(|z| z * z).collect();
            // Independent draws would scatter by 0.1 and 0.14.
            assert!(mean(&draws).abs() < 0.02, "{}", mean(&draws));
            assert!((mean(&squares) - 1.0).abs() < 0.15, "{}", mean(&squares));
        }
        assert!(latin_normals(0, &mut rng).is_empty());
    }
}
