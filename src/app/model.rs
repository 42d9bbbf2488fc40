//! The model that answers: loaded and saved in the background, or fresh from a training.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::app::network::TrainedModel;
use crate::jobs::Job;
use crate::shipped::ModelSource;

/// What the shipped model is called.
pub const SHIPPED_NAME: &str = "shipped";

/// A model and where it comes from.
pub struct CurrentModel<M> {
    /// The model.
    pub model: Arc<M>,
    /// For a person: the file's name, or that it was trained here.
    pub name: String,
    /// Whether a file holds it.
    pub is_saved: bool,
}

/// The model, and which one is wanted.
pub struct ModelStatus<M> {
    /// The file that was asked for last; the inner `None` is the shipped model.
    requested: Option<Option<PathBuf>>,
    job: Option<Job<Result<(M, String), String>>>,
    saving: Option<Job<Result<PathBuf, String>>>,
    /// What answers.
    pub current: Option<CurrentModel<M>>,
    /// Why the wanted one does not.
    pub problem: Option<String>,
    /// A path to which it is to be saved, being typed.
    pub typed_path: String,
}

impl<M> Default for ModelStatus<M> {
    fn default() -> Self {
        let (requested, job, saving, current, problem) = (None, None, None, None, None);
        Self { requested, job, saving, current, problem, typed_path: String::new() }
    }
}

impl<M: TrainedModel> ModelStatus<M> {
    /// Starts loading if another model is wanted than the last time. A problem comes back.
    pub fn update(
        &mut self,
        wanted: &Option<PathBuf>,
        wake: impl Fn() + Send + 'static,
    ) -> Option<String> {
        if self.requested.as_ref() != Some(wanted) {
            self.requested = Some(wanted.clone());
            let path = wanted.clone();
            match Job::spawn("load model", wake, move |_| load(path)) {
                Ok(job) => self.job = Some(job),
                Err(error) => return Some(error.to_string()),
            }
        }
        let result = self.job.as_mut()?.poll().into_result("the loader")?;
        self.job = None;
        match result {
            Ok((model, name)) => {
                self.current = Some(CurrentModel { model: Arc::new(model), name, is_saved: true });
                self.problem = None;
                None
            }
            Err(problem) => {
                self.problem = Some(problem.clone());
                Some(problem)
            }
        }
    }

    /// Whether a model is being loaded.
    pub fn is_loading(&self) -> bool {
        self.job.is_some()
    }

    /// Takes a model that was just trained.
    pub fn take_trained(&mut self, model: M, name: String) {
        self.job = None;
        self.problem = None;
        self.current = Some(CurrentModel { model: Arc::new(model), name, is_saved: false });
    }

    /// Reads the file again, e.g. after the user asked for it once more.
    pub fn reload(&mut self) {
        self.requested = None;
    }

    /// Starts writing the model to a file.
    ///
    /// # Errors
    /// A message for the user.
    pub fn save(&mut self, path: PathBuf, wake: impl Fn() + Send + 'static) -> Result<(), String> {
        let Some(current) = &self.current else {
            return Err(format!("there is no {} to save", M::NETWORK.model()));
        };
        let model = Arc::clone(&current.model);
        let job = Job::spawn("save model", wake, move |_| model.write(&path).map(|()| path));
        self.saving = Some(job.map_err(|error| error.to_string())?);
        Ok(())
    }

    /// Whether a file is being written.
    pub fn is_saving(&self) -> bool {
        self.saving.is_some()
    }

    /// The file that was just written, which is the wanted one from now on.
    pub fn poll_saving(&mut self) -> Option<Result<PathBuf, String>> {
        let result = self.saving.as_mut()?.poll().into_result("the writer")?;
        self.saving = None;
        if let Ok(path) = &result {
            self.requested = Some(Some(path.clone()));
            if let Some(current) = &mut self.current {
                (current.name, current.is_saved) = (file_name(path), true);
            }
        }
        Some(result)
    }
}

fn load<M: TrainedModel>(path: Option<PathBuf>) -> Result<(M, String), String> {
    let (source, name) = match path {
        Some(path) => (ModelSource::File(path.clone()), file_name(&path)),
        None => (ModelSource::Shipped, SHIPPED_NAME.to_owned()),
    };
    M::read(&source).map(|model| (model, name)).map_err(|problem| format!("{source}: {problem}"))
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}
