//! Recorded pairs of vehicles that collide and push each other, and how far a forecast of both lies from
//! them.

mod record;

pub use record::{PairAttributes, PairCase, PairCaseError, PairRecords, RecordedContact};
