//! The grid on the ground, and how far its lines cover a pixel.

use crate::scene::Projection;
use crate::scene::ground::Ground;
use crate::scene::row_map::{RowMap, Spot};
use impactlab_core::units::{Quantity, UnitSystem};

/// Least distance of coarse grid lines, points.
const COARSE_POINTS: f64 = 84.0;
/// Fine lines between coarse ones.
const FINE_PER_COARSE: f64 = 5.0;
/// Distance of grid lines in the picture below which they fade, and at which they are gone, pixels.
pub const FADING_PIXELS: [f32; 2] = [9.0, 3.0];
/// Distances at which the ground begins to fade into the sky, and has done so, over the distance of the
/// point that is looked at.
const HAZE: [f64; 2] = [3.0, 14.0];

/// The distance of coarse grid lines that fits the picture: 1, 2 or 5 times a power of ten.
///
/// - returns it in the unit of the scene and in m.
pub fn grid_step(projection: &Projection, points: f64, units: UnitSystem) -> (f64, f64) {
    let unit = Quantity::Length.display_unit(units);
    let least = COARSE_POINTS * points / projection.pixels_per_m(projection.target_m());
    let wanted = unit.from_si(least).max(1e-6);
    let power = 10.0_f64.powf(wanted.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power);
    let step = steps.into_iter().find(|step| *step >= wanted).unwrap_or(wanted);
    (step, unit.to_si(step))
}

/// Numbers of the ground that are the same for every pixel; places are off the target, m.
pub struct Grid {
    /// The ground under pixels, as [`Projection::ground_map`].
    pub map: [[f32; 3]; 3],
    /// Coordinates of the target within a coarse cell, so that large coordinates lose no digits.
    pub phase_m: [f32; 2],
    /// Distances of fine and of coarse lines.
    pub steps_m: [f32; 2],
    /// Place of the camera.
    pub eye_m: [f32; 2],
    /// Distances at which the ground begins to fade into the sky, and has done so.
    pub haze_m: [f32; 2],
    /// Lowest and highest place of the density.
    pub density_m: Option<[[f32; 2]; 2]>,
}

impl Grid {
    /// The numbers of a ground.
    pub fn new(ground: &Ground<'_>) -> Self {
        let target = ground.projection.target_m();
        let (_, step_m) = grid_step(ground.projection, ground.points, ground.scene.units);
        let [x, y, z] = ground.projection.eye_m();
        let eye = [x - target[0], y - target[1]];
        let distance_m = eye[0].hypot(eye[1]).hypot(z);
        let density_m = ground.scene.density.as_ref().map(|density| {
            let grid = &density.map.grid;
            let [nx, ny] = grid.size.map(|n| n.saturating_sub(1) as f64);
            let low = [grid.low_m[0] - target[0], grid.low_m[1] - target[1]];
            let high = [low[0] + nx * grid.step_m[0], low[1] + ny * grid.step_m[1]];
            [low, high].map(|place| place.map(|value| value as f32))
        });
        Self {
            map: ground.projection.ground_map().map(|row| row.map(|value| value as f32)),
            phase_m: target.map(|value| value.rem_euclid(step_m) as f32),
            steps_m: [step_m / FINE_PER_COARSE, step_m].map(|step| step as f32),
            eye_m: eye.map(|value| value as f32),
            haze_m: HAZE.map(|factor| (factor * distance_m) as f32),
            density_m,
        }
    }

    /// How far fine and coarse lines across an axis cover a pixel, 0 to 1.
    #[inline(always)]
    pub fn cover(&self, axis: usize, map: &RowMap, spot: &Spot) -> [f32; 2] {
        let (at, change) = (spot.place[axis] + self.phase_m[axis], map.change(spot, axis));
        let [fine_m, coarse_m] = self.steps_m;
        [line_cover(at, change, fine_m), line_cover(at, change, coarse_m)]
    }
}

/// How far a line of the grid covers a pixel, 0 to 1.
///
/// - `at`: coordinate of the pixel, m; `change`: by how much it changes over a pixel, m, more than 0.
#[inline(always)]
pub fn line_cover(at: f32, change: f32, step_m: f32) -> f32 {
    let (cell, per) = (at / step_m, step_m / change);
    let distance = (cell - cell.round()).abs() * per;
    let [full, gone] = FADING_PIXELS;
    let cover = (1.0 - distance) * ((per - gone) / (full - gone)).clamp(0.0, 1.0);
    if distance >= 1.0 { 0.0 } else { cover }
}
