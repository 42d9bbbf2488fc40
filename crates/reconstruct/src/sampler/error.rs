//! What can go wrong while a posterior is sampled.

use std::path::PathBuf;

use impactlab_core::data::DataError;
use impactlab_core::data::write::WriteError;

/// A posterior cannot be sampled.
#[derive(Debug, thiserror::Error)]
pub enum SamplerError {
    /// A setting is outside its range.
    #[error("{name} is {value}, expected {expected}")]
    Setting {
        /// Name of the setting.
        name: &'static str,
        /// Its value.
        value: f64,
        /// The range, in words.
        expected: &'static str,
    },
    /// No particle of the prior can explain the evidence at all.
    #[error(
        "the evidence is impossible for each of {n_evaluations} draws from the prior: it contradicts \
         the prior ranges, or itself"
    )]
    ImpossibleEverywhere {
        /// Number of draws.
        n_evaluations: usize,
    },
    /// Somebody stopped the run before a particle of the prior could explain the evidence, which says nothing
    /// of the evidence.
    #[error(
        "stopped after {n_evaluations} draws from the prior, of which none can explain the evidence"
    )]
    Stopped {
        /// Number of draws.
        n_evaluations: usize,
    },
    /// The likelihood has returned another number of values than there were particles.
    #[error("the likelihood returned {got} values, expected {expected}, one for each particle")]
    WrongCount {
        /// Number of particles.
        expected: usize,
        /// Number of values.
        got: usize,
    },
    /// The likelihood is infinite, so that it can be no density.
    #[error("the likelihood of a particle is infinite, expected a finite number or zero")]
    InfiniteLikelihood,
    /// The checkpoint is of another run.
    #[error("{}: the run to resume had another {what}", path.display())]
    OtherRun {
        /// The checkpoint.
        path: PathBuf,
        /// What differs: question, settings or version.
        what: &'static str,
    },
    /// The checkpoint cannot be understood.
    #[error("{}: cannot be read as the checkpoint of a reconstruction: {reason}", path.display())]
    Checkpoint {
        /// The checkpoint.
        path: PathBuf,
        /// The reason.
        reason: String,
    },
    /// The checkpoint cannot be opened or written.
    #[error(transparent)]
    File(Box<DataError>),
}

impl SamplerError {
    /// Whether the checkpoint is at fault, and not what is sampled.
    pub fn is_of_checkpoint(&self) -> bool {
        matches!(self, Self::OtherRun { .. } | Self::Checkpoint { .. } | Self::File(_))
    }

    /// Whether somebody stopped the run, and nothing is wrong.
    pub fn is_of_stop(&self) -> bool {
        matches!(self, Self::Stopped { .. })
    }

    /// Whether another run, here or in another process, is writing the checkpoint.
    pub fn is_in_use(&self) -> bool {
        let Self::File(error) = self else { return false };
        matches!(**error, DataError::Write(WriteError::InUse { .. }))
    }
}

impl From<DataError> for SamplerError {
    fn from(error: DataError) -> Self {
        Self::File(Box::new(error))
    }
}
