//! What a training leaves behind besides weights: on what, how, and how it went.

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::data::{Split, split};
use crate::force::input::hex;
use crate::force::train::{LossTerms, VarianceFactors};
use crate::force::{ForceCase, ForceError};

/// Fewest cases to train on: below, a fold of the crush model has no case of each kind.
const LEAST_CASES: usize = 8;

/// A case by name and content.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CaseId {
    /// Its name in its data set.
    pub name: String,
    /// See [`ForceCase::digest`].
    pub digest: String,
}

/// The cases of a training, already split.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TrainingSet {
    /// What a person calls the data.
    pub name: String,
    /// To learn from.
    pub train: Vec<ForceCase>,
    /// Kept apart for the test: only their names are known to the training.
    pub test: Vec<CaseId>,
}

/// One epoch.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EpochRecord {
    /// From 1.
    pub epoch: usize,
    /// Over the cases learned from, while the weights changed.
    pub train: LossTerms,
    /// Over the validation cases at its end; all zero without validation cases.
    pub validation: LossTerms,
    /// η at its end.
    pub learning_rate: f64,
    /// Longest gradient before clipping.
    pub gradient_norm: f64,
    /// How long it took.
    pub seconds: f64,
}

/// How a model came to be; saved in it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrainingRecord {
    /// Version of this program.
    pub version: String,
    /// What the data were called.
    pub data: String,
    /// SHA-256 over the digests of the cases learned from.
    pub data_digest: String,
    /// All draws come from it.
    pub seed: u64,
    /// Cases learned from, without those for validation.
    pub train: Vec<CaseId>,
    /// Cases that decided when to stop.
    pub validation: Vec<CaseId>,
    /// Cases kept apart.
    pub test: Vec<CaseId>,
    /// Epoch whose weights these are, from 1.
    pub best_epoch: usize,
    /// Factors on the variances, from calibration on training cases.
    pub variance_factors: VarianceFactors,
    /// Every epoch.
    pub history: Vec<EpochRecord>,
}

impl CaseId {
    /// Of a case.
    pub fn of(case: &ForceCase) -> Self {
        Self { name: case.name.clone(), digest: case.digest.clone() }
    }
}

impl TrainingSet {
    /// Splits cases by seed, see [`split`].
    ///
    /// - `extra`: cases of other sets, all to learn from.
    ///
    /// # Errors
    /// [`ForceError::TooFewCases`].
    pub fn new(
        name: impl Into<String>,
        cases: &[ForceCase],
        extra: &[ForceCase],
        (seed, test_share): (u64, f64),
    ) -> Result<Self, ForceError> {
        let Split { train, test } = split(cases, seed, test_share);
        let of = |indices: Vec<usize>| indices.into_iter().filter_map(|idx| cases.get(idx));
        let test: Vec<CaseId> = of(test).map(CaseId::of).collect();
        // A case that is in both sets must not come in by the back door.
        let is_new = |case: &&ForceCase| test.iter().all(|id| id.digest != case.digest);
        let extra = extra.iter().filter(is_new);
        let train: Vec<ForceCase> = of(train).chain(extra).cloned().collect();
        if train.len() < LEAST_CASES {
            return Err(ForceError::TooFewCases { n_cases: train.len(), least: LEAST_CASES });
        }
        Ok(Self { name: name.into(), train, test })
    }

    /// SHA-256 over the digests of the cases to learn from.
    pub fn digest(&self) -> String {
        let mut hash = Sha256::new();
        for case in &self.train {
            hash.update(case.digest.as_bytes());
        }
        hex(&hash.finalize())
    }
}
