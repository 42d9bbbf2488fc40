//! The memory that the settings of the force network ask for.

use crate::force::{ForceConfig, NetworkConfig};
use crate::learning::{LearningError, check_memory, sum};
use impactlab_core::uncertainty::CURVE_N_INSTANTS;

/// Bytes of a number of the network.
const NUMBER_BYTES: u64 = 4;

/// Copies of each number that a step of the training holds: values, gradients and intermediate
/// results of the operations.
const N_COPIES: u64 = 6;

impl ForceConfig {
    /// Checks the memory of a training.
    ///
    /// - `n_cases`: the cases that it learns from.
    ///
    /// # Errors
    /// [`LearningError::TooMuchMemory`].
    pub(crate) fn check_memory(&self, n_cases: usize) -> Result<(), LearningError> {
        let network = &self.network;
        network.check_memory("cases", n_cases)?;
        let batch = self.training.batch_cases.min(n_cases);
        let bytes = NUMBER_BYTES * N_COPIES;
        let n_per_instant = sum(network.trunk.iter().copied().chain([
            network.position_channels,
            network.attention_channels.saturating_mul(4),
            network.encoder_branches.iter().map(|[.., last]| *last).fold(0, usize::saturating_add),
        ]));
        let what = "training.batch_cases × the widths of the network";
        check_memory(what, bytes, &[batch, CURVE_N_INSTANTS, n_per_instant])?;
        if !network.attention {
            return Ok(());
        }
        let n_seen = CURVE_N_INSTANTS.div_ceil(network.attention_stride.max(1));
        let sizes = [batch, network.attention_heads, CURVE_N_INSTANTS, n_seen];
        check_memory("training.batch_cases × network.attention_heads", bytes, &sizes)
    }
}

impl NetworkConfig {
    /// Checks the memory of the distributions of curves.
    ///
    /// - `what`: what each distribution belongs to, in words: `cases` or `variants`;
    /// - `n`: their number.
    ///
    /// # Errors
    /// [`LearningError::TooMuchMemory`].
    pub(crate) fn check_memory(&self, what: &str, n: usize) -> Result<(), LearningError> {
        let n_values = 2 * CURVE_N_INSTANTS + 1;
        let sizes = [n, self.components, self.factors.saturating_add(3), n_values];
        let what = match what {
            "cases" => "network.components × network.factors × the cases",
            _ => "network.components × network.factors × the contact points and bodies",
        };
        check_memory(what, NUMBER_BYTES * N_COPIES, &sizes)
    }
}
