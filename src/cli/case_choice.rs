//! What a path and `--case` choose: a case of a data set, or a single file.

use std::path::{Path, PathBuf};

use crate::cli::CliError;
use crate::cli::progress::{complete, with_progress};
use crate::data::{Case, ColumnMap, Dataset, DatasetKind, Loaded, read_any_series};

/// What a path and `--case` choose.
pub(super) enum Chosen {
    /// A case of a data set.
    Case {
        /// The case.
        case: Box<Case>,
        /// The data set's vehicle file.
        vehicle_file: Option<PathBuf>,
    },
    /// A single file.
    File {
        /// What a title calls it.
        name: String,
        /// Its content.
        loaded: Box<Loaded>,
    },
}

/// Loads a data set under a progress bar.
pub(super) fn load_dataset(root: &Path) -> Result<Dataset, CliError> {
    complete(with_progress(|report| Dataset::load(root, report))?)
}

/// The case of this name, or the error that says what there is.
///
/// A case that could not be read gives the reason for it.
pub(super) fn take_case(dataset: &mut Dataset, name: &str) -> Result<Case, CliError> {
    if let Some(case) = dataset.case(name) {
        return Ok(case.clone());
    }
    let file = format!("{name}.csv");
    let is_about = |text: String| text.contains(&file) || text.contains(&format!("{name:?}"));
    let at = dataset.problems.iter().position(|problem| is_about(problem.to_string()));
    Err(match at {
        Some(at) => dataset.problems.swap_remove(at).into(),
        None => CliError::NoSuchCase {
            path: dataset.root.clone(),
            case: name.to_owned(),
            n_cases: dataset.cases.len(),
            first: dataset.cases.first().map_or(String::new(), |case| case.name.clone()),
        },
    })
}

/// Takes a case out of a data set, or reads a single file.
pub(super) fn choose(
    path: &Path,
    case: Option<&str>,
    map: Option<&ColumnMap>,
) -> Result<Chosen, CliError> {
    let path_owned = || path.to_owned();
    if !path.is_dir() {
        if let Some(case) = case {
            return Err(CliError::CaseOfFile { path: path_owned(), case: case.to_owned() });
        }
        let loaded = Box::new(read_any_series(path, map)?);
        let stem = path.file_stem().unwrap_or(path.as_os_str());
        let name = stem.to_string_lossy().into_owned();
        return Ok(Chosen::File { name, loaded });
    }
    if map.is_some() {
        return Err(CliError::MapOfFolder { path: path_owned() });
    }
    match case {
        None if DatasetKind::of_folder(path).is_some() => {
            Err(CliError::CaseNeeded { path: path_owned() })
        }
        None => Err(crate::data::DataError::NotRecognised { path: path_owned() }.into()),
        Some(name) => {
            let mut dataset = load_dataset(path)?;
            let case = Box::new(take_case(&mut dataset, name)?);
            let vehicle_file = dataset.vehicle_file;
            Ok(Chosen::Case { case, vehicle_file })
        }
    }
}
