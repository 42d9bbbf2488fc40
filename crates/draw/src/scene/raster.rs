//! Triangles on a tile of a picture, four samples a pixel, the nearest in front.

use egui::Color32;

use crate::scene::lines::over;

/// Side of a tile, pixels.
pub const TILE: usize = 64;
/// Samples along the side of a pixel.
const SAMPLES: usize = 2;
/// Samples along the side of a tile.
const SIDE: usize = TILE * SAMPLES;

/// A triangle in the picture: corners `[x, y, nearness]` with x and y in pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScreenTriangle {
    /// Corners, clockwise in the picture, whose y points down, or the other way round.
    pub corners: [[f32; 3]; 3],
    /// Colour.
    pub color: Color32,
}

/// Triangles that belong together.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Object {
    /// The triangles.
    pub triangles: Vec<ScreenTriangle>,
    /// Lowest and highest `[x, y]` of them, pixels.
    pub bounds: [[f32; 2]; 2],
    /// Opacity, 0 to 1. What is not opaque lets the ground shine through, shows its own front only, and
    /// lies behind everything that is opaque, so that this stays clear.
    pub opacity: f32,
}

impl Object {
    /// Empties the object without giving its memory back.
    pub fn clear(&mut self) {
        self.triangles.clear();
        self.bounds = [[f32::INFINITY; 2], [f32::NEG_INFINITY; 2]];
    }

    /// Adds a triangle.
    pub fn push(&mut self, triangle: ScreenTriangle) {
        let [low, high] = &mut self.bounds;
        for corner in &triangle.corners {
            for axis in 0..2 {
                low[axis] = low[axis].min(corner[axis]);
                high[axis] = high[axis].max(corner[axis]);
            }
        }
        self.triangles.push(triangle);
    }

    fn touches(&self, [x, y]: [usize; 2]) -> bool {
        let ([low, high], tile) = (self.bounds, TILE as f32);
        let (x, y) = (x as f32, y as f32);
        low[0] < x + tile && high[0] > x && low[1] < y + tile && high[1] > y
    }
}

/// The samples of a tile. It is used for one tile after the other.
pub struct Tile {
    colors: Vec<Color32>,
    depths: Vec<f32>,
    ghost_colors: Vec<Color32>,
    ghost_depths: Vec<f32>,
}

impl Default for Tile {
    fn default() -> Self {
        let (colors, depths) =
            (vec![Color32::BLACK; SIDE * SIDE], vec![f32::NEG_INFINITY; SIDE * SIDE]);
        Self { ghost_colors: colors.clone(), ghost_depths: depths.clone(), colors, depths }
    }
}

impl Tile {
    /// Draws objects over the pixels of a tile.
    ///
    /// - `rows`: pixels of whole rows, `width` each, the first of them at the top of the tile;
    /// - `at`: left top of the tile in the picture;
    /// - `objects`: the opaque ones first, then the others from far to near.
    pub fn draw(&mut self, rows: &mut [Color32], width: usize, at: [usize; 2], objects: &[Object]) {
        let mut touching = objects.iter().filter(|object| object.touches(at)).peekable();
        if touching.peek().is_none() {
            return;
        }
        self.load(rows, width, at[0]);
        for object in touching {
            if object.opacity >= 1.0 {
                let (colors, depths) = (&mut self.colors, &mut self.depths);
                for triangle in &object.triangles {
                    fill(colors, depths, triangle, at);
                }
            } else {
                self.draw_ghost(object, at);
            }
        }
        self.store(rows, width, at[0]);
    }

    fn load(&mut self, rows: &[Color32], width: usize, left: usize) {
        self.depths.fill(f32::NEG_INFINITY);
        for (row, samples) in rows.chunks(width).zip(self.colors.chunks_mut(SIDE * SAMPLES)) {
            let pixels = row.get(left..).unwrap_or_default().iter().take(TILE);
            let (first, second) = samples.split_at_mut(SIDE);
            for (column, pixel) in pixels.enumerate() {
                for line in [&mut *first, &mut *second] {
                    line[column * SAMPLES..(column + 1) * SAMPLES].fill(*pixel);
                }
            }
        }
    }

    fn store(&self, rows: &mut [Color32], width: usize, left: usize) {
        for (row, samples) in rows.chunks_mut(width).zip(self.colors.chunks(SIDE * SAMPLES)) {
            let (first, second) = samples.split_at(SIDE);
            let pixels = row.get_mut(left..).unwrap_or_default().iter_mut().take(TILE);
            for (column, pixel) in pixels.enumerate() {
                let at = column * SAMPLES;
                *pixel = mean([first[at], first[at + 1], second[at], second[at + 1]]);
            }
        }
    }

    fn draw_ghost(&mut self, object: &Object, at: [usize; 2]) {
        let [low, high] = object.bounds;
        let span = |axis: usize| {
            let from = (low[axis] - at[axis] as f32).max(0.0) * SAMPLES as f32;
            let to = (high[axis] - at[axis] as f32).clamp(0.0, TILE as f32) * SAMPLES as f32;
            (from as usize).min(SIDE)..(to.ceil() as usize).min(SIDE)
        };
        let (columns, rows) = (span(0), span(1));
        for row in rows.clone() {
            self.ghost_depths[row * SIDE..][columns.clone()].fill(f32::NEG_INFINITY);
        }
        for triangle in &object.triangles {
            fill(&mut self.ghost_colors, &mut self.ghost_depths, triangle, at);
        }
        for row in rows {
            for column in columns.clone() {
                let idx = row * SIDE + column;
                let is_seen = self.depths[idx] == f32::NEG_INFINITY;
                if is_seen && self.ghost_depths[idx] > f32::NEG_INFINITY {
                    let under = self.colors[idx];
                    self.colors[idx] = over(under, self.ghost_colors[idx], object.opacity);
                }
            }
        }
    }
}

fn mean(samples: [Color32; SAMPLES * SAMPLES]) -> Color32 {
    let mean = |channel: fn(&Color32) -> u8| {
        let sum: u32 = samples.iter().map(|sample| u32::from(channel(sample))).sum();
        ((sum + 2) / 4) as u8
    };
    Color32::from_rgb(mean(Color32::r), mean(Color32::g), mean(Color32::b))
}

/// Draws a triangle where it is nearer than what is there. A sample is covered if its middle is.
fn fill(colors: &mut [Color32], depths: &mut [f32], triangle: &ScreenTriangle, at: [usize; 2]) {
    let to_samples = |[x, y, depth]: [f32; 3]| {
        let sample_place =
            |value: f32, origin: usize| (value - origin as f32) * SAMPLES as f32 - 0.5;
        [sample_place(x, at[0]), sample_place(y, at[1]), depth]
    };
    let [a, b, c] = triangle.corners.map(to_samples);
    let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    // Not a number, too, is no area.
    let has_area = area.abs() > 1e-6;
    if !has_area {
        return;
    }
    // Nearness is linear in the picture.
    let along_x = ((b[2] - a[2]) * (c[1] - a[1]) - (c[2] - a[2]) * (b[1] - a[1])) / area;
    let along_y = ((c[2] - a[2]) * (b[0] - a[0]) - (b[2] - a[2]) * (c[0] - a[0])) / area;
    let side = SIDE as f32;
    let (top, bottom) = (a[1].min(b[1]).min(c[1]), a[1].max(b[1]).max(c[1]));
    let first = top.ceil().clamp(0.0, side) as usize;
    let end = (bottom.floor() + 1.0).clamp(0.0, side) as usize;
    for row in first..end {
        let y = row as f32;
        let [mut left, mut right] = [f32::INFINITY, f32::NEG_INFINITY];
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let (low, high) = if from[1] <= to[1] { (from, to) } else { (to, from) };
            if y < low[1] || y > high[1] {
                continue;
            }
            let rise = high[1] - low[1];
            if rise > 0.0 {
                let x = low[0] + (high[0] - low[0]) * ((y - low[1]) / rise);
                (left, right) = (left.min(x), right.max(x));
            } else {
                left = left.min(low[0]).min(high[0]);
                right = right.max(low[0]).max(high[0]);
            }
        }
        if left > right {
            continue;
        }
        let from = left.ceil().clamp(0.0, side) as usize;
        let to = (right.floor() + 1.0).clamp(0.0, side) as usize;
        let start = row * SIDE;
        let base = a[2] + (y - a[1]) * along_y - a[0] * along_x;
        for column in from..to {
            let (idx, depth) = (start + column, base + column as f32 * along_x);
            if depth > depths[idx] {
                depths[idx] = depth;
                colors[idx] = triangle.color;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(low: f32, high: f32, depth: f32, color: Color32) -> Object {
        let mut object = Object { opacity: 1.0, ..Object::default() };
        object.clear();
        let corner = |x, y| [x, y, depth];
        for corners in [
            [corner(low, low), corner(high, low), corner(high, high)],
            [corner(low, low), corner(high, high), corner(low, high)],
        ] {
            object.push(ScreenTriangle { corners, color });
        }
        object
    }

    fn drawn(objects: &[Object]) -> Vec<Color32> {
        let mut pixels = vec![Color32::BLACK; 100 * TILE];
        let mut tile = Tile::default();
        tile.draw(&mut pixels, 100, [0, 0], objects);
        tile.draw(&mut pixels, 100, [64, 0], objects);
        pixels
    }

    #[test]
    fn what_is_nearer_hides_what_is_behind_in_any_order() {
        let (far, near) =
            (square(5.0, 80.0, 1.0, Color32::RED), square(10.0, 50.0, 2.0, Color32::BLUE));
        let pixels = drawn(&[far.clone(), near.clone()]);
        assert_eq!(pixels, drawn(&[near, far]));
        let at = |x: usize, y: usize| pixels[y * 100 + x];
        assert_eq!([at(4, 30), at(5, 30)], [Color32::BLACK, Color32::RED]);
        assert_eq!(
            [at(9, 30), at(10, 30), at(49, 30)],
            [Color32::RED, Color32::BLUE, Color32::BLUE]
        );
        assert_eq!(
            [at(50, 30), at(79, 60), at(80, 60)],
            [Color32::RED, Color32::RED, Color32::BLACK]
        );
    }

    #[test]
    fn edges_are_smooth_and_parts_without_objects_are_left_alone() {
        let pixels = drawn(&[square(10.5, 20.0, 1.0, Color32::WHITE)]);
        let half = pixels[15 * 100 + 10].r();
        assert!((100..=156).contains(&half), "{half}");
        assert_eq!(pixels[15 * 100 + 70], Color32::BLACK);
    }

    #[test]
    fn a_ghost_shows_its_front_once_and_hides_behind_bodies() {
        let body = square(30.0, 60.0, 2.0, Color32::WHITE);
        let mut ghost = square(5.0, 40.0, 1.0, Color32::from_rgb(200, 0, 0));
        ghost.push(ScreenTriangle {
            corners: [[5.0, 5.0, 0.5], [40.0, 5.0, 0.5], [40.0, 40.0, 0.5]],
            color: Color32::GREEN,
        });
        ghost.opacity = 0.5;
        let pixels = drawn(&[body, ghost]);
        assert_eq!(pixels[10 * 100 + 20], Color32::from_rgb(100, 0, 0), "half of the red front");
        assert_eq!(pixels[35 * 100 + 35], Color32::WHITE, "behind the body");
    }

    #[test]
    fn a_slanted_triangle_is_cut_where_it_passes_through_another() {
        let flat = square(0.0, 60.0, 0.5, Color32::RED);
        let mut slanted = Object { opacity: 1.0, ..Object::default() };
        slanted.clear();
        let corner = |x: f32, y| [x, y, x / 60.0];
        for corners in [
            [corner(0.0, 0.0), corner(60.0, 0.0), corner(60.0, 60.0)],
            [corner(0.0, 0.0), corner(60.0, 60.0), corner(0.0, 60.0)],
        ] {
            slanted.push(ScreenTriangle { corners, color: Color32::BLUE });
        }
        let pixels = drawn(&[flat, slanted]);
        assert_eq!(pixels[20 * 100 + 28], Color32::RED);
        assert_eq!(pixels[20 * 100 + 31], Color32::BLUE);
    }
}
