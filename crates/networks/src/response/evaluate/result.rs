//! What a comparison finds, as it is written to and read from `comparison.json`.

use std::path::Path;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::learning::LearningError;
use crate::response::evaluate::compare::CaseClusters;
use crate::response::evaluate::{
    ComparisonSettings, MotionCaseMetrics, MotionMetrics, MotionModelKind,
};
use crate::response::{ResponseCase, STEP_S};
use impactlab_core::collision::Footprint;
use impactlab_core::collision::ImpulseClusters;
use impactlab_core::data::{MAX_RESULTS_BYTES, read_bytes};
use impactlab_core::vehicle::VehicleState;

/// Between the points of the paths of a comparison, s.
pub const PATH_STEP_S: f64 = 0.1;
/// Decimals that are kept of them: tenths of a millimetre.
const PATH_UNIT: f64 = 1e4;

/// A model with its metrics over all trajectories.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ComparedModel {
    /// Such as `PINN`.
    pub name: String,
    /// Its kind.
    pub kind: MotionModelKind,
    /// Trajectories it was fine-tuned on; 0 for none.
    pub trajectories: usize,
    /// Over all trajectories asked about.
    #[serde(flatten)]
    pub metrics: MotionMetrics,
    /// Mean average error of each choice of the fine-tune trajectories, m.
    pub average_error_by_choice_m: Vec<f64>,
    /// Seconds that a training took, mean over the choices.
    pub training_s: f64,
}

/// A model on one trajectory.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ComparedCase {
    /// Name of the trajectory.
    pub case: String,
    /// Its cluster by impulse.
    pub cluster: usize,
    /// Whether a wheel is braked, dragged or locked.
    #[serde(default)]
    pub is_braked: bool,
    /// The model.
    pub model: String,
    /// Its kind.
    pub kind: MotionModelKind,
    /// Trajectories it was fine-tuned on.
    pub trajectories: usize,
    /// Which choice of them.
    pub choice: u64,
    /// The metrics of the model on the trajectory.
    #[serde(flatten)]
    pub metrics: MotionCaseMetrics,
    /// Where it says the vehicle goes: [X, Y, ψ] every [`PATH_STEP_S`], m and rad.
    pub path: Vec<[f64; 3]>,
}

/// The models on a group of trajectories: a cluster by impulse, or those of a kind of ending.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ClusterRow {
    /// Such as `C0`, by rising impulse, or `coasting`.
    pub name: String,
    /// Trajectories in it.
    pub n: usize,
    /// Impulse at the centre of a cluster, N s.
    pub impulse_n_s: Option<f64>,
    /// Each model on them.
    pub models: Vec<ClusterModel>,
}

/// A model on one cluster.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ClusterModel {
    /// Such as `PINN`.
    pub name: String,
    /// Trajectories it was fine-tuned on; 0 for none.
    pub trajectories: usize,
    /// Over the trajectories of the cluster.
    #[serde(flatten)]
    pub metrics: MotionMetrics,
}

/// A trajectory asked about.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TestCase {
    /// Its name.
    pub name: String,
    /// Its cluster by impulse.
    pub cluster: usize,
    /// Whether it turns by 90° or more.
    pub spins: bool,
    /// Outline of the vehicle.
    pub footprint: Footprint,
    /// The recorded path: [X, Y, ψ] every [`PATH_STEP_S`], m and rad.
    pub path: Vec<[f64; 3]>,
}

/// All models on the same trajectories.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Comparison {
    /// What the data are called.
    pub data: String,
    /// Seed of the split and of the first choice.
    pub seed: u64,
    /// Choices for each number of trajectories.
    pub n_choices: u64,
    /// The trajectories asked about.
    pub test: Vec<TestCase>,
    /// The models.
    pub models: Vec<ComparedModel>,
    /// The models on each cluster of trajectories.
    pub clusters: Vec<ClusterRow>,
    /// The models on the trajectories of each kind of ending; none where all are of one kind.
    #[serde(default)]
    pub endings: Vec<ClusterRow>,
    /// Each model on each trajectory.
    pub cases: Vec<ComparedCase>,
}

impl Comparison {
    pub(super) fn new(
        name: &str,
        settings: &ComparisonSettings,
        test: &[&ResponseCase],
        clusters: &CaseClusters,
        cases: Vec<ComparedCase>,
        times: &[(MotionModelKind, usize, f64)],
    ) -> Self {
        let mut kinds: Vec<(MotionModelKind, usize)> =
            cases.iter().map(|row| (row.kind, row.trajectories)).collect();
        kinds.sort_by_key(|(kind, n)| (*n, *kind));
        kinds.dedup();
        let rows_of = |kind: MotionModelKind, n: usize| -> Vec<&ComparedCase> {
            cases.iter().filter(|row| row.kind == kind && row.trajectories == n).collect()
        };
        let model = |&(kind, n): &(MotionModelKind, usize)| {
            let rows = rows_of(kind, n);
            let metrics: Vec<&MotionCaseMetrics> = rows.iter().map(|row| &row.metrics).collect();
            let mut choices: Vec<u64> = rows.iter().map(|row| row.choice).collect();
            choices.sort_unstable();
            choices.dedup();
            let mean = |choice: &u64| {
                let chosen = rows.iter().filter(|row| row.choice == *choice);
                let errors: Vec<f64> =
                    chosen.map(|row| row.metrics.error.average_error_m).collect();
                errors.iter().sum::<f64>() / errors.len().max(1) as f64
            };
            let of_times = times.iter().filter(|(k, m, _)| (*k, *m) == (kind, n));
            let seconds: Vec<f64> = of_times.map(|(_, _, seconds)| *seconds).collect();
            ComparedModel {
                name: kind.label().to_owned(),
                kind,
                trajectories: n,
                metrics: MotionMetrics::from_cases(&metrics),
                average_error_by_choice_m: choices.iter().map(mean).collect(),
                training_s: seconds.iter().sum::<f64>() / seconds.len().max(1) as f64,
            }
        };
        let models: Vec<ComparedModel> = kinds.iter().map(model).collect();
        let n_clusters = clusters.clusters.as_ref().map_or(1, ImpulseClusters::n_clusters);
        let models_on = |is_in_group: &dyn Fn(&ComparedCase) -> bool| -> Vec<ClusterModel> {
            let of_model = |&(kind, n): &(MotionModelKind, usize)| {
                let rows = rows_of(kind, n);
                let metrics: Vec<&MotionCaseMetrics> =
                    rows.iter().filter(|row| is_in_group(row)).map(|row| &row.metrics).collect();
                let metrics = MotionMetrics::from_cases(&metrics);
                ClusterModel { name: kind.label().to_owned(), trajectories: n, metrics }
            };
            kinds.iter().map(of_model).collect()
        };
        let cluster = |cluster: usize| ClusterRow {
            name: ImpulseClusters::label(cluster),
            n: clusters.of_case.iter().filter(|number| **number == cluster).count(),
            impulse_n_s: clusters.clusters.as_ref().and_then(|fitted| fitted.impulse_n_s(cluster)),
            models: models_on(&|row| row.cluster == cluster),
        };
        let ending = |(name, is_braked): (&str, bool)| ClusterRow {
            name: name.to_owned(),
            n: test.iter().filter(|case| case.is_braked() == is_braked).count(),
            impulse_n_s: None,
            models: models_on(&|row| row.is_braked == is_braked),
        };
        let mut endings: Vec<ClusterRow> =
            [("coasting", false), ("braked", true)].map(ending).into();
        if endings.iter().any(|row| row.n == 0) {
            endings.clear();
        }
        let tested = test.iter().zip(&clusters.of_case);
        Self {
            data: name.to_owned(),
            seed: settings.seed,
            n_choices: settings.n_choices,
            test: tested.map(|(case, &cluster)| TestCase::new(case, cluster)).collect(),
            models,
            clusters: (0..n_clusters).map(cluster).filter(|row| row.n > 0).collect(),
            endings,
            cases,
        }
    }
}

impl Comparison {
    /// Reads a `comparison.json`.
    ///
    /// # Errors
    /// [`LearningError::Data`] if the file cannot be read or has more than [`MAX_RESULTS_BYTES`],
    /// [`LearningError::File`] with line and column if it is no comparison.
    pub fn load(path: &Path) -> Result<Self, LearningError> {
        let bytes = read_bytes(path, MAX_RESULTS_BYTES)
            .map_err(|error| LearningError::Data(Box::new(error)))?;
        serde_json::from_slice(&bytes).map_err(|error| LearningError::File {
            path: path.to_owned(),
            reason: error.to_string(),
        })
    }
}

impl TestCase {
    fn new(case: &ResponseCase, cluster: usize) -> Self {
        Self {
            name: case.name.clone(),
            cluster,
            spins: case.spins,
            footprint: Footprint::from(&case.vehicle.geometry),
            path: path_of(&case.states),
        }
    }
}

/// [X, Y, ψ] every [`PATH_STEP_S`], as long as they are finite.
pub(super) fn path_of(states: &[VehicleState<f64>]) -> Vec<[f64; 3]> {
    let stride = (PATH_STEP_S / STEP_S).round() as usize;
    let rounded = |value: f64| (value * PATH_UNIT).round() / PATH_UNIT;
    let pose = |state: &VehicleState<f64>| [state.x_m, state.y_m, state.yaw_rad].map(rounded);
    let is_finite = |pose: &[f64; 3]| pose.iter().all(|value| value.is_finite());
    states.iter().step_by(stride).map(pose).take_while(is_finite).collect()
}
