//! What can go wrong between a trajectory and a prediction.

use std::path::PathBuf;

use crate::data::TomlError;
use crate::nn::NnError;

/// A response model cannot be trained, opened or asked.
#[derive(Debug, thiserror::Error)]
pub enum ResponseError {
    /// Nothing to learn from.
    #[error("no trajectory to learn from")]
    NoCases,
    /// Fewer trajectories than asked for.
    #[error("{n_cases} trajectories to learn from, expected {wanted}")]
    TooFewCases {
        /// How many there are.
        n_cases: usize,
        /// How many were asked for.
        wanted: usize,
    },
    /// A setting outside its range.
    #[error("{name} is {value}, expected {expected}")]
    Setting {
        /// Section and name, as in the file.
        name: &'static str,
        /// Its value.
        value: String,
        /// The range, in words.
        expected: &'static str,
    },
    /// A configuration file cannot be read.
    #[error(transparent)]
    ConfigFile(#[from] TomlError),
    /// A comparison cannot be read.
    #[error("{}: {reason}", path.display())]
    ComparisonFile {
        /// The file.
        path: PathBuf,
        /// Why, with line and column.
        reason: String,
    },
    /// A checkpoint was written by another training.
    #[error("{}: the training to resume had another {what}", path.display())]
    OtherTraining {
        /// The checkpoint.
        path: PathBuf,
        /// What differs: configuration, seed, trajectories.
        what: &'static str,
    },
    /// The loss is not a number any more.
    #[error("the loss is {loss} in epoch {epoch}: lower the learning rate")]
    Diverged {
        /// The loss.
        loss: f64,
        /// In which epoch, from 1.
        epoch: usize,
    },
    /// Network or model file.
    #[error(transparent)]
    Network(#[from] NnError),
}

impl From<candle_core::Error> for ResponseError {
    fn from(error: candle_core::Error) -> Self {
        Self::Network(error.into())
    }
}
