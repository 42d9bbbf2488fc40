//! The questions about the networks, which the panels of trainings, evaluations and comparisons edit.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::app::network::TrainingMode;
use impactlab_study::{
    CompareRequest, EvaluateForceRequest, EvaluatedCases, FineTuneRequest, ModelChoice,
    TrainForceRequest,
};

/// The questions about the networks, which are of no variant. Their models are those in use when they are
/// asked, and their vehicle is the one that is simulated. Their data set is the one that they name if it is
/// open, else the first one that is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct NetworkQuestions {
    /// The training of the force network.
    pub train_force: TrainForceRequest,
    /// Whether it learns from all cases of the other open force data sets too.
    pub use_others: bool,
    /// The training of the response network. Pre-training shares its data set and its settings.
    pub fine_tune: FineTuneRequest,
    /// From which weights and data it learns.
    pub mode: TrainingMode,
    /// A log of one impact, open as a file, to learn from instead of a data set.
    pub log: Option<PathBuf>,
    /// The file with the contact force of the log; `None` estimates it from the motion.
    pub log_force: Option<PathBuf>,
    /// Whether nothing was struck in the log, as in a test drive.
    pub log_is_without_impact: bool,
    /// Angle of the steering wheel of the log over that of the road wheels.
    pub log_steering_ratio: Option<f64>,
    /// The comparison of response models. The evaluation of the current one shares its data set, its seed
    /// and what happens to cases that cannot be used.
    pub compare: CompareRequest,
    /// The cases on which the current response model is evaluated.
    pub response_cases: EvaluatedCases,
    /// The evaluation of the current force model.
    pub evaluate_force: EvaluateForceRequest,
}

impl Default for NetworkQuestions {
    fn default() -> Self {
        let evaluate_force = EvaluateForceRequest::new(ModelChoice::default(), "");
        Self {
            train_force: TrainForceRequest::default(),
            use_others: false,
            fine_tune: FineTuneRequest::default(),
            mode: TrainingMode::default(),
            log: None,
            log_force: None,
            log_is_without_impact: false,
            log_steering_ratio: None,
            compare: CompareRequest::new(""),
            response_cases: EvaluatedCases::default(),
            evaluate_force: EvaluateForceRequest { for_figures: true, ..evaluate_force },
        }
    }
}
