//! How a reconstruction is shown, which is saved between runs.

use serde::{Deserialize, Serialize};

use crate::app::scene::SceneSettings;
use impactlab_reconstruct::ReconstructedQuantity;

/// How a reconstruction is shown.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ReconstructionView {
    /// The quantity whose distribution is drawn.
    pub quantity: ReconstructedQuantity,
    /// The quantity that is drawn against it.
    pub against: ReconstructedQuantity,
    /// Whether the scene has the cars as bodies instead of the plan in which evidence is placed.
    pub shows_cars: bool,
    /// From where these cars are seen.
    pub scene: SceneSettings,
    /// Whether several courses of events stand side by side instead of in one scene.
    pub courses_side_by_side: bool,
}

impl Default for ReconstructionView {
    fn default() -> Self {
        Self {
            quantity: ReconstructedQuantity::StruckSpeed,
            against: ReconstructedQuantity::RoadFriction,
            shows_cars: false,
            scene: SceneSettings::default(),
            courses_side_by_side: true,
        }
    }
}
