//! How well reconstructions do on staged collisions, of which the truth is known: what is left of the
//! evidence, how the estimates score against the truth, and their summary over many cases.

mod estimates;
mod known;
mod pair_evidence;
mod recorded_car;
mod scores;
mod staged;
mod summary;

pub use estimates::{
    EstimatedQuantity, MethodEstimates, QuantityDistribution, ReconstructionMethod, SCORED,
};
pub use known::KnownEvidence;
pub use pair_evidence::{PairEvidence, PairEvidenceError};
pub use scores::{CaseScore, ScoredQuantity};
pub use staged::{StagedCollisions, StagedSplit, TrueQuantities};
pub use summary::{MethodSummary, QuantitySummary, SUFFICIENT_ESS};
