//! Calibration of a trained network: three factors on its variances, with which its intervals
//! contain their nominal share of the observed values.

use rand_chacha::ChaCha8Rng;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::force::ForceCase;
use crate::nn::{Expected, NnError, check_number};
use impactlab_core::numerics::normal_cdf;
use impactlab_core::numerics::random_stream;
use impactlab_core::uncertainty::{
    CURVE_INTERVAL_S, CurveComponent, CurveMixture, CurveQuantities,
};

/// Nominal share of the central intervals that are calibrated.
const CALIBRATED_SHARE: f64 = 0.9;
/// Logarithms of the smallest and largest factor.
const MOST_EXTREME_LOG_FACTORS: [f64; 2] = [-6.0, 4.0];
/// Number of bisection steps for a factor.
const N_STEPS: usize = 20;
/// Number of steps of the search by impulses and peaks, and largest factor relative to the one that
/// is right for impulses alone.
const N_SHARED_STEPS: usize = 8;
const LARGEST_SHARED: f64 = 4.0;
/// Number of draws of a case for its peak.
const N_PEAK_DRAWS: usize = 200;
/// Smallest number of cases for a calibration.
const LEAST_CASES: usize = 8;

/// Factors on the variances of force curves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VarianceFactors {
    /// Factor on the variance of forces through the latent factors.
    pub shared: f64,
    /// Factor on the variance of forces that the latent factors do not explain.
    pub single: f64,
    /// Factor on the variance of the duration.
    pub duration: f64,
}

impl Default for VarianceFactors {
    /// Factors that leave the predicted variances unchanged.
    fn default() -> Self {
        Self { shared: 1.0, single: 1.0, duration: 1.0 }
    }
}

impl VarianceFactors {
    /// Checks factors from a file.
    ///
    /// - `name`: their place in the metadata.
    ///
    /// # Errors
    /// [`NnError::StoredNumber`].
    pub(crate) fn check(&self, name: &str) -> Result<(), NnError> {
        check_number(&format!("{name}.shared"), self.shared, Expected::Positive)?;
        check_number(&format!("{name}.single"), self.single, Expected::Positive)?;
        check_number(&format!("{name}.duration"), self.duration, Expected::Positive)
    }

    /// The factors with which the central 90 % intervals contain 90 % of
    ///
    /// - the forces during contact, F_x and F_y (`single`),
    /// - the impulses and, as nearly as both allow, the peaks (`shared`),
    /// - the durations (`duration`).
    ///
    /// With fewer than eight cases the variances stay unchanged.
    pub(crate) fn calibrated(cases: &[(&ForceCase, CurveMixture)], seed: u64) -> Self {
        if cases.len() < LEAST_CASES {
            return Self::default();
        }
        let single = |shared: f64| {
            smallest(N_STEPS, |single| held_forces(cases, Self { shared, single, duration: 1.0 }))
        };
        let of_impulse = smallest(N_STEPS, |factor| {
            held_impulses(cases, Self { shared: factor, single: factor, duration: 1.0 })
        });
        // Among this factor and larger ones, the search chooses the one with which the shares of
        // impulses and peaks are closest to the nominal share. A larger factor is not always better
        // for peaks: drawn curves that are too rough have peaks that are all too high.
        let shared = (0..=N_SHARED_STEPS)
            .map(|step| of_impulse * LARGEST_SHARED.powf(step as f64 / N_SHARED_STEPS as f64))
            .map(|shared| {
                let factors = Self { shared, single: single(shared), duration: 1.0 };
                let held = [held_impulses(cases, factors), held_peaks(cases, factors, seed)];
                let off = held.map(|held| (held - CALIBRATED_SHARE).powi(2));
                (off[0] + off[1], shared)
            })
            .min_by(|(a, _), (b, _)| a.total_cmp(b))
            .map_or(of_impulse, |(_, shared)| shared);
        let duration = smallest(N_STEPS, |duration| {
            held_durations(cases, Self { duration, ..Self::default() })
        });
        Self { shared, single: single(shared), duration }
    }

    /// Multiplies the variances of a mixture by the factors.
    pub fn apply(self, mixture: CurveMixture) -> CurveMixture {
        mixture.map_components(|component| self.widen(component))
    }

    fn widen(self, component: &mut CurveComponent) {
        let last = component.mean.len() - 1;
        for (idx, variance) in component.variance.iter_mut().enumerate() {
            *variance *= if idx == last { self.duration } else { self.single };
        }
        for (idx, mut row) in component.factors.row_iter_mut().enumerate() {
            row *= if idx == last { self.duration } else { self.shared }.sqrt();
        }
    }
}

/// The smallest factor with which intervals contain their nominal share, by bisection of its
/// logarithm.
///
/// - `held`: share of the observed values inside their intervals with a given factor.
fn smallest(n_steps: usize, held: impl Fn(f64) -> f64) -> f64 {
    let [mut low, mut high] = MOST_EXTREME_LOG_FACTORS;
    for _ in 0..n_steps {
        let middle = 0.5 * (low + high);
        if held(f64::exp(middle)) < CALIBRATED_SHARE {
            low = middle;
        } else {
            high = middle;
        }
    }
    high.exp()
}

/// Whether a value lies in the central interval of the nominal share, given the predicted
/// probability of a smaller value.
fn is_inside(probability_below: f64) -> bool {
    let tail = (1.0 - CALIBRATED_SHARE) / 2.0;
    (tail..=1.0 - tail).contains(&probability_below)
}

/// The share of `true` values; 0 if there are none.
fn share(inside: impl Iterator<Item = bool>) -> f64 {
    let (mut n_inside, mut n) = (0_usize, 0_usize);
    for is_inside in inside {
        n += 1;
        n_inside += usize::from(is_inside);
    }
    n_inside as f64 / n.max(1) as f64
}

/// Share of the forces F_x and F_y during contact that lie inside their intervals.
fn held_forces(cases: &[(&ForceCase, CurveMixture)], factors: VarianceFactors) -> f64 {
    share(cases.iter().flat_map(|(case, mixture)| {
        let observed = case.curve.to_values();
        let n_instants = observed.len() / 2;
        let last_s = case.onset_s + case.curve.duration_s;
        let n_contact = ((last_s / CURVE_INTERVAL_S).ceil() as usize).min(n_instants);
        // Every second instant is sufficient because neighbouring values are strongly correlated.
        let instants = (0..n_contact).step_by(2);
        let values: Vec<usize> = instants.flat_map(|t| [t, n_instants + t]).collect();
        let inside = move |idx: usize| {
            let below = mixture.components().iter().map(|component| {
                let row = component.factors.row(idx);
                let variance =
                    factors.shared * row.norm_squared() + factors.single * component.variance[idx];
                component.weight
                    * normal_cdf((observed[idx] - component.mean[idx]) / variance.sqrt())
            });
            is_inside(below.sum())
        };
        values.into_iter().map(inside).collect::<Vec<bool>>()
    }))
}

/// Share of the impulses P_x and P_y that lie inside their intervals.
fn held_impulses(cases: &[(&ForceCase, CurveMixture)], factors: VarianceFactors) -> f64 {
    share(cases.iter().flat_map(|(case, mixture)| {
        let mixture = factors.apply(mixture.clone());
        [0, 1].map(|axis| is_inside(mixture.impulse(axis).cdf(case.impulse_n_s[axis])))
    }))
}

/// Share of the durations that lie inside their intervals.
fn held_durations(cases: &[(&ForceCase, CurveMixture)], factors: VarianceFactors) -> f64 {
    share(cases.iter().map(|(case, mixture)| {
        let duration_s = factors.apply(mixture.clone()).duration_s();
        is_inside(duration_s.cdf(case.curve.duration_s))
    }))
}

/// Share of the peaks that lie inside their intervals. The curves are drawn with the same random
/// numbers for all factors.
fn held_peaks(cases: &[(&ForceCase, CurveMixture)], factors: VarianceFactors, seed: u64) -> f64 {
    share(cases.iter().enumerate().map(|(i, (case, mixture))| {
        let mut rng: ChaCha8Rng = random_stream(seed, "calibration of peaks", i as u64);
        let drawn = factors.apply(mixture.clone()).sample_quantities(N_PEAK_DRAWS, &mut rng);
        let interval = CurveQuantities::interval(&drawn.peak_n, CALIBRATED_SHARE);
        interval.is_some_and(|[low, high]| (low..=high).contains(&case.peak_n))
    }))
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;
    use rand::SeedableRng;

    use super::*;
    use crate::force::input::shipped;
    use impactlab_core::uncertainty::ForceCurve;

    /// A mixture of one component around a haversine, and cases that are drawn from it with its
    /// variances multiplied by the factors.
    fn cases(factors: VarianceFactors) -> Vec<(ForceCase, CurveMixture)> {
        let n = impactlab_core::uncertainty::CURVE_N_INSTANTS;
        let bump = |i: usize| (std::f64::consts::PI * (i as f64 + 0.5) / 100.0).sin().max(0.0);
        let is_on = |i: usize| f64::from(u8::from(i < 100));
        let row = |size: f64, floor: f64| -> Vec<f64> {
            let axis = |share: f64| (0..n).map(move |i| share * size * bump(i) * is_on(i) + floor);
            axis(0.3).chain(axis(1.0)).chain([0.1]).collect()
        };
        let mut factor = row(2e3, 0.0);
        factor[2 * n] = 0.0;
        let mut variance = row(9e6, 1e3);
        variance[2 * n] = 1e-4;
        let component = CurveComponent {
            weight: 1.0,
            mean: row(50e3, 0.0),
            factors: DMatrix::from_column_slice(2 * n + 1, 1, &factor),
            variance,
            lag_correlation: 0.6,
        };
        let mixture = CurveMixture::new(vec![component]).unwrap();
        let truth = factors.apply(mixture.clone());
        let template = shipped("fea").swap_remove(0);
        let draws = truth.sample(300, &mut ChaCha8Rng::seed_from_u64(5));
        let case = |curve: ForceCurve| {
            let case = ForceCase {
                impulse_n_s: curve.impulse_n_s(),
                peak_n: curve.peak().0,
                onset_s: 0.0,
                curve,
                ..template.clone()
            };
            (case, mixture.clone())
        };
        draws.into_iter().map(case).collect()
    }

    #[test]
    fn factors_that_were_left_out_are_found() {
        let truth = VarianceFactors { shared: 4.0, single: 2.0, duration: 0.25 };
        let cases = cases(truth);
        let cases: Vec<_> = cases.iter().map(|(case, mixture)| (case, mixture.clone())).collect();
        let found = VarianceFactors::calibrated(&cases, 1);
        for (name, got, expected) in [
            ("shared", found.shared, truth.shared),
            ("single", found.single, truth.single),
            ("duration", found.duration, truth.duration),
        ] {
            assert!((got / expected).ln().abs() < 0.4, "{name}: {got}, expected {expected}");
        }
        assert_eq!(VarianceFactors::calibrated(&cases[..3], 1), VarianceFactors::default());
    }
}
