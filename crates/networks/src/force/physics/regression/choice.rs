//! The choice of the options of a regression by cross-validation on training cases.

use rayon::prelude::*;

use crate::force::ForceCase;
use crate::force::regression::scales::Scales;
use crate::force::regression::shapes::Shapes;
use crate::force::regression::{
    Alignment, ColumnSet, CurveFitError, CurveRegression, CurveRegressionOptions, best_of,
    case_folds, history_error, mean,
};

/// Numbers of components among which cross-validation chooses, rising.
const N_COMPONENTS: [usize; 2] = [4, 8];

/// The options with the smallest mean history error in cross-validation.
pub(super) fn choose(
    cases: &[&ForceCase],
    columns: ColumnSet,
    seed: u64,
) -> Result<CurveRegressionOptions, CurveFitError> {
    let folds = case_folds(cases, seed);
    let tasks: Vec<_> = folds.iter().flat_map(|fold| [(fold, false), (fold, true)]).collect();
    let losses = tasks.par_iter().map(|((train, test), with_impulse)| {
        fold_losses(train, test, columns, *with_impulse, seed)
    });
    let losses: Vec<Vec<(f64, CurveRegressionOptions)>> = losses.collect::<Result<_, _>>()?;
    let candidates = candidates().map(|options| {
        let own = losses.iter().flatten().filter(|(_, other)| *other == options);
        (own.map(|(loss, _)| loss).sum(), options)
    });
    best_of(candidates.collect::<Vec<_>>())
        .filter(|_| !losses.is_empty())
        .ok_or(CurveFitError::NoCases)
}

fn candidates() -> impl Iterator<Item = CurveRegressionOptions> {
    let inputs = [false, true].into_iter();
    inputs.flat_map(|with_impulse| {
        Alignment::CANDIDATES.into_iter().flat_map(move |alignment| {
            let options = move |n_components| CurveRegressionOptions {
                alignment,
                n_components,
                with_impulse,
            };
            N_COMPONENTS.into_iter().map(options)
        })
    })
}

/// Sum of the history errors over the cases left out, for all options with these inputs. Regressions
/// that several options have in common are fitted once.
fn fold_losses(
    train: &[&ForceCase],
    test: &[&ForceCase],
    columns: ColumnSet,
    with_impulse: bool,
    seed: u64,
) -> Result<Vec<(f64, CurveRegressionOptions)>, CurveFitError> {
    let scales = Scales::fit(train, columns, with_impulse)?;
    let mut losses = Vec::new();
    for alignment in Alignment::CANDIDATES {
        let most = N_COMPONENTS[N_COMPONENTS.len() - 1];
        let options = CurveRegressionOptions { alignment, n_components: most, with_impulse };
        let shapes = Shapes::fit(train, &scales, options)?;
        for n_components in N_COMPONENTS {
            let options = CurveRegressionOptions { n_components, ..options };
            let model = CurveRegression::from_parts(
                train,
                scales.clone(),
                shapes.clone().truncated(n_components),
                options,
                seed,
            );
            let error = |case: &&ForceCase| history_error(case, model.point(&case.scenario));
            losses.push((mean(test.iter().map(error)) * test.len() as f64, options));
        }
    }
    Ok(losses)
}
