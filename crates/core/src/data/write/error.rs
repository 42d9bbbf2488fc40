//! The errors of writing files.

use std::io;
use std::path::{Component, Path, PathBuf};

use crate::data::write::folder::STAGING;

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
    /// A folder of results holds a file of a name that is to be written, and it is none of an earlier run.
    #[error(
        "{}: was not written by an earlier run, or has been edited since, so it is not replaced, not \
         even with --overwrite; move it away or choose another folder",
        path.display()
    )]
    NotOfRun {
        /// The file.
        path: PathBuf,
    },
    /// The name of the file says that it holds something else.
    #[error("{}: cannot be made; expected a name that ends in .{ending}", path.display())]
    Ending {
        /// The file.
        path: PathBuf,
        /// The ending of files with such a content.
        ending: &'static str,
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
    #[error("{}: cannot be written", without_staging(path).display())]
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
        move |source| Self::Io { path, source: of_system(source) }
    }
}

/// The error without the temporary file that `tempfile` adds to its text, which nobody asked for.
fn of_system(error: io::Error) -> io::Error {
    let text = error.to_string();
    match text.split_once(" at path \"") {
        Some((text, _)) if error.raw_os_error().is_none() => {
            io::Error::new(error.kind(), text.to_owned())
        }
        _ => error,
    }
}

/// The path that a file in a staging folder is made for.
fn without_staging(path: &Path) -> PathBuf {
    let is_kept = |part: &Component<'_>| {
        let name = part.as_os_str().to_string_lossy();
        !(name.starts_with(STAGING[0]) && name.ends_with(STAGING[1]))
    };
    path.components().filter(is_kept).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error_chain;

    #[test]
    fn an_error_names_the_file_that_was_asked_for() {
        let folder = tempfile::tempdir().unwrap();
        let missing = folder.path().join("missing");
        let target = missing.join("a.csv");
        let error = tempfile::Builder::new().suffix(".tmp").tempfile_in(&missing).unwrap_err();
        assert!(error.to_string().contains(".tmp"), "{error}");
        let system = io::Error::from_raw_os_error(error.raw_os_error().unwrap_or(2));
        let text = error_chain(&WriteError::io(&target)(error));
        assert_eq!(text, format!("{}: cannot be written: {system}", target.display()));
        let staged = missing.join(".impactlab-x1.tmp").join("a.csv");
        let text = WriteError::io(&staged)(io::Error::from_raw_os_error(28)).to_string();
        assert_eq!(text, format!("{}: cannot be written", target.display()));
    }
}
