//! A comparison of models: made in the background, or read from a file.

use std::path::PathBuf;
use std::sync::Arc;

use crate::app::response::ComparisonForm;
use crate::app::source::CheckedDataset;
use crate::error_chain;
use crate::jobs::{Job, Report};
use crate::response::comparison::{
    Comparison, ComparisonSettings, compare_models, write_comparison,
};
use crate::response::{ResponseCase, ResponseConfig};
use crate::vehicle::VehicleParameters;

/// What is compared on what.
pub struct ComparisonRequest {
    /// What the data are called.
    pub name: String,
    /// The trajectories.
    pub dataset: Arc<CheckedDataset>,
    /// The struck vehicle.
    pub vehicle: VehicleParameters,
    /// Numbers, choices, seed, settings.
    pub form: ComparisonForm,
}

/// A comparison, under way or over.
#[derive(Default)]
pub struct ComparisonStatus {
    /// Under way; `None` in the end if it was cancelled.
    pub job: Option<Job<Result<Option<Comparison>, String>>>,
    saving: Option<Job<Result<PathBuf, String>>>,
    /// The latest that is over, or why there is none.
    pub result: Option<Result<Arc<Comparison>, String>>,
    /// A folder to which it is to be saved, being typed.
    pub typed_path: String,
}

impl ComparisonStatus {
    /// Trains and compares; what is under way is dropped.
    ///
    /// # Errors
    /// The operating system's, if no thread can be started.
    pub fn start(
        &mut self,
        request: ComparisonRequest,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<()> {
        let job = Job::spawn_in_background("compare", wake, move |report| run(&request, report))?;
        self.job = Some(job);
        Ok(())
    }

    /// Stops what is under way.
    pub fn cancel(&self) {
        if let Some(job) = &self.job {
            job.cancel();
        }
    }

    /// Reads a `comparison.json`.
    ///
    /// # Errors
    /// The operating system's, if no thread can be started.
    pub fn open(&mut self, path: PathBuf, wake: impl Fn() + Send + 'static) -> std::io::Result<()> {
        let job = Job::spawn("open comparison", wake, move |_| {
            Comparison::load(&path).map(Some).map_err(|error| error_chain(&error))
        })?;
        self.job = Some(job);
        Ok(())
    }

    /// Writes the comparison into a folder: JSON, Markdown, tables.
    ///
    /// # Errors
    /// A message for the user.
    pub fn save(
        &mut self,
        folder: PathBuf,
        wake: impl Fn() + Send + 'static,
    ) -> Result<(), String> {
        let Some(Ok(comparison)) = &self.result else {
            return Err("there is no comparison to save".to_owned());
        };
        let comparison = Arc::clone(comparison);
        let job = Job::spawn("save comparison", wake, move |_| {
            let written = write_comparison(&folder, &comparison);
            written.map(|()| folder).map_err(|error| error_chain(&error))
        });
        self.saving = Some(job.map_err(|error| error.to_string())?);
        Ok(())
    }

    /// Takes in what has come to an end: the folder that was written.
    pub fn poll(&mut self) -> Option<Result<PathBuf, String>> {
        let ended = self.job.as_mut().and_then(|job| job.poll().into_result("the comparison"));
        if let Some(result) = ended {
            self.job = None;
            match result {
                Ok(None) => {} // cancelled: the last one stays
                Ok(Some(comparison)) => self.result = Some(Ok(Arc::new(comparison))),
                Err(problem) => self.result = Some(Err(problem)),
            }
        }
        let saved = self.saving.as_mut()?.poll().into_result("the writer")?;
        self.saving = None;
        Some(saved)
    }

    /// The comparison, if there is one.
    pub fn comparison(&self) -> Option<&Arc<Comparison>> {
        self.result.as_ref()?.as_ref().ok()
    }
}

/// # Errors
/// A message for the user.
fn run(request: &ComparisonRequest, report: &mut Report<'_>) -> Result<Option<Comparison>, String> {
    let form = &request.form;
    let config = match form.config.trim() {
        "" => ResponseConfig::default(),
        path => ResponseConfig::load(path.as_ref()).map_err(|error| error_chain(&error))?,
    };
    let settings = ComparisonSettings {
        config,
        trajectories: trajectories(&form.trajectories)?,
        n_choices: form.n_choices.max(1),
        seed: form.seed,
    };
    let (cases, mut problems) =
        ResponseCase::of_dataset(&request.dataset.dataset, &request.vehicle);
    // Two runs on one data set shall have the same cases.
    if !problems.is_empty() {
        return Err(error_chain(&problems.swap_remove(0)));
    }
    compare_models((&request.name, &cases), None, &settings, report)
        .map_err(|error| error_chain(&error))
}

/// `5, 20` as numbers.
fn trajectories(text: &str) -> Result<Vec<usize>, String> {
    let number = |part: &str| match part.trim().parse::<usize>() {
        Ok(n) if n > 0 => Ok(n),
        _ => Err(format!("{part:?} is no number of trajectories, expected such as 5, 20")),
    };
    text.split(',').map(number).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_trajectories_are_read_or_refused() {
        assert_eq!(trajectories("5, 20"), Ok(vec![5, 20]));
        assert!(trajectories("5, x").unwrap_err().contains("\" x\""));
        assert!(trajectories("0").is_err() && trajectories("").is_err());
    }
}
