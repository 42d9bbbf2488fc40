//! Why a force model cannot be evaluated.

use crate::force::regression::CurveFitError;
use impactlab_core::numerics::ClusterError;
use impactlab_core::uncertainty::MixtureError;

/// Why an evaluation is not possible.
#[derive(Debug, Clone, thiserror::Error)]
pub enum EvaluationError {
    /// There are no test cases.
    #[error("an evaluation on no cases")]
    NoCases,
    /// The number of predictions is not that of the test cases.
    #[error("{got} predictions for {expected} cases")]
    Predictions {
        /// Number of test cases.
        expected: usize,
        /// Number of predictions.
        got: usize,
    },
    /// A prediction contains a number that is not finite.
    #[error("case {case}: the prediction holds a number that is not finite")]
    NotFinite {
        /// Name of the case.
        case: String,
    },
    /// A baseline cannot be fitted.
    #[error("baseline {baseline}")]
    Baseline {
        /// Name of the baseline.
        baseline: &'static str,
        /// The cause.
        source: CurveFitError,
    },
    /// A distribution cannot be scored.
    #[error("case {case}")]
    Mixture {
        /// Name of the case.
        case: String,
        /// The cause.
        source: MixtureError,
    },
    /// The training cases cannot be clustered.
    #[error("the training cases cannot be clustered")]
    Clusters(#[from] ClusterError),
}
