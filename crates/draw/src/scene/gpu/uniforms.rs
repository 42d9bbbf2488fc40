//! The numbers that all stages share, in the order of `common.wgsl`.

use egui::Color32;

use crate::scene::grid::{FADING_PIXELS, Grid};
use crate::scene::ground::{DENSITY_OPACITY, Ground, LEAST_DENSITY_SHARE};
use crate::scene::shade::{
    AMBIENT, AWAY, DIFFUSE, LOCKED_COLOR, grid_colors, ground_color, picture_wash, role_color,
    sky_color,
};
use crate::scene::shadow::{SHADOW_EDGE_M, shadow_opacity};
use crate::scene::underlay::{HATCH, Hatch, TINT};
use impactlab_document::scene::SceneRole;

/// Vectors of four numbers.
pub const N_VECTORS: usize = 21;

/// The numbers of a scene as its camera sees it.
///
/// - `size`: width and height of the picture, pixels.
pub fn uniforms(ground: &Ground<'_>, size: [usize; 2]) -> [[f32; 4]; N_VECTORS] {
    let (projection, dark) = (ground.projection, ground.dark);
    let grid = Grid::new(ground);
    let [width, height] = size.map(|side| side as f32);
    let [across, up] = projection.clip_per_m(size.map(|side| side as f64));
    let [map_x, map_y, map_d] = grid.map.map(|[a, b, c]| [a, b, c, 0.0]);
    let [low, high] = grid.density_m.unwrap_or_default();
    let is_parallel = f32::from(u8::from(projection.is_parallel()));
    let [fine, coarse] = grid_colors(dark);
    let hatch = Hatch::new(ground);
    let (picture_map, picture, last_level) = picture_of(ground);
    [
        [width, height, across as f32, up as f32],
        map_x,
        map_y,
        map_d,
        joined(grid.phase_m, grid.steps_m),
        joined(grid.eye_m, grid.haze_m),
        joined(low, high),
        density_of(ground),
        picture_map,
        picture,
        [hatch.step_m, hatch.phase_m, TINT, HATCH],
        [is_parallel, ground.grid_opacity(), picture_wash(dark), last_level],
        [shadow_opacity(dark), SHADOW_EDGE_M as f32, 0.0, 0.0],
        [FADING_PIXELS[0], FADING_PIXELS[1], LEAST_DENSITY_SHARE, 0.0],
        [AMBIENT as f32, DIFFUSE as f32, AWAY as f32, 0.0],
        shares(ground_color(dark)),
        shares(sky_color(dark)),
        shares(fine),
        shares(coarse),
        shares(role_color(SceneRole::Forecast, dark)),
        shares(Color32::from_rgb(LOCKED_COLOR[0], LOCKED_COLOR[1], LOCKED_COLOR[2])),
    ]
}

fn joined([a, b]: [f32; 2], [c, d]: [f32; 2]) -> [f32; 4] {
    [a, b, c, d]
}

fn shares(color: Color32) -> [f32; 4] {
    color.to_array().map(|value| f32::from(value) / 255.0)
}

/// Steps of the density, its largest value and its opacity there.
fn density_of(ground: &Ground<'_>) -> [f32; 4] {
    let density = ground.scene.density.as_ref().map(|density| {
        let [x, y] = density.map.grid.step_m.map(|step| step as f32);
        [x, y, density.peak as f32, DENSITY_OPACITY]
    });
    density.unwrap_or([1.0, 1.0, 1.0, 0.0])
}

/// Pixels of the picture of the ground per metre; its pixel under the point that is looked at, and its
/// size; the number of its smallest copy.
fn picture_of(ground: &Ground<'_>) -> ([f32; 4], [f32; 4], f32) {
    let picture = ground.scene.ground.as_deref().and_then(|site| site.picture.as_deref());
    let Some(picture) = picture else { return ([0.0; 4], [0.0; 4], 0.0) };
    let map = &picture.map;
    let [x, y] = [[1.0, 0.0], [0.0, 1.0]].map(|way| map.pixels_along(way).map(|v| v as f32));
    let target = map.pixel(ground.projection.target_m()).map(|value| value as f32);
    let size = picture.size().map(|side| side as f32);
    let last = picture.levels().len().saturating_sub(1) as f32;
    (joined(x, y), joined(target, size), last)
}
