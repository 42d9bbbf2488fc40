//! What a training of the response network begins with.

use serde::{Deserialize, Serialize};

use impactlab_core::data::DatasetKind;

/// The initial weights and the data of a training of the response network.
#[derive(
    Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, strum::VariantArray,
)]
pub enum TrainingMode {
    /// Fine-tune the shipped pre-trained network on trajectories.
    #[default]
    FineTuneShipped,
    /// Fine-tune the current model on trajectories.
    FineTuneCurrent,
    /// Tell the current model, which knows how cars differ, trajectories of one: seconds.
    Condition,
    /// Train a network with random initial weights on trajectories alone.
    FromScratch,
    /// Pre-train a network with random initial weights on simulations.
    Pretrain,
}

impl TrainingMode {
    /// All modes.
    pub const ALL: &'static [Self] = <Self as strum::VariantArray>::VARIANTS;

    /// Returns the name of the mode, shown to the user.
    pub fn label(self) -> &'static str {
        match self {
            Self::FineTuneShipped => "fine-tune the shipped pre-trained network",
            Self::FineTuneCurrent => "fine-tune the current model",
            Self::Condition => "fit the current model to one car (seconds)",
            Self::FromScratch => "train a new network on trajectories alone",
            Self::Pretrain => "pre-train a new network on simulations",
        }
    }

    /// Whether a training in this mode can learn from a log of one impact.
    pub fn takes_log(self) -> bool {
        self != Self::Pretrain
    }

    /// Returns the kinds of data sets from which a training in this mode can learn.
    pub fn data_kinds(self) -> &'static [DatasetKind] {
        match self {
            Self::FineTuneShipped | Self::FineTuneCurrent | Self::Condition | Self::FromScratch => {
                &[DatasetKind::Trajectory]
            }
            Self::Pretrain => &[DatasetKind::Trajectory, DatasetKind::Force],
        }
    }
}
