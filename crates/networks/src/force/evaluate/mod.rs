//! A force model on test cases, beside the baselines that it must beat.

mod error;

pub mod baselines;

mod report;
mod scored;

mod evaluation;

mod model_evaluation;

pub use error::EvaluationError;
pub use evaluation::{EvaluationSettings, FittedBaselines, evaluate};
pub use model_evaluation::{
    ComparedMetrics, CrossValidation, EvaluateError, cross_validate, evaluate_model,
};
pub use report::{
    BaselineMetrics, CaseErrors, ClusterMetrics, DomainMetrics, Evaluation, ForceMetrics,
};
