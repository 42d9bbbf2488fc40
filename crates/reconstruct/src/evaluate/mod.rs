//! How well reconstructions do on staged collisions, of which the truth is known: what is left of the
//! evidence, how the estimates score against the truth, and their summary over many cases.

mod known;
mod scores;
mod speeds;
mod staged;
mod summary;

pub use known::KnownEvidence;
pub use scores::{CaseScore, ScoredQuantity};
pub use speeds::{EstimatedSpeed, ReconstructionMethod, SPEEDS, SpeedDistribution, SpeedEstimates};
pub use staged::{StagedCollisions, StagedSplit, TrueSpeeds};
pub use summary::{MethodSummary, QuantitySummary, SUFFICIENT_ESS};
