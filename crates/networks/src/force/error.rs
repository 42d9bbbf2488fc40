//! The errors of the force models, from the data set to the prediction.

use crate::force::regression::CurveFitError;
use crate::learning::LearningError;
use crate::nn::NnError;
use impactlab_core::collision::ImpactError;
use impactlab_core::uncertainty::MixtureError;

/// The reason why a force model cannot be trained, read or evaluated.
#[derive(Debug, thiserror::Error)]
pub enum ForceError {
    /// The law of the crush model cannot be fitted.
    #[error("the crush model cannot be fitted: none of the {n_cases} cases has a force")]
    NoCrushFit {
        /// Number of cases, none of which has a contact force.
        n_cases: usize,
    },
    /// A number of the scenario is outside its range.
    #[error("{name} is {value}, expected {expected}")]
    Scenario {
        /// Name of the number.
        name: &'static str,
        /// Value of the number.
        value: f64,
        /// The accepted range, in words.
        expected: &'static str,
    },
    /// The regressions that are averaged with the crush model cannot be fitted or evaluated.
    #[error("the regressions beside the crush model fail")]
    Regression(#[from] CurveFitError),
    /// The momentum solution of the impact does not exist.
    #[error(transparent)]
    Impact(#[from] ImpactError),
    /// The parameters of a mixture of force curves are invalid.
    #[error(transparent)]
    Mixture(#[from] MixtureError),
    /// Settings, training, network or model file cause an error.
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
