//! The speeds of one staged collision by every method, kept in a file once they are estimated.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use serde::{Deserialize, Serialize};

use crate::{
    EvaluateReconstructionRequest, Event, EvidenceChoice, Library, Observer, Question,
    ReconstructRequest, StudyError, word,
};
use impactlab_core::data::{
    DataError, Existing, MAX_RESULTS_BYTES, Outcome, read_bytes, write_atomically,
};
use impactlab_core::error_chain;
use impactlab_core::numerics::sha256_hex;
use impactlab_core::program;
use impactlab_reconstruct::evaluate::{KnownEvidence, MethodEstimates};
use impactlab_reconstruct::evidence::Evidence;
use impactlab_reconstruct::{HandCalculation, OptimumSettings, PointOptimum};

/// Draws from the normal distribution about the optimum of the swarm.
const SWARM_DRAWS: usize = 2000;

/// A case of which the speeds are asked.
pub(crate) struct CaseQuestion<'a> {
    /// Its name.
    pub(crate) case: &'a str,
    /// How much of its evidence is used.
    pub(crate) known: KnownEvidence,
    /// The file of its evidence.
    pub(crate) evidence: PathBuf,
}

/// The estimates of a case by every method.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct CaseEstimates {
    /// Name of the case.
    pub(crate) case: String,
    /// How much of its evidence was used.
    pub(crate) known: KnownEvidence,
    /// The estimates by each method.
    pub(crate) methods: Vec<MethodEstimates>,
}

/// Cases that are kept in files as soon as they are finished. Those of another build of the program are
/// not taken for its own.
pub(crate) struct FinishedCases<'a> {
    folder: Option<&'a Path>,
}

/// The content of such a file.
#[derive(Serialize, Deserialize)]
struct Saved {
    /// Digest of all that the estimates depend on.
    question: String,
    #[serde(flatten)]
    estimates: CaseEstimates,
}

impl CaseQuestion<'_> {
    /// Why the case has no answer.
    pub(crate) fn failed(&self, error: &StudyError) -> String {
        format!("{}, {}: {}", self.case, self.known.label(), error_chain(error))
    }

    /// Reconstructs the case, and estimates the speeds by hand and by swarm.
    fn estimates(
        &self,
        evidence: &Evidence,
        evaluation: &EvaluateReconstructionRequest,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<CaseEstimates>, StudyError> {
        let request = ReconstructRequest {
            particles: evaluation.particles,
            seed: evaluation.seed,
            ..ReconstructRequest::new(EvidenceChoice::Inline(Box::new(evidence.clone())))
        };
        let mut is_stopped = false;
        let mut watch = |event: Event<'_>| {
            let flow = observer(event);
            is_stopped |= flow.is_break();
            flow
        };
        let started = Instant::now();
        let answer = request.answer(library, &mut watch)?;
        let seconds = || started.elapsed().as_secs_f64();
        // A reconstruction that is stopped near its end answers with what it has.
        let Outcome::Complete(answer) = answer else { return Ok(Outcome::Cancelled) };
        if is_stopped {
            return Ok(Outcome::Cancelled);
        }
        let ours = MethodEstimates::from_posterior(
            &answer.posterior,
            answer.report.ess,
            answer.report.n_simulations,
            seconds(),
        );
        let started = Instant::now();
        let hand = HandCalculation::new(evidence, answer.target.model().cars(), &[]);
        let by_hand = MethodEstimates::by_hand(hand.as_ref(), started.elapsed().as_secs_f64());
        let mut methods = vec![ours, by_hand];
        if evaluation.swarm {
            let started = Instant::now();
            let settings = OptimumSettings { seed: evaluation.seed, ..OptimumSettings::default() };
            let found = PointOptimum::find(&answer.target, settings);
            let seconds = started.elapsed().as_secs_f64();
            methods.push(MethodEstimates::by_swarm(
                &answer.target,
                found.as_ref(),
                SWARM_DRAWS,
                evaluation.seed,
                seconds,
            ));
        }
        let (case, known) = (self.case.to_owned(), self.known);
        Ok(Outcome::Complete(CaseEstimates { case, known, methods }))
    }
}

impl<'a> FinishedCases<'a> {
    /// The files in a folder, which is made if it is not there; none without a folder.
    pub(crate) fn from_folder(folder: Option<&'a Path>) -> Result<Self, StudyError> {
        if let Some(folder) = folder {
            fs::create_dir_all(folder).map_err(|source| DataError::io(folder, source))?;
        }
        Ok(Self { folder })
    }

    /// The speeds of a case: from its file if the same program has estimated them from the same
    /// evidence with the same settings, else anew. A file that cannot be read is replaced.
    pub(crate) fn estimates(
        &self,
        evaluation: &EvaluateReconstructionRequest,
        case: &CaseQuestion<'_>,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<CaseEstimates>, StudyError> {
        let evidence = case.known.select(&Evidence::load(&case.evidence)?);
        let Some(folder) = self.folder else {
            return case.estimates(&evidence, evaluation, library, observer);
        };
        let file = folder.join(format!("{}-{}.json", case.case, word(&case.known)));
        let settings = (evaluation.particles, evaluation.seed, evaluation.swarm);
        let question = format!("{} {} {settings:?} {evidence:?}", program::version(), case.case);
        let question = sha256_hex([question.as_bytes()]);
        let saved = read_bytes(&file, MAX_RESULTS_BYTES).ok();
        let saved = saved.and_then(|bytes| serde_json::from_slice::<Saved>(&bytes).ok());
        if let Some(saved) = saved.filter(|saved| saved.question == question) {
            return Ok(Outcome::Complete(saved.estimates));
        }
        let estimates = case.estimates(&evidence, evaluation, library, observer)?;
        let Outcome::Complete(estimates) = estimates else { return Ok(Outcome::Cancelled) };
        let saved = Saved { question, estimates };
        write_atomically(&file, Existing::Replace, |out| {
            serde_json::to_writer(&mut *out, &saved)?;
            writeln!(out)
        })?;
        Ok(Outcome::Complete(saved.estimates))
    }
}
