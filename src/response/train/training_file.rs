//! A training on disk, so that it survives being killed.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::nn::{Checkpoint, ModelKind};
use crate::response::train::training_run::SavedTraining;
use crate::response::{ResponseConfig, ResponseEpoch, ResponseError, ResponseTrainSettings};

const KIND: ModelKind = ModelKind { name: "training of a response network", version: 1 };

/// What must be the same for a training to go on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Identity {
    config: ResponseConfig,
    seed: u64,
    data_digest: String,
}

/// Where a training is saved, if anywhere.
pub(super) struct TrainingFile {
    path: Option<PathBuf>,
    resume: bool,
    identity: Identity,
}

impl TrainingFile {
    /// - `data_digest`: of what is learned from.
    pub(super) fn new(settings: &ResponseTrainSettings, data_digest: String) -> Self {
        let (config, seed) = (settings.config.clone(), settings.seed);
        Self {
            path: settings.checkpoint.clone(),
            resume: settings.resume,
            identity: Identity { config, seed, data_digest },
        }
    }

    /// The saved training, if it is wanted and there.
    ///
    /// # Errors
    /// [`ResponseError::OtherTraining`], [`ResponseError::Network`] if the file is damaged.
    pub(super) fn read(&self) -> Result<Option<SavedTraining>, ResponseError> {
        let Some(path) = self.path.as_ref().filter(|path| self.resume && path.exists()) else {
            return Ok(None);
        };
        let mut file = Checkpoint::read(path, KIND)?;
        let saved: Identity = file.get("identity")?;
        let differs = [
            ("configuration", saved.config != self.identity.config),
            ("seed", saved.seed != self.identity.seed),
            ("set of trajectories", saved.data_digest != self.identity.data_digest),
        ];
        if let Some((what, _)) = differs.into_iter().find(|(_, differs)| *differs) {
            return Err(ResponseError::OtherTraining { path: path.clone(), what });
        }
        let saved = SavedTraining {
            step: file.get("step")?,
            history: file.get::<Vec<ResponseEpoch>>("history")?,
            parameters: file.take_group("parameters"),
            moments: file.take_group("moments"),
        };
        file.check_all_taken()?;
        Ok(Some(saved))
    }

    /// Saves a training, whole or not at all.
    ///
    /// # Errors
    /// [`ResponseError::Network`].
    pub(super) fn write(&self, training: &SavedTraining) -> Result<(), ResponseError> {
        let Some(path) = &self.path else { return Ok(()) };
        let mut file = Checkpoint::new(KIND);
        file.put("identity", &self.identity)?;
        file.put("step", &training.step)?;
        file.put("history", &training.history)?;
        file.put_group("parameters", training.parameters.clone());
        file.put_group("moments", training.moments.clone());
        Ok(file.write(path)?)
    }
}
