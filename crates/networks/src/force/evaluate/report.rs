//! The result of an evaluation.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::force::metrics::{CurveMetrics, PointErrors};
use crate::force::regression::ColumnSet;

/// Metrics of one model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ForceMetrics {
    /// Over all cases.
    pub overall: CurveMetrics,
    /// Over the cases that neither hook nor stay together; `None` if there are none.
    pub separated: Option<CurveMetrics>,
}

/// Metrics of a model inside and outside of what it has learned from; each `None` without cases.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DomainMetrics {
    /// Over the cases to which it applies fully.
    pub inside: Option<CurveMetrics>,
    /// Over the others.
    pub outside: Option<CurveMetrics>,
}

/// Metrics of the baselines.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BaselineMetrics {
    /// Classic pulse with the momentum solution's impulse.
    pub pulse: ForceMetrics,
    /// Nearest training case.
    pub nearest: ForceMetrics,
    /// Gaussian processes on principal components.
    pub statistical: ForceMetrics,
}

/// Metrics within one cluster.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ClusterMetrics {
    /// Name of the cluster: C0, C1, … by rising impulse.
    pub name: String,
    /// Impulse at the centre of the cluster, N s.
    pub impulse_n_s: f64,
    /// The model.
    pub model: CurveMetrics,
    /// The Gaussian processes, which are the strongest baseline.
    pub statistical: CurveMetrics,
}

/// Errors of all models on one case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CaseErrors {
    /// Name of the case.
    pub name: String,
    /// Whether the vehicles neither hook nor stay together.
    pub clean: bool,
    /// Name of its cluster.
    pub cluster: String,
    /// The model.
    pub model: PointErrors,
    /// The classic pulse.
    pub pulse: PointErrors,
    /// The nearest training case.
    pub nearest: PointErrors,
    /// The Gaussian processes.
    pub statistical: PointErrors,
}

/// A model's metrics beside those of the baselines.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Evaluation {
    /// Name of the model in tables.
    pub model: String,
    /// The columns of a scenario that model and baselines used.
    pub columns: ColumnSet,
    /// Number of training cases.
    pub n_train: usize,
    /// Metrics of the model.
    #[serde(flatten)]
    pub metrics: ForceMetrics,
    /// Metrics of the model by where the cases lie.
    pub domain: DomainMetrics,
    /// Metrics of the baselines.
    pub baselines: BaselineMetrics,
    /// Metrics by cluster of the training cases. Clusters without a test case are left out.
    pub clusters: Vec<ClusterMetrics>,
    /// Errors of each case.
    pub cases: Vec<CaseErrors>,
    /// Test cases that a baseline cannot predict, with the reason. Its prediction there is no force.
    pub problems: Vec<String>,
}
