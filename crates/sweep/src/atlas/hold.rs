//! Which axes a case can hold, so that enough rows are left to say something of it.

use crate::Outcome;
use crate::atlas::model::is_held;
use crate::atlas::{Atlas, Axis, MIN_ROWS};

impl Atlas {
    /// As many of the wanted bins as leave enough rows for a mean, the axis that moves an outcome most first;
    /// one that would leave too few is averaged over.
    ///
    /// - `wanted`: the bin of every axis in which a case lies.
    pub fn held_in_cell(&self, wanted: &[Option<usize>], outcome: Outcome) -> Vec<Option<usize>> {
        let n_rows = |held: &[Option<usize>]| -> u64 {
            let chosen =
                self.cells.iter().filter(|(number, _)| is_held(&self.bins(**number), held));
            chosen.map(|(_, cell)| cell.n_rows).sum()
        };
        self.held_while(wanted, outcome, |held| n_rows(held) >= MIN_ROWS)
    }

    /// The same for a map, of which every cell has enough rows.
    ///
    /// # Panics
    /// As [`Atlas::slice`].
    pub fn held_in_map(
        &self,
        [x, y]: [usize; 2],
        wanted: &[Option<usize>],
        outcome: Outcome,
    ) -> Vec<Option<usize>> {
        let mut wanted = wanted.to_vec();
        for axis in [x, y] {
            if let Some(bin) = wanted.get_mut(axis) {
                *bin = None;
            }
        }
        self.held_while(&wanted, outcome, |held| {
            let slice = self.slice(x, y, held, outcome);
            slice.cells.iter().all(|cell| cell.n_rows >= MIN_ROWS)
        })
    }

    fn held_while(
        &self,
        wanted: &[Option<usize>],
        outcome: Outcome,
        has_enough: impl Fn(&[Option<usize>]) -> bool,
    ) -> Vec<Option<usize>> {
        let mut held = vec![None; self.axes.len()];
        for axis in self.by_influence(outcome) {
            let mut with_axis = held.clone();
            let slot = with_axis.get_mut(axis).zip(wanted.get(axis).copied().flatten());
            let Some((slot, bin)) = slot else { continue };
            *slot = Some(bin);
            if has_enough(&with_axis) {
                held = with_axis;
            }
        }
        held
    }

    /// The axes, by their total Sobol indices of an outcome the greatest first; then those without one.
    fn by_influence(&self, outcome: Outcome) -> Vec<usize> {
        let indices = self.sensitivity(outcome).unwrap_or_default();
        let rank = |axis: &Axis| indices.iter().position(|index| index.name == axis.name);
        let ranks: Vec<_> = self.axes.iter().map(|axis| rank(axis).unwrap_or(usize::MAX)).collect();
        let mut order: Vec<usize> = (0..ranks.len()).collect();
        order.sort_by_key(|axis| ranks.get(*axis).copied());
        order
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atlas::make::test_rows::{axes, rows};
    use crate::atlas::{OutcomeSensitivity, Sensitivity};

    fn sensitivity(totals: [(&str, f64); 2]) -> Vec<OutcomeSensitivity> {
        let index = |(name, total): (&str, f64)| Sensitivity {
            name: name.to_owned(),
            first: 0.0,
            first_error: 0.0,
            total,
            total_error: 0.0,
        };
        let outcome = Outcome::Turns90.name().to_owned();
        vec![OutcomeSensitivity { outcome, n_bases: 100, inputs: totals.map(index).to_vec() }]
    }

    /// A report held every axis, and had two to twelve rows to tell of.
    #[test]
    fn a_case_holds_what_moves_the_outcome_as_long_as_enough_rows_are_left() {
        let wanted = [Some(3), Some(1)];
        let held = |n_rows: u64, totals: [f64; 2]| {
            let mut rows = rows(n_rows);
            rows.inputs[0].values = (0..n_rows).map(|i| 20.5 + 1.25 * (i % 8) as f64).collect();
            rows.inputs[1].values = (0..n_rows).map(|i| (i / 8 % 2) as f64).collect();
            let mut atlas = Atlas::from_rows(&rows, axes(8)).unwrap();
            let [speed, esc] = totals;
            atlas.sensitivity = sensitivity([("target_speed_m_s", speed), ("esc", esc)]);
            let held = atlas.held_in_cell(&wanted, Outcome::Turns90);
            assert!(atlas.cell(&held).n_rows() >= MIN_ROWS, "{held:?}");
            held
        };
        assert_eq!(held(4000, [0.2, 0.8]), wanted);
        // 30 rows have the speed, and 15 the speed and the ESC.
        assert_eq!(held(240, [0.8, 0.2]), [Some(3), None]);
        assert_eq!(held(240, [0.2, 0.8]), [None, Some(1)]);
        // An axis that leaves too few is passed over for the next one.
        assert_eq!(held(80, [0.8, 0.2]), [None, Some(1)]);
        let few = Atlas::from_rows(&rows(10), axes(8)).unwrap();
        assert_eq!(few.held_in_cell(&wanted, Outcome::Turns90), [None, None]);
    }

    #[test]
    fn a_map_holds_what_leaves_every_cell_of_it_enough_rows() {
        let mut layout = axes(4);
        let driver =
            Axis { name: "driver".to_owned(), word: "driver".to_owned(), ..layout[1].clone() };
        layout.push(driver);
        let held = |n_rows: u64| {
            let mut rows = rows(n_rows);
            let mut driver = rows.inputs[1].clone();
            driver.name = "driver".to_owned();
            driver.values = (0..n_rows).map(|i| (i % 2) as f64).collect();
            rows.inputs.push(driver);
            let atlas = Atlas::from_rows(&rows, layout.clone()).unwrap();
            atlas.held_in_map([0, 1], &[Some(0), Some(0), Some(1)], Outcome::Turns90)
        };
        assert_eq!(held(4000), [None, None, Some(1)]);
        assert_eq!(held(200), [None, None, None]);
    }
}
