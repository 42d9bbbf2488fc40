//! A reconstruction whose answer is prepared for drawing.

use crate::app::reconstruction::StoredRuns;
use impactlab_core::data::Outcome;
use impactlab_document::figure::prior_values;
use impactlab_reconstruct::ReconstructedQuantity;
use impactlab_study::{
    Answer, Library, Observer, Question, ReconstructAnswer, ReconstructReport, ReconstructRequest,
    ReconstructedPaths, StudyError,
};

/// A question for a reconstruction, whose answer is prepared for drawing.
#[derive(Debug, Clone, PartialEq)]
pub struct ReconstructionQuestion {
    /// The question for the reconstruction itself.
    pub request: ReconstructRequest,
    /// Where its run is kept; `None` keeps none.
    pub stored_runs: Option<StoredRuns>,
}

impl ReconstructionQuestion {
    /// The answer of the run that is kept, which goes on where it has not ended. What is wrong with the
    /// kept run is no reason to give no answer.
    fn sampled(
        &self,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<ReconstructAnswer>, StudyError> {
        let Some(runs) = &self.stored_runs else { return self.request.solve(library, observer) };
        let resumed = runs.resumed(&self.request)?;
        match resumed.solve(library, observer) {
            Err(error) if error.is_of_checkpoint() => {
                let unusable = resumed.checkpoint_files().filter(|_| !error.is_checkpoint_in_use());
                for path in unusable.into_iter().flatten() {
                    // It may be missing, or be in a folder that cannot be written.
                    let _ = std::fs::remove_file(path);
                }
                self.request.solve(library, observer)
            }
            answered => answered,
        }
    }
}

/// A reconstruction with its paths and its prior.
pub struct PreparedReconstruction {
    /// The answer to the question for the reconstruction.
    pub answer: ReconstructAnswer,
    /// Paths of some of all particles.
    paths: ReconstructedPaths,
    /// The same of each course of events.
    mode_paths: Vec<ReconstructedPaths>,
    /// The quantities that can be drawn: those that the case is asked for.
    quantities: Vec<ReconstructedQuantity>,
    /// Values of each of them before the evidence, in their order.
    priors: Vec<Vec<f64>>,
    /// Ends of the 90 % interval of each component of the prior after the evidence.
    pub intervals_90: Vec<Option<[f64; 2]>>,
}

impl PreparedReconstruction {
    /// Paths of one course of events, by its number; `None` is all of them.
    pub fn paths_of(&self, mode: Option<usize>) -> &ReconstructedPaths {
        mode.and_then(|idx| self.mode_paths.get(idx)).unwrap_or(&self.paths)
    }

    /// The courses of events that the evidence leaves possible, each with its title and its paths; none if
    /// there is one only.
    pub fn courses(&self) -> Vec<(String, &ReconstructedPaths)> {
        let modes = &self.answer.report.modes;
        let several = modes.iter().filter(|_| modes.len() > 1);
        several.map(ReconstructedPaths::course_title).zip(&self.mode_paths).collect()
    }

    /// The quantities that can be drawn.
    pub fn quantities(&self) -> &[ReconstructedQuantity] {
        &self.quantities
    }

    /// Values of a quantity before the evidence: draws, of which those of a number belong together.
    pub fn prior_of(&self, quantity: ReconstructedQuantity) -> &[f64] {
        let idx = self.quantities.iter().position(|of| *of == quantity);
        idx.and_then(|idx| self.priors.get(idx)).map_or(&[], Vec::as_slice)
    }
}

impl Question for ReconstructionQuestion {
    type Answer = PreparedReconstruction;
    type Report = Answer<ReconstructReport>;
    const NAME: &'static str = ReconstructRequest::NAME;

    fn check(&self) -> Result<(), StudyError> {
        self.request.check()
    }

    fn report(answer: &Self::Answer) -> &Self::Report {
        &answer.answer.report
    }

    fn solve(
        &self,
        library: &Library,
        observer: &mut Observer<'_>,
    ) -> Result<Outcome<PreparedReconstruction>, StudyError> {
        let answered = self.sampled(library, observer)?;
        Ok(answered.map(|answer| {
            let modes = answer.report.modes.iter();
            let quantities = answer.posterior.asked();
            let components = answer.target.model().prior().components().iter();
            PreparedReconstruction {
                paths: ReconstructedPaths::from_answer(&answer),
                mode_paths: modes
                    .map(|mode| ReconstructedPaths::from_mode(&answer, mode))
                    .collect(),
                priors: quantities.iter().map(|of| prior_values(&answer.target, *of)).collect(),
                quantities,
                intervals_90: components
                    .map(|component| answer.posterior.interval_90_of(component.latent))
                    .collect(),
                answer,
            }
        }))
    }
}
