//! Reads settings from TOML files.

use std::path::Path;

use serde::de::DeserializeOwned;

use crate::data::{TomlError, TomlFile};

/// Reads settings from a TOML file whose keys are the fields of `T`. A key that the file omits
/// keeps the default value that `T` has for it.
///
/// # Errors
/// [`TomlError::Read`] if the file cannot be read, and [`TomlError::Syntax`], with the place in the
/// file, if it is not TOML, has keys unknown to `T` or lacks required ones, or has values of the
/// wrong kind.
pub fn read_settings<T: DeserializeOwned>(path: &Path) -> Result<T, TomlError> {
    TomlFile { path, text: &TomlFile::read(path)? }.to()
}
