//! The cases of a training: those to learn from, and the names of those kept apart for the test.

use crate::learning::{CaseId, LearningError, Split, TrainingCase, split};
use impactlab_core::numerics::sha256_hex;

/// The cases of a training, already split.
#[derive(Debug, Clone, PartialEq)]
pub struct TrainingSet<C> {
    /// What a person calls the data.
    pub name: String,
    /// The cases to learn from.
    pub train: Vec<C>,
    /// The cases kept apart for the test: a training knows only their names.
    pub test: Vec<CaseId>,
}

impl<C> Default for TrainingSet<C> {
    fn default() -> Self {
        Self { name: String::new(), train: Vec::new(), test: Vec::new() }
    }
}

impl<C: TrainingCase + Clone> TrainingSet<C> {
    /// Splits cases by seed, see [`split()`].
    ///
    /// - `test_share`: share of the cases that is kept apart for the test, 0 to 1.
    pub fn from_split(name: impl Into<String>, cases: &[C], seed: u64, test_share: f64) -> Self {
        let Split { train, test } = split(cases, seed, test_share);
        let pick = |indices: Vec<usize>| indices.into_iter().filter_map(|idx| cases.get(idx));
        Self {
            name: name.into(),
            train: pick(train).cloned().collect(),
            test: pick(test).map(CaseId::from_case).collect(),
        }
    }

    /// Adds cases of other data sets to learn from, except those that are kept apart for the test.
    #[must_use]
    pub fn with_extra(mut self, extra: &[C]) -> Self {
        let is_new = |case: &&C| self.test.iter().all(|id| id.digest != case.digest());
        let extra: Vec<C> = extra.iter().filter(is_new).cloned().collect();
        self.train.extend(extra);
        self
    }

    /// Chooses some of the cases to learn from, the ordinary ones and the others as they occur.
    ///
    /// - `n_cases`: how many; `None` keeps all of them;
    /// - `seed`: of the choice alone.
    ///
    /// # Errors
    /// [`LearningError::TooFewCases`] if there are fewer, or none.
    pub fn choose(mut self, n_cases: Option<usize>, seed: u64) -> Result<Self, LearningError> {
        let wanted = n_cases.unwrap_or(self.train.len());
        self.check_size(wanted.max(1))?;
        self.train = chosen(&self.train, wanted.max(1), seed);
        Ok(self)
    }

    /// Checks that there are enough cases to learn from.
    ///
    /// # Errors
    /// [`LearningError::TooFewCases`].
    pub fn check_size(&self, least: usize) -> Result<(), LearningError> {
        match self.train.len() {
            n_cases if n_cases < least => Err(LearningError::TooFewCases { n_cases, least }),
            _ => Ok(()),
        }
    }

    /// Several sets as one, called after all of them.
    #[must_use]
    pub fn joined(sets: Vec<Self>) -> Self {
        let names: Vec<&str> = sets.iter().map(|set| set.name.as_str()).collect();
        let mut joined = Self { name: names.join(" and "), ..Self::default() };
        for set in sets {
            joined.train.extend(set.train);
            joined.test.extend(set.test);
        }
        joined
    }

    /// The same set with only some of its cases to learn from.
    #[must_use]
    pub fn part(&self, indices: &[usize]) -> Self {
        let train = indices.iter().filter_map(|&idx| self.train.get(idx).cloned()).collect();
        Self { name: self.name.clone(), train, test: self.test.clone() }
    }

    /// The SHA-256 over the digests of the cases to learn from.
    pub fn digest(&self) -> String {
        sha256_hex(self.train.iter().map(|case| case.digest().as_bytes()))
    }
}

/// `n` of the cases by the hash of their names: the test part of a split, which takes from each
/// stratum its share, and from the rest where rounding leaves one short.
fn chosen<C: TrainingCase + Clone>(cases: &[C], n: usize, seed: u64) -> Vec<C> {
    let share = n as f64 / cases.len().max(1) as f64;
    let Split { test: mut taken, train: left } = split(cases, seed, share);
    taken.truncate(n);
    let missing = n - taken.len();
    taken.extend(left.into_iter().take(missing));
    taken.sort_unstable();
    taken.into_iter().filter_map(|idx| cases.get(idx).cloned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, Clone, PartialEq)]
    struct Numbered {
        name: String,
        spins: bool,
    }

    impl TrainingCase for Numbered {
        fn name(&self) -> &str {
            &self.name
        }

        fn digest(&self) -> &str {
            &self.name
        }

        fn is_ordinary(&self) -> bool {
            !self.spins
        }
    }

    fn cases() -> Vec<Numbered> {
        let case = |i: usize| Numbered { name: format!("c{i:03}"), spins: i.is_multiple_of(4) };
        (0..100).map(case).collect()
    }

    fn set(name: &str, n: usize, seed: u64) -> TrainingSet<Numbered> {
        TrainingSet::from_split(name, &cases(), 0, 0.25).choose(Some(n), seed).unwrap()
    }

    #[test]
    fn cases_are_chosen_as_they_occur_and_never_from_the_test() {
        for (n, seed) in [(20, 0), (5, 1), (7, 2), (1, 3)] {
            let set = set("made", n, seed);
            assert_eq!((set.train.len(), set.test.len()), (n, 25));
            let n_spin = set.train.iter().filter(|case| case.spins).count();
            assert!(n_spin.abs_diff(n / 4) <= 1, "{n_spin} of {n}");
            assert!(set.train.iter().all(|case| set.test.iter().all(|id| id.name != case.name)));
        }
        assert_eq!(set("made", 20, 0), set("made", 20, 0));
        assert_ne!(set("made", 20, 0).digest(), set("made", 20, 1).digest());
        assert_eq!(set("made", 20, 0).test, set("made", 20, 1).test);
    }

    #[test]
    fn joined_sets_keep_what_was_chosen() {
        let joined = TrainingSet::joined(vec![set("a", 10, 0), set("b", 10, 1)]);
        assert_eq!(
            (joined.name.as_str(), joined.train.len(), joined.test.len()),
            ("a and b", 20, 50)
        );
        assert_eq!(TrainingSet::joined(vec![set("a", 10, 0)]), set("a", 10, 0));
    }

    #[test]
    fn more_than_there_are_cannot_be_chosen() {
        let all = TrainingSet::from_split("made", &cases(), 0, 0.25);
        let message = all.choose(Some(76), 0).unwrap_err().to_string();
        assert_eq!(message, "75 cases to learn from, expected 76 or more");
        let none = TrainingSet::<Numbered>::from_split("made", &[], 0, 0.25);
        assert!(none.choose(None, 0).is_err());
    }

    #[test]
    fn cases_of_other_sets_are_learned_from_unless_they_test() {
        let cases = cases();
        let set = TrainingSet::from_split("made", &cases, 0, 0.25).with_extra(&cases);
        assert_eq!((set.train.len(), set.test.len()), (150, 25));
    }
}
