//! The state of the model of one network.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::app::archive::{ArchiveEntry, ArchiveError, ArchiveFolder, NOTE_ENDING, name_of};
use crate::app::model::current::{CurrentModel, ModelEvent, ModelNews};
use crate::app::model::name::file_name;
use crate::app::network::TrainedModel;
use crate::app::tasks::{TaskKey, Tasks};
use impactlab_core::data::Existing;
use impactlab_core::error_chain;
use impactlab_core::jobs::ProgressCallback;
use impactlab_study::{Library, ModelChoice};

/// The state of the model of one network: the model in use, the one that is being loaded or saved,
/// and the one that a training has left beside it.
pub struct ModelStatus<M> {
    /// The model that was requested last; `None` if none has been requested yet, or if it must be read
    /// again.
    requested: Option<ModelChoice>,
    is_loading: bool,
    is_saving: bool,
    /// Number of models that are being kept.
    n_keeping: usize,
    /// Number of models that trainings have given since the start of the program.
    n_trained: usize,
    /// The model that answers questions; `None` before the first one is loaded.
    pub current: Option<CurrentModel<M>>,
    /// The model of the last training that is not in use, because the training was cancelled or the
    /// answers are about a scenario. It answers only after the user has asked for it.
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
            is_loading: false,
            is_saving: false,
            n_keeping: 0,
            n_trained: 0,
            current: None,
            set_aside: None,
            problem: None,
            typed_path: String::new(),
        }
    }
}

impl<M: TrainedModel> ModelStatus<M> {
    /// Starts to load a model if the project requests another one than before. If loading fails, the
    /// model in use stays.
    ///
    /// - `wanted`: the model in the question.
    pub fn update(&mut self, wanted: &ModelChoice, library: &Arc<Library>, tasks: &mut Tasks) {
        if self.requested.as_ref() == Some(wanted) {
            return;
        }
        self.requested = Some(wanted.clone());
        self.is_loading = true;
        let (choice, library) = (wanted.clone(), Arc::clone(library));
        let event = |result| M::command(ModelEvent::Loaded(result));
        tasks.start(TaskKey::LoadModel(M::NETWORK), move |_| load(choice, &library), event);
    }

    /// Takes what a task has made of a model. One that was saved or kept is identified by its file from
    /// then on, also if another model has come into use meanwhile.
    ///
    /// - `wanted`: the model in the question.
    pub fn take(
        &mut self,
        event: &ModelEvent<M>,
        library: &Library,
        wanted: &mut ModelChoice,
    ) -> ModelNews {
        match event {
            // Another model has come into use meanwhile.
            ModelEvent::Loaded(_) if !self.is_loading => ModelNews::Nothing,
            ModelEvent::Loaded(result) => {
                (self.is_loading, self.problem) = (false, None);
                match result {
                    Ok(current) => {
                        // One that is in no file stays at hand, so that it can be used and saved.
                        let before = self.current.replace(current.clone());
                        let kept = [self.set_aside.take(), before.filter(|of| !of.is_saved)];
                        let mut others = kept.into_iter().flatten();
                        self.set_aside = others.find(|of| of.choice != current.choice);
                    }
                    Err(problem) => {
                        self.problem = Some(problem.clone());
                        return ModelNews::Problem(problem.clone());
                    }
                }
                ModelNews::Nothing
            }
            ModelEvent::Saved(model, result) => {
                self.is_saving = false;
                if let Ok(path) = result {
                    self.identify(model, path, file_name(path), library, wanted);
                }
                ModelNews::Saved(result.clone())
            }
            ModelEvent::Archived(model, result) => {
                self.n_keeping = self.n_keeping.saturating_sub(1);
                ModelNews::Archived(result.clone().map(|(entry, path)| {
                    // A file to which the user has saved it meanwhile comes before the kept one.
                    let current = self.current.as_ref();
                    if current.is_some_and(|of| Arc::ptr_eq(&of.model, model) && of.is_saved) {
                        M::hold(library, ModelChoice::file(&path), Arc::clone(model));
                    } else {
                        self.identify(model, &path, entry.name.clone(), library, wanted);
                    }
                    entry
                }))
            }
        }
    }

    /// Whether a model is being loaded.
    pub fn is_loading(&self) -> bool {
        self.is_loading
    }

    /// Receives a model that was just trained and puts it into the library.
    ///
    /// - `name`: description of the training, shown to the user; a number is appended from the
    ///   second training on;
    /// - `wanted`: the model in the question, which becomes this one; `None` sets it aside;
    /// - returns the model and the name that it has got.
    pub fn take_trained(
        &mut self,
        model: M,
        name: String,
        library: &Library,
        wanted: Option<&mut ModelChoice>,
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
        if let Some(wanted) = wanted {
            self.use_trained(wanted);
        }
        taken
    }

    /// Starts to keep a model that was just trained in the user's data folder. Once it is kept, its
    /// training cannot be lost any more, and the checkpoint of a completed training is removed.
    ///
    /// - `draft`: its note;
    /// - `checkpoint`: the files of the training, if this window stores any.
    pub fn keep(
        &mut self,
        model: Arc<M>,
        draft: ArchiveEntry,
        folder: ArchiveFolder,
        checkpoint: Option<PathBuf>,
        tasks: &mut Tasks,
    ) {
        let written = Arc::clone(&model);
        self.n_keeping += 1;
        let key = TaskKey::KeepModel(M::NETWORK, draft.name.clone());
        let work = move |_: &mut ProgressCallback<'_>| {
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
        };
        tasks.start(key, work, |result| M::command(ModelEvent::Archived(model, result)));
    }

    /// Whether a model is being kept.
    pub fn is_keeping(&self) -> bool {
        self.n_keeping > 0
    }

    /// Returns the name of a model that is in no file: the one in use or the one that was set aside.
    pub fn unsaved(&self) -> Option<&str> {
        let mut models = [&self.current, &self.set_aside].into_iter().flatten();
        models.find(|model| !model.is_saved).map(|model| model.name.as_str())
    }

    /// Identifies a model by a file that holds it from now on, also if it is not in use.
    fn identify(
        &mut self,
        model: &Arc<M>,
        path: &Path,
        name: String,
        library: &Library,
        wanted: &mut ModelChoice,
    ) {
        let choice = ModelChoice::file(path);
        let is_it = |of: &&mut CurrentModel<M>| Arc::ptr_eq(&of.model, model);
        if let Some(current) = self.current.as_mut().filter(is_it) {
            // Another one that was chosen meanwhile stays chosen.
            if *wanted == current.choice {
                wanted.clone_from(&choice);
                self.requested = Some(choice.clone());
            }
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
    /// - `wanted`: the model in the question, which becomes this one.
    pub fn use_trained(&mut self, wanted: &mut ModelChoice) {
        let Some(trained) = self.set_aside.take() else { return };
        self.is_loading = false;
        self.problem = None;
        wanted.clone_from(&trained.choice);
        self.requested = Some(trained.choice.clone());
        self.current = Some(trained);
    }

    /// Makes the next update read the requested model again.
    pub fn reload(&mut self) {
        self.requested = None;
    }

    /// Starts writing the model in use to a file.
    ///
    /// - `existing`: what happens to a file that exists already.
    ///
    /// # Errors
    /// A message for the user, if there is no model.
    pub fn save(
        &mut self,
        path: PathBuf,
        existing: Existing,
        tasks: &mut Tasks,
    ) -> Result<(), String> {
        let Some(current) = &self.current else {
            return Err(format!("there is no {} to save", M::NETWORK.model()));
        };
        let (model, written) = (Arc::clone(&current.model), Arc::clone(&current.model));
        self.is_saving = true;
        let write = move |_: &mut ProgressCallback<'_>| {
            written.save(&path, existing).map(|()| path).map_err(|error| error_chain(&error))
        };
        let event = |result| M::command(ModelEvent::Saved(model, result));
        tasks.start(TaskKey::SaveModel(M::NETWORK), write, event);
        Ok(())
    }

    /// Whether a file is being written.
    pub fn is_saving(&self) -> bool {
        self.is_saving
    }
}

/// Writes a model into the folder of kept models.
fn keep<M: TrainedModel>(
    model: &M,
    draft: ArchiveEntry,
    folder: &ArchiveFolder,
) -> Result<ArchiveEntry, ArchiveError> {
    let problem = |error: M::Error| ArchiveError::Content(error_chain(&error));
    let sha256 = model.sha256().map_err(problem)?;
    let write = |path: &Path| model.save(path, Existing::Replace).map_err(problem);
    folder.put(ArchiveEntry { sha256, ..draft }, write)
}

fn load<M: TrainedModel>(
    choice: ModelChoice,
    library: &Library,
) -> Result<CurrentModel<M>, String> {
    let name = choice.path().map(|path| name_of(path).unwrap_or_else(|| file_name(path)));
    let name = name.unwrap_or_else(|| choice.to_string());
    match M::from_library(library, &choice) {
        Ok(model) => {
            let is_saved = !matches!(choice, ModelChoice::Held { .. });
            Ok(CurrentModel { choice, model, name, is_saved })
        }
        Err(error) => Err(format!("{choice}: {}", error_chain(&error))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::command::Command;
    use impactlab_networks::force::ForceModel;
    use impactlab_networks::shipped::ModelSource;

    /// Receives what the tasks have made of the force model, until they have ended.
    fn settle(
        status: &mut ModelStatus<ForceModel>,
        tasks: &mut Tasks,
        library: &Library,
        wanted: &mut ModelChoice,
    ) -> Vec<ModelNews> {
        let mut news = Vec::new();
        while status.is_loading() || status.is_saving() {
            for command in tasks.poll() {
                let Command::ForceModel(event) = command else { panic!("{command:?}") };
                news.push(status.take(&event, library, wanted));
            }
        }
        news
    }

    #[test]
    fn a_model_that_comes_into_use_while_another_is_written_is_not_taken_for_the_written_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("written.safetensors");
        let (library, mut tasks) = (Arc::new(Library::default()), Tasks::default());
        let mut status = ModelStatus::<ForceModel>::default();
        let mut wanted = ModelChoice::default();
        status.update(&wanted, &library, &mut tasks);
        settle(&mut status, &mut tasks, &library, &mut wanted);
        let written = Arc::clone(&status.current.as_ref().unwrap().model);
        status.save(path.clone(), Existing::Replace, &mut tasks).unwrap();
        let trained = ModelSource::Shipped.force_model().unwrap();
        let used = Some(&mut wanted);
        status.take_trained(trained, "trained meanwhile".to_owned(), &library, used);
        let in_use = wanted.clone();
        let saved = settle(&mut status, &mut tasks, &library, &mut wanted);
        assert!(matches!(&saved[..], [ModelNews::Saved(Ok(saved))] if *saved == path));
        assert_eq!(wanted, in_use);
        let held = library.force_model(&ModelChoice::file(&path)).unwrap();
        assert!(Arc::ptr_eq(&held, &written));
        let current = status.current.as_ref().unwrap();
        assert_eq!((current.name.as_str(), current.is_saved), ("trained meanwhile", false));

        status.save(path.clone(), Existing::Replace, &mut tasks).unwrap();
        settle(&mut status, &mut tasks, &library, &mut wanted);
        let current = status.current.as_ref().unwrap();
        assert_eq!((current.name.as_str(), current.is_saved), ("written.safetensors", true));
        assert_eq!(wanted, ModelChoice::file(path));
    }

    /// The window closed without a word of a network that was in no file, once another had been chosen.
    #[test]
    fn a_trained_model_in_no_file_is_at_hand_beside_another_and_unsaved_when_it_comes_back() {
        let (library, mut tasks) = (Arc::new(Library::default()), Tasks::default());
        let mut status = ModelStatus::<ForceModel>::default();
        let mut wanted = ModelChoice::default();
        let trained = ModelSource::Shipped.force_model().unwrap();
        status.take_trained(trained, "trained".to_owned(), &library, Some(&mut wanted));
        let undone = std::mem::take(&mut wanted);
        for (wanted, is_in_use) in [(&mut wanted, false), (&mut undone.clone(), true)] {
            status.update(wanted, &library, &mut tasks);
            settle(&mut status, &mut tasks, &library, wanted);
            assert_eq!(status.current.as_ref().unwrap().choice, *wanted);
            assert_eq!(
                (status.unsaved(), status.set_aside.is_none()),
                (Some("trained"), is_in_use)
            );
        }
    }

    /// A case that was opened while the last network was being kept asked that one instead of its own.
    #[test]
    fn a_model_that_was_chosen_while_the_one_in_use_is_written_stays_chosen() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("trained.safetensors");
        let (library, mut tasks) = (Arc::new(Library::default()), Tasks::default());
        let mut status = ModelStatus::<ForceModel>::default();
        let mut wanted = ModelChoice::default();
        let trained = ModelSource::Shipped.force_model().unwrap();
        status.take_trained(trained, "trained".to_owned(), &library, Some(&mut wanted));
        status.save(path.clone(), Existing::Refuse, &mut tasks).unwrap();
        wanted = ModelChoice::default();
        settle(&mut status, &mut tasks, &library, &mut wanted);
        assert_eq!(wanted, ModelChoice::default());
        let current = status.current.as_ref().unwrap();
        assert_eq!((&current.choice, current.is_saved), (&ModelChoice::file(path), true));
        status.update(&wanted, &library, &mut tasks);
        settle(&mut status, &mut tasks, &library, &mut wanted);
        assert_eq!(status.current.as_ref().unwrap().choice, ModelChoice::default());
    }
}
