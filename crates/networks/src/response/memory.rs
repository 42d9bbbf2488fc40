//! The memory that the settings of the response network ask for.

use crate::learning::{LearningError, MAX_MEMORY_BYTES, check_memory, sum};
use crate::response::{N_FEATURES, ResponseCase, ResponseConfig};

/// Bytes of a number of the network.
const NUMBER_BYTES: u64 = 8;

/// Copies of each number that a step of the training holds: values, gradients and intermediate
/// results, each for a motion and for the mirrored one.
const N_COPIES: u64 = 12;

/// Memory of an instant of a simulated motion with its features and effects, bytes.
const INSTANT_BYTES: u64 = 2048;

/// Instants of a simulated motion.
const N_INSTANTS: usize = 400;

/// Memory of an instant of a recorded motion while it is learned from, bytes: measured on a fleet.
const RECORDED_INSTANT_BYTES: u64 = 2560;

/// How many trainings on as many motions as these have room beside each other, one at least.
pub(crate) fn n_trainings_in_memory(cases: &[ResponseCase]) -> usize {
    let n_instants = cases.iter().map(|case| case.inputs.len() as u64).sum::<u64>().max(1);
    let n = MAX_MEMORY_BYTES / n_instants.saturating_mul(RECORDED_INSTANT_BYTES);
    usize::try_from(n).unwrap_or(usize::MAX).max(1)
}

impl ResponseConfig {
    /// Checks the memory of a training.
    ///
    /// # Errors
    /// [`LearningError::TooMuchMemory`].
    pub(crate) fn check_memory(&self) -> Result<(), LearningError> {
        let Self { network, pretraining, single_steps, rollouts, physics, .. } = self;
        let sizes = [pretraining.motions, N_INSTANTS];
        check_memory("pretraining.motions", INSTANT_BYTES, &sizes)?;
        let hidden = network.encoder.last().copied().unwrap_or(0);
        let n_per_instant = sum(network.encoder.iter().chain(&network.trunk).copied().chain([
            N_FEATURES,
            hidden.saturating_mul(4),
            network.components.saturating_mul(24),
        ]));
        let bytes = NUMBER_BYTES * N_COPIES;
        let longest = rollouts.lengths.iter().copied().max().unwrap_or(0);
        for (what, n, n_steps) in [
            (
                "single_steps.batch_instants × the widths of the network",
                single_steps.batch_instants,
                1,
            ),
            ("physics.batch_instants × the widths of the network", physics.batch_instants, 1),
            (
                "rollouts.batch_windows × rollouts.lengths × the widths of the network",
                rollouts.batch_windows,
                longest,
            ),
        ] {
            check_memory(what, bytes, &[n, n_steps, n_per_instant])?;
        }
        Ok(())
    }
}
