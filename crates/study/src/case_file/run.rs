//! Asks a case its questions.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Serialize;

use crate::case_file::{CaseError, CaseFile, Change, UsedModel, Variant};
use crate::{AnyAnswer, Event, Library, Observer, Report, Request, StudyError};
use impactlab_core::data::Outcome;
use impactlab_core::data::write::ModelDigest;
use impactlab_core::error_chain;
use impactlab_core::jobs::Progress;

/// Units of work of a question in the progress of all of them.
const STEPS: u64 = 1000;

/// The answers to all questions of a case.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct CaseReport {
    /// What the case is called.
    pub name: String,
    /// What is not as it was when the case was saved; answers may differ from those of then.
    pub changes: Vec<Change>,
    /// The variants with their answers.
    pub variants: Vec<VariantReport>,
}

/// The answers to the questions of a variant.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct VariantReport {
    /// What it is called.
    pub name: String,
    /// Questions with their answers, in the order of the case.
    pub answers: Vec<AnsweredQuestion>,
}

/// A question with its answer, or why there is none.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct AnsweredQuestion {
    /// The question.
    pub request: Request,
    /// The answer: what the command of the question prints with `--json`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub report: Option<Report>,
    /// Why there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
}

/// Is told of the variant, the question, and its answer or why there is none.
pub type AnswerListener<'a> = dyn FnMut(&Variant, &Request, Result<&AnyAnswer, &StudyError>) + 'a;

impl CaseFile {
    /// Answers every question of the variants. A question without an answer does not keep the others from
    /// being asked.
    ///
    /// - `variants`: names of the variants that are asked; empty for all.
    ///
    /// # Errors
    /// [`CaseError::NoVariant`].
    pub fn ask(
        &self,
        variants: &[String],
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<CaseReport>, CaseError> {
        self.ask_each(variants, library, observer, &mut |_, _, _| {})
    }

    /// The same, and tells of each answer, with what it was made from, before the next question is
    /// asked.
    ///
    /// - `listener`: is called with the variant, the question, and its answer or why there is none.
    ///
    /// # Errors
    /// As for [`CaseFile::ask`].
    pub fn ask_each(
        &self,
        variants: &[String],
        library: &Library,
        observer: &mut Observer<'_>,
        listener: &mut AnswerListener<'_>,
    ) -> Result<Outcome<CaseReport>, CaseError> {
        if let Some(name) = variants.iter().find(|name| self.variant(name).is_none()) {
            return Err(self.no_variant(name));
        }
        let is_chosen =
            |variant: &&Variant| variants.is_empty() || variants.contains(&variant.name);
        self.check_writable()?;
        let chosen = || self.variants.iter().filter(is_chosen);
        let n: usize = chosen().map(|variant| variant.questions.len()).sum();
        let mut n_asked = 0;
        let mut reports = Vec::new();
        for variant in chosen() {
            let mut answers = Vec::new();
            for request in &variant.questions {
                let mut watch = |event: Event<'_>| match event {
                    Event::Progress(progress) => {
                        observer(Event::Progress(of_all(progress, n_asked, n as u64)))
                    }
                    event => observer(event),
                };
                let answer = request.answer(library, &mut watch);
                n_asked += 1;
                let answered = match answer {
                    Ok(Outcome::Complete(answer)) => {
                        listener(variant, request, Ok(&answer));
                        (Some(answer.into_report()), None)
                    }
                    Ok(Outcome::Cancelled) => return Ok(Outcome::Cancelled),
                    Err(error) => {
                        listener(variant, request, Err(&error));
                        (None, Some(error_chain(&error)))
                    }
                };
                let (report, error) = answered;
                answers.push(AnsweredQuestion { request: request.clone(), report, error });
            }
            reports.push(VariantReport { name: variant.name.clone(), answers });
        }
        let changes = self.changes().into_iter().chain(self.other_models(&reports)).collect();
        let name = self.name.clone();
        Ok(Outcome::Complete(CaseReport { name, changes, variants: reports }))
    }

    /// Networks that have answered and are not those that did when the case was saved.
    fn other_models(&self, reports: &[VariantReport]) -> Vec<Change> {
        let used = models_of(reports.iter().flat_map(VariantReport::reports));
        let is_other = |before: &&UsedModel| {
            let key = (before.network.clone(), before.name.clone());
            used.get(&key).is_some_and(|sha256| *sha256 != before.sha256)
        };
        let change = |model: &UsedModel| Change::Model {
            network: model.network.clone(),
            name: model.name.clone(),
        };
        self.models.iter().filter(is_other).map(change).collect()
    }
}

/// The progress of all questions, each of which counts alike.
///
/// - `progress`: of the question that is asked;
/// - `n_before`: questions before it, of `n`.
fn of_all(progress: Progress, n_before: u64, n: u64) -> Progress {
    let share = f64::from(progress.fraction().unwrap_or(0.0));
    let done = n_before * STEPS + (share * STEPS as f64) as u64;
    Progress::new(done, n * STEPS, progress.message)
}

impl VariantReport {
    /// The answers that there are.
    pub fn reports(&self) -> impl Iterator<Item = &Report> {
        self.answers.iter().filter_map(|answer| answer.report.as_ref())
    }
}

impl CaseReport {
    /// Whether every question has an answer in which nothing is wrong with what was asked of, and nothing has
    /// changed since the case was saved.
    pub fn is_clean(&self) -> bool {
        let mut answers = self.variants.iter().flat_map(|variant| &variant.answers);
        let is_clean = |answer: &AnsweredQuestion| {
            answer.report.as_ref().is_some_and(|report| !report.has_problems())
        };
        self.changes.is_empty() && answers.all(is_clean)
    }

    /// The networks that have answered.
    pub fn models(&self) -> Vec<UsedModel> {
        let used = models_of(self.variants.iter().flat_map(VariantReport::reports));
        let model = |((network, name), sha256)| UsedModel { network, name, sha256 };
        used.into_iter().map(model).collect()
    }
}

/// The networks that reports name, by kind and name.
fn models_of<'a>(reports: impl Iterator<Item = &'a Report>) -> BTreeMap<(String, String), String> {
    let digests = reports.flat_map(|report| &report.provenance().model_digests);
    let model = |digest: &ModelDigest| {
        ((digest.network.clone().into_owned(), digest.name.clone()), digest.sha256.clone())
    };
    digests.map(model).collect()
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;
    use std::path::Path;

    use super::*;
    use crate::{ForceQuestion, ImpactRequest, ModelChoice, PredictForceRequest, ScenarioChoice};
    use impactlab_core::collision::Scenario;

    const PIT: &str = include_str!("../../../../assets/scenarios/pit_right_rear.toml");

    /// The bar of a report stood at 100 % once for each question.
    #[test]
    fn questions_of_a_case_have_one_progress() {
        let told = |done, n_before| of_all(Progress::new(done, 100, "at work"), n_before, 4);
        assert_eq!(told(50, 1), Progress::new(1500, 4 * STEPS, "at work"));
        assert_eq!(told(100, 3).fraction(), Some(1.0));
        assert_eq!(of_all(Progress::new(7, 0, ""), 2, 4).done, 2 * STEPS);
    }

    #[test]
    fn the_networks_that_answered_are_found_and_others_than_before_are_changes() {
        let scenario = Scenario::from_toml(PIT, Path::new("pit.toml")).unwrap();
        let scenario = ScenarioChoice::Inline(Box::new(scenario));
        let force = PredictForceRequest::new(ForceQuestion::Scenario(scenario.clone()));
        let questions = vec![ImpactRequest::new(scenario).into(), Request::from(force)];
        let variant = Variant { name: "one".into(), questions, ..Variant::default() };
        let mut case = CaseFile::new("case", variant);
        let library = Library::default();
        let ask = |case: &CaseFile| {
            let answered = case.ask(&[], &library, &mut |_| ControlFlow::Continue(()));
            answered.unwrap().complete().unwrap()
        };
        let report = ask(&case);
        let ModelDigest { network, name, sha256 } =
            library.force_model_digest(&ModelChoice::default()).unwrap();
        let used = UsedModel { network: network.into_owned(), name, sha256 };
        assert_eq!(report.models(), std::slice::from_ref(&used));
        assert!(report.is_clean(), "{:?}", report.changes);
        let change = Change::Model { network: used.network.clone(), name: used.name.clone() };
        case.models = vec![UsedModel { sha256: "another".into(), ..used }];
        assert_eq!(ask(&case).changes, [change]);
    }

    #[cfg(unix)]
    #[test]
    fn a_file_whose_name_is_not_unicode_is_refused_and_not_left_out_of_a_report() {
        use std::ffi::OsStr;
        use std::os::unix::ffi::OsStrExt;

        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(OsStr::from_bytes(b"caf\xe9.toml"));
        std::fs::write(&path, PIT).unwrap();
        let question = ImpactRequest::new(ScenarioChoice::File(path));
        let variant =
            Variant { name: "one".into(), questions: vec![question.into()], ..Variant::default() };
        let case = CaseFile::new("case", variant);
        let answered = case.ask(&[], &Library::default(), &mut |_| ControlFlow::Continue(()));
        let error = answered.unwrap_err().to_string();
        assert_eq!(error, "variant \"one\": the name of a file is not Unicode; rename it");
        assert!(case.to_text(&folder.path().join("a.impactlab")).is_err());
    }
}
