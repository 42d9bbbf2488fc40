//! Where the evidence of a reconstruction comes from.

use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{InputKind, StudyError};
use impactlab_reconstruct::evidence::Evidence;

/// The evidence: a file, or in memory.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum EvidenceChoice {
    /// An evidence file.
    File(PathBuf),
    /// The evidence itself.
    Inline(Box<Evidence>),
}

impl EvidenceChoice {
    /// The evidence.
    ///
    /// # Errors
    /// [`StudyError::TomlFile`], with line and column; [`StudyError::IncompleteEvidence`] for a form that
    /// has not been filled in.
    pub fn load(&self) -> Result<Evidence, StudyError> {
        match self {
            Self::File(path) => InputKind::Evidence.explain(path, Evidence::load(path)),
            Self::Inline(evidence) => match evidence.missing() {
                None => Ok(evidence.as_ref().clone()),
                Some(missing) => Err(StudyError::IncompleteEvidence { name: self.name(), missing }),
            },
        }
    }

    /// The file, if it is one.
    pub fn file(&self) -> Option<&Path> {
        match self {
            Self::File(path) => Some(path),
            Self::Inline(_) => None,
        }
    }

    /// What messages call it: its file, or its case.
    pub(super) fn name(&self) -> String {
        match self {
            Self::File(path) => path.display().to_string(),
            Self::Inline(evidence) => evidence.case.clone(),
        }
    }
}
