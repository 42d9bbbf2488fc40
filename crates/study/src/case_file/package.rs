//! One zip of a case and all its files, for a colleague's machine.
//!
//! ```text
//! NAME.impactlab          its paths lead into files/
//! files/0/force.csv       the first file that it uses, under its own name where every system can hold that
//! files/1/fea/…           a folder, with the files of its data sets
//! ```
//!
//! Nothing else is in a package, and one that has something else is refused before anything of it is on
//! disk.

use std::fs::{self, File};
use std::io::{self, BufReader, Read, Seek};
use std::path::{Path, PathBuf};

use serde::Serialize;
use zip::write::SimpleFileOptions;
use zip::{ZipArchive, ZipWriter};

use crate::ask::inputs::data_files::{files_of_data, files_of_sets, folder_of_data};
use crate::case_file::on_disk::sealed;
use crate::case_file::portable::portable_name;
use crate::case_file::used::{files_of_site, named_below};
use crate::case_file::{CASE_ENDING, CaseError, CaseFile};
use crate::{ForceSource, ModelChoice, Request};
use impactlab_core::data::write::{WriterLock, check_ending, check_inputs, sync_folder};
use impactlab_core::data::{Existing, MAX_RESULTS_BYTES, open_file, read_utf8, write_atomically};

/// Folder of the files within a package.
const FILES: &str = "files";

/// The most that is unpacked: files, and bytes of all together.
const MAX_FILES: usize = 100_000;
const MAX_BYTES: u64 = 8 << 30;

/// A package may unpack to this many bytes, and to this multiple of its own size more. Tables of numbers
/// shrink to a tenth.
const FREE_BYTES: u64 = 256 << 20;
const MAX_RATIO: u64 = 100;

/// Beginning of the names of folders in which packages are being unpacked.
const STAGING: &str = ".impactlab-unpack-";
/// What is unpacked, in such a folder. Its lock is beside it there, so that all that a killed run leaves is in
/// one place.
const UNPACKED: &str = "unpacked";

/// A file that went into a package.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct PackedFile {
    /// Its name in the package.
    pub name: String,
    /// Where it was read.
    pub path: PathBuf,
}

/// Packs a case and every file that its questions use into a zip, whole or not at all, and returns the files in
/// their order. A file that is filled in and not asked stays here, and so does what lies in the folder of a data
/// set and is no part of it. Who may be handed the others is for the caller
/// to ask ([`CaseFile::reach`]).
///
/// # Errors
/// [`CaseError::Missing`] for a file that is not there, [`CaseError::NothingRead`] for a folder without data, [`CaseError::PackedName`] for one that could not be
/// unpacked, [`CaseError::Zip`], [`CaseError::Data`], also for a name that does not end in `.zip`.
pub fn pack(case: &CaseFile, to: &Path, existing: Existing) -> Result<Vec<PackedFile>, CaseError> {
    if let Some(path) = case.missing_inputs().into_iter().next() {
        return Err(CaseError::Missing { path });
    }
    check_inputs(to, &case.input_files())?;
    check_ending(to, "zip")?;
    let used = case.asked(&[])?.used_paths();
    let mut case = case.clone();
    case.record_files();
    case.files.retain(|file| used.contains(&file.path));
    let mut entries = Vec::new();
    let mut places = Vec::new();
    for (used, place) in placed_files(&used)? {
        if let Some(folder) = folder_of_data(&used) {
            let reads = !files_of_sets(folder).is_empty() || case.reads_logs_in(folder);
            let files = if reads { files_of_data(&used) } else { Vec::new() };
            if files.is_empty() {
                return Err(CaseError::NothingRead { path: used });
            }
            // A table lies beside the files of its cases.
            let at = if folder == used { &place } else { parent_of(&place) };
            let inner = named_below(folder, files).into_iter();
            entries.extend(
                inner.map(|(name, path)| PackedFile { name: format!("{at}/{name}"), path }),
            );
        } else if used.is_file() {
            entries.push(PackedFile { name: place.clone(), path: used.clone() });
        } else {
            return Err(CaseError::Missing { path: used });
        }
        places.push((used, format!("./{place}")));
    }
    if let Some(PackedFile { path, .. }) = entries.iter().find(|file| !can_be_unpacked(&file.name))
    {
        return Err(CaseError::PackedName { path: path.clone() });
    }
    if entries.len() >= MAX_FILES {
        let why = format!("it would have more than {MAX_FILES} files");
        return Err(CaseError::NoPackage { path: to.to_owned(), why });
    }
    let said = case.said_paths();
    let placed = |text: &str| {
        let found = places.iter().find(|(used, _)| used == Path::new(text));
        let place = found.map(|(_, place)| place.clone());
        place.or_else(|| said.get(Path::new(text)).map(|path| beside_case(path)))
    };
    let wrong = |source: serde_json::Error| CaseError::syntax(to, &source);
    let packed = case.with_paths(&placed).map_err(wrong)?;
    let text = sealed(&serde_json::to_string_pretty(&packed).map_err(wrong)?);
    let name = file_stem(&case.name);
    write_atomically(to, existing, |out| {
        let mut zip = ZipWriter::new_stream(out);
        let options = SimpleFileOptions::default();
        zip.start_file(format!("{name}.{CASE_ENDING}"), options).map_err(io::Error::other)?;
        io::Write::write_all(&mut zip, text.as_bytes())?;
        for PackedFile { name, path } in &entries {
            zip.start_file(name.as_str(), options.large_file(true)).map_err(io::Error::other)?;
            let (mut file, _) = open_file(path, u64::MAX).map_err(io::Error::other)?;
            io::copy(&mut file, &mut zip)?;
        }
        zip.finish().map_err(io::Error::other)?;
        Ok(())
    })?;
    Ok(entries)
}

/// The folder of a file in a package.
fn parent_of(place: &str) -> &str {
    place.rsplit_once('/').map_or("", |(folder, _)| folder)
}

impl CaseFile {
    /// Whether a question learns from the logs in a folder.
    fn reads_logs_in(&self, folder: &Path) -> bool {
        let questions = self.variants.iter().flat_map(|variant| &variant.questions);
        let mut logs = questions.flat_map(|question| match question {
            Request::FineTune(request) => request.logs.iter().flat_map(|of| &of.logs).collect(),
            _ => Vec::new(),
        });
        logs.any(|path| std::path::absolute(path).is_ok_and(|path| path == folder))
    }

    /// Names of the networks that questions ask and that stand in no file, such as those that were just trained:
    /// no package has them, and nobody else can ask them.
    pub fn networks_in_no_file(&self) -> Vec<&str> {
        let questions = self.variants.iter().flat_map(|variant| &variant.questions);
        let asked = questions.flat_map(|question| match question {
            Request::PredictForce(of) => [Some(&of.model), None],
            Request::PredictMotion(of) => {
                let force = match &of.force {
                    ForceSource::Predicted(model) => Some(model),
                    ForceSource::File(_) | ForceSource::Given => None,
                };
                [Some(&of.response_model), force]
            }
            _ => [None, None],
        });
        let held = asked.flatten().filter_map(|model| match model {
            ModelChoice::Held { held } => Some(held.as_str()),
            ModelChoice::Source(_) => None,
        });
        let mut names: Vec<&str> = held.collect();
        names.sort_unstable();
        names.dedup();
        names
    }
}

/// What a case says in a package in place of a path that leads to none of its files, such as that of a view
/// or of a checkpoint: the last part, beside the case. The folders above it are those of a person and a
/// machine.
fn beside_case(path: &Path) -> String {
    format!("./{}", path.file_name().unwrap_or_default().to_string_lossy())
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
        let below = match folder.and_then(|folder| path.strip_prefix(folder).ok()) {
            Some(below) => {
                let parts: Option<Vec<&str>> = below.iter().map(|part| part.to_str()).collect();
                parts.map(|parts| parts.join("/"))
            }
            // Nothing finds it by its name.
            None => path.file_name().and_then(|name| name.to_str()).map(portable_name),
        };
        let name = format!("{FILES}/{i}/{}", below.ok_or_else(missing)?);
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

/// A name as that of a file without its ending, such as of a case or of the title of a figure, on any system.
pub fn file_stem(name: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_');
    let plain: String = name.chars().map(|c| if is_plain(c) { c } else { '_' }).collect();
    // A colon or comma before a space is no word.
    let plain = plain.replace("_ ", " ");
    let plain = plain.trim();
    if plain.is_empty() { "case".to_owned() } else { portable_name(plain) }
}

/// Unpacks a package into a new folder, whole or not at all, and returns the path of its case. What a killed
/// run has left beside the folder is removed.
///
/// # Errors
/// [`CaseError::FolderExists`], [`CaseError::NoPackage`] for a zip without a case, with anything that is no
/// part of a package, or that unpacks to too much, [`CaseError::Zip`], [`CaseError::Io`],
/// [`CaseError::Data`].
pub fn unpack(package: &Path, folder: &Path) -> Result<PathBuf, CaseError> {
    if folder.symlink_metadata().is_ok() {
        return Err(CaseError::FolderExists { path: folder.to_owned() });
    }
    let io = |path: &Path| {
        let path = path.to_owned();
        move |source| CaseError::Io { path, source }
    };
    let (file, bytes) = open_file(package, MAX_BYTES)?;
    let mut archive = ZipArchive::new(BufReader::new(file))
        .map_err(|source| CaseError::Zip { path: package.to_owned(), source })?;
    let case = check_contents(&mut archive, package, bytes)?;
    let absolute = std::path::absolute(folder).map_err(io(folder))?;
    let parent = absolute.parent().unwrap_or(Path::new("/"));
    sweep_staging(parent);
    let staging =
        tempfile::Builder::new().prefix(STAGING).tempdir_in(parent).map_err(io(parent))?;
    let unpacked = staging.path().join(UNPACKED);
    let _lock = WriterLock::lock_file(&unpacked)?;
    fs::create_dir(&unpacked).map_err(io(&unpacked))?;
    for i in 0..archive.len() {
        extract(&mut archive, i, [&unpacked, &absolute], package)?;
    }
    // What is wrong with it is told of the place that it would have.
    let text = read_utf8(&unpacked.join(&case), MAX_RESULTS_BYTES)?;
    CaseFile::parse(&text, &absolute.join(&case))?;
    // A name that is on the disk before what it names would leave empty files after a loss of power.
    sync_folders(&unpacked).map_err(io(folder))?;
    fs::rename(&unpacked, &absolute).map_err(|source| match absolute.exists() {
        // Another process has made it by now.
        true => CaseError::FolderExists { path: folder.to_owned() },
        false => io(folder)(source),
    })?;
    sync_folder(parent).map_err(io(parent))?;
    Ok(absolute.join(case))
}

/// Brings the names in a folder and in all folders below it to the disk.
fn sync_folders(folder: &Path) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        if entry.file_type()?.is_dir() {
            sync_folders(&entry.path())?;
        }
    }
    sync_folder(folder)
}

/// Checks everything that a package says of its content, and returns the name of its case. Nothing is
/// unpacked.
fn check_contents(
    archive: &mut ZipArchive<impl Read + Seek>,
    package: &Path,
    package_bytes: u64,
) -> Result<String, CaseError> {
    let none = |why: String| CaseError::NoPackage { path: package.to_owned(), why };
    let zipped = |source| CaseError::Zip { path: package.to_owned(), source };
    if archive.len() > MAX_FILES {
        return Err(none(format!("it has more than {MAX_FILES} files")));
    }
    let (mut total, mut cases) = (0_u64, Vec::new());
    for i in 0..archive.len() {
        let entry = archive.by_index_raw(i).map_err(zipped)?;
        let name = entry.name().map_err(zipped)?.into_owned();
        match parts_of(&name)[..] {
            _ if entry.unix_mode().is_some_and(is_special) => {
                return Err(none(format!("{name:?} is neither a file nor a folder")));
            }
            [case] if is_case(case) && !entry.is_dir() => cases.push(case.to_owned()),
            [FILES, ..] => {}
            _ => return Err(none(format!("{name:?} is no part of a package"))),
        }
        total = total.saturating_add(entry.size());
    }
    let limit = (FREE_BYTES + package_bytes.saturating_mul(MAX_RATIO)).min(MAX_BYTES);
    if total > limit {
        let [total, limit] = [total, limit].map(|bytes| bytes >> 20);
        return Err(none(format!("it unpacks to {total} MiB, expected {limit} MiB at the most")));
    }
    if archive.has_overlapping_files().map_err(zipped)? {
        return Err(none("files in it share their bytes".to_owned()));
    }
    match &cases[..] {
        [case] => Ok(case.clone()),
        [] => Err(none("it has no case".to_owned())),
        _ => Err(none("it has several cases".to_owned())),
    }
}

/// Whether [`unpack`] takes a file of this name.
fn can_be_unpacked(name: &str) -> bool {
    !parts_of(name).is_empty()
}

/// The parts of a name in a package; none if it leads anywhere but down.
fn parts_of(name: &str) -> Vec<&str> {
    let parts: Vec<&str> = name.strip_suffix('/').unwrap_or(name).split('/').collect();
    let is_plain = |part: &&str| {
        let means_more = |c: char| matches!(c, '\\' | '\0') || (cfg!(windows) && c == ':');
        !matches!(*part, "" | "." | "..") && !part.contains(means_more)
    };
    if parts.iter().all(is_plain) { parts } else { Vec::new() }
}

fn is_case(name: &str) -> bool {
    Path::new(name).extension().is_some_and(|ending| ending == CASE_ENDING)
}

/// Whether the mode of a file is that of a link, a pipe or a device.
fn is_special(mode: u32) -> bool {
    !matches!(mode & 0o170_000, 0 | 0o100_000 | 0o040_000)
}

/// Unpacks one file of a package that was checked.
///
/// - `staging`, `place`: the folder into which it is unpacked, and the one that this becomes.
fn extract(
    archive: &mut ZipArchive<impl Read + Seek>,
    i: usize,
    [staging, place]: [&Path; 2],
    package: &Path,
) -> Result<(), CaseError> {
    let zipped = |source| CaseError::Zip { path: package.to_owned(), source };
    let entry = archive.by_index(i).map_err(zipped)?;
    let name = entry.name().map_err(zipped)?.into_owned();
    let below: PathBuf = parts_of(&name).iter().collect();
    let to = staging.join(&below);
    let io = |source| CaseError::Io { path: place.join(&below), source };
    if entry.is_dir() {
        return fs::create_dir_all(&to).map_err(io);
    }
    fs::create_dir_all(to.parent().unwrap_or(staging)).map_err(io)?;
    let mut out = File::create_new(&to).map_err(io)?;
    let size = entry.size();
    // One byte beyond the size that was checked is enough to see that it is wrong.
    let copied = io::copy(&mut entry.take(size.saturating_add(1)), &mut out);
    let is_damaged = match &copied {
        Ok(n) => *n != size,
        Err(error) => error.raw_os_error().is_none(),
    };
    if is_damaged {
        let why = format!("{name:?} is damaged, or not as large as it says");
        return Err(CaseError::NoPackage { path: package.to_owned(), why });
    }
    copied.map_err(io)?;
    out.sync_all().map_err(io)
}

/// Removes the folders that killed runs were unpacking into; those of living ones are locked.
fn sweep_staging(parent: &Path) {
    for entry in fs::read_dir(parent).into_iter().flatten().flatten() {
        let is_staging = entry.file_name().to_string_lossy().starts_with(STAGING)
            && entry.file_type().is_ok_and(|kind| kind.is_dir());
        if is_staging && let Ok(_lock) = WriterLock::lock_file(&entry.path().join(UNPACKED)) {
            // One that cannot be removed stands in nobody's way.
            let _ = fs::remove_dir_all(entry.path());
        }
    }
}
