//! The names of the panes.

use serde::{Deserialize, Serialize};

/// A pane of the window. What it is called and how it is drawn stands in the list of panels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, strum::VariantArray)]
pub enum Pane {
    /// What the case consists of, and what is missing.
    Case,
    /// The data sets and files that are open, with the problems found in them.
    Data,
    /// The cases of the listed data set.
    Cases,
    /// The vehicles, the equations of motion and their integration.
    Vehicle,
    /// The scenario of two vehicles and its impulse solution.
    Scenario,
    /// The scene of the impact and the motion, seen from above.
    Scene,
    /// The motion over time.
    Motion,
    /// The contact force over time.
    Force,
    /// The simulation compared with the recorded motion.
    Comparison,
    /// The force history that the force network predicts.
    ForcePrediction,
    /// The predicted motion of the struck vehicle, with its uncertainty.
    MotionForecast,
    /// What was found after a collision, as the reconstruction takes it.
    Evidence,
    /// The evidence from above, with the paths that go with it.
    ReconstructedScene,
    /// What the evidence says of the speeds before the impact.
    Speeds,
    /// A calculation by hand.
    Hand,
    /// The replay of an event data recorder.
    Replay,
    /// The variants of the case side by side.
    Variants,
    /// Models in use, work under way, and what has been finished.
    Models,
    /// The training of either network.
    Training,
    /// The evaluation of the force network on a data set.
    Evaluation,
    /// The comparison of response models.
    ModelComparison,
    /// Settings and sections of the report.
    Report,
    /// The report as it will be written.
    ReportPages,
    /// Which outcome the map of an atlas shows over what, and where its other inputs stand.
    AtlasChoices,
    /// The map of an atlas.
    AtlasMap,
    /// Which input of an atlas moves the outcome most.
    Sensitivity,
    /// A sweep: one question many times.
    Sweep,
}

impl Pane {
    /// Every pane, in the order of the menu.
    pub const ALL: &'static [Self] = <Self as strum::VariantArray>::VARIANTS;

    /// Whether the pane shows nothing but the simulation of the subject.
    pub(in crate::app) fn is_answer(self) -> bool {
        matches!(self, Self::Scene | Self::Motion | Self::Force | Self::Comparison)
    }
}
