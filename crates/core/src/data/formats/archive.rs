//! A crash test in an archive (`.zip`): the description of a test in ISO-MME or of the NHTSA database with its
//! channels, in whatever folders of the archive they are.
//!
//! The files of a test are unpacked into a folder that is removed at once when they have been read. Counted are
//! the bytes that really come out of the archive, not those that it says.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{BufReader, Read, Seek, copy};
use std::path::Path;

use zip::ZipArchive;

use crate::data::budget::MAX_WORKBOOK_BYTES;
use crate::data::formats::nhtsa::MAX_CURVE_BYTES;
use crate::data::formats::{Converted, from_text};
use crate::data::text::read_text;
use crate::data::{DataError, Place, ReadSettings, open_file};

/// Bytes of all files of a test together.
const MAX_TEST_BYTES: u64 = 256 << 20;
/// An archive may unpack to this many bytes, and to this multiple of its own size more.
const FREE_BYTES: u64 = 16 << 20;
const MAX_RATIO: u64 = 100;

/// What it is called if it cannot be read.
const FORMAT: &str = "an archive of several crash tests";

/// Reads the test in an archive; `None` if there is none in it.
///
/// # Errors
/// [`DataError`] if there are several, if it unpacks to too much, or if the test cannot be read.
pub(super) fn as_table(
    path: &Path,
    settings: &ReadSettings,
) -> Result<Option<Converted>, DataError> {
    let (file, n_bytes) = open_file(path, MAX_WORKBOOK_BYTES)?;
    // Whatever else is wrong with it is said by the reader of workbooks.
    let Ok(mut archive) = ZipArchive::new(BufReader::new(file)) else { return Ok(None) };
    let names = names_of_test(&mut archive);
    let tests: Vec<&(usize, String)> = names.iter().filter(|(_, name)| is_test(name)).collect();
    let distinct: BTreeSet<String> = names.iter().map(|(_, name)| name.to_lowercase()).collect();
    let main = match tests.as_slice() {
        [] => return Ok(None),
        [(_, main)] if distinct.len() == names.len() => main.clone(),
        _ => {
            let remedy = "unpack it and open one of them";
            return Err(DataError::OtherFormat { path: path.to_owned(), format: FORMAT, remedy });
        }
    };
    let folder = tempfile::tempdir().map_err(|source| DataError::io(path, source))?;
    let limit = FREE_BYTES.saturating_add(MAX_RATIO.saturating_mul(n_bytes)).min(MAX_TEST_BYTES);
    let mut left = limit;
    for (idx, name) in &names {
        let damaged = |why: String| damaged(path, format!("{name:?} cannot be unpacked ({why})"));
        let part = archive.by_index(*idx).map_err(|error| damaged(error.to_string()))?;
        let to = folder.path().join(name);
        let mut out = File::create_new(to).map_err(|source| DataError::io(path, source))?;
        let n = copy(&mut part.take(left.saturating_add(1)), &mut out);
        let n = n.map_err(|error| damaged(error.to_string()))?;
        left = left.checked_sub(n).ok_or_else(|| {
            let (path, bytes) = (path.to_owned(), limit.saturating_add(1));
            DataError::TooLarge { path, bytes, limit }
        })?;
    }
    let inner = folder.path().join(&main);
    let read = read_text(&inner, MAX_CURVE_BYTES)
        .and_then(|text| from_text(&inner, &text.text, settings))
        .map_err(|error| of_archive(path, folder.path(), error))?;
    Ok(read.map(|Converted { text, mut said }| {
        said.description += &format!(" (from {main} in the archive)");
        Converted { text, said }
    }))
}

/// The files that may belong to a test, by their indices, with their names without folders.
fn names_of_test(archive: &mut ZipArchive<impl Read + Seek>) -> Vec<(usize, String)> {
    let mut names = Vec::new();
    for idx in 0..archive.len() {
        let Ok(part) = archive.by_index_raw(idx) else { continue };
        let Ok(name) = part.name() else { continue };
        let own = name.rsplit(['/', '\\']).next().unwrap_or_default();
        let is_plain = own.len() <= 120
            && !own.starts_with('.')
            && own.chars().all(|c| c.is_alphanumeric() || " ._-()+".contains(c));
        if part.is_file() && is_plain && (is_test(own) || is_channel(own)) {
            names.push((idx, own.to_owned()));
        }
    }
    names
}

fn ending(name: &str) -> String {
    Path::new(name).extension().unwrap_or_default().to_string_lossy().to_lowercase()
}

/// Whether a file is the description of a test by its name.
fn is_test(name: &str) -> bool {
    matches!(ending(name).as_str(), "mme" | "ev5")
}

/// Whether a file is one of the channels of a test by its name.
fn is_channel(name: &str) -> bool {
    let ending = ending(name);
    ending.len() == 3 && ending.bytes().all(|byte| byte.is_ascii_digit())
}

fn damaged(path: &Path, why: String) -> DataError {
    DataError::DamagedAt { path: path.to_owned(), place: Place::Whole, why }
}

/// An error of an unpacked file as one of the archive.
fn of_archive(path: &Path, folder: &Path, error: DataError) -> DataError {
    match error {
        DataError::NoSheet { wanted, found, .. } => {
            DataError::NoSheet { path: path.to_owned(), wanted, found }
        }
        DataError::OtherFormat { format, remedy, .. } => {
            DataError::OtherFormat { path: path.to_owned(), format, remedy }
        }
        error => {
            let folder = format!("{}{}", folder.display(), std::path::MAIN_SEPARATOR);
            damaged(path, error.to_string().replace(&folder, ""))
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;
    use std::path::PathBuf;

    use super::*;
    use crate::data::{Channel, read_any_series};

    fn zipped(folder: &Path, parts: &[(&str, &str)]) -> PathBuf {
        let path = folder.join("test.zip");
        let mut zip = zip::ZipWriter::new(File::create(&path).unwrap());
        for (name, content) in parts {
            zip.start_file(*name, zip::write::SimpleFileOptions::default()).unwrap();
            zip.write_all(content.as_bytes()).unwrap();
        }
        zip.finish().unwrap();
        path
    }

    const CHANNEL: &str = "Channel code                :11BARR000000FOXP\n\
        Reference channel           :implicit\nSampling interval           :0.001\n\
        Unit                        :kN\n-1\n-2\n-1\n";
    const TEST: &str = "Data format edition number  :1.6\nLaboratory name             :L\n";

    #[test]
    fn a_test_in_an_archive_is_read_from_any_folder() {
        let folder = tempfile::tempdir().unwrap();
        let parts = [("1/a.mme", TEST), ("1/Channel/a.001", CHANNEL), ("1/read.me", "x")];
        let path = zipped(folder.path(), &parts);
        let map = "fx_body=2:kN,fy_body=none".parse().unwrap();
        let loaded = read_any_series(&path, Some(&map)).unwrap();
        assert_eq!(loaded.series.require(Channel::FxBody).unwrap(), [-1e3, -2e3, -1e3]);
        let notes: Vec<String> = loaded.notes.iter().map(ToString::to_string).collect();
        assert!(notes.iter().any(|note| note.contains("a.mme in the archive")), "{notes:?}");
    }

    #[test]
    fn several_tests_and_damaged_channels_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let refused = |parts: &[(&str, &str)]| {
            let path = zipped(folder.path(), parts);
            read_any_series(&path, None).unwrap_err().to_string()
        };
        let two = refused(&[("a.mme", TEST), ("b/b.mme", TEST)]);
        assert!(two.contains("several crash tests"), "{two}");
        let twice = refused(&[("a.mme", TEST), ("1/a.001", CHANNEL), ("2/A.001", CHANNEL)]);
        assert!(twice.contains("several crash tests"), "{twice}");
        let bad = refused(&[("a.mme", TEST), ("a.001", &CHANNEL.replace("-2", "- 2"))]);
        assert!(bad.contains("test.zip: a.001:6:1: "), "{bad}");
        let none = refused(&[("a.mme", TEST)]);
        assert!(none.contains("test.zip: is a test in ISO-MME without channels"), "{none}");
    }
}
