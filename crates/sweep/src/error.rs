//! Why a sweep cannot be planned, run or merged.

use std::path::{Path, PathBuf};

use impactlab_core::data::write::WriteError;
use impactlab_core::data::{DataError, TomlError};
use impactlab_study::StudyError;

/// A sweep that cannot go on.
#[derive(Debug, thiserror::Error)]
pub enum SweepError {
    /// The plan that a user wrote is refused.
    #[error(transparent)]
    Toml(#[from] TomlError),
    /// A file cannot be read or written.
    #[error(transparent)]
    Data(#[from] DataError),
    /// A network, vehicle or scenario cannot be read.
    #[error(transparent)]
    Study(Box<StudyError>),
    /// A request file holds no request, or not with the values of the plan.
    #[error("{}: is no request", path.display())]
    Request {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        source: serde_json::Error,
    },
    /// A resolved plan cannot be read.
    #[error("{}: is no plan of a sweep", path.display())]
    NoPlan {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        source: serde_json::Error,
    },
    /// A resolved plan holds values that no plan file gives.
    #[error("{}: is no plan of a sweep: {what}", path.display())]
    BadPlan {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        what: String,
    },
    /// The plan was made by another program, or with other networks or files.
    #[error(
        "{}: the plan was made with {what} {planned}, and this is {present}; run it with the program that \
         made it, or make the plan anew in another folder",
        path.display()
    )]
    OtherProgram {
        /// The plan.
        path: PathBuf,
        /// What differs.
        what: String,
        /// As in the plan.
        planned: String,
        /// As it is here.
        present: String,
    },
    /// The folder holds another plan, whose rows may be there or under way.
    #[error(
        "{}: is another plan, or of another version of the program, and is not replaced; make this one in \
         another folder",
        path.display()
    )]
    PlanThere {
        /// The file.
        path: PathBuf,
    },
    /// A file that the question reads has gone or cannot be read.
    #[error("{}: cannot be read", path.display())]
    Input {
        /// The file.
        path: PathBuf,
        /// The error of the operating system.
        source: std::io::Error,
    },
    /// There is no such chunk.
    #[error("there is no chunk {chunk}; the plan has {n_chunks}, the first is 0")]
    NoChunk {
        /// As asked for.
        chunk: u64,
        /// Number of chunks.
        n_chunks: u64,
    },
    /// A variable of the job array is missing or no number.
    #[error(
        "--array: {name} is {value:?}, expected a whole number as Slurm sets it; with --stride N only \
         SLURM_ARRAY_TASK_ID is needed"
    )]
    Array {
        /// The variable.
        name: &'static str,
        /// Its value; empty if it is not set.
        value: String,
    },
    /// A table of rows cannot be read.
    #[error("{}: is no whole table of rows: {what}", path.display())]
    Rows {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        what: String,
    },
    /// A file of the name of a chunk holds rows of another plan, which somebody has computed.
    #[error(
        "{}: holds rows of another plan, which are not replaced; move them away, or make the plan in \
         another folder",
        path.display()
    )]
    OtherPlan {
        /// The file.
        path: PathBuf,
    },
    /// Rows cannot be written as a table.
    #[error("the rows cannot be written as a table")]
    Encode(#[from] parquet::errors::ParquetError),
    /// A batch file cannot say a path.
    #[error("{}: a name that is no UTF-8 text cannot stand in a batch file; choose another", path.display())]
    NoText {
        /// The folder of the sweep, or the program.
        path: PathBuf,
    },
    /// Chunks are missing.
    #[error(
        "{}: chunks are missing: {missing}; run them first, such as with --chunks {first}",
        folder.display()
    )]
    Missing {
        /// The folder of the sweep.
        folder: PathBuf,
        /// Which, as an array expression.
        missing: String,
        /// The first of them.
        first: String,
    },
    /// The work was cancelled. What is finished is kept.
    #[error("cancelled; what is finished is kept")]
    Cancelled,
}

impl SweepError {
    /// The folder of a sweep cannot be made.
    pub(crate) fn no_folder(folder: &Path, source: std::io::Error) -> Self {
        let path = folder.to_owned();
        let error = match folder.exists() && !folder.is_dir() {
            true => WriteError::NotAFolder { path },
            false => WriteError::Io { path, source },
        };
        DataError::from(error).into()
    }
}

impl From<StudyError> for SweepError {
    fn from(error: StudyError) -> Self {
        Self::Study(Box::new(error))
    }
}
