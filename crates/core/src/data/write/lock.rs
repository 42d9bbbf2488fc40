//! Keeps two writers of one file or folder apart.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use crate::data::DataError;
use crate::data::write::temporary::{MARK, is_at};
use crate::data::write::{Existing, WriteError, check_target};

/// Number of times that a lock file is opened anew because its holder removed it meanwhile.
const MAX_ATTEMPTS: usize = 100;

/// The right to write a file or a folder, held until it is dropped or the process ends, however it
/// ends.
///
/// It is a lock of the operating system on a small file that holds the number of the process. The
/// file is removed with the lock; what a killed process leaves of it is taken over by the next
/// writer. In a file system without locks nobody is kept apart.
#[derive(Debug)]
pub struct WriterLock {
    path: PathBuf,
    /// Open, and so locked, as long as the lock is held.
    _file: File,
}

impl WriterLock {
    /// Takes the lock of a file, which need not exist. The lock file is beside it.
    ///
    /// # Errors
    /// [`WriteError::InUse`] within [`DataError::Write`] if somebody else holds it, with the number
    /// of the process; [`WriteError::Io`] if the lock file cannot be made.
    pub fn lock_file(target: &Path) -> Result<Self, DataError> {
        let name = target.file_name().unwrap_or_default().to_string_lossy();
        let path = target.with_file_name(format!(".{name}.{MARK}-lock"));
        Ok(Self::take(path, target)?)
    }

    /// Takes the right to replace a file again and again while a long computation goes on, and says before
    /// it begins what stands in the way.
    ///
    /// # Errors
    /// As for [`check_target`] and [`WriterLock::lock_file`].
    pub fn claim_checkpoint(target: &Path) -> Result<Self, DataError> {
        check_target(target, Existing::Replace)?;
        Self::lock_file(target)
    }

    /// Takes the lock of a folder, which must exist. The lock file is in it.
    ///
    /// # Errors
    /// As for [`WriterLock::lock_file`].
    pub(super) fn lock_folder(folder: &Path) -> Result<Self, WriteError> {
        Self::take(folder.join(format!(".{MARK}-lock")), folder)
    }

    fn take(path: PathBuf, target: &Path) -> Result<Self, WriteError> {
        for _ in 0..MAX_ATTEMPTS {
            let found = fs::symlink_metadata(&path);
            if found.is_ok_and(|found| !found.is_file()) {
                return Err(WriteError::NotAFile { path, kind: "thing that is no lock" });
            }
            let mut options = OpenOptions::new();
            options.read(true).write(true).create(true).truncate(false);
            let mut file = options.open(&path).map_err(WriteError::io(&path))?;
            match file.try_lock() {
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => {
                    let (path, process) = (target.to_owned(), process_in(&mut file));
                    return Err(WriteError::InUse { path, process });
                }
                Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => {}
                Err(TryLockError::Error(error)) => return Err(WriteError::io(&path)(error)),
            }
            if !is_at(&file, &path) {
                continue;
            }
            let written = file.set_len(0).and_then(|()| write!(file, "{}", std::process::id()));
            written.map_err(WriteError::io(&path))?;
            return Ok(Self { path, _file: file });
        }
        Err(WriteError::InUse { path: target.to_owned(), process: None })
    }
}

impl Drop for WriterLock {
    /// Removes the file while it is still locked, so that nobody else's lock is removed.
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.path);
    }
}

/// The number of the process that a lock file names.
fn process_in(file: &mut File) -> Option<u32> {
    let mut text = String::new();
    file.take(32).read_to_string(&mut text).ok()?;
    text.trim().parse().ok()
}
