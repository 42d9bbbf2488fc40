//! Actions on the sweep.

use std::path::PathBuf;

use crate::app::found::Found;
use crate::app::sweep::{ReadSweep, SweepView, TimedRows};
use impactlab_sweep::RunReport;

/// An action on the sweep.
#[derive(Debug, Clone, PartialEq)]
pub enum SweepCommand {
    /// Show the plan in this file, or the sweep in whose folder it stands.
    OpenPlan(PathBuf),
    /// Compute into this folder.
    Folder(PathBuf),
    /// Look again at what the folder holds.
    Look,
    /// Take a plan that was read with what its folder holds.
    Read(Found<ReadSweep>),
    /// Time some rows, of which nothing is left behind.
    Time,
    /// Take how long some rows of a sweep took, or why that is not known.
    Timed(SweepView, Result<TimedRows, String>),
    /// Compute the chunks that are missing.
    Start,
    /// Stop computing or merging. Chunks that are finished stay.
    Cancel,
    /// Take what a run has done; `None` if it was stopped.
    Ended(Result<Option<RunReport>, String>),
}
