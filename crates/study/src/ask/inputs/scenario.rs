//! Which scenario a question is about.

use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::ask::checks::check_all;
use crate::{InputKind, StudyError};
use impactlab_core::collision::{SCENARIO_PRESETS, Scenario, ScenarioError};

/// A scenario: a file, or one that is in memory.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ScenarioChoice {
    /// A scenario file, or the name of a scenario that comes with the program.
    File(PathBuf),
    /// The scenario itself.
    Inline(Box<Scenario>),
}

impl ScenarioChoice {
    /// The scenario.
    ///
    /// # Errors
    /// [`StudyError::TomlFile`], with line and column.
    pub fn load(&self) -> Result<Scenario, StudyError> {
        match self {
            Self::File(path) => InputKind::Scenario.explain(path, Scenario::preset_or_file(path)),
            Self::Inline(scenario) => Ok(scenario.as_ref().clone()),
        }
    }

    /// The scenario that is in memory; `None` for a file.
    pub fn inline(&self) -> Option<&Scenario> {
        match self {
            Self::File(_) => None,
            Self::Inline(scenario) => Some(scenario),
        }
    }

    /// The same, to be edited.
    pub fn inline_mut(&mut self) -> Option<&mut Scenario> {
        match self {
            Self::File(_) => None,
            Self::Inline(scenario) => Some(scenario),
        }
    }

    /// Checks every number of a scenario that stands in the question; a file is checked when it is
    /// read.
    pub(crate) fn check(&self) -> Result<(), StudyError> {
        match self {
            Self::File(_) => Ok(()),
            Self::Inline(scenario) => check_all(scenario.ranges()),
        }
    }

    /// The scenario file; `None` for a scenario that is in memory or part of the program.
    pub fn file(&self) -> Option<&Path> {
        match self {
            Self::File(path) => {
                let is_preset = SCENARIO_PRESETS.iter().any(|(name, _)| Path::new(name) == path);
                (!is_preset).then_some(path)
            }
            Self::Inline(_) => None,
        }
    }

    /// Refuses a scenario in which a vehicle meets an object that does not move: networks know two cars.
    ///
    /// # Errors
    /// [`StudyError::FixedPartner`], and those of [`ScenarioChoice::load`].
    pub(crate) fn refuse_fixed(&self) -> Result<(), StudyError> {
        match self.load()?.striking.fixed {
            Some(object) => {
                Err(StudyError::FixedPartner { name: self.name(), object: object.word() })
            }
            None => Ok(()),
        }
    }

    /// The error of a scenario that has no solution.
    pub(crate) fn unsolved(&self, source: ScenarioError) -> StudyError {
        StudyError::Scenario { name: self.name(), source }
    }

    /// The file, or the name of the scenario, for messages.
    pub fn name(&self) -> String {
        match self {
            Self::File(path) => path.display().to_string(),
            Self::Inline(scenario) => scenario.name.clone(),
        }
    }
}

impl From<&Path> for ScenarioChoice {
    fn from(path: &Path) -> Self {
        Self::File(path.to_owned())
    }
}
