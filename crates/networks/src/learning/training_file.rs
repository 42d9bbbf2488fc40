//! A training on disk, so that it survives being killed.

use std::error::Error;
use std::path::{Path, PathBuf};

use serde::de::{DeserializeOwned, IgnoredAny};
use serde::{Deserialize, Serialize};

use crate::learning::{EpochRecord, LearningError, TrainSettings};
use crate::nn::{Checkpoint, ModelKind, NamedTensors, NnError, OptimizerState};
use impactlab_core::data::Existing;

/// Metadata of a checkpoint: the duration of every epoch, s, which the history leaves out.
const EPOCH_SECONDS: &str = "epoch_seconds";

/// What must be the same for a training to go on from a checkpoint.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Identity<C> {
    config: C,
    seed: u64,
    data_digest: String,
}

/// The file in which a training is saved, if it is saved at all.
///
/// - `C`: sizes, weights and rates of the network and its training.
pub struct TrainingFile<C> {
    kind: ModelKind,
    path: Option<PathBuf>,
    resume: bool,
    identity: Identity<C>,
}

/// What a checkpoint holds of every kind of network.
///
/// - `E`: what only this kind of network records of an epoch.
pub struct SavedTraining<E> {
    /// Weights at the end of the last epoch.
    pub parameters: NamedTensors,
    /// State of the optimiser.
    pub optimizer: OptimizerState,
    /// Every epoch, with those of an earlier training from which this one started.
    pub history: Vec<EpochRecord<E>>,
}

impl<C: PartialEq + Serialize + DeserializeOwned> TrainingFile<C> {
    /// The file that the settings name.
    ///
    /// - `config`: the part of the configuration that must be the same for a training to go on;
    /// - `data_digest`: the digest of what is learned from.
    pub fn new(
        kind: ModelKind,
        settings: &TrainSettings<C>,
        config: C,
        data_digest: String,
    ) -> Self {
        Self {
            kind,
            path: settings.checkpoint.clone(),
            resume: settings.resume,
            identity: Identity { config, seed: settings.seed, data_digest },
        }
    }

    /// Saves nothing from now on.
    pub fn disable(&mut self) {
        self.path = None;
    }

    /// The saved training, if it is to be resumed and there is one.
    ///
    /// - `take`: takes the training out of the checkpoint.
    ///
    /// # Errors
    /// [`LearningError::OtherTraining`], [`LearningError::Network`] if the file cannot be read, and
    /// [`LearningError::InFile`] if its contents cannot be used.
    pub fn read<T, E: From<NnError> + Error + Send + Sync + 'static>(
        &self,
        take: impl FnOnce(&mut Checkpoint) -> Result<T, E>,
    ) -> Result<Option<T>, LearningError> {
        let Some(path) = self.path.as_ref().filter(|path| self.resume && path.exists()) else {
            return Ok(None);
        };
        let mut file = Checkpoint::read(path, self.kind)?;
        let in_file = |source: Box<dyn Error + Send + Sync>| LearningError::InFile {
            path: path.clone(),
            what: "a training",
            source,
        };
        let saved: Identity<C> = file.get("identity").map_err(|error| in_file(Box::new(error)))?;
        let differs = [
            ("configuration", saved.config != self.identity.config),
            ("seed", saved.seed != self.identity.seed),
            ("set of cases", saved.data_digest != self.identity.data_digest),
        ];
        if let Some((what, _)) = differs.into_iter().find(|(_, differs)| *differs) {
            return Err(LearningError::OtherTraining { path: path.clone(), what });
        }
        let training = take(&mut file).map_err(|error| in_file(Box::new(error)))?;
        file.check_all_taken().map_err(|error| in_file(Box::new(error)))?;
        Ok(Some(training))
    }

    /// Names the checkpoint in the error of a training that was taken from it: what fails may have
    /// come with the file.
    ///
    /// - `was_resumed`: whether the training was taken from the checkpoint.
    ///
    /// # Errors
    /// That of `result`, within [`LearningError::Resumed`] if the training was taken from the
    /// checkpoint.
    pub fn named<T, E: From<LearningError> + Error + Send + Sync + 'static>(
        &self,
        was_resumed: bool,
        result: Result<T, E>,
    ) -> Result<T, E> {
        match self.path.clone().filter(|_| was_resumed) {
            None => result,
            Some(path) => {
                let in_file = |error: E| LearningError::Resumed { path, source: Box::new(error) };
                result.map_err(|error| in_file(error).into())
            }
        }
    }

    /// Saves a training, whole or not at all.
    ///
    /// - `put`: puts the training into the checkpoint.
    ///
    /// # Errors
    /// [`LearningError::Network`].
    pub fn write(
        &self,
        put: impl FnOnce(&mut Checkpoint) -> Result<(), NnError>,
    ) -> Result<(), LearningError> {
        let Some(path) = &self.path else { return Ok(()) };
        let mut file = Checkpoint::new(self.kind);
        file.put("identity", &self.identity)?;
        put(&mut file)?;
        Ok(file.write(path, Existing::Replace)?)
    }
}

impl<E: Serialize + DeserializeOwned> SavedTraining<E> {
    /// Takes it out of a checkpoint.
    ///
    /// # Errors
    /// [`NnError`] if something is missing or has another form.
    pub fn take(file: &mut Checkpoint) -> Result<Self, NnError> {
        let mut history: Vec<EpochRecord<E>> = file.get("history")?;
        match file.get::<Vec<Option<f64>>>(EPOCH_SECONDS) {
            Ok(seconds) => {
                for (epoch, seconds) in history.iter_mut().zip(seconds) {
                    epoch.seconds = seconds;
                }
            }
            // A checkpoint of an earlier version has them in the history.
            Err(NnError::MissingMetadata { .. }) => {}
            Err(error) => return Err(error),
        }
        Ok(Self {
            optimizer: OptimizerState {
                step: file.get("step")?,
                moments: file.take_group("moments"),
            },
            history,
            parameters: file.take_group("parameters"),
        })
    }

    /// Puts it into a checkpoint.
    ///
    /// # Errors
    /// [`NnError::Metadata`].
    pub fn put(self, file: &mut Checkpoint) -> Result<(), NnError> {
        file.put("step", &self.optimizer.step)?;
        file.put("history", &self.history)?;
        let seconds: Vec<Option<f64>> = self.history.iter().map(|epoch| epoch.seconds).collect();
        file.put(EPOCH_SECONDS, &seconds)?;
        file.put_group("parameters", self.parameters);
        file.put_group("moments", self.optimizer.moments);
        Ok(())
    }
}

/// Number of epochs in the history of the checkpoint of a training of either network.
///
/// - `kind`: what the checkpoint holds.
///
/// # Errors
/// [`LearningError::Network`] if the file cannot be read or has no history.
pub fn stored_epochs(path: &Path, kind: ModelKind) -> Result<usize, LearningError> {
    let file = Checkpoint::read(path, kind)?;
    Ok(file.get::<Vec<IgnoredAny>>("history")?.len())
}
