//! Which trained network answers.

use std::fmt;
use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use impactlab_networks::shipped::ModelSource;

/// A trained network.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum ModelChoice {
    /// One that comes with the program, or a file.
    Source(ModelSource),
    /// One that stands in no file, such as one just trained.
    Held {
        /// What it is called in the [`Library`](crate::Library) that holds it.
        held: String,
    },
}

impl ModelChoice {
    /// One that the library holds under this name.
    pub fn held(name: impl Into<String>) -> Self {
        Self::Held { held: name.into() }
    }

    /// A model file.
    pub fn file(path: impl Into<PathBuf>) -> Self {
        Self::Source(ModelSource::File(path.into()))
    }

    /// Whether an answer that names its network so is one of the default network, which alone was measured.
    pub fn is_default(name: &str) -> bool {
        name == Self::default().to_string()
    }

    /// The file that it stands in, if it is one of the user.
    pub fn path(&self) -> Option<&Path> {
        match self {
            Self::Source(ModelSource::File(path)) => Some(path),
            Self::Source(_) | Self::Held { .. } => None,
        }
    }
}

impl Default for ModelChoice {
    fn default() -> Self {
        Self::Source(ModelSource::Shipped)
    }
}

impl From<ModelSource> for ModelChoice {
    fn from(source: ModelSource) -> Self {
        Self::Source(source)
    }
}

impl fmt::Display for ModelChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Source(source) => source.fmt(f),
            Self::Held { held } => f.write_str(held),
        }
    }
}
