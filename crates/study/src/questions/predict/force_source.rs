//! Where the force of a predicted motion comes from.

use std::path::PathBuf;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{ModelChoice, MotionSource};

/// Which force drives a motion.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ForceSource {
    /// What a force network says of the collision.
    Predicted(ModelChoice),
    /// That of the motion's own source: a record, or the pulse of a scenario.
    Given,
    /// A file.
    File(PathBuf),
}

impl ForceSource {
    /// The force where nobody says which: what was recorded, and of a scenario, of which nothing was, what
    /// the shipped network says.
    pub fn usual(source: &MotionSource) -> Self {
        match source {
            MotionSource::Scenario { .. } => Self::Predicted(ModelChoice::default()),
            MotionSource::Case { .. }
            | MotionSource::Trajectory { .. }
            | MotionSource::Drive(_) => Self::Given,
        }
    }
}
