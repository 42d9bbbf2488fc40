//! Files of other programs that are no plain tables, each read by one file of this folder, whose head
//! describes the layout.
//!
//! A reader makes the text of a table of a file, with the units in its header, so that columns are
//! found, mapped, converted and checked as those of any table.

mod archive;
mod bytes;
mod cdr;
mod fem;
mod iso_mme;
mod iso_mme_channel;
mod mdf;
mod mdf_blocks;
mod mdf_records;
mod nhtsa;
mod nhtsa_curves;
mod parquet_check;
mod parquet_file;
mod positions;
mod recorder;
mod recorder_columns;
mod recorder_contradictions;
mod recorder_table;
#[cfg(test)]
mod sample_tests;
mod tdms;
mod tdms_file;
mod tdms_objects;
mod upright;

use std::io::Read;
use std::path::{Path, PathBuf};

use crate::data::{DataError, ReadSettings, Sheet, SheetRef, open_file};

pub(super) use fem::OpenUnits;
pub use fem::{DeckUnits, ModelStart};
pub use nhtsa::{CrashTest, TestChannel, TestVehicle};
pub use nhtsa_curves::{BarrierForce, BarrierMomentum};
pub(super) use positions::OF_COURSE;
pub use recorder::{
    RecordedControls, RecordedDeltaV, RecordedSide, RecordedSides, RecordedSpeed, RecorderRecord,
};

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
    /// Columns that are not read, each with what it holds.
    pub left_out: Vec<String>,
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
    /// With which velocities the cars of the model begin, if that is known.
    pub model_start: Option<ModelStart>,
}

/// Bytes at the beginning of a file by which it is known to have others beside it.
const HEAD_BYTES: u64 = 16 << 10;

/// The files that are read together with a file: all parts of a `binout`, a crash test and its curves, a test in
/// ISO-MME and its channels. The file itself is among them, for a test the first one; none for a file that is
/// read alone.
pub fn parts_beside(path: &Path) -> Vec<PathBuf> {
    let parts = fem::parts_beside(path);
    if !parts.is_empty() {
        return parts;
    }
    let text = head_text(path);
    let beside = match nhtsa::is_test(&text) {
        true => CrashTest::read(path).map(|test| test.curve_files()).unwrap_or_default(),
        false => iso_mme::channels_beside(path, &text),
    };
    match beside.is_empty() {
        true => Vec::new(),
        false => std::iter::once(path.to_owned()).chain(beside).collect(),
    }
}

/// The beginning of a file as text; empty if it cannot be read.
fn head_text(path: &Path) -> String {
    let head = open_file(path, u64::MAX).ok().and_then(|(file, _)| {
        let mut head = Vec::new();
        file.take(HEAD_BYTES).read_to_end(&mut head).ok()?;
        Some(head)
    });
    String::from_utf8_lossy(&head.unwrap_or_default()).into_owned()
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
    if first.starts_with(b"TDSm") {
        return tdms::as_table(path, settings).map(Some);
    }
    if mdf_blocks::is_mdf(&first) {
        return mdf::as_table(path, settings).map(Some);
    }
    fem::from_binary(path, settings)
}

/// Reads the crash test in an archive; `None` if there is none in it.
///
/// # Errors
/// [`DataError`] if there is one and it cannot be read.
pub(super) fn from_archive(
    path: &Path,
    settings: &ReadSettings,
) -> Result<Option<Converted>, DataError> {
    archive::as_table(path, settings)
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

/// The index of the part of a file that the settings name.
///
/// - `first`: taken if they name none.
///
/// # Errors
/// [`DataError::NoSheet`] without such a part.
fn chosen_part(
    path: &Path,
    all: &[String],
    first: usize,
    settings: &ReadSettings,
) -> Result<usize, DataError> {
    let chosen = match &settings.sheet {
        None => Some(first),
        Some(SheetRef::Number(number)) => number.checked_sub(1),
        Some(SheetRef::Name(name)) => all.iter().position(|part| part == name),
    };
    chosen.filter(|idx| *idx < all.len()).ok_or_else(|| {
        let wanted = settings.sheet.as_ref().map_or_else(String::new, SheetRef::to_string);
        DataError::NoSheet { path: path.to_owned(), wanted, found: all.to_vec() }
    })
}

/// A number with the fewest digits that give it again; with an exponent if it would be long.
fn number_text(number: f64) -> String {
    match number.fract() == 0.0 && number.abs() < 1e15 {
        true => format!("{number:.0}"),
        false => format!("{number:?}"),
    }
}
