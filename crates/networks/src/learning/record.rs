//! What a training leaves behind besides weights: what it learned from, how, and how it went.

use serde::{Deserialize, Serialize};

use crate::learning::{
    CaseId, EpochSummary, NamedLoss, PhysicsBalance, TrainSettings, TrainingCase, TrainingSet,
};

/// What only one kind of network records of an epoch.
pub trait EpochDetail {
    /// The part of the training to which the epoch belongs, if there are several.
    fn stage(&self) -> Option<String> {
        None
    }

    /// Every loss term by its name, the one that is minimised first.
    fn losses(&self) -> Vec<NamedLoss>;

    /// How data and physics balance in the loss, where physics has a weight that changes.
    fn physics(&self) -> Option<PhysicsBalance> {
        None
    }
}

/// One epoch.
///
/// - `E`: what only this kind of network records, an [`EpochDetail`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct EpochRecord<E> {
    /// Number of the epoch over all stages, counted from 1.
    pub epoch: usize,
    /// Losses, and what else this kind of network records.
    #[serde(flatten)]
    pub detail: E,
    /// Learning rate η of the optimiser at the end of the epoch.
    pub learning_rate: f64,
    /// Norm of the longest gradient before clipping.
    pub gradient_norm: f64,
    /// Duration of the epoch, s; `None` where only the model is left of the training. It is no part
    /// of a model file, whose bytes would depend on the clock otherwise; files of earlier versions
    /// have it. A checkpoint keeps it beside the history.
    #[serde(default, skip_serializing)]
    pub seconds: Option<f64>,
}

impl<E: EpochDetail> EpochRecord<E> {
    /// What a progress bar or a plot shows of the epoch, the same for every kind of network.
    pub fn summary(&self) -> EpochSummary {
        EpochSummary {
            epoch: self.epoch,
            stage: self.detail.stage(),
            losses: self.detail.losses(),
            physics: self.detail.physics(),
            learning_rate: self.learning_rate,
            gradient_norm: self.gradient_norm,
            seconds: self.seconds,
        }
    }
}

/// How a model came to be; saved in the model.
///
/// - `E`: what only this kind of network records of an epoch;
/// - `T`: what only this kind of network records of its training.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrainingRecord<E, T> {
    /// Version of this program, without the digest of its source: a model file has the same bytes as
    /// long as data, settings and training are the same.
    pub version: String,
    /// What the data were called.
    pub data: String,
    /// SHA-256 over the digests of the cases learned from.
    pub data_digest: String,
    /// The seed of every random number of the training.
    pub seed: u64,
    /// Cases learned from; none for a model that learned from simulations alone.
    pub train: Vec<CaseId>,
    /// Cases kept apart for the test.
    pub test: Vec<CaseId>,
    /// What only this kind of network records.
    #[serde(flatten)]
    pub detail: T,
    /// Every epoch.
    pub history: Vec<EpochRecord<E>>,
}

impl<E, T> TrainingRecord<E, T> {
    /// The record of a training on a set, all of whose cases were learned from.
    pub fn new<C: TrainingCase + Clone, S>(
        set: &TrainingSet<C>,
        settings: &TrainSettings<S>,
        detail: T,
        history: Vec<EpochRecord<E>>,
    ) -> Self {
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            data: set.name.clone(),
            data_digest: set.digest(),
            seed: settings.seed,
            train: set.train.iter().map(CaseId::from_case).collect(),
            test: set.test.clone(),
            detail,
            history,
        }
    }
}
