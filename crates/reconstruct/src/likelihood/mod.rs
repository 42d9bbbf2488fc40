//! How well a motion goes with the evidence. What an item says of a motion stands with the item
//! ([`evidence`](crate::evidence)).

mod comparison;
mod discrepancy;
mod draw;
mod fit;
mod onset;
mod target;
mod track;

pub use comparison::{ComparedBy, EvidenceTerm};
pub use discrepancy::Discrepancy;
pub use fit::EvidenceFit;
pub use target::ReconstructionTarget;

pub(crate) use comparison::{Compared, ComparedCar, Comparison, SINGLE_DEGREES_OF_FREEDOM};
pub(crate) use discrepancy::{PathResidual, student};
pub(crate) use onset::{NEVER_M, Onset};
pub(crate) use track::{Nearest, Track};
