//! What is in memory already, so that a question that is asked again need not read files again.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::data::{Dataset, Loaded, Outcome, read_any_series};
use crate::force::ForceModel;
use crate::response::ResponseModel;
use crate::study::question::progress_of;
use crate::study::{ModelChoice, Observer, SeriesFile, StudyError};

/// Models and data by what questions call them.
///
/// A file that has been read stays as it was until it is forgotten or held anew: the window decides
/// when that is, and a command lives too short to care.
#[derive(Debug, Default)]
pub struct Library {
    force_models: Shelf<ModelChoice, ForceModel>,
    response_models: Shelf<ModelChoice, ResponseModel>,
    datasets: Shelf<PathBuf, Dataset>,
    files: Shelf<PathBuf, Loaded>,
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
        self.force_models.get_or_read(choice, || match choice {
            ModelChoice::Source(source) => Ok(source.force_model()?),
            ModelChoice::Held { held } => Err(StudyError::NotHeld { name: held.clone() }),
        })
    }

    /// A response network.
    ///
    /// # Errors
    /// [`StudyError::Learning`] if it cannot be read; [`StudyError::NotHeld`].
    pub fn response_model(&self, choice: &ModelChoice) -> Result<Arc<ResponseModel>, StudyError> {
        self.response_models.get_or_read(choice, || match choice {
            ModelChoice::Source(source) => Ok(source.response_model()?),
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
        self.force_models.put(choice, model);
    }

    /// Keeps a response network under what questions call it.
    pub fn hold_response_model(&self, choice: ModelChoice, model: Arc<ResponseModel>) {
        self.response_models.put(choice, model);
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
