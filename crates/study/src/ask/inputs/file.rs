//! Single files of time series.

use std::path::PathBuf;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use impactlab_core::data::ColumnMap;

/// A file of time series and which of its columns is what.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SeriesFile {
    /// The file.
    pub path: PathBuf,
    /// The user's columns; without them, the header says.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub map: Option<ColumnMap>,
}

impl SeriesFile {
    /// A file whose header says which column is what.
    pub fn new(path: impl Into<PathBuf>) -> Self {
        Self { path: path.into(), map: None }
    }

    /// The file's name without its ending, for titles.
    pub(crate) fn title(&self) -> String {
        let stem = self.path.file_stem().unwrap_or(self.path.as_os_str());
        stem.to_string_lossy().into_owned()
    }
}
