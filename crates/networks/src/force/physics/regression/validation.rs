//! Cross-validation on training cases, by which regressions and baselines choose their options.

use crate::force::metrics::PointErrors;
use crate::force::regression::CurveFitError;
use crate::force::{CurvePrediction, ForceCase};
use crate::learning::{Split, folds};

/// Number of folds of the cross-validations by which options are chosen.
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

/// The error by which options are chosen. It is 1, that of a prediction without force, for a case that
/// cannot be predicted.
pub(crate) fn history_error(
    case: &ForceCase,
    prediction: Result<CurvePrediction, CurveFitError>,
) -> f64 {
    prediction.map_or(1.0, |prediction| PointErrors::new(case, &prediction).history_error)
}

/// Mean of values; infinite without values, so that a candidate without them is never chosen.
pub(crate) fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut n) = (0.0, 0);
    for value in values {
        (sum, n) = (sum + value, n + 1);
    }
    if n == 0 { f64::INFINITY } else { sum / f64::from(n) }
}

/// The candidate with the smallest loss, and the first of several with the same loss.
pub(crate) fn best_of<T>(candidates: impl IntoIterator<Item = (f64, T)>) -> Option<T> {
    let smaller = |best: Option<(f64, T)>, (loss, candidate)| match best {
        Some((least, _)) if least <= loss => best,
        _ => Some((loss, candidate)),
    };
    candidates.into_iter().fold(None, smaller).map(|(_, candidate)| candidate)
}
