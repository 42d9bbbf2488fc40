//! What a training leaves behind besides weights: on what, how, and how it went.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::data::{Split, split};
use crate::force::CaseId;
use crate::nn::sha256_hex;
use crate::response::{ResponseCase, ResponseError, ResponseLossTerms};

/// Trajectories to fine-tune on, already chosen.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ResponseTrainingSet {
    /// What a person calls the data.
    pub name: String,
    /// To learn from.
    pub train: Vec<ResponseCase>,
    /// Kept apart for the test: only their names are known to the training.
    pub test: Vec<CaseId>,
}

/// What an epoch was part of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ResponseStage {
    /// On simulations.
    Pretraining,
    /// On single steps of trajectories.
    SingleSteps,
    /// On rollouts.
    Rollouts {
        /// Steps of each.
        length: usize,
    },
}

/// One epoch.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ResponseEpoch {
    /// From 1, over all stages.
    pub epoch: usize,
    /// What it was part of.
    pub stage: ResponseStage,
    /// Mean over its batches, while the weights changed.
    pub loss: ResponseLossTerms,
    /// λ_physics.
    pub physics_weight: f64,
    /// `L_data/(L_data + λ L_physics)`.
    pub balance: f64,
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
pub struct ResponseRecord {
    /// Version of this program.
    pub version: String,
    /// What the data were called.
    pub data: String,
    /// SHA-256 over the digests of the trajectories learned from.
    pub data_digest: String,
    /// All draws come from it.
    pub seed: u64,
    /// Simulated motions of the pre-training; 0 without.
    pub n_simulated: usize,
    /// Trajectories learned from; none for a model that is pre-trained alone.
    pub train: Vec<CaseId>,
    /// Trajectories kept apart.
    pub test: Vec<CaseId>,
    /// Every epoch.
    pub history: Vec<ResponseEpoch>,
    /// Whether the uncertainty is that of the model it started from, nowhere below the usual one, as
    /// there were no two trajectories to calibrate it on.
    #[serde(default)]
    pub keeps_latents: bool,
}

impl fmt::Display for ResponseStage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Pretraining => write!(f, "simulations"),
            Self::SingleSteps => write!(f, "single steps"),
            Self::Rollouts { length } => write!(f, "rollouts of {length} steps"),
        }
    }
}

impl ResponseTrainingSet {
    /// Splits trajectories by seed, see [`split`], and chooses some of those to learn from: those that
    /// spin and the others as they occur.
    ///
    /// - `n_trajectories`: how many; `None` for all that are not kept for the test;
    /// - `test_share`: 0 to 1;
    /// - `choice`: seed of the choice alone.
    ///
    /// # Errors
    /// [`ResponseError::NoCases`], [`ResponseError::TooFewCases`].
    pub fn choose(
        name: impl Into<String>,
        cases: &[ResponseCase],
        n_trajectories: Option<usize>,
        (seed, test_share, choice): (u64, f64, u64),
    ) -> Result<Self, ResponseError> {
        let Split { train, test } = split(cases, seed, test_share);
        let pick = |indices: &[usize]| -> Vec<&ResponseCase> {
            indices.iter().filter_map(|&idx| cases.get(idx)).collect()
        };
        let (train, test) = (pick(&train), pick(&test));
        let wanted = n_trajectories.unwrap_or(train.len());
        if train.is_empty() || wanted == 0 {
            return Err(ResponseError::NoCases);
        }
        if wanted > train.len() {
            return Err(ResponseError::TooFewCases { n_cases: train.len(), wanted });
        }
        Ok(Self {
            name: name.into(),
            train: chosen(&train, wanted, choice).into_iter().cloned().collect(),
            test: test.into_iter().map(case_id).collect(),
        })
    }

    /// Several sets as one, called after all of them.
    pub fn joined(sets: Vec<Self>) -> Self {
        let names: Vec<&str> = sets.iter().map(|set| set.name.as_str()).collect();
        let name = names.join(" and ");
        let mut joined = Self { name, ..Self::default() };
        for set in sets {
            joined.train.extend(set.train);
            joined.test.extend(set.test);
        }
        joined
    }

    /// SHA-256 over the digests of the trajectories to learn from.
    pub fn digest(&self) -> String {
        sha256_hex(self.train.iter().map(|case| case.digest.as_bytes()))
    }
}

/// Name and content of a trajectory.
pub(crate) fn case_id(case: &ResponseCase) -> CaseId {
    CaseId { name: case.name.clone(), digest: case.digest.clone() }
}

/// `n` of the cases by the hash of their names: the test part of a split, which takes from each
/// stratum its share, and from the rest where rounding leaves one short.
fn chosen<'a>(cases: &[&'a ResponseCase], n: usize, seed: u64) -> Vec<&'a ResponseCase> {
    let share = n as f64 / cases.len().max(1) as f64;
    let Split { test: mut taken, train: left } = split(cases, seed, share);
    taken.truncate(n);
    let missing = n - taken.len();
    taken.extend(left.into_iter().take(missing));
    taken.sort_unstable();
    taken.into_iter().filter_map(|idx| cases.get(idx).copied()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cases() -> Vec<ResponseCase> {
        let case = |i: usize| ResponseCase {
            name: format!("c{i:03}"),
            vehicle: crate::vehicle::Preset::Reference.parameters(),
            states: Vec::new(),
            inputs: Vec::new(),
            spins: i.is_multiple_of(4),
            digest: format!("{i}"),
        };
        (0..100).map(case).collect()
    }

    #[test]
    fn trajectories_are_chosen_as_they_occur_and_never_from_the_test() {
        let cases = cases();
        for (n, choice) in [(20, 0), (5, 1), (7, 2), (1, 3)] {
            let set =
                ResponseTrainingSet::choose("made", &cases, Some(n), (0, 0.25, choice)).unwrap();
            assert_eq!((set.train.len(), set.test.len()), (n, 25));
            let n_spin = set.train.iter().filter(|case| case.spins).count();
            assert!(n_spin.abs_diff(n / 4) <= 1, "{n_spin} of {n}");
            assert!(set.train.iter().all(|case| set.test.iter().all(|id| id.name != case.name)));
        }
        let of = |choice| {
            ResponseTrainingSet::choose("made", &cases, Some(20), (0, 0.25, choice)).unwrap()
        };
        assert_eq!(of(0), of(0));
        assert_ne!(of(0).digest(), of(1).digest());
        assert_eq!(of(0).test, of(1).test);
    }

    #[test]
    fn joined_sets_keep_what_was_chosen() {
        let of = |name: &str, choice| {
            ResponseTrainingSet::choose(name, &cases(), Some(10), (0, 0.25, choice)).unwrap()
        };
        let joined = ResponseTrainingSet::joined(vec![of("a", 0), of("b", 1)]);
        assert_eq!(
            (joined.name.as_str(), joined.train.len(), joined.test.len()),
            ("a and b", 20, 50)
        );
        let alone = of("a", 0);
        assert_eq!(ResponseTrainingSet::joined(vec![alone.clone()]), alone);
    }

    #[test]
    fn more_than_there_are_cannot_be_chosen() {
        let chosen = ResponseTrainingSet::choose("made", &cases(), Some(76), (0, 0.25, 0));
        let message = chosen.unwrap_err().to_string();
        assert_eq!(message, "75 trajectories to learn from, expected 76");
        assert!(ResponseTrainingSet::choose("made", &[], None, (0, 0.25, 0)).is_err());
    }
}
