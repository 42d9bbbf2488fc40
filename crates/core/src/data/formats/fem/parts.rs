//! The files of one `binout`: `binout0000`, `binout0001` of several processes, `binout0000%001` of one that
//! became too large.

use std::collections::BTreeSet;
use std::io::Read;
use std::path::{Path, PathBuf};

use crate::data::formats::fem::lsda::is_lsda;
use crate::data::formats::fem::{EXAMINED_BYTES, EXAMINED_LINES, examined_lines, matsum, rcforc};
use crate::data::{DataError, Place, list_folder, open_file};

/// Beginning of the names of which several processes write one file each.
const NAME: &str = "binout";

/// A name of a part: what all parts have in common, the process, and the number of the part.
#[derive(Debug, Clone, PartialEq, Eq)]
struct PartName {
    family: String,
    process: String,
    number: u32,
}

impl PartName {
    fn parse(name: &str) -> Option<Self> {
        let (whole, number) = match name.rsplit_once('%') {
            Some((whole, digits)) => {
                (whole, digits.parse::<u32>().ok().filter(|number| *number > 0)?)
            }
            None => (name, 0),
        };
        let stem = whole.trim_end_matches(|c: char| c.is_ascii_digit());
        // Other names that end in digits are as likely those of other runs.
        let is_shared = stem.to_ascii_lowercase().ends_with(NAME);
        let (family, process) = match is_shared {
            true => whole.split_at(stem.len()),
            false => (whole, ""),
        };
        Some(Self { family: family.to_owned(), process: process.to_owned(), number })
    }

    /// Whether both are parts of one file. `binout` without digits is not one of `binout0000`.
    fn is_with(&self, other: &Self) -> bool {
        self.family == other.family && self.process.len() == other.process.len()
    }
}

/// All parts of the file that a path names, in their order; the path alone if it has no others.
///
/// # Errors
/// [`DataError`] if the folder cannot be listed, [`DataError::DamagedAt`] if a part is missing between
/// others.
pub(super) fn parts(path: &Path) -> Result<Vec<PathBuf>, DataError> {
    let name_of = |path: &Path| PartName::parse(path.file_name()?.to_str()?);
    let Some(own) = name_of(path) else { return Ok(vec![path.to_owned()]) };
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let mut found: Vec<(PartName, PathBuf)> = list_folder(folder.unwrap_or(Path::new(".")))?
        .into_iter()
        .filter_map(|entry| Some((name_of(&entry)?, entry)))
        .filter(|(name, entry)| name.is_with(&own) && entry.is_file())
        .map(|(name, entry)| {
            // As the path was given, so that it is named so.
            let beside = entry.file_name().map(|name| path.with_file_name(name));
            (name, beside.unwrap_or(entry))
        })
        .collect();
    found.sort_by(|(a, _), (b, _)| (&a.process, a.number).cmp(&(&b.process, b.number)));
    let there: BTreeSet<(&str, u32)> =
        found.iter().map(|(name, _)| (name.process.as_str(), name.number)).collect();
    for (name, entry) in &found {
        let before = name.number.checked_sub(1);
        if before.is_some_and(|before| !there.contains(&(name.process.as_str(), before))) {
            let why = "the part before it is not in the folder".to_owned();
            return Err(DataError::DamagedAt { path: entry.clone(), place: Place::Whole, why });
        }
    }
    match found.is_empty() {
        true => Ok(vec![path.to_owned()]),
        false => Ok(found.into_iter().map(|(_, path)| path).collect()),
    }
}

/// The files that are read together with a file of results, itself among them: all parts of a `binout`, an
/// `rcforc` and its `matsum`; none for any other file.
pub fn parts_beside(path: &Path) -> Vec<PathBuf> {
    let head = open_file(path, u64::MAX).ok().and_then(|(file, _)| {
        let mut head = Vec::new();
        file.take(8).read_to_end(&mut head).ok()?;
        Some(head)
    });
    match head.is_some_and(|head| is_lsda(&head)) {
        true => parts(path).unwrap_or_default(),
        false => forces_with_momenta(path).unwrap_or_default(),
    }
}

/// An `rcforc` with the `matsum` beside it; `None` for any other file.
fn forces_with_momenta(path: &Path) -> Option<Vec<PathBuf>> {
    let momenta = matsum::beside(path)?;
    let (file, _) = open_file(path, u64::MAX).ok()?;
    let mut head = Vec::new();
    file.take((EXAMINED_LINES * EXAMINED_BYTES) as u64).read_to_end(&mut head).ok()?;
    let is_forces = examined_lines(&String::from_utf8_lossy(&head)).any(rcforc::is_row);
    is_forces.then(|| vec![path.to_owned(), momenta])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_one_run_belong_together_and_a_gap_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str| std::fs::write(folder.path().join(name), b"").unwrap();
        let names = |name: &str| {
            let found = parts(&folder.path().join(name)).unwrap();
            let name = |path: PathBuf| path.file_name().unwrap().to_str().unwrap().to_owned();
            found.into_iter().map(name).collect::<Vec<_>>()
        };
        let family = ["binout0000", "binout0000%001", "binout0001"];
        for name in family.iter().chain(&["binout", "run12", "run13", "run13%001", "binout.txt"]) {
            write(name);
        }
        assert_eq!(names("binout0001"), family);
        assert_eq!(names("binout0000%001"), family);
        assert_eq!(names("binout"), ["binout"]);
        assert_eq!(names("run13"), ["run13", "run13%001"]);
        write("binout0001%002");
        let error = parts(&folder.path().join("binout0000")).unwrap_err().to_string();
        assert!(error.contains("binout0001%002: the part before it"), "{error}");
    }
}
