//! The model that answers: loaded in the background, or fresh from a training.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::app::shipped;
use crate::error_chain;
use crate::force::{ForceError, ForceModel};
use crate::jobs::{Job, Update};

/// Where the shipped model stands, from the folder of the program or its sources.
const SHIPPED_MODEL: &str = "assets/models/force.safetensors";

/// A model and where it comes from.
pub struct CurrentModel {
    /// The model.
    pub model: Arc<ForceModel>,
    /// For a person: the file's name, or that it was trained here.
    pub name: String,
    /// Whether a file holds it.
    pub is_saved: bool,
}

/// The model, and which one is wanted.
#[derive(Default)]
pub struct ModelStatus {
    /// The file that was asked for last; the inner `None` is the shipped model.
    requested: Option<Option<PathBuf>>,
    job: Option<Job<Result<(ForceModel, String), String>>>,
    /// What answers.
    pub current: Option<CurrentModel>,
    /// Why the wanted one does not.
    pub problem: Option<String>,
}

impl ModelStatus {
    /// Starts loading if another model is wanted than the last time. News for the user come back.
    pub fn update(
        &mut self,
        wanted: &Option<PathBuf>,
        wake: impl Fn() + Send + 'static,
    ) -> Option<Result<String, String>> {
        if self.requested.as_ref() != Some(wanted) {
            self.requested = Some(wanted.clone());
            let path = wanted.clone();
            match Job::spawn("load model", wake, move |_| load(path)) {
                Ok(job) => self.job = Some(job),
                Err(error) => return Some(Err(error.to_string())),
            }
        }
        let result = match self.job.as_mut()?.poll() {
            Update::Running => return None,
            Update::Finished(result) => result,
            Update::Panicked(text) => Err(format!("internal error: {text}")),
            Update::Gone => Err("the loader is gone".to_owned()),
        };
        self.job = None;
        Some(match result {
            Ok((model, name)) => {
                let said = format!("force model: {name}");
                self.current = Some(CurrentModel { model: Arc::new(model), name, is_saved: true });
                self.problem = None;
                Ok(said)
            }
            Err(problem) => {
                self.problem = Some(problem.clone());
                Err(problem)
            }
        })
    }

    /// Whether a model is being loaded.
    pub fn is_loading(&self) -> bool {
        self.job.is_some()
    }

    /// Takes a model that was just trained.
    pub fn take_trained(&mut self, model: ForceModel, name: String) {
        self.job = None;
        self.problem = None;
        self.current = Some(CurrentModel { model: Arc::new(model), name, is_saved: false });
    }

    /// Notes that a file holds the model now.
    pub fn saved_as(&mut self, path: &Path) {
        self.requested = Some(Some(path.to_owned()));
        if let Some(current) = &mut self.current {
            (current.name, current.is_saved) = (file_name(path), true);
        }
    }

    /// Reads the file again, e.g. after the user asked for it once more.
    pub fn reload(&mut self) {
        self.requested = None;
    }
}

fn load(path: Option<PathBuf>) -> Result<(ForceModel, String), String> {
    let (path, name) = match path {
        Some(path) => (path.clone(), file_name(&path)),
        None => match shipped(SHIPPED_MODEL) {
            Some(path) => (path, "shipped".to_owned()),
            None => return Err(format!("{SHIPPED_MODEL} is not beside the program")),
        },
    };
    let chain = |error: ForceError| format!("{}: {}", path.display(), error_chain(&error));
    ForceModel::load(&path).map(|model| (model, name)).map_err(chain)
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}
