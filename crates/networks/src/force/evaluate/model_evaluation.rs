//! The evaluation of the force network on test cases, and by cross-validation on training cases.

use schemars::JsonSchema;
use serde::Serialize;

use crate::force::metrics::{CurveMetrics, PointErrors};
use crate::force::regression::ColumnSet;
use crate::force::{
    CaseErrors, CurvePrediction, Evaluation, EvaluationError, EvaluationSettings, ForceCase,
    ForceConfig, ForceError, ForceModel, ForceScenario, evaluate, train,
};
use crate::learning::{TrainSettings, TrainingReport, TrainingSet, folds};
use impactlab_core::data::Outcome;
use impactlab_core::jobs::{Progress, ProgressCallback};

/// Why a model cannot be evaluated.
#[derive(Debug, thiserror::Error)]
pub enum EvaluateError {
    /// The model cannot be trained, or not predict a case.
    #[error(transparent)]
    Model(#[from] ForceError),
    /// The predictions cannot be scored.
    #[error(transparent)]
    Evaluation(#[from] EvaluationError),
}

/// Metrics of the network and of its baselines over the same cases.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ComparedMetrics {
    /// The force network.
    pub model: CurveMetrics,
    /// Classic pulse with the momentum solution's impulse.
    pub pulse: CurveMetrics,
    /// Nearest training case.
    pub nearest: CurveMetrics,
    /// Gaussian processes on principal components.
    pub statistical: CurveMetrics,
}

/// The result of a cross-validation, in which every case is predicted by a model that was trained
/// without it.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct CrossValidation {
    /// Over all cases.
    pub overall: Option<ComparedMetrics>,
    /// Without cases that hook or have not separated.
    pub separated: Option<ComparedMetrics>,
    /// The evaluation of each fold, with the scores of its distributions.
    pub folds: Vec<Evaluation>,
}

impl CrossValidation {
    fn from_folds(folds: Vec<Evaluation>) -> Self {
        let compared = |choose: fn(&CaseErrors) -> bool| {
            let cases: Vec<&CaseErrors> =
                folds.iter().flat_map(|fold| &fold.cases).filter(|case| choose(case)).collect();
            let metrics = |errors_by: fn(&CaseErrors) -> &PointErrors| {
                let errors: Vec<&PointErrors> = cases.iter().map(|case| errors_by(case)).collect();
                CurveMetrics::new(&errors, &[])
            };
            Some(ComparedMetrics {
                model: metrics(|case| &case.model)?,
                pulse: metrics(|case| &case.pulse)?,
                nearest: metrics(|case| &case.nearest)?,
                statistical: metrics(|case| &case.statistical)?,
            })
        };
        let (overall, separated) = (compared(|_| true), compared(|case| case.clean));
        Self { overall, separated, folds }
    }
}

impl ComparedMetrics {
    /// Name and metrics of each model.
    pub fn named(&self) -> [(&'static str, &CurveMetrics); 4] {
        [
            ("force network", &self.model),
            ("pulse", &self.pulse),
            ("nearest", &self.nearest),
            ("statistical", &self.statistical),
        ]
    }
}

/// Evaluates a model on cases, and beside it baselines that are fitted to its training cases.
///
/// # Errors
/// [`EvaluateError`].
pub fn evaluate_model(
    model: &ForceModel,
    test: &[ForceCase],
    settings: &EvaluationSettings,
    report: &mut ProgressCallback<'_>,
) -> Result<Outcome<Evaluation>, EvaluateError> {
    let predictions = predictions(model, test, settings)?;
    let train: Vec<&ForceCase> = model.training_cases().iter().collect();
    let test: Vec<&ForceCase> = test.iter().collect();
    Ok(evaluate("force network", &train, &test, &predictions, settings, report)?)
}

fn predictions(
    model: &ForceModel,
    test: &[ForceCase],
    settings: &EvaluationSettings,
) -> Result<Vec<CurvePrediction>, ForceError> {
    let predict = |case: &ForceCase| {
        let predicted = model.predict(&known(&case.scenario, settings.columns))?;
        let applicability = predicted.applicability;
        let prediction = CurvePrediction::from_mixture(predicted.mixture, &predicted.likely);
        Ok(CurvePrediction { applicability, ..prediction })
    };
    test.iter().map(predict).collect()
}

/// The scenario without the columns that the model may not use.
fn known(scenario: &ForceScenario, columns: ColumnSet) -> ForceScenario {
    match columns {
        ColumnSet::ThetaContactAndBody => scenario.clone(),
        ColumnSet::Theta => ForceScenario {
            contact_m: None,
            striking_position_m: None,
            striking_body: None,
            struck_body: None,
            ..scenario.clone()
        },
    }
}

/// Trains a model for each fold of the cases and evaluates it on the cases of the fold, and baselines
/// likewise. Settings can be chosen by it without using test cases.
///
/// # Errors
/// [`EvaluateError`].
pub fn cross_validate(
    cases: &[ForceCase],
    config: &ForceConfig,
    n_folds: usize,
    settings: &EvaluationSettings,
    report: &mut ProgressCallback<'_>,
) -> Result<Outcome<CrossValidation>, EvaluateError> {
    let folds = folds(cases, n_folds, settings.seed);
    let n_steps = (folds.len() * config.training.epochs) as u64;
    let mut evaluations = Vec::with_capacity(folds.len());
    for (i, fold) in folds.iter().enumerate() {
        let chosen = |indices: &[usize]| -> Vec<ForceCase> {
            indices.iter().filter_map(|&idx| cases.get(idx)).cloned().collect()
        };
        let name = format!("fold {}", i + 1);
        let set = TrainingSet { name, train: chosen(&fold.train), test: Vec::new() };
        let train_settings = TrainSettings::unsaved(config.clone(), settings.seed);
        let (mut is_cancelled, first) = (false, (i * config.training.epochs) as u64);
        let model = train(&set, &train_settings, &mut |progress| {
            let (done, what) = match progress {
                TrainingReport::Fit(fit) => (0, format!("{}: {}", set.name, fit.what)),
                TrainingReport::Epoch(trained) => {
                    let epoch = trained.summary.epoch;
                    (epoch as u64, format!("{}: epoch {epoch}", set.name))
                }
            };
            let flow = report(Progress::new(first + done, n_steps, what));
            is_cancelled |= flow.is_break();
            flow
        })?;
        if is_cancelled {
            return Ok(Outcome::Cancelled);
        }
        match evaluate_model(&model, &chosen(&fold.test), settings, report)? {
            Outcome::Complete(evaluation) => evaluations.push(evaluation),
            Outcome::Cancelled => return Ok(Outcome::Cancelled),
        }
    }
    Ok(Outcome::Complete(CrossValidation::from_folds(evaluations)))
}
