//! Runs chunks of a sweep.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use crate::chunk::{chunk_path, read_chunk, read_rows, rows_bytes};
use crate::row::{Answerer, Row};
use crate::rows::Rows;
use crate::{Plan, SweepError};
use impactlab_core::data::{Existing, check_target, write_bytes};
use impactlab_core::jobs::{Progress, ProgressCallback};
use impactlab_study::Library;

/// Rows that are answered side by side between two reports of progress.
const BLOCK_ROWS: u64 = 64;

/// What a run has done.
#[derive(Debug, Clone, Default, PartialEq, Eq, serde::Serialize)]
pub struct RunReport {
    /// Chunks that were computed.
    pub computed: Vec<u64>,
    /// Chunks that were there already.
    pub kept: Vec<u64>,
    /// Chunks that were broken, and were computed anew, each with what was wrong.
    pub replaced: Vec<(u64, String)>,
    /// Rows that were computed.
    pub rows: u64,
    /// Those of them that failed.
    pub failed: u64,
}

/// Answers rows of a plan side by side. The bits depend on (plan, seed, row) alone.
///
/// - `rows`: their numbers;
/// - `report`: is told of rows that are done, after every few of them.
///
/// # Errors
/// [`SweepError::Study`] if a network cannot be read; [`SweepError::Cancelled`].
pub fn answer_rows(
    answerer: &Answerer<'_>,
    rows: std::ops::Range<u64>,
    report: &mut dyn FnMut(u64) -> ControlFlow<()>,
) -> Result<Vec<Row>, SweepError> {
    let mut all = Vec::new();
    let mut start = rows.start;
    while start < rows.end {
        let end = start.saturating_add(BLOCK_ROWS).min(rows.end);
        let numbers: Vec<u64> = (start..end).collect();
        let block: Vec<Row> = numbers.into_par_iter().map(|row| answerer.row(row)).collect();
        all.extend(block);
        if report(end - start).is_break() {
            return Err(SweepError::Cancelled);
        }
        start = end;
    }
    Ok(all)
}

/// Runs chunks of the plan in a folder. One that is there and whole is kept, one that is broken is computed
/// anew.
///
/// # Errors
/// [`SweepError`]: above all [`SweepError::OtherProgram`], [`SweepError::OtherPlan`] for whole rows of another
/// plan, and [`SweepError::Cancelled`], which keeps what is finished.
pub fn run_chunks(
    folder: &Path,
    chunks: &[u64],
    library: &Library,
    progress: &mut ProgressCallback<'_>,
) -> Result<RunReport, SweepError> {
    let plan = Plan::open(folder, library)?;
    let n_chunks = plan.n_chunks();
    if let Some(&chunk) = chunks.iter().find(|chunk| **chunk >= n_chunks) {
        return Err(SweepError::NoChunk { chunk, n_chunks });
    }
    // What is in memory may be of another content than the plan knows.
    let anew = Library::default();
    let answerer = Answerer::new(&plan, if plan.files.is_empty() { library } else { &anew })?;
    let n_rows = |chunk: u64| {
        let rows = plan.rows_of(chunk);
        rows.end - rows.start
    };
    let total: u64 = chunks.iter().map(|&chunk| n_rows(chunk)).sum();
    let (mut done, mut kept_rows, mut run) = (0, 0, RunReport::default());
    for &chunk in chunks {
        let path = chunk_path(folder, chunk);
        if path.exists() {
            match read_chunk(folder, &plan, chunk) {
                Ok(_) => {
                    run.kept.push(chunk);
                    done += n_rows(chunk);
                    kept_rows += n_rows(chunk);
                    continue;
                }
                Err(SweepError::Rows { .. }) if is_of_other_plan(&path, &plan) => {
                    return Err(SweepError::OtherPlan { path });
                }
                Err(SweepError::Rows { what, .. }) => run.replaced.push((chunk, what)),
                Err(error) => return Err(error),
            }
        }
        // Before the work whose rows would be lost.
        check_target(&path, Existing::Replace)?;
        let mut report = |n: u64| {
            done += n;
            let message = format!("chunk {chunk} of {n_chunks}");
            progress(Progress::new(done, total, message).going_on_from(kept_rows))
        };
        let rows = answer_rows(&answerer, plan.rows_of(chunk), &mut report)?;
        // A file that was changed in the meantime would have answered some of the rows.
        plan.check_files(folder)?;
        let table = Rows::new(&plan, chunk, &rows);
        let bytes = rows_bytes(&table)?;
        write_bytes(&path, Existing::Replace, &bytes)?;
        run.rows += table.len() as u64;
        run.failed += table.n_failed() as u64;
        run.computed.push(chunk);
    }
    Ok(run)
}

/// Whether a file holds whole rows of another plan.
fn is_of_other_plan(path: &Path, plan: &Plan) -> bool {
    read_rows(path).is_ok_and(|rows| rows.meta.plan_sha256 != plan.sha256())
}

/// Runs one chunk, and gives the path of its file: for schedulers that call a function.
///
/// # Errors
/// As for [`run_chunks`].
pub fn run_chunk(folder: &Path, chunk: u64, library: &Library) -> Result<PathBuf, SweepError> {
    run_chunks(folder, &[chunk], library, &mut |_| ControlFlow::Continue(()))?;
    Ok(chunk_path(folder, chunk))
}

/// The chunks of one task of a job array.
///
/// With a stride n, task t has the chunks t, t + n, t + 2n and so on, whichever other tasks there are.
/// Without it, the tasks of an array without gaps share all chunks, and each task of an array with gaps,
/// such as one of missing chunks, has the chunk of its number. Without a stride all variables are needed: a task
/// that knew its own number alone would have every chunk, as each of the others.
///
/// - `variable`: gives the variables that Slurm sets.
///
/// # Errors
/// [`SweepError::Array`] for a variable that is missing or no number.
pub fn chunks_of_task(
    n_chunks: u64,
    stride: Option<u64>,
    variable: impl Fn(&str) -> Option<String>,
) -> Result<Vec<u64>, SweepError> {
    let number = |name: &'static str, usual: Option<u64>| {
        let value = variable(name);
        let parsed = value.as_deref().map_or(usual, |text| text.trim().parse().ok());
        parsed.ok_or_else(|| SweepError::Array { name, value: value.unwrap_or_default() })
    };
    let every = |first: u64, stride: u64| -> Vec<u64> {
        (first..n_chunks).step_by(usize::try_from(stride.max(1)).unwrap_or(usize::MAX)).collect()
    };
    let task = number("SLURM_ARRAY_TASK_ID", None)?;
    if let Some(stride) = stride {
        return Ok(every(task, stride));
    }
    let first = number("SLURM_ARRAY_TASK_MIN", None)?;
    let last = number("SLURM_ARRAY_TASK_MAX", None)?;
    let count = number("SLURM_ARRAY_TASK_COUNT", None)?.max(1);
    let step = number("SLURM_ARRAY_TASK_STEP", Some(1))?.max(1);
    let has_gaps = last.saturating_sub(first) / step + 1 != count;
    match has_gaps {
        true if task < n_chunks => Ok(vec![task]),
        true => Err(SweepError::NoChunk { chunk: task, n_chunks }),
        false => Ok(every(task.saturating_sub(first) / step, count)),
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::Distribution;
    use impactlab_study::SeriesFile;

    /// The plan was that of the file as it is, and the rows those of the file as it was opened in the window.
    #[test]
    fn a_file_that_has_changed_since_it_was_read_is_read_again() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let ask = serde_json::json!({
            "question": "simulate",
            "source": { "drive": {
                "speed_m_s": 20.0,
                "yaw_rate_rad_s": 0.0,
                "force": { "path": at("force.csv") },
            } },
            "vehicle": { "Preset": "reference-2000" },
            "duration_s": 1.0,
        });
        fs::write(at("ask.json"), ask.to_string()).unwrap();
        let plan = "question = \"request\"\nn = 1\n[request]\nfile = \"ask.json\"\n\
                    outcomes = [{ name = \"y_m\", at = \"/end/y_m\", unit = \"m\" }]\n\
                    [vary.friction]\nat = \"/friction\"\nlist = [0.8]\n";
        fs::write(at("plan.toml"), plan).unwrap();
        let y_m = |sweep: &str, peak_n: u32, library: &Library| {
            let force = format!("time_s,fx_n,fy_n\n0,0,0\n0.05,0,{peak_n}\n0.1,0,0\n");
            fs::write(at("force.csv"), force).unwrap();
            let plan = Plan::read(&at("plan.toml"), library).unwrap();
            plan.write(&at(sweep)).unwrap();
            let rows = read_rows(&run_chunk(&at(sweep), 0, library).unwrap()).unwrap();
            assert_eq!(rows.reasons, [""]);
            rows.outcomes[0].values[0]
        };
        let library = Library::default();
        let weak_m = y_m("weak", 20_000, &library);
        library.series(&SeriesFile::new(at("force.csv"))).unwrap();
        let strong_m = y_m("strong", 40_000, &library);
        assert_eq!(strong_m, y_m("again", 40_000, &Library::default()));
        assert!(strong_m.abs() > 1.5 * weak_m.abs(), "{strong_m} {weak_m}");
    }

    /// Such a row had the answer of the usual friction, and infinity in the column of the input.
    #[test]
    fn a_row_with_an_input_that_is_not_finite_has_no_answer() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let ask = serde_json::json!({
            "question": "simulate",
            "source": { "drive": { "speed_m_s": 20.0, "yaw_rate_rad_s": 0.0 } },
            "vehicle": { "Preset": "reference-2000" },
            "duration_s": 1.0,
        });
        fs::write(at("ask.json"), ask.to_string()).unwrap();
        let plan = "question = \"request\"\nn = 16\n[request]\nfile = \"ask.json\"\n\
                    outcomes = [{ name = \"y_m\", at = \"/end/y_m\", unit = \"m\" }]\n\
                    [vary.friction]\nat = \"/friction\"\nlognormal = [0.7, 0.1]\n";
        fs::write(at("plan.toml"), plan).unwrap();
        let library = Library::default();
        let mut plan = Plan::read(&at("plan.toml"), &library).unwrap();
        // No plan that is read has such a distribution.
        let (low, high) = (None, None);
        plan.vary[0].distribution =
            Distribution::Lognormal { median: 0.7, log_sigma: 900.0, low, high };
        let answerer = Answerer::new(&plan, &library).unwrap();
        let rows: Vec<Row> = (0..16).map(|row| answerer.row(row)).collect();
        assert!(rows.iter().any(|row| row.inputs[0] == f64::INFINITY), "{rows:?}");
        for row in &rows {
            let is_refused =
                row.outcomes == Err("friction is inf, expected a finite number".to_owned());
            assert_eq!(is_refused, row.inputs[0].is_infinite(), "{row:?}");
        }
    }

    /// Its rows were lost once they were computed.
    #[cfg(unix)]
    #[test]
    fn a_chunk_that_cannot_be_written_is_not_computed() {
        let folder = tempfile::tempdir().unwrap();
        let sweep = folder.path().join("sweep");
        let plan = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/atlas/pit.toml");
        let library = Library::default();
        let plan = Plan { n: 1, chunk: 1, ..Plan::read(&plan, &library).unwrap() };
        plan.write(&sweep).unwrap();
        let missing = folder.path().join("missing/part.parquet");
        std::os::unix::fs::symlink(missing, chunk_path(&sweep, 0)).unwrap();
        let mut n_told = 0;
        let refused = run_chunks(&sweep, &[0], &library, &mut |_| {
            n_told += 1;
            ControlFlow::Continue(())
        });
        assert!(matches!(&refused, Err(SweepError::Data(_))), "{refused:?}");
        assert_eq!(n_told, 0);
    }

    fn chunks(stride: Option<u64>, variables: &[(&str, &str)]) -> Result<Vec<u64>, SweepError> {
        chunks_of_task(8, stride, |name| {
            let found = variables.iter().find(|(variable, _)| *variable == name);
            found.map(|(_, value)| (*value).to_owned())
        })
    }

    fn array<'a>(task: &'a str, range: [&'a str; 2], count: &'a str) -> [(&'a str, &'a str); 4] {
        [
            ("SLURM_ARRAY_TASK_ID", task),
            ("SLURM_ARRAY_TASK_MIN", range[0]),
            ("SLURM_ARRAY_TASK_MAX", range[1]),
            ("SLURM_ARRAY_TASK_COUNT", count),
        ]
    }

    #[test]
    fn the_tasks_of_an_array_share_all_chunks() {
        let of = |task: &str| chunks(None, &array(task, ["1", "3"], "3")).unwrap();
        assert_eq!([of("1"), of("2"), of("3")], [vec![0, 3, 6], vec![1, 4, 7], vec![2, 5]]);
    }

    #[test]
    fn a_task_that_is_run_again_has_the_same_chunks() {
        assert_eq!(chunks(Some(3), &array("2", ["2", "2"], "1")).unwrap(), [2, 5]);
        // The missing ones, as an array of their numbers.
        assert_eq!(chunks(None, &array("7", ["2", "7"], "2")).unwrap(), [7]);
        assert!(chunks(None, &array("9", ["2", "9"], "2")).is_err());
    }

    #[test]
    fn without_a_job_array_there_is_no_task() {
        assert!(chunks(None, &[]).is_err());
        assert!(chunks(Some(2), &[("SLURM_ARRAY_TASK_ID", "x")]).is_err());
    }

    /// Each task of an array of which it knew its number alone computed all chunks; one that knew their count,
    /// too, left most of them out.
    #[test]
    fn a_task_that_does_not_know_its_array_has_no_chunks() {
        let all = array("2", ["0", "3"], "4");
        assert_eq!(chunks(None, &all).unwrap(), [2, 6]);
        for missing in 1..all.len() {
            let mut some = all.to_vec();
            let (name, _) = some.remove(missing);
            let refused = chunks(None, &some);
            assert!(
                matches!(&refused, Err(SweepError::Array { name: it, .. }) if *it == name),
                "{refused:?}"
            );
        }
        assert_eq!(chunks(Some(4), &[("SLURM_ARRAY_TASK_ID", "2")]).unwrap(), [2, 6]);
    }
}
