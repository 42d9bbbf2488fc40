//! Scores of draws from a predicted distribution against an observation; smaller is better.
//!
//! Source: [`GneitingRaftery2007`](crate::bibliography::GneitingRaftery2007).

use crate::uncertainty::ForceCurve;

/// Continuous ranked probability score of draws of a scalar, in its unit; 0 without draws.
///
/// ```text
/// CRPS = mean |X − y| − ½ mean |X − X'|
/// ```
///
/// The means are over all draws and all pairs of draws, eq. (21) of the source.
pub fn sample_crps(draws: &[f64], observed: f64) -> f64 {
    let n = draws.len() as f64;
    if draws.is_empty() {
        return 0.0;
    }
    let mut sorted = draws.to_vec();
    sorted.sort_by(f64::total_cmp);
    let to_observed: f64 = sorted.iter().map(|x| (x - observed).abs()).sum::<f64>() / n;
    // For sorted values, Σ_j Σ_k |x_j − x_k| / 2 = Σ_i (2i + 1 − n) x_(i).
    let ranks = sorted.iter().enumerate().map(|(i, x)| (2.0 * i as f64 + 1.0 - n) * x);
    to_observed - ranks.sum::<f64>() / (n * n)
}

/// Energy score of draws of whole force curves, N; 0 without draws. The durations of the curves are
/// not compared.
///
/// ```text
/// ES = mean |Y − y| − ½ mean |Y − Y'|        |·|² = mean over instants and both axes of the square
/// ```
pub fn energy_score_n(draws: &[ForceCurve], observed: &ForceCurve) -> f64 {
    let n = draws.len() as f64;
    if draws.is_empty() {
        return 0.0;
    }
    let to_observed: f64 = draws.iter().map(|draw| distance_n(draw, observed)).sum();
    let mut among = 0.0;
    for (i, draw) in draws.iter().enumerate() {
        among += draws.iter().take(i).map(|other| distance_n(draw, other)).sum::<f64>();
    }
    to_observed / n - among / (n * n)
}

/// Root mean square of the difference of two curves over both axes and the instants that both
/// curves have, N.
pub fn distance_n(a: &ForceCurve, b: &ForceCurve) -> f64 {
    let n = a.n_instants().min(b.n_instants()).max(1) as f64;
    let square =
        |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum() };
    ((square(&a.fx_n, &b.fx_n) + square(&a.fy_n, &b.fy_n)) / (2.0 * n)).sqrt()
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use rand_distr::StandardNormal;

    use super::*;
    use crate::uncertainty::{NormalMixture, NormalPart};

    #[test]
    fn many_draws_score_like_their_distribution() {
        let mut rng = ChaCha8Rng::seed_from_u64(11);
        let draws: Vec<f64> = (0..20_000).map(|_| rng.sample(StandardNormal)).collect();
        let part = NormalPart { weight: 1.0, mean: 0.0, std: 1.0 };
        let exact = NormalMixture::new(vec![part]).unwrap();
        for observed in [-3.0, 0.0, 0.7, 5.0] {
            let (score, expected) = (sample_crps(&draws, observed), exact.crps(observed));
            // The standard error of a mean of 20 000 distances is 0.007.
            assert!((score - expected).abs() < 0.03, "{observed}: {score}, exact {expected}");
        }
        assert_eq!(sample_crps(&[2.0], 5.0), 3.0);
    }

    #[test]
    fn with_one_value_the_energy_score_is_the_ranked_one() {
        let draws = [3.0, -1.0, 4.0, 1.5];
        let curve = |f: f64| ForceCurve { fx_n: vec![f], fy_n: vec![f], duration_s: 0.0 };
        let curves: Vec<ForceCurve> = draws.iter().map(|f| curve(*f)).collect();
        let (energy, ranked) = (energy_score_n(&curves, &curve(2.0)), sample_crps(&draws, 2.0));
        assert!((energy - ranked).abs() < 1e-12, "{energy} {ranked}");
        assert_eq!(energy_score_n(&curves[..1], &curve(5.0)), 2.0);
    }
}
