//! The epochs of a training, one after the other, with reports and checkpoints.

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::learning::{EpochReport, LearningError, TrainingFile, TrainingProgress, TrainingReport};
use crate::nn::{Checkpoint, NnError};

/// A training that goes on epoch by epoch.
pub trait EpochLoop {
    /// What can go wrong in an epoch.
    type Error: From<LearningError>;

    /// Passes once over the cases and says how it went; `None` if there is no epoch left.
    ///
    /// # Errors
    /// A loss that is not finite, and failures of the network.
    fn epoch(&mut self) -> Result<Option<EpochReport>, Self::Error>;

    /// Whether the state after the latest epoch is to be saved, as it is after the last one.
    fn is_checkpoint_due(&self) -> bool;

    /// Puts the state into a checkpoint, from which the training can go on.
    ///
    /// # Errors
    /// [`NnError`] if a tensor cannot be copied or something cannot be written as JSON.
    fn put(&self, file: &mut Checkpoint) -> Result<(), NnError>;
}

/// Runs all epochs that are left, until the callback breaks.
///
/// # Errors
/// As for [`EpochLoop::epoch`], and of a checkpoint that cannot be written.
pub fn run_epochs<L: EpochLoop, C: PartialEq + Serialize + DeserializeOwned>(
    training: &mut L,
    file: &TrainingFile<C>,
    report: &mut TrainingProgress<'_>,
) -> Result<(), L::Error> {
    while let Some(epoch) = training.epoch()? {
        let flow = report(&TrainingReport::Epoch(epoch));
        if flow.is_break() || training.is_checkpoint_due() {
            file.write(|file| training.put(file))?;
        }
        if flow.is_break() {
            return Ok(());
        }
    }
    Ok(())
}
