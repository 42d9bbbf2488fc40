//! Why a file is no atlas.

use std::io;

use crate::atlas::AtlasError;
use crate::atlas::file::FORMAT;

/// Why a file is no atlas.
#[derive(Debug, thiserror::Error)]
pub enum AtlasFileError {
    /// It is no archive, or a part of it is damaged or missing.
    #[error("{name}: cannot be read from the archive")]
    Zip {
        /// The part.
        name: String,
        /// What is wrong.
        source: zip::result::ZipError,
    },
    /// A part of it cannot be read or written.
    #[error("{name}: cannot be read or written")]
    Io {
        /// The part.
        name: String,
        /// What is wrong.
        source: io::Error,
    },
    /// The head is none.
    #[error("its head is none")]
    Head(#[from] serde_json::Error),
    /// It is of another version.
    #[error("it has format {got}, expected {FORMAT}; another version of the program wrote it")]
    Format {
        /// Its version.
        got: u32,
    },
    /// A part is larger than it can be.
    #[error("{name} has more than {limit} bytes")]
    TooLarge {
        /// The part.
        name: String,
        /// The limit.
        limit: u64,
    },
    /// It says more cells than its axes have, or than are read.
    #[error("it has {got} cells, expected 1 to {limit}")]
    Cells {
        /// As it says.
        got: usize,
        /// The limit.
        limit: u64,
    },
    /// Its axes are none.
    #[error("its axes are none")]
    Axes(#[source] Box<AtlasError>),
    /// Its outcomes or histograms are not those of this program.
    #[error("its {what} are not those of this program")]
    Other {
        /// What differs.
        what: &'static str,
    },
    /// A column is of another type or shape.
    #[error("{name} is no array of the type and shape that it should have")]
    NotThisArray {
        /// The column.
        name: String,
    },
    /// A column has another length.
    #[error("{name} has {got} values, expected {expected}")]
    Length {
        /// The column.
        name: String,
        /// Its length.
        got: usize,
        /// That of the others.
        expected: usize,
    },
    /// A number is not finite.
    #[error("{name}: the value of row {cell} is not finite")]
    NotFinite {
        /// The column.
        name: String,
        /// The row of the table.
        cell: usize,
    },
    /// Counts that contradict each other, or cells that do not rise.
    #[error("row {cell} of the table of cells contradicts itself or the rows before")]
    Contradiction {
        /// The row of the table.
        cell: usize,
    },
}
