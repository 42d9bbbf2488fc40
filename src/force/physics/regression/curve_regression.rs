//! Baseline (c): Gaussian processes on the principal components of curves that are scaled by their
//! impulse and duration.
//!
//! ```text
//! F(t) = |P| / T · R(direction) · (s̄(u) + Σ_j c_j s_j(u))        u = (t − t₀)/T
//! ```
//!
//! Impulse and direction are regressed relative to the momentum solution, T, t₀ and the duration as
//! logarithms, the coefficients `c_j` with one set of hyperparameters. Cases that hook or have not
//! separated are learned from with a noise of their own ([`GaussianProcess`]). Alignment, number of
//! components and whether the momentum impulse is an input are chosen by cross-validation on the
//! training cases.
//!
//! The point estimate is the mean curve over the uncertainty of the regressions, not the curve of
//! their means: where onset and length are unsure, the latter is too sharp.
//!
//! [`GaussianProcess`]: crate::numerics::GaussianProcess

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;
use serde::{Deserialize, Serialize};

use crate::force::regression::alignment::{Alignment, Placement};
use crate::force::regression::choice::choose;
use crate::force::regression::scales::Scales;
use crate::force::regression::shapes::{self, Shapes};
use crate::force::regression::{BaselineError, ColumnSet, spread};
use crate::force::{ForceCase, ForceScenario, Prediction};
use crate::numerics::GaussianPrediction;
use crate::uncertainty::{CurveMixture, ForceCurve};

/// Pairs of opposite draws behind a distribution.
const N_PAIRS: usize = 64;

/// Pairs of draws behind a point estimate, where their noise hardly counts.
const N_POINT_PAIRS: usize = 16;

/// Regressed numbers besides the coefficients: impulse, direction, duration, length, onset.
const N_SCALARS: usize = 5;

/// What is chosen by cross-validation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct StatisticalOptions {
    /// The stretch of a curve that is its unit of time.
    pub alignment: Alignment,
    /// Principal components of the shapes, 1 or more.
    pub n_components: usize,
    /// Whether the momentum solution's impulse is among the inputs (it always scales the impulse).
    pub with_impulse: bool,
}

/// Regressions fitted to training cases.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StatisticalBaseline {
    /// What was chosen.
    pub options: StatisticalOptions,
    scales: Scales,
    shapes: Shapes,
    /// Share of training cases that hook or have not separated.
    unusual_share: f64,
    seed: u64,
}

/// What the regressions say of a scenario.
struct Regressed {
    /// Size, N s, and direction of the momentum solution's impulse.
    impulse_n_s: f64,
    direction_rad: f64,
    /// `ln |P|/|P_m|`, turn of the direction, `ln` duration.
    scales: [GaussianPrediction; 3],
    /// `ln T`, `ln (t₀ + floor)`.
    times: [GaussianPrediction; 2],
    coefficients: GaussianPrediction,
}

impl StatisticalBaseline {
    /// Chooses its options and fits it.
    ///
    /// - `seed`: of the folds and of the draws behind predictions.
    ///
    /// # Errors
    /// [`BaselineError`].
    pub fn fit(cases: &[&ForceCase], columns: ColumnSet, seed: u64) -> Result<Self, BaselineError> {
        let options = choose(cases, columns, seed)?;
        Self::fit_with(cases, columns, options, seed)
    }

    /// Fits it with these options.
    ///
    /// # Errors
    /// [`BaselineError`].
    pub fn fit_with(
        cases: &[&ForceCase],
        columns: ColumnSet,
        options: StatisticalOptions,
        seed: u64,
    ) -> Result<Self, BaselineError> {
        let scales = Scales::fit(cases, columns, options.with_impulse)?;
        let shapes = Shapes::fit(cases, &scales, options)?;
        Ok(Self::of_parts(cases, (scales, shapes), options, seed))
    }

    pub(super) fn of_parts(
        cases: &[&ForceCase],
        (scales, shapes): (Scales, Shapes),
        options: StatisticalOptions,
        seed: u64,
    ) -> Self {
        let n_unusual = cases.iter().filter(|case| !case.is_clean()).count();
        let unusual_share = n_unusual as f64 / cases.len().max(1) as f64;
        Self { options, scales, shapes, unusual_share, seed }
    }

    /// Curve, impulse, peak and duration of a canonical scenario with their distribution: one
    /// component of vehicles that part, one of those that do not, each from draws of all
    /// regressions. The point estimate is that of vehicles that part.
    ///
    /// # Errors
    /// [`BaselineError`].
    pub fn predict(&self, scenario: &ForceScenario) -> Result<Prediction, BaselineError> {
        let regressed = self.regress(scenario)?;
        let draws = self.draw(&regressed, false, N_PAIRS);
        let mut prediction = self.mean_of(&regressed, &draws);
        let residual = |draws: &[ForceCurve]| self.residual_std_n(&regressed, draws);
        let mut parts =
            vec![(1.0 - self.unusual_share, spread::component(&draws, residual(&draws)))];
        if self.unusual_share > 0.0 {
            let draws = self.draw(&regressed, true, N_PAIRS);
            parts.push((self.unusual_share, spread::component(&draws, residual(&draws))));
        }
        let components = parts.into_iter().map(|(weight, mut component)| {
            component.weight = weight;
            component
        });
        prediction.mixture = Some(CurveMixture::new(components.collect())?);
        Ok(prediction)
    }

    /// The point estimate alone, from fewer draws.
    ///
    /// # Errors
    /// [`BaselineError`].
    pub fn point(&self, scenario: &ForceScenario) -> Result<Prediction, BaselineError> {
        let regressed = self.regress(scenario)?;
        Ok(self.mean_of(&regressed, &self.draw(&regressed, false, N_POINT_PAIRS)))
    }

    fn regress(&self, scenario: &ForceScenario) -> Result<Regressed, BaselineError> {
        let (row, [px, py]) = self.scales.row(scenario)?;
        Ok(Regressed {
            impulse_n_s: px.hypot(py),
            direction_rad: px.atan2(py),
            scales: self.scales.predict(&row)?,
            times: self.shapes.predict_times(&row)?,
            coefficients: self.shapes.predict_coefficients(&row)?,
        })
    }

    /// Mean of draws. The peak is that of the curve of the means: averaged curves are too flat, and
    /// drawn ones too rough.
    fn mean_of(&self, regressed: &Regressed, draws: &[ForceCurve]) -> Prediction {
        let mut curve = ForceCurve::from_values(&spread::mean_values(draws));
        let [ln_ratio, turn, ln_duration] = &regressed.scales;
        curve.duration_s = ln_duration.mean[0].exp();
        let impulse = regressed.impulse_n_s * ln_ratio.mean[0].exp();
        let (sin, cos) = (regressed.direction_rad + turn.mean[0]).sin_cos();
        let n_numbers = N_SCALARS + regressed.coefficients.mean.len();
        let of_means = self.curve(regressed, false, &vec![0.0; n_numbers]);
        Prediction {
            curve,
            impulse_n_s: [impulse * sin, impulse * cos],
            peak_n: of_means.peak().0,
            mixture: None,
        }
    }

    /// Curves with their durations, in pairs of opposite draws.
    fn draw(&self, regressed: &Regressed, unusual: bool, n_pairs: usize) -> Vec<ForceCurve> {
        let mut rng = ChaCha8Rng::seed_from_u64(self.seed);
        let n_numbers = N_SCALARS + regressed.coefficients.mean.len();
        let mut draws = Vec::with_capacity(2 * n_pairs);
        for _ in 0..n_pairs {
            let z: Vec<f64> = (0..n_numbers).map(|_| rng.sample(StandardNormal)).collect();
            for sign in [1.0, -1.0] {
                let signed: Vec<f64> = z.iter().map(|z| sign * z).collect();
                draws.push(self.curve(regressed, unusual, &signed));
            }
        }
        draws
    }

    /// The curve at these numbers of standard deviations of each regression.
    fn curve(&self, regressed: &Regressed, unusual: bool, z: &[f64]) -> ForceCurve {
        let at = |of: &GaussianPrediction, i: usize, z: f64| {
            of.mean[i] + z * if unusual { of.std_unusual[i] } else { of.std[i] }
        };
        let [ln_ratio, turn, ln_duration] = [0, 1, 2].map(|i| at(&regressed.scales[i], 0, z[i]));
        let [ln_length, ln_start] = [0, 1].map(|i| at(&regressed.times[i], 0, z[3 + i]));
        let coefficients: Vec<f64> = (0..regressed.coefficients.mean.len())
            .map(|i| at(&regressed.coefficients, i, z[N_SCALARS + i]))
            .collect();
        let placement = Placement {
            start_s: shapes::start_s(ln_start),
            length_s: ln_length.exp(),
            impulse_n_s: regressed.impulse_n_s * ln_ratio.exp(),
            direction_rad: regressed.direction_rad + turn,
        };
        let curve = placement.curve_of(&self.shapes.shape(&coefficients));
        ForceCurve { duration_s: ln_duration.exp(), ..curve }
    }

    /// Deviation of what the principal components leave out, N, at the placement of the means, and a
    /// floor.
    fn residual_std_n(&self, regressed: &Regressed, draws: &[ForceCurve]) -> Vec<f64> {
        let placement = Placement {
            start_s: shapes::start_s(regressed.times[1].mean[0]),
            length_s: regressed.times[0].mean[0].exp(),
            impulse_n_s: regressed.impulse_n_s * regressed.scales[0].mean[0].exp(),
            direction_rad: 0.0,
        };
        let left_out = placement.curve_of(self.shapes.residual_std());
        let peak_n = spread::mean_peak_n(draws);
        let values = left_out.fx_n.iter().chain(&left_out.fy_n);
        values.map(|std| std.hypot(spread::FLOOR_SHARE_OF_PEAK * peak_n)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::force::input::shipped;
    use crate::force::metrics::PointErrors;
    use crate::learning::{TEST_SHARE, split};
    use crate::numerics::Summary;

    const OPTIONS: StatisticalOptions = StatisticalOptions {
        alignment: Alignment::ImpulseShares { from: 0.02, to: 0.90 },
        n_components: 8,
        with_impulse: false,
    };

    #[test]
    fn it_learns_from_cases_that_hook_without_being_bent_by_them() {
        let cases = shipped("fea");
        let split = split(&cases, 0, TEST_SHARE);
        // Of the training cases only: a third is kept back here.
        let train: Vec<&ForceCase> = split.train.iter().map(|idx| &cases[*idx]).collect();
        let (kept_back, fitted_to): (Vec<_>, Vec<_>) =
            train.iter().enumerate().partition(|(i, _)| i % 3 == 0);
        let fitted_to: Vec<&ForceCase> = fitted_to.into_iter().map(|(_, case)| *case).collect();
        let columns = ColumnSet::ThetaContactAndBody;
        let model = StatisticalBaseline::fit_with(&fitted_to, columns, OPTIONS, 0).unwrap();
        let predict = |case: &ForceCase| model.predict(&case.scenario).unwrap();
        let clean = kept_back.iter().map(|(_, case)| **case).filter(|case| case.is_clean());
        let errors = clean.map(|case| PointErrors::of(case, &predict(case)).history_error);
        let error = Summary::of(errors).unwrap();
        assert!(error.median < 0.4 && error.mean < 0.45, "{error:?}");
        let first = predict(fitted_to[0]);
        let mixture = first.mixture.as_ref().unwrap();
        assert_eq!(mixture.components().len(), 2);
        assert_eq!(first, predict(fitted_to[0]), "the same seed predicts the same");
        let spread = mixture.impulse(1).std() / first.impulse_n_s[1];
        assert!((0.005..1.0).contains(&spread), "{spread}");
    }
}
