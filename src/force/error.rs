//! What can go wrong between a data set and a prediction.

use std::path::PathBuf;

use crate::collision::ImpactError;
use crate::data::TomlError;
use crate::force::regression::BaselineError;
use crate::nn::NnError;
use crate::uncertainty::MixtureError;

/// A force model cannot be trained, opened or asked.
#[derive(Debug, thiserror::Error)]
pub enum ForceError {
    /// Too few cases to learn from.
    #[error("{n_cases} cases to train on, expected at least {least}")]
    TooFewCases {
        /// How many there are.
        n_cases: usize,
        /// How many it takes.
        least: usize,
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
    /// The law of the crush model cannot be fitted.
    #[error("the crush model cannot be fitted: none of the {n_cases} cases has a force")]
    NoCrushFit {
        /// How many cases there are.
        n_cases: usize,
    },
    /// The bullet's body is unknown to the model.
    #[error("bullet body {name:?} is unknown to the model, expected one of {}", known.join(", "))]
    UnknownBody {
        /// As asked for.
        name: String,
        /// What it knows.
        known: Vec<String>,
    },
    /// A number of the scenario makes no sense.
    #[error("{name} is {value}, expected {expected}")]
    Scenario {
        /// Which number.
        name: &'static str,
        /// Its value.
        value: f64,
        /// The range, in words.
        expected: &'static str,
    },
    /// A checkpoint was written by another training.
    #[error("{}: the training to resume had another {what}", path.display())]
    OtherTraining {
        /// The checkpoint.
        path: PathBuf,
        /// What differs: configuration, seed, cases.
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
    /// The regressions beside the crush model cannot be fitted or asked.
    #[error("the regressions beside the crush model fail")]
    Regression(#[from] BaselineError),
    /// The momentum solution has no answer.
    #[error(transparent)]
    Impact(#[from] ImpactError),
    /// The distribution makes no sense.
    #[error(transparent)]
    Mixture(#[from] MixtureError),
    /// Network or model file.
    #[error(transparent)]
    Network(#[from] NnError),
}

impl From<candle_core::Error> for ForceError {
    fn from(error: candle_core::Error) -> Self {
        Self::Network(error.into())
    }
}
