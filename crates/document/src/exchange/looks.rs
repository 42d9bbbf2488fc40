//! Names and colours of what a scene shows, for formats that are drawn by other programs.

use crate::scene::{CarLook, SceneCar, SceneRole};

/// Name of a role, as it begins the names of layers and materials.
pub fn role_name(role: SceneRole) -> String {
    match role {
        SceneRole::Recorded => "RECORDED".to_owned(),
        SceneRole::Simulated => "SIMULATED".to_owned(),
        SceneRole::Forecast => "FORECAST".to_owned(),
        SceneRole::Striking => "STRIKING".to_owned(),
        SceneRole::Evidence => "EVIDENCE".to_owned(),
        SceneRole::Variant(idx) => format!("VARIANT_{}", idx + 1),
        SceneRole::Muted => "OTHER".to_owned(),
        SceneRole::TireMark => "TYRE_MARK".to_owned(),
        SceneRole::Crush => "CRUSH".to_owned(),
    }
}

/// Colour of a role, 8 bits each for red, green and blue, as in the light theme of the pictures.
pub fn role_rgb(role: SceneRole) -> [u8; 3] {
    match role {
        SceneRole::Simulated => [0, 114, 178],
        SceneRole::Forecast => [0, 158, 115],
        SceneRole::Striking => [213, 94, 0],
        SceneRole::Evidence => [170, 68, 136],
        SceneRole::Recorded => [60, 60, 60],
        SceneRole::Variant(_) => [140, 110, 40],
        SceneRole::Muted => [150, 150, 150],
        SceneRole::TireMark => [40, 40, 40],
        SceneRole::Crush => [190, 40, 40],
    }
}

/// Colour of a role in the index of AutoCAD (ACI).
pub fn role_aci(role: SceneRole) -> u8 {
    match role {
        SceneRole::Simulated => 5,
        SceneRole::Forecast => 3,
        SceneRole::Striking => 30,
        SceneRole::Evidence => 6,
        SceneRole::Recorded => 8,
        SceneRole::Variant(_) => 42,
        SceneRole::Muted => 9,
        SceneRole::TireMark => 250,
        SceneRole::Crush => 1,
    }
}

/// Whether a car is one of many draws of a forecast, of which only the paths are of use.
pub fn is_draw(car: &SceneCar) -> bool {
    car.look == CarLook::Ghost && car.role == SceneRole::Forecast && car.tag.is_empty()
}
