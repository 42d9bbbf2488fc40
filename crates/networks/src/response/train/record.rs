//! What a training of the response network records beside what every training does.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::learning::{EpochDetail, NamedLoss, PhysicsBalance, TrainingRecord};
use crate::response::ResponseLossTerms;

/// The part of a training to which an epoch belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ResponseStage {
    /// Training on simulations.
    Pretraining,
    /// Training on single steps of trajectories.
    SingleSteps,
    /// Training on rollouts.
    Rollouts {
        /// Steps of each rollout.
        length: usize,
    },
}

/// What only the response network records of an epoch.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ResponseEpoch {
    /// The part of the training to which the epoch belongs.
    pub stage: ResponseStage,
    /// Mean over the batches of the epoch, while the weights changed.
    pub loss: ResponseLossTerms,
    /// Weight λ_physics of the physics.
    pub physics_weight: f64,
    /// Share of the data in the loss: `L_data/(L_data + λ L_physics)`.
    pub balance: f64,
}

/// What only the response network records of its training.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct ResponseTraining {
    /// Simulated motions of the pre-training; 0 without a pre-training.
    pub n_simulated: usize,
    /// Whether the uncertainty is that of the model from which the training started, nowhere below
    /// the usual one, because there were no two trajectories to calibrate it on.
    #[serde(default)]
    pub keeps_latents: bool,
}

/// How a response model came to be; saved in the model.
pub type ResponseRecord = TrainingRecord<ResponseEpoch, ResponseTraining>;

impl fmt::Display for ResponseStage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Pretraining => write!(f, "simulations"),
            Self::SingleSteps => write!(f, "single steps"),
            Self::Rollouts { length } => write!(f, "rollouts of {length} steps"),
        }
    }
}

impl EpochDetail for ResponseEpoch {
    fn stage(&self) -> Option<String> {
        Some(self.stage.to_string())
    }

    fn losses(&self) -> Vec<NamedLoss> {
        let named = |(name, train)| NamedLoss { name, train, validation: None };
        self.loss.named().map(named).to_vec()
    }

    fn physics(&self) -> Option<PhysicsBalance> {
        Some(PhysicsBalance { weight: self.physics_weight, data_share: self.balance })
    }
}
