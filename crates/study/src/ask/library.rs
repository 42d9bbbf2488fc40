//! What is in memory already, so that a question that is asked again need not read files again.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::ask::provenance::{FORCE_NETWORK, RESPONSE_NETWORK};
use crate::ask::question::progress_of;
use crate::{ModelChoice, Observer, SeriesFile, StudyError};
use impactlab_core::compare::PairRecords;
use impactlab_core::data::write::ModelDigest;
use impactlab_core::data::{Dataset, Loaded, Outcome, read_any_series};
use impactlab_networks::force::ForceModel;
use impactlab_networks::learning::ModelFile;
use impactlab_networks::response::ResponseModel;

/// Models and data by what questions call them.
///
/// A file that has been read stays as it was until it is forgotten or held anew: the window decides
/// when that is, and a command lives too short to care.
#[derive(Debug, Default)]
pub struct Library {
    force_models: Shelf<ModelChoice, Held<ForceModel>>,
    response_models: Shelf<ModelChoice, Held<ResponseModel>>,
    datasets: Shelf<PathBuf, Dataset>,
    files: Shelf<PathBuf, Loaded>,
}

/// A model and the content of its file.
#[derive(Debug)]
struct Held<M> {
    model: Arc<M>,
    /// SHA-256 of the file that was read; `None` for a model that was handed over.
    sha256: Option<String>,
}

/// Values of one kind, shared between threads.
#[derive(Debug)]
struct Shelf<K, V>(Mutex<BTreeMap<K, Arc<V>>>);

impl<K, V> Default for Shelf<K, V> {
    fn default() -> Self {
        Self(Mutex::new(BTreeMap::new()))
    }
}

impl<K: Ord + Clone, V> Shelf<K, V> {
    fn lock(&self) -> MutexGuard<'_, BTreeMap<K, Arc<V>>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn get(&self, key: &K) -> Option<Arc<V>> {
        self.lock().get(key).cloned()
    }

    fn put(&self, key: K, value: Arc<V>) {
        self.lock().insert(key, value);
    }

    fn forget(&self, key: &K) {
        self.lock().remove(key);
    }

    /// The value, read where it is not there yet. Two threads may read it at the same time; both
    /// read the same.
    fn get_or_read(
        &self,
        key: &K,
        read: impl FnOnce() -> Result<V, StudyError>,
    ) -> Result<Arc<V>, StudyError> {
        if let Some(value) = self.get(key) {
            return Ok(value);
        }
        let value = Arc::new(read()?);
        self.put(key.clone(), Arc::clone(&value));
        Ok(value)
    }
}

impl Library {
    /// A force network.
    ///
    /// # Errors
    /// [`StudyError::Force`] if it cannot be read; [`StudyError::NotHeld`].
    pub fn force_model(&self, choice: &ModelChoice) -> Result<Arc<ForceModel>, StudyError> {
        Ok(Arc::clone(&self.held_force_model(choice)?.model))
    }

    /// The content of a force network's file: the one that was read, or the one that it would be
    /// saved in.
    ///
    /// # Errors
    /// As for [`Library::force_model`], and if the network cannot be saved.
    pub fn force_model_digest(&self, choice: &ModelChoice) -> Result<ModelDigest, StudyError> {
        digest(FORCE_NETWORK, choice, &*self.held_force_model(choice)?)
    }

    fn held_force_model(&self, choice: &ModelChoice) -> Result<Arc<Held<ForceModel>>, StudyError> {
        self.force_models.get_or_read(choice, || match choice {
            ModelChoice::Source(source) => {
                let (model, sha256) = source.force_model_with_digest()?;
                Ok(Held { model: Arc::new(model), sha256: Some(sha256) })
            }
            ModelChoice::Held { held } => Err(StudyError::NotHeld { name: held.clone() }),
        })
    }

    /// A response network.
    ///
    /// # Errors
    /// [`StudyError::Learning`] if it cannot be read; [`StudyError::NotHeld`].
    pub fn response_model(&self, choice: &ModelChoice) -> Result<Arc<ResponseModel>, StudyError> {
        Ok(Arc::clone(&self.held_response_model(choice)?.model))
    }

    /// The content of a response network's file: the one that was read, or the one that it would
    /// be saved in.
    ///
    /// # Errors
    /// As for [`Library::response_model`], and if the network cannot be saved.
    pub fn response_model_digest(&self, choice: &ModelChoice) -> Result<ModelDigest, StudyError> {
        digest(RESPONSE_NETWORK, choice, &*self.held_response_model(choice)?)
    }

    fn held_response_model(
        &self,
        choice: &ModelChoice,
    ) -> Result<Arc<Held<ResponseModel>>, StudyError> {
        self.response_models.get_or_read(choice, || match choice {
            ModelChoice::Source(source) => {
                let (model, sha256) = source.response_model_with_digest()?;
                Ok(Held { model: Arc::new(model), sha256: Some(sha256) })
            }
            ModelChoice::Held { held } => Err(StudyError::NotHeld { name: held.clone() }),
        })
    }

    /// A data set with the problems of its cases.
    ///
    /// # Errors
    /// [`StudyError::Data`] if its table of cases cannot be read.
    pub fn dataset(
        &self,
        root: &Path,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<Arc<Dataset>>, StudyError> {
        let key = root.to_owned();
        if let Some(dataset) = self.datasets.get(&key) {
            return Ok(Outcome::Complete(dataset));
        }
        if PairRecords::is_at(root) {
            return Err(StudyError::WrongKind {
                path: root.to_owned(),
                got: "a data set of recorded pairs".to_owned(),
                expected: "one of forces or of trajectories; pairs: impactlab evaluate pairs DIR",
            });
        }
        let loaded = Dataset::load(root, &mut progress_of(observer))?;
        Ok(loaded.map(|dataset| {
            let dataset = Arc::new(dataset);
            self.datasets.put(key, Arc::clone(&dataset));
            dataset
        }))
    }

    /// A single file of time series. A file with the user's own columns is read anew.
    ///
    /// # Errors
    /// [`StudyError::Data`], with the place in the file.
    pub fn series(&self, file: &SeriesFile) -> Result<Arc<Loaded>, StudyError> {
        let read = || Ok(read_any_series(&file.path, file.map.as_ref())?);
        match &file.map {
            Some(_) => read().map(Arc::new),
            None => self.files.get_or_read(&file.path, read),
        }
    }

    /// Keeps a force network under what questions call it.
    pub fn hold_force_model(&self, choice: ModelChoice, model: Arc<ForceModel>) {
        self.force_models.put(choice, Arc::new(Held { model, sha256: None }));
    }

    /// Keeps a response network under what questions call it.
    pub fn hold_response_model(&self, choice: ModelChoice, model: Arc<ResponseModel>) {
        self.response_models.put(choice, Arc::new(Held { model, sha256: None }));
    }

    /// Keeps a data set that was opened.
    pub fn hold_dataset(&self, dataset: Arc<Dataset>) {
        self.datasets.put(dataset.root.clone(), dataset);
    }

    /// Keeps a file that was opened.
    pub fn hold_series(&self, path: PathBuf, loaded: Arc<Loaded>) {
        self.files.put(path, loaded);
    }

    /// Forgets what was read from a path, so that it is read again.
    pub fn forget(&self, path: &Path) {
        let key = path.to_owned();
        self.datasets.forget(&key);
        self.files.forget(&key);
        let choice = ModelChoice::file(key);
        self.force_models.forget(&choice);
        self.response_models.forget(&choice);
    }
}

/// The content of a model's file; of one that was handed over, what its file would hold.
fn digest<M: ModelFile>(
    network: &'static str,
    choice: &ModelChoice,
    held: &Held<M>,
) -> Result<ModelDigest, StudyError>
where
    StudyError: From<M::Error>,
{
    let sha256 = match &held.sha256 {
        Some(sha256) => sha256.clone(),
        None => held.model.sha256()?,
    };
    Ok(ModelDigest { network: network.into(), name: choice.to_string(), sha256 })
}
