//! Rows of many things at the same instants, as a solver writes them state by state.

use std::collections::BTreeMap;

/// Rows of `N` numbers of each thing at each instant.
#[derive(Debug)]
pub(super) struct States<K, const N: usize> {
    pub(super) time: Vec<f64>,
    pub(super) rows: BTreeMap<K, Vec<[f64; N]>>,
    n_again: usize,
    is_cut: bool,
}

impl<K, const N: usize> Default for States<K, N> {
    fn default() -> Self {
        Self { time: Vec::new(), rows: BTreeMap::new(), n_again: 0, is_cut: false }
    }
}

impl<K: Ord + Copy, const N: usize> States<K, N> {
    /// Begins a state. States that are not earlier, as after a restart, are written again and count no
    /// longer.
    ///
    /// # Errors
    /// What is missing in the state before, in words.
    pub(super) fn begin(&mut self, time: f64) -> Result<(), String> {
        if self.time.last() == Some(&time) {
            return Ok(());
        }
        let n = self.time.iter().rposition(|earlier| *earlier < time).map_or(0, |at| at + 1);
        match n == self.time.len() {
            true => self.check_complete()?,
            false => self.cut_to(n),
        }
        self.time.push(time);
        Ok(())
    }

    /// Adds the row of one thing to the state.
    ///
    /// # Errors
    /// Why it does not belong there, in words.
    pub(super) fn push(&mut self, key: K, row: [f64; N]) -> Result<(), String> {
        let Some(idx) = self.time.len().checked_sub(1) else {
            return Err("stands before the first instant".to_owned());
        };
        let rows = self.rows.entry(key).or_default();
        if rows.len() == idx {
            rows.push(row);
            return Ok(());
        }
        match rows.get_mut(idx) {
            Some(last) => {
                *last = row;
                Ok(())
            }
            None => Err("is not in the states before this one".to_owned()),
        }
    }

    /// Ends the last state. One that is not complete, as of a run that was killed, is left out.
    pub(super) fn end(&mut self) {
        if self.check_complete().is_err() {
            self.is_cut = true;
            let n = self.time.len().saturating_sub(1);
            self.time.truncate(n);
            self.rows.values_mut().for_each(|rows| rows.truncate(n));
            self.rows.retain(|_, rows| rows.len() == n && n > 0);
        }
    }

    /// What was left out, in words.
    pub(super) fn doubts(&self) -> Vec<String> {
        let again = (self.n_again > 0).then(|| written_again(self.n_again));
        again.into_iter().chain(self.is_cut.then(cut_state)).collect()
    }

    /// A number of one thing at all instants.
    ///
    /// - `at`: its place in the rows.
    pub(super) fn column(rows: &[[f64; N]], at: usize) -> Vec<f64> {
        rows.iter().filter_map(|row| row.get(at).copied()).collect()
    }

    fn cut_to(&mut self, n: usize) {
        self.n_again += self.time.len() - n;
        self.time.truncate(n);
        self.rows.values_mut().for_each(|rows| rows.truncate(n));
    }

    fn check_complete(&self) -> Result<(), String> {
        match self.rows.values().all(|rows| rows.len() == self.time.len()) {
            true => Ok(()),
            false => Err("the state before this one is not complete".to_owned()),
        }
    }
}

/// What is said of states that were written twice.
pub(super) fn written_again(n: usize) -> String {
    format!("{n} states were written again, as after a restart; the later ones count")
}

/// What is said of a last state that is not complete.
pub(super) fn cut_state() -> String {
    "the last state is not complete and is left out; was the run ended?".to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_restart_replaces_and_a_cut_state_is_left_out() {
        let mut states = States::<i64, 1>::default();
        assert!(states.push(1, [0.0]).is_err());
        for (time, value) in [(0.0, 1.0), (1.0, 2.0), (2.0, 3.0), (1.0, 4.0), (3.0, 5.0)] {
            states.begin(time).unwrap();
            states.push(1, [value]).unwrap();
            states.push(2, [-value]).unwrap();
        }
        states.begin(4.0).unwrap();
        states.push(1, [6.0]).unwrap();
        states.end();
        assert_eq!(states.time, [0.0, 1.0, 3.0]);
        assert_eq!(states.rows[&1], [[1.0], [4.0], [5.0]]);
        assert_eq!(states.rows[&2], [[-1.0], [-4.0], [-5.0]]);
        assert_eq!(states.doubts().len(), 2);
        let mut states = States::<i64, 1>::default();
        states.begin(0.0).unwrap();
        states.push(1, [0.0]).unwrap();
        states.begin(1.0).unwrap();
        assert!(states.push(2, [0.0]).is_err());
        assert!(states.begin(2.0).is_err());
    }
}
