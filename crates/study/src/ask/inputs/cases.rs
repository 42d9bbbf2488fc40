//! The cases that a training, an evaluation or a comparison is made with.

use crate::caveats::assumed;
use std::error::Error;
use std::path::{Path, PathBuf};

use impactlab_core::uncertainty::{CaveatSubject, Caveats};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::ask::inputs::{OpenVehicle, struck_vehicle};
use crate::{Library, Observer, StudyError, VehicleChoice};
use impactlab_core::data::{Case, Dataset, DatasetKind, Outcome, list_folder};
use impactlab_core::error_chain;
use impactlab_networks::force::ForceCase;
use impactlab_networks::learning::{cases_and_problems, check_kind, load_cases};
use impactlab_networks::response::ResponseCase;

/// What happens to cases of a data set that cannot be used.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BadCases {
    /// The first one is an error, so that two runs on one data set have the same cases.
    #[default]
    Refuse,
    /// They are left out and listed in the report.
    LeaveOut,
}

/// Which cases of a data set a model is evaluated on.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum EvaluatedCases {
    /// Those that the model was not trained on, recognised by their content.
    #[default]
    Test,
    /// All, also those that it was trained on.
    All,
}

/// What a data set or a file of one is called.
pub(crate) fn data_name(root: &Path) -> String {
    root.file_name().unwrap_or(root.as_os_str()).to_string_lossy().into_owned()
}

/// What several data sets are called together.
pub(crate) fn data_names<'a>(roots: impl IntoIterator<Item = &'a PathBuf>) -> String {
    let names: Vec<String> = roots.into_iter().map(|root| data_name(root)).collect();
    names.join(" + ")
}

/// Cases as a network learns from them, and why others are left out.
pub(crate) struct UsableCases<T> {
    pub(crate) cases: Vec<T>,
    pub(crate) left_out: Vec<String>,
}

/// The cases of a force data set.
pub(crate) fn force_cases(
    root: &Path,
    bad_cases: BadCases,
    library: &Library,
    observer: &mut Observer<'_>,
) -> Result<Outcome<UsableCases<ForceCase>>, StudyError> {
    let Outcome::Complete(dataset) = library.dataset(root, observer)? else {
        return Ok(Outcome::Cancelled);
    };
    check_kind(&dataset, DatasetKind::Force)?;
    usable(&dataset, bad_cases, ForceCase::from_case).map(Outcome::Complete)
}

/// The trajectories of a data set; a vehicle that nobody named is added to the caveats.
pub(crate) fn response_cases(
    root: &Path,
    choice: &VehicleChoice,
    bad_cases: BadCases,
    caveats: &mut Caveats,
    library: &Library,
    observer: &mut Observer<'_>,
) -> Result<Outcome<UsableCases<ResponseCase>>, StudyError> {
    let Outcome::Complete(dataset) = library.dataset(root, observer)? else {
        return Ok(Outcome::Cancelled);
    };
    check_kind(&dataset, DatasetKind::Trajectory)?;
    let own = OpenVehicle::OfDataset(dataset.vehicle_file.as_deref());
    let vehicle = struck_vehicle(choice, &own, caveats)?;
    caveats.extend(assumed::medians(CaveatSubject::VehicleParameter, &vehicle));
    let from_case = |case: &Case| ResponseCase::from_case(case, &vehicle);
    usable(&dataset, bad_cases, from_case).map(Outcome::Complete)
}

/// The data sets of paths: each folder that is one, and those in a folder of them, by name.
///
/// # Errors
/// [`StudyError::Data`] if a folder cannot be read.
pub(crate) fn dataset_folders(paths: &[PathBuf]) -> Result<Vec<PathBuf>, StudyError> {
    let mut folders = Vec::new();
    for path in paths {
        let inside = match DatasetKind::from_folder(path) {
            None if path.is_dir() => list_folder(path)?,
            _ => Vec::new(),
        };
        let mut sets: Vec<PathBuf> =
            inside.into_iter().filter(|path| DatasetKind::from_folder(path).is_some()).collect();
        sets.sort();
        // What is no data set is said where it is read.
        if sets.is_empty() {
            sets.push(path.clone());
        }
        folders.extend(sets);
    }
    Ok(folders)
}

fn usable<T, E: Error + Send + Sync + 'static>(
    dataset: &Dataset,
    bad_cases: BadCases,
    from_case: impl FnMut(&Case) -> Result<T, E>,
) -> Result<UsableCases<T>, StudyError> {
    let unread: Vec<String> = dataset.problems.iter().map(|problem| error_chain(problem)).collect();
    match (bad_cases, unread.first()) {
        (BadCases::Refuse, Some(problem)) => {
            let (path, problem) = (dataset.root.clone(), problem.clone());
            Err(StudyError::BadCase { path, problem })
        }
        (BadCases::Refuse, None) => {
            Ok(UsableCases { cases: load_cases(dataset, from_case)?, left_out: Vec::new() })
        }
        (BadCases::LeaveOut, _) => {
            let (cases, problems) = cases_and_problems(dataset, from_case);
            let unusable = problems.iter().map(|problem| error_chain(problem));
            Ok(UsableCases { cases, left_out: unread.into_iter().chain(unusable).collect() })
        }
    }
}
