//! Which cases train and which test: by name and seed, alike on every machine.
//!
//! Ordinary cases and the others (impacts that hook, motions that spin) are split apart, so that each
//! part has its share of both.

use crate::learning::TrainingCase;
use impactlab_core::numerics::sha256_hex;

/// Share of the cases that test: train to test 3 : 1, as in the paper
/// ([`PitPinnPaper`](impactlab_core::bibliography::PitPinnPaper)).
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
pub fn split<C: TrainingCase>(cases: &[C], seed: u64, test_share: f64) -> Split {
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
pub fn folds<C: TrainingCase>(cases: &[C], n_folds: usize, seed: u64) -> Vec<Split> {
    let order: Vec<usize> = strata(cases, seed).concat();
    let fold = |number: usize| {
        let dealt = order.iter().enumerate().map(|(rank, &idx)| (rank % n_folds.max(1), idx));
        let (test, train): (Vec<_>, Vec<_>) = dealt.partition(|(fold, _)| *fold == number);
        let indices = |part: Vec<(usize, usize)>| {
            let mut indices: Vec<usize> = part.into_iter().map(|(_, idx)| idx).collect();
            indices.sort_unstable();
            indices
        };
        Split { train: indices(train), test: indices(test) }
    };
    (0..n_folds).map(fold).filter(|split| !split.test.is_empty()).collect()
}

/// Ordinary cases, then the others, each ordered by hash.
fn strata<C: TrainingCase>(cases: &[C], seed: u64) -> [Vec<usize>; 2] {
    let mut keyed: Vec<(String, usize)> =
        cases.iter().enumerate().map(|(idx, case)| (hash(seed, case.name()), idx)).collect();
    keyed.sort();
    let members = |ordinary: bool| {
        let stratum = keyed.iter().filter(|(_, idx)| cases[*idx].is_ordinary() == ordinary);
        stratum.map(|(_, idx)| *idx).collect()
    };
    [members(true), members(false)]
}

fn hash(seed: u64, name: &str) -> String {
    sha256_hex([format!("{seed}:{name}").as_bytes()])
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Labelled(String, bool);

    impl TrainingCase for Labelled {
        fn name(&self) -> &str {
            &self.0
        }

        fn digest(&self) -> &str {
            &self.0
        }

        fn is_ordinary(&self) -> bool {
            self.1
        }
    }

    /// c001 to c100, every tenth of which is not ordinary.
    fn cases() -> Vec<Labelled> {
        (1..=100).map(|i| Labelled(format!("c{i:03}"), i % 10 != 0)).collect()
    }

    #[test]
    fn each_stratum_gives_its_share_to_the_test() {
        let cases = cases();
        let split = split(&cases, 0, TEST_SHARE);
        assert_eq!((split.train.len(), split.test.len()), (76, 24));
        assert_eq!(split.test.iter().filter(|idx| !cases[**idx].1).count(), 2);
        // "0:c002" has a low hash, by an independent script.
        assert_eq!(split.test.first(), Some(&1));
    }

    #[test]
    fn every_case_tests_once_in_the_folds() {
        let cases = cases();
        let folds = folds(&cases, 5, 3);
        let mut tested: Vec<usize> = folds.iter().flat_map(|fold| fold.test.clone()).collect();
        tested.sort_unstable();
        assert_eq!(tested, (0..cases.len()).collect::<Vec<_>>());
        for fold in &folds {
            assert_eq!((fold.train.len(), fold.test.len()), (80, 20));
            assert_eq!(fold.test.iter().filter(|idx| !cases[**idx].1).count(), 2);
        }
        assert!(folds.len() == 5 && super::folds(&cases[..3], 5, 0).len() == 3);
    }
}
