//! The trajectories of a data set on disk.

use std::path::{Path, PathBuf};

use crate::data::{DataError, Dataset, DatasetKind, Outcome, TomlError};
use crate::jobs::Report;
use crate::response::{ResponseCase, ResponseCaseError};
use crate::vehicle::VehicleParameters;

/// A folder that gives no trajectories.
#[derive(Debug, thiserror::Error)]
pub enum ResponseLoadError {
    /// The data set cannot be read, or one of its cases.
    #[error(transparent)]
    Data(#[from] DataError),
    /// Its cases are no motions.
    #[error("{}: holds force histories, expected a trajectory data set (trajectories/)", path.display())]
    NoTrajectories {
        /// The folder.
        path: PathBuf,
    },
    /// Nothing says which vehicle it is.
    #[error("{}: has no vehicle.toml; say which vehicle it is", path.display())]
    NoVehicle {
        /// The folder.
        path: PathBuf,
    },
    /// Its vehicle cannot be read.
    #[error(transparent)]
    Vehicle(#[from] TomlError),
    /// A case lacks something.
    #[error("{}", path.display())]
    Case {
        /// The folder.
        path: PathBuf,
        /// What it lacks.
        source: Box<ResponseCaseError>,
    },
}

impl ResponseCase {
    /// All trajectories of a folder; one that cannot be read is an error, not a gap, so that two runs
    /// on one folder have the same cases.
    ///
    /// - `vehicle`: the struck vehicle; `None` for the data set's own.
    ///
    /// # Errors
    /// [`ResponseLoadError`] with the first thing that is wrong.
    pub fn load_all(
        root: &Path,
        vehicle: Option<&VehicleParameters>,
        report: &mut Report<'_>,
    ) -> Result<Outcome<Vec<Self>>, ResponseLoadError> {
        let Outcome::Complete(mut dataset) = Dataset::load(root, report)? else {
            return Ok(Outcome::Cancelled);
        };
        let path = || root.to_owned();
        if dataset.kind != DatasetKind::Trajectory {
            return Err(ResponseLoadError::NoTrajectories { path: path() });
        }
        if !dataset.problems.is_empty() {
            return Err(dataset.problems.swap_remove(0).into());
        }
        let vehicle = match (vehicle, &dataset.vehicle_file) {
            (Some(vehicle), _) => vehicle.clone(),
            (None, Some(file)) => VehicleParameters::load(file)?,
            (None, None) => return Err(ResponseLoadError::NoVehicle { path: path() }),
        };
        let of = |case| {
            Self::from_case(case, &vehicle).map_err(|source| ResponseLoadError::Case {
                path: path(),
                source: Box::new(source),
            })
        };
        Ok(Outcome::Complete(dataset.cases.iter().map(of).collect::<Result<_, _>>()?))
    }
}
