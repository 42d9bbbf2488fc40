//! Files of other programs that are no plain tables, each read by one file of this folder, whose head
//! describes the layout.
//!
//! A reader makes the text of a table of a file, with the units in its header, so that columns are
//! found, mapped, converted and checked as those of any table.

mod cdr;
mod fem;
mod iso_mme;
mod nhtsa;
mod nhtsa_curves;
mod parquet_check;
mod parquet_file;
mod positions;
mod recorder;

use std::io::Read;
use std::path::Path;

use crate::data::{DataError, ReadSettings, Sheet, open_file};

pub(super) use fem::OpenUnits;
pub use fem::{DeckUnits, parts_beside};
pub use nhtsa::{CrashTest, TestChannel, TestVehicle};
pub use nhtsa_curves::{BarrierForce, BarrierMomentum};
pub use recorder::{RecordedControls, RecordedDeltaV, RecordedSpeed, RecorderRecord};

/// Bytes at the beginning of a file by which a binary format is known.
const FIRST_BYTES: u64 = 64;

/// A file as the text of a table.
pub(super) struct Converted {
    /// A header and rows, with tabs between their cells and points as decimal signs.
    pub text: String,
    /// What is said of the file.
    pub said: Said,
}

/// What is said of a file that is no plain table.
#[derive(Debug, Clone, Default)]
pub(super) struct Said {
    /// What it is and how it is read, in words.
    pub description: String,
    /// What a person should look at before the numbers are used, in words.
    pub doubts: Vec<String>,
    /// The part that is read, and the names of all parts; `None` if there is one only.
    pub part: Option<Sheet>,
    /// By what a chosen map is kept beside the names of the columns, such as the type of a device.
    pub device: String,
    /// Whether every row stands in the line of the file from which it comes. Places are otherwise
    /// named as those of a sheet.
    pub keeps_lines: bool,
    /// Whether it holds results of a finite-element model, whose units the map can say.
    pub is_model: bool,
    /// What is proposed for the units of the model, if nobody has said them.
    pub open_units: Option<OpenUnits>,
}

/// Reads a binary file of one of these formats; `None` if it is none of them.
///
/// # Errors
/// [`DataError`] if it is one and cannot be read.
pub(super) fn from_binary(
    path: &Path,
    settings: &ReadSettings,
) -> Result<Option<Converted>, DataError> {
    let (file, _) = open_file(path, u64::MAX)?;
    let mut first = Vec::new();
    let read = file.take(FIRST_BYTES).read_to_end(&mut first);
    read.map_err(|source| DataError::io(path, source))?;
    if first.starts_with(b"PAR1") {
        return parquet_file::as_table(path).map(Some);
    }
    fem::from_binary(path, settings)
}

/// Reads a text file of one of these formats; `None` if it is none of them.
///
/// - `text`: the whole file.
///
/// # Errors
/// [`DataError`] if it is one and cannot be read.
pub(super) fn from_text(
    path: &Path,
    text: &str,
    settings: &ReadSettings,
) -> Result<Option<Converted>, DataError> {
    for as_table in [cdr::as_table, nhtsa_curves::as_table, iso_mme::as_table, positions::as_table]
    {
        if let Some(converted) = as_table(path, text, settings)? {
            return Ok(Some(converted));
        }
    }
    fem::from_text(path, text, settings)
}

/// A number with the fewest digits that give it again; with an exponent if it would be long.
fn number_text(number: f64) -> String {
    match number.fract() == 0.0 && number.abs() < 1e15 {
        true => format!("{number:.0}"),
        false => format!("{number:?}"),
    }
}
