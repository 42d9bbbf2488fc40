//! What a training is asked to do.

use std::path::PathBuf;

/// How to train.
///
/// - `C`: sizes, weights and rates of the network and its training.
#[derive(Debug, Clone, PartialEq)]
pub struct TrainSettings<C> {
    /// Sizes, weights and rates.
    pub config: C,
    /// The seed of every random number of the training.
    pub seed: u64,
    /// The file in which the training is saved every few epochs, if any.
    pub checkpoint: Option<PathBuf>,
    /// Whether to go on from that file, if it is there.
    pub resume: bool,
}

impl<C> TrainSettings<C> {
    /// A training that is not saved on the way.
    pub fn unsaved(config: C, seed: u64) -> Self {
        Self { config, seed, checkpoint: None, resume: false }
    }
}
