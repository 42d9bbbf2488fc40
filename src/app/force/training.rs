//! A training of the force network in the background.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::app::force::TrainingForm;
use crate::app::source::CheckedDataset;
use crate::app::training::{Tell, TrainingNews};
use crate::error_chain;
use crate::force::{
    ForceCase, ForceConfig, ForceModel, ForceTrainSettings, ForceTrainingSet, train,
};
use crate::learning::TrainingReport;

/// What a training learns from.
pub struct ForceTrainingData {
    /// What a person calls it.
    pub name: String,
    /// Of these cases some are kept for the test.
    pub dataset: Arc<CheckedDataset>,
    /// All of these cases are learned from.
    pub extra: Vec<Arc<CheckedDataset>>,
}

/// Trains a force network.
///
/// # Errors
/// A message for the user.
pub fn run_force_training(
    data: ForceTrainingData,
    (form, checkpoint): (&TrainingForm, Option<PathBuf>),
    tell: &mut Tell<'_>,
) -> Result<ForceModel, String> {
    let mut config = match form.config.trim() {
        "" => ForceConfig::default(),
        path => ForceConfig::load(Path::new(path)).map_err(|error| error_chain(&error))?,
    };
    config.training.epochs = form.epochs;
    let mut read = |checked: &CheckedDataset| {
        let (cases, problems) = ForceCase::of_dataset(&checked.dataset);
        for problem in problems {
            // Cancelling takes effect at the first report of the training itself.
            let _ = tell(TrainingNews::LeftOut(error_chain(&problem)));
        }
        cases
    };
    let cases = read(&data.dataset);
    let extra: Vec<ForceCase> = data.extra.iter().flat_map(|checked| read(checked)).collect();
    let share = config.training.test_share;
    let set = ForceTrainingSet::of_split(data.name, &cases, form.seed, share).with_extra(&extra);
    let settings = ForceTrainSettings { config, seed: form.seed, checkpoint, resume: form.resume };
    let mut report = |report: &TrainingReport| tell(TrainingNews::Report(report.clone()));
    train(&set, &settings, &mut report).map_err(|error| error_chain(&error))
}
