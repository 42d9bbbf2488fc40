//! The response network beside a tuned 4DOF model, the data sheet and a plain network, on
//! trajectories that none of them has seen: METHOD of this project, section 7.

mod case_figures;
mod compare;
mod figures;
mod paper;
mod result;
mod rival;
mod tables;
mod write;

pub use case_figures::{CaseFigures, Coverage};
pub use compare::{ComparisonSettings, compare_models, evaluate_rival};
pub use figures::{CoverageFigures, MeanStd, ModelFigures, RootMeanSquares};
pub use paper::{PaperFigure, paper_figure};
use result::path_of;
pub use result::{
    ClusterModel, ClusterRow, ComparedCase, ComparedModel, Comparison, PATH_STEP_S, TestCase,
};
pub use rival::{Rival, RivalKind};
pub use tables::{Table, all_tables, cluster_table, horizon_table, model_table, uncertainty_table};
pub use write::{to_markdown, write_comparison};
