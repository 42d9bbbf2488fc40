//! How well reconstructions do on staged collisions, beside the calculation by hand and the optimum of
//! a swarm: `evaluate reconstruction`.

use std::ops::ControlFlow;
use std::path::PathBuf;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::ask::checks::check_count;
use crate::questions::evaluate::reconstruction_estimates::{
    CaseEstimates, CaseQuestion, FinishedCases,
};
use crate::{
    Answer, Event, Library, Observer, Provenance, Question, ReconstructRequest, StudyError,
};
use impactlab_core::data::Outcome;
use impactlab_core::error_chain;
use impactlab_core::jobs::Progress;
use impactlab_core::ranges::RECONSTRUCTION_PARTICLES;
use impactlab_core::uncertainty::{Caveat, CaveatKind};
use impactlab_core::units::{Phrase, PhraseValue};
use impactlab_reconstruct::evaluate::{
    CaseScore, KnownEvidence, MethodSummary, ReconstructionMethod, StagedCollisions, StagedSplit,
    TrueQuantities,
};

/// Asks how well the speeds of staged collisions are reconstructed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EvaluateReconstructionRequest {
    /// The folder of staged collisions: `evidence/<case>.toml` and `truth/<case>.toml`.
    pub data: PathBuf,
    /// How much of the evidence is used, one answer for each.
    #[serde(default = "all_known")]
    pub known: Vec<KnownEvidence>,
    /// Which of the cases.
    #[serde(default)]
    pub split: StagedSplit,
    /// If not empty: those of them that have these names.
    #[serde(default)]
    pub only: Vec<String>,
    /// Number of particles.
    #[serde(default = "default_particles")]
    pub particles: usize,
    /// Seed of all draws.
    #[serde(default)]
    pub seed: u64,
    /// Whether the optimum of a swarm is computed, too.
    #[serde(default = "with_swarm")]
    pub swarm: bool,
    /// Folder in which each finished case is kept, and from which it is taken if the question is
    /// asked again by the same program.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub finished: Option<PathBuf>,
}

fn all_known() -> Vec<KnownEvidence> {
    KnownEvidence::ALL.into()
}

fn default_particles() -> usize {
    ReconstructRequest::DEFAULT_PARTICLES
}

fn with_swarm() -> bool {
    true
}

/// Staged collisions beside their truths, SI units.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct EvaluateReconstructionReport {
    /// The folder.
    pub data: PathBuf,
    /// Which of its cases.
    pub split: StagedSplit,
    /// Number of cases that were asked for.
    pub n_cases: usize,
    /// Number of particles.
    pub n_particles: usize,
    /// Whether the evaluation was stopped before all cases were done.
    pub stopped: bool,
    /// The summary of each method for each part of the evidence.
    pub summary: Vec<MethodSummary>,
    /// Each case by each method.
    pub cases: Vec<CaseScore>,
    /// Cases that have no answer, and why.
    pub left_out: Vec<String>,
}

/// A finished evaluation.
#[derive(Debug, Clone, PartialEq)]
pub struct EvaluateReconstructionAnswer {
    /// What is told, with what restricts it and where it comes from.
    pub report: Answer<EvaluateReconstructionReport>,
}

impl EvaluateReconstructionRequest {
    /// An evaluation in which nothing else is said.
    pub fn new(data: impl Into<PathBuf>) -> Self {
        Self {
            data: data.into(),
            known: all_known(),
            split: StagedSplit::default(),
            only: Vec::new(),
            particles: default_particles(),
            seed: 0,
            swarm: with_swarm(),
            finished: None,
        }
    }

    /// The names of the cases, in their order.
    ///
    /// # Errors
    /// [`StudyError::NoSuchCase`], [`StudyError::NoStagedCase`], [`StudyError::NoTruth`], and if the
    /// folder cannot be listed.
    fn cases(&self, staged: &StagedCollisions) -> Result<Vec<String>, StudyError> {
        let of_split = staged.names_in(self.split);
        if let Some(unknown) = self.only.iter().find(|name| !staged.names().contains(name)) {
            return Err(StudyError::NoSuchCase {
                path: self.data.clone(),
                case: unknown.clone(),
                n_cases: staged.names().len(),
                first: staged.names().first().cloned().unwrap_or_default(),
            });
        }
        let is_chosen = |name: &String| self.only.is_empty() || self.only.contains(name);
        let chosen: Vec<String> = of_split.into_iter().filter(is_chosen).collect();
        if chosen.is_empty() || self.known.is_empty() {
            return Err(StudyError::NoStagedCase { path: self.data.clone() });
        }
        let truths = chosen.iter().map(|name| staged.truth_file(name));
        match truths.into_iter().find(|path| !path.is_file()) {
            Some(path) => Err(StudyError::NoTruth { path }),
            None => Ok(chosen),
        }
    }

    /// The estimates of all cases, as far as the observer lets it go, and why others have none.
    fn estimates(
        &self,
        staged: &StagedCollisions,
        cases: &[String],
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Estimated, StudyError> {
        let finished = FinishedCases::from_folder(self.finished.as_deref())?;
        let mut all = Estimated::default();
        let known = || self.known.iter().copied();
        let pairs = cases.iter().flat_map(|case| known().map(move |known| (case, known)));
        let n = cases.len() * self.known.len();
        for (done, (case, known)) in pairs.enumerate() {
            let question = CaseQuestion { case, known, evidence: staged.evidence_file(case) };
            let mut report_share = |event: Event<'_>| match event {
                Event::Progress(of_case) => {
                    let what = format!("{case}, {}: {}", known.label(), of_case.message);
                    let share = of_case.fraction().map_or(0.0, f64::from);
                    let position = 1000.0 * (done as f64 + share);
                    let total = 1000 * n as u64;
                    observer(Event::Progress(Progress::new(position as u64, total, what)))
                }
                Event::Training(_) | Event::Sampling(_) => ControlFlow::Continue(()),
            };
            match finished.estimates(self, &question, library, &mut report_share) {
                Ok(Outcome::Complete(estimates)) => all.done.push(estimates),
                Ok(Outcome::Cancelled) => {
                    all.stopped = true;
                    break;
                }
                Err(error) => all.failed.push(question.failed(&error)),
            }
        }
        Ok(all)
    }
}

/// What was estimated of the cases.
#[derive(Default)]
struct Estimated {
    done: Vec<CaseEstimates>,
    failed: Vec<String>,
    stopped: bool,
}

impl Estimated {
    /// The estimates beside the truths, which are read only now.
    fn scored(&mut self, staged: &StagedCollisions) -> Vec<CaseScore> {
        let mut scores = Vec::new();
        for done in &self.done {
            match TrueQuantities::load(&staged.truth_file(&done.case)) {
                Ok(truth) => scores.extend(
                    done.methods
                        .iter()
                        .map(|estimates| CaseScore::new(&done.case, done.known, estimates, &truth)),
                ),
                Err(error) => self.failed.push(format!("{}: {}", done.case, error_chain(&error))),
            }
        }
        scores
    }
}

impl Question for EvaluateReconstructionRequest {
    type Answer = EvaluateReconstructionAnswer;
    type Report = Answer<EvaluateReconstructionReport>;
    const NAME: &'static str = "evaluate";

    fn check(&self) -> Result<(), StudyError> {
        check_count("particles", &RECONSTRUCTION_PARTICLES, self.particles)
    }

    fn report(answer: &Self::Answer) -> &Self::Report {
        &answer.report
    }

    fn has_problems(report: &Self::Report) -> bool {
        !report.left_out.is_empty()
    }

    fn solve(
        &self,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<EvaluateReconstructionAnswer>, StudyError> {
        let staged = StagedCollisions::open(&self.data)?;
        let cases = self.cases(&staged)?;
        let mut estimated = self.estimates(&staged, &cases, library, observer)?;
        let scores = estimated.scored(&staged);
        let Estimated { failed: left_out, stopped, .. } = estimated;
        if stopped && scores.is_empty() {
            return Ok(Outcome::Cancelled);
        }
        let is_answer = |score: &&CaseScore| score.method == ReconstructionMethod::Reconstruction;
        let n_answers = scores.iter().filter(is_answer).count();
        let report = EvaluateReconstructionReport {
            data: self.data.clone(),
            split: self.split,
            n_cases: cases.len(),
            n_particles: self.particles,
            stopped,
            summary: MethodSummary::from_scores(&scores),
            cases: scores,
            left_out,
        };
        let missing = of_missing(n_answers, cases.len() * self.known.len());
        let report = Answer {
            report,
            caveats: missing.into_iter().collect(),
            provenance: Provenance::from_seed(self.seed),
        };
        Ok(Outcome::Complete(EvaluateReconstructionAnswer { report }))
    }
}

/// Reconstructions that have no answer: they failed, or the evaluation was stopped.
fn of_missing(n_answers: usize, n_expected: usize) -> Option<Caveat> {
    let n_missing = n_expected.saturating_sub(n_answers);
    let caveat = || {
        let text = Phrase::new(
            "{0} of {1} reconstructions have no answer",
            "{0} von {1} Rekonstruktionen haben kein Ergebnis",
        )
        .with(PhraseValue::Name(n_missing.to_string()))
        .with(PhraseValue::Name(n_expected.to_string()));
        let quantity = "reconstructions without an answer";
        Caveat::new(CaveatKind::LeftOut, text)
            .with_value(quantity, n_missing as f64)
            .with_range([0.0, 0.0])
    };
    (n_missing > 0).then(caveat)
}

#[cfg(test)]
#[path = "reconstruction_tests.rs"]
mod tests;
