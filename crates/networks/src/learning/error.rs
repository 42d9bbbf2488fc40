//! What can go wrong while a network learns, or while its files are read and written.

use std::path::PathBuf;

use crate::nn::NnError;
use impactlab_core::data::{DataError, TomlError};

/// A network cannot be trained, opened or asked.
#[derive(Debug, thiserror::Error)]
pub enum LearningError {
    /// Fewer cases than the training needs or was asked to learn from.
    #[error("{n_cases} cases to learn from, expected {least} or more")]
    TooFewCases {
        /// How many cases there are.
        n_cases: usize,
        /// How many it takes.
        least: usize,
    },
    /// Every case was learned from before.
    #[error(
        "every trajectory is one that the network has learned from already; it says nothing new"
    )]
    NothingNew,
    /// A setting outside its range.
    #[error("{name} is {value}, expected {expected}")]
    Setting {
        /// Section and name, as in the file.
        name: String,
        /// Its value.
        value: String,
        /// The range, in words.
        expected: String,
    },
    /// Settings and sizes ask for more memory than is meant for them.
    #[error("{what} take {gib:.1} GiB of memory, at most {limit_gib:.1} GiB are meant for it")]
    TooMuchMemory {
        /// The settings and sizes that are multiplied, in words.
        what: &'static str,
        /// The memory that they ask for, GiB.
        gib: f64,
        /// The largest memory, GiB.
        limit_gib: f64,
    },
    /// A file of settings cannot be read.
    #[error(transparent)]
    Toml(#[from] TomlError),
    /// A file cannot be opened or is too large.
    #[error(transparent)]
    Data(Box<DataError>),
    /// A file of results cannot be understood.
    #[error("{}: {reason}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// The reason, with the line.
        reason: String,
    },
    /// A file was read, but its contents cannot be used.
    #[error("{}: cannot be used as {what}", path.display())]
    InFile {
        /// The file.
        path: PathBuf,
        /// What it was read as, in words.
        what: &'static str,
        /// The reason.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// A checkpoint was written by another training.
    #[error("{}: the training to resume had another {what}", path.display())]
    OtherTraining {
        /// The checkpoint.
        path: PathBuf,
        /// What differs: configuration, seed or cases.
        what: &'static str,
    },
    /// A training that was taken from a checkpoint failed.
    #[error("{}: the training that it holds cannot go on", path.display())]
    Resumed {
        /// The checkpoint.
        path: PathBuf,
        /// The reason.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// The loss is no longer a finite number.
    #[error("the loss is {loss} in epoch {epoch}: lower the learning rate")]
    Diverged {
        /// The loss.
        loss: f64,
        /// The epoch, counted from 1.
        epoch: usize,
    },
    /// The model does not know how cars differ, so that trajectories of one say nothing of it.
    #[error(
        "the response network was not trained on a fleet of cars; it can be fine-tuned, not conditioned"
    )]
    NoPopulation,
    /// A car that is to be new to the network is one that it has learned from.
    #[error(
        "{case}: the network has learned from this car; expected cars that are new to it, or a network \
         that knows no cars, such as shipped-pretrained"
    )]
    SeenCar {
        /// A trajectory of the car.
        case: String,
    },
    /// The network itself or a model file failed.
    #[error(transparent)]
    Network(#[from] NnError),
}

impl From<candle_core::Error> for LearningError {
    fn from(error: candle_core::Error) -> Self {
        Self::Network(error.into())
    }
}
