//! A picture of the ground in tiles, with smaller copies for what is seen from afar.

use std::sync::Arc;

use image::RgbaImage;

use impactlab_core::site::PixelMap;

/// Side of a tile, pixels; a power of two.
pub const TILE: usize = 128;

/// A picture of the ground. Its levels halve in size, each pixel of one being the mean of four of the
/// level before, so that distant ground neither flickers nor is read pixel by pixel.
#[derive(Debug, Clone)]
pub struct GroundPicture {
    /// Where the pixels of the first level lie.
    pub map: PixelMap,
    levels: Arc<[PictureLevel]>,
}

impl PartialEq for GroundPicture {
    /// Pixels that are shared are not compared one by one.
    fn eq(&self, other: &Self) -> bool {
        let is_shared = Arc::ptr_eq(&self.levels, &other.levels);
        self.map == other.map && (is_shared || self.levels == other.levels)
    }
}

/// Smaller copies, the picture itself counted, at most: the smallest is 1/256 as wide.
const MAX_LEVELS: usize = 9;

/// One level: pixels `[red, green, blue, opacity]` in square tiles, so that neighbours in any direction
/// are close in memory.
#[derive(Debug, PartialEq)]
pub struct PictureLevel {
    size: [usize; 2],
    tiles_across: usize,
    pixels: Vec<[u8; 4]>,
}

impl PictureLevel {
    fn new([width, height]: [usize; 2]) -> Self {
        let [across, down] = [width, height].map(|side| side.div_ceil(TILE).max(1));
        let pixels = vec![[0; 4]; across * down * TILE * TILE];
        Self { size: [width, height], tiles_across: across, pixels }
    }

    /// Width and height, pixels.
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Its tiles: the left top pixel of each, and [`TILE`] rows of as many pixels
    /// `[red, green, blue, opacity]`, of which those beyond the edge mean nothing.
    pub fn tiles(&self) -> impl Iterator<Item = ([usize; 2], &[[u8; 4]])> {
        let place = |idx: usize| [idx % self.tiles_across, idx / self.tiles_across];
        let tiles = self.pixels.chunks_exact(TILE * TILE).enumerate();
        tiles.map(move |(idx, pixels)| (place(idx).map(|place| place * TILE), pixels))
    }

    fn index(&self, x: usize, y: usize) -> usize {
        let tile = y / TILE * self.tiles_across + x / TILE;
        tile * TILE * TILE + y % TILE * TILE + x % TILE
    }

    /// The pixel at a column and a row; those beyond the edge are those at the edge.
    fn at(&self, x: usize, y: usize) -> [u8; 4] {
        let [width, height] = self.size;
        let idx = self.index(x.min(width.saturating_sub(1)), y.min(height.saturating_sub(1)));
        self.pixels.get(idx).copied().unwrap_or_default()
    }

    /// A pixel, the one at its right, and those below them.
    fn four_at(&self, x: usize, y: usize) -> [[u8; 4]; 4] {
        let is_within = |at: usize, side: usize| at % TILE + 1 < TILE && at + 1 < side;
        if is_within(x, self.size[0]) && is_within(y, self.size[1]) {
            let start = self.index(x, y);
            if let Some(pixels) = self.pixels.get(start..start + TILE + 2) {
                return [pixels[0], pixels[1], pixels[TILE], pixels[TILE + 1]];
            }
        }
        [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[i, j]| self.at(x + i, y + j))
    }

    fn set(&mut self, x: usize, y: usize, pixel: [u8; 4]) {
        let idx = self.index(x, y);
        if let Some(place) = self.pixels.get_mut(idx) {
            *place = pixel;
        }
    }

    /// The level of half the size.
    fn halved(&self) -> Self {
        let mut half = Self::new(self.size.map(|side| side.div_ceil(2)));
        for y in 0..half.size[1] {
            for x in 0..half.size[0] {
                let (x2, y2) = (2 * x, 2 * y);
                let four = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[i, j]| self.at(x2 + i, y2 + j));
                half.set(x, y, mean(four));
            }
        }
        half
    }

    /// Colour and opacity at a point between the middles of four pixels, 0 to 255; transparent beyond the
    /// edge.
    fn sample(&self, [u, v]: [f32; 2]) -> [f32; 4] {
        let [width, height] = self.size.map(|side| side as f32);
        if !(u >= 0.0 && v >= 0.0 && u <= width && v <= height) {
            return [0.0; 4];
        }
        let (u, v) = ((u - 0.5).max(0.0), (v - 0.5).max(0.0));
        let (x, y) = (u as usize, v as usize);
        let (fx, fy) = (u - x as f32, v - y as f32);
        let [a, b, c, d] = self.four_at(x, y);
        std::array::from_fn(|k| {
            let [a, b, c, d] = [a, b, c, d].map(|pixel| f32::from(pixel[k]));
            let (above, below) = (a + (b - a) * fx, c + (d - c) * fx);
            above + (below - above) * fy
        })
    }
}

/// Mean of four pixels; what is transparent has no part in the colour.
fn mean(four: [[u8; 4]; 4]) -> [u8; 4] {
    let opacity: u32 = four.iter().map(|pixel| u32::from(pixel[3])).sum();
    if opacity == 0 {
        return [0; 4];
    }
    let mean = |k: usize| {
        let sum: u32 = four.iter().map(|pixel| u32::from(pixel[k]) * u32::from(pixel[3])).sum();
        ((sum + opacity / 2) / opacity) as u8
    };
    [mean(0), mean(1), mean(2), ((opacity + 2) / 4) as u8]
}

impl GroundPicture {
    /// The picture with all its smaller copies.
    ///
    /// - `map`: where its pixels lie.
    pub fn new(picture: &RgbaImage, map: PixelMap) -> Self {
        let size = [picture.width(), picture.height()].map(|side| side as usize);
        let mut first = PictureLevel::new(size);
        for (x, y, pixel) in picture.enumerate_pixels() {
            first.set(x as usize, y as usize, pixel.0);
        }
        let mut levels = vec![first];
        while let Some(half) = levels.last().filter(|level| level.size[0].max(level.size[1]) > 1)
            && levels.len() < MAX_LEVELS
        {
            let half = half.halved();
            levels.push(half);
        }
        Self { map, levels: levels.into() }
    }

    /// The same picture somewhere else.
    #[must_use]
    pub fn placed(&self, map: PixelMap) -> Self {
        Self { map, levels: Arc::clone(&self.levels) }
    }

    /// Whether it has the same pixels, wherever they lie.
    pub fn has_pixels_of(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.levels, &other.levels)
    }

    /// Width and height, pixels.
    pub fn size(&self) -> [usize; 2] {
        self.levels[0].size
    }

    /// The picture and its smaller copies, each half as wide and high as the one before, rounded up.
    pub fn levels(&self) -> &[PictureLevel] {
        &self.levels
    }

    /// Whether a point lies within the picture, in pixels of the first level.
    pub fn holds(&self, [u, v]: [f32; 2]) -> bool {
        let [width, height] = self.levels[0].size.map(|side| side as f32);
        u >= 0.0 && v >= 0.0 && u <= width && v <= height
    }

    /// Colour and opacity, 0 to 255, of a part of the picture: the mean along a line, at the level whose
    /// pixels are as large as the part is wide.
    ///
    /// - `middle`: middle of the part, pixels of the first level from the left top corner;
    /// - `along`: from one end of the line to the other, pixels;
    /// - `width`: of the part across the line, pixels.
    pub fn mean_along(&self, middle: [f32; 2], along: [f32; 2], width: f32) -> [f32; 4] {
        let length = (along[0] * along[0] + along[1] * along[1]).sqrt();
        // At most eight samples; a longer line is read at a coarser level.
        let n = (length / width.max(1.0)).ceil().clamp(1.0, 8.0);
        let part = width.max(length / n).max(1.0);
        let mut sum = [0.0; 4];
        for i in 0..n as usize {
            let share = (i as f32 + 0.5) / n - 0.5;
            let at = [middle[0] + share * along[0], middle[1] + share * along[1]];
            let here = self.sample(at, part.log2());
            for k in 0..4 {
                sum[k] += here[k] / n;
            }
        }
        sum
    }

    /// Colour and opacity at a point between two levels.
    fn sample(&self, [u, v]: [f32; 2], level: f32) -> [f32; 4] {
        let last = self.levels.len() - 1;
        let coarse = (level.max(0.0) as usize).min(last);
        let at = |idx: usize| {
            let scale = 1.0 / (1_u64 << idx.min(40)) as f32;
            self.levels[idx].sample([u * scale, v * scale])
        };
        let (near, share) = (at(coarse), (level - coarse as f32).clamp(0.0, 1.0));
        if share < 0.02 || coarse == last {
            return near;
        }
        let far = at(coarse + 1);
        std::array::from_fn(|k| near[k] + (far[k] - near[k]) * share)
    }
}

#[cfg(test)]
mod tests {
    use image::Rgba;

    use super::*;

    const MAP: PixelMap =
        PixelMap { corner_m: [0.0; 2], per_column_m: [1.0, 0.0], per_row_m: [0.0, -1.0] };

    #[test]
    fn a_pixel_has_its_colour_in_its_middle() {
        let mut picture = RgbaImage::from_pixel(300, 200, Rgba([10, 20, 30, 255]));
        picture.put_pixel(257, 133, Rgba([200, 100, 50, 255]));
        let picture = GroundPicture::new(&picture, MAP);
        assert_eq!(picture.mean_along([257.5, 133.5], [0.0; 2], 1.0), [200.0, 100.0, 50.0, 255.0]);
        assert_eq!(picture.mean_along([258.5, 133.5], [0.0; 2], 1.0), [10.0, 20.0, 30.0, 255.0]);
        let between = picture.mean_along([258.0, 133.5], [0.0; 2], 1.0);
        assert!((between[0] - 105.0).abs() < 1e-3, "{between:?}");
        assert_eq!(picture.mean_along([-0.1, 5.0], [0.0; 2], 1.0), [0.0; 4], "beyond the edge");
    }

    #[test]
    fn large_parts_are_means_and_transparent_pixels_have_no_colour() {
        let checker = RgbaImage::from_fn(256, 256, |x, y| match (x + y) % 2 {
            0 => Rgba([255, 255, 255, 255]),
            _ => Rgba([1, 1, 1, 255]),
        });
        let picture = GroundPicture::new(&checker, MAP);
        for width in [2.0, 4.0, 37.0] {
            let mean = picture.mean_along([128.3, 120.7], [width, 0.0], width);
            assert!((mean[0] - 128.0).abs() < 1.0, "{width}: {mean:?}");
        }
        let holes = RgbaImage::from_fn(64, 64, |x, _| match x % 2 {
            0 => Rgba([80, 90, 100, 255]),
            _ => Rgba([255, 0, 255, 0]),
        });
        let mean = GroundPicture::new(&holes, MAP).mean_along([32.0, 32.0], [8.0, 0.0], 8.0);
        assert!((mean[0] - 80.0).abs() < 1.0 && (mean[3] - 127.5).abs() < 1.5, "{mean:?}");
    }
}
