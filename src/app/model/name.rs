//! Names of files for a person.

use std::path::Path;

/// Returns the last component of a path, as text.
pub fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}
