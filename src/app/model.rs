//! The model that answers the questions of one network. It is loaded and saved in the background,
//! or it comes from a training.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::app::network::TrainedModel;
use crate::data::Existing;
use crate::error_chain;
use crate::jobs::Job;
use crate::study::{Library, ModelChoice};

/// A model in use or ready for use, and its origin.
pub struct CurrentModel<M> {
    /// The reference to the model in questions.
    pub choice: ModelChoice,
    /// The model.
    pub model: Arc<M>,
    /// The name that is shown: the name of the file, “shipped”, or a description of the training.
    pub name: String,
    /// Whether the model is stored in a file or is the shipped one.
    pub is_saved: bool,
}

/// A model that is being written, which need not be the one in use when it has been written.
struct Saving<M> {
    model: Arc<M>,
    job: Job<Result<PathBuf, String>>,
}

/// The state of the model of one network: the model in use, the one that is being loaded or saved,
/// and the one that a cancelled training has left.
pub struct ModelStatus<M> {
    /// The file that was requested last; the inner `None` is the shipped model. The outer `None`
    /// means that no model has been requested yet, or that it must be read again.
    requested: Option<Option<PathBuf>>,
    job: Option<Job<Result<CurrentModel<M>, String>>>,
    saving: Option<Saving<M>>,
    /// Number of models that trainings have given since the start of the program.
    n_trained: usize,
    /// The model that answers questions; `None` before the first one is loaded.
    pub current: Option<CurrentModel<M>>,
    /// The model of the last training that is not in use, because the training was cancelled. It
    /// answers only after the user has asked for it.
    pub set_aside: Option<CurrentModel<M>>,
    /// The reason why the model that the project requests could not be loaded.
    pub problem: Option<String>,
    /// The path in the text field for saving, as the user has typed it so far.
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
    /// Starts to load a model if the project requests another one than before, and receives the
    /// model that has been loaded. If loading fails, the model in use stays.
    ///
    /// - `wanted`: file of the requested model; `None` is the shipped one;
    /// - `wake`: called when the model is loaded;
    /// - returns the reason why a model could not be loaded, once.
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

    /// Receives a model that was just trained and puts it into the library.
    ///
    /// - `name`: description of the training, shown to the user; a number is appended from the
    ///   second training on;
    /// - `is_used`: whether the model answers questions from now on; otherwise it is set aside.
    pub fn take_trained(&mut self, model: M, name: String, (library, is_used): (&Library, bool)) {
        self.n_trained += 1;
        // The library identifies a model by its name. Two models of the same name would make the
        // answers of one pass for those of the other.
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

    /// Puts the model that was set aside into use and stops loading another one.
    pub fn use_trained(&mut self) {
        if let Some(trained) = self.set_aside.take() {
            self.job = None;
            self.problem = None;
            self.current = Some(trained);
        }
    }

    /// Makes the next update read the requested file again.
    pub fn reload(&mut self) {
        self.requested = None;
    }

    /// Starts writing the model in use to a file.
    ///
    /// - `existing`: what happens to a file that exists already;
    /// - `wake`: called when the file has been written.
    ///
    /// # Errors
    /// A message for the user, if there is no model or the thread cannot be started.
    pub fn save(
        &mut self,
        (path, existing): (PathBuf, Existing),
        wake: impl Fn() + Send + 'static,
    ) -> Result<(), String> {
        let Some(current) = &self.current else {
            return Err(format!("there is no {} to save", M::NETWORK.model()));
        };
        let (model, written) = (Arc::clone(&current.model), Arc::clone(&current.model));
        let job =
            Job::spawn("save model", wake, move |_| written.write(&path, existing).map(|()| path));
        self.saving = Some(Saving { model, job: job.map_err(|error| error.to_string())? });
        Ok(())
    }

    /// Whether a file is being written.
    pub fn is_saving(&self) -> bool {
        self.saving.is_some()
    }

    /// Returns the path of the file that has just been written, or why it could not be; `None`
    /// otherwise. If the model that was written is still in use, it is identified by that file from
    /// then on; another model that has come into use meanwhile stays in use and unsaved.
    ///
    /// - `wanted`: file of the model that the project requests, which becomes the written one.
    pub fn poll_saving(
        &mut self,
        library: &Library,
        wanted: &mut Option<PathBuf>,
    ) -> Option<Result<PathBuf, String>> {
        let result = self.saving.as_mut()?.job.poll().into_result("the writer")?;
        let model = self.saving.take()?.model;
        if let Ok(path) = &result {
            let choice = ModelChoice::file(path);
            let in_use = self.current.as_mut().filter(|of| Arc::ptr_eq(&of.model, &model));
            if let Some(current) = in_use {
                *wanted = Some(path.clone());
                self.requested = Some(wanted.clone());
                current.choice = choice.clone();
                (current.name, current.is_saved) = (file_name(path), true);
            }
            M::hold(library, choice, model);
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

/// Returns the last component of a path, as text.
pub fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::force::ForceModel;
    use crate::shipped::ModelSource;

    #[test]
    fn a_model_that_comes_into_use_while_another_is_written_is_not_taken_for_the_written_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("written.safetensors");
        let library = Arc::new(Library::default());
        let (mut status, mut wanted) = (ModelStatus::<ForceModel>::default(), None);
        while status.current.is_none() {
            assert_eq!(status.update(&wanted, &library, || {}), None);
        }
        let written = Arc::clone(&status.current.as_ref().unwrap().model);
        status.save((path.clone(), Existing::Replace), || {}).unwrap();
        let trained = ModelSource::Shipped.force_model().unwrap();
        status.take_trained(trained, "trained meanwhile".to_owned(), (&library, true));
        let saved = loop {
            if let Some(saved) = status.poll_saving(&library, &mut wanted) {
                break saved;
            }
        };
        assert_eq!((saved, &wanted), (Ok(path.clone()), &None));
        let held = library.force_model(&ModelChoice::file(&path)).unwrap();
        assert!(Arc::ptr_eq(&held, &written));
        let current = status.current.as_ref().unwrap();
        assert_eq!((current.name.as_str(), current.is_saved), ("trained meanwhile", false));

        status.save((path.clone(), Existing::Replace), || {}).unwrap();
        while status.poll_saving(&library, &mut wanted).is_none() {}
        let current = status.current.as_ref().unwrap();
        assert_eq!((current.name.as_str(), current.is_saved), ("written.safetensors", true));
        assert_eq!(wanted, Some(path));
    }
}
