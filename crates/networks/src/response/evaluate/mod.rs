//! The response network beside a tuned 4DOF model, the data sheet and a plain network, on
//! trajectories that none of them has seen.

mod motion_model;

mod case_metrics;
mod metrics;

mod compare;
mod leave_cars_out;
mod result;

mod paper;
mod tables;

pub use case_metrics::{MotionCaseMetrics, MotionCoverage};
pub use compare::{ComparisonSettings, compare_models, evaluate_motion_model};
pub use leave_cars_out::compare_on_unseen_cars;
pub use metrics::{CoverageMetrics, MeanStd, MotionMetrics, RootMeanSquares};
pub use motion_model::{MotionModel, MotionModelKind};
pub use paper::{PaperMetrics, paper_metrics};
use result::path_of;
pub use result::{
    ClusterModel, ClusterRow, ComparedCase, ComparedModel, Comparison, PATH_STEP_S, TestCase,
};
pub use tables::{ComparisonTable, all_tables};
