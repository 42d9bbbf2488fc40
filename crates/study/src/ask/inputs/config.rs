//! Settings of a training and where its state is kept.

use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{BadCases, StudyError};
use impactlab_core::data::DataError;
use impactlab_core::data::write::{WriteError, WriterLock};
use impactlab_networks::force::FORCE_CHECKPOINT;
use impactlab_networks::nn::kind_of_file;
use impactlab_networks::response::{RESPONSE_CHECKPOINT, ResponseConfig, ResponseModel};

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
    /// replaced; [`StudyError::Data`] if another process trains there, if the file cannot be
    /// written, or if it is no training and so is somebody's.
    pub(crate) fn claim(&self) -> Result<Option<WriterLock>, StudyError> {
        let Some(path) = &self.checkpoint else { return Ok(None) };
        let lock = WriterLock::claim_checkpoint(path)?;
        if path.exists() && !self.resume {
            if !is_training(path) {
                return Err(DataError::from(WriteError::NotOfRun { path: path.clone() }).into());
            }
            if !self.overwrite {
                return Err(StudyError::TrainingExists { path: path.clone() });
            }
        }
        Ok(Some(lock))
    }
}

/// Whether a file holds the state of a training.
fn is_training(path: &Path) -> bool {
    let kinds = [FORCE_CHECKPOINT.name, RESPONSE_CHECKPOINT.name];
    kind_of_file(path).is_ok_and(|kind| kinds.contains(&kind.as_str()))
}

/// Where a training keeps its state: beside its model, as `MODEL.training`.
pub fn checkpoint_beside(model: &Path) -> PathBuf {
    let mut path = model.to_owned().into_os_string();
    path.push(".training");
    path.into()
}
