//! Chunks of a sweep, for schedulers that call a function.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use pyo3::prelude::*;

use crate::question::detached;
use impactlab_core::data::Outcome;
use impactlab_study::Library;
use impactlab_sweep::{PLAN_FILE, Plan, SweepError, chunk_path, run_chunks};

/// Resolves a plan into a folder, as the command ``impactlab sweep plan`` does.
///
/// plan: the plan that a person writes, a TOML file.
/// out: the folder of the sweep; it is made if it is not there.
///
/// Returns the number of chunks.
#[pyfunction]
pub(crate) fn plan_sweep(py: Python<'_>, plan: PathBuf, out: PathBuf) -> PyResult<u64> {
    detached(py, move |_| {
        let plan = Plan::read(&plan, &Library::default())?;
        write_plan(&plan, &out)?;
        Ok::<_, SweepError>(Outcome::Complete(plan.n_chunks()))
    })
}

/// Runs a chunk of a sweep, as the command ``impactlab sweep run`` does: the same bytes. A chunk that is there
/// and whole is kept.
///
/// plan: the folder of the sweep, or ``plan.json`` in it.
/// i: number of the chunk, from 0.
/// out: the folder that the file goes into, in which the plan will stand too; without it, that of the plan.
///
/// Returns the path of the file.
#[pyfunction]
#[pyo3(signature = (plan, i, out=None))]
pub(crate) fn run_chunk(
    py: Python<'_>,
    plan: PathBuf,
    i: u64,
    out: Option<PathBuf>,
) -> PyResult<OsString> {
    let path = detached(py, move |go_on| {
        let library = Library::default();
        let folder = folder_of(&plan);
        let out = match &out {
            Some(out) => {
                write_plan(&Plan::open(folder, &library)?, out)?;
                out.as_path()
            }
            None => folder,
        };
        run_chunks(out, &[i], &library, &mut |_| go_on())?;
        Ok::<_, SweepError>(Outcome::Complete(chunk_path(out, i)))
    })?;
    Ok(path.into_os_string())
}

fn folder_of(plan: &Path) -> &Path {
    match plan.parent() {
        Some(folder) if plan.file_name() == Some(OsStr::new(PLAN_FILE)) => folder,
        _ => plan,
    }
}

/// Writes a plan. Another process that writes the same one at the same time is no error.
fn write_plan(plan: &Plan, folder: &Path) -> Result<(), SweepError> {
    plan.write(folder).or_else(|error| match Plan::stored(folder) {
        Ok(there) if there == *plan => Ok(()),
        _ => Err(error),
    })
}
