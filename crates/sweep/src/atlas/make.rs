//! Makes an atlas from the rows of a sweep.

use std::collections::{BTreeMap, HashSet};
use std::path::Path;

use crate::atlas::axis::check_all;
use crate::atlas::cell::Moments;
use crate::atlas::file::MAX_FILE_CELLS;
use crate::atlas::model::{MAX_CELLS, n_cells_of};
use crate::atlas::sensitivity::{is_saltelli, sensitivity_of_rows};
use crate::atlas::{Atlas, AtlasError, Axis, Cell, HistogramKind};
use crate::{Column, Outcome, Rows, read_rows};

/// Both networks apply by at least this in a row that counts as inside the domain.
const APPLIES: f64 = 0.5;

/// An atlas that is being made, file by file of rows.
#[derive(Debug)]
pub struct AtlasBuilder {
    atlas: Atlas,
    /// Numbers of the rows so far.
    seen: HashSet<u64>,
}

impl Atlas {
    /// The atlas of some rows.
    ///
    /// # Errors
    /// As [`AtlasBuilder::add`] and [`AtlasBuilder::finish`].
    pub fn from_rows(rows: &Rows, axes: Vec<Axis>) -> Result<Self, AtlasError> {
        let mut builder = AtlasBuilder::new(axes)?;
        builder.add(rows)?;
        builder.finish()
    }
}

impl AtlasBuilder {
    /// An atlas without rows.
    ///
    /// # Errors
    /// [`AtlasError`] if the axes are none, or have more cells than can be numbered.
    pub fn new(axes: Vec<Axis>) -> Result<Self, AtlasError> {
        check_all(&axes)?;
        n_cells_of(&axes).ok_or(AtlasError::TooManyCells { limit: MAX_CELLS })?;
        let atlas = Atlas {
            axes,
            plan_sha256: String::new(),
            program: String::new(),
            networks: BTreeMap::new(),
            n_rows: 0,
            n_failed: 0,
            n_outside: 0,
            sensitivity: Vec::new(),
            sensitivity_plan_sha256: None,
            cells: BTreeMap::new(),
        };
        Ok(Self { atlas, seen: HashSet::new() })
    }

    /// Adds rows of the same plan.
    ///
    /// # Errors
    /// [`AtlasError`] if columns are missing, of other lengths or units, if the rows come from another plan,
    /// program or network than those before or are there already, if they share their inputs, or if an outcome
    /// is infinite.
    pub fn add(&mut self, rows: &Rows) -> Result<(), AtlasError> {
        self.take_meta(rows)?;
        if is_saltelli(rows) {
            return Err(AtlasError::Saltelli);
        }
        let n = rows.index.len();
        let inputs: Vec<&Column> = self
            .atlas
            .axes
            .iter()
            .map(|axis| input(&rows.inputs, axis, n))
            .collect::<Result<_, _>>()?;
        let outcomes: Vec<&Column> = Outcome::ALL
            .iter()
            .map(|outcome| column(&rows.outcomes, outcome.name(), n))
            .collect::<Result<_, _>>()?;
        for (at, row) in rows.index.iter().enumerate() {
            if !self.seen.insert(*row) {
                return Err(AtlasError::Twice { row: *row });
            }
            let value = |column: &&Column| column.values.get(at).copied().unwrap_or(f64::NAN);
            let has_failed = rows.reasons.get(at).is_some_and(|reason| !reason.is_empty());
            let bins: Option<Vec<usize>> = self
                .atlas
                .axes
                .iter()
                .zip(&inputs)
                .map(|(axis, column)| axis.locate(value(column)))
                .collect();
            let Some(number) = bins.and_then(|bins| self.number(&bins)) else {
                self.atlas.n_outside += 1;
                continue;
            };
            let cell = self.atlas.cells.entry(number).or_default();
            if has_failed {
                cell.n_failed += 1;
                self.atlas.n_failed += 1;
                continue;
            }
            let values: Vec<f64> = outcomes.iter().map(value).collect();
            add_row(cell, *row, &values)?;
            self.atlas.n_rows += 1;
        }
        Ok(())
    }

    /// Adds the rows of a file: a chunk, or all chunks merged.
    ///
    /// # Errors
    /// [`AtlasError::Rows`], [`AtlasError::RowsOf`].
    pub fn add_file(&mut self, path: &Path) -> Result<(), AtlasError> {
        self.add(&read_rows(path)?).map_err(rows_of(path))
    }

    /// Adds the Sobol indices of the rows of a file.
    ///
    /// # Errors
    /// [`AtlasError::Rows`], [`AtlasError::RowsOf`].
    pub fn add_sensitivity_file(&mut self, path: &Path) -> Result<(), AtlasError> {
        self.add_sensitivity(&read_rows(path)?).map_err(rows_of(path))
    }

    /// Adds the Sobol indices of the rows of a Saltelli design.
    ///
    /// # Errors
    /// [`AtlasError::Sensitivity`] if the rows are no such design, [`AtlasError::NoColumn`] if an axis does not
    /// vary in them, [`AtlasError::Mixed`] if another program or network computed them.
    pub fn add_sensitivity(&mut self, rows: &Rows) -> Result<(), AtlasError> {
        for axis in &self.atlas.axes {
            input(&rows.inputs, axis, rows.index.len())?;
        }
        if !self.seen.is_empty() {
            self.check_program(rows)?;
        }
        self.atlas.sensitivity = sensitivity_of_rows(rows)?;
        self.atlas.sensitivity_plan_sha256 = Some(rows.meta.plan_sha256.clone());
        Ok(())
    }

    /// The atlas, with its numbers as a file keeps them.
    ///
    /// # Errors
    /// [`AtlasError::NoRows`], and [`AtlasError::TooManyCells`] if more cells have rows than a file may have.
    pub fn finish(self) -> Result<Atlas, AtlasError> {
        let Self { mut atlas, seen } = self;
        if atlas.n_rows == 0 {
            return Err(AtlasError::NoRows { n_rows: seen.len() as u64 });
        }
        if atlas.cells.len() > MAX_FILE_CELLS {
            return Err(AtlasError::TooManyCells { limit: MAX_FILE_CELLS as u64 });
        }
        for cell in atlas.cells.values_mut() {
            for (outcome, moments) in Outcome::ALL.iter().zip(&mut cell.moments) {
                *moments = kept(*moments, outcome.is_probability());
            }
        }
        Ok(atlas)
    }

    /// Takes what the rows say of themselves, or checks it.
    fn take_meta(&mut self, rows: &Rows) -> Result<(), AtlasError> {
        let atlas = &mut self.atlas;
        if self.seen.is_empty() {
            atlas.plan_sha256.clone_from(&rows.meta.plan_sha256);
            atlas.program.clone_from(&rows.meta.program);
            atlas.networks.clone_from(&rows.meta.networks);
            return Ok(());
        }
        same("plans", &atlas.plan_sha256, &rows.meta.plan_sha256)?;
        self.check_program(rows)
    }

    /// Checks that the program and the networks of the rows before have computed these rows.
    fn check_program(&self, rows: &Rows) -> Result<(), AtlasError> {
        same("programs", &self.atlas.program, &rows.meta.program)?;
        let listed = |networks: &BTreeMap<String, String>| {
            networks.values().cloned().collect::<Vec<_>>().join(", ")
        };
        same("networks", &listed(&self.atlas.networks), &listed(&rows.meta.networks))
    }

    /// The number of the cell of some bins.
    fn number(&self, bins: &[usize]) -> Option<u32> {
        let along = self.atlas.axes.iter().zip(bins);
        let number = along.fold(0, |number, (axis, bin)| number * axis.n_bins() + bin);
        u32::try_from(number).ok()
    }
}

fn rows_of(path: &Path) -> impl FnOnce(AtlasError) -> AtlasError + '_ {
    move |source| AtlasError::RowsOf { path: path.to_owned(), source: Box::new(source) }
}

/// Moments with the digits that a file keeps: a count of those that happen, else numbers of 32 bits.
fn kept(moments: Moments, is_probability: bool) -> Moments {
    let Moments { n, mean, m2 } = moments;
    if is_probability {
        return of_count(n, (mean * n as f64).round() as u64);
    }
    Moments { n, mean: f64::from(mean as f32), m2: f64::from(m2 as f32) }
}

/// Moments of what happens in some of the rows.
pub(super) fn of_count(n: u64, happens: u64) -> Moments {
    if n == 0 {
        return Moments::default();
    }
    let (rows, happens) = (n as f64, happens as f64);
    Moments { n, mean: happens / rows, m2: happens - happens * happens / rows }
}

fn add_row(cell: &mut Cell, row: u64, values: &[f64]) -> Result<(), AtlasError> {
    for ((outcome, value), moments) in Outcome::ALL.iter().zip(values).zip(&mut cell.moments) {
        if value.is_nan() {
            continue;
        }
        let (name, value) = (outcome.name(), *value);
        if value.is_infinite() {
            return Err(AtlasError::Infinite { row, name: name.to_owned(), value });
        }
        if outcome.is_probability() && value != 0.0 && value != 1.0 {
            return Err(AtlasError::NotZeroOrOne { row, name: name.to_owned(), value });
        }
        moments.add(value);
    }
    let of = |outcome: Outcome| values.get(outcome as usize).copied().unwrap_or(f64::NAN);
    for (kind, counts) in HistogramKind::ALL.iter().zip(&mut cell.histograms) {
        let value = of(kind.outcome());
        if !value.is_nan()
            && let Some(count) = counts.get_mut(kind.bin(value))
        {
            *count = count.saturating_add(1);
        }
    }
    let applies = |outcome| of(outcome) >= APPLIES;
    cell.n_rows += 1;
    cell.n_inside += u64::from(applies(Outcome::ForceApplies) && applies(Outcome::ResponseApplies));
    Ok(())
}

/// The column of an axis, in its unit.
fn input<'a>(columns: &'a [Column], axis: &Axis, n: usize) -> Result<&'a Column, AtlasError> {
    let found = column(columns, &axis.name, n)?;
    if found.unit != axis.unit {
        let (name, axis, rows) = (axis.name.clone(), axis.unit.clone(), found.unit.clone());
        return Err(AtlasError::OtherUnit { name, axis, rows });
    }
    Ok(found)
}

/// A column with as many values as there are rows.
fn column<'a>(columns: &'a [Column], name: &str, n: usize) -> Result<&'a Column, AtlasError> {
    let found = columns.iter().find(|column| column.name == name);
    let found = found.ok_or_else(|| AtlasError::NoColumn { name: name.to_owned() })?;
    if found.values.len() != n {
        let (name, got) = (name.to_owned(), found.values.len());
        return Err(AtlasError::ColumnLength { name, got, expected: n });
    }
    Ok(found)
}

fn same(what: &'static str, first: &str, second: &str) -> Result<(), AtlasError> {
    let mixed = || AtlasError::Mixed { what, first: first.to_owned(), second: second.to_owned() };
    if first == second { Ok(()) } else { Err(mixed()) }
}

/// Rows for the tests of the atlas.
#[cfg(test)]
pub(super) mod test_rows {
    use std::f64::consts::PI;

    use rand::RngExt;

    use super::*;
    use crate::RowsMeta;
    use impactlab_core::numerics::random_stream;

    /// Speed from 20 to 30 m/s and whether there is ESC.
    pub fn axes(n_speeds: usize) -> Vec<Axis> {
        let edges = (0..=n_speeds).map(|i| 20.0 + 10.0 * i as f64 / n_speeds as f64).collect();
        let axis = |name: &str, word: &str, unit: &str| Axis {
            name: name.to_owned(),
            word: word.to_owned(),
            label: word.to_owned(),
            unit: unit.to_owned(),
            edges: Vec::new(),
            labels: Vec::new(),
        };
        let labels = vec!["without ESC".to_owned(), "with ESC".to_owned()];
        let speed = Axis { edges, ..axis("target_speed_m_s", "speed", "m/s") };
        vec![speed, Axis { labels, ..axis("esc", "esc", "1") }]
    }

    /// Rows whose probability of a quarter turn rises with the speed and is halved by ESC; some have no
    /// rest, some lie outside of the domain.
    pub fn rows(n: u64) -> Rows {
        let mut rng = random_stream(3, "rows of an atlas", 0);
        let mut inputs = vec![Vec::new(); 2];
        let mut outcomes = vec![Vec::new(); Outcome::ALL.len()];
        for _ in 0..n {
            let speed = 20.0 + 10.0 * rng.random::<f64>();
            let esc = f64::from(u8::from(rng.random::<bool>()));
            inputs[0].push(speed);
            inputs[1].push(esc);
            let turns = rng.random::<f64>() < (speed - 20.0) / 10.0 * (1.0 - 0.5 * esc);
            let rests = rng.random::<f64>() < 0.9;
            for (outcome, values) in Outcome::ALL.iter().zip(&mut outcomes) {
                values.push(match outcome {
                    Outcome::ReachM => 20.0 + 40.0 * rng.random::<f64>(),
                    Outcome::OffsetM => 8.0 * rng.random::<f64>() - 4.0,
                    Outcome::TurnRad => {
                        if turns {
                            -0.75 * PI
                        } else {
                            0.1
                        }
                    }
                    Outcome::Turns90 => f64::from(u8::from(turns)),
                    Outcome::RestTimeS if !rests => f64::NAN,
                    Outcome::ForceApplies | Outcome::ResponseApplies => {
                        if rng.random::<f64>() < 0.8 { 1.0 } else { 0.2 }
                    }
                    other if other.is_probability() => f64::from(u8::from(rng.random::<bool>())),
                    _ => 3.0 + rng.random::<f64>(),
                });
            }
        }
        let named = |name: &str, unit: &str, values| Column {
            name: name.to_owned(),
            unit: unit.to_owned(),
            values,
        };
        let [speeds, escs] = <[Vec<f64>; 2]>::try_from(inputs).unwrap();
        Rows {
            inputs: vec![named("target_speed_m_s", "m/s", speeds), named("esc", "1", escs)],
            outcomes: Outcome::ALL
                .iter()
                .zip(outcomes)
                .map(|(outcome, values)| named(outcome.name(), outcome.unit(), values))
                .collect(),
            index: (0..n).collect(),
            caveats: None,
            reasons: vec![String::new(); n as usize],
            meta: RowsMeta {
                plan_sha256: "ab".repeat(32),
                program: "0.1.0+test".to_owned(),
                ..RowsMeta::default()
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::test_rows::{axes, rows};
    use super::*;

    #[test]
    fn a_cell_counts_the_rows_that_lie_in_it() {
        let rows = rows(3000);
        let atlas = Atlas::from_rows(&rows, axes(5)).unwrap();
        assert_eq!((atlas.n_rows, atlas.n_failed, atlas.n_outside), (3000, 0, 0));
        let (speeds, escs) = (&rows.inputs[0].values, &rows.inputs[1].values);
        let turns = rows.outcomes.iter().find(|of| of.name == Outcome::Turns90.name()).unwrap();
        let is_in = |i: &usize| (24.0..26.0).contains(&speeds[*i]) && escs[*i] == 1.0;
        let here: Vec<usize> = (0..3000).filter(is_in).collect();
        let n_turns = here.iter().filter(|i| turns.values[**i] == 1.0).count();
        let cell = atlas.cell(&[Some(2), Some(1)]);
        let told = cell.measure(Outcome::Turns90);
        assert_eq!(told.n_rows, here.len() as u64);
        assert_eq!(told.mean, Some(n_turns as f64 / here.len() as f64));
        let rest = cell.measure(Outcome::RestTimeS);
        assert!(rest.n_applies < rest.n_rows && rest.mean.is_some(), "{rest:?}");
        assert!((told.inside - 0.64).abs() < 0.12, "{}", told.inside);
    }

    #[test]
    fn failed_rows_and_rows_outside_are_counted_apart() {
        let mut rows = rows(400);
        rows.reasons[3] = "no contact".to_owned();
        for column in &mut rows.outcomes {
            column.values[3] = f64::NAN;
        }
        rows.inputs[0].values[5] = 99.0;
        let atlas = Atlas::from_rows(&rows, axes(1)).unwrap();
        assert_eq!((atlas.n_rows, atlas.n_failed, atlas.n_outside), (398, 1, 1));
    }

    #[test]
    fn rows_that_do_not_belong_together_are_refused() {
        let good = rows(50);
        let mut builder = AtlasBuilder::new(axes(1)).unwrap();
        builder.add(&good).unwrap();
        assert!(matches!(builder.add(&good), Err(AtlasError::Twice { row: 0 })));
        let mut other = good.clone();
        other.index = (50..100).collect();
        other.meta.plan_sha256 = "cd".repeat(32);
        assert!(matches!(builder.add(&other), Err(AtlasError::Mixed { what: "plans", .. })));
        let mut infinite = good.clone();
        infinite.outcomes[Outcome::TravelM as usize].values[7] = f64::INFINITY;
        let refused = Atlas::from_rows(&infinite, axes(1));
        assert!(matches!(refused, Err(AtlasError::Infinite { row: 7, .. })), "{refused:?}");
        let mut half = good.clone();
        half.outcomes[Outcome::Turns90 as usize].values[9] = 0.5;
        let refused = Atlas::from_rows(&half, axes(1));
        assert!(matches!(refused, Err(AtlasError::NotZeroOrOne { row: 9, .. })), "{refused:?}");
        let mut short = good.clone();
        short.inputs.pop();
        let refused = Atlas::from_rows(&short, axes(1));
        assert!(matches!(refused, Err(AtlasError::NoColumn { .. })), "{refused:?}");
    }

    /// Edges of 20 to 30 without a unit were taken as m/s, whatever they were meant as.
    #[test]
    fn axes_are_of_the_quantity_of_their_columns() {
        for unit in ["1", "m"] {
            let mut axes = axes(1);
            axes[0].unit = unit.to_owned();
            let refused = Atlas::from_rows(&rows(50), axes);
            assert!(
                matches!(&refused, Err(AtlasError::OtherUnit { rows, .. }) if rows == "m/s"),
                "{refused:?}"
            );
        }
    }
}
