//! The model that answers the questions of one network. It is loaded and saved in the background,
//! or it comes from a training.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::app::kept::{KeptEntry, KeptError, KeptFolder, NOTE_ENDING, name_of};
use crate::app::network::TrainedModel;
use impactlab_core::data::Existing;
use impactlab_core::error_chain;
use impactlab_core::jobs::Job;
use impactlab_networks::shipped::ModelSource;
use impactlab_study::{Library, ModelChoice};

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

/// A model that is being kept in the user's data folder.
struct Keeping<M> {
    model: Arc<M>,
    /// Why the model is not kept, with its name.
    job: Job<Result<(KeptEntry, PathBuf), String>>,
}

/// The state of the model of one network: the model in use, the one that is being loaded or saved,
/// and the one that a cancelled training has left.
pub struct ModelStatus<M> {
    /// The file that was requested last; the inner `None` is the shipped model. The outer `None`
    /// means that no model has been requested yet, or that it must be read again.
    requested: Option<Option<PathBuf>>,
    job: Option<Job<Result<CurrentModel<M>, String>>>,
    saving: Option<Saving<M>>,
    keeping: Vec<Keeping<M>>,
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
            keeping: Vec::new(),
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
    /// - `is_used`: whether the model answers questions from now on; otherwise it is set aside;
    /// - returns the model and the name that it has got.
    pub fn take_trained(
        &mut self,
        model: M,
        name: String,
        (library, is_used): (&Library, bool),
    ) -> (Arc<M>, String) {
        self.n_trained += 1;
        // The library identifies a model by its name. Two models of the same name would make the
        // answers of one pass for those of the other.
        let name = match self.n_trained {
            1 => name,
            n => format!("{name} (training {n})"),
        };
        let (choice, model) = (ModelChoice::held(&name), Arc::new(model));
        M::hold(library, choice.clone(), Arc::clone(&model));
        let taken = (Arc::clone(&model), name.clone());
        self.set_aside = Some(CurrentModel { choice, model, name, is_saved: false });
        if is_used {
            self.use_trained();
        }
        taken
    }

    /// Starts to keep a model that was just trained in the user's data folder. Once it is kept, its
    /// training cannot be lost any more, and the checkpoint of a completed training is removed.
    ///
    /// - `draft`: its note;
    /// - `checkpoint`: the files of the training, if this window stores any;
    /// - `wake`: called when it is kept.
    ///
    /// # Errors
    /// The error of the operating system, if the thread cannot be started.
    pub fn keep(
        &mut self,
        (model, draft): (Arc<M>, KeptEntry),
        (folder, checkpoint): (KeptFolder, Option<PathBuf>),
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<()> {
        let written = Arc::clone(&model);
        let job = Job::spawn("keep model", wake, move |_| {
            let (name, is_complete) = (draft.name.clone(), !draft.is_cancelled);
            let entry = keep(&*written, draft, &folder)
                .map_err(|error| format!("{name} is not kept: {}", error_chain(&error)))?;
            for file in checkpoint.filter(|_| is_complete).iter() {
                // What cannot be removed is offered as a training that can go on, to its end.
                let _ = std::fs::remove_file(file);
                let _ = std::fs::remove_file(file.with_extension(NOTE_ENDING));
            }
            let path = folder.path_of(&entry);
            Ok((entry, path))
        })?;
        self.keeping.push(Keeping { model, job });
        Ok(())
    }

    /// Whether a model is being kept.
    pub fn is_keeping(&self) -> bool {
        !self.keeping.is_empty()
    }

    /// Returns the name of a model that is in no file: the one in use or the one that was set aside.
    pub fn unsaved(&self) -> Option<&str> {
        let mut models = [&self.current, &self.set_aside].into_iter().flatten();
        models.find(|model| !model.is_saved).map(|model| model.name.as_str())
    }

    /// Returns the note of a model that has just been kept, or why it could not be; `None` otherwise.
    /// The model is identified by its file from then on.
    ///
    /// - `wanted`: file of the model that the project requests, which becomes that of the kept one
    ///   if it is in use.
    pub fn poll_keeping(
        &mut self,
        library: &Library,
        wanted: &mut Option<PathBuf>,
    ) -> Option<Result<KeptEntry, String>> {
        let poll = |keeping: &mut Keeping<M>| keeping.job.poll().into_result("the writer");
        let (idx, result) = self
            .keeping
            .iter_mut()
            .enumerate()
            .find_map(|(idx, keeping)| Some((idx, poll(keeping)?)))?;
        let Keeping { model, .. } = self.keeping.remove(idx);
        // A file to which the user has saved it meanwhile comes before the kept one.
        let current = self.current.as_ref();
        let is_saved = current.is_some_and(|of| Arc::ptr_eq(&of.model, &model) && of.is_saved);
        Some(result.map(|(entry, path)| {
            if is_saved {
                M::hold(library, ModelChoice::file(&path), model);
            } else {
                self.identify((&model, &path), entry.name.clone(), (library, wanted));
            }
            entry
        }))
    }

    /// Identifies a model by a file that holds it from now on, also if it is not in use.
    fn identify(
        &mut self,
        (model, path): (&Arc<M>, &Path),
        name: String,
        (library, wanted): (&Library, &mut Option<PathBuf>),
    ) {
        let choice = ModelChoice::file(path);
        let is_it = |of: &&mut CurrentModel<M>| Arc::ptr_eq(&of.model, model);
        if let Some(current) = self.current.as_mut().filter(is_it) {
            *wanted = Some(path.to_owned());
            self.requested = Some(wanted.clone());
            current.choice = choice.clone();
            (current.name, current.is_saved) = (name, true);
        } else if let Some(set_aside) = self.set_aside.as_mut().filter(is_it) {
            set_aside.choice = choice.clone();
            (set_aside.name, set_aside.is_saved) = (name, true);
        }
        M::hold(library, choice, Arc::clone(model));
    }

    /// Puts the model that was set aside into use and stops loading another one.
    ///
    /// - returns the file that holds it, if there is one: what the project requests from now on.
    pub fn use_trained(&mut self) -> Option<PathBuf> {
        let trained = self.set_aside.take()?;
        self.job = None;
        self.problem = None;
        let path = match &trained.choice {
            ModelChoice::Source(ModelSource::File(path)) => Some(path.clone()),
            _ => None,
        };
        if path.is_some() {
            self.requested = Some(path.clone());
        }
        self.current = Some(trained);
        path
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
            self.identify((&model, path), file_name(path), (library, wanted));
        }
        Some(result)
    }
}

/// Writes a model into the folder of kept models.
fn keep<M: TrainedModel>(
    model: &M,
    draft: KeptEntry,
    folder: &KeptFolder,
) -> Result<KeptEntry, KeptError> {
    let sha256 = model.digest().map_err(KeptError::Content)?;
    let write = |path: &Path| model.write(path, Existing::Replace).map_err(KeptError::Content);
    folder.put(KeptEntry { sha256, ..draft }, write)
}

fn load<M: TrainedModel>(
    path: Option<PathBuf>,
    library: &Library,
) -> Result<CurrentModel<M>, String> {
    let name = path.as_deref().map(|path| name_of(path).unwrap_or_else(|| file_name(path)));
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
    use impactlab_networks::force::ForceModel;

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
