//! Calibration of a trained network: factors on its variances, with which its intervals
//! contain their nominal share of the observed values, near the training cases and far from them.

use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
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
/// Number of factors on the variance of shapes that are tried, and the smallest and largest relative to
/// the one that is right for impulses; the same for single instants.
const N_SHARED: usize = 7;
const SHARED_PER_IMPULSE: [f64; 2] = [0.25, 8.0];
const N_SINGLE: usize = 7;
const TRIED_SINGLE: [f64; 2] = [0.125, 8.0];
/// Number of draws of a case for its peak.
const N_PEAK_DRAWS: usize = 100;
/// Largest number of cases by whose peaks factors are judged; of more, every second or third is taken.
const MOST_PEAK_CASES: usize = 48;
/// Smallest number of cases for a calibration.
const LEAST_CASES: usize = 8;
/// One case in so many is far from the others; smallest number of cases of which this share is
/// calibrated by itself.
const FAR_PART: usize = 4;
const LEAST_CASES_OF_TWO_PARTS: usize = FAR_PART * LEAST_CASES;

/// Factors on the variances of force curves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct VarianceFactors {
    /// Factor on the variance of forces through the latent factors, at a given impulse.
    pub shared: f64,
    /// Factor on the variance of the impulse through the latent factors, which change it in proportion
    /// to the mean force; `None` for that of `shared`, as models of before have it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub impulse: Option<f64>,
    /// Factor on the variance of forces that the latent factors do not explain.
    pub single: f64,
    /// Factor on the variance of the duration.
    pub duration: f64,
}

/// Factors on the variances of force curves by the distance of a scenario from the training cases.
///
/// A network that has learned from many cases of one kind and a few of another is right about itself
/// among the many only: between both distances the logarithms of the factors are interpolated.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct VarianceCalibration {
    /// Factors near the training cases.
    #[serde(flatten)]
    pub near: VarianceFactors,
    /// Factors far from them; `None` for a model whose factors are the same everywhere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub far: Option<FarFactors>,
}

/// Factors on the variances of force curves far from the training cases.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FarFactors {
    /// Distance up to which the factors are those of near scenarios, and from which on these are
    /// right: means to the three nearest training cases, each feature of the scenario in its standard
    /// deviations.
    pub distance: [f64; 2],
    /// The factors.
    pub factors: VarianceFactors,
}

/// A case that the network was not fitted to, with what is predicted for it.
pub(crate) struct CalibrationCase<'a> {
    pub(crate) case: &'a ForceCase,
    pub(crate) mixture: CurveMixture,
    /// Distance from the other training cases.
    pub(crate) distance: f64,
}

impl VarianceCalibration {
    /// Checks factors from a file.
    ///
    /// - `name`: their place in the metadata.
    ///
    /// # Errors
    /// [`NnError::StoredNumber`].
    pub(crate) fn check(&self, name: &str) -> Result<(), NnError> {
        self.near.check(name)?;
        let Some(FarFactors { distance: [near, far], factors }) = self.far else { return Ok(()) };
        factors.check(&format!("{name}.far.factors"))?;
        check_number(&format!("{name}.far.distance[0]"), near, Expected::NotNegative)?;
        let more = far - near;
        check_number(&format!("{name}.far.distance (difference)"), more, Expected::Positive)
    }

    /// Calibrates the quarter of the cases that is farthest from the training cases apart from the
    /// others, if there are enough. Those of impulse and duration are never smaller far away than near.
    ///
    /// - `cases`: in any order.
    pub(crate) fn of_cases(mut cases: Vec<CalibrationCase<'_>>, seed: u64) -> Self {
        let all = |cases: &[CalibrationCase<'_>]| VarianceFactors::calibrated(cases, seed);
        if cases.len() < LEAST_CASES_OF_TWO_PARTS {
            return Self { near: all(&cases), far: None };
        }
        cases.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        let (near, far) = cases.split_at(cases.len() - cases.len() / FAR_PART);
        let middle = |part: &[CalibrationCase<'_>]| part[part.len() / 2].distance;
        let distance = [middle(near), middle(far)];
        if distance[0] >= distance[1] {
            return Self { near: all(&cases), far: None };
        }
        let [near, far] = [near, far].map(all);
        // Factors of shapes and of single instants stand in for each other: those of far cases go together.
        let VarianceFactors { impulse, duration, .. } = near.zip(far, f64::max);
        let factors = VarianceFactors { impulse, duration, ..far };
        Self { near, far: Some(FarFactors { distance, factors }) }
    }

    /// The factors at a distance from the training cases.
    pub(crate) fn at(&self, distance: f64) -> VarianceFactors {
        let Some(far) = self.far else { return self.near };
        let [low, high] = far.distance;
        let share = ((distance - low) / (high - low)).clamp(0.0, 1.0);
        self.near.zip(far.factors, |near, far| near * (far / near).powf(share))
    }
}

impl Default for VarianceFactors {
    /// Factors that leave the predicted variances unchanged.
    fn default() -> Self {
        Self { shared: 1.0, impulse: None, single: 1.0, duration: 1.0 }
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
        let impulse = self.impulse.unwrap_or(self.shared);
        check_number(&format!("{name}.impulse"), impulse, Expected::Positive)?;
        check_number(&format!("{name}.single"), self.single, Expected::Positive)?;
        check_number(&format!("{name}.duration"), self.duration, Expected::Positive)
    }

    /// The factors with which the central 90 % intervals contain 90 % of
    ///
    /// - the impulses (`impulse`),
    /// - the durations (`duration`),
    /// - and, as nearly as both allow, of the peaks and of the forces during contact, F_x and F_y (`shared`
    ///   and `single`).
    ///
    /// With fewer than eight cases the variances stay unchanged.
    fn calibrated(cases: &[CalibrationCase<'_>], seed: u64) -> Self {
        if cases.len() < LEAST_CASES {
            return Self::default();
        }
        let duration = smallest(N_STEPS, |duration| {
            held_durations(cases, Self { duration, ..Self::default() })
        });
        let of_impulse =
            |of: &dyn Fn(f64) -> Self| smallest(N_STEPS, |factor| held_impulses(cases, of(factor)));
        let alike =
            |factor| Self { shared: factor, impulse: Some(factor), single: factor, duration };
        let first = of_impulse(&alike);
        // A larger factor is not always better for peaks: drawn curves that are too rough have peaks that
        // are all too high. So all are tried, and those that hold forces and peaks best are taken.
        let mut best = (f64::INFINITY, alike(first));
        for (shared, single) in tried_shapes(first) {
            let factors = Self { shared, impulse: Some(first), single, duration };
            let off_forces = (held_forces(cases, factors) - CALIBRATED_SHARE).powi(2);
            if off_forces < best.0 {
                let off =
                    off_forces + (held_peaks(cases, factors, seed) - CALIBRATED_SHARE).powi(2);
                if off < best.0 {
                    best = (off, factors);
                }
            }
        }
        let shape = best.1;
        // What varies from instant to instant has a part in the impulse, too.
        let impulse = of_impulse(&|factor| Self { impulse: Some(factor), ..shape });
        Self { impulse: Some(impulse), ..shape }
    }

    /// Each factor from both of two.
    fn zip(self, other: Self, of: impl Fn(f64, f64) -> f64) -> Self {
        Self {
            shared: of(self.shared, other.shared),
            impulse: self.impulse.zip(other.impulse).map(|(a, b)| of(a, b)),
            single: of(self.single, other.single),
            duration: of(self.duration, other.duration),
        }
    }

    fn apply(self, mixture: CurveMixture) -> CurveMixture {
        mixture.map_components(|component| self.widen(component))
    }

    /// Multiplies the variances of a component by the factors.
    pub(crate) fn widen(self, component: &mut CurveComponent) {
        let last = component.mean.len() - 1;
        for (idx, variance) in component.variance.iter_mut().enumerate() {
            *variance *= if idx == last { self.duration } else { self.single };
        }
        let n_instants = last / 2;
        let profile = magnitude_shares(&component.mean[..last]);
        let impulse = self.impulse.unwrap_or(self.shared);
        for mut column in component.factors.column_iter_mut() {
            for axis in 0..2 {
                let mut forces = column.rows_mut(axis * n_instants, n_instants);
                let total = forces.sum();
                for (force, share) in forces.iter_mut().zip(&profile) {
                    let of_impulse = total * share;
                    *force =
                        impulse.sqrt() * of_impulse + self.shared.sqrt() * (*force - of_impulse);
                }
            }
            column[last] *= self.duration.sqrt();
        }
    }
}

/// Factors on the variances of shapes and of single instants that are tried.
///
/// - `of_impulse`: the factor that is right for impulses.
fn tried_shapes(of_impulse: f64) -> impl Iterator<Item = (f64, f64)> {
    let step = |[low, high]: [f64; 2], i: usize, n: usize| {
        low * f64::powf(high / low, i as f64 / (n - 1) as f64)
    };
    let shared = (0..N_SHARED).map(move |i| of_impulse * step(SHARED_PER_IMPULSE, i, N_SHARED));
    shared.flat_map(move |shared| {
        (0..N_SINGLE).map(move |i| (shared, step(TRIED_SINGLE, i, N_SINGLE)))
    })
}

/// The share of each instant in the impulse of a mean curve, by the magnitude of its force.
///
/// - `forces`: F_x at all instants, then F_y.
fn magnitude_shares(forces: &[f64]) -> Vec<f64> {
    let (fx, fy) = forces.split_at(forces.len() / 2);
    let magnitude: Vec<f64> = fx.iter().zip(fy).map(|(fx, fy)| fx.hypot(*fy)).collect();
    let total = magnitude.iter().sum::<f64>().max(f64::MIN_POSITIVE);
    magnitude.into_iter().map(|force| force / total).collect()
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
fn held_forces(cases: &[CalibrationCase<'_>], factors: VarianceFactors) -> f64 {
    share(cases.iter().flat_map(|CalibrationCase { case, mixture, .. }| {
        let mixture = factors.apply(mixture.clone());
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
                let variance = row.norm_squared() + component.variance[idx];
                component.weight
                    * normal_cdf((observed[idx] - component.mean[idx]) / variance.sqrt())
            });
            is_inside(below.sum())
        };
        values.into_iter().map(inside).collect::<Vec<bool>>()
    }))
}

/// Share of the impulses P_x and P_y that lie inside their intervals.
fn held_impulses(cases: &[CalibrationCase<'_>], factors: VarianceFactors) -> f64 {
    share(cases.iter().flat_map(|CalibrationCase { case, mixture, .. }| {
        let mixture = factors.apply(mixture.clone());
        [0, 1].map(|axis| is_inside(mixture.impulse(axis).cdf(case.impulse_n_s[axis])))
    }))
}

/// Share of the durations that lie inside their intervals.
fn held_durations(cases: &[CalibrationCase<'_>], factors: VarianceFactors) -> f64 {
    share(cases.iter().map(|CalibrationCase { case, mixture, .. }| {
        let duration_s = factors.apply(mixture.clone()).duration_s();
        is_inside(duration_s.cdf(case.curve.duration_s))
    }))
}

/// Share of the peaks that lie inside their intervals. The curves are drawn with the same random
/// numbers for all factors.
fn held_peaks(cases: &[CalibrationCase<'_>], factors: VarianceFactors, seed: u64) -> f64 {
    let every = cases.len().div_ceil(MOST_PEAK_CASES).max(1);
    let cases = cases.par_iter().enumerate().step_by(every);
    let inside = cases.map(|(i, CalibrationCase { case, mixture, .. })| {
        let mut rng: ChaCha8Rng = random_stream(seed, "calibration of peaks", i as u64);
        let drawn = factors.apply(mixture.clone()).sample_quantities(N_PEAK_DRAWS, &mut rng);
        let interval = CurveQuantities::interval(&drawn.peak_n, CALIBRATED_SHARE);
        interval.is_some_and(|[low, high]| (low..=high).contains(&case.peak_n))
    });
    share(inside.collect::<Vec<bool>>().into_iter())
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
        let mut of_size = row(4e3, 0.0);
        of_size[2 * n] = 0.0;
        let early = |i: usize| (std::f64::consts::TAU * (i % n) as f64 / 100.0).cos();
        let of_shape = of_size.iter().enumerate().map(|(i, size)| 2.0 * size * early(i));
        let factors_n: Vec<f64> = of_size.iter().copied().chain(of_shape).collect();
        let mut variance = row(9e6, 1e3);
        variance[2 * n] = 1e-4;
        let component = CurveComponent {
            weight: 1.0,
            mean: row(50e3, 0.0),
            factors: DMatrix::from_column_slice(2 * n + 1, 2, &factors_n),
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

    fn at(
        distance: f64,
        cases: &[(ForceCase, CurveMixture)],
    ) -> impl Iterator<Item = CalibrationCase<'_>> {
        cases.iter().map(move |(case, mixture)| CalibrationCase {
            case,
            mixture: mixture.clone(),
            distance,
        })
    }

    /// Factors of shapes and of single instants stand in for each other, so that what they hold is asked.
    fn assert_hold(
        found: VarianceFactors,
        truth: VarianceFactors,
        cases: &[(ForceCase, CurveMixture)],
    ) {
        for (name, got, expected) in [
            ("impulse", found.impulse.unwrap(), truth.impulse.unwrap()),
            ("duration", found.duration, truth.duration),
        ] {
            assert!((got / expected).ln().abs() < 0.4, "{name}: {got}, expected {expected}");
        }
        let cases: Vec<CalibrationCase<'_>> = at(0.0, cases).collect();
        for (name, held, tolerance) in [
            ("forces", held_forces(&cases, found), 0.03),
            ("impulses", held_impulses(&cases, found), 0.03),
            ("peaks", held_peaks(&cases, found, 2), 0.08),
        ] {
            assert!((held - CALIBRATED_SHARE).abs() < tolerance, "{name}: {held} by {found:?}");
        }
    }

    #[test]
    fn factors_that_were_left_out_are_found() {
        let truth =
            VarianceFactors { shared: 4.0, impulse: Some(1.0), single: 2.0, duration: 0.25 };
        let cases = cases(truth);
        let found = VarianceCalibration::of_cases(at(1.0, &cases).collect(), 1);
        assert_hold(found.near, truth, &cases);
        assert_eq!(found.far, None, "all are as far as each other");
        let few = VarianceCalibration::of_cases(at(1.0, &cases[..3]).collect(), 1);
        assert_eq!(few, VarianceCalibration::default());
    }

    #[test]
    fn far_from_the_training_cases_the_factors_are_those_of_far_ones() {
        let near = VarianceFactors { shared: 1.0, impulse: Some(1.0), single: 0.5, duration: 1.0 };
        let far = VarianceFactors { shared: 9.0, impulse: Some(9.0), single: 4.0, duration: 4.0 };
        let (many, few) = (cases(near), cases(far));
        let both = at(3.0, &few[..100]).chain(at(0.5, &many)).collect();
        let found = VarianceCalibration::of_cases(both, 1);
        assert_hold(found.at(0.2), near, &many);
        assert_hold(found.at(7.0), far, &few[..100]);
        let middle = found.at(1.75);
        assert!((middle.impulse.unwrap() / 3.0).ln().abs() < 0.4, "{middle:?}");
        assert_eq!(found.far.map(|far| far.distance), Some([0.5, 3.0]));
        found.check("record").unwrap();
    }
}
