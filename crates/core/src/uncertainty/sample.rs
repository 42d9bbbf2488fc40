//! Random draws of whole force curves from a mixture, and the impulse, peak and duration of the
//! drawn curves.
//!
//! The generator is the one of [`random_stream`](crate::numerics::random_stream) and no type parameter: a
//! generic function is compiled in the crates that call it, some of which are compiled for size.

use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

use crate::numerics::{index_of_share, latin_normals, latin_uniforms, quantile_of_sorted};
use crate::uncertainty::{CurveComponent, CurveMixture, ForceCurve};

/// Impulse, peak and duration of drawn curves, one entry for each draw.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct CurveQuantities {
    /// Impulse `[P_x, P_y]` on the struck vehicle, N s.
    pub impulse_n_s: Vec<[f64; 2]>,
    /// Largest `|F|`, N.
    pub peak_n: Vec<f64>,
    /// Time at which the largest `|F|` occurs, s.
    pub peak_time_s: Vec<f64>,
    /// Contact duration, s.
    pub duration_s: Vec<f64>,
}

impl CurveMixture {
    /// Draws whole curves: for each curve a component, its latent factors, and the correlated
    /// residual.
    ///
    /// ```text
    /// k ~ π     y = m_k + U_k z + √d_k ⊙ ε     z ~ N(0, 1)     ε_i = φ ε_(i−1) + √(1 − φ²) N(0, 1)
    /// ```
    ///
    /// k and z fill their space evenly over the draws (Latin hypercube,
    /// [`McKay1979`](crate::bibliography::McKay1979)), so that a few curves stand for the distribution
    /// better than independent ones would. A negative duration is replaced by zero.
    pub fn sample(&self, n_samples: usize, rng: &mut ChaCha8Rng) -> Vec<ForceCurve> {
        self.draw(n_samples, rng).into_iter().map(|(_, curve)| curve).collect()
    }

    /// Draws as [`Self::sample`], each with the index of its component.
    fn draw(&self, n_samples: usize, rng: &mut ChaCha8Rng) -> Vec<(usize, ForceCurve)> {
        let mut drawn = Vec::with_capacity(n_samples);
        let components = latin_uniforms(n_samples, rng);
        let n_factors = self.components().iter().map(|component| component.factors.ncols()).max();
        let factors: Vec<Vec<f64>> =
            (0..n_factors.unwrap_or(0)).map(|_| latin_normals(n_samples, rng)).collect();
        let deviations: Vec<Vec<f64>> = self
            .components()
            .iter()
            .map(|component| component.variance.iter().map(|d| d.sqrt()).collect())
            .collect();
        for (draw, share) in components.into_iter().enumerate() {
            let weights = self.components().iter().map(|component| component.weight);
            let k = index_of_share(weights, share);
            let (component, own) = (&self.components()[k], &deviations[k]);
            let mut values = component.mean.clone();
            for (column, z) in component.factors.column_iter().zip(&factors) {
                let z = z[draw];
                for (value, factor) in values.iter_mut().zip(column.iter()) {
                    *value += z * factor;
                }
            }
            let (n_instants, phi) = ((own.len() / 2).max(1), component.lag_correlation);
            let fresh = (1.0 - phi * phi).sqrt();
            for (values, own) in values.chunks_mut(n_instants).zip(own.chunks(n_instants)) {
                let mut noise = 0.0;
                for (i, (value, deviation)) in values.iter_mut().zip(own).enumerate() {
                    let new: f64 = rng.sample(StandardNormal);
                    noise = if i == 0 { new } else { phi * noise + fresh * new };
                    *value += deviation * noise;
                }
            }
            let mut curve = ForceCurve::from_values(&values);
            curve.duration_s = curve.duration_s.max(0.0);
            drawn.push((k, curve));
        }
        drawn
    }

    /// Draws as [`Self::sample`], with impulse, peak, time of the peak and duration of each curve. The
    /// peak is that of the drawn curve with the factors of its component.
    pub fn sample_quantities(
        &self,
        n_samples: usize,
        rng: &mut ChaCha8Rng,
    ) -> (Vec<ForceCurve>, CurveQuantities) {
        let drawn = self.draw(n_samples, rng);
        let peak_of_mean =
            |component: &CurveComponent| ForceCurve::from_values(&component.mean).peak().0;
        let means_n: Vec<f64> = self.components().iter().map(peak_of_mean).collect();
        let mut quantities = CurveQuantities::default();
        for (k, curve) in &drawn {
            let (peak_n, peak_time_s) = curve.peak();
            let factors = self.components()[*k].peak;
            quantities.impulse_n_s.push(curve.impulse_n_s());
            quantities.peak_n.push(factors.apply(peak_n, means_n[*k]));
            quantities.peak_time_s.push(peak_time_s);
            quantities.duration_s.push(curve.duration_s);
        }
        (drawn.into_iter().map(|(_, curve)| curve).collect(), quantities)
    }
}

impl CurveQuantities {
    /// Magnitude of the impulse of each draw, N s.
    pub fn impulse_magnitude_n_s(&self) -> Vec<f64> {
        self.impulse_n_s.iter().map(|[x, y]| x.hypot(*y)).collect()
    }

    /// Central interval `[low, high]` of the draws of one quantity; `None` without draws.
    ///
    /// - `level`: share of the draws that the interval holds, 0 to 1.
    pub fn interval(values: &[f64], level: f64) -> Option<[f64; 2]> {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let at = |probability| quantile_of_sorted(&sorted, probability);
        Some([at((1.0 - level) / 2.0)?, at((1.0 + level) / 2.0)?])
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;
    use rand::SeedableRng;

    use super::*;
    use crate::uncertainty::PeakFactors;
    use crate::uncertainty::mixture::tests::example;

    #[test]
    fn what_the_factors_leave_has_its_memory() {
        let n = 200;
        let component = CurveComponent {
            weight: 1.0,
            mean: vec![0.0; 2 * n + 1],
            factors: DMatrix::zeros(2 * n + 1, 0),
            variance: vec![4.0; 2 * n + 1],
            lag_correlation: 0.7,
            peak: PeakFactors::default(),
        };
        let mixture = CurveMixture::new(vec![component]).unwrap();
        let drawn = mixture.sample(500, &mut ChaCha8Rng::seed_from_u64(1));
        let mean = |value: &dyn Fn(&ForceCurve, usize) -> f64| {
            let pairs = drawn.iter().flat_map(|curve| (1..n).map(move |i| value(curve, i)));
            pairs.sum::<f64>() / (500 * (n - 1)) as f64
        };
        let variance = mean(&|curve, i| curve.fy_n[i].powi(2));
        let lagged = mean(&|curve, i| curve.fy_n[i] * curve.fy_n[i - 1]);
        assert!((variance - 4.0).abs() < 0.1, "{variance}");
        assert!((lagged / variance - 0.7).abs() < 0.01, "{lagged}");
    }

    #[test]
    fn draws_have_the_moments_of_the_mixture() {
        let mixture = example(3, 20);
        let n = 20_000;
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let (_, quantities) = mixture.sample_quantities(n, &mut rng);
        // The bounds are four standard errors of a mean; the spread of the impulse may be off by 3
        // %, some six of its standard errors.
        for axis in [0, 1] {
            let exact = mixture.impulse(axis);
            let impulses = quantities.impulse_n_s.iter().map(|p| p[axis]);
            let mean = impulses.clone().sum::<f64>() / n as f64;
            let variance = impulses.map(|p| (p - mean).powi(2)).sum::<f64>() / n as f64;
            let error = (mean - exact.mean()) / (exact.std() / (n as f64).sqrt());
            assert!(error.abs() < 4.0, "axis {axis}: {error} standard errors");
            let ratio = variance.sqrt() / exact.std();
            assert!((ratio - 1.0).abs() < 0.03, "axis {axis}: spread {ratio} of the exact one");
        }
        let durations = mixture.duration_s();
        let [low, high] = CurveQuantities::interval(&quantities.duration_s, 0.8).unwrap();
        for (got, probability) in [(low, 0.1), (high, 0.9)] {
            // The bound is four standard errors of a share.
            let error = (durations.cdf(got) - probability).abs();
            assert!(error < 4.0 * (0.09 / n as f64).sqrt(), "{probability}: {error}");
        }
    }

    #[test]
    fn the_same_seed_draws_the_same() {
        let mixture = example(2, 10);
        let draw = |seed| mixture.sample_quantities(5, &mut ChaCha8Rng::seed_from_u64(seed));
        assert_eq!(draw(3), draw(3));
        assert_ne!(draw(3), draw(4));
        assert_eq!(draw(3).0, mixture.sample(5, &mut ChaCha8Rng::seed_from_u64(3)));
    }

    #[test]
    fn peaks_have_the_factors_of_their_component() {
        let peaks = |peak| {
            let mixture = example(1, 20).map_components(|component| component.peak = peak);
            let (curves, drawn) = mixture.sample_quantities(50, &mut ChaCha8Rng::seed_from_u64(3));
            (curves, drawn.peak_n, mixture.mean().peak().0)
        };
        let (curves, plain, mean_n) = peaks(PeakFactors::default());
        let of_curves: Vec<f64> = curves.iter().map(|curve| curve.peak().0).collect();
        for (told, drawn) in plain.iter().zip(&of_curves) {
            assert!((told / drawn - 1.0).abs() < 1e-12, "{told} {drawn}");
        }
        let (same, told, _) = peaks(PeakFactors { scale: 1.2, spread: 2.0 });
        assert_eq!(same, curves, "the curves stay");
        for (told, drawn) in told.iter().zip(&of_curves) {
            let expected = 1.2 * drawn * drawn / mean_n;
            assert!((told / expected - 1.0).abs() < 1e-12, "{told} {expected}");
        }
    }

    #[test]
    fn intervals_of_a_row() {
        let row: Vec<f64> = (0..=100).rev().map(f64::from).collect();
        let [low, high] = CurveQuantities::interval(&row, 0.9).unwrap();
        assert!((low - 5.0).abs() < 1e-9 && (high - 95.0).abs() < 1e-9, "{low} {high}");
        assert_eq!(CurveQuantities::interval(&[], 0.9), None);
    }
}
