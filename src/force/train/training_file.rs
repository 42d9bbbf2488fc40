//! A training on disk, so that it survives being killed.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::force::physics::{CentreCurve, CentreModel};
use crate::force::train::training::SavedTraining;
use crate::force::{EpochRecord, ForceConfig, ForceError, TrainSettings, TrainingSet};
use crate::nn::{Checkpoint, ModelKind};

const KIND: ModelKind = ModelKind { name: "training of a force network", version: 1 };

/// What must be the same for a training to go on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Identity {
    config: ForceConfig,
    seed: u64,
    data_digest: String,
}

/// Where a training is saved, if anywhere.
pub(crate) struct TrainingFile {
    path: Option<PathBuf>,
    resume: bool,
    identity: Identity,
}

impl TrainingFile {
    pub(crate) fn new(set: &TrainingSet, settings: &TrainSettings) -> Self {
        let mut config = settings.config.clone();
        // More epochs or patience do not change those that were.
        config.training.epochs = 0;
        config.training.patience = 0;
        config.training.checkpoint_epochs = 0;
        Self {
            path: settings.checkpoint.clone(),
            resume: settings.resume,
            identity: Identity { config, seed: settings.seed, data_digest: set.digest() },
        }
    }

    /// Saves nothing from now on.
    pub(crate) fn forget(&mut self) {
        self.path = None;
    }

    /// The saved training, if it is wanted and there.
    ///
    /// # Errors
    /// [`ForceError::OtherTraining`], [`ForceError::Network`] if the file is damaged.
    pub(crate) fn read(&self) -> Result<Option<SavedTraining>, ForceError> {
        let Some(path) = self.path.as_ref().filter(|path| self.resume && path.exists()) else {
            return Ok(None);
        };
        let mut file = Checkpoint::read(path, KIND)?;
        let saved: Identity = file.get("identity")?;
        let differs = [
            ("configuration", saved.config != self.identity.config),
            ("seed", saved.seed != self.identity.seed),
            ("set of cases", saved.data_digest != self.identity.data_digest),
        ];
        if let Some((what, _)) = differs.into_iter().find(|(_, differs)| *differs) {
            return Err(ForceError::OtherTraining { path: path.clone(), what });
        }
        let saved = SavedTraining {
            centre: file.get::<CentreModel>("centre")?,
            centres: file.get::<Vec<CentreCurve>>("centres")?,
            step: file.get("step")?,
            best_epoch: file.get("best_epoch")?,
            history: file.get::<Vec<EpochRecord>>("history")?,
            parameters: file.take_group("parameters"),
            best_parameters: file.take_group("best"),
            moments: file.take_group("moments"),
        };
        file.check_all_taken()?;
        Ok(Some(saved))
    }

    /// Saves a training, whole or not at all.
    ///
    /// # Errors
    /// [`ForceError::Network`].
    pub(crate) fn write(&self, training: &SavedTraining) -> Result<(), ForceError> {
        let Some(path) = &self.path else { return Ok(()) };
        let mut file = Checkpoint::new(KIND);
        file.put("identity", &self.identity)?;
        file.put("centre", &training.centre)?;
        file.put("centres", &training.centres)?;
        file.put("step", &training.step)?;
        file.put("best_epoch", &training.best_epoch)?;
        file.put("history", &training.history)?;
        file.put_group("parameters", training.parameters.clone());
        file.put_group("best", training.best_parameters.clone());
        file.put_group("moments", training.moments.clone());
        Ok(file.write(path)?)
    }
}
