//! Settings of a training and where its state is kept.

use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{BadCases, StudyError};
use impactlab_core::data::write::WriterLock;
use impactlab_networks::response::{ResponseConfig, ResponseModel};

/// Where the settings of a training come from.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ConfigChoice {
    /// Those of the model that is trained on, else the defaults.
    #[default]
    Default,
    /// A TOML file; what it leaves out keeps its default.
    File(PathBuf),
}

impl ConfigChoice {
    /// The file, if there is one.
    pub fn file(&self) -> Option<&Path> {
        match self {
            Self::Default => None,
            Self::File(path) => Some(path),
        }
    }

    /// The settings of a response network.
    ///
    /// - `start`: the network that it is trained on.
    pub(crate) fn response(
        &self,
        start: Option<&ResponseModel>,
    ) -> Result<ResponseConfig, StudyError> {
        match (self.file(), start) {
            (Some(path), _) => Ok(ResponseConfig::load(path)?),
            (None, Some(start)) => Ok(start.config().clone()),
            (None, None) => Ok(ResponseConfig::default()),
        }
    }
}

impl From<Option<PathBuf>> for ConfigChoice {
    fn from(file: Option<PathBuf>) -> Self {
        file.map_or(Self::Default, Self::File)
    }
}

/// How a network is trained, whichever it is.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct TrainingOptions {
    /// Settings of network and training.
    pub config: ConfigChoice,
    /// Seed of the split and, where no other is given, of all draws.
    pub seed: u64,
    /// What happens to cases that cannot be used.
    pub bad_cases: BadCases,
    /// Where the state of the training is kept.
    pub checkpoint: Option<PathBuf>,
    /// Whether to go on from that state, if it is there.
    pub resume: bool,
    /// Whether a state that is there is replaced, if it is not to go on.
    pub overwrite: bool,
}

impl TrainingOptions {
    /// Takes the right to write the state of the training, for as long as the result is held.
    ///
    /// # Errors
    /// [`StudyError::TrainingExists`] if there is a training that is neither to go on nor to be
    /// replaced; [`StudyError::Data`] if another process trains there, or if the file cannot be
    /// written.
    pub(crate) fn claim(&self) -> Result<Option<WriterLock>, StudyError> {
        let Some(path) = &self.checkpoint else { return Ok(None) };
        let lock = WriterLock::claim_checkpoint(path)?;
        if path.exists() && !self.resume && !self.overwrite {
            return Err(StudyError::TrainingExists { path: path.clone() });
        }
        Ok(Some(lock))
    }
}

/// Where a training keeps its state: beside its model, as `MODEL.training`.
pub fn checkpoint_beside(model: &Path) -> PathBuf {
    let mut path = model.to_owned().into_os_string();
    path.push(".training");
    path.into()
}
