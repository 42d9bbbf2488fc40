//! How well a response network does on recorded motions: `evaluate response`.

use std::path::PathBuf;

use impactlab_core::uncertainty::Caveats;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::ask::inputs::{UsableCases, data_name, response_cases};
use crate::caveats::restrictions;
use crate::{
    Answer, BadCases, CompareAnswer, CompareReport, EvaluatedCases, Library, ModelChoice, Observer,
    Question, StudyError, VehicleChoice,
};
use impactlab_core::data::Outcome;
use impactlab_networks::response::evaluate::{MotionModel, evaluate_motion_model};
use impactlab_networks::response::{Correction, ResponseCase, ResponseModel};

/// Asks how well a response network predicts the motions of a data set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EvaluateResponseRequest {
    /// The response network.
    #[serde(default)]
    pub model: ModelChoice,
    /// The trajectory data set.
    pub data: PathBuf,
    /// Which of its cases.
    #[serde(default)]
    pub split: EvaluatedCases,
    /// The struck vehicle.
    #[serde(default)]
    pub vehicle: VehicleChoice,
    /// Seed of the clusters.
    #[serde(default)]
    pub seed: u64,
    /// What happens to cases that cannot be used.
    #[serde(default)]
    pub bad_cases: BadCases,
}

impl EvaluateResponseRequest {
    /// The trajectories that the model is evaluated on, and why others are left out. Of those that it has learned
    /// from it is told how many they are.
    pub(crate) fn cases(
        &self,
        model: &ResponseModel,
        caveats: &mut Caveats,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<UsableCases<ResponseCase>>, StudyError> {
        let cases =
            response_cases(&self.data, &self.vehicle, self.bad_cases, caveats, library, observer)?;
        let Outcome::Complete(usable) = cases else { return Ok(Outcome::Cancelled) };
        let cases = match self.split {
            EvaluatedCases::All => usable.cases,
            EvaluatedCases::Test => test_cases(model, usable.cases),
        };
        if cases.is_empty() {
            return Err(StudyError::NoTestCase { path: self.data.clone() });
        }
        let n_known = cases.iter().filter(|case| model.is_trained_on(case)).count();
        caveats.extend(restrictions::trained_on_caveat(n_known, cases.len()));
        Ok(Outcome::Complete(UsableCases { cases, left_out: usable.left_out }))
    }

    /// The network as one of the models that are compared.
    pub(crate) fn motion_model(model: &ResponseModel) -> Result<MotionModel, StudyError> {
        let own = Box::new(model.copied()?);
        Ok(match model.config().network.correction {
            Correction::Whole => MotionModel::Plain(own),
            _ => MotionModel::Network(own),
        })
    }
}

/// A finished evaluation: a comparison with one model.
pub type EvaluateResponseAnswer = CompareAnswer;

impl Question for EvaluateResponseRequest {
    type Answer = EvaluateResponseAnswer;
    type Report = Answer<CompareReport>;
    const NAME: &'static str = "evaluate";

    fn check(&self) -> Result<(), StudyError> {
        Ok(())
    }

    fn report(answer: &Self::Answer) -> &Self::Report {
        &answer.report
    }

    fn solve(
        &self,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<EvaluateResponseAnswer>, StudyError> {
        let model = library.response_model(&self.model)?;
        let digest = library.response_model_digest(&self.model)?;
        let mut caveats = Caveats::default();
        let cases = self.cases(&model, &mut caveats, library, observer)?;
        let Outcome::Complete(UsableCases { cases, left_out }) = cases else {
            return Ok(Outcome::Cancelled);
        };
        let chosen: Vec<&ResponseCase> = cases.iter().collect();
        let trajectories = model.record().train.len();
        let compared = Self::motion_model(&model)?;
        let name = data_name(&self.data);
        let comparison = evaluate_motion_model(&name, &chosen, &compared, trajectories, self.seed)?;
        let answer = CompareAnswer::new(comparison, left_out, caveats, [digest]);
        Ok(Outcome::Complete(answer))
    }
}

/// Those kept for the test of the model, or, of other data, all that it was not trained on.
fn test_cases(model: &ResponseModel, cases: Vec<ResponseCase>) -> Vec<ResponseCase> {
    let test = &model.record().test;
    let is_held_out = |case: &ResponseCase| test.iter().any(|id| id.digest == case.digest);
    if cases.iter().any(is_held_out) {
        return cases.into_iter().filter(is_held_out).collect();
    }
    cases.into_iter().filter(|case| !model.is_trained_on(case)).collect()
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;
    use std::path::Path;

    use super::*;
    use impactlab_core::uncertainty::CaveatKind;

    /// “Trajectories that none has seen” stood above the errors on a car of which the network has learned from 9 of
    /// 12 motions.
    #[test]
    fn motions_that_the_network_has_learned_from_are_counted() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../datasets/trajectories-cars");
        let library = Library::default();
        let model = library.response_model(&ModelChoice::default()).unwrap();
        for (split, n, n_known) in [(EvaluatedCases::All, 12, 9), (EvaluatedCases::Test, 3, 0)] {
            let request = EvaluateResponseRequest {
                model: ModelChoice::default(),
                data: root.join("car-001"),
                split,
                vehicle: VehicleChoice::default(),
                seed: 0,
                bad_cases: BadCases::default(),
            };
            let mut caveats = Caveats::default();
            let mut go_on = |_: crate::Event<'_>| ControlFlow::Continue(());
            let cases = request.cases(&model, &mut caveats, &library, &mut go_on).unwrap();
            assert_eq!(cases.complete().unwrap().cases.len(), n, "{split:?}");
            let told = caveats.iter().find(|caveat| caveat.kind == CaveatKind::TrainedOn);
            assert_eq!(told.map_or(Some(0.0), |caveat| caveat.value), Some(f64::from(n_known)));
        }
    }
}
