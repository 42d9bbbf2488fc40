//! The force network under evaluation: on cases it has not seen, or in folds of those it has.

use serde::Serialize;

use crate::data::Outcome;
use crate::force::metrics::{Figures, PointErrors};
use crate::force::regression::ColumnSet;
use crate::force::{
    CaseErrors, Evaluation, EvaluationError, EvaluationSettings, ForceCase, ForceConfig,
    ForceError, ForceModel, ForceScenario, Prediction, evaluate, train,
};
use crate::jobs::{Progress, Report};
use crate::learning::{TrainSettings, TrainingReport, TrainingSet, folds};

/// A model that cannot be evaluated.
#[derive(Debug, thiserror::Error)]
pub enum EvaluateError {
    /// It cannot predict a case, or not be trained.
    #[error(transparent)]
    Model(#[from] ForceError),
    /// Its predictions cannot be measured.
    #[error(transparent)]
    Evaluation(#[from] EvaluationError),
}

/// Figures of the network and its baselines over the same cases.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Compared {
    /// The force network.
    pub model: Figures,
    /// Classic pulse with the momentum solution's impulse.
    pub pulse: Figures,
    /// Nearest training case.
    pub nearest: Figures,
    /// Gaussian processes on principal components.
    pub statistical: Figures,
}

/// A cross-validation: every case predicted by models that have not seen it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CrossValidation {
    /// Over all cases.
    pub overall: Option<Compared>,
    /// Without cases that hook or have not separated.
    pub separated: Option<Compared>,
    /// Each fold, with its distributions.
    pub folds: Vec<Evaluation>,
}

impl CrossValidation {
    fn of(folds: Vec<Evaluation>) -> Self {
        let compared = |choose: fn(&CaseErrors) -> bool| {
            let cases: Vec<&CaseErrors> =
                folds.iter().flat_map(|fold| &fold.cases).filter(|case| choose(case)).collect();
            let figures = |of: fn(&CaseErrors) -> &PointErrors| {
                let errors: Vec<&PointErrors> = cases.iter().map(|case| of(case)).collect();
                Figures::of(&errors, &[])
            };
            Some(Compared {
                model: figures(|case| &case.model)?,
                pulse: figures(|case| &case.pulse)?,
                nearest: figures(|case| &case.nearest)?,
                statistical: figures(|case| &case.statistical)?,
            })
        };
        let (overall, separated) = (compared(|_| true), compared(|case| case.clean));
        Self { overall, separated, folds }
    }
}

impl Compared {
    /// Name and figures of each.
    pub fn named(&self) -> [(&'static str, &Figures); 4] {
        [
            ("force network", &self.model),
            ("pulse", &self.pulse),
            ("nearest", &self.nearest),
            ("statistical", &self.statistical),
        ]
    }
}

/// Evaluates a model on cases, beside baselines fitted to the model's own training cases.
///
/// # Errors
/// [`EvaluateError`].
pub fn evaluate_model(
    model: &ForceModel,
    test: &[ForceCase],
    settings: &EvaluationSettings,
    report: &mut Report<'_>,
) -> Result<Outcome<Evaluation>, EvaluateError> {
    let predictions = predictions(model, test, settings)?;
    let train: Vec<&ForceCase> = model.training_cases().iter().collect();
    let test: Vec<&ForceCase> = test.iter().collect();
    Ok(evaluate("force network", (&train, &test), &predictions, settings, report)?)
}

fn predictions(
    model: &ForceModel,
    test: &[ForceCase],
    settings: &EvaluationSettings,
) -> Result<Vec<Prediction>, ForceError> {
    let predict = |case: &ForceCase| {
        let said = model.predict(&known(&case.scenario, settings.columns))?;
        Ok(Prediction::of_mixture(said.mixture, &said.likely))
    };
    test.iter().map(predict).collect()
}

/// What the model may know of a scenario.
fn known(scenario: &ForceScenario, columns: ColumnSet) -> ForceScenario {
    match columns {
        ColumnSet::ThetaContactAndBody => scenario.clone(),
        ColumnSet::Theta => ForceScenario {
            contact_m: None,
            bullet_position_m: None,
            bullet_body: None,
            ..scenario.clone()
        },
    }
}

/// Trains in folds of cases and predicts each case with the model that has not seen it; baselines
/// likewise. For choosing settings without a look at test cases.
///
/// # Errors
/// [`EvaluateError`].
pub fn cross_validate(
    cases: &[ForceCase],
    config: &ForceConfig,
    (n_folds, settings): (usize, &EvaluationSettings),
    report: &mut Report<'_>,
) -> Result<Outcome<CrossValidation>, EvaluateError> {
    let folds = folds(cases, n_folds, settings.seed);
    let n_steps = (folds.len() * config.training.epochs) as u64;
    let mut evaluations = Vec::with_capacity(folds.len());
    for (i, fold) in folds.iter().enumerate() {
        let of = |indices: &[usize]| -> Vec<ForceCase> {
            indices.iter().filter_map(|&idx| cases.get(idx)).cloned().collect()
        };
        let name = format!("fold {}", i + 1);
        let set = TrainingSet { name, train: of(&fold.train), test: Vec::new() };
        let train_settings = TrainSettings::unsaved(config.clone(), settings.seed);
        let (mut is_cancelled, first) = (false, (i * config.training.epochs) as u64);
        let model = train(&set, &train_settings, &mut |told| {
            let (done, what) = match told {
                TrainingReport::Fit { what, .. } => (0, format!("{}: {what}", set.name)),
                TrainingReport::Epoch(told) => {
                    let epoch = told.summary.epoch;
                    (epoch as u64, format!("{}: epoch {epoch}", set.name))
                }
            };
            let told = report(Progress::new(first + done, n_steps, what));
            is_cancelled |= told.is_break();
            told
        })?;
        if is_cancelled {
            return Ok(Outcome::Cancelled);
        }
        match evaluate_model(&model, &of(&fold.test), settings, report)? {
            Outcome::Complete(evaluation) => evaluations.push(evaluation),
            Outcome::Cancelled => return Ok(Outcome::Cancelled),
        }
    }
    Ok(Outcome::Complete(CrossValidation::of(evaluations)))
}
