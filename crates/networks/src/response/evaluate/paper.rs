//! What the paper printed, for a column of its own: measured on other data.

use crate::response::evaluate::MotionModelKind;

/// The metrics that the paper gives of a model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PaperMetrics {
    /// The model.
    pub kind: MotionModelKind,
    /// Trajectories it was fine-tuned on, where the paper has several of a kind.
    pub trajectories: Option<usize>,
    /// Average error, m.
    pub average_error_m: f64,
    /// Time per step, ms.
    pub time_per_step_ms: f64,
}

/// Average errors and times per step of [`PitPinnPaper`](impactlab_core::bibliography::PitPinnPaper). They were
/// measured on other data, on another machine, against a 4DOF model with errors: to be shown beside
/// metrics of this program, never as such.
const PAPER_METRICS: [PaperMetrics; 4] = [
    PaperMetrics {
        kind: MotionModelKind::Untuned,
        trajectories: None,
        average_error_m: 35.20,
        time_per_step_ms: 3.21,
    },
    PaperMetrics {
        kind: MotionModelKind::Network,
        trajectories: Some(5),
        average_error_m: 14.13,
        time_per_step_ms: 10.75,
    },
    PaperMetrics {
        kind: MotionModelKind::Network,
        trajectories: Some(20),
        average_error_m: 10.47,
        time_per_step_ms: 10.78,
    },
    PaperMetrics {
        kind: MotionModelKind::Plain,
        trajectories: None,
        average_error_m: 8.25,
        time_per_step_ms: 7.45,
    },
];

/// The metrics that the paper prints for a model, if it has such a model.
pub fn paper_metrics(kind: MotionModelKind, trajectories: usize) -> Option<PaperMetrics> {
    PAPER_METRICS
        .into_iter()
        .find(|figure| figure.kind == kind && figure.trajectories.is_none_or(|n| n == trajectories))
}
