//! Which sweep is worked on, which is saved, and what is known of it, which is not.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use impactlab_sweep::{Plan, SweepStatus};

/// Most reasons and broken chunks that are listed, and letters of the list of missing chunks.
const MOST_LINES: usize = 5;
const MOST_LETTERS: usize = 200;

/// Which sweep is worked on.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct SweepView {
    /// The file of the plan that a person wrote; `None` for the plan in the folder.
    pub plan: Option<PathBuf>,
    /// The folder into which the chunks are written.
    pub folder: Option<PathBuf>,
}

/// A sweep with what its folder holds.
#[derive(Debug, Clone)]
pub struct KnownSweep {
    /// Its plan.
    pub plan: Plan,
    /// What the folder holds; `None` without a folder, or before the plan stands in it.
    pub status: Option<SweepStatus>,
}

/// A sweep that was read.
#[derive(Debug, Clone)]
pub struct ReadSweep {
    /// Which one.
    pub of: SweepView,
    /// The sweep, or what is wrong with it.
    pub sweep: Result<KnownSweep, String>,
}

/// How long some rows took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimedRows {
    /// Number of rows.
    pub n_rows: u64,
    /// Time that they took together, s.
    pub seconds: f64,
}

/// What is known of the sweep.
#[derive(Default)]
pub struct SweepSession {
    /// The sweep that was read last.
    pub(super) read: Option<ReadSweep>,
    /// The sweep that is being read.
    pub(super) reading: Option<SweepView>,
    /// How long some rows took, or why that is not known.
    pub(super) timed: Option<Result<TimedRows, String>>,
    /// Why the latest run ended before it was complete.
    pub(super) problem: Option<String>,
}

impl SweepView {
    /// Whether there is something to read.
    pub fn is_chosen(&self) -> bool {
        self.plan.is_some() || self.folder.is_some()
    }
}

impl KnownSweep {
    /// Number of chunks that are not there, or not whole.
    pub fn n_missing(&self) -> u64 {
        let done = self.status.as_ref().map_or(0, |status| status.chunks_done);
        self.plan.n_chunks().saturating_sub(done)
    }

    /// Number of rows that are not there.
    pub fn rows_left(&self) -> u64 {
        let done = self.status.as_ref().map_or(0, |status| status.rows_done);
        self.plan.n_rows().saturating_sub(done)
    }

    /// Whether a chunk is there.
    pub fn has_begun(&self) -> bool {
        self.status.as_ref().is_some_and(|status| status.chunks_done > 0)
    }

    /// What the folder holds, a line each.
    pub fn status_lines(&self) -> Vec<String> {
        let Some(status) = &self.status else {
            return vec!["Nothing is computed yet.".to_owned()];
        };
        let SweepStatus { chunks_done, rows_done, rows_failed, missing, .. } = status;
        let n_chunks = self.plan.n_chunks();
        let mut lines = vec![format!(
            "{chunks_done} of {n_chunks} chunks are there, with {rows_done} rows, {rows_failed} of \
             them without an answer."
        )];
        if self.n_missing() > 0 {
            let most = missing.char_indices().nth(MOST_LETTERS).map(|(at, _)| at);
            let shown = most.and_then(|at| missing.get(..at));
            let end = if shown.is_some() { " …" } else { "" };
            lines.push(format!("Missing: {}{end}", shown.unwrap_or(missing)));
        }
        let reasons = status.reasons.iter().take(MOST_LINES);
        lines.extend(reasons.map(|(reason, n)| format!("{n} rows: {reason}")));
        let broken = status.broken.iter().take(MOST_LINES);
        lines.extend(broken.map(|(chunk, what)| format!("Chunk {chunk} is broken: {what}")));
        lines
    }
}

impl SweepSession {
    /// The sweep; `None` while it is read, or if something is wrong with it.
    pub fn sweep(&self) -> Option<&KnownSweep> {
        self.read.as_ref()?.sweep.as_ref().ok()
    }

    /// What is wrong with the plan or the folder.
    pub fn refusal(&self) -> Option<&str> {
        self.read.as_ref()?.sweep.as_ref().err().map(String::as_str)
    }

    /// How long some rows took, or why that is not known; `None` if none were timed.
    pub fn timed(&self) -> Option<&Result<TimedRows, String>> {
        self.timed.as_ref()
    }

    /// Why the latest run ended before it was complete.
    pub fn problem(&self) -> Option<&str> {
        self.problem.as_deref()
    }
}

impl TimedRows {
    /// Time that a number of rows take as these did, s.
    pub fn seconds_of(&self, n_rows: u64) -> f64 {
        self.seconds / self.n_rows.max(1) as f64 * n_rows as f64
    }
}
