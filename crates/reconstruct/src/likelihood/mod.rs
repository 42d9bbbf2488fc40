//! How well a motion goes with the evidence.

mod discrepancy;
mod draw;
mod fit;
mod onset;
mod target;
mod terms;
mod track;

pub use discrepancy::Discrepancy;
pub use fit::EvidenceFit;
pub use target::ReconstructionTarget;
pub use terms::EvidenceTerm;
