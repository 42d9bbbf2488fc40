//! What a force model must beat, each made as strong as it honestly can be: METHOD of this project,
//! section 4. All are fitted to training cases and choose their own options by cross-validation on
//! them; all take canonical scenarios.

mod alignment;
mod features;
mod nearest;
mod pulse;
mod statistical;

use crate::collision::{ImpactError, PulseError};
use crate::force::metrics::PointErrors;
use crate::force::{ForceCase, Prediction, Split, folds};
use crate::numerics::GaussianProcessError;
use crate::uncertainty::MixtureError;

pub use alignment::Alignment;
pub use features::{ColumnSet, FeatureMap};
pub use nearest::{NearestBaseline, NearestScaling};
pub use pulse::PulseBaseline;
pub use statistical::{StatisticalBaseline, StatisticalOptions};

/// Folds of the cross-validations by which options are chosen.
pub const N_FOLDS: usize = 5;

/// A baseline that cannot be fitted or asked.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BaselineError {
    /// No case to learn from.
    #[error("a baseline fitted to no cases")]
    NoCases,
    /// The momentum solution has no impulse to scale by: the vehicles do not approach.
    #[error("the vehicles do not approach: the momentum solution has no impulse")]
    NotApproaching,
    /// The momentum solution fails.
    #[error("the momentum solution fails")]
    Impact(#[from] ImpactError),
    /// The pulse is no pulse.
    #[error("the pulse is out of range")]
    Pulse(#[from] PulseError),
    /// The regression fails.
    #[error("the regression fails")]
    Regression(#[from] GaussianProcessError),
    /// The spread is no distribution.
    #[error("the spread is no distribution")]
    Mixture(#[from] MixtureError),
}

/// Training and test cases of each fold.
fn case_folds<'a>(
    cases: &[&'a ForceCase],
    seed: u64,
) -> Vec<(Vec<&'a ForceCase>, Vec<&'a ForceCase>)> {
    let pick = |part: &[usize]| part.iter().filter_map(|idx| cases.get(*idx).copied()).collect();
    let folds = folds(cases, N_FOLDS, seed);
    folds.iter().map(|Split { train, test }| (pick(train), pick(test))).collect()
}

/// What options are chosen by. A case that cannot be predicted counts as if no force were predicted.
fn history_error(case: &ForceCase, prediction: Result<Prediction, BaselineError>) -> f64 {
    prediction.map_or(1.0, |prediction| PointErrors::of(case, &prediction).history_error)
}

/// Mean of values; infinite without any, so that it never wins.
fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut n) = (0.0, 0);
    for value in values {
        (sum, n) = (sum + value, n + 1);
    }
    if n == 0 { f64::INFINITY } else { sum / f64::from(n) }
}

/// The candidate with the smallest loss; of equals the first.
fn best_of<T>(candidates: impl IntoIterator<Item = (f64, T)>) -> Option<T> {
    let smaller = |best: Option<(f64, T)>, (loss, candidate)| match best {
        Some((least, _)) if least <= loss => best,
        _ => Some((loss, candidate)),
    };
    candidates.into_iter().fold(None, smaller).map(|(_, candidate)| candidate)
}
