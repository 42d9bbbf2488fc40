//! A cloud seen from above, pixel by pixel.

use crate::data::MAX_RASTER_PIXELS;

/// Thickness of the lowest layer of a pixel, which is shown, m: above the unevenness of a road, below the
/// height of a bumper.
const LAYER_M: f64 = 0.15;

/// Most pixels of a side.
const MAX_SIDE: f64 = 65_535.0;

/// A raster of height and colour. Rows lead down from the largest northing. Its pixels begin at multiples of
/// their side, so that rasters of neighbouring clouds fit each other.
pub(super) struct Raster {
    /// Left top corner: easting and northing, m.
    pub corner_m: [f64; 2],
    /// Index of its column and of its row among all multiples of a pixel, to the east and to the north.
    corner_px: [f64; 2],
    /// Side of a pixel, m.
    pub pixel_m: f64,
    /// Width and height, pixels.
    pub size_px: [u32; 2],
    /// Height from which those of the pixels are counted, m.
    base_m: f64,
    cells: Vec<Cell>,
}

/// The lowest layer of a pixel.
#[derive(Debug, Clone, Copy, Default)]
struct Cell {
    /// Its lowest point above the base of the raster, m.
    height_m: f32,
    color: [f32; 3],
    n: u32,
}

/// Width and height of an extent, pixels.
pub(super) fn size_px([low, high]: [[f64; 2]; 2], pixel_m: f64) -> [f64; 2] {
    std::array::from_fn(|axis| (high[axis] / pixel_m).floor() - (low[axis] / pixel_m).floor() + 1.0)
}

/// Whether a raster of so many pixels is made.
pub(super) fn is_possible([width, height]: [f64; 2]) -> bool {
    let is_side = |side: f64| (1.0..=MAX_SIDE).contains(&side);
    is_side(width) && is_side(height) && width * height <= MAX_RASTER_PIXELS as f64
}

impl Raster {
    /// An empty raster over an extent, whose size [`is_possible`].
    ///
    /// - `base_m`: the lowest height.
    pub fn new(extent_m: [[f64; 2]; 2], pixel_m: f64, base_m: f64) -> Self {
        let size_px = size_px(extent_m, pixel_m).map(|side| side as u32);
        let [width, height] = size_px.map(|side| side as usize);
        let [left, top] = [extent_m[0][0], extent_m[1][1]].map(|side| (side / pixel_m).floor());
        let corner_m = [left * pixel_m, (top + 1.0) * pixel_m];
        let cells = vec![Cell::default(); width * height];
        Self { corner_m, corner_px: [left, top], pixel_m, size_px, base_m, cells }
    }

    /// Takes a point, unless it lies outside.
    pub fn take(&mut self, [easting_m, northing_m, height_m]: [f64; 3], color: [f32; 3]) {
        // Counted as the size is, so that no point on the border of the extent is lost.
        let [left, top] = self.corner_px;
        let column = (easting_m / self.pixel_m).floor() - left;
        let row = top - (northing_m / self.pixel_m).floor();
        let [width, height] = self.size_px.map(f64::from);
        if !(0.0..width).contains(&column) || !(0.0..height).contains(&row) {
            return;
        }
        let idx = row as usize * self.size_px[0] as usize + column as usize;
        let Some(cell) = self.cells.get_mut(idx) else { return };
        let height_m = height_m - self.base_m;
        let above_m = height_m - f64::from(cell.height_m);
        if cell.n == 0 || above_m < -LAYER_M {
            *cell = Cell { height_m: height_m as f32, color, n: 1 };
        } else if above_m <= LAYER_M {
            cell.height_m = cell.height_m.min(height_m as f32);
            cell.n = cell.n.saturating_add(1);
            let share = 1.0 / cell.n as f32;
            for (mean, new) in cell.color.iter_mut().zip(color) {
                *mean += (new - *mean) * share;
            }
        }
    }

    /// Share of the pixels that have points.
    pub fn filled(&self) -> f64 {
        let n = self.cells.iter().filter(|cell| cell.n > 0).count();
        n as f64 / self.cells.len().max(1) as f64
    }

    /// Lowest and highest height of a pixel, m; `None` without any point.
    pub fn heights_m(&self) -> Option<[f64; 2]> {
        let heights = self.cells.iter().filter(|cell| cell.n > 0);
        let heights = heights.map(|cell| self.base_m + f64::from(cell.height_m));
        heights.fold(None, |range: Option<[f64; 2]>, height_m| {
            let [low, high] = range.unwrap_or([height_m; 2]);
            Some([low.min(height_m), high.max(height_m)])
        })
    }

    /// Red, green, blue and opacity of all pixels, row by row; pixels without points are clear.
    ///
    /// - `color`: from the mean colour of a pixel and its height to 0 … 1.
    pub fn rgba(&self, color: impl Fn([f32; 3], f64) -> [f32; 3]) -> Vec<u8> {
        let pixel = |cell: &Cell| match cell.n {
            0 => [255, 255, 255, 0],
            _ => {
                let height_m = self.base_m + f64::from(cell.height_m);
                let [r, g, b] = color(cell.color, height_m)
                    .map(|part| (part.clamp(0.0, 1.0) * 255.0).round() as u8);
                [r, g, b, 255]
            }
        };
        self.cells.iter().flat_map(pixel).collect()
    }

    /// Heights of all pixels, row by row: 0 without points, else 1 at the lowest to 65535 at the highest.
    pub fn heights(&self, [low_m, high_m]: [f64; 2]) -> Vec<u16> {
        let span_m = (high_m - low_m).max(f64::MIN_POSITIVE);
        let step = |cell: &Cell| match cell.n {
            0 => 0,
            _ => {
                let share = (self.base_m + f64::from(cell.height_m) - low_m) / span_m;
                (1.0 + 65_534.0 * share.clamp(0.0, 1.0)).round() as u16
            }
        };
        self.cells.iter().map(step).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lowest_layer_is_shown_and_averaged() {
        let mut raster = Raster::new([[0.0, 0.0], [1.0, 0.5]], 0.5, 100.0);
        assert_eq!(raster.size_px, [3, 2]);
        let (road, roof) = ([0.2; 3], [1.0; 3]);
        for (height_m, color) in [(103.0, roof), (100.0, road), (100.1, [0.4; 3]), (104.0, roof)] {
            raster.take([0.1, 0.95, height_m], color);
        }
        raster.take([-0.1, 0.2, 100.0], roof);
        raster.take([0.1, 9.0, 100.0], roof);
        let pixels = raster.rgba(|color, _| color);
        assert_eq!(pixels[..8], [77, 77, 77, 255, 255, 255, 255, 0], "the mean of two, and a hole");
        assert!((raster.filled() - 1.0 / 6.0).abs() < 1e-12);
        assert_eq!(raster.heights_m(), Some([100.0, 100.0]));
    }

    /// The lowest and the highest point of an extent are in its picture, wherever the lines of pixels lie.
    #[test]
    fn no_point_on_the_border_is_lost() {
        for pixel_m in [0.05, 0.1, 0.03, 0.5] {
            for low in [0.0, 0.3, 512_345.15, -17.4] {
                let extent_m = [[low, low], [low + 1.2, low + 1.2]];
                for at in extent_m {
                    let mut raster = Raster::new(extent_m, pixel_m, 0.0);
                    raster.take([at[0], at[1], 0.0], [0.5; 3]);
                    assert!(raster.filled() > 0.0, "{at:?} with {pixel_m} m");
                }
            }
        }
    }

    #[test]
    fn what_is_too_large_is_known_before_it_is_made() {
        for (extent_m, pixel_m, expected) in [
            ([[0.0, 0.0], [100.0, 100.0]], 0.05, true),
            ([[0.0, 0.0], [1000.0, 1000.0]], 0.05, false),
            ([[0.0, 0.0], [1e7, 0.0]], 1.0, false),
            ([[0.0, 0.0], [f64::INFINITY, 0.0]], 1.0, false),
            ([[0.0, 0.0], [f64::NAN, 0.0]], 1.0, false),
        ] {
            assert_eq!(is_possible(size_px(extent_m, pixel_m)), expected, "{extent_m:?} {pixel_m}");
        }
    }
}
