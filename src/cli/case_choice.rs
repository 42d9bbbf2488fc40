//! One series of a path: a case of a data set, or a single file.

use std::path::{Path, PathBuf};

use crate::cli::CliError;
use crate::cli::force_source::sampling_of;
use crate::cli::progress::{complete, with_progress};
use crate::data::{Case, ColumnMap, Dataset, DatasetKind, Sampling, TimeSeries, read_any_series};

/// What a path and `--case` choose.
pub(super) struct Chosen {
    /// What a title calls it.
    pub(super) name: String,
    /// Its series.
    pub(super) series: TimeSeries,
    /// What a force sample stands for.
    pub(super) sampling: Sampling,
    /// The case, if it is one of a data set.
    pub(super) case: Option<Case>,
    /// The data set's vehicle file.
    pub(super) vehicle_file: Option<PathBuf>,
}

/// Loads a data set under a progress bar.
pub(super) fn load_dataset(root: &Path) -> Result<Dataset, CliError> {
    complete(with_progress(|report| Dataset::load(root, report))?)
}

/// The case of this name, or the error that says what there is.
pub(super) fn find_case<'a>(dataset: &'a Dataset, name: &str) -> Result<&'a Case, CliError> {
    dataset.case(name).ok_or_else(|| CliError::NoSuchCase {
        path: dataset.root.clone(),
        case: name.to_owned(),
        n_cases: dataset.cases.len(),
        first: dataset
            .cases
            .first()
            .map_or(String::new(), |case| case.name.clone()),
    })
}

/// Takes a case out of a data set, or reads a single file.
pub(super) fn choose(
    path: &Path,
    case: Option<&str>,
    map: Option<&ColumnMap>,
) -> Result<Chosen, CliError> {
    let (path_owned, is_dataset) = (path.to_owned(), DatasetKind::of_folder(path).is_some());
    match (is_dataset, case, map) {
        (true, _, Some(_)) => Err(CliError::MapOfFolder { path: path_owned }),
        (true, None, _) => Err(CliError::CaseNeeded { path: path_owned }),
        (true, Some(name), None) => {
            let dataset = load_dataset(path)?;
            let case = find_case(&dataset, name)?.clone();
            Ok(Chosen {
                name: case.name.clone(),
                series: case.series.clone(),
                sampling: case.kind.sampling(),
                case: Some(case),
                vehicle_file: dataset.vehicle_file,
            })
        }
        (false, Some(name), _) if !path.is_dir() => Err(CliError::CaseOfFile {
            path: path_owned,
            case: name.to_owned(),
        }),
        (false, ..) => {
            let loaded = read_any_series(path, map)?;
            let stem = path.file_stem().unwrap_or(path.as_os_str());
            Ok(Chosen {
                name: stem.to_string_lossy().into_owned(),
                sampling: sampling_of(path, &loaded),
                series: loaded.series,
                case: None,
                vehicle_file: None,
            })
        }
    }
}
