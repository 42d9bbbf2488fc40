//! One zip of a case and all its files, for a colleague's machine.
//!
//! ```text
//! NAME.impactlab          its paths lead into files/
//! files/0/force.csv       the first file that it uses, under its own name
//! files/1/fea/…           a folder, with everything in it
//! ```

use std::fs::{self, File};
use std::io::{self, BufReader, Read, Seek};
use std::path::{Path, PathBuf};

use zip::write::SimpleFileOptions;
use zip::{ZipArchive, ZipWriter};

use crate::case_file::on_disk::sealed;
use crate::case_file::used::{files_in, files_of_site};
use crate::case_file::{CASE_ENDING, CaseError, CaseFile};
use impactlab_core::data::write::check_inputs;
use impactlab_core::data::{Existing, write_atomically};

/// Folder of the files within a package.
const FILES: &str = "files";

/// The most that is unpacked: files, and bytes of all together.
const MAX_FILES: usize = 100_000;
const MAX_BYTES: u64 = 8 << 30;

/// A file that goes into a package.
struct Entry {
    name: String,
    from: PathBuf,
}

/// Packs a case and every file that it uses into a zip, whole or not at all.
///
/// # Errors
/// [`CaseError::Missing`] for a file that is not there, [`CaseError::Zip`], [`CaseError::Data`].
pub fn pack(case: &CaseFile, to: &Path, existing: Existing) -> Result<(), CaseError> {
    if let Some(path) = case.missing_inputs().into_iter().next() {
        return Err(CaseError::Missing { path });
    }
    check_inputs(to, &case.input_files())?;
    let mut case = case.clone();
    case.record_files();
    let mut entries = Vec::new();
    let mut places = Vec::new();
    for (used, place) in placed_files(&case.used_paths())? {
        let missing = || CaseError::Missing { path: used.clone() };
        if used.is_dir() {
            let io = |source| CaseError::Io { path: used.clone(), source };
            let inner = files_in(&used).map_err(io)?;
            entries.extend(
                inner.into_iter().map(|inner| Entry {
                    name: format!("{place}/{inner}"),
                    from: used.join(inner),
                }),
            );
        } else if used.is_file() {
            entries.push(Entry { name: place.clone(), from: used.clone() });
        } else {
            return Err(missing());
        }
        places.push((used, format!("./{place}")));
    }
    let placed = |text: &str| {
        let found = places.iter().find(|(used, _)| used == Path::new(text));
        found.map(|(_, place)| place.clone())
    };
    let wrong = |source| CaseError::Syntax { path: to.to_owned(), source };
    let packed = case.with_paths(&placed).map_err(wrong)?;
    let text = sealed(&serde_json::to_string_pretty(&packed).map_err(wrong)?);
    let name = file_stem(&case.name);
    Ok(write_atomically(to, existing, |out| {
        let mut zip = ZipWriter::new_stream(out);
        let options = SimpleFileOptions::default();
        zip.start_file(format!("{name}.{CASE_ENDING}"), options).map_err(io::Error::other)?;
        io::Write::write_all(&mut zip, text.as_bytes())?;
        for Entry { name, from } in &entries {
            zip.start_file(name.as_str(), options.large_file(true)).map_err(io::Error::other)?;
            io::copy(&mut File::open(from)?, &mut zip)?;
        }
        zip.finish().map_err(io::Error::other)?;
        Ok(())
    })?)
}

/// Where each file goes in a package: into a folder of its own, but what a site names beside the site, so
/// that its names lead there, and all sites of one folder into one.
fn placed_files(used: &[PathBuf]) -> Result<Vec<(PathBuf, String)>, CaseError> {
    let sites: Vec<(usize, &PathBuf, Vec<PathBuf>)> = used
        .iter()
        .enumerate()
        .map(|(i, path)| (i, path, files_of_site(path)))
        .filter(|(.., files)| !files.is_empty())
        .collect();
    let mut placed: Vec<(PathBuf, String)> = Vec::new();
    let mut place = |path: &PathBuf, i: usize, folder: Option<&Path>| {
        let missing = || CaseError::Missing { path: path.clone() };
        let below = folder.and_then(|folder| path.strip_prefix(folder).ok());
        let below = below.or_else(|| path.file_name().map(Path::new)).ok_or_else(missing)?;
        let parts: Option<Vec<&str>> = below.iter().map(|part| part.to_str()).collect();
        let name = format!("{FILES}/{i}/{}", parts.ok_or_else(missing)?.join("/"));
        if placed.iter().all(|(_, other)| *other != name) {
            placed.push((path.clone(), name));
        }
        Ok::<(), CaseError>(())
    };
    // An orthophoto with a world file is a site of its own, too; below another site it goes with that.
    let owner_of = |site: &PathBuf| {
        let owner = sites.iter().find(|(.., files)| files.contains(site));
        owner.map_or_else(|| site.clone(), |(_, owner, _)| (*owner).clone())
    };
    for (i, site, files) in &sites {
        let owner = owner_of(site);
        let beside = sites.iter().find(|(_, other, _)| {
            owner_of(other).parent() == owner.parent() && owner_of(other) == **other
        });
        let i = beside.map_or(*i, |(i, ..)| *i);
        for path in std::iter::once(*site).chain(files) {
            place(path, i, owner.parent())?;
        }
    }
    let is_of_site =
        |path: &PathBuf| sites.iter().any(|(_, site, files)| *site == path || files.contains(path));
    for (i, path) in used.iter().enumerate().filter(|(_, path)| !is_of_site(path)) {
        place(path, i, None)?;
    }
    Ok(placed)
}

/// A name as that of a file without its ending, such as of a case or of the title of a figure.
pub fn file_stem(name: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_');
    let plain: String = name.chars().map(|c| if is_plain(c) { c } else { '_' }).collect();
    let plain = plain.trim();
    if plain.is_empty() { "case".to_owned() } else { plain.to_owned() }
}

/// Unpacks a package into a new folder, whole or not at all, and returns the path of its case.
///
/// # Errors
/// [`CaseError::FolderExists`], [`CaseError::NoPackage`] for a zip without a case or with names that lead
/// out of the folder, [`CaseError::Zip`], [`CaseError::Io`].
pub fn unpack(package: &Path, folder: &Path) -> Result<PathBuf, CaseError> {
    if folder.symlink_metadata().is_ok() {
        return Err(CaseError::FolderExists { path: folder.to_owned() });
    }
    let io = |path: &Path| {
        let path = path.to_owned();
        move |source| CaseError::Io { path, source }
    };
    let zipped = |source| CaseError::Zip { path: package.to_owned(), source };
    let none = |why: &str| CaseError::NoPackage { path: package.to_owned(), why: why.to_owned() };
    let file = File::open(package).map_err(io(package))?;
    let mut archive = ZipArchive::new(BufReader::new(file)).map_err(zipped)?;
    if archive.len() > MAX_FILES {
        return Err(none("it has too many files"));
    }
    let mut names = archive.file_names().flatten();
    let is_case =
        |name: &str| Path::new(name).extension().is_some_and(|ending| ending == CASE_ENDING);
    let case = names.find(|name| is_case(name.as_ref()));
    let case = case.ok_or_else(|| none("it has no case"))?.into_owned();
    drop(names);
    let absolute = std::path::absolute(folder).map_err(io(folder))?;
    let parent = absolute.parent().unwrap_or(Path::new("/"));
    let staging =
        tempfile::Builder::new().prefix(".impactlab-").tempdir_in(parent).map_err(io(parent))?;
    let mut left = MAX_BYTES;
    for i in 0..archive.len() {
        extract(&mut archive, i, staging.path(), &mut left, package)?;
    }
    CaseFile::load(&staging.path().join(&case))?;
    let staged = staging.keep();
    if let Err(source) = fs::rename(&staged, &absolute) {
        // What was unpacked is of no use there.
        let _ = fs::remove_dir_all(&staged);
        return Err(CaseError::Io { path: folder.to_owned(), source });
    }
    Ok(absolute.join(case))
}

/// Unpacks one file of a package.
///
/// - `left`: bytes that may still be unpacked.
fn extract(
    archive: &mut ZipArchive<impl Read + Seek>,
    i: usize,
    folder: &Path,
    left: &mut u64,
    package: &Path,
) -> Result<(), CaseError> {
    let path = || package.to_owned();
    let entry = archive.by_index(i).map_err(|source| CaseError::Zip { path: path(), source })?;
    let Some(name) = entry.enclosed_name() else {
        let why = format!("{:?} leads out of it", entry.name());
        return Err(CaseError::NoPackage { path: path(), why });
    };
    let to = folder.join(name);
    let io = |source| CaseError::Io { path: to.clone(), source };
    if entry.is_dir() {
        return fs::create_dir_all(&to).map_err(io);
    }
    fs::create_dir_all(to.parent().unwrap_or(folder)).map_err(io)?;
    let mut out = File::create_new(&to).map_err(io)?;
    let n = io::copy(&mut entry.take(*left), &mut out).map_err(io)?;
    *left -= n;
    if *left == 0 {
        let why = format!("it holds more than {} GB", MAX_BYTES >> 30);
        return Err(CaseError::NoPackage { path: path(), why });
    }
    Ok(())
}
