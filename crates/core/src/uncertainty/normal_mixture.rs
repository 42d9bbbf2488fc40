//! Mixture of normal distributions of a scalar: moments, density, quantiles and continuous ranked
//! probability score (CRPS).
//!
//! Source of the score: [`Grimit2006`](crate::bibliography::Grimit2006). Checked against the
//! numerical integral that defines the score.

use crate::numerics::{normal_cdf, normal_density, normal_quantile};
use crate::uncertainty::MixtureError;
use crate::units::Estimate;

/// Largest number of steps of the search for a quantile. Bisection alone would need 60 for the last
/// bit.
const MAX_STEPS: usize = 100;

/// One normal distribution of a mixture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalPart {
    /// Weight in the mixture, 0 to 1.
    pub weight: f64,
    /// Mean, in the unit of the quantity.
    pub mean: f64,
    /// Standard deviation, positive, in the unit of the quantity.
    pub std: f64,
}

/// The distribution `Σ_k w_k N(m_k, s_k²)`, whose weights sum to one and whose standard deviations
/// are positive.
#[derive(Debug, Clone, PartialEq)]
pub struct NormalMixture {
    parts: Vec<NormalPart>,
}

impl NormalMixture {
    /// Makes a mixture of normal distributions and scales their weights to sum to one.
    ///
    /// # Errors
    /// [`MixtureError::Empty`], [`MixtureError::Weight`] or [`MixtureError::NoWeight`] for the
    /// weights, [`MixtureError::NotFinite`] for a mean that is not finite, and
    /// [`MixtureError::Variance`] for a standard deviation that is not a positive finite number.
    pub fn new(mut parts: Vec<NormalPart>) -> Result<Self, MixtureError> {
        let weights: Vec<f64> = parts.iter().map(|part| part.weight).collect();
        let sum = MixtureError::check_weights(&weights)?;
        for (component, part) in parts.iter_mut().enumerate() {
            part.weight /= sum;
            if !part.mean.is_finite() {
                return Err(MixtureError::NotFinite { component, what: "mean" });
            }
            if !(part.std > 0.0 && part.std.is_finite()) {
                let (value_idx, variance) = (0, part.std * part.std);
                return Err(MixtureError::Variance { component, value_idx, variance });
            }
        }
        Ok(Self { parts })
    }

    /// Makes a mixture of parts that come from a mixture that was checked already.
    pub(crate) fn from_checked(parts: Vec<NormalPart>) -> Self {
        Self { parts }
    }

    /// The normal distributions of the mixture.
    pub fn parts(&self) -> &[NormalPart] {
        &self.parts
    }

    /// Mean of the mixture.
    pub fn mean(&self) -> f64 {
        self.sum(|part| part.mean)
    }

    /// Standard deviation of the mixture, from the spread within the parts and between them.
    pub fn std(&self) -> f64 {
        let mean = self.mean();
        self.sum(|part| part.std.powi(2) + (part.mean - mean).powi(2)).sqrt()
    }

    /// Probability density at a value, in the inverse of the quantity's unit.
    pub fn density(&self, value: f64) -> f64 {
        self.sum(|part| normal_density((value - part.mean) / part.std) / part.std)
    }

    /// Cumulative distribution function: the probability of a value up to this one, 0 to 1. The sum
    /// over the parts, whose weights sum to one but for rounding errors, is limited to that.
    pub fn cdf(&self, value: f64) -> f64 {
        self.sum(|part| normal_cdf((value - part.mean) / part.std)).clamp(0.0, 1.0)
    }

    /// The value below which the quantity lies with a given probability, to 1e-12 of the
    /// probability. The value lies between the smallest and the largest quantile of the parts, and
    /// is found by Newton's method, which bisection keeps between these bounds.
    ///
    /// - `probability`: 0 to 1, at which the quantile is infinite; beyond, and for NaN, it is NaN.
    pub fn quantile(&self, probability: f64) -> f64 {
        let z = normal_quantile(probability);
        if !z.is_finite() {
            return z;
        }
        let ends = self.parts.iter().map(|part| part.mean + z * part.std);
        let (mut low, mut high) = ends
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), end| {
                (low.min(end), high.max(end))
            });
        let mut value = (self.mean() + z * self.std()).clamp(low, high);
        for _ in 0..MAX_STEPS {
            let excess = self.cdf(value) - probability;
            if excess.abs() < 1e-12 || high - low <= 1e-14 * (low.abs() + high.abs()) {
                break;
            }
            if excess > 0.0 {
                high = value;
            } else {
                low = value;
            }
            let newton = value - excess / self.density(value);
            value = if newton > low && newton < high { newton } else { (low + high) / 2.0 };
        }
        value
    }

    /// Central interval `[low, high]` that holds the quantity with probability `level`, 0 to below
    /// 1.
    pub fn interval(&self, level: f64) -> [f64; 2] {
        [self.quantile((1.0 - level) / 2.0), self.quantile((1.0 + level) / 2.0)]
    }

    /// Median, 50 % and 90 %, in the unit of the quantity.
    pub fn estimate(&self) -> Estimate {
        let [half, ninety] = [0.5, 0.9].map(|level| self.interval(level));
        Estimate::new(self.quantile(0.5), half, ninety)
    }

    /// Continuous ranked probability score for an observed value, in the unit of the quantity;
    /// smaller is better.
    ///
    /// ```text
    /// CRPS = Σ_k w_k A(y − m_k, s_k²) − ½ Σ_j Σ_k w_j w_k A(m_j − m_k, s_j² + s_k²)
    /// A(m, s²) = 2 s φ(m/s) + m (2 Φ(m/s) − 1)
    /// ```
    ///
    /// Source: [`Grimit2006`](crate::bibliography::Grimit2006).
    pub fn crps(&self, observed: f64) -> f64 {
        let to_observed = self.sum(|part| mean_distance(observed - part.mean, part.std));
        let among = self.sum(|a| self.sum(|b| mean_distance(a.mean - b.mean, a.std.hypot(b.std))));
        to_observed - among / 2.0
    }

    /// Weighted sum of a quantity over the parts.
    fn sum(&self, term: impl Fn(&NormalPart) -> f64) -> f64 {
        self.parts.iter().map(|part| part.weight * term(part)).sum()
    }
}

/// Expected value of `|X|` for a normally distributed X, A(m, s²) in [`NormalMixture::crps`].
fn mean_distance(mean: f64, std: f64) -> f64 {
    let z = mean / std;
    2.0 * std * normal_density(z) + mean * (2.0 * normal_cdf(z) - 1.0)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn mixture(parts: &[[f64; 3]]) -> NormalMixture {
        let part = |&[weight, mean, std]: &[f64; 3]| NormalPart { weight, mean, std };
        NormalMixture::new(parts.iter().map(part).collect()).unwrap()
    }

    #[test]
    fn a_single_part_is_the_normal_distribution() {
        let normal = mixture(&[[3.0, 10.0, 2.0]]);
        assert_eq!((normal.mean(), normal.std()), (10.0, 2.0));
        let [low, high] = normal.interval(0.95);
        assert!((low - (10.0 - 2.0 * 1.959_963_985)).abs() < 1e-8, "{low}");
        assert!((high - (10.0 + 2.0 * 1.959_963_985)).abs() < 1e-8, "{high}");
        // CRPS of a standard normal at its mean: 2φ(0) − 1/√π.
        let expected = 2.0 * (2.0 * 0.398_942_280_4 - 0.564_189_583_5);
        assert!((normal.crps(10.0) - expected).abs() < 1e-8);
    }

    #[test]
    fn quantiles_invert_the_probability_also_between_far_parts() {
        let far = mixture(&[[0.5, -50.0, 0.1], [0.3, 0.0, 1.0], [0.2, 1e4, 30.0]]);
        for probability in [0.001, 0.025, 0.4999, 0.5, 0.5001, 0.79, 0.9, 0.999] {
            let value = far.quantile(probability);
            assert!((far.cdf(value) - probability).abs() < 1e-9, "{probability}: {value}");
        }
    }

    #[test]
    fn the_score_is_the_integral_of_its_definition() {
        let two = mixture(&[[0.7, 0.0, 1.0], [0.3, 4.0, 0.5]]);
        for observed in [-2.0, 0.3, 4.0, 9.0] {
            let step = 1e-3;
            let integral: f64 = (-20_000..20_000)
                .map(|i| {
                    let x = (f64::from(i) + 0.5) * step;
                    let above = if x >= observed { 1.0 } else { 0.0 };
                    (two.cdf(x) - above).powi(2) * step
                })
                .sum();
            let score = two.crps(observed);
            assert!((score - integral).abs() < 1e-5, "{observed}: {score}, integral {integral}");
        }
    }

    #[test]
    fn the_probability_of_what_is_certain_is_not_above_one() {
        // The weights sum to slightly more than one.
        let weights = (1..60).map(|i| f64::from(i) / 1770.0);
        for n_parts in 2..60 {
            let parts = weights.clone().take(n_parts);
            let parts = parts.map(|weight| NormalPart { weight, mean: 0.1, std: 1e-3 }).collect();
            let heading = NormalMixture::new(parts).unwrap();
            let p = heading.cdf(1.5);
            assert!((1.0 - 1e-12..=1.0).contains(&p), "{n_parts} parts: {p}");
        }
    }

    #[test]
    fn what_is_not_finite_is_called_by_its_name() {
        let part = |mean, std| NormalMixture::new(vec![NormalPart { weight: 1.0, mean, std }]);
        for mean in [f64::NAN, f64::INFINITY] {
            let error = part(mean, 1.0).unwrap_err();
            assert_eq!(error, MixtureError::NotFinite { component: 0, what: "mean" });
        }
        for std in [f64::NAN, f64::INFINITY, 0.0, -1.0] {
            assert!(matches!(part(0.0, std), Err(MixtureError::Variance { .. })), "{std}");
        }
    }

    proptest! {
        #[test]
        fn probabilities_are_probabilities_and_quantiles_are_numbers(
            parts in prop::collection::vec((1e-12..1.0_f64, -1e3..1e3_f64, -9.0..9.0_f64), 1..40),
            values in prop::array::uniform4(-2e3..2e3_f64),
        ) {
            let part = |&(weight, mean, log_std): &(f64, f64, f64)| {
                NormalPart { weight, mean, std: log_std.exp() }
            };
            let mixture = NormalMixture::new(parts.iter().map(part).collect()).unwrap();
            let is_probability = |p: f64| (0.0..=1.0).contains(&p) && p.is_sign_positive();
            for value in values.into_iter().chain([f64::NEG_INFINITY, f64::INFINITY]) {
                prop_assert!(is_probability(mixture.cdf(value)), "{value}");
            }
            prop_assert!(mixture.std() > 0.0, "{}", mixture.std());
            let mut before = f64::NEG_INFINITY;
            for probability in [0.0, 1e-9, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0 - 1e-9, 1.0] {
                let value = mixture.quantile(probability);
                prop_assert!(!value.is_nan() && value >= before, "{probability}: {value} {before}");
                before = value;
            }
        }
    }

    #[test]
    fn bad_parts_are_refused() {
        for parts in [&[][..], &[[1.0, 0.0, 0.0]], &[[-1.0, 0.0, 1.0]], &[[0.0, 0.0, 1.0]]] {
            let part = |&[weight, mean, std]: &[f64; 3]| NormalPart { weight, mean, std };
            assert!(NormalMixture::new(parts.iter().map(part).collect()).is_err(), "{parts:?}");
        }
    }
}
