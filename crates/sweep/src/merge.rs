//! All chunks of a sweep as one table, whose bytes depend on the plan alone.

use std::io;
use std::path::Path;

use crate::chunk::{RowsWriter, chunk_path, read_chunk};
use crate::status::array_expression;
use crate::{PLAN_FILE, Plan, SweepError};
use impactlab_core::data::write::{check_ending, check_inputs};
use impactlab_core::data::{Existing, write_atomically};
use impactlab_core::jobs::{Progress, ProgressCallback};

/// What was merged.
#[derive(Debug, Clone, Default, PartialEq, Eq, serde::Serialize)]
pub struct MergeReport {
    /// Chunks.
    pub chunks: u64,
    /// Rows.
    pub rows: u64,
    /// Those of them that failed.
    pub failed: u64,
}

/// Writes all chunks of a sweep into one file, a row group each. Every chunk is checked: the digest of its
/// plan, program and networks, its number, and that its rows are those of the plan, each once.
///
/// # Errors
/// [`SweepError::Missing`] if chunks are missing, [`SweepError::Rows`] with the first that is broken,
/// [`SweepError::Data`] if the file is one of those that it is made of, or its name does not end in
/// `.parquet`.
pub fn merge(
    folder: &Path,
    out: &Path,
    existing: Existing,
    progress: &mut ProgressCallback<'_>,
) -> Result<MergeReport, SweepError> {
    check_ending(out, "parquet")?;
    let plan = Plan::stored(folder)?;
    let n_chunks = plan.n_chunks();
    let is_missing = |chunk: &u64| !chunk_path(folder, *chunk).exists();
    let missing: Vec<u64> = (0..n_chunks).filter(is_missing).collect();
    if let Some(first) = missing.first() {
        let (missing, first) = (array_expression(&missing), first.to_string());
        return Err(SweepError::Missing { folder: folder.to_owned(), missing, first });
    }
    let parts = (0..n_chunks).map(|chunk| chunk_path(folder, chunk));
    check_inputs(out, &parts.chain([folder.join(PLAN_FILE)]).collect::<Vec<_>>())?;
    let mut like = read_chunk(folder, &plan, 0)?;
    like.meta.chunk = None;
    let mut writer = RowsWriter::new(&like)?;
    let (mut report, mut failure) = (MergeReport::default(), None);
    let written = write_atomically(out, existing, |file| {
        let mut aside = |error: SweepError| {
            failure = Some(error);
            io::Error::other("the chunks cannot be merged")
        };
        for chunk in 0..n_chunks {
            let rows = read_chunk(folder, &plan, chunk).map_err(&mut aside)?;
            if rows.caveats.is_some() != like.caveats.is_some() {
                let what = format!("it has other columns than {}", chunk_path(folder, 0).display());
                return Err(aside(SweepError::Rows { path: chunk_path(folder, chunk), what }));
            }
            let bytes = writer.add(&rows).map_err(|error| aside(error.into()))?;
            file.write_all(&bytes)?;
            report.chunks += 1;
            report.rows += rows.len() as u64;
            report.failed += rows.n_failed() as u64;
            if progress(Progress::new(chunk + 1, n_chunks, "merging chunks")).is_break() {
                return Err(aside(SweepError::Cancelled));
            }
        }
        let bytes = writer.finish().map_err(|error| aside(error.into()))?;
        file.write_all(&bytes)
    });
    match (written, failure) {
        (_, Some(error)) => Err(error),
        (Err(error), None) => Err(error.into()),
        (Ok(()), None) => Ok(report),
    }
}
