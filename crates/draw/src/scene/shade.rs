//! Colours of roles and materials, and the light that falls on them.

use egui::Color32;

use crate::theme;
use impactlab_document::scene::{GroundLineKind, SceneRole, Surface};

/// Direction to the sun, of unit length: from behind and from the right of a car that drives along X.
pub const SUN: [f64; 3] = [-0.355, -0.413, 0.839];
/// Share of the light that comes from everywhere, and from the sun.
pub const AMBIENT: f64 = 0.58;
pub const DIFFUSE: f64 = 0.52;
/// Share that what is turned away from the sun lacks.
pub const AWAY: f64 = 0.10;
/// How far the colour of a role is mixed with grey where it covers a body.
const BODY_GREY: f32 = 0.16;

/// A colour of 8 bits each for red, green and blue.
pub type Rgb = [u8; 3];

/// Colour of a role, for lines and labels.
pub fn role_color(role: SceneRole, dark: bool) -> Color32 {
    match role.in_plots() {
        Some(role) => theme::color(role, dark),
        None if role == SceneRole::Crush => crush_color(dark),
        None => mark_color(dark),
    }
}

/// Colour of rubber on the ground where it is darkest: black on the light ground; chalk on the dark one,
/// on which black is not seen.
pub fn mark_color(dark: bool) -> Color32 {
    if dark { Color32::from_rgb(196, 188, 176) } else { Color32::from_rgb(28, 28, 30) }
}

/// Colour of dented outlines, which stands out from every body and from the ground.
fn crush_color(dark: bool) -> Color32 {
    if dark { Color32::from_rgb(252, 250, 240) } else { Color32::from_rgb(12, 12, 14) }
}

/// Colour of the ground.
pub fn ground_color(dark: bool) -> Color32 {
    if dark { Color32::from_rgb(38, 41, 44) } else { Color32::from_rgb(236, 238, 239) }
}

/// Share of the colour of the ground over its picture, so that what lies on it stays clear.
pub fn picture_wash(dark: bool) -> f32 {
    if dark { 0.42 } else { 0.30 }
}

/// Colour of a lane where there is no picture.
pub fn lane_color(dark: bool) -> Color32 {
    if dark { Color32::from_rgb(55, 58, 62) } else { Color32::from_rgb(216, 219, 222) }
}

/// Colour of a zone of friction: the yellow of the palette of the theme, which nothing else has.
pub fn zone_color(dark: bool) -> Color32 {
    if dark { Color32::from_rgb(240, 228, 66) } else { Color32::from_rgb(122, 106, 0) }
}

/// Colour of a line on the ground.
pub fn ground_line_color(kind: GroundLineKind, dark: bool) -> Color32 {
    let (light_ground, dark_ground) = match kind {
        GroundLineKind::Marking => ([255, 255, 255], [196, 199, 202]),
        GroundLineKind::Kerb => ([158, 161, 164], [112, 116, 120]),
        GroundLineKind::Drawing | GroundLineKind::Surveyed => ([96, 102, 110], [150, 156, 163]),
    };
    let [r, g, b] = if dark { dark_ground } else { light_ground };
    Color32::from_rgb(r, g, b)
}

/// Colour of the sky above the horizon.
pub fn sky_color(dark: bool) -> Color32 {
    if dark { Color32::from_rgb(24, 26, 29) } else { Color32::from_rgb(250, 251, 252) }
}

/// Colour of the lines of the grid: fine and coarse.
pub fn grid_colors(dark: bool) -> [Color32; 2] {
    match dark {
        true => [Color32::from_rgb(50, 54, 58), Color32::from_rgb(68, 73, 78)],
        false => [Color32::from_rgb(225, 228, 230), Color32::from_rgb(204, 209, 213)],
    }
}

/// Colour of the disc of a wheel that is locked.
pub const LOCKED_COLOR: Rgb = [214, 39, 70];

/// Colour of a material of a car.
///
/// - `is_locked`: of the wheel, for its disc.
pub fn surface_color(surface: Surface, body: Rgb, is_locked: bool) -> Rgb {
    match surface {
        Surface::Hub | Surface::HubGap if is_locked => LOCKED_COLOR,
        surface => surface.rgb(body),
    }
}

/// Colour of a body.
pub fn body_color(role: SceneRole, dark: bool) -> Rgb {
    let color = role_color(role, dark);
    let grey = if dark { 130.0 } else { 165.0 };
    [color.r(), color.g(), color.b()]
        .map(|v| (f32::from(v) * (1.0 - BODY_GREY) + grey * BODY_GREY).round() as u8)
}

/// A colour in the light of the sun.
///
/// - `normal`: of unit length, in world axes.
pub fn lit(color: Rgb, normal: [f64; 3]) -> Rgb {
    let toward: f64 = (0..3).map(|i| normal[i] * SUN[i]).sum();
    // What is turned away from the sun is darkened less the more it is turned up.
    let light = AMBIENT + DIFFUSE * toward.max(0.0) + AWAY * toward.min(0.0);
    color.map(|v| (f64::from(v) * light).round().clamp(0.0, 255.0) as u8)
}

/// A colour of a share of another over it.
pub fn mixed(under: Color32, over: Color32, share: f32) -> Color32 {
    let mix = |a: u8, b: u8| (f32::from(a) + (f32::from(b) - f32::from(a)) * share).round() as u8;
    Color32::from_rgb(mix(under.r(), over.r()), mix(under.g(), over.g()), mix(under.b(), over.b()))
}
