//! Which cases train and which test: by name and seed, alike on every machine.
//!
//! Clean cases and those that hook or have not separated are split apart, so that each part has its
//! share of both.

use std::borrow::Borrow;

use sha2::{Digest, Sha256};

use crate::force::ForceCase;
use crate::force::case::hex;

/// Share of the cases that test: train to test 3 : 1, as in the paper
/// ([`PitPinnPaper`](crate::bibliography::PitPinnPaper)).
pub const TEST_SHARE: f64 = 0.25;

/// Indices of cases, rising.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Split {
    /// Those to learn from.
    pub train: Vec<usize>,
    /// Those to test on: nothing is fitted to them or chosen by them.
    pub test: Vec<usize>,
}

/// Splits cases: in each stratum ordered by the SHA-256 of `"{seed}:{name}"` in hex, the first
/// `round(n · test_share)` test (halves to even).
///
/// - `test_share`: 0 to 1, see [`TEST_SHARE`].
pub fn split<C: Borrow<ForceCase>>(cases: &[C], seed: u64, test_share: f64) -> Split {
    let mut split = Split::default();
    for stratum in strata(cases, seed) {
        let n_test = (stratum.len() as f64 * test_share).round_ties_even() as usize;
        let (test, train) = stratum.split_at(n_test.min(stratum.len()));
        split.test.extend(test);
        split.train.extend(train);
    }
    split.train.sort_unstable();
    split.test.sort_unstable();
    split
}

/// Folds of a cross-validation: in the order of [`split`], the strata one after the other, the
/// cases are dealt round. In fold `i` the test part is what was dealt to it.
///
/// - `n_folds`: 2 or more; folds that get no case are left out.
pub fn folds<C: Borrow<ForceCase>>(cases: &[C], n_folds: usize, seed: u64) -> Vec<Split> {
    let order: Vec<usize> = strata(cases, seed).concat();
    let fold = |of: usize| {
        let dealt = order.iter().enumerate().map(|(rank, &idx)| (rank % n_folds.max(1), idx));
        let (test, train): (Vec<_>, Vec<_>) = dealt.partition(|(fold, _)| *fold == of);
        let indices = |part: Vec<(usize, usize)>| {
            let mut indices: Vec<usize> = part.into_iter().map(|(_, idx)| idx).collect();
            indices.sort_unstable();
            indices
        };
        Split { train: indices(train), test: indices(test) }
    };
    (0..n_folds).map(fold).filter(|split| !split.test.is_empty()).collect()
}

/// Clean cases, then the others, each ordered by hash.
fn strata<C: Borrow<ForceCase>>(cases: &[C], seed: u64) -> [Vec<usize>; 2] {
    let mut keyed: Vec<(String, usize)> = cases
        .iter()
        .enumerate()
        .map(|(idx, case)| (hex(&Sha256::digest(format!("{seed}:{}", case.borrow().name))), idx))
        .collect();
    keyed.sort();
    let of = |clean: bool| {
        let stratum = keyed.iter().filter(|(_, idx)| cases[*idx].borrow().is_clean() == clean);
        stratum.map(|(_, idx)| *idx).collect()
    };
    [of(true), of(false)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::force::case::tests::shipped;

    #[test]
    fn the_shipped_cases_split_as_in_the_first_trials() {
        let cases = shipped("fea");
        let split = split(&cases, 0, TEST_SHARE);
        let count = |of: &dyn Fn(&ForceCase) -> bool| {
            split.test.iter().filter(|idx| of(&cases[**idx])).count()
        };
        assert_eq!((split.train.len(), split.test.len()), (75, 25));
        assert_eq!(count(&ForceCase::is_clean), 22);
        assert_eq!((count(&|case| case.hooked), count(&|case| !case.separated)), (3, 3));
        // By an independent script that hashes "0:c001" and so on.
        let first: Vec<&str> =
            split.test.iter().take(3).map(|idx| cases[*idx].name.as_str()).collect();
        assert_eq!(first, ["c002", "c006", "c008"]);
    }

    #[test]
    fn every_case_tests_once_in_the_folds() {
        let cases = shipped("fea");
        let folds = folds(&cases, 5, 3);
        let mut tested: Vec<usize> = folds.iter().flat_map(|fold| fold.test.clone()).collect();
        tested.sort_unstable();
        assert_eq!(tested, (0..cases.len()).collect::<Vec<_>>());
        for fold in &folds {
            assert_eq!(fold.train.len() + fold.test.len(), cases.len());
            let n_clean = fold.test.iter().filter(|idx| cases[**idx].is_clean()).count();
            assert!((16..=18).contains(&n_clean), "{n_clean} clean of {}", fold.test.len());
        }
        assert!(folds.len() == 5 && super::folds(&cases[..3], 5, 0).len() == 3);
    }
}
