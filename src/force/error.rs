//! What can go wrong between a data set and a prediction.

use crate::collision::ImpactError;
use crate::force::regression::CurveFitError;
use crate::learning::LearningError;
use crate::nn::NnError;
use crate::uncertainty::MixtureError;

/// A force model cannot be trained, opened or asked.
#[derive(Debug, thiserror::Error)]
pub enum ForceError {
    /// The law of the crush model cannot be fitted.
    #[error("the crush model cannot be fitted: none of the {n_cases} cases has a force")]
    NoCrushFit {
        /// How many cases there are.
        n_cases: usize,
    },
    /// The bullet's body is unknown to the model.
    #[error("bullet body {name:?} is unknown to the model, expected one of {}", known.join(", "))]
    UnknownBody {
        /// As asked for.
        name: String,
        /// What it knows.
        known: Vec<String>,
    },
    /// A number of the scenario makes no sense.
    #[error("{name} is {value}, expected {expected}")]
    Scenario {
        /// Which number.
        name: &'static str,
        /// Its value.
        value: f64,
        /// The range, in words.
        expected: &'static str,
    },
    /// The regressions beside the crush model cannot be fitted or asked.
    #[error("the regressions beside the crush model fail")]
    Regression(#[from] CurveFitError),
    /// The momentum solution has no answer.
    #[error(transparent)]
    Impact(#[from] ImpactError),
    /// The distribution makes no sense.
    #[error(transparent)]
    Mixture(#[from] MixtureError),
    /// Settings, training, network or model file.
    #[error(transparent)]
    Learning(#[from] LearningError),
}

impl From<NnError> for ForceError {
    fn from(error: NnError) -> Self {
        Self::Learning(error.into())
    }
}

impl From<candle_core::Error> for ForceError {
    fn from(error: candle_core::Error) -> Self {
        Self::Learning(error.into())
    }
}
