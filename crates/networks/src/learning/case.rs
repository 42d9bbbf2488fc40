//! A case that a network learns from, and how it is recognised later.

use serde::{Deserialize, Serialize};

use impactlab_core::numerics::sha256_hex;

/// A recorded case that a network learns from or is tested on.
pub trait TrainingCase {
    /// The name of the case in its data set.
    fn name(&self) -> &str;

    /// The SHA-256 in hex of its content: the same for the same content under another name.
    fn digest(&self) -> &str;

    /// Whether the case belongs to the ordinary ones. The others (impacts that hook, motions that
    /// spin) are rare, and a [`split`](crate::learning::split()) shares them out by themselves.
    fn is_ordinary(&self) -> bool;
}

impl<T: TrainingCase> TrainingCase for &T {
    fn name(&self) -> &str {
        T::name(self)
    }

    fn digest(&self) -> &str {
        T::digest(self)
    }

    fn is_ordinary(&self) -> bool {
        T::is_ordinary(self)
    }
}

/// A case by name and content.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CaseId {
    /// The name of the case in its data set.
    pub name: String,
    /// The digest of its content, see [`TrainingCase::digest`].
    pub digest: String,
}

impl CaseId {
    /// The identity of a case.
    pub fn from_case(case: &impl TrainingCase) -> Self {
        Self { name: case.name().to_owned(), digest: case.digest().to_owned() }
    }
}

/// The number of whole steps in a value, for [`content_digest`]: a file that is written again with
/// fewer digits, or read on another machine, keeps its digest.
pub fn n_steps(value: f64, step: f64) -> i64 {
    (value / step).round() as i64
}

/// The SHA-256 in hex of a sequence of numbers, each rounded by [`n_steps`].
pub fn content_digest(numbers: impl IntoIterator<Item = i64>) -> String {
    let bytes: Vec<u8> = numbers.into_iter().flat_map(i64::to_le_bytes).collect();
    sha256_hex([bytes.as_slice()])
}
