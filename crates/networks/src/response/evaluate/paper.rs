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
}

/// Average errors of [`PitPinnPaper`](impactlab_core::bibliography::PitPinnPaper). They were measured on other
/// data, against a 4DOF model with errors: to be shown beside metrics of this program, never as such.
const PAPER_METRICS: [PaperMetrics; 4] = [
    PaperMetrics { kind: MotionModelKind::Untuned, trajectories: None, average_error_m: 35.20 },
    PaperMetrics { kind: MotionModelKind::Network, trajectories: Some(5), average_error_m: 14.13 },
    PaperMetrics { kind: MotionModelKind::Network, trajectories: Some(20), average_error_m: 10.47 },
    PaperMetrics { kind: MotionModelKind::Plain, trajectories: None, average_error_m: 8.25 },
];

/// The metrics that the paper prints for a model, if it has such a model.
pub fn paper_metrics(kind: MotionModelKind, trajectories: usize) -> Option<PaperMetrics> {
    PAPER_METRICS
        .into_iter()
        .find(|figure| figure.kind == kind && figure.trajectories.is_none_or(|n| n == trajectories))
}
