//! The file of an atlas: a zip of a head in JSON and one array for each column of the table of cells,
//! which `numpy.load` reads as well.
//!
//! ```text
//! atlas.json                       axes, plan, program, networks, edges of the histograms, Sobol indices
//! cell.npy                         number of each cell; the last axis counts fastest
//! rows.npy  failed.npy  inside.npy
//! NAME.n.npy                       rows to which an outcome applies
//! NAME.k.npy                       in how many of them it happens, of a probability; else
//! NAME.mean.npy  NAME.m2.npy       mean and sum of squared deviations
//! NAME.histogram.npy               counts, one row a cell
//! ```

use std::collections::BTreeMap;
use std::io::{Cursor, Read, Write};
use std::path::Path;

use serde::{Deserialize, Serialize};
use zip::write::SimpleFileOptions;
use zip::{ZipArchive, ZipWriter};

use crate::Outcome;
use crate::atlas::axis::check_all;
use crate::atlas::cell::Moments;
use crate::atlas::make::of_count;
use crate::atlas::model::{MAX_CELLS, n_cells_of};
use crate::atlas::{
    Atlas, AtlasError, AtlasFileError, Axis, Cell, HistogramKind, OutcomeSensitivity, npy,
};
use impactlab_core::data::{Existing, read_bytes, write_bytes};

/// Version of the format.
pub(super) const FORMAT: u32 = 1;

/// Most bytes of a file and of its head.
const MAX_FILE_BYTES: u64 = 64 << 20;
const MAX_HEAD_BYTES: u64 = 1 << 20;

/// Most cells of an atlas, of which each takes about a kilobyte of memory, however small the file is.
pub(super) const MAX_FILE_CELLS: usize = 40_000;

const HEAD: &str = "atlas.json";

/// The head of the file.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Head {
    format: u32,
    plan_sha256: String,
    program: String,
    networks: BTreeMap<String, String>,
    axes: Vec<Axis>,
    outcomes: Vec<String>,
    histograms: BTreeMap<String, Vec<f64>>,
    n_cells: usize,
    n_rows: u64,
    n_failed: u64,
    n_outside: u64,
    sensitivity: Vec<OutcomeSensitivity>,
    sensitivity_plan_sha256: Option<String>,
}

impl Atlas {
    /// Reads an atlas.
    ///
    /// # Errors
    /// [`AtlasError::Data`], [`AtlasError::File`].
    pub fn read(path: &Path) -> Result<Self, AtlasError> {
        let bytes = read_bytes(path, MAX_FILE_BYTES)?;
        Self::from_bytes(&bytes)
            .map_err(|source| AtlasError::File { path: path.to_owned(), source: Box::new(source) })
    }

    /// Writes the atlas, whole or not at all.
    ///
    /// - `existing`: what happens to a file that exists already.
    ///
    /// # Errors
    /// [`AtlasError::Data`], [`AtlasError::Encode`].
    pub fn write(&self, path: &Path, existing: Existing) -> Result<(), AtlasError> {
        let bytes = self.to_bytes().map_err(|source| AtlasError::Encode(Box::new(source)))?;
        Ok(write_bytes(path, existing, &bytes)?)
    }

    /// The file of the atlas. The same atlas gives the same bytes.
    ///
    /// # Errors
    /// [`AtlasFileError`].
    pub fn to_bytes(&self) -> Result<Vec<u8>, AtlasFileError> {
        let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
        let head = serde_json::to_vec_pretty(&self.head())?;
        let parts = [(HEAD.to_owned(), head)].into_iter().chain(self.columns());
        for (name, bytes) in parts {
            let zipped = |source| AtlasFileError::Zip { name: name.clone(), source };
            zip.start_file(name.as_str(), SimpleFileOptions::default()).map_err(zipped)?;
            let io = |source| AtlasFileError::Io { name: name.clone(), source };
            zip.write_all(&bytes).map_err(io)?;
        }
        let zipped = |source| AtlasFileError::Zip { name: HEAD.to_owned(), source };
        Ok(zip.finish().map_err(zipped)?.into_inner())
    }

    /// Reads the file of an atlas.
    ///
    /// # Errors
    /// [`AtlasFileError`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, AtlasFileError> {
        let zipped = |source| AtlasFileError::Zip { name: HEAD.to_owned(), source };
        let mut file = AtlasFile { zip: ZipArchive::new(Cursor::new(bytes)).map_err(zipped)? };
        let head: Head = serde_json::from_slice(&file.part(HEAD, MAX_HEAD_BYTES)?)?;
        check_head(&head)?;
        let cells = file.cells(&head)?;
        let sum = |of: fn(&Cell) -> u64| cells.values().map(of).sum::<u64>();
        if [sum(|cell| cell.n_rows), sum(|cell| cell.n_failed)] != [head.n_rows, head.n_failed] {
            return Err(AtlasFileError::Contradiction { cell: cells.len() });
        }
        Ok(Self {
            axes: head.axes,
            plan_sha256: head.plan_sha256,
            program: head.program,
            networks: head.networks,
            n_rows: head.n_rows,
            n_failed: head.n_failed,
            n_outside: head.n_outside,
            sensitivity: head.sensitivity,
            sensitivity_plan_sha256: head.sensitivity_plan_sha256,
            cells,
        })
    }

    fn head(&self) -> Head {
        Head {
            format: FORMAT,
            plan_sha256: self.plan_sha256.clone(),
            program: self.program.clone(),
            networks: self.networks.clone(),
            axes: self.axes.clone(),
            outcomes: outcome_names(),
            histograms: histogram_edges(),
            n_cells: self.cells.len(),
            n_rows: self.n_rows,
            n_failed: self.n_failed,
            n_outside: self.n_outside,
            sensitivity: self.sensitivity.clone(),
            sensitivity_plan_sha256: self.sensitivity_plan_sha256.clone(),
        }
    }

    /// The columns of the table of cells, each with its name.
    fn columns(&self) -> Vec<(String, Vec<u8>)> {
        let n = self.cells.len();
        let cells = || self.cells.values();
        let counts = |values: Vec<u32>| npy::of_counts(&values, [n, 1]);
        let of = |get: fn(&Cell) -> u64| counts(cells().map(|cell| count(get(cell))).collect());
        let mut columns = vec![
            ("cell.npy".to_owned(), counts(self.cells.keys().copied().collect())),
            ("rows.npy".to_owned(), of(|cell| cell.n_rows)),
            ("failed.npy".to_owned(), of(|cell| cell.n_failed)),
            ("inside.npy".to_owned(), of(|cell| cell.n_inside)),
        ];
        for (idx, outcome) in Outcome::ALL.iter().enumerate() {
            let moments: Vec<Moments> =
                cells().filter_map(|cell| cell.moments.get(idx).copied()).collect();
            let [applies, happens, mean, m2] = names(*outcome);
            columns.push((applies, counts(moments.iter().map(|of| count(of.n)).collect())));
            if outcome.is_probability() {
                let happen = |of: &Moments| count((of.mean * of.n as f64).round() as u64);
                columns.push((happens, counts(moments.iter().map(happen).collect())));
            } else {
                let number = |get: fn(&Moments) -> f64| {
                    npy::of_numbers(&moments.iter().map(|of| get(of) as f32).collect::<Vec<_>>())
                };
                columns.push((mean, number(|of| of.mean)));
                columns.push((m2, number(|of| of.m2)));
            }
        }
        for (idx, kind) in HistogramKind::ALL.iter().enumerate() {
            let rows = cells().filter_map(|cell| cell.histograms.get(idx));
            let values: Vec<u32> = rows.flatten().copied().collect();
            columns.push((histogram_name(*kind), npy::of_counts(&values, [n, kind.n_bins()])));
        }
        columns
    }
}

/// A count as a file has it. There are no more rows than this: each has a number of its own in memory.
fn count(n: u64) -> u32 {
    u32::try_from(n).unwrap_or(u32::MAX)
}

/// Names of the columns of an outcome: where it applies, where it happens, its mean, its squares.
fn names(outcome: Outcome) -> [String; 4] {
    ["n", "k", "mean", "m2"].map(|part| format!("{}.{part}.npy", outcome.name()))
}

fn histogram_name(kind: HistogramKind) -> String {
    format!("{}.histogram.npy", kind.outcome().name())
}

fn outcome_names() -> Vec<String> {
    Outcome::ALL.iter().map(|outcome| outcome.name().to_owned()).collect()
}

fn histogram_edges() -> BTreeMap<String, Vec<f64>> {
    let edges = |kind: &HistogramKind| (kind.outcome().name().to_owned(), kind.edges());
    HistogramKind::ALL.iter().map(edges).collect()
}

fn check_head(head: &Head) -> Result<(), AtlasFileError> {
    if head.format != FORMAT {
        return Err(AtlasFileError::Format { got: head.format });
    }
    let axes = |error| AtlasFileError::Axes(Box::new(error));
    check_all(&head.axes).map_err(axes)?;
    let limit = n_cells_of(&head.axes)
        .ok_or_else(|| axes(AtlasError::TooManyCells { limit: MAX_CELLS }))?
        .min(MAX_FILE_CELLS as u64);
    if head.n_cells == 0 || head.n_cells as u64 > limit {
        return Err(AtlasFileError::Cells { got: head.n_cells, limit });
    }
    if head.outcomes != outcome_names() {
        return Err(AtlasFileError::Other { what: "outcomes" });
    }
    if head.histograms != histogram_edges() {
        return Err(AtlasFileError::Other { what: "histograms" });
    }
    let is_finite = |of: &OutcomeSensitivity| of.inputs.iter().all(|input| input.is_finite());
    if !head.sensitivity.iter().all(is_finite) {
        return Err(AtlasFileError::Other { what: "Sobol indices" });
    }
    Ok(())
}

/// The archive while it is read.
struct AtlasFile<'a> {
    zip: ZipArchive<Cursor<&'a [u8]>>,
}

impl AtlasFile<'_> {
    /// A part, unpacked.
    ///
    /// - `limit`: most bytes that are unpacked.
    fn part(&mut self, name: &str, limit: u64) -> Result<Vec<u8>, AtlasFileError> {
        let zipped = |source| AtlasFileError::Zip { name: name.to_owned(), source };
        let entry = self.zip.by_name(name).map_err(zipped)?;
        let mut bytes = Vec::new();
        let io = |source| AtlasFileError::Io { name: name.to_owned(), source };
        entry.take(limit + 1).read_to_end(&mut bytes).map_err(io)?;
        if bytes.len() as u64 > limit {
            return Err(AtlasFileError::TooLarge { name: name.to_owned(), limit });
        }
        Ok(bytes)
    }

    fn counts(&mut self, name: &str, shape: [usize; 2]) -> Result<Vec<u32>, AtlasFileError> {
        npy::counts(name, &self.part(name, npy::most_bytes(shape))?, shape)
    }

    fn numbers(&mut self, name: &str, n: usize) -> Result<Vec<f32>, AtlasFileError> {
        npy::numbers(name, &self.part(name, npy::most_bytes([n, 1]))?, n)
    }

    /// The table of cells.
    fn cells(&mut self, head: &Head) -> Result<BTreeMap<u32, Cell>, AtlasFileError> {
        let n = head.n_cells;
        let numbers = self.counts("cell.npy", [n, 1])?;
        let limit = n_cells_of(&head.axes).unwrap_or(0);
        let rises = |idx: &usize| match (numbers.get(*idx), numbers.get(idx + 1)) {
            (Some(number), Some(next)) => number < next,
            (Some(last), None) => u64::from(*last) < limit,
            _ => false,
        };
        if let Some(cell) = (0..n).find(|idx| !rises(idx)) {
            return Err(AtlasFileError::Contradiction { cell });
        }
        let mut cells = vec![Cell::default(); n];
        let counts: [Vec<u32>; 3] = [
            self.counts("rows.npy", [n, 1])?,
            self.counts("failed.npy", [n, 1])?,
            self.counts("inside.npy", [n, 1])?,
        ];
        let [rows, failed, inside] = &counts;
        for (cell, ((rows, failed), inside)) in
            cells.iter_mut().zip(rows.iter().zip(failed).zip(inside))
        {
            cell.n_rows = u64::from(*rows);
            cell.n_failed = u64::from(*failed);
            cell.n_inside = u64::from(*inside);
        }
        for (idx, outcome) in Outcome::ALL.iter().enumerate() {
            let column = self.moments(*outcome, n)?;
            for (cell, moments) in cells.iter_mut().zip(column) {
                if let Some(slot) = cell.moments.get_mut(idx) {
                    *slot = moments;
                }
            }
        }
        for (idx, kind) in HistogramKind::ALL.iter().enumerate() {
            let values = self.counts(&histogram_name(*kind), [n, kind.n_bins()])?;
            for (cell, counts) in cells.iter_mut().zip(values.chunks_exact(kind.n_bins())) {
                if let Some(slot) = cell.histograms.get_mut(idx) {
                    slot.copy_from_slice(counts);
                }
            }
        }
        if let Some(cell) = cells.iter().position(|cell| !is_consistent(cell)) {
            return Err(AtlasFileError::Contradiction { cell });
        }
        Ok(numbers.into_iter().zip(cells).collect())
    }

    /// The moments of an outcome in every cell.
    fn moments(&mut self, outcome: Outcome, n: usize) -> Result<Vec<Moments>, AtlasFileError> {
        let [applies, happens, mean, m2] = names(outcome);
        let applies = self.counts(&applies, [n, 1])?;
        if outcome.is_probability() {
            let happens = self.counts(&happens, [n, 1])?;
            let both = applies.iter().zip(&happens);
            if let Some(cell) = both.clone().position(|(applies, happens)| happens > applies) {
                return Err(AtlasFileError::Contradiction { cell });
            }
            return Ok(both.map(|(n, k)| of_count(u64::from(*n), u64::from(*k))).collect());
        }
        let (mean, m2) = (self.numbers(&mean, n)?, self.numbers(&m2, n)?);
        if let Some(cell) = m2.iter().position(|m2| *m2 < 0.0) {
            return Err(AtlasFileError::Contradiction { cell });
        }
        let both = mean.into_iter().zip(m2);
        let moments = |(n, (mean, m2)): (u32, (f32, f32))| Moments {
            n: u64::from(n),
            mean: f64::from(mean),
            m2: f64::from(m2),
        };
        Ok(applies.into_iter().zip(both).map(moments).collect())
    }
}

/// Whether nothing is counted more often than there are rows.
fn is_consistent(cell: &Cell) -> bool {
    let n = cell.n_rows;
    let total = |counts: &Vec<u32>| counts.iter().map(|count| u64::from(*count)).sum::<u64>();
    cell.n_inside <= n
        && cell.moments.iter().all(|moments| moments.n <= n)
        && cell.histograms.iter().all(|counts| total(counts) <= n)
}

#[cfg(test)]
#[path = "file_tests.rs"]
mod tests;
