//! A training of the response network in the background.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::app::network::TrainedModel;
use crate::app::response::{ResponseTrainingForm, TrainingMode};
use crate::app::source::CheckedDataset;
use crate::app::training::{Tell, TrainingNews};
use crate::error_chain;
use crate::learning::{TEST_SHARE, TrainingReport, split};
use crate::response::{
    ImpactRecord, ResponseCase, ResponseConfig, ResponseModel, ResponseTrainSettings,
    ResponseTrainingSet, fine_tune, pretrain,
};
use crate::shipped::ModelSource;
use crate::vehicle::VehicleParameters;

/// What a training learns from.
pub struct ResponseTrainingData {
    /// What a person calls it.
    pub name: String,
    /// The trajectories.
    pub dataset: Arc<CheckedDataset>,
    /// The struck vehicle.
    pub vehicle: VehicleParameters,
    /// The current model.
    pub current: Option<Arc<ResponseModel>>,
}

/// Trains a response network.
///
/// # Errors
/// A message for the user.
pub fn run_response_training(
    data: &ResponseTrainingData,
    (form, checkpoint): (&ResponseTrainingForm, Option<PathBuf>),
    tell: &mut Tell<'_>,
) -> Result<ResponseModel, String> {
    let (cases, problems) = ResponseCase::of_dataset(&data.dataset.dataset, &data.vehicle);
    for problem in problems {
        // Cancelling takes effect at the first report of the training itself.
        let _ = tell(TrainingNews::LeftOut(error_chain(&problem)));
    }
    let mut report = |report: &TrainingReport| tell(TrainingNews::Report(report.clone()));
    let start = start_of(data, form.mode)?;
    let config = config_of(form, start.as_deref())?;
    let settings =
        ResponseTrainSettings { config, seed: form.choice, checkpoint, resume: form.resume };
    let trained = match form.mode {
        TrainingMode::Pretrain => {
            let kept = split(&cases, form.seed, TEST_SHARE).train;
            let records: Vec<ImpactRecord> = kept
                .into_iter()
                .filter_map(|idx| cases.get(idx).and_then(ResponseCase::impact))
                .collect();
            pretrain((&data.name, &records), &settings, &mut report)
        }
        _ => {
            let wanted = (form.n_trajectories > 0).then_some(form.n_trajectories);
            ResponseTrainingSet::of_split(&data.name, &cases, form.seed, TEST_SHARE)
                .choose(wanted, form.choice)
                .and_then(|set| fine_tune(start.as_deref(), &set, &settings, &mut report))
        }
    };
    trained.map_err(|error| error_chain(&error))
}

/// The model that is fine-tuned.
fn start_of(
    data: &ResponseTrainingData,
    mode: TrainingMode,
) -> Result<Option<Arc<ResponseModel>>, String> {
    Ok(match mode {
        TrainingMode::FineTuneShipped => {
            Some(Arc::new(ResponseModel::read(&ModelSource::ShippedPretrained)?))
        }
        TrainingMode::FineTuneCurrent => {
            let current = data.current.clone();
            Some(current.ok_or_else(|| "there is no current response model".to_owned())?)
        }
        TrainingMode::FromScratch | TrainingMode::Pretrain => None,
    })
}

fn config_of(
    form: &ResponseTrainingForm,
    start: Option<&ResponseModel>,
) -> Result<ResponseConfig, String> {
    match (form.config.trim(), start) {
        ("", Some(start)) => Ok(start.config().clone()),
        ("", None) => Ok(ResponseConfig::default()),
        (path, _) => ResponseConfig::load(Path::new(path)).map_err(|error| error_chain(&error)),
    }
}
