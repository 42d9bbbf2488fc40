//! What of a sweep is done.

use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;

use crate::chunk::{chunk_path, read_chunk};
use crate::{Plan, SweepError};
use impactlab_core::error_chain;

/// What of a sweep is done.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct SweepStatus {
    /// What it is called.
    pub name: String,
    /// SHA-256 of its plan.
    pub plan_sha256: String,
    /// Rows in all.
    pub rows: u64,
    /// Chunks in all.
    pub chunks: u64,
    /// Chunks that are whole.
    pub chunks_done: u64,
    /// Rows in them.
    pub rows_done: u64,
    /// Rows in them that failed.
    pub rows_failed: u64,
    /// Chunks that are missing or broken, as an array expression: `7,19-23`.
    pub missing: String,
    /// Chunks that are there and no whole chunk of the plan, each with what is wrong.
    pub broken: Vec<(u64, String)>,
    /// The commonest reasons of rows that failed, with how many rows have it.
    pub reasons: Vec<(String, u64)>,
}

/// Most reasons that are told.
const MOST_REASONS: usize = 10;

/// Most different reasons that are counted.
const MOST_COUNTED: usize = 1000;

impl SweepStatus {
    /// Reads every chunk in the folder of a sweep.
    ///
    /// # Errors
    /// [`SweepError`] if there is no plan.
    pub fn read(folder: &Path) -> Result<(Plan, Self), SweepError> {
        let plan = Plan::stored(folder)?;
        let mut status = Self {
            name: plan.name.clone(),
            plan_sha256: plan.sha256(),
            rows: plan.n_rows(),
            chunks: plan.n_chunks(),
            chunks_done: 0,
            rows_done: 0,
            rows_failed: 0,
            missing: String::new(),
            broken: Vec::new(),
            reasons: Vec::new(),
        };
        let mut missing = Vec::new();
        let mut reasons = BTreeMap::new();
        for chunk in 0..plan.n_chunks() {
            let path = chunk_path(folder, chunk);
            if !path.exists() {
                missing.push(chunk);
                continue;
            }
            match read_chunk(folder, &plan, chunk) {
                Ok(rows) => {
                    status.chunks_done += 1;
                    status.rows_done += rows.len() as u64;
                    status.rows_failed += rows.n_failed() as u64;
                    for reason in rows.reasons.into_iter().filter(|reason| !reason.is_empty()) {
                        if reasons.len() < MOST_COUNTED || reasons.contains_key(&reason) {
                            *reasons.entry(reason).or_insert(0) += 1;
                        }
                    }
                }
                Err(error) => {
                    missing.push(chunk);
                    status.broken.push((chunk, fault_of(&path, &error)));
                }
            }
        }
        status.missing = array_expression(&missing);
        let mut reasons: Vec<(String, u64)> = reasons.into_iter().collect();
        reasons.sort_by_key(|(_, n)| Reverse(*n));
        reasons.truncate(MOST_REASONS);
        status.reasons = reasons;
        Ok((plan, status))
    }

    /// The missing chunks.
    pub fn missing_chunks(&self) -> Vec<u64> {
        parse_array(&self.missing).unwrap_or_default()
    }

    /// The tasks that have missing chunks, where task t has every n-th chunk from t on.
    ///
    /// - `stride`: n.
    pub fn missing_tasks(&self, stride: u64) -> String {
        let tasks = self.missing_chunks().into_iter().map(|chunk| chunk % stride.max(1));
        let mut tasks: Vec<u64> = tasks.collect();
        tasks.sort_unstable();
        tasks.dedup();
        array_expression(&tasks)
    }
}

/// What is wrong with a chunk, without its path, which stands before it.
fn fault_of(path: &Path, error: &SweepError) -> String {
    match error {
        SweepError::Rows { what, .. } => what.clone(),
        error => {
            let text = error_chain(error);
            let path = format!("{}: ", path.display());
            text.strip_prefix(&path).unwrap_or(&text).to_owned()
        }
    }
}

/// Rising numbers as an array expression: `7,19-23`.
pub fn array_expression(numbers: &[u64]) -> String {
    let runs = numbers.chunk_by(|a, b| a + 1 == *b);
    let text = |run: &[u64]| match run {
        [] => String::new(),
        [one] => one.to_string(),
        [first, .., last] => format!("{first}-{last}"),
    };
    runs.map(text).collect::<Vec<_>>().join(",")
}

/// The numbers of an array expression; `None` if it is none.
pub fn parse_array(text: &str) -> Option<Vec<u64>> {
    let mut numbers = Vec::new();
    for part in text.split(',').filter(|part| !part.is_empty()) {
        let (first, last) = part.split_once('-').unwrap_or((part, part));
        let [first, last] = [first.parse::<u64>().ok()?, last.parse::<u64>().ok()?];
        if first > last || last - first > crate::plan::MOST_CHUNKS {
            return None;
        }
        numbers.extend(first..=last);
    }
    Some(numbers)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_an_array_expression_and_back() {
        for (numbers, text) in [
            (vec![], ""),
            (vec![7], "7"),
            (vec![7, 19, 20, 21, 22, 23], "7,19-23"),
            (vec![0, 1, 3, 5, 6], "0-1,3,5-6"),
        ] {
            assert_eq!(array_expression(&numbers), text);
            assert_eq!(parse_array(text), Some(numbers));
        }
        for bad in ["a", "5-3", "1-", "-1", "0-99999999999"] {
            assert_eq!(parse_array(bad), None, "{bad}");
        }
    }
}
