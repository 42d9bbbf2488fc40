//! What cannot be evaluated.

use crate::force::regression::BaselineError;
use crate::numerics::ClusterError;
use crate::uncertainty::MixtureError;

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
