//! The work on a sweep that is done on other threads.

use std::path::Path;
use std::time::Instant;

use crate::app::sweep::{KnownSweep, SweepView, TimedRows};
use impactlab_core::data::Existing;
use impactlab_core::error_chain;
use impactlab_core::jobs::{Progress, ProgressCallback};
use impactlab_study::Library;
use impactlab_sweep::{
    Answerer, PLAN_FILE, Plan, RunReport, SweepError, SweepStatus, answer_rows, run_chunks,
};

/// Rows that are timed. The first ones pay for what is read once.
const TIMED_ROWS: u64 = 64;

fn told(error: SweepError) -> String {
    error_chain(&error)
}

/// Reads a plan and what its folder holds.
///
/// # Errors
/// A message for the user.
pub fn read(of: &SweepView, library: &Library) -> Result<KnownSweep, String> {
    let written = of.plan.as_ref().map(|path| Plan::read(path, library)).transpose();
    let written = written.map_err(told)?;
    let folder = of.folder.as_ref().filter(|folder| folder.join(PLAN_FILE).exists());
    let stored = folder.map(|folder| SweepStatus::read(folder)).transpose().map_err(told)?;
    let (stored, status) = stored.unzip();
    match (written, stored) {
        (Some(written), Some(stored)) if written != stored => Err(
            "this folder holds the sweep of another plan, or of another version of the program: \
                 choose another folder"
                .to_owned(),
        ),
        (Some(plan), _) | (None, Some(plan)) => Ok(KnownSweep { plan, status }),
        (None, None) => {
            Err(format!("the folder has no {PLAN_FILE}: open the plan of a sweep first"))
        }
    }
}

/// Times some rows of a plan.
///
/// # Errors
/// A message for the user, also if it was cancelled.
pub fn time(
    plan: &Plan,
    library: &Library,
    report: &mut ProgressCallback<'_>,
) -> Result<TimedRows, String> {
    let answerer = Answerer::new(plan, library).map_err(told)?;
    let n_rows = plan.n_rows().min(TIMED_ROWS);
    let mut go_on = |_: u64| report(Progress::new(0, 0, "timing rows"));
    let start = Instant::now();
    answer_rows(&answerer, 0..n_rows, &mut go_on).map_err(told)?;
    Ok(TimedRows { n_rows, seconds: start.elapsed().as_secs_f64() })
}

/// Computes the chunks of a plan that are missing in a folder, into which the plan is written first.
///
/// - returns what was done; `None` if it was cancelled.
///
/// # Errors
/// A message for the user.
pub fn run(
    plan: &Plan,
    folder: &Path,
    library: &Library,
    report: &mut ProgressCallback<'_>,
) -> Result<Option<RunReport>, String> {
    plan.write(folder).map_err(told)?;
    let all: Vec<u64> = (0..plan.n_chunks()).collect();
    match run_chunks(folder, &all, library, report) {
        Ok(run) => Ok(Some(run)),
        Err(SweepError::Cancelled) => Ok(None),
        Err(error) => Err(told(error)),
    }
}

/// Puts the chunks of a folder together in one file.
///
/// # Errors
/// A message for the user, also if it was cancelled.
pub fn merge(
    folder: &Path,
    path: &Path,
    existing: Existing,
    report: &mut ProgressCallback<'_>,
) -> Result<String, String> {
    let merged = impactlab_sweep::merge(folder, path, existing, report).map_err(told)?;
    let (path, rows, failed) = (path.display(), merged.rows, merged.failed);
    Ok(format!("{path} written, with {rows} rows, {failed} of them without an answer"))
}
