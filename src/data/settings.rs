//! Settings from TOML files.

use std::path::Path;

use serde::de::DeserializeOwned;

use crate::data::{TomlError, TomlFile};

/// Reads settings from a TOML file; what the file does not name keeps its default.
///
/// # Errors
/// [`TomlError`], with the place in the file.
pub fn read_settings<T: DeserializeOwned>(path: &Path) -> Result<T, TomlError> {
    TomlFile { path, text: &TomlFile::read(path)? }.to()
}
