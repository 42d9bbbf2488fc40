//! Why there is no atlas.

use std::path::PathBuf;

use crate::SweepError;
use crate::atlas::{AtlasFileError, AxisError, SensitivityError};
use impactlab_core::data::{DataError, TomlError};

/// An atlas that cannot be made, read or written.
#[derive(Debug, thiserror::Error)]
pub enum AtlasError {
    /// A file cannot be read or written.
    #[error(transparent)]
    Data(#[from] DataError),
    /// A table of rows cannot be read.
    #[error(transparent)]
    Rows(Box<SweepError>),
    /// The rows of a file cannot be used.
    #[error("{}: its rows cannot be used", path.display())]
    RowsOf {
        /// The file.
        path: PathBuf,
        /// Why.
        source: Box<AtlasError>,
    },
    /// A file is no atlas.
    #[error("{}: is no atlas", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        source: Box<AtlasFileError>,
    },
    /// An atlas cannot be written as a file.
    #[error("the atlas cannot be written")]
    Encode(#[source] Box<AtlasFileError>),
    /// A file of axes cannot be read, is no TOML, or has other keys.
    #[error(transparent)]
    Axes(#[from] TomlError),
    /// An axis is no axis.
    #[error("axis {name:?}")]
    Axis {
        /// The axis.
        name: String,
        /// What is wrong.
        source: AxisError,
    },
    /// There are no axes.
    #[error("there are no axes")]
    NoAxes,
    /// Two axes have one name.
    #[error("there are two axes {name:?}")]
    SameAxis {
        /// The name.
        name: String,
    },
    /// There are more cells than can be numbered.
    #[error("the axes have more than {limit} cells")]
    TooManyCells {
        /// The limit.
        limit: u64,
    },
    /// The rows lack a column.
    #[error("the rows have no column {name:?}")]
    NoColumn {
        /// The column.
        name: String,
    },
    /// The edges of an axis are of another quantity than the column of the rows.
    #[error(
        "axis {name:?} is in {axis:?} and the rows have it in {rows:?}; write its edges in {rows:?}, or in \
         another unit of the same quantity"
    )]
    OtherUnit {
        /// The axis.
        name: String,
        /// Its SI unit.
        axis: String,
        /// The unit of the rows.
        rows: String,
    },
    /// A column has another number of rows than there are.
    #[error("column {name:?} has {got} rows, expected {expected}")]
    ColumnLength {
        /// The column.
        name: String,
        /// Rows of the column.
        got: usize,
        /// Rows.
        expected: usize,
    },
    /// An outcome is infinite.
    #[error(
        "row {row}: {name} is {value}, expected a finite number, or NaN where it does not apply"
    )]
    Infinite {
        /// The row.
        row: u64,
        /// The outcome.
        name: String,
        /// Its value.
        value: f64,
    },
    /// An outcome that happens or not is something between.
    #[error("row {row}: {name} is {value}, expected 0 or 1")]
    NotZeroOrOne {
        /// The row.
        row: u64,
        /// The outcome.
        name: String,
        /// Its value.
        value: f64,
    },
    /// Rows of two plans or two programs.
    #[error("the rows come from different {what}: {first} and {second}")]
    Mixed {
        /// What differs.
        what: &'static str,
        /// That of the rows before.
        first: String,
        /// That of these rows.
        second: String,
    },
    /// Rows that share their inputs.
    #[error(
        "the rows are those of a Saltelli design, which share their inputs: they give Sobol indices \
         (--saltelli) and no cells, whose errors would be too small"
    )]
    Saltelli,
    /// A row is there twice.
    #[error("row {row} is there twice")]
    Twice {
        /// The row.
        row: u64,
    },
    /// No row can be used.
    #[error("none of {n_rows} rows lies in a cell of the atlas and has an answer")]
    NoRows {
        /// Rows that there are.
        n_rows: u64,
    },
    /// No Sobol indices follow from rows.
    #[error("no Sobol indices follow from these rows")]
    Sensitivity(#[from] SensitivityError),
}

impl From<SweepError> for AtlasError {
    fn from(error: SweepError) -> Self {
        Self::Rows(Box::new(error))
    }
}
