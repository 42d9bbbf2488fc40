//! Errors and scores of one model on all test cases.

use rayon::prelude::*;

use crate::force::evaluate::{EvaluationError, ForceMetrics};
use crate::force::metrics::{
    CurveMetrics, PointErrors, ProbabilisticScores, ProbabilisticSettings,
};
use crate::force::{CurvePrediction, ForceCase};

/// Errors and scores of one model on all test cases.
pub(super) struct Scored {
    pub errors: Vec<PointErrors>,
    /// Scores of the distributions; empty if the model has none.
    scores: Vec<ProbabilisticScores>,
}

impl Scored {
    pub(super) fn new(
        test: &[&ForceCase],
        predictions: &[CurvePrediction],
        settings: ProbabilisticSettings,
    ) -> Result<Self, EvaluationError> {
        let pairs = || test.iter().zip(predictions);
        let errors = pairs().map(|(case, prediction)| PointErrors::new(case, prediction)).collect();
        if predictions.iter().any(|prediction| prediction.mixture.is_none()) {
            return Ok(Self { errors, scores: Vec::new() });
        }
        let tasks: Vec<_> = pairs().enumerate().collect();
        let scores = tasks.par_iter().filter_map(|(stream, (case, prediction))| {
            let mixture = prediction.mixture.as_ref()?;
            let scores = ProbabilisticScores::new(case, mixture, settings, *stream as u64);
            let named = |source| EvaluationError::Mixture { case: case.name.clone(), source };
            Some(scores.map_err(named))
        });
        Ok(Self { errors, scores: scores.collect::<Result<_, _>>()? })
    }

    pub(super) fn metrics(&self, test: &[&ForceCase]) -> Option<ForceMetrics> {
        Some(ForceMetrics {
            overall: self.chosen(test, |_| true)?,
            separated: self.chosen(test, ForceCase::is_clean),
        })
    }

    /// Metrics over the cases that `choose` takes.
    pub(super) fn chosen(
        &self,
        test: &[&ForceCase],
        choose: impl Fn(&ForceCase) -> bool,
    ) -> Option<CurveMetrics> {
        self.over(test.iter().enumerate().filter(|(_, case)| choose(case)).map(|(idx, _)| idx))
    }

    /// Metrics over the cases with these indices; `None` without any.
    pub(super) fn over(&self, indices: impl Iterator<Item = usize>) -> Option<CurveMetrics> {
        let taken: Vec<usize> = indices.collect();
        let errors: Vec<_> = taken.iter().filter_map(|idx| self.errors.get(*idx)).collect();
        let scores: Vec<_> = taken.iter().filter_map(|idx| self.scores.get(*idx)).collect();
        CurveMetrics::new(&errors, &scores)
    }
}
