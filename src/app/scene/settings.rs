//! From where the scene is seen, which is saved.

use serde::{Deserialize, Serialize};

use impactlab_draw::scene::{Camera, Follow};

/// From where the scene is seen, which is saved.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SceneSettings {
    /// Kind of view and directions; the place follows the scene.
    pub camera: Camera,
    /// Which car stays in the middle.
    pub follow: Follow,
    /// Whether the forecast is shown: draws of it as ghosts, and where it ends.
    pub shows_forecast: bool,
    /// Whether the camera moves with the time between its keys.
    pub shows_keyed_camera: bool,
}
