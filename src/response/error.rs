//! What can go wrong between a trajectory and a prediction.

use crate::nn::NnError;

/// A response model cannot be trained or asked.
#[derive(Debug, thiserror::Error)]
pub enum ResponseError {
    /// Nothing to learn from.
    #[error("no trajectory to learn from")]
    NoCases,
    /// Network or model file.
    #[error(transparent)]
    Network(#[from] NnError),
}

impl From<candle_core::Error> for ResponseError {
    fn from(error: candle_core::Error) -> Self {
        Self::Network(error.into())
    }
}
