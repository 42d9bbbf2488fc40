//! The evaluation of a force model and of the baselines on the same test cases.
//!
//! Baselines and clusters are fitted to training cases, and no option is chosen on test cases.

use rayon::prelude::*;

use crate::force::evaluate::baselines::{NearestBaseline, PulseBaseline};
use crate::force::evaluate::scored::Scored;
use crate::force::evaluate::{
    BaselineMetrics, CaseErrors, ClusterMetrics, DomainMetrics, Evaluation, EvaluationError,
};
use crate::force::metrics::ProbabilisticSettings;
use crate::force::regression::{ColumnSet, CurveFitError, CurveRegression};
use crate::force::{CurvePrediction, ForceCase, ForceScenario};
use impactlab_core::collision::{ImpulseClusters, ImpulseFeatures};
use impactlab_core::data::Outcome;
use impactlab_core::jobs::{Progress, ProgressCallback};
use impactlab_core::numerics::ClusterError;
use impactlab_core::uncertainty::ForceCurve;

/// Settings of an evaluation.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct EvaluationSettings {
    /// The columns of a scenario that model and baselines may use.
    pub columns: ColumnSet,
    /// Seed of folds, clusters and the baselines' draws.
    pub seed: u64,
    /// Settings of the scores of distributions.
    pub probabilistic: ProbabilisticSettings,
}

/// Baselines fitted to training cases.
#[derive(Debug, Clone)]
pub struct FittedBaselines {
    /// Classic pulse.
    pub pulse: PulseBaseline,
    /// Nearest case.
    pub nearest: NearestBaseline,
    /// Gaussian processes.
    pub statistical: CurveRegression,
}

impl FittedBaselines {
    /// Fits all three baselines and chooses their options by cross-validation.
    ///
    /// # Errors
    /// [`EvaluationError::Baseline`].
    pub fn fit(
        train: &[&ForceCase],
        columns: ColumnSet,
        seed: u64,
    ) -> Result<Self, EvaluationError> {
        let failed = |baseline| move |source| EvaluationError::Baseline { baseline, source };
        Ok(Self {
            pulse: PulseBaseline::fit(train, columns, seed).map_err(failed("pulse"))?,
            nearest: NearestBaseline::fit(train, columns, seed).map_err(failed("nearest"))?,
            statistical: CurveRegression::fit(train, columns, seed)
                .map_err(failed("statistical"))?,
        })
    }
}

/// Evaluates a model, and beside it baselines that are fitted to the training cases.
///
/// - `predictions`: of the test cases, in their order, canonical axes;
/// - `report`: is told of each step; breaks to cancel.
///
/// # Errors
/// [`EvaluationError`].
pub fn evaluate(
    model: &str,
    train: &[&ForceCase],
    test: &[&ForceCase],
    predictions: &[CurvePrediction],
    settings: &EvaluationSettings,
    report: &mut ProgressCallback<'_>,
) -> Result<Outcome<Evaluation>, EvaluationError> {
    const N_STEPS: u64 = 3;
    check(test, predictions)?;
    let mut go_on =
        |done, message: &str| report(Progress::new(done, N_STEPS, message)).is_continue();
    if !go_on(0, "fitting baselines") {
        return Ok(Outcome::Cancelled);
    }
    let baselines = FittedBaselines::fit(train, settings.columns, settings.seed)?;
    if !go_on(1, "scoring baselines") {
        return Ok(Outcome::Cancelled);
    }
    let mut problems = Vec::new();
    let mut score = |name: &str, predict: &PredictOne<'_>| {
        let predictions = predict_all(test, name, predict, &mut problems);
        Scored::new(test, &predictions, settings.probabilistic)
    };
    let pulse = score("pulse", &|scenario| baselines.pulse.predict(scenario))?;
    let nearest = score("nearest", &|scenario| baselines.nearest.predict(scenario))?;
    let statistical = score("statistical", &|scenario| baselines.statistical.predict(scenario))?;
    if !go_on(2, "scoring the model") {
        return Ok(Outcome::Cancelled);
    }
    let scored = Scored::new(test, predictions, settings.probabilistic)?;
    let of_domain = |inside: bool| {
        let known = predictions.iter().enumerate();
        let known = known.filter(|(_, prediction)| (prediction.applicability == 1.0) == inside);
        scored.over(known.map(|(idx, _)| idx))
    };
    let domain = DomainMetrics { inside: of_domain(true), outside: of_domain(false) };
    let clusters = cluster(train, settings.seed)?;
    let all = [&scored, &pulse, &nearest, &statistical];
    let metrics = |scored: &Scored| scored.metrics(test).ok_or(EvaluationError::NoCases);
    let evaluation = Evaluation {
        model: model.to_owned(),
        columns: settings.columns,
        n_train: train.len(),
        metrics: metrics(&scored)?,
        domain,
        baselines: BaselineMetrics {
            pulse: metrics(&pulse)?,
            nearest: metrics(&nearest)?,
            statistical: metrics(&statistical)?,
        },
        clusters: cluster_metrics(test, &clusters, &scored, &statistical),
        cases: case_errors(test, &clusters, all),
        problems,
    };
    go_on(N_STEPS, "evaluated");
    Ok(Outcome::Complete(evaluation))
}

fn check(test: &[&ForceCase], predictions: &[CurvePrediction]) -> Result<(), EvaluationError> {
    let (expected, got) = (test.len(), predictions.len());
    if expected == 0 {
        return Err(EvaluationError::NoCases);
    }
    if expected != got {
        return Err(EvaluationError::Predictions { expected, got });
    }
    let is_finite = |p: &CurvePrediction| {
        let values = p.curve.to_values().into_iter().chain(p.impulse_n_s);
        values.chain([p.peak_n]).all(f64::is_finite)
    };
    match test.iter().zip(predictions).find(|(_, prediction)| !is_finite(prediction)) {
        Some((case, _)) => Err(EvaluationError::NotFinite { case: case.name.clone() }),
        None => Ok(()),
    }
}

/// A model as a function.
type PredictOne<'a> = dyn Fn(&ForceScenario) -> Result<CurvePrediction, CurveFitError> + Sync + 'a;

fn predict_all(
    test: &[&ForceCase],
    name: &str,
    predict: &PredictOne<'_>,
    problems: &mut Vec<String>,
) -> Vec<CurvePrediction> {
    let predictions: Vec<_> = test.par_iter().map(|case| predict(&case.scenario)).collect();
    let mut or_no_force =
        |(case, prediction): (&&ForceCase, Result<CurvePrediction, CurveFitError>)| {
            prediction.unwrap_or_else(|error| {
                problems.push(format!(
                    "{name}, case {}: {}",
                    case.name,
                    impactlab_core::error_chain(&error)
                ));
                let zeros = vec![0.0; case.curve.n_instants()];
                let (fx_n, fy_n) = (zeros.clone(), zeros);
                CurvePrediction::from_curve(ForceCurve { fx_n, fy_n, duration_s: 0.0 })
            })
        };
    test.iter().zip(predictions).map(&mut or_no_force).collect()
}

fn features(case: &ForceCase) -> Option<ImpulseFeatures> {
    ImpulseFeatures::from_history(&case.curve.to_history())
}

fn cluster(train: &[&ForceCase], seed: u64) -> Result<ImpulseClusters, ClusterError> {
    let rows: Vec<ImpulseFeatures> = train.iter().filter_map(|case| features(case)).collect();
    ImpulseClusters::fit(&rows, seed)
}

fn cluster_metrics(
    test: &[&ForceCase],
    clusters: &ImpulseClusters,
    model: &Scored,
    statistical: &Scored,
) -> Vec<ClusterMetrics> {
    let metrics = |number: usize| {
        let is_in =
            |case: &ForceCase| features(case).is_some_and(|f| clusters.nearest(&f) == number);
        Some(ClusterMetrics {
            name: ImpulseClusters::label(number),
            impulse_n_s: clusters.impulse_n_s(number)?,
            model: model.chosen(test, is_in)?,
            statistical: statistical.chosen(test, is_in)?,
        })
    };
    (0..clusters.n_clusters()).filter_map(metrics).collect()
}

fn case_errors(
    test: &[&ForceCase],
    clusters: &ImpulseClusters,
    [model, pulse, nearest, statistical]: [&Scored; 4],
) -> Vec<CaseErrors> {
    let errors = |(idx, case): (usize, &&ForceCase)| {
        let number = clusters.nearest(&features(case)?);
        Some(CaseErrors {
            name: case.name.clone(),
            clean: case.is_clean(),
            cluster: ImpulseClusters::label(number),
            model: *model.errors.get(idx)?,
            pulse: *pulse.errors.get(idx)?,
            nearest: *nearest.errors.get(idx)?,
            statistical: *statistical.errors.get(idx)?,
        })
    };
    test.iter().enumerate().filter_map(errors).collect()
}
