//! Gaussian processes on the principal components of curves that are scaled by their impulse and
//! duration. They are a member of the committee in the centre of the network and a baseline of the
//! evaluation.
//!
//! ```text
//! F(t) = |P| / T · R(direction) · (s̄(u) + Σ_j c_j s_j(u))        u = (t − t₀)/T
//! ```
//!
//! Impulse and direction are regressed relative to the momentum solution, T, t₀ and the duration as
//! logarithms, the coefficients `c_j` with one set of hyperparameters. Cases that hook or have not
//! separated have a noise of their own ([`GaussianProcess`]). Alignment, number of
//! components and whether the momentum impulse is an input are chosen by cross-validation on the
//! training cases.
//!
//! The point estimate is the mean of the curves over the uncertainty of the regressions. The curve of
//! their means would be too steep where onset and length are uncertain.
//!
//! [`GaussianProcess`]: impactlab_core::numerics::GaussianProcess

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;
use serde::{Deserialize, Serialize};

use crate::force::regression::alignment::{Alignment, Placement};
use crate::force::regression::choice::choose;
use crate::force::regression::scales::Scales;
use crate::force::regression::shapes::{self, Shapes};
use crate::force::regression::{ColumnSet, CurveFitError, spread};
use crate::force::{CurvePrediction, ForceCase, ForceScenario};
use crate::nn::{Expected, NnError, check_number};
use impactlab_core::numerics::GaussianPrediction;
use impactlab_core::uncertainty::{CurveMixture, ForceCurve};

/// Number of antithetic pairs of draws for a distribution.
const N_PAIRS: usize = 64;

/// Number of antithetic pairs of draws for a point estimate, which needs fewer.
const N_POINT_PAIRS: usize = 16;

/// Number of regressed quantities besides the coefficients: impulse, direction, duration, length and
/// onset.
const N_SCALARS: usize = 5;

/// Options chosen by cross-validation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CurveRegressionOptions {
    /// The interval of a curve that is the unit of its scaled time.
    pub alignment: Alignment,
    /// Number of principal components of the shapes, 1 or more.
    pub n_components: usize,
    /// Whether the momentum solution's impulse is an input of the regressions. In either case their
    /// impulse is relative to it.
    pub with_impulse: bool,
}

/// Regressions of scaled force curves, fitted to training cases.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CurveRegression {
    /// The chosen options.
    pub options: CurveRegressionOptions,
    scales: Scales,
    shapes: Shapes,
    /// Share of training cases that hook or have not separated.
    unusual_share: f64,
    seed: u64,
}

/// Predictions of the regressions for a scenario.
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

impl CurveRegression {
    /// Checks a regression from a file.
    ///
    /// - `name`: its place in the metadata.
    ///
    /// # Errors
    /// [`NnError`] with the first number or list that is refused.
    pub(crate) fn check(&self, name: &str) -> Result<(), NnError> {
        self.scales.check(&format!("{name}.scales"))?;
        self.shapes.check(&format!("{name}.shapes"))?;
        check_number(&format!("{name}.unusual_share"), self.unusual_share, Expected::Share)
    }

    /// Chooses the options and fits the regressions.
    ///
    /// - `seed`: of the folds and of the draws for predictions.
    ///
    /// # Errors
    /// [`CurveFitError`].
    pub fn fit(cases: &[&ForceCase], columns: ColumnSet, seed: u64) -> Result<Self, CurveFitError> {
        let options = choose(cases, columns, seed)?;
        Self::fit_with(cases, columns, options, seed)
    }

    /// Fits the regressions with these options.
    ///
    /// # Errors
    /// [`CurveFitError`].
    pub fn fit_with(
        cases: &[&ForceCase],
        columns: ColumnSet,
        options: CurveRegressionOptions,
        seed: u64,
    ) -> Result<Self, CurveFitError> {
        let scales = Scales::fit(cases, columns, options.with_impulse)?;
        let shapes = Shapes::fit(cases, &scales, options)?;
        Ok(Self::from_parts(cases, scales, shapes, options, seed))
    }

    pub(super) fn from_parts(
        cases: &[&ForceCase],
        scales: Scales,
        shapes: Shapes,
        options: CurveRegressionOptions,
        seed: u64,
    ) -> Self {
        let n_unusual = cases.iter().filter(|case| !case.is_clean()).count();
        let unusual_share = n_unusual as f64 / cases.len().max(1) as f64;
        Self { options, scales, shapes, unusual_share, seed }
    }

    /// Curve, impulse, peak and duration of a canonical scenario with their distribution.
    ///
    /// The distribution has one component for vehicles that part and one for vehicles that hook or stay
    /// together, each from draws of all regressions. The point estimate is for vehicles that part.
    ///
    /// # Errors
    /// [`CurveFitError`].
    pub fn predict(&self, scenario: &ForceScenario) -> Result<CurvePrediction, CurveFitError> {
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
    /// [`CurveFitError`].
    pub fn point(&self, scenario: &ForceScenario) -> Result<CurvePrediction, CurveFitError> {
        let regressed = self.regress(scenario)?;
        Ok(self.mean_of(&regressed, &self.draw(&regressed, false, N_POINT_PAIRS)))
    }

    fn regress(&self, scenario: &ForceScenario) -> Result<Regressed, CurveFitError> {
        let (row, [px, py]) = self.scales.row(scenario)?;
        Ok(Regressed {
            impulse_n_s: px.hypot(py),
            direction_rad: px.atan2(py),
            scales: self.scales.predict(&row)?,
            times: self.shapes.predict_times(&row)?,
            coefficients: self.shapes.predict_coefficients(&row)?,
        })
    }

    /// Mean of draws. Its peak is that of the curve of the means, since the mean of curves is too flat
    /// and drawn curves are too rough.
    fn mean_of(&self, regressed: &Regressed, draws: &[ForceCurve]) -> CurvePrediction {
        let mut curve = ForceCurve::from_values(&spread::mean_values(draws));
        let [ln_ratio, turn, ln_duration] = &regressed.scales;
        curve.duration_s = ln_duration.mean[0].exp();
        let impulse = regressed.impulse_n_s * ln_ratio.mean[0].exp();
        let (sin, cos) = (regressed.direction_rad + turn.mean[0]).sin_cos();
        let n_numbers = N_SCALARS + regressed.coefficients.mean.len();
        let of_means = self.curve(regressed, false, &vec![0.0; n_numbers]);
        CurvePrediction {
            applicability: 1.0,
            curve,
            impulse_n_s: [impulse * sin, impulse * cos],
            peak_n: of_means.peak().0,
            mixture: None,
        }
    }

    /// Drawn curves with their durations, in antithetic pairs.
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

    /// The curve at `z` standard deviations from the mean of each regression.
    fn curve(&self, regressed: &Regressed, unusual: bool, z: &[f64]) -> ForceCurve {
        let at = |prediction: &GaussianPrediction, i: usize, z: f64| {
            prediction.mean[i]
                + z * if unusual { prediction.std_unusual[i] } else { prediction.std[i] }
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

    /// Standard deviation of the part that the principal components do not explain, N, for the mean
    /// interval and impulse, with a lower bound.
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
    use impactlab_core::numerics::Summary;

    const OPTIONS: CurveRegressionOptions = CurveRegressionOptions {
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
        let (held_out, fitted_to): (Vec<_>, Vec<_>) =
            train.iter().enumerate().partition(|(i, _)| i % 3 == 0);
        let fitted_to: Vec<&ForceCase> = fitted_to.into_iter().map(|(_, case)| *case).collect();
        let columns = ColumnSet::ThetaContactAndBody;
        let model = CurveRegression::fit_with(&fitted_to, columns, OPTIONS, 0).unwrap();
        let predict = |case: &ForceCase| model.predict(&case.scenario).unwrap();
        let clean = held_out.iter().map(|(_, case)| **case).filter(|case| case.is_clean());
        let errors = clean.map(|case| PointErrors::new(case, &predict(case)).history_error);
        let error = Summary::from_values(errors).unwrap();
        assert!(error.median < 0.4 && error.mean < 0.45, "{error:?}");
        let first = predict(fitted_to[0]);
        let mixture = first.mixture.as_ref().unwrap();
        assert_eq!(mixture.components().len(), 2);
        assert_eq!(first, predict(fitted_to[0]), "the same seed predicts the same");
        let spread = mixture.impulse(1).std() / first.impulse_n_s[1];
        assert!((0.005..1.0).contains(&spread), "{spread}");
    }
}
