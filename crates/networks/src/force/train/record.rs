//! The parts of the training record that are specific to the force network.

use serde::{Deserialize, Serialize};

use crate::force::train::{LossTerms, VarianceCalibration};
use crate::learning::{CaseId, EpochDetail, NamedLoss, TrainingRecord};

/// The part of the record of an epoch that is specific to the force network.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ForceEpoch {
    /// Losses over the cases that the network is fitted to, computed while the weights change.
    pub train: LossTerms,
    /// Losses over the validation cases at the end of the epoch; all are zero without validation
    /// cases.
    pub validation: LossTerms,
}

/// The part of the training record that is specific to the force network.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ForceTraining {
    /// Cases that decide when the training stops. The network is not fitted to them.
    pub validation: Vec<CaseId>,
    /// The epoch whose weights the model has, counted from 1; 0 for the weights before training.
    pub best_epoch: usize,
    /// Factors on the variances, from the calibration on training cases.
    pub variance_factors: VarianceCalibration,
}

/// The record of how a force model was trained; it is part of the model file.
pub type ForceRecord = TrainingRecord<ForceEpoch, ForceTraining>;

impl EpochDetail for ForceEpoch {
    fn losses(&self) -> Vec<NamedLoss> {
        let pairs = self.train.named().into_iter().zip(self.validation.named());
        let named = |((name, train), (_, validation))| NamedLoss {
            name,
            train,
            validation: Some(validation),
        };
        pairs.map(named).collect()
    }
}
