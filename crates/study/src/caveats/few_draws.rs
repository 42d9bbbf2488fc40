//! Draws that are so few that with another seed the answer would be another.

use crate::PredictMotionReport;
use crate::analysis::{FEWEST_DRAWS, MonteCarloError};
use impactlab_core::uncertainty::{Caveat, CaveatKind};
use impactlab_core::units::{Phrase, PhraseValue};

/// Largest standard error of the end of an interval by the number of draws, as a share of the width.
const MOST_CHANCE: f64 = 0.1;

/// Draws that are so few that with another seed the intervals would be others.
///
/// The error of an end is found from the draws themselves, and of a handful it is far too small; of one
/// there is none.
pub(crate) fn few_draws(n_draws: usize, error: Option<&MonteCarloError>) -> Option<Caveat> {
    if n_draws == 1 {
        let text = Phrase::new(
            "there is a single draw, which has no interval and no probability: it is one of the motions that \
             are possible, and says nothing of the others",
            "Es gibt nur eine Ziehung, die weder ein Intervall noch eine Wahrscheinlichkeit hat: Sie ist eine \
             der möglichen Bewegungen und sagt nichts über die anderen",
        );
        return Some(Caveat::new(CaveatKind::FewDraws, text));
    }
    if n_draws < FEWEST_DRAWS {
        let text = Phrase::new(
            "the draws are {0}, too few for an interval of 90 %, beyond each end of which one of {1} lies: \
             what is told as one is too narrow, and a probability may be anything",
            "Zahl der Ziehungen: {0}. Das ist zu wenig für ein 90-%-Intervall, außerhalb dessen je Seite eine \
             von {1} liegt: Was als solches genannt ist, ist zu eng, und eine Wahrscheinlichkeit kann jeden \
             Wert haben",
        )
        .with(PhraseValue::Name(n_draws.to_string()))
        .with(PhraseValue::Name(FEWEST_DRAWS.to_string()));
        return Some(Caveat::new(CaveatKind::FewDraws, text));
    }
    let share = error?.interval_share;
    let text = || {
        Phrase::new(
            "an end of a 90 % interval is uncertain by {0} of the interval's width, because so few \
             draws were made",
            "Ein Ende eines 90-%-Intervalls ist um {0} der Intervallbreite unsicher, weil so wenige \
             Ziehungen gemacht wurden",
        )
        .with(PhraseValue::Share(share))
    };
    let is_much = share > MOST_CHANCE || share.is_nan();
    is_much.then(|| {
        Caveat::new(CaveatKind::FewDraws, text())
            .with_value("error of an interval's end as a share of its width", share)
            .with_range([0.0, MOST_CHANCE])
    })
}

/// Draws of a forecast that know nothing of each other: whole motions of both vehicles, else forces and
/// vehicles, under each of which there are several motions. What is not drawn makes none few.
pub(crate) fn independent_draws(report: &PredictMotionReport) -> usize {
    if let Some(contacts) = &report.contacts {
        return contacts.n_draws;
    }
    let forces = report.force_model.as_ref().map(|_| report.n_forces);
    let vehicles = Some(report.n_vehicles).filter(|n_vehicles| *n_vehicles > 0);
    forces.into_iter().chain(vehicles).min().unwrap_or(usize::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A forecast of one draw had intervals without width and no word, one of two a small error.
    #[test]
    fn a_handful_of_draws_has_no_interval_whatever_its_error() {
        let error = |interval_share| MonteCarloError { interval_share, region_90_m2: 0.1 };
        let kind = |n, error: Option<&MonteCarloError>| few_draws(n, error).map(|it| it.kind);
        for n in [1, 2, 19] {
            assert_eq!(kind(n, None), Some(CaveatKind::FewDraws), "{n}");
            assert_eq!(kind(n, Some(&error(0.01))), Some(CaveatKind::FewDraws), "{n}");
        }
        let one = few_draws(1, None).unwrap().text;
        assert!(one.contains("has no interval and no probability"), "{one}");
        assert_eq!(kind(20, Some(&error(0.01))), None);
        assert_eq!(kind(20, Some(&error(0.2))), Some(CaveatKind::FewDraws));
        assert_eq!(kind(200, None), None);
    }
}
