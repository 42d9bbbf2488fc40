//! The model that answers: loaded and saved in the background, or fresh from a training.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::app::network::TrainedModel;
use crate::error_chain;
use crate::jobs::Job;
use crate::study::{Library, ModelChoice};

/// A model that can answer questions, and where it comes from.
pub struct CurrentModel<M> {
    /// The name of the model in questions.
    pub choice: ModelChoice,
    /// The model.
    pub model: Arc<M>,
    /// The name that is shown: that of its file, or how it was trained.
    pub name: String,
    /// Whether the model stands in a file.
    pub is_saved: bool,
}

/// The model of one network that answers, and the one that the project asks for.
pub struct ModelStatus<M> {
    /// The file that was asked for last; the inner `None` is the shipped model.
    requested: Option<Option<PathBuf>>,
    job: Option<Job<Result<CurrentModel<M>, String>>>,
    saving: Option<Job<Result<PathBuf, String>>>,
    n_trained: usize,
    /// The model that answers questions.
    pub current: Option<CurrentModel<M>>,
    /// The model of a cancelled training, which answers only once the user says so.
    pub set_aside: Option<CurrentModel<M>>,
    /// Why the model that the project asks for could not be loaded.
    pub problem: Option<String>,
    /// The path in the text field for saving, as far as it has been typed.
    pub typed_path: String,
}

impl<M> Default for ModelStatus<M> {
    fn default() -> Self {
        Self {
            requested: None,
            job: None,
            saving: None,
            n_trained: 0,
            current: None,
            set_aside: None,
            problem: None,
            typed_path: String::new(),
        }
    }
}

impl<M: TrainedModel> ModelStatus<M> {
    /// Starts to load a model if the project asks for another one than before. Returns once why a
    /// model could not be loaded.
    pub fn update(
        &mut self,
        wanted: &Option<PathBuf>,
        library: &Arc<Library>,
        wake: impl Fn() + Send + 'static,
    ) -> Option<String> {
        if self.requested.as_ref() != Some(wanted) {
            self.requested = Some(wanted.clone());
            let (path, library) = (wanted.clone(), Arc::clone(library));
            match Job::spawn("load model", wake, move |_| load(path, &library)) {
                Ok(job) => self.job = Some(job),
                Err(error) => return Some(error.to_string()),
            }
        }
        let result = self.job.as_mut()?.poll().into_result("the loader")?;
        self.job = None;
        self.problem = None;
        match result {
            Ok(current) => self.current = Some(current),
            Err(problem) => self.problem = Some(problem),
        }
        self.problem.clone()
    }

    /// Whether a model is being loaded.
    pub fn is_loading(&self) -> bool {
        self.job.is_some()
    }

    /// Takes a model that was just trained and puts it into the library.
    ///
    /// - `name`: how it was trained, for a person;
    /// - `is_used`: whether it answers questions from now on; otherwise it is set aside.
    pub fn take_trained(&mut self, model: M, name: String, (library, is_used): (&Library, bool)) {
        self.n_trained += 1;
        // A name stands for one model, so that an answer of another one is not taken for its own.
        let name = match self.n_trained {
            1 => name,
            n => format!("{name} (training {n})"),
        };
        let (choice, model) = (ModelChoice::held(&name), Arc::new(model));
        M::hold(library, choice.clone(), Arc::clone(&model));
        self.set_aside = Some(CurrentModel { choice, model, name, is_saved: false });
        if is_used {
            self.use_trained();
        }
    }

    /// Puts the model of a cancelled training into use.
    pub fn use_trained(&mut self) {
        if let Some(trained) = self.set_aside.take() {
            self.job = None;
            self.problem = None;
            self.current = Some(trained);
        }
    }

    /// Reads the file again at the next update.
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

    /// The file that has just been written. The model is that file's from now on.
    pub fn poll_saving(&mut self, library: &Library) -> Option<Result<PathBuf, String>> {
        let result = self.saving.as_mut()?.poll().into_result("the writer")?;
        self.saving = None;
        if let Ok(path) = &result {
            self.requested = Some(Some(path.clone()));
            if let Some(current) = &mut self.current {
                current.choice = ModelChoice::file(path);
                M::hold(library, current.choice.clone(), Arc::clone(&current.model));
                (current.name, current.is_saved) = (file_name(path), true);
            }
        }
        Some(result)
    }
}

fn load<M: TrainedModel>(
    path: Option<PathBuf>,
    library: &Library,
) -> Result<CurrentModel<M>, String> {
    let name = path.as_deref().map(file_name);
    let choice = path.map_or_else(ModelChoice::default, ModelChoice::file);
    let name = name.unwrap_or_else(|| choice.to_string());
    match M::of_library(library, &choice) {
        Ok(model) => Ok(CurrentModel { choice, model, name, is_saved: true }),
        Err(error) => Err(format!("{choice}: {}", error_chain(&error))),
    }
}

/// The last part of a path.
pub fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}
