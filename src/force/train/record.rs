//! What a training of the force network records beside what every training does.

use serde::{Deserialize, Serialize};

use crate::force::train::{LossTerms, VarianceFactors};
use crate::learning::{CaseId, EpochDetail, NamedLoss, TrainingRecord};

/// What only the force network records of an epoch.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ForceEpoch {
    /// Losses over the cases learned from, while the weights changed.
    pub train: LossTerms,
    /// Losses over the validation cases at the end of the epoch; all zero without validation cases.
    pub validation: LossTerms,
}

/// What only the force network records of its training.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ForceTraining {
    /// Cases that decided when to stop. They are not among those learned from.
    pub validation: Vec<CaseId>,
    /// The epoch whose weights these are, counted from 1.
    pub best_epoch: usize,
    /// Factors on the variances, from the calibration on training cases.
    pub variance_factors: VarianceFactors,
}

/// How a force model came to be; saved in the model.
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
