//! Why a case cannot be read, written or packed.

use std::path::{Path, PathBuf};

use impactlab_core::data::DataError;

/// A case that cannot be read, written or packed.
#[derive(Debug, thiserror::Error)]
pub enum CaseError {
    /// A file cannot be read or written.
    #[error(transparent)]
    Data(#[from] DataError),
    /// The file is not JSON, or a key or a value is not what is expected there.
    #[error("{}:{line}:{column}: is no case: {message}", path.display())]
    Syntax {
        /// The case file.
        path: PathBuf,
        /// Its line, from 1.
        line: usize,
        /// The column in that line, from 1.
        column: usize,
        /// What is wrong there.
        message: String,
    },
    /// A question names a file whose name is not Unicode, so that it can be neither written to a case
    /// nor listed in a report.
    #[error("variant {variant:?}: the name of a file is not Unicode; rename it")]
    NotUnicode {
        /// The variant.
        variant: String,
        /// What is wrong.
        source: serde_json::Error,
    },
    /// The file is JSON, but of another kind.
    #[error("{}: is no case: format is {got:?}, expected \"impactlab case\"", path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// What it says that it is.
        got: String,
    },
    /// A later version of the program has saved it.
    #[error("{}: has the version {got} of the format, expected {expected} at the most; a later version of the program has saved it", path.display())]
    Version {
        /// The case file.
        path: PathBuf,
        /// Its version.
        got: u32,
        /// The latest version that this program reads.
        expected: u32,
    },
    /// Two variants have the same name.
    #[error("{}: two variants are called {name:?}", path.display())]
    SameName {
        /// The case file.
        path: PathBuf,
        /// The name.
        name: String,
    },
    /// The variant that is shown, or asked for, is not there.
    #[error("there is no variant {name:?}, expected one of: {}", known.join(", "))]
    NoVariant {
        /// The name.
        name: String,
        /// The names of the variants.
        known: Vec<String>,
    },
    /// A file that the case uses is missing, so that it cannot be packed.
    #[error("{}: is missing; the case uses it", path.display())]
    Missing {
        /// The file.
        path: PathBuf,
    },
    /// A folder in which no question reads anything, so that it is not known what of it to pack.
    #[error("{}: holds no data that the case uses", path.display())]
    NothingRead {
        /// The folder.
        path: PathBuf,
    },
    /// The name of a file is one that others find it by, and that no package can have.
    #[error("{}: cannot be packed because of the backslash in its name; rename it", path.display())]
    PackedName {
        /// The file.
        path: PathBuf,
    },
    /// A package is no zip, or is damaged.
    #[error("{}: is no package of a case", path.display())]
    Zip {
        /// The package.
        path: PathBuf,
        /// What is wrong.
        source: zip::result::ZipError,
    },
    /// A package that no case was packed into.
    #[error("{}: is no package of a case: {why}", path.display())]
    NoPackage {
        /// The package.
        path: PathBuf,
        /// What it has or lacks.
        why: String,
    },
    /// A package is unpacked into a folder that is there already.
    #[error("{}: exists already; a package is unpacked into a new folder", path.display())]
    FolderExists {
        /// The folder.
        path: PathBuf,
    },
    /// The operating system refuses.
    #[error("{}", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
}

impl CaseError {
    /// That a file is not the JSON of a case. What the parser says of the place stands before its text.
    pub(super) fn syntax(path: &Path, source: &serde_json::Error) -> Self {
        let (line, column) = (source.line(), source.column());
        let text = source.to_string();
        let place = format!(" at line {line} column {column}");
        let message = text.strip_suffix(&place).unwrap_or(&text).to_owned();
        Self::Syntax { path: path.to_owned(), line, column, message }
    }
}
