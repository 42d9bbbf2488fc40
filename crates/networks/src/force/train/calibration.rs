//! Calibration of a trained network: factors on its variances, with which its intervals
//! contain their nominal share of the observed values, near the training cases and far from them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::force::ForceCase;
use crate::force::train::held_shares::{
    CALIBRATED_SHARE, Held, held_durations, held_forces, held_impulses,
};
use crate::force::train::peaks::peak_factors;
use crate::nn::{Expected, NnError, check_number};
use impactlab_core::uncertainty::{CurveComponent, CurveMixture, PeakFactors};

/// Logarithms of the smallest and largest factor.
const MOST_EXTREME_LOG_FACTORS: [f64; 2] = [-6.0, 4.0];
/// Number of bisection steps for a factor.
const N_STEPS: usize = 20;
/// Factors on the variance of shapes that are tried, relative to the one that is right for impulses, and
/// on that of single instants. Both widen the force at an instant; what single instants have more makes
/// drawn curves rough, so that it stays small.
const SHARED_PER_IMPULSE: Tried = Tried { n: 15, range: [0.25, 32.0] };
const SINGLE: Tried = Tried { n: 4, range: [0.25, 2.0] };
/// Largest spread of peaks, and logarithm of their scale, of a file that is read.
const MOST_PEAK_FACTOR: f64 = 10.0;
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
    /// Factors on peaks; those of models of before leave them as drawn.
    #[serde(default)]
    pub peak: PeakFactors,
}

/// Factors that are tried, at equal steps of their logarithm.
pub(super) struct Tried {
    pub(super) n: usize,
    pub(super) range: [f64; 2],
}

impl Tried {
    pub(super) fn factors(self) -> impl Iterator<Item = f64> {
        let [low, high] = self.range;
        (0..self.n).map(move |i| low * f64::powf(high / low, i as f64 / (self.n - 1) as f64))
    }
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
        let peak = PeakFactors::default();
        Self { shared: 1.0, impulse: None, single: 1.0, duration: 1.0, peak }
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
        check_number(&format!("{name}.duration"), self.duration, Expected::Positive)?;
        check_number(&format!("{name}.peak.scale"), self.peak.scale, Expected::Positive)?;
        check_number(&format!("{name}.peak.spread"), self.peak.spread, Expected::Positive)?;
        let [scale, spread] = [self.peak.scale.ln(), self.peak.spread];
        let most = Expected::Magnitude(MOST_PEAK_FACTOR);
        check_number(&format!("{name}.peak.scale (logarithm)"), scale, most)?;
        check_number(&format!("{name}.peak.spread"), spread, Expected::Magnitude(MOST_PEAK_FACTOR))
    }

    /// The factors with which the central 90 % intervals contain 90 % of
    ///
    /// - the impulses (`impulse`),
    /// - the durations (`duration`),
    ///
    /// and with which those of 50 and of 90 % contain as nearly as possible what they should of
    ///
    /// - the forces during contact, F_x and F_y (`shared` and `single`),
    /// - the peaks, half of which are above their median (`peak`).
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
        let unchanged = Self { duration, ..Self::default() };
        let alike =
            |factor| Self { shared: factor, impulse: Some(factor), single: factor, ..unchanged };
        let first = of_impulse(&alike);
        let tried = SHARED_PER_IMPULSE.factors().flat_map(|shared| {
            let shared = first * shared;
            let factors = move |single| Self { shared, single, ..alike(first) };
            SINGLE.factors().map(factors)
        });
        let off = |factors: &Self| held_forces(cases, *factors).off();
        let tried: Vec<(f64, Self)> = tried.map(|factors| (off(&factors), factors)).collect();
        let best = tried.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
        let shape = best.map_or(alike(first), |(_, factors)| factors);
        // What varies from instant to instant has a part in the impulse, too.
        let impulse = Some(of_impulse(&|factor| Self { impulse: Some(factor), ..shape }));
        let curves = Self { impulse, ..shape };
        Self { peak: peak_factors(cases, curves, seed), ..curves }
    }

    /// Each factor from both of two.
    fn zip(self, other: Self, of: impl Fn(f64, f64) -> f64) -> Self {
        Self {
            shared: of(self.shared, other.shared),
            impulse: self.impulse.zip(other.impulse).map(|(a, b)| of(a, b)),
            single: of(self.single, other.single),
            duration: of(self.duration, other.duration),
            peak: PeakFactors {
                scale: of(self.peak.scale, other.peak.scale),
                spread: of(self.peak.spread, other.peak.spread),
            },
        }
    }

    pub(super) fn apply(self, mixture: CurveMixture) -> CurveMixture {
        mixture.map_components(|component| self.widen(component))
    }

    /// Multiplies the variances of a component by the factors, and gives it those of its peaks.
    pub(crate) fn widen(self, component: &mut CurveComponent) {
        component.peak = self.peak;
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
fn smallest(n_steps: usize, held: impl Fn(f64) -> Held) -> f64 {
    let [mut low, mut high] = MOST_EXTREME_LOG_FACTORS;
    for _ in 0..n_steps {
        let middle = 0.5 * (low + high);
        if held(f64::exp(middle)).calibrated() < CALIBRATED_SHARE {
            low = middle;
        } else {
            high = middle;
        }
    }
    high.exp()
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

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
            peak: PeakFactors::default(),
        };
        let mixture = CurveMixture::new(vec![component]).unwrap();
        let truth = factors.apply(mixture.clone());
        let template = shipped("fea").swap_remove(0);
        let (curves, drawn) = truth.sample_quantities(300, &mut ChaCha8Rng::seed_from_u64(5));
        let case = |(curve, peak_n): (ForceCurve, f64)| {
            let case = ForceCase {
                impulse_n_s: curve.impulse_n_s(),
                peak_n,
                onset_s: 0.0,
                curve,
                ..template.clone()
            };
            (case, mixture.clone())
        };
        curves.into_iter().zip(drawn.peak_n).map(case).collect()
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
        let peaks = cases.iter().map(|CalibrationCase { case, mixture, .. }| {
            let mut rng = ChaCha8Rng::seed_from_u64(6);
            let (_, drawn) = found.apply(mixture.clone()).sample_quantities(200, &mut rng);
            drawn.peak_n.iter().filter(|peak_n| **peak_n < case.peak_n).count() as f64 / 200.0
        });
        for (name, held, tolerance) in [
            ("forces", held_forces(&cases, found), 0.04),
            ("impulses", held_impulses(&cases, found), 0.04),
            ("peaks", Held::of(&peaks.collect::<Vec<_>>()), 0.04),
        ] {
            let off = (held.calibrated() - CALIBRATED_SHARE).abs();
            assert!(off < tolerance, "{name}: {held:?} by {found:?}");
        }
    }

    #[test]
    fn factors_that_were_left_out_are_found() {
        let truth = VarianceFactors {
            shared: 4.0,
            impulse: Some(1.0),
            single: 2.0,
            duration: 0.25,
            peak: PeakFactors { scale: 0.8, spread: 2.0 },
        };
        let cases = cases(truth);
        let found = VarianceCalibration::of_cases(at(1.0, &cases).collect(), 1);
        assert_hold(found.near, truth, &cases);
        assert_eq!(found.far, None, "all are as far as each other");
        let few = VarianceCalibration::of_cases(at(1.0, &cases[..3]).collect(), 1);
        assert_eq!(few, VarianceCalibration::default());
    }

    #[test]
    fn far_from_the_training_cases_the_factors_are_those_of_far_ones() {
        let near = VarianceFactors {
            shared: 1.0,
            impulse: Some(1.0),
            single: 0.5,
            ..VarianceFactors::default()
        };
        let far = VarianceFactors {
            shared: 9.0,
            impulse: Some(9.0),
            single: 4.0,
            duration: 4.0,
            peak: PeakFactors { scale: 1.5, spread: 0.7 },
        };
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
