//! Where the pixels of an orthophoto lie on the ground.

use serde::{Deserialize, Serialize};

use crate::ranges::PIXEL_SIZE;
use crate::site::{SiteOrigin, WorldFile};

/// Largest ratio of the sides of a pixel, and of the cosine of the angle between them: beyond that,
/// something is wrong with the numbers.
const LARGEST_RATIO: f64 = 4.0;
const LARGEST_COSINE: f64 = 0.5;

/// An affine map from an orthophoto to the ground.
///
/// ```text
/// [X, Y] = corner_m + column · per_column_m + row · per_row_m
/// ```
///
/// Column and row are counted in pixels from the left top corner of the picture; the middle of the first
/// pixel is at [0.5, 0.5].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PixelMap {
    /// The left top corner, m.
    pub corner_m: [f64; 2],
    /// From a pixel to the one at its right, m.
    pub per_column_m: [f64; 2],
    /// From a pixel to the one below, m.
    pub per_row_m: [f64; 2],
}

impl PixelMap {
    /// The map of a world file, whose last two numbers are the **middle** of the left top pixel.
    pub fn from_world_file(world: &WorldFile, origin: &SiteOrigin) -> Self {
        let (column, row) = (world.per_column_m, world.per_row_m);
        let middle = origin.site_from_survey(world.first_pixel_m);
        let (column, row) = (origin.turned(column), origin.turned(row));
        let corner_m = std::array::from_fn(|i| middle[i] - 0.5 * column[i] - 0.5 * row[i]);
        Self { corner_m, per_column_m: column, per_row_m: row }
    }

    /// The map that turns and scales a picture, alike in both directions, so that two of its points lie
    /// where they are; `None` if the points coincide.
    ///
    /// - `points_px`: the points, `[column, row]`;
    /// - `points_m`: where they are, `[X, Y]`.
    pub fn from_two_points(points_px: [[f64; 2]; 2], points_m: [[f64; 2]; 2]) -> Option<Self> {
        // As complex numbers, with the rows pointing up: points_m = a + s · points_px.
        let [du, dv] = [points_px[1][0] - points_px[0][0], points_px[0][1] - points_px[1][1]];
        let [dx, dy] = [points_m[1][0] - points_m[0][0], points_m[1][1] - points_m[0][1]];
        let squared = du * du + dv * dv;
        if !(squared > 0.0 && dx.hypot(dy) > 0.0) {
            return None;
        }
        let (re, im) = ((dx * du + dy * dv) / squared, (dy * du - dx * dv) / squared);
        let (per_column_m, per_row_m) = ([re, im], [im, -re]);
        let [u, v] = points_px[0];
        let corner_m =
            std::array::from_fn(|i| points_m[0][i] - u * per_column_m[i] - v * per_row_m[i]);
        Some(Self { corner_m, per_column_m, per_row_m })
    }

    /// The map of an upright picture, whose columns run along X, by the distance of two of its points;
    /// `None` if the points coincide.
    ///
    /// - `first_m`: where the first point is.
    pub fn from_distance(
        points_px: [[f64; 2]; 2],
        distance_m: f64,
        first_m: [f64; 2],
    ) -> Option<Self> {
        let way = [points_px[1][0] - points_px[0][0], points_px[0][1] - points_px[1][1]];
        let scale = distance_m / way[0].hypot(way[1]);
        let second_m = [first_m[0] + scale * way[0], first_m[1] + scale * way[1]];
        second_m.iter().all(|value| value.is_finite()).then_some(())?;
        Self::from_two_points(points_px, [first_m, second_m])
    }

    /// The same map with everything farther from a point by a factor.
    #[must_use]
    pub fn scaled_about(self, fixed_m: [f64; 2], factor: f64) -> Self {
        let from = |i: usize| fixed_m[i] + factor * (self.corner_m[i] - fixed_m[i]);
        Self {
            corner_m: [from(0), from(1)],
            per_column_m: self.per_column_m.map(|value| factor * value),
            per_row_m: self.per_row_m.map(|value| factor * value),
        }
    }

    /// Where a point of the picture lies, m.
    pub fn ground_m(&self, [column, row]: [f64; 2]) -> [f64; 2] {
        std::array::from_fn(|i| {
            self.corner_m[i] + column * self.per_column_m[i] + row * self.per_row_m[i]
        })
    }

    /// The point of the picture that lies at a place, `[column, row]`.
    pub fn pixel(&self, [x_m, y_m]: [f64; 2]) -> [f64; 2] {
        self.pixels_along([x_m - self.corner_m[0], y_m - self.corner_m[1]])
    }

    /// A way on the ground in pixels, `[columns, rows]`.
    pub fn pixels_along(&self, [dx_m, dy_m]: [f64; 2]) -> [f64; 2] {
        let ([a, d], [b, e]) = (self.per_column_m, self.per_row_m);
        let area = self.area_m2();
        [(e * dx_m - b * dy_m) / area, (a * dy_m - d * dx_m) / area]
    }

    /// Area of a pixel, m²; negative for a picture that is not mirrored, since rows point down.
    pub fn area_m2(&self) -> f64 {
        let ([a, d], [b, e]) = (self.per_column_m, self.per_row_m);
        a * e - b * d
    }

    /// Width and height of a pixel, m.
    pub fn pixel_size_m(&self) -> [f64; 2] {
        [self.per_column_m, self.per_row_m].map(|[x, y]| x.hypot(y))
    }

    /// What is expected of the map where it cannot be that of an orthophoto: its pixels are too small or
    /// too large, mirrored, or far from square.
    pub fn problem(&self) -> Option<&'static str> {
        let size = self.pixel_size_m();
        let ([a, d], [b, e]) = (self.per_column_m, self.per_row_m);
        let cosine = (a * b + d * e).abs() / (size[0] * size[1]);
        let ratio = (size[0] / size[1]).max(size[1] / size[0]);
        if size.iter().any(|side| !PIXEL_SIZE.contains(*side)) {
            return Some("a pixel of 0.0005 to 100 m on the ground");
        }
        if self.area_m2() >= 0.0 {
            return Some("rows that lead down, so that the picture is not mirrored");
        }
        (cosine > LARGEST_COSINE || ratio > LARGEST_RATIO).then_some("pixels that are about square")
    }

    /// The corners of a picture on the ground: left top, right top, right bottom, left bottom, m.
    pub fn corners_m(&self, size_px: [u32; 2]) -> [[f64; 2]; 4] {
        let [width, height] = size_px.map(f64::from);
        [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]].map(|at| self.ground_m(at))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: [f64; 2], b: [f64; 2], tolerance: f64) -> bool {
        (a[0] - b[0]).hypot(a[1] - b[1]) <= tolerance
    }

    #[test]
    fn the_last_numbers_of_a_world_file_are_the_middle_of_the_first_pixel() {
        let world = WorldFile {
            per_column_m: [0.25, 0.0],
            per_row_m: [0.0, -0.25],
            first_pixel_m: [500_000.125, 5_400_099.875],
        };
        let origin = SiteOrigin { survey_m: [500_000.0, 5_400_000.0], ..SiteOrigin::default() };
        let map = PixelMap::from_world_file(&world, &origin);
        assert_eq!(map.corner_m, [0.0, 100.0], "the corner is half a pixel outside of the middle");
        assert_eq!(map.ground_m([0.5, 0.5]), [0.125, 99.875]);
        assert_eq!(map.ground_m([400.0, 400.0]), [100.0, 0.0]);
    }

    #[test]
    fn rotation_terms_turn_the_picture_the_right_way() {
        // A picture turned by 30° to the left: columns run along 30°, rows along 30° − 90°.
        let (sin, cos) = f64::to_radians(30.0).sin_cos();
        let world = WorldFile {
            per_column_m: [0.1 * cos, 0.1 * sin],
            per_row_m: [0.1 * sin, -0.1 * cos],
            first_pixel_m: [0.0, 0.0],
        };
        let map = PixelMap::from_world_file(&world, &SiteOrigin::default());
        let right = map.ground_m([100.5, 0.5]);
        assert!(near(right, [10.0 * cos, 10.0 * sin], 1e-12), "{right:?}");
        let below = map.ground_m([0.5, 100.5]);
        assert!(near(below, [10.0 * sin, -10.0 * cos], 1e-12), "{below:?}");
        assert!((map.area_m2() + 0.01).abs() < 1e-15, "not mirrored");
        // With X along the columns of the picture, it is upright in the site.
        let origin = SiteOrigin { survey_m: [0.0; 2], x_axis_azimuth_rad: f64::to_radians(60.0) };
        let upright = PixelMap::from_world_file(&world, &origin);
        assert!(near(upright.per_column_m, [0.1, 0.0], 1e-15), "{upright:?}");
        assert!(near(upright.per_row_m, [0.0, -0.1], 1e-15), "{upright:?}");
    }

    #[test]
    fn pixels_come_back_from_the_ground() {
        let map = PixelMap {
            corner_m: [1.2e6, -3.4e6],
            per_column_m: [0.09, 0.02],
            per_row_m: [0.03, -0.11],
        };
        for at in [[0.0, 0.0], [1.5, 799.0], [1234.25, 17.75]] {
            let back = map.pixel(map.ground_m(at));
            assert!(near(back, at, 1e-6), "{at:?}: {back:?}");
        }
    }

    #[test]
    fn two_points_lie_where_they_are_and_the_picture_is_not_mirrored() {
        let px = [[100.0, 400.0], [700.0, 100.0]];
        for metres in [[[0.0, 0.0], [42.0, 21.0]], [[5.0, 5.0], [-3.0, 60.0]]] {
            let map = PixelMap::from_two_points(px, metres).unwrap();
            for (at, expected) in px.into_iter().zip(metres) {
                assert!(near(map.ground_m(at), expected, 1e-9), "{metres:?}");
            }
            let [width, height] = map.pixel_size_m();
            assert!((width - height).abs() < 1e-12 && map.area_m2() < 0.0);
        }
        let upright = PixelMap::from_two_points(px, [[0.0, 0.0], [42.0, 21.0]]).unwrap();
        assert!(near(upright.per_column_m, [0.07, 0.0], 1e-12), "{upright:?}");
        assert_eq!(PixelMap::from_two_points([[1.0, 1.0]; 2], [[0.0, 0.0], [1.0, 0.0]]), None);
        assert_eq!(PixelMap::from_two_points(px, [[3.0, 3.0]; 2]), None);
    }

    #[test]
    fn a_distance_scales_an_upright_picture() {
        let px = [[100.0, 400.0], [500.0, 100.0]];
        let map = PixelMap::from_distance(px, 25.0, [3.0, 4.0]).unwrap();
        assert!(near(map.per_column_m, [0.05, 0.0], 1e-12), "{map:?}");
        assert!(near(map.per_row_m, [0.0, -0.05], 1e-12), "{map:?}");
        assert!(near(map.ground_m(px[0]), [3.0, 4.0], 1e-12));
        assert_eq!(PixelMap::from_distance([[1.0, 1.0]; 2], 25.0, [0.0; 2]), None);
        let double = map.scaled_about([3.0, 4.0], 2.0);
        assert!(near(double.ground_m(px[0]), [3.0, 4.0], 1e-12), "the point stays");
        let [a, b] = px.map(|at| double.ground_m(at));
        assert!(((a[0] - b[0]).hypot(a[1] - b[1]) - 50.0).abs() < 1e-9);
    }
}
