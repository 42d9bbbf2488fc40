//! Cross-validation on training cases, by which baselines choose their options.

use crate::force::metrics::PointErrors;
use crate::force::regression::BaselineError;
use crate::force::{ForceCase, Prediction};
use crate::learning::{Split, folds};

/// Folds of the cross-validations by which options are chosen.
pub const N_FOLDS: usize = 5;

/// Training and test cases of each fold.
pub(crate) fn case_folds<'a>(
    cases: &[&'a ForceCase],
    seed: u64,
) -> Vec<(Vec<&'a ForceCase>, Vec<&'a ForceCase>)> {
    let pick = |part: &[usize]| part.iter().filter_map(|idx| cases.get(*idx).copied()).collect();
    let folds = folds(cases, N_FOLDS, seed);
    folds.iter().map(|Split { train, test }| (pick(train), pick(test))).collect()
}

/// What options are chosen by. A case that cannot be predicted counts as if no force were predicted.
pub(crate) fn history_error(
    case: &ForceCase,
    prediction: Result<Prediction, BaselineError>,
) -> f64 {
    prediction.map_or(1.0, |prediction| PointErrors::of(case, &prediction).history_error)
}

/// Mean of values; infinite without any, so that it never wins.
pub(crate) fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut n) = (0.0, 0);
    for value in values {
        (sum, n) = (sum + value, n + 1);
    }
    if n == 0 { f64::INFINITY } else { sum / f64::from(n) }
}

/// The candidate with the smallest loss; of equals the first.
pub(crate) fn best_of<T>(candidates: impl IntoIterator<Item = (f64, T)>) -> Option<T> {
    let smaller = |best: Option<(f64, T)>, (loss, candidate)| match best {
        Some((least, _)) if least <= loss => best,
        _ => Some((loss, candidate)),
    };
    candidates.into_iter().fold(None, smaller).map(|(_, candidate)| candidate)
}
