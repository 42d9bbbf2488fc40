//! The files that are read where a path is named for its data: whatever answers a question, lists what an answer
//! rests on, or hands it on in a package, means the same files by it.

use std::path::{Path, PathBuf};

use crate::InputKind;
use impactlab_core::compare::PairRecords;
use impactlab_core::data::{
    CASES_FILE, DataError, Dataset, DatasetKind, list_folder, parts_beside,
};
use impactlab_reconstruct::evaluate::StagedCollisions;

/// The files that are read where a question names this path: of a folder, or the table of cases in it, those of
/// its data sets, or else the logs in it; of a file, itself with the other parts of what it is the first of.
/// Others in a folder are left alone.
pub(crate) fn files_of_data(path: &Path) -> Vec<PathBuf> {
    if let Some(folder) = folder_of_data(path) {
        return match files_of_sets(folder) {
            files if files.is_empty() => logs_in(folder).unwrap_or_default(),
            files => files,
        };
    }
    let parts = parts_beside(path);
    if parts.is_empty() { vec![path.to_owned()] } else { parts }
}

/// The folder whose files are read where a path is named: itself, or that of a table of cases.
pub(crate) fn folder_of_data(path: &Path) -> Option<&Path> {
    if path.is_dir() {
        return Some(path);
    }
    let is_table = path.file_name().is_some_and(|name| name == CASES_FILE);
    let is_of_set = || matches!(InputKind::from_path(path), InputKind::Dataset | InputKind::Pairs);
    path.parent().filter(|_| is_table && is_of_set())
}

/// The files of the data sets of a folder: of the one that it is, or of those directly in it.
pub(crate) fn files_of_sets(folder: &Path) -> Vec<PathBuf> {
    if StagedCollisions::is_at(folder) {
        return StagedCollisions::files(folder);
    }
    let files = |root: &Path| match DatasetKind::from_folder(root) {
        Some(_) => Dataset::files(root),
        None => PairRecords::files(root),
    };
    if DatasetKind::from_folder(folder).is_some() || PairRecords::is_at(folder) {
        return files(folder);
    }
    let mut inside = list_folder(folder).unwrap_or_default();
    inside.sort();
    inside.iter().flat_map(|root| files(root)).collect()
}

/// The logs directly in a folder, in the order of their names; names that begin with a point are left out.
///
/// # Errors
/// [`DataError`] if the folder cannot be listed.
pub(crate) fn logs_in(folder: &Path) -> Result<Vec<PathBuf>, DataError> {
    let is_log = |path: &PathBuf| {
        let is_csv = path.extension().is_some_and(|end| end.eq_ignore_ascii_case("csv"));
        let name = path.file_name().unwrap_or_default();
        is_csv && !name.as_encoded_bytes().starts_with(b".")
    };
    let mut logs = list_folder(folder)?;
    logs.retain(is_log);
    logs.sort();
    Ok(logs)
}
