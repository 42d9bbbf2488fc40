//! The errors of writing files.

use std::io;
use std::path::{Path, PathBuf};

/// The reason why a file or a folder is not written.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// The file exists, and nobody said that it may be replaced.
    #[error("{}: exists already; --overwrite replaces it", path.display())]
    Exists {
        /// The file.
        path: PathBuf,
    },
    /// The file is one of those that its content is computed from.
    #[error(
        "{}: is an input ({}) of what is to be written, so it is not replaced, not even with \
         --overwrite; choose another name",
        path.display(), input.display()
    )]
    IsInput {
        /// The file that was to be written.
        path: PathBuf,
        /// The same file, as it was named as an input.
        input: PathBuf,
    },
    /// The folder holds files of an earlier run, and nobody said that they may be replaced.
    #[error("{}: holds the files of an earlier run; --overwrite replaces them", path.display())]
    HoldsResults {
        /// The folder.
        path: PathBuf,
    },
    /// The path leads to something that cannot be replaced by a file.
    #[error("{}: is a {kind}, expected a file or a name that is not taken", path.display())]
    NotAFile {
        /// The path.
        path: PathBuf,
        /// What is there.
        kind: &'static str,
    },
    /// The path of an output folder leads to something else.
    #[error("{}: is no folder, expected a folder or a name that is not taken", path.display())]
    NotAFolder {
        /// The path.
        path: PathBuf,
    },
    /// The existing file must not be changed.
    #[error("{}: is read-only, so it is not replaced", path.display())]
    ReadOnly {
        /// The file.
        path: PathBuf,
    },
    /// Symbolic links lead around in a circle.
    #[error("{}: is a symbolic link that leads to no file", path.display())]
    LinkLoop {
        /// The link.
        path: PathBuf,
    },
    /// Somebody else is writing there.
    #[error(
        "{}: {} is writing it; wait for it, end it or choose another name",
        path.display(),
        process.map_or_else(|| "another process".to_owned(), |id| format!("process {id}"))
    )]
    InUse {
        /// The file or folder that is being written.
        path: PathBuf,
        /// The number of the process, if it could be read.
        process: Option<u32>,
    },
    /// The folder in which the file should be does not exist.
    #[error("{}: cannot be written, because there is no folder {}", path.display(), folder.display())]
    NoFolder {
        /// The file.
        path: PathBuf,
        /// The folder.
        folder: PathBuf,
    },
    /// The operating system reports an error.
    #[error("{}: cannot be written", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The error that the operating system reports.
        source: io::Error,
    },
}

impl WriteError {
    /// An error of the operating system at `path`.
    pub(super) fn io(path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Io { path, source }
    }
}
