//! What an evaluation says.

use serde::Serialize;

use crate::force::metrics::{Figures, PointErrors};
use crate::force::regression::ColumnSet;

/// Figures of one model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModelFigures {
    /// Over all cases.
    pub overall: Figures,
    /// Without cases that hook or have not separated; nothing if that leaves none.
    pub separated: Option<Figures>,
}

/// Figures of the baselines.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BaselineFigures {
    /// Classic pulse with the momentum solution's impulse.
    pub pulse: ModelFigures,
    /// Nearest training case.
    pub nearest: ModelFigures,
    /// Gaussian processes on principal components.
    pub statistical: ModelFigures,
}

/// Figures within one cluster.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ClusterFigures {
    /// C0, C1, … by rising impulse.
    pub name: String,
    /// Impulse at its centre, N s.
    pub impulse_n_s: f64,
    /// The model.
    pub model: Figures,
    /// The strongest baseline.
    pub statistical: Figures,
}

/// Errors of all models on one case.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CaseErrors {
    /// Name of the case.
    pub name: String,
    /// Whether the vehicles part for good.
    pub clean: bool,
    /// Its cluster.
    pub cluster: String,
    /// The model.
    pub model: PointErrors,
    /// Baselines.
    pub pulse: PointErrors,
    /// Baselines.
    pub nearest: PointErrors,
    /// Baselines.
    pub statistical: PointErrors,
}

/// A model's figures beside those of the baselines.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Evaluation {
    /// What a table calls the model.
    pub model: String,
    /// What the baselines knew of a scenario.
    pub columns: ColumnSet,
    /// Training cases.
    pub n_train: usize,
    /// The model.
    #[serde(flatten)]
    pub figures: ModelFigures,
    /// The baselines.
    pub baselines: BaselineFigures,
    /// By cluster of the training cases; those without a test case are left out.
    pub clusters: Vec<ClusterFigures>,
    /// Each case.
    pub cases: Vec<CaseErrors>,
    /// Test cases that a baseline cannot predict, and why: there it predicts no force.
    pub problems: Vec<String>,
}
