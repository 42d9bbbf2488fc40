//! What the response network learns from recorded motions: `fine-tune response`, and `condition
//! response`.

use crate::caveats::assumed;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use impactlab_core::uncertainty::{Caveat, CaveatKind, CaveatSubject};
use impactlab_core::units::Phrase;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::ask::checks::{check, check_count};
use crate::ask::inputs::{OpenVehicle, data_name, dataset_folders, response_cases, struck_vehicle};
use crate::questions::train::response::TrainingNotes;
use crate::{
    Answer, ConfigChoice, Event, Library, ModelChoice, MotionLogs, Observer, Question,
    ResponseTrainingAnswer, ResponseTrainingReport, StudyError, TrainingOptions, VehicleChoice,
};
use impactlab_core::data::Outcome;
use impactlab_core::ranges::{TEST_SHARE as SHARE_OF_TEST, TRAJECTORIES};
use impactlab_networks::learning::{TEST_SHARE, TrainingReport};
use impactlab_networks::response::{
    ResponseConfig, ResponseModel, ResponseTrainSettings, ResponseTrainingSet, condition,
    fine_tune, train_fleet,
};

/// What is learned from recorded motions.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Learning {
    /// The network itself, for the cars of the data.
    #[default]
    Network,
    /// The network, and how cars differ, for cars of which there are no data.
    Fleet,
    /// The strengths of one car, by a network that knows how cars differ: seconds, no training.
    Strengths,
}

/// Asks for a response network that has learned from recorded motions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FineTuneRequest {
    /// What is learned.
    #[serde(default)]
    pub learning: Learning,
    /// The network to start from; without one all layers are trained, from random weights.
    #[serde(default)]
    pub model: Option<ModelChoice>,
    /// Trajectory data sets, or folders of such sets, of each of which a share of the cases is kept apart for the test.
    #[serde(default)]
    pub data: Vec<PathBuf>,
    /// Logs of single impacts instead of data sets.
    #[serde(default)]
    pub logs: Option<MotionLogs>,
    /// How many trajectories of each data set to learn from; all that are not kept for the test if
    /// not given.
    #[serde(default)]
    pub trajectories: Option<usize>,
    /// The struck vehicle.
    #[serde(default)]
    pub vehicle: VehicleChoice,
    /// Share of the cases that is kept for the test.
    #[serde(default = "default_test_share")]
    pub test_share: f64,
    /// Seed of the choice of the trajectories and of all other draws; the split's if not given.
    #[serde(default)]
    pub choice: Option<u64>,
    /// Settings, seed, checkpoint.
    #[serde(flatten)]
    pub training: TrainingOptions,
}

fn default_test_share() -> f64 {
    TEST_SHARE
}

impl Default for FineTuneRequest {
    fn default() -> Self {
        Self {
            learning: Learning::Network,
            model: None,
            data: Vec::new(),
            logs: None,
            trajectories: None,
            vehicle: VehicleChoice::default(),
            test_share: TEST_SHARE,
            choice: None,
            training: TrainingOptions::default(),
        }
    }
}

impl FineTuneRequest {
    /// The settings that it trains with, and the network that it starts from.
    ///
    /// # Errors
    /// [`StudyError::Learning`] with what is wrong with a file.
    pub fn settings(
        &self,
        library: &Library,
    ) -> Result<(ResponseConfig, Option<Arc<ResponseModel>>), StudyError> {
        let start = self.model.as_ref().map(|model| library.response_model(model)).transpose()?;
        let mut config = self.training.config.response(start.as_deref())?;
        if self.training.config == ConfigChoice::Default && self.logs.is_some() {
            config.effects = config.effects.few_samples();
        }
        Ok((config, start))
    }

    /// The trajectories to learn from.
    pub(crate) fn training_set(
        &self,
        notes: &mut TrainingNotes,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<ResponseTrainingSet>, StudyError> {
        if let Some(logs) = &self.logs {
            let vehicle = struck_vehicle(&self.vehicle, &OpenVehicle::Unknown, &mut notes.caveats)?;
            let medians = assumed::medians(CaveatSubject::VehicleParameter, &vehicle);
            notes.caveats.extend(medians);
            let (train, reports) = logs.read(vehicle, &mut notes.caveats)?;
            notes.logs = reports;
            let names: Vec<&str> = train.iter().map(|case| case.name.as_str()).collect();
            let set = ResponseTrainingSet { name: names.join(", "), train, test: Vec::new() };
            return Ok(Outcome::Complete(set));
        }
        let mut sets = Vec::new();
        for root in dataset_folders(&self.data)? {
            let caveats = &mut notes.caveats;
            let cases = response_cases(
                &root,
                &self.vehicle,
                self.training.bad_cases,
                caveats,
                library,
                observer,
            )?;
            let Outcome::Complete(usable) = cases else { return Ok(Outcome::Cancelled) };
            notes.left_out.extend(usable.left_out);
            let (name, share) = (data_name(&root), self.test_share);
            let set =
                ResponseTrainingSet::from_split(name, &usable.cases, self.training.seed, share);
            sets.push(set.choose(self.trajectories, self.choice_seed())?);
        }
        if sets.is_empty() {
            return Err(StudyError::NothingToLearnFrom);
        }
        Ok(Outcome::Complete(ResponseTrainingSet::joined(sets)))
    }

    fn learned(
        &self,
        start: Option<&ResponseModel>,
        set: &ResponseTrainingSet,
        settings: &ResponseTrainSettings,
        observer: &mut Observer<'_>,
    ) -> Result<ResponseModel, StudyError> {
        let mut report = |report: &TrainingReport| observer(Event::Training(report));
        Ok(match (self.learning, start) {
            (Learning::Network, start) => fine_tune(start, set, settings, &mut report)?,
            (Learning::Fleet, Some(start)) => train_fleet(start, set, settings, &mut report)?,
            (Learning::Strengths, Some(start)) => condition(start, set)?,
            (Learning::Fleet | Learning::Strengths, None) => return Err(StudyError::NoStart),
        })
    }

    fn choice_seed(&self) -> u64 {
        self.choice.unwrap_or(self.training.seed)
    }
}

impl Question for FineTuneRequest {
    type Answer = ResponseTrainingAnswer;
    type Report = Answer<ResponseTrainingReport>;
    const NAME: &'static str = "fine-tune";

    fn check(&self) -> Result<(), StudyError> {
        check("test_share", &SHARE_OF_TEST, self.test_share)?;
        if let Some(n) = self.trajectories {
            check_count("trajectories", &TRAJECTORIES, n)?;
        }
        self.logs.as_ref().map_or(Ok(()), MotionLogs::check)
    }

    fn report(answer: &Self::Answer) -> &Self::Report {
        &answer.report
    }

    fn solve(
        &self,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<ResponseTrainingAnswer>, StudyError> {
        // Held until the training is over.
        let _claim = self.training.claim()?;
        let (config, start) = self.settings(library)?;
        let start_digest = |model| library.response_model_digest(model);
        let mut notes = TrainingNotes {
            start: self.model.as_ref().map(start_digest).transpose()?,
            ..TrainingNotes::default()
        };
        let set = self.training_set(&mut notes, library, observer)?;
        let Outcome::Complete(set) = set else { return Ok(Outcome::Cancelled) };
        let settings = ResponseTrainSettings {
            config,
            seed: self.choice_seed(),
            checkpoint: self.training.checkpoint.clone(),
            resume: self.training.resume,
        };
        let started = Instant::now();
        let model = self.learned(start.as_deref(), &set, &settings, observer)?;
        notes.caveats.extend(cars_not_learned(self.learning, &model));
        let answer = ResponseTrainingAnswer::new(model, started.elapsed().as_secs_f64(), notes)?;
        Ok(Outcome::Complete(answer))
    }
}

/// That a training on a fleet was stopped before it had learned how cars differ: of its epochs nothing is
/// missing then.
fn cars_not_learned(learning: Learning, model: &ResponseModel) -> Option<Caveat> {
    let text = Phrase::new(
        "the training was stopped before it learned how cars differ: the network takes every car for those of \
         the data, and its intervals are too narrow for others; let the training end",
        "Das Training wurde abgebrochen, bevor gelernt war, wie sich Fahrzeuge unterscheiden. Das Netz hält jedes \
         Fahrzeug für eines der Daten, und für andere sind seine Intervalle zu eng; das Training ist bis zum Ende \
         zu führen",
    );
    (learning == Learning::Fleet && model.population().is_none())
        .then(|| Caveat::new(CaveatKind::OutsideDomain, text))
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_networks::shipped::ModelSource;

    #[test]
    fn a_fleet_that_was_not_learned_from_to_the_end_is_warned_of() {
        let of_one_kind = ModelSource::ShippedPretrained.response_model().unwrap();
        let caveat = cars_not_learned(Learning::Fleet, &of_one_kind).unwrap();
        assert!(caveat.is_warning(), "{caveat:?}");
        assert_eq!(cars_not_learned(Learning::Network, &of_one_kind), None);
        let of_fleet = ModelSource::Shipped.response_model().unwrap();
        assert_eq!(cars_not_learned(Learning::Fleet, &of_fleet), None);
    }
}
