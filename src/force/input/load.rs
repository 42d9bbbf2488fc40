//! The cases of a force data set on disk.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use crate::data::{DataError, Dataset, DatasetKind, Outcome};
use crate::force::{ForceCase, ForceCaseError};
use crate::jobs::Report;

/// A folder that gives no cases to learn from or to test on.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// The data set cannot be read, or one of its cases.
    #[error(transparent)]
    Data(#[from] DataError),
    /// Its cases are no force histories.
    #[error("{}: holds motions, expected a force data set (forces/)", path.display())]
    NoForces {
        /// The folder.
        path: PathBuf,
    },
    /// A case lacks something.
    #[error("{}", path.display())]
    Case {
        /// The folder.
        path: PathBuf,
        /// What it lacks.
        source: Box<ForceCaseError>,
    },
}

impl ForceCase {
    /// All cases of a folder; a case that cannot be read is an error, not a gap, so that two runs
    /// on one folder have the same cases.
    ///
    /// # Errors
    /// [`LoadError`] with the first thing that is wrong.
    pub fn load_all(root: &Path, report: &mut Report<'_>) -> Result<Outcome<Vec<Self>>, LoadError> {
        let Outcome::Complete(mut dataset) = Dataset::load(root, report)? else {
            return Ok(Outcome::Cancelled);
        };
        if dataset.kind != DatasetKind::Force {
            return Err(LoadError::NoForces { path: root.to_owned() });
        }
        if !dataset.problems.is_empty() {
            return Err(dataset.problems.swap_remove(0).into());
        }
        let of = |case| {
            Self::from_case(case).map_err(|source| LoadError::Case {
                path: root.to_owned(),
                source: Box::new(source),
            })
        };
        Ok(Outcome::Complete(dataset.cases.iter().map(of).collect::<Result<_, _>>()?))
    }

    /// [`ForceCase::load_all`] that nobody watches.
    ///
    /// # Errors
    /// As for [`ForceCase::load_all`].
    pub fn load_quietly(root: &Path) -> Result<Vec<Self>, LoadError> {
        let outcome = Self::load_all(root, &mut |_| ControlFlow::Continue(()))?;
        Ok(outcome.complete().unwrap_or_default())
    }
}
