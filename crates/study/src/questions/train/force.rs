//! A training of the force network: `train force`.

use std::path::PathBuf;
use std::time::Instant;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::caveats::restrictions;

use crate::ask::checks::check_count;
use crate::ask::inputs::{data_names, force_cases};
use crate::ask::provenance::FORCE_NETWORK;
use crate::{Answer, Event, Library, Observer, Provenance, Question, StudyError, TrainingOptions};
use impactlab_core::data::Outcome;
use impactlab_core::ranges::EPOCHS;
use impactlab_networks::force::{
    ForceConfig, ForceModel, ForceTrainSettings, ForceTrainingSet, LossTerms, VarianceCalibration,
    train,
};

/// Asks for a force network that has learned from force data sets.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TrainForceRequest {
    /// A force data set; a share of its cases is kept apart for the test.
    pub data: PathBuf,
    /// Other force data sets, all of them to learn from.
    #[serde(default)]
    pub extra: Vec<PathBuf>,
    /// Without a file of settings, the sizes of the paper instead of the default ones.
    #[serde(default)]
    pub paper: bool,
    /// Epochs at most, instead of the configured number.
    #[serde(default)]
    pub epochs: Option<usize>,
    /// Settings, seed, checkpoint.
    #[serde(flatten)]
    pub training: TrainingOptions,
}

/// What was trained.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct TrainForceReport {
    /// What the data are called.
    pub data: String,
    /// SHA-256 over the cases learned from.
    pub data_digest: String,
    /// Cases learned from.
    pub n_train: usize,
    /// Cases that decided when to stop.
    pub n_validation: usize,
    /// Cases kept apart for the test.
    pub n_test: usize,
    /// Weights of the network.
    pub n_parameters: usize,
    /// How long it took, s.
    pub seconds: f64,
    /// Epoch whose weights these are, from 1.
    pub best_epoch: usize,
    /// Epochs in all.
    pub epochs: usize,
    /// Factors on the variances, from calibration on training cases.
    pub variance_factors: VarianceCalibration,
    /// Losses of the best epoch over the cases learned from.
    pub train: Option<LossTerms>,
    /// The same over the validation cases.
    pub validation: Option<LossTerms>,
    /// Cases that were left out, and why.
    pub left_out: Vec<String>,
}

/// A trained force network.
#[derive(Debug)]
pub struct TrainForceAnswer {
    /// What is told, with what restricts it and where it comes from.
    pub report: Answer<TrainForceReport>,
    /// The network.
    pub model: ForceModel,
}

impl TrainForceRequest {
    /// The settings that it trains with.
    ///
    /// # Errors
    /// [`StudyError::Force`] or [`StudyError::Data`] with what is wrong with the file.
    pub fn settings(&self) -> Result<ForceConfig, StudyError> {
        let mut config = match self.training.config.file() {
            Some(path) => ForceConfig::load(path)?,
            None if self.paper => ForceConfig::paper(),
            None => ForceConfig::default(),
        };
        config.training.epochs = self.epochs.unwrap_or(config.training.epochs);
        Ok(config)
    }

    /// The cases to learn from, and why others are left out.
    pub(crate) fn training_set(
        &self,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<(ForceTrainingSet, Vec<String>)>, StudyError> {
        let cases = force_cases(&self.data, self.training.bad_cases, library, observer)?;
        let Outcome::Complete(mut usable) = cases else { return Ok(Outcome::Cancelled) };
        let mut extra = Vec::new();
        for root in &self.extra {
            let cases = force_cases(root, self.training.bad_cases, library, observer)?;
            let Outcome::Complete(more) = cases else { return Ok(Outcome::Cancelled) };
            extra.extend(more.cases);
            usable.left_out.extend(more.left_out);
        }
        let name = data_names(std::iter::once(&self.data).chain(&self.extra));
        let share = self.settings()?.training.test_share;
        let set = ForceTrainingSet::from_split(name, &usable.cases, self.training.seed, share);
        Ok(Outcome::Complete((set.with_extra(&extra), usable.left_out)))
    }
}

impl Question for TrainForceRequest {
    type Answer = TrainForceAnswer;
    type Report = Answer<TrainForceReport>;
    const NAME: &'static str = "train";

    fn check(&self) -> Result<(), StudyError> {
        self.epochs.map_or(Ok(()), |epochs| check_count("epochs", &EPOCHS, epochs))
    }

    fn report(answer: &Self::Answer) -> &Self::Report {
        &answer.report
    }

    fn solve(
        &self,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<TrainForceAnswer>, StudyError> {
        // Held until the training is over.
        let _claim = self.training.claim()?;
        let config = self.settings()?;
        let set = self.training_set(library, observer)?;
        let Outcome::Complete((set, left_out)) = set else { return Ok(Outcome::Cancelled) };
        let settings = ForceTrainSettings {
            config,
            seed: self.training.seed,
            checkpoint: self.training.checkpoint.clone(),
            resume: self.training.resume,
        };
        let started = Instant::now();
        let model = train(&set, &settings, &mut |report| observer(Event::Training(report)))?;
        let seconds = started.elapsed().as_secs_f64();
        let provenance = Provenance::from_seed(self.training.seed);
        let provenance = provenance.with_trained(FORCE_NETWORK, &model)?;
        let left_out_cases = restrictions::left_out_caveat(left_out.len(), "cases");
        let report = Answer {
            report: TrainForceReport::new(&model, seconds, left_out),
            caveats: left_out_cases.into_iter().collect(),
            provenance,
        };
        Ok(Outcome::Complete(TrainForceAnswer { report, model }))
    }
}

impl TrainForceReport {
    pub(crate) fn new(model: &ForceModel, seconds: f64, left_out: Vec<String>) -> Self {
        let record = model.record();
        let best = record.detail.best_epoch.checked_sub(1).and_then(|idx| record.history.get(idx));
        Self {
            data: record.data.clone(),
            data_digest: record.data_digest.clone(),
            n_train: record.train.len(),
            n_validation: record.detail.validation.len(),
            n_test: record.test.len(),
            n_parameters: model.n_parameters(),
            seconds,
            best_epoch: record.detail.best_epoch,
            epochs: record.history.len(),
            variance_factors: record.detail.variance_factors,
            train: best.map(|record| record.detail.train),
            validation: best.map(|record| record.detail.validation),
            left_out,
        }
    }
}
