//! A force model on test cases, beside the baselines that it must beat.

mod error;
mod report;

mod scored;

mod evaluate;
mod table;

pub use error::EvaluationError;
pub use evaluate::{EvaluationSettings, FittedBaselines, evaluate};
pub use report::{BaselineFigures, CaseErrors, ClusterFigures, Evaluation, ModelFigures};
