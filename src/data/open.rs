//! Opens whatever a person points at.

use std::path::{Path, PathBuf};

use crate::data::dataset::CASES_FILE;
use crate::data::{DataError, Dataset, DatasetKind, Loaded, Outcome, read_any_series};
use crate::jobs::ProgressCallback;

/// What a path turned out to be.
#[derive(Debug)]
pub enum Opened {
    /// A folder with `cases.csv`, or this file itself.
    Dataset(Dataset),
    /// A folder of such folders.
    Collection {
        /// The data sets, in the order of their folders' names.
        datasets: Vec<Dataset>,
        /// Why others could not be read.
        problems: Vec<DataError>,
    },
    /// A force, trajectory or steer file.
    File(Loaded),
}

/// Opens a data set, a folder of data sets, or a force, trajectory or steer file.
///
/// # Errors
/// [`DataError::NotRecognised`] for a folder without data sets; else why the file or the table of
/// cases could not be read.
pub fn open(path: &Path, report: &mut ProgressCallback<'_>) -> Result<Outcome<Opened>, DataError> {
    if path.is_dir() {
        return open_folder(path, report);
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    let is_table = path.file_name().is_some_and(|name| name == CASES_FILE);
    if is_table && DatasetKind::of_folder(folder).is_some() {
        return open_folder(folder, report);
    }
    let loaded = read_any_series(path, None)?;
    Ok(Outcome::Complete(Opened::File(loaded)))
}

fn open_folder(
    root: &Path,
    report: &mut ProgressCallback<'_>,
) -> Result<Outcome<Opened>, DataError> {
    if DatasetKind::of_folder(root).is_some() {
        return Ok(Dataset::load(root, report)?.map(Opened::Dataset));
    }
    let roots = dataset_folders(root)?;
    if roots.is_empty() {
        let path = root.to_owned();
        return Err(DataError::NotRecognised { path });
    }
    let (mut datasets, mut problems) = (Vec::new(), Vec::new());
    for root in roots {
        match Dataset::load(&root, report) {
            Ok(Outcome::Complete(dataset)) => datasets.push(dataset),
            Ok(Outcome::Cancelled) => return Ok(Outcome::Cancelled),
            Err(problem) => problems.push(problem),
        }
    }
    Ok(Outcome::Complete(Opened::Collection { datasets, problems }))
}

/// The data sets' folders in a folder, by name.
fn dataset_folders(root: &Path) -> Result<Vec<PathBuf>, DataError> {
    let to_error = |source| DataError::io(root, source);
    let mut folders = Vec::new();
    for entry in std::fs::read_dir(root).map_err(to_error)? {
        let path = entry.map_err(to_error)?.path();
        if DatasetKind::of_folder(&path).is_some() {
            folders.push(path);
        }
    }
    folders.sort();
    Ok(folders)
}
