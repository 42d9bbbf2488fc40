//! Settings from TOML files.

use std::path::Path;

use serde::de::DeserializeOwned;

/// Settings from a TOML file.
///
/// # Errors
/// Why not, with the line where the file is at fault.
pub fn read_settings<T: DeserializeOwned>(path: &Path) -> Result<T, String> {
    let text = std::fs::read_to_string(path).map_err(|error| error.to_string())?;
    toml::from_str(&text).map_err(|error| {
        let line = error.span().map_or(1, |span| {
            1 + text.get(..span.start).map_or(0, |before| before.matches('\n').count())
        });
        format!("line {line}: {}", error.message())
    })
}
