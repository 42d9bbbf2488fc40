//! Results of finite-element solvers: forces and motions over time, in the units of the model.
//!
//! A file holds many histories, one for each contact and side, section, wall, spring or node. One of
//! them is read at a time; it is chosen like the sheet of a workbook. The units of the model stand in
//! none of the files and are asked for ([`DeckUnits`]).

mod binout;
mod choice;
mod deck;
mod fortran;
mod legend;
mod lsda;
mod matsum;
mod momenta;
mod motion;
mod nodout;
mod parts;
mod radioss;
mod rbdout;
mod rcforc;
mod results;
mod secforc;
mod start;
mod states;
mod tokens;

use std::path::Path;

use crate::data::foreign::other;
use crate::data::formats::{Converted, Said};
use crate::data::{DataError, ReadSettings, open_file};

use choice::Chosen;
pub use deck::DeckUnits;
pub(in crate::data) use deck::OpenUnits;
pub use parts::parts_beside;
use results::{Kind, Results};
pub use start::ModelStart;
use tokens::damaged_line;

/// Lines at the start of a text in which the marks of a solver are looked for, and the longest line
/// that is examined, bytes.
const EXAMINED_LINES: usize = 2000;
const EXAMINED_BYTES: usize = 400;

/// What to do with a file of momenta.
const WITH_FORCES: &str = "open the rcforc beside it, with which its momenta are read";

/// First bytes by which a binary file is recognised.
const HEAD_BYTES: u64 = 92;

/// Reads a binary file of results; `None` if it is none.
///
/// # Errors
/// [`DataError`] if it is one and cannot be read.
pub(super) fn from_binary(
    path: &Path,
    settings: &ReadSettings,
) -> Result<Option<Converted>, DataError> {
    use std::io::Read;
    let (file, _) = open_file(path, u64::MAX)?;
    let mut head = Vec::new();
    let read = file.take(HEAD_BYTES).read_to_end(&mut head);
    read.map_err(|source| DataError::io(path, source))?;
    let results = match () {
        () if lsda::is_lsda(&head) => binout::read(path)?,
        () if radioss::is_history(&head) => radioss::read(path)?,
        () => return Ok(None),
    };
    converted(path, &results, settings).map(Some)
}

/// Reads a text file of results; `None` if it is none.
///
/// # Errors
/// [`DataError`] if it is one and cannot be read.
pub(super) fn from_text(
    path: &Path,
    text: &str,
    settings: &ReadSettings,
) -> Result<Option<Converted>, DataError> {
    let reader = examined_lines(text).find_map(|line| -> Option<Reader> {
        match () {
            () if rcforc::is_row(line) => Some(rcforc::read),
            () if nodout::is_title(line) => Some(nodout::read),
            () if secforc::is_title(line) => Some(secforc::read),
            () if rbdout::is_title(line) => Some(rbdout::read),
            () => None,
        }
    });
    let Some(read) = reader else {
        return match examined_lines(text).any(matsum::is_part) {
            true => Err(other(path, "an LS-DYNA matsum file", WITH_FORCES)),
            false => Ok(None),
        };
    };
    let mut results = read(text).map_err(|at| damaged_line(path, at))?;
    if results.histories.iter().any(|history| history.kind == Kind::Contact) {
        matsum::add_beside(path, text, &mut results);
    }
    converted(path, &results, settings).map(Some)
}

/// The lines of a text in which the marks of a solver are looked for.
fn examined_lines(text: &str) -> impl Iterator<Item = &str> {
    text.lines().take(EXAMINED_LINES).filter(|line| line.len() <= EXAMINED_BYTES)
}

/// A reader of text. What is wrong is said with its line.
type Reader = fn(&str) -> Result<Results, (u64, String)>;

fn converted(
    path: &Path,
    results: &Results,
    settings: &ReadSettings,
) -> Result<Converted, DataError> {
    let chosen = Chosen::new(path, results, settings.sheet.as_ref())?;
    let said = Said {
        description: chosen.description(results, settings.deck),
        doubts: chosen.doubts(results, settings.deck),
        part: Some(chosen.sheet(results)),
        // The same choice is right for the next run of the same model only.
        device: results.labels().join("\n"),
        open_units: settings.deck.is_none().then(|| results.open_units()),
        is_model: true,
        model_start: chosen.start(results, settings.deck),
        ..Said::default()
    };
    Ok(Converted { text: chosen.table(settings.deck), said })
}
