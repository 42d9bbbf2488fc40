//! The reasons why something is not kept, or why what was kept cannot be used.

use std::path::PathBuf;

use impactlab_core::data::DataError;

/// The reason why something is not kept, or why what was kept cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum ArchiveError {
    /// The folder cannot be made or listed, or a file cannot be read or removed.
    #[error("{}: {source}", path.display())]
    Io {
        /// The folder or file.
        path: PathBuf,
        /// The error of the operating system.
        source: std::io::Error,
    },
    /// A file cannot be read or written.
    #[error(transparent)]
    Data(#[from] DataError),
    /// The content cannot be written.
    #[error("{0}")]
    Content(String),
    /// The note is not what this program writes.
    #[error("{}:{line}:{column}: the note is damaged ({reason})", path.display())]
    Note {
        /// The note.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// What is wrong there.
        reason: String,
    },
    /// The note was written by a later version of the program.
    #[error("{}: was kept by a later version of the program (version {got} of the note, expected {expected})", path.display())]
    Version {
        /// The note.
        path: PathBuf,
        /// The version that this program writes.
        expected: u32,
        /// The version of the note.
        got: u32,
    },
    /// The content has another digest than when it was kept.
    #[error("{}: is damaged: its SHA-256 begins with {}, expected {}", path.display(), short(got), short(expected))]
    OtherContent {
        /// The file with the content.
        path: PathBuf,
        /// The digest when it was kept.
        expected: String,
        /// The digest now.
        got: String,
    },
    /// There is a note but no content.
    #[error("{}: is missing; only its note is left", path.display())]
    NoContent {
        /// The file with the content.
        path: PathBuf,
    },
    /// There is content but no note.
    #[error("{}: has no note of what it is", path.display())]
    NoNote {
        /// The file with the content.
        path: PathBuf,
    },
}

impl ArchiveError {
    /// An error of the operating system at `path`.
    pub(in crate::app) fn io(path: &std::path::Path) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Io { path, source }
    }
}

fn short(sha256: &str) -> &str {
    sha256.get(..12).unwrap_or(sha256)
}
