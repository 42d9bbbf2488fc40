//! Shadows of cars on the ground.

use egui::Color32;

use crate::scene::Projection;
use crate::scene::cars::SeenCar;
use crate::scene::lines::{Rows, over};
use impactlab_core::collision::Pose;

/// Darkness of a shadow in the light and in the dark theme.
const OPACITY: [f32; 2] = [0.34, 0.55];
/// Width of the soft edge on either side of the outline, m.
pub const SHADOW_EDGE_M: f64 = 0.45;
/// How far the sun moves a shadow, m.
const SHIFT_M: [f64; 2] = [0.22, 0.26];

/// The shadow of a car.
#[derive(Debug, Clone, Copy)]
pub struct Shadow {
    /// Its middle and its direction.
    pub pose: Pose,
    /// Half its length and half its width, m.
    pub half_m: [f64; 2],
    /// Lowest and highest `[x, y]` in the picture.
    pub bounds: [[f64; 2]; 2],
}

/// Darkness of shadows, 0 to 1.
pub fn shadow_opacity(dark: bool) -> f32 {
    OPACITY[usize::from(dark)]
}

impl Shadow {
    /// The shadow of a car; `None` where part of it is behind the camera, and below a car that is not
    /// opaque.
    pub fn new(seen: &SeenCar<'_>, projection: &Projection) -> Option<Self> {
        if seen.opacity < 1.0 {
            return None;
        }
        let (body, state) = (&seen.car.shape.body, &seen.state);
        let middle = state.pose.world_from_body([body.front_m - body.length_m / 2.0, 0.0]);
        let pose = Pose {
            x_m: middle[0] + SHIFT_M[0],
            y_m: middle[1] + SHIFT_M[1],
            yaw_rad: state.pose.yaw_rad,
        };
        let half_m = [body.length_m / 2.0, body.width_m / 2.0];
        let mut bounds = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        for signs in [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]] {
            let corner = std::array::from_fn(|i| signs[i] * (half_m[i] + SHADOW_EDGE_M));
            let [x, y] = pose.world_from_body(corner);
            let at = projection.project([x, y, 0.0])?;
            for axis in 0..2 {
                bounds[0][axis] = bounds[0][axis].min(at[axis]);
                bounds[1][axis] = bounds[1][axis].max(at[axis]);
            }
        }
        Some(Self { pose, half_m, bounds })
    }
}

/// Darkens the ground under a car.
pub fn draw_shadow(rows: &mut Rows<'_>, shadow: &Shadow, projection: &Projection, dark: bool) {
    let (map, target) = (projection.ground_map(), projection.target_m());
    let [low, high] = shadow.bounds;
    let last = (rows.first + rows.n_rows()) as f64;
    let from = low[1].floor().clamp(rows.first as f64, last) as usize;
    let to = high[1].ceil().clamp(rows.first as f64, last) as usize;
    let limit = rows.width as f64;
    let columns =
        low[0].floor().clamp(0.0, limit) as usize..high[0].ceil().clamp(0.0, limit) as usize;
    let (sin, cos) = shadow.pose.yaw_rad.sin_cos();
    let opacity = shadow_opacity(dark);
    for row in from..to {
        for column in columns.clone() {
            let (px, py) = (column as f64 + 0.5, row as f64 + 0.5);
            let [x, y, d] = map.map(|row| row[0] + row[1] * px + row[2] * py);
            if d <= 0.0 {
                continue;
            }
            let off = [x / d + target[0] - shadow.pose.x_m, y / d + target[1] - shadow.pose.y_m];
            let own = [off[0] * cos + off[1] * sin, off[1] * cos - off[0] * sin];
            let beyond: [f64; 2] =
                std::array::from_fn(|i| own[i].abs() - shadow.half_m[i] + SHADOW_EDGE_M);
            let distance =
                beyond[0].max(0.0).hypot(beyond[1].max(0.0)) + beyond[0].max(beyond[1]).min(0.0);
            let share = (1.0 - distance / (2.0 * SHADOW_EDGE_M)).clamp(0.0, 1.0);
            let share = share * share * (3.0 - 2.0 * share);
            let idx = (row - rows.first) * rows.width + column;
            if let Some(pixel) = rows.pixels.get_mut(idx) {
                *pixel = over(*pixel, Color32::BLACK, opacity * share as f32);
            }
        }
    }
}
