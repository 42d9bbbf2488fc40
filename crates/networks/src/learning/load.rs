//! The cases of a data set, all of them or those that can be read.

use std::error::Error;
use std::path::{Path, PathBuf};

use impactlab_core::data::{Case, DataError, Dataset, DatasetKind, Outcome, TomlError};
use impactlab_core::jobs::ProgressCallback;

/// A folder whose cases a network cannot learn from or be tested on.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// The data set cannot be read, or one of its cases.
    #[error(transparent)]
    Data(#[from] DataError),
    /// The cases are not force histories.
    #[error("{}: holds motions, expected a force data set (forces/)", path.display())]
    NoForces {
        /// The folder.
        path: PathBuf,
    },
    /// The cases are not motions.
    #[error("{}: holds force histories, expected a trajectory data set (trajectories/)", path.display())]
    NoTrajectories {
        /// The folder.
        path: PathBuf,
    },
    /// Nothing says which vehicle was struck.
    #[error("{}: has no vehicle.toml; say which vehicle it is", path.display())]
    NoVehicle {
        /// The folder.
        path: PathBuf,
    },
    /// The file of the struck vehicle cannot be read.
    #[error(transparent)]
    Vehicle(#[from] TomlError),
    /// A case lacks something.
    #[error("{}", path.display())]
    Case {
        /// The folder.
        path: PathBuf,
        /// What the case lacks.
        source: Box<dyn Error + Send + Sync>,
    },
}

/// Reads a data set of one kind. A case that cannot be read is an error, not a gap, so that two runs
/// on one folder have the same cases.
///
/// # Errors
/// [`LoadError`] with the first thing that is wrong.
pub fn load_dataset(
    root: &Path,
    kind: DatasetKind,
    report: &mut ProgressCallback<'_>,
) -> Result<Outcome<Dataset>, LoadError> {
    let Outcome::Complete(mut dataset) = Dataset::load(root, report)? else {
        return Ok(Outcome::Cancelled);
    };
    check_kind(&dataset, kind)?;
    if !dataset.problems.is_empty() {
        return Err(dataset.problems.swap_remove(0).into());
    }
    Ok(Outcome::Complete(dataset))
}

/// Checks what the cases of a data set are.
///
/// # Errors
/// [`LoadError::NoForces`], [`LoadError::NoTrajectories`].
pub fn check_kind(dataset: &Dataset, kind: DatasetKind) -> Result<(), LoadError> {
    let path = || dataset.root.clone();
    match kind {
        of_dataset if of_dataset == dataset.kind => Ok(()),
        DatasetKind::Force => Err(LoadError::NoForces { path: path() }),
        DatasetKind::Trajectory => Err(LoadError::NoTrajectories { path: path() }),
    }
}

/// All cases of a data set, in its order.
///
/// - `from_case`: what a network learns from, out of a case of the data set.
///
/// # Errors
/// [`LoadError::Case`] with the first case that lacks something.
pub fn load_cases<C, E: Error + Send + Sync + 'static>(
    dataset: &Dataset,
    from_case: impl FnMut(&Case) -> Result<C, E>,
) -> Result<Vec<C>, LoadError> {
    let in_folder =
        |source: E| LoadError::Case { path: dataset.root.clone(), source: Box::new(source) };
    dataset.cases.iter().map(from_case).map(|case| case.map_err(in_folder)).collect()
}

/// The cases of a data set that can be learned from, and what is wrong with the others.
pub fn cases_and_problems<C, E>(
    dataset: &Dataset,
    from_case: impl FnMut(&Case) -> Result<C, E>,
) -> (Vec<C>, Vec<E>) {
    let (mut cases, mut problems) = (Vec::new(), Vec::new());
    for case in dataset.cases.iter().map(from_case) {
        match case {
            Ok(case) => cases.push(case),
            Err(problem) => problems.push(problem),
        }
    }
    (cases, problems)
}
