//! A folder of files that belong together, written whole or not at all.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use tempfile::{Builder, TempDir};

use crate::data::DataError;
use crate::data::write::file::{Target, sync_folder};
use crate::data::write::manifest::earlier_files;
use crate::data::write::{
    Existing, FileDigest, MANIFEST_FILE, Manifest, RunRecord, WriteError, WriterLock, check_inputs,
    write_atomically,
};

/// Beginning and end of the names of staging folders.
pub(super) const STAGING: [&str; 2] = [".impactlab-", ".tmp"];

/// A folder whose files are being made.
///
/// They are written into a staging folder in it, which nobody looks at. [`OutputFolder::finish`]
/// moves them to their places and writes the [`Manifest`] last. If anything fails before that, or
/// if the process is killed, the folder holds what it held before; what was left behind is removed
/// by the next run. As long as it lives, no other run writes into the folder.
#[derive(Debug)]
pub struct OutputFolder {
    folder: PathBuf,
    existing: Existing,
    started: SystemTime,
    staging: TempDir,
    /// Files that the results are computed from.
    inputs: Vec<PathBuf>,
    lock: WriterLock,
    _made: MadeFolders,
}

/// Folders that were made, the innermost first, and are removed again if they stay empty.
#[derive(Debug)]
struct MadeFolders(Vec<PathBuf>);

impl MadeFolders {
    /// Makes a folder and those above it that are missing.
    fn make(folder: &Path) -> io::Result<Self> {
        let is_missing = |path: &&Path| !path.as_os_str().is_empty() && !path.exists();
        let missing = folder.ancestors().take_while(is_missing).map(Path::to_owned).collect();
        fs::create_dir_all(folder)?;
        Ok(Self(missing))
    }
}

impl Drop for MadeFolders {
    fn drop(&mut self) {
        for folder in &self.0 {
            // Refused by the system unless the folder is empty.
            let _ = fs::remove_dir(folder);
        }
    }
}

impl OutputFolder {
    /// Prepares a folder, which is made if it is not there. To be called before the work begins,
    /// so that nothing is computed that cannot be written.
    ///
    /// - `existing`: what happens to files of an earlier run. What that run has not written, or
    ///   somebody has changed since, is never replaced: nobody has named it, as the folder was named;
    /// - `known`: names that will be written, as far as they are known yet;
    /// - `inputs`: files that the results are computed from, which are neither replaced nor removed as
    ///   those of an earlier run.
    ///
    /// # Errors
    /// [`WriteError`] within [`DataError::Write`]: files of an earlier run that must not be
    /// replaced, files of the same names that are none of it, inputs, a folder that another process
    /// is writing, and the errors of the operating system.
    pub fn begin(
        folder: &Path,
        existing: Existing,
        known: &[&str],
        inputs: Vec<PathBuf>,
    ) -> Result<Self, DataError> {
        if folder.exists() && !folder.is_dir() {
            return Err(WriteError::NotAFolder { path: folder.to_owned() }.into());
        }
        if existing == Existing::Refuse && earlier_files(folder).is_some() {
            return Err(WriteError::HoldsResults { path: folder.to_owned() }.into());
        }
        let made = MadeFolders::make(folder).map_err(WriteError::io(folder))?;
        let lock = WriterLock::lock_folder(folder)?;
        sweep_staging(folder);
        let earlier = earlier_files(folder);
        let names = || known.iter().copied().chain([MANIFEST_FILE]);
        let of_earlier = earlier.iter().flatten().map(|file| file.name.as_str());
        for name in names().chain(of_earlier) {
            check_inputs(&folder.join(name), &inputs)?;
        }
        for name in names() {
            target_in(folder, name, earlier.as_deref())?;
        }
        let mut builder = Builder::new();
        let [prefix, suffix] = STAGING;
        let staging = builder.prefix(prefix).suffix(suffix).tempdir_in(folder);
        let staging = staging.map_err(WriteError::io(folder))?;
        let (folder, started) = (folder.to_owned(), SystemTime::now());
        Ok(Self { folder, existing, started, staging, inputs, lock, _made: made })
    }

    /// The staging folder, into which the files are to be written.
    pub fn staging(&self) -> &Path {
        self.staging.path()
    }

    /// Where a file of the staging folder will be.
    pub fn path_of(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// Moves the files to their places, removes files of an earlier run that this one has not
    /// written, unless somebody has changed them since, and writes the manifest.
    ///
    /// # Errors
    /// As for [`OutputFolder::begin`]. A file that must not be replaced is found before the first
    /// one is moved.
    pub fn finish(self, run: RunRecord) -> Result<(), DataError> {
        let (folder, existing) = (&self.folder, self.existing);
        let to_error = || WriteError::io(folder);
        let files = staged_files(self.staging.path()).map_err(to_error())?;
        let earlier = earlier_files(folder);
        let mut targets = Vec::with_capacity(files.len());
        for file in &files {
            check_inputs(&folder.join(&file.name), &self.inputs)?;
            targets.push(target_in(folder, &file.name, earlier.as_deref())?);
        }
        let earlier = earlier.unwrap_or_default();
        let manifest_path = folder.join(MANIFEST_FILE);
        let mut manifest = Manifest::new(run, self.started, files);

        // Says whose the files are if the process is killed before the last one is in place.
        let own = manifest.files.iter().chain(&earlier).cloned().collect();
        let partial = Manifest { complete: false, files: own, ..manifest.clone() };
        write_manifest(&manifest_path, existing, &partial)?;
        for (file, target) in manifest.files.iter().zip(&targets) {
            target.take_over(&self.staging.path().join(&file.name))?;
        }
        remove_stale(folder, &earlier, &manifest.files);
        sync_folder(folder).map_err(to_error())?;

        manifest.complete = true;
        write_manifest(&manifest_path, Existing::Replace, &manifest)?;
        drop((self.staging, self.lock));
        Ok(())
    }
}

/// The files in a staging folder in the order of their names.
fn staged_files(staging: &Path) -> io::Result<Vec<FileDigest>> {
    let mut files = Vec::new();
    for entry in fs::read_dir(staging)? {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        files.push(FileDigest::from_file(name, &entry.path())?);
    }
    files.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(files)
}

/// Where a file of the folder goes. One that is there already has to be as an earlier run has left it.
fn target_in(
    folder: &Path,
    name: &str,
    earlier: Option<&[FileDigest]>,
) -> Result<Target, WriteError> {
    let path = folder.join(name);
    let target = Target::find(&path, Existing::Replace)?;
    let is_own =
        earlier.is_some_and(|earlier| name == MANIFEST_FILE || is_as_left(&path, name, earlier));
    if target.is_new() || is_own { Ok(target) } else { Err(WriteError::NotOfRun { path }) }
}

/// Whether a file is one of an earlier run, and nobody has changed it since.
fn is_as_left(path: &Path, name: &str, earlier: &[FileDigest]) -> bool {
    earlier.iter().any(|file| file.name == name)
        && FileDigest::from_file(name, path).is_ok_and(|found| earlier.contains(&found))
}

fn write_manifest(path: &Path, existing: Existing, manifest: &Manifest) -> Result<(), DataError> {
    write_atomically(path, existing, |out| {
        serde_json::to_writer_pretty(&mut *out, manifest)?;
        writeln!(out)
    })
}

/// Removes files of an earlier run that are as that run has left them and not of this one.
fn remove_stale(folder: &Path, earlier: &[FileDigest], written: &[FileDigest]) {
    let is_written = |name: &str| written.iter().any(|file| file.name == name);
    for file in earlier.iter().filter(|file| !is_written(&file.name)) {
        let path = folder.join(&file.name);
        let is_plain = path.symlink_metadata().is_ok_and(|found| found.is_file());
        if is_plain
            && FileDigest::from_file(file.name.as_str(), &path).is_ok_and(|found| found == *file)
        {
            // What cannot be removed is listed no longer and so is the user's from now on.
            let _ = fs::remove_file(path);
        }
    }
}

/// Removes the staging folders of killed runs. To be called by the holder of the folder's lock, so
/// that no living run has one.
fn sweep_staging(folder: &Path) {
    let [prefix, suffix] = STAGING;
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let is_folder = entry.file_type().is_ok_and(|kind| kind.is_dir());
        if is_folder && name.starts_with(prefix) && name.ends_with(suffix) {
            let _ = fs::remove_dir_all(entry.path());
        }
    }
}
