//! Temporary files beside the file that they become, and what killed writes have left of them.

use std::fs::{self, File};
use std::io;
use std::path::Path;

use tempfile::{Builder, NamedTempFile};

/// Part of the name of everything that is there only while something is written.
pub(super) const MARK: &str = "impactlab";

/// End of the name of a temporary file.
const ENDING: &str = ".tmp";

/// Longest part of a file's name that its temporary file repeats, bytes; with the mark and the
/// ending it stays below the 255 bytes that file systems allow.
const MAX_REPEATED_BYTES: usize = 200;

/// Makes a temporary file for a target, locked as long as it is open.
///
/// - `is_new`: whether there is no such file yet. Until it has the permissions of one that it replaces,
///   nobody but the user may read it.
pub(super) fn temporary_file(
    folder: &Path,
    target: &Path,
    is_new: bool,
) -> io::Result<NamedTempFile> {
    loop {
        let prefix = prefix(target);
        let mut builder = Builder::new();
        builder.prefix(&prefix).suffix(ENDING);
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // The umask takes from these what it takes from every new file.
            let bits = if is_new { 0o666 } else { 0o600 };
            builder.permissions(fs::Permissions::from_mode(bits));
        }
        #[cfg(not(unix))]
        let _ = is_new;
        let file = builder.tempfile_in(folder)?;
        // A file system without locks has no sweeping either.
        let is_locked = file.as_file().lock().is_ok();
        if !is_locked || is_at(file.as_file(), file.path()) {
            return Ok(file);
        }
        // Another write took it for a leftover before it was locked.
    }
}

/// Removes the temporary files that killed writes of a target have left. Those of living writers
/// are locked and stay. What cannot be removed stays too: it stands in nobody's way.
pub(super) fn sweep(folder: &Path, target: &Path) {
    let prefix = prefix(target);
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let is_temporary = name.starts_with(&prefix) && name.ends_with(ENDING);
        if !is_temporary || !entry.file_type().is_ok_and(|kind| kind.is_file()) {
            continue;
        }
        let Ok(file) = File::open(entry.path()) else { continue };
        if file.try_lock().is_ok() {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Beginning of the names of a target's temporary files.
fn prefix(target: &Path) -> String {
    let name = target.file_name().unwrap_or_default().to_string_lossy();
    format!(".{}.{MARK}-", &name[..name.floor_char_boundary(MAX_REPEATED_BYTES)])
}

/// Whether an open file is still the one that its path leads to.
pub(super) fn is_at(file: &File, path: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        let (Ok(open), Ok(found)) = (file.metadata(), fs::symlink_metadata(path)) else {
            return false;
        };
        (open.dev(), open.ino()) == (found.dev(), found.ino())
    }
    #[cfg(not(unix))]
    {
        let _ = file;
        path.exists()
    }
}
