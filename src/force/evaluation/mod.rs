//! A force model on test cases, beside the baselines that it must beat.
//!
//! Nothing is fitted to test cases or chosen by them: baselines and clusters see training cases only.

mod table;

use rayon::prelude::*;
use serde::Serialize;

use crate::data::Outcome;
use crate::force::baselines::{
    BaselineError, ColumnSet, NearestBaseline, PulseBaseline, StatisticalBaseline,
};
use crate::force::metrics::{Figures, PointErrors, ProbabilisticScores, ProbabilisticSettings};
use crate::force::{ForceCase, ForceScenario, ImpulseClusters, ImpulseFeatures, Prediction};
use crate::jobs::{Progress, Report};
use crate::numerics::ClusterError;
use crate::uncertainty::{ForceCurve, MixtureError};

/// What an evaluation needs to be told.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct EvaluationSettings {
    /// What baselines may know of a scenario: as much as the model.
    pub columns: ColumnSet,
    /// Seed of folds, clusters and the baselines' draws.
    pub seed: u64,
    /// Draws for the scores of distributions.
    pub probabilistic: ProbabilisticSettings,
}

/// Figures of one model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModelFigures {
    /// Over all cases.
    pub overall: Figures,
    /// Without cases that hook or have not separated; nothing if that leaves none.
    pub separated: Option<Figures>,
}

/// Figures of the baselines.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BaselineFigures {
    /// Classic pulse with the momentum solution's impulse.
    pub pulse: ModelFigures,
    /// Nearest training case.
    pub nearest: ModelFigures,
    /// Gaussian processes on principal components.
    pub statistical: ModelFigures,
}

/// Figures within one cluster.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ClusterFigures {
    /// C0, C1, … by rising impulse.
    pub name: String,
    /// Impulse at its centre, N s.
    pub impulse_n_s: f64,
    /// The model.
    pub model: Figures,
    /// The strongest baseline.
    pub statistical: Figures,
}

/// Errors of all models on one case.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CaseErrors {
    /// Name of the case.
    pub name: String,
    /// Whether the vehicles part for good.
    pub clean: bool,
    /// Its cluster.
    pub cluster: String,
    /// The model.
    pub model: PointErrors,
    /// Baselines.
    pub pulse: PointErrors,
    /// Baselines.
    pub nearest: PointErrors,
    /// Baselines.
    pub statistical: PointErrors,
}

/// A model's figures beside those of the baselines.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Evaluation {
    /// What a table calls the model.
    pub model: String,
    /// What the baselines knew of a scenario.
    pub columns: ColumnSet,
    /// Training cases.
    pub n_train: usize,
    /// The model.
    #[serde(flatten)]
    pub figures: ModelFigures,
    /// The baselines.
    pub baselines: BaselineFigures,
    /// By cluster of the training cases; those without a test case are left out.
    pub clusters: Vec<ClusterFigures>,
    /// Each case.
    pub cases: Vec<CaseErrors>,
    /// Test cases that a baseline cannot predict, and why: there it predicts no force.
    pub problems: Vec<String>,
}

/// An evaluation that cannot be made.
#[derive(Debug, Clone, thiserror::Error)]
pub enum EvaluationError {
    /// No test cases.
    #[error("an evaluation on no cases")]
    NoCases,
    /// Predictions for other cases.
    #[error("{got} predictions for {expected} cases")]
    Predictions {
        /// Test cases.
        expected: usize,
        /// Predictions.
        got: usize,
    },
    /// A prediction that is not finite.
    #[error("case {case}: the prediction holds a number that is not finite")]
    NotFinite {
        /// Name of the case.
        case: String,
    },
    /// A baseline cannot be fitted.
    #[error("baseline {baseline}")]
    Baseline {
        /// Which.
        baseline: &'static str,
        /// Why.
        source: BaselineError,
    },
    /// A distribution cannot be scored.
    #[error("case {case}")]
    Mixture {
        /// Name of the case.
        case: String,
        /// Why.
        source: MixtureError,
    },
    /// The clusters fail.
    #[error("the training cases cannot be clustered")]
    Clusters(#[from] ClusterError),
}

/// Baselines fitted to training cases.
#[derive(Debug, Clone)]
pub struct FittedBaselines {
    /// Classic pulse.
    pub pulse: PulseBaseline,
    /// Nearest case.
    pub nearest: NearestBaseline,
    /// Gaussian processes.
    pub statistical: StatisticalBaseline,
}

impl FittedBaselines {
    /// Fits all three and chooses their options.
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
            statistical: StatisticalBaseline::fit(train, columns, seed)
                .map_err(failed("statistical"))?,
        })
    }
}

/// Scores of one model on all test cases.
struct Scored {
    errors: Vec<PointErrors>,
    /// Empty without distributions.
    scores: Vec<ProbabilisticScores>,
}

/// Evaluates a model beside baselines that are fitted here to the training cases.
///
/// - `predictions`: of the test cases, in their order, canonical axes;
/// - `report`: is told of each step; breaks to cancel.
///
/// # Errors
/// [`EvaluationError`].
pub fn evaluate(
    model: &str,
    (train, test): (&[&ForceCase], &[&ForceCase]),
    predictions: &[Prediction],
    settings: &EvaluationSettings,
    report: &mut Report<'_>,
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
        let predictions = predict_all(test, (name, predict), &mut problems);
        Scored::of(test, &predictions, settings.probabilistic)
    };
    let pulse = score("pulse", &|scenario| baselines.pulse.predict(scenario))?;
    let nearest = score("nearest", &|scenario| baselines.nearest.predict(scenario))?;
    let statistical = score("statistical", &|scenario| baselines.statistical.predict(scenario))?;
    if !go_on(2, "scoring the model") {
        return Ok(Outcome::Cancelled);
    }
    let scored = Scored::of(test, predictions, settings.probabilistic)?;
    let clusters = cluster(train, settings.seed)?;
    let all = [&scored, &pulse, &nearest, &statistical];
    let figures = |of: &Scored| of.figures(test).ok_or(EvaluationError::NoCases);
    let evaluation = Evaluation {
        model: model.to_owned(),
        columns: settings.columns,
        n_train: train.len(),
        figures: figures(&scored)?,
        baselines: BaselineFigures {
            pulse: figures(&pulse)?,
            nearest: figures(&nearest)?,
            statistical: figures(&statistical)?,
        },
        clusters: cluster_figures(test, &clusters, (&scored, &statistical)),
        cases: case_errors(test, &clusters, all),
        problems,
    };
    go_on(N_STEPS, "evaluated");
    Ok(Outcome::Complete(evaluation))
}

fn check(test: &[&ForceCase], predictions: &[Prediction]) -> Result<(), EvaluationError> {
    let (expected, got) = (test.len(), predictions.len());
    if expected == 0 {
        return Err(EvaluationError::NoCases);
    }
    if expected != got {
        return Err(EvaluationError::Predictions { expected, got });
    }
    let is_finite = |p: &Prediction| {
        let values = p.curve.to_values().into_iter().chain(p.impulse_n_s);
        values.chain([p.peak_n]).all(f64::is_finite)
    };
    match test.iter().zip(predictions).find(|(_, prediction)| !is_finite(prediction)) {
        Some((case, _)) => Err(EvaluationError::NotFinite { case: case.name.clone() }),
        None => Ok(()),
    }
}

/// A model as a function.
type PredictOne<'a> = dyn Fn(&ForceScenario) -> Result<Prediction, BaselineError> + Sync + 'a;

fn predict_all(
    test: &[&ForceCase],
    (name, predict): (&str, &PredictOne<'_>),
    problems: &mut Vec<String>,
) -> Vec<Prediction> {
    let predictions: Vec<_> = test.par_iter().map(|case| predict(&case.scenario)).collect();
    let mut or_no_force = |(case, prediction): (&&ForceCase, Result<Prediction, BaselineError>)| {
        prediction.unwrap_or_else(|error| {
            problems.push(format!("{name}, case {}: {}", case.name, crate::error_chain(&error)));
            let zeros = vec![0.0; case.curve.n_instants()];
            let (fx_n, fy_n) = (zeros.clone(), zeros);
            Prediction::of_curve(ForceCurve { fx_n, fy_n, duration_s: 0.0 })
        })
    };
    test.iter().zip(predictions).map(&mut or_no_force).collect()
}

impl Scored {
    fn of(
        test: &[&ForceCase],
        predictions: &[Prediction],
        settings: ProbabilisticSettings,
    ) -> Result<Self, EvaluationError> {
        let pairs = || test.iter().zip(predictions);
        let errors = pairs().map(|(case, prediction)| PointErrors::of(case, prediction)).collect();
        if predictions.iter().any(|prediction| prediction.mixture.is_none()) {
            return Ok(Self { errors, scores: Vec::new() });
        }
        let tasks: Vec<_> = pairs().enumerate().collect();
        let scores = tasks.par_iter().filter_map(|(stream, (case, prediction))| {
            let mixture = prediction.mixture.as_ref()?;
            let scores = ProbabilisticScores::of(case, mixture, settings, *stream as u64);
            let named = |source| EvaluationError::Mixture { case: case.name.clone(), source };
            Some(scores.map_err(named))
        });
        Ok(Self { errors, scores: scores.collect::<Result<_, _>>()? })
    }

    fn figures(&self, test: &[&ForceCase]) -> Option<ModelFigures> {
        Some(ModelFigures {
            overall: self.chosen(test, |_| true)?,
            separated: self.chosen(test, ForceCase::is_clean),
        })
    }

    /// Figures over the cases that `choose` takes.
    fn chosen(&self, test: &[&ForceCase], choose: impl Fn(&ForceCase) -> bool) -> Option<Figures> {
        let taken: Vec<usize> =
            test.iter().enumerate().filter(|(_, case)| choose(case)).map(|(idx, _)| idx).collect();
        let errors: Vec<_> = taken.iter().filter_map(|idx| self.errors.get(*idx)).collect();
        let scores: Vec<_> = taken.iter().filter_map(|idx| self.scores.get(*idx)).collect();
        Figures::of(&errors, &scores)
    }
}

fn features(case: &ForceCase) -> Option<ImpulseFeatures> {
    ImpulseFeatures::of(&case.curve.to_history())
}

fn cluster(train: &[&ForceCase], seed: u64) -> Result<ImpulseClusters, ClusterError> {
    let rows: Vec<ImpulseFeatures> = train.iter().filter_map(|case| features(case)).collect();
    ImpulseClusters::fit(&rows, seed)
}

fn cluster_figures(
    test: &[&ForceCase],
    clusters: &ImpulseClusters,
    (model, statistical): (&Scored, &Scored),
) -> Vec<ClusterFigures> {
    let of = |number: usize| {
        let is_in = |case: &ForceCase| features(case).is_some_and(|f| clusters.of(&f) == number);
        Some(ClusterFigures {
            name: ImpulseClusters::label(number),
            impulse_n_s: clusters.impulse_n_s(number)?,
            model: model.chosen(test, is_in)?,
            statistical: statistical.chosen(test, is_in)?,
        })
    };
    (0..clusters.n_clusters()).filter_map(of).collect()
}

fn case_errors(
    test: &[&ForceCase],
    clusters: &ImpulseClusters,
    [model, pulse, nearest, statistical]: [&Scored; 4],
) -> Vec<CaseErrors> {
    let of = |(idx, case): (usize, &&ForceCase)| {
        let number = clusters.of(&features(case)?);
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
    test.iter().enumerate().filter_map(of).collect()
}
