//! The atlas and what is read from it.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use serde::Serialize;

use crate::atlas::{Axis, Cell, Measure, OutcomeSensitivity, Sensitivity, SliceCell};
use crate::plan::networks;
use crate::{Outcome, SweepError};
use impactlab_study::Library;

/// The cells of the shipped atlas; empty as long as none is shipped.
const SHIPPED: &[u8] = include_bytes!("../../../../assets/atlas/pit.atlas");

/// Most cells that the axes may have: what a cell is numbered by.
pub(super) const MAX_CELLS: u64 = u32::MAX as u64;

/// Outcomes of a manoeuvre over its conditions, in cells.
#[derive(Debug, Clone, PartialEq)]
pub struct Atlas {
    /// What the cells are laid out over.
    pub axes: Vec<Axis>,
    /// SHA-256 of the plan whose rows it is made of.
    pub plan_sha256: String,
    /// The program that computed the rows.
    pub program: String,
    /// SHA-256 of each network that computed them.
    pub networks: BTreeMap<String, String>,
    /// Rows with an answer within the axes.
    pub n_rows: u64,
    /// Rows within the axes that have none.
    pub n_failed: u64,
    /// Rows outside the axes, which are in no cell.
    pub n_outside: u64,
    /// Sobol indices of each outcome that has them.
    pub sensitivity: Vec<OutcomeSensitivity>,
    /// SHA-256 of the plan of the Saltelli design that they come from.
    pub sensitivity_plan_sha256: Option<String>,
    /// The cells that have rows, by their numbers: the last axis counts fastest.
    pub(super) cells: BTreeMap<u32, Cell>,
}

/// A map of two axes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Slice {
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// Row by row from the lowest y upwards, each row from the lowest x onwards.
    pub cells: Vec<SliceCell>,
}

impl Slice {
    /// A cell of the map.
    pub fn at(&self, x: usize, y: usize) -> Option<&SliceCell> {
        let width = self.x.n_bins();
        (x < width).then(|| self.cells.get(y * width + x)).flatten()
    }
}

impl Atlas {
    /// The atlas of the PIT manoeuvre that comes with the program; `None` as long as none does.
    pub fn shipped() -> Option<&'static Self> {
        static ATLAS: LazyLock<Option<Atlas>> = LazyLock::new(|| {
            if SHIPPED.is_empty() {
                return None;
            }
            match Atlas::from_bytes(SHIPPED) {
                Ok(atlas) => Some(atlas),
                Err(error) => unreachable!("the shipped atlas is bad (a test reads it): {error}"),
            }
        });
        ATLAS.as_ref()
    }

    /// The outcomes of which it has cells.
    pub fn outcomes(&self) -> &'static [Outcome] {
        Outcome::ALL
    }

    /// Number of cells that have rows.
    pub fn n_cells(&self) -> usize {
        self.cells.len()
    }

    /// The axis that a name or a word names, by its number.
    pub fn axis(&self, name: &str) -> Option<usize> {
        self.axes.iter().position(|axis| axis.name == name || axis.word == name)
    }

    /// The bin of every axis in which a case lies; `None` for an axis of which no value is given or whose
    /// value lies outside.
    ///
    /// - `values`: names of axes and their values in SI units.
    pub fn locate(&self, values: &[(&str, f64)]) -> Vec<Option<usize>> {
        let bin = |axis: &Axis| {
            let given = values.iter().find(|(name, _)| *name == axis.name || *name == axis.word);
            given.and_then(|(_, value)| axis.locate(*value))
        };
        self.axes.iter().map(bin).collect()
    }

    /// A map over two axes.
    ///
    /// - `held`: the bin of every axis that is held; over the others the rows are put together, so that
    ///   each counts as often as the plan has it. Those of x and y are left out.
    ///
    /// # Panics
    /// If there is no axis of number `x` or `y`.
    pub fn slice(
        &self,
        x: usize,
        y: usize,
        held: &[Option<usize>],
        measure: impl Into<Measure>,
    ) -> Slice {
        let measure = measure.into();
        let (x_axis, y_axis) = (self.axes[x].clone(), self.axes[y].clone());
        let width = x_axis.n_bins();
        let mut cells = vec![Cell::default(); width * y_axis.n_bins()];
        let mut held = held.to_vec();
        for axis in [x, y] {
            if let Some(held) = held.get_mut(axis) {
                *held = None;
            }
        }
        for (number, cell) in &self.cells {
            let at = self.bins(*number);
            if !is_held(&at, &held) {
                continue;
            }
            let place = at.get(x).zip(at.get(y)).map(|(x, y)| y * width + x);
            if let Some(slot) = place.and_then(|place| cells.get_mut(place)) {
                slot.merge_for(cell, measure);
            }
        }
        let cells = cells.iter().map(|cell| cell.measure(measure)).collect();
        Slice { x: x_axis, y: y_axis, cells }
    }

    /// All rows of the cells that are chosen, put together.
    ///
    /// - `at`: the bin of every axis that is chosen; all bins of the others.
    pub fn cell(&self, at: &[Option<usize>]) -> Cell {
        let mut all = Cell::default();
        for (number, cell) in &self.cells {
            if is_held(&self.bins(*number), at) {
                all.merge(cell);
            }
        }
        all
    }

    /// The networks that are not those that computed it.
    ///
    /// - `present`: names of networks with the SHA-256 of their files.
    pub fn other_networks<'a>(
        &self,
        present: impl IntoIterator<Item = (&'a str, &'a str)>,
    ) -> Vec<&'a str> {
        let is_other = |(name, sha256): &(&str, &str)| {
            self.networks.get(*name).is_none_or(|computed| computed != sha256)
        };
        present.into_iter().filter(is_other).map(|(name, _)| name).collect()
    }

    /// The networks of the program that are not those that computed it.
    ///
    /// # Errors
    /// [`SweepError::Study`] if they cannot be read.
    pub fn other_networks_in(&self, library: &Library) -> Result<Vec<String>, SweepError> {
        let present = networks(library)?;
        let present = present.iter().map(|(name, sha256)| (name.as_str(), sha256.as_str()));
        Ok(self.other_networks(present).into_iter().map(str::to_owned).collect())
    }

    /// The Sobol indices of an outcome, the greatest total one first; `None` if it has none.
    pub fn sensitivity(&self, outcome: Outcome) -> Option<Vec<Sensitivity>> {
        let found = self.sensitivity.iter().find(|of| of.outcome == outcome.name())?;
        let mut indices = found.inputs.clone();
        indices.sort_by(|a, b| b.total.total_cmp(&a.total));
        Some(indices)
    }

    /// The bin along every axis of a cell.
    pub(super) fn bins(&self, number: u32) -> Vec<usize> {
        let mut rest = number as usize;
        let mut bins: Vec<usize> = Vec::with_capacity(self.axes.len());
        for axis in self.axes.iter().rev() {
            let n_bins = axis.n_bins().max(1);
            bins.push(rest % n_bins);
            rest /= n_bins;
        }
        bins.reverse();
        bins
    }
}

/// Whether a cell is one of those that are chosen.
pub(super) fn is_held(at: &[usize], held: &[Option<usize>]) -> bool {
    at.iter().zip(held).all(|(bin, held)| held.is_none_or(|held| held == *bin))
}

/// Number of cells of some axes; `None` if they are too many.
pub(super) fn n_cells_of(axes: &[Axis]) -> Option<u64> {
    let mut n: u64 = 1;
    for axis in axes {
        n = n.checked_mul(axis.n_bins() as u64).filter(|n| *n <= MAX_CELLS)?;
    }
    Some(n)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atlas::make::test_rows::{axes, rows};

    #[test]
    fn a_shipped_atlas_can_be_read_and_has_the_axes_that_are_shipped() {
        if SHIPPED.is_empty() {
            assert!(Atlas::shipped().is_none());
        } else {
            let atlas = Atlas::from_bytes(SHIPPED).unwrap();
            assert_eq!(atlas.axes, Axis::pit().unwrap());
            assert!(SHIPPED.len() <= 5 << 20, "{} bytes", SHIPPED.len());
            let others = atlas.other_networks_in(&Library::default()).unwrap();
            assert_eq!(others, Vec::<String>::new());
        }
    }

    #[test]
    fn cells_put_together_are_the_same_as_cells_of_wider_bins() {
        let rows = rows(4000);
        let fine = Atlas::from_rows(&rows, axes(8)).unwrap();
        let wide = Atlas::from_rows(&rows, axes(1)).unwrap();
        let (all, direct) = (fine.cell(&[None, None]), wide.cell(&[None, None]));
        assert_eq!((all.n_rows, all.n_inside), (direct.n_rows, direct.n_inside));
        assert_eq!(all.histograms, direct.histograms);
        for (merged, direct) in all.moments.iter().zip(&direct.moments) {
            assert_eq!(merged.n, direct.n);
            // The cells are kept with the digits of the file.
            let close = |a: f64, b: f64| (a - b).abs() <= 1e-5 * (1.0 + a.abs());
            assert!(close(merged.mean, direct.mean), "{merged:?} {direct:?}");
            assert!(close(merged.m2, direct.m2), "{merged:?} {direct:?}");
        }
        let one = fine.slice(0, 1, &[None, None], Outcome::Turns90);
        let n: u64 = one.cells.iter().map(|cell| cell.n_rows).sum();
        assert_eq!(n, fine.n_rows);
    }

    #[test]
    fn a_slice_holds_what_is_held() {
        let rows = rows(4000);
        let atlas = Atlas::from_rows(&rows, axes(4)).unwrap();
        let whole = atlas.slice(0, 1, &[None, None], Outcome::TravelM);
        for (x, y) in [(0, 0), (3, 1)] {
            let cell = atlas.cell(&[Some(x), Some(y)]).measure(Outcome::TravelM);
            assert_eq!(whole.at(x, y), Some(&cell));
        }
        assert_eq!(whole.at(4, 0), None);
        // What is held along x or y itself is not.
        assert_eq!(atlas.slice(0, 1, &[Some(2), Some(0)], Outcome::TravelM), whole);
        let located = atlas.locate(&[("speed", 22.0), ("esc", 1.0)]);
        assert_eq!(located, [Some(0), Some(1)]);
        assert_eq!(atlas.locate(&[("speed", 1.0)]), [None, None]);
    }

    #[test]
    fn networks_that_did_not_compute_an_atlas_are_named() {
        let mut atlas = Atlas::from_rows(&rows(100), axes(1)).unwrap();
        atlas.networks = BTreeMap::from([("force".to_owned(), "ab".to_owned())]);
        assert_eq!(atlas.other_networks([("force", "ab")]), [""; 0]);
        let other = atlas.other_networks([("force", "cd"), ("response", "ef")]);
        assert_eq!(other, ["force", "response"]);
    }

    #[test]
    fn the_corridor_is_a_quantile_of_the_rows() {
        let atlas = Atlas::from_rows(&rows(4000), axes(2)).unwrap();
        let corridor = atlas.cell(&[None, None]).corridor();
        let (length, width) = (corridor.length_m.unwrap(), corridor.width_m.unwrap());
        // Reach is spread evenly over 20 to 60 m, the offset over −4 to 4 m.
        assert!((length.value - 56.0).abs() < 4.0 * length.error + 0.5, "{length:?}");
        assert!((width.value - 3.6).abs() < 4.0 * width.error + 0.1, "{width:?}");
        let map = atlas.slice(0, 1, &[None, None], Measure::CorridorLength);
        assert!(map.cells.iter().all(|cell| cell.mean.is_some()));
    }
}
