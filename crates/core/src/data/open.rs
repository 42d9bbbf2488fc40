//! Opens a path whose content is not known yet.

use std::path::{Path, PathBuf};

use crate::data::dataset::CASES_FILE;
use crate::data::{
    DataError, Dataset, DatasetKind, Loaded, MAX_DATASET_BYTES, Outcome, list_folder,
    read_any_series,
};
use crate::jobs::ProgressCallback;

/// The content of a path that was opened.
#[derive(Debug)]
pub enum Opened {
    /// A data set: a folder with `forces/` or `trajectories/`, or the file `cases.csv` in it.
    Dataset(Dataset),
    /// A folder that contains the folders of several data sets.
    Collection {
        /// The data sets that could be loaded, in the order of the names of their folders.
        datasets: Vec<Dataset>,
        /// The reasons why other data sets could not be loaded.
        problems: Vec<DataError>,
    },
    /// A force, trajectory or steer file.
    File(Loaded),
}

/// Opens a data set, a folder of data sets, or a force, trajectory or steer file.
///
/// - `report`: called with the progress of loading a data set; if it breaks, the result is
///   [`Outcome::Cancelled`].
///
/// # Errors
/// [`DataError::NotRecognised`] for a folder without data sets, and otherwise the reason why the
/// file or the table of cases could not be read.
pub fn open(path: &Path, report: &mut ProgressCallback<'_>) -> Result<Outcome<Opened>, DataError> {
    if path.is_dir() {
        return open_folder(path, report);
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    let is_table = path.file_name().is_some_and(|name| name == CASES_FILE);
    if is_table && DatasetKind::from_folder(folder).is_some() {
        return open_folder(folder, report);
    }
    let loaded = read_any_series(path, None)?;
    Ok(Outcome::Complete(Opened::File(loaded)))
}

fn open_folder(
    root: &Path,
    report: &mut ProgressCallback<'_>,
) -> Result<Outcome<Opened>, DataError> {
    if DatasetKind::from_folder(root).is_some() {
        return Ok(Dataset::load(root, report)?.map(Opened::Dataset));
    }
    let roots = dataset_folders(root)?;
    if roots.is_empty() {
        let path = root.to_owned();
        return Err(DataError::NotRecognised { path });
    }
    let (mut datasets, mut problems) = (Vec::new(), Vec::new());
    let mut budget = MAX_DATASET_BYTES;
    for root in roots {
        match Dataset::load_within(&root, &mut budget, report) {
            Ok(Outcome::Complete(dataset)) => datasets.push(dataset),
            Ok(Outcome::Cancelled) => return Ok(Outcome::Cancelled),
            Err(problem) => problems.push(problem),
        }
    }
    Ok(Outcome::Complete(Opened::Collection { datasets, problems }))
}

/// The folders of data sets directly in a folder, in the order of their names.
///
/// # Errors
/// [`DataError`] if the folder cannot be listed.
fn dataset_folders(root: &Path) -> Result<Vec<PathBuf>, DataError> {
    let is_dataset = |path: &PathBuf| DatasetKind::from_folder(path).is_some();
    let mut folders: Vec<PathBuf> = list_folder(root)?.into_iter().filter(is_dataset).collect();
    folders.sort();
    Ok(folders)
}
