//! From where a scene is seen.
//!
//! From above the picture is parallel: X to the right, Y up. In perspective the camera looks at a point
//! on the ground, about which it orbits. The ground point in the middle of the picture has the same
//! scale in both, so that a change of the view keeps it.

use std::f64::consts::{FRAC_PI_2, TAU};

use serde::{Deserialize, Serialize};

use impactlab_document::scene::ViewKind;

/// Half the angle over the height of the picture that the camera sees, rad.
const HALF_FIELD_RAD: f64 = 0.30;
/// Range of the distance from the point that is looked at, m.
const DISTANCES_M: [f64; 2] = [2.0, 20_000.0];
/// Range of the height of the camera above the horizon, rad.
const ELEVATIONS_RAD: [f64; 2] = [0.035, FRAC_PI_2 - 0.01];
/// Room around what is fitted, as a share of its size.
const MARGIN: f64 = 1.16;
/// Height of what stands on the ground, m, for which there is room above when a scene is fitted.
const HEIGHT_M: f64 = 1.6;
/// Closest distance that is drawn, m.
pub const NEAR_M: f64 = 0.2;

/// A camera.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Camera {
    /// How the scene is seen.
    pub kind: ViewKind,
    /// Point on the ground that is in the middle of the picture, `[X, Y]`, m.
    pub target_m: [f64; 2],
    /// In perspective: direction from the point that is looked at to the camera, counter-clockwise from
    /// X as seen from above, rad.
    pub azimuth_rad: f64,
    /// In perspective: height of the camera above the horizon of that point, rad.
    pub elevation_rad: f64,
    /// Distance of the camera from that point, m. From above it sets the scale.
    pub distance_m: f64,
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            kind: ViewKind::Above,
            target_m: [0.0; 2],
            azimuth_rad: -1.95,
            elevation_rad: 0.55,
            distance_m: 60.0,
        }
    }
}

impl Camera {
    /// The camera with each number within its limits; one that is not finite gets its default.
    #[must_use]
    pub fn limited(self) -> Self {
        let usual = Self::default();
        let finite = |value: f64, usual: f64| if value.is_finite() { value } else { usual };
        let [low, high] = ELEVATIONS_RAD;
        let [nearest, farthest] = DISTANCES_M;
        Self {
            kind: self.kind,
            target_m: self.target_m.map(|value| finite(value, 0.0)),
            azimuth_rad: finite(self.azimuth_rad, usual.azimuth_rad).rem_euclid(TAU),
            elevation_rad: finite(self.elevation_rad, usual.elevation_rad).clamp(low, high),
            distance_m: finite(self.distance_m, usual.distance_m).clamp(nearest, farthest),
        }
    }

    /// The camera moved so that it sees a part of the ground: the directions stay.
    ///
    /// - `places_m`: places `[X, Y]` that are seen, m;
    /// - `size`: width and height of the picture, in any unit.
    #[must_use]
    pub fn fitted(self, places_m: &[[f64; 2]], size: [f64; 2]) -> Self {
        let mut extent = places_m.first().map_or([[0.0; 2]; 2], |first| [*first; 2]);
        for place in places_m {
            for axis in 0..2 {
                extent[0][axis] = extent[0][axis].min(place[axis]);
                extent[1][axis] = extent[1][axis].max(place[axis]);
            }
        }
        let [low, high] = extent;
        let middle = [(low[0] + high[0]) / 2.0, (low[1] + high[1]) / 2.0];
        let camera = Self { target_m: middle, ..self }.limited();
        let aspect = (size[0] / size[1].max(1.0)).max(1e-3);
        if self.kind == ViewKind::Above {
            let tall = (high[1] - low[1]).max((high[0] - low[0]) / aspect);
            let distance_m = MARGIN * tall / 2.0 / HALF_FIELD_RAD.tan();
            return Self { distance_m, ..camera }.limited();
        }
        // The distance at which the outermost place is at the edge, by bisection; twice, so that the
        // middle of what is seen comes to the middle of the picture.
        let mut camera = camera;
        for _ in 0..3 {
            camera = camera.at_least_distance(places_m, aspect);
            camera = camera.centred(places_m, aspect);
        }
        camera.at_least_distance(places_m, aspect)
    }

    /// The camera as far back that a picture holds the width of another one; what is looked at stays.
    ///
    /// - `seen`: width over height of the picture that the camera was placed for;
    /// - `aspect`: likewise, of the picture that is to hold its width.
    #[must_use]
    pub fn holding_width(self, seen: f64, aspect: f64) -> Self {
        let back = (seen / aspect.max(1e-3)).max(1.0);
        Self { distance_m: self.distance_m * back, ..self }.limited()
    }

    /// The camera at the least distance from which it sees the corners.
    fn at_least_distance(self, corners: &[[f64; 2]], aspect: f64) -> Self {
        let [mut near, mut far] = DISTANCES_M;
        for _ in 0..48 {
            let middle = (near * far).sqrt();
            let seen = Self { distance_m: middle, ..self };
            if seen.holds(corners, aspect) { far = middle } else { near = middle }
        }
        Self { distance_m: far, ..self }.limited()
    }

    /// Whether the corners, and what stands there, are in the picture with some room.
    fn holds(&self, corners: &[[f64; 2]], aspect: f64) -> bool {
        let projection = Projection::new(self, [aspect, 1.0]);
        let is_seen = |[x, y]: [f64; 2]| {
            [0.0, HEIGHT_M].into_iter().all(|z| {
                projection.project([x, y, z]).is_some_and(|[px, py, _]| {
                    let off = [(px / aspect - 0.5).abs(), (py - 0.5).abs()];
                    off[0] < 0.5 / MARGIN && off[1] < 0.5 / MARGIN
                })
            })
        };
        corners.iter().all(|corner| is_seen(*corner))
    }

    /// The camera moved along the ground so that the corners lie about its middle.
    fn centred(self, corners: &[[f64; 2]], aspect: f64) -> Self {
        let projection = Projection::new(&self, [aspect, 1.0]);
        let seen: Vec<[f64; 3]> =
            corners.iter().filter_map(|[x, y]| projection.project([*x, *y, 0.0])).collect();
        let middle = |axis: usize| {
            let values = seen.iter().map(|at| at[axis]);
            let (low, high) = values.fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(v), h.max(v)));
            (low + high) / 2.0
        };
        if seen.len() < corners.len() {
            return self;
        }
        match projection.ground_at([middle(0), middle(1)]) {
            Some(target_m) => Self { target_m, ..self }.limited(),
            None => self,
        }
    }

    /// The camera after a drag that keeps the ground under the pointer.
    #[must_use]
    pub fn panned(self, size: [f64; 2], [from, to]: [[f64; 2]; 2]) -> Self {
        let projection = Projection::new(&self, size);
        match (projection.ground_at(from), projection.ground_at(to)) {
            (Some(from_m), Some(to_m)) => {
                let target_m = std::array::from_fn(|i| self.target_m[i] + from_m[i] - to_m[i]);
                Self { target_m, ..self }.limited()
            }
            _ => self,
        }
    }

    /// The camera turned about the point that is looked at.
    #[must_use]
    pub fn orbited(self, [azimuth_rad, elevation_rad]: [f64; 2]) -> Self {
        let (azimuth_rad, elevation_rad) =
            (self.azimuth_rad + azimuth_rad, self.elevation_rad + elevation_rad);
        Self { azimuth_rad, elevation_rad, ..self }.limited()
    }

    /// The camera nearer by a factor; the ground under the pointer stays there.
    #[must_use]
    pub fn zoomed(self, size: [f64; 2], pointer: [f64; 2], factor: f64) -> Self {
        let near = Self { distance_m: self.distance_m / factor, ..self }.limited();
        let (before, after) = (Projection::new(&self, size), Projection::new(&near, size));
        match (before.ground_at(pointer), after.ground_at(pointer)) {
            (Some(from), Some(to)) => {
                let moved: [f64; 2] = std::array::from_fn(|i| from[i] - to[i]);
                // Near the horizon a step would be larger than what is seen.
                if moved[0].hypot(moved[1]) > self.distance_m {
                    return near;
                }
                let target_m = std::array::from_fn(|i| self.target_m[i] + moved[i]);
                Self { target_m, ..near }.limited()
            }
            _ => near,
        }
    }
}

/// What a camera makes of points, in a picture of a given size. The origin of a picture is at its left
/// top, y points down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Projection {
    /// Whether lines that are parallel stay so.
    is_parallel: bool,
    /// Where the camera looks at and where it is, m.
    target_m: [f64; 2],
    eye_m: [f64; 3],
    /// Directions to the right, up and ahead.
    axes: [[f64; 3]; 3],
    /// Middle of the picture.
    middle: [f64; 2],
    /// From above: pixels per metre. In perspective: pixels at a distance of one.
    scale: f64,
}

impl Projection {
    /// The projection of a camera.
    ///
    /// - `size`: width and height of the picture, pixels.
    pub fn new(camera: &Camera, [width, height]: [f64; 2]) -> Self {
        let camera = camera.limited();
        let is_parallel = camera.kind == ViewKind::Above;
        let (azimuth_rad, elevation_rad) = match is_parallel {
            true => (-FRAC_PI_2, FRAC_PI_2),
            false => (camera.azimuth_rad, camera.elevation_rad),
        };
        let (sin, cos) = azimuth_rad.sin_cos();
        let (up_sin, up_cos) = elevation_rad.sin_cos();
        let out = [up_cos * cos, up_cos * sin, up_sin];
        let right = [-sin, cos, 0.0];
        let up = [-up_sin * cos, -up_sin * sin, up_cos];
        let [x, y] = camera.target_m;
        let at = |i: usize, base: f64| base + camera.distance_m * out[i];
        let per_one = height / 2.0 / HALF_FIELD_RAD.tan();
        Self {
            is_parallel,
            target_m: camera.target_m,
            eye_m: [at(0, x), at(1, y), at(2, 0.0)],
            axes: [right, up, out.map(|v| -v)],
            middle: [width / 2.0, height / 2.0],
            scale: if is_parallel { per_one / camera.distance_m } else { per_one },
        }
    }

    /// Whether the picture is from above.
    pub fn is_parallel(&self) -> bool {
        self.is_parallel
    }

    /// Point of the ground that is looked at, m.
    pub fn target_m(&self) -> [f64; 2] {
        self.target_m
    }

    /// Position of the camera, m.
    pub fn eye_m(&self) -> [f64; 3] {
        self.eye_m
    }

    /// Direction from a point to the camera; not of unit length.
    pub fn towards_camera(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        match self.is_parallel {
            true => [0.0, 0.0, 1.0],
            false => [self.eye_m[0] - x, self.eye_m[1] - y, self.eye_m[2] - z],
        }
    }

    /// A point in the axes of the camera: to the right, up, and ahead of it, m.
    pub fn in_camera(&self, point_m: [f64; 3]) -> [f64; 3] {
        let off: [f64; 3] = std::array::from_fn(|i| point_m[i] - self.eye_m[i]);
        self.axes.map(|axis| axis[0] * off[0] + axis[1] * off[1] + axis[2] * off[2])
    }

    /// A point in the axes of the camera in the picture: `[x, y, nearness]`. Nearness is larger for what
    /// hides other things and linear in the picture; `None` for what is behind the camera.
    pub fn in_picture(&self, [right, up, ahead]: [f64; 3]) -> Option<[f64; 3]> {
        let [mx, my] = self.middle;
        if self.is_parallel {
            return Some([mx + self.scale * right, my - self.scale * up, -ahead]);
        }
        if ahead < NEAR_M {
            return None;
        }
        let near = 1.0 / ahead;
        Some([mx + self.scale * right * near, my - self.scale * up * near, near])
    }

    /// A point `[X, Y, Z]` in the picture, m.
    pub fn project(&self, point_m: [f64; 3]) -> Option<[f64; 3]> {
        self.in_picture(self.in_camera(point_m))
    }

    /// A direction in the axes of the camera: to the right, up, and ahead of it.
    pub fn direction_in_camera(&self, direction: [f64; 3]) -> [f64; 3] {
        self.axes.map(|axis| (0..3).map(|i| axis[i] * direction[i]).sum())
    }

    /// Clip coordinates per metre to the right and up: everywhere from above, at a distance of 1 m in
    /// perspective.
    ///
    /// - `size`: width and height of the picture, pixels.
    pub fn clip_per_m(&self, size: [f64; 2]) -> [f64; 2] {
        size.map(|side| 2.0 * self.scale / side)
    }

    /// Lowest and highest `[x, y]` in the picture that a ball may cover; `None` if part of it is behind
    /// the camera.
    pub fn bounds_of_ball(&self, middle_m: [f64; 3], radius_m: f64) -> Option<[[f64; 2]; 2]> {
        let [right, up, ahead] = self.in_camera(middle_m);
        let [x, y, _] = self.in_picture([right, up, ahead])?;
        let near = ahead - radius_m;
        let reach = match self.is_parallel {
            true => [self.scale * radius_m; 2],
            false if near < NEAR_M => return None,
            // What is nearer by the radius lies further from the middle of the picture.
            false => {
                [right, up].map(|off| self.scale * radius_m / near * (1.0 + off.abs() / ahead))
            }
        };
        Some([[x - reach[0], y - reach[1]], [x + reach[0], y + reach[1]]])
    }

    /// Ground point under a pixel, m; `None` above the horizon.
    pub fn ground_at(&self, [px, py]: [f64; 2]) -> Option<[f64; 2]> {
        let (right, up) = ((px - self.middle[0]) / self.scale, (self.middle[1] - py) / self.scale);
        let [r, u, f] = self.axes;
        if self.is_parallel {
            return Some([self.target_m[0] + right, self.target_m[1] + up]);
        }
        let ray: [f64; 3] = std::array::from_fn(|i| r[i] * right + u[i] * up + f[i]);
        if ray[2] > -1e-6 {
            return None;
        }
        let share = -self.eye_m[2] / ray[2];
        Some([self.eye_m[0] + share * ray[0], self.eye_m[1] + share * ray[1]])
    }

    /// Pixels per metre at a point of the ground, across the line of sight.
    pub fn pixels_per_m(&self, [x, y]: [f64; 2]) -> f64 {
        if self.is_parallel {
            return self.scale;
        }
        let ahead = self.in_camera([x, y, 0.0])[2];
        self.scale / ahead.max(NEAR_M)
    }

    /// The ground under pixel `(px, py)` as `(N + N_x px + N_y py) / (D + D_x px + D_y py)`: three numbers
    /// each for X and Y off the target, and for D; in perspective D is positive below the horizon.
    pub fn ground_map(&self) -> [[f64; 3]; 3] {
        let [r, u, f] = self.axes;
        let [mx, my] = self.middle;
        let per = 1.0 / self.scale;
        if self.is_parallel {
            return [[-mx * per, per, 0.0], [my * per, 0.0, -per], [1.0, 0.0, 0.0]];
        }
        let ray = |i: usize| [f[i] - mx * per * r[i] + my * per * u[i], per * r[i], -per * u[i]];
        let (down, height) = (ray(2).map(|v| -v), self.eye_m[2]);
        let along = |i: usize| {
            let (base, ray) = (self.eye_m[i] - self.target_m[i], ray(i));
            std::array::from_fn(|k| base * down[k] + height * ray[k])
        };
        [along(0), along(1), down]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [f64; 2] = [800.0, 500.0];

    fn cameras() -> Vec<Camera> {
        let mut cameras = Vec::new();
        for kind in [ViewKind::Above, ViewKind::Perspective] {
            for (azimuth_rad, elevation_rad) in [(-1.9, 0.5), (0.3, 1.2), (2.8, 0.2)] {
                let base = Camera { kind, azimuth_rad, elevation_rad, ..Camera::default() };
                cameras.push(Camera { target_m: [3.0e6, -4.0e5], distance_m: 40.0, ..base });
                cameras.push(Camera { target_m: [12.0, 5.0], distance_m: 300.0, ..base });
            }
        }
        cameras
    }

    #[test]
    fn the_ground_under_a_pixel_is_drawn_at_that_pixel() {
        for camera in cameras() {
            let projection = Projection::new(&camera, SIZE);
            for pixel in [[400.0, 250.0], [100.0, 400.0], [700.0, 330.0]] {
                let Some([x, y]) = projection.ground_at(pixel) else { continue };
                let [px, py, _] = projection.project([x, y, 0.0]).unwrap();
                let off = (px - pixel[0]).hypot(py - pixel[1]);
                assert!(off < 1e-5, "{camera:?} {pixel:?}: {px}, {py}");
                let map = projection.ground_map();
                let at_pixel = |row: [f64; 3]| row[0] + row[1] * pixel[0] + row[2] * pixel[1];
                let [mx, my, d] = map.map(at_pixel);
                let again = [camera.target_m[0] + mx / d, camera.target_m[1] + my / d];
                let off = (again[0] - x).hypot(again[1] - y);
                assert!(off < 1e-6 * camera.distance_m, "{camera:?} {pixel:?}: {again:?}");
            }
        }
    }

    #[test]
    fn a_picture_that_is_less_wide_holds_the_width_that_was_seen() {
        let camera = Camera { kind: ViewKind::Above, distance_m: 40.0, ..Camera::default() };
        let width_m = |camera: &Camera, size: [f64; 2]| {
            let projection = Projection::new(camera, size);
            let x_m = |px: f64| projection.ground_at([px, size[1] / 2.0]).unwrap()[0];
            x_m(size[0]) - x_m(0.0)
        };
        let [seen, narrow, wide] = [[800.0, 200.0], [320.0, 180.0], [900.0, 100.0]];
        let held = camera.holding_width(seen[0] / seen[1], narrow[0] / narrow[1]);
        assert!((width_m(&held, narrow) - width_m(&camera, seen)).abs() < 1e-9, "{held:?}");
        let as_wide = camera.holding_width(seen[0] / seen[1], wide[0] / wide[1]);
        assert_eq!(as_wide.distance_m, camera.distance_m, "what is wider cuts nothing off");
    }

    #[test]
    fn the_target_is_in_the_middle_and_y_points_up() {
        for camera in cameras() {
            let projection = Projection::new(&camera, SIZE);
            let [x, y] = camera.target_m;
            let [px, py, _] = projection.project([x, y, 0.0]).unwrap();
            assert!((px - 400.0).abs() < 1e-6 && (py - 250.0).abs() < 1e-6, "{camera:?}");
            let [_, above, _] = projection.project([x, y, 1.0]).unwrap();
            assert!(above <= py, "{camera:?}: what is higher is drawn higher");
        }
        let above = Projection::new(&Camera::default(), SIZE);
        let [x, y, _] = above.project([1.0, 2.0, 0.0]).unwrap();
        assert!(x > 400.0 && y < 250.0, "X to the right, Y up");
    }

    #[test]
    fn panning_keeps_the_ground_under_the_pointer_and_so_does_zooming() {
        for camera in cameras() {
            let (from, to) = ([380.0, 300.0], [430.0, 360.0]);
            let held = Projection::new(&camera, SIZE).ground_at(from).unwrap();
            let after = Projection::new(&camera.panned(SIZE, [from, to]), SIZE);
            let [x, y] = after.ground_at(to).unwrap();
            let off_m = (x - held[0]).hypot(y - held[1]);
            assert!(off_m < 1e-6 * camera.distance_m, "{camera:?}: {off_m}");
            let near = Projection::new(&camera.zoomed(SIZE, from, 1.7), SIZE);
            let [x, y] = near.ground_at(from).unwrap();
            let off_m = (x - held[0]).hypot(y - held[1]);
            assert!(off_m < 1e-6 * camera.distance_m, "{camera:?}: {off_m}");
        }
    }

    #[test]
    fn what_is_fitted_is_seen_and_fills_the_picture() {
        for camera in cameras() {
            let [x, y] = camera.target_m;
            let corners = [[-20.0, -4.0], [45.0, -4.0], [45.0, 12.0], [-20.0, 12.0]]
                .map(|[dx, dy]| [x + dx, y + dy]);
            let fitted = camera.fitted(&corners, SIZE);
            let projection = Projection::new(&fitted, SIZE);
            let seen: Vec<[f64; 3]> =
                corners.iter().map(|c| projection.project([c[0], c[1], 0.0]).unwrap()).collect();
            let spans = [0, 1].map(|axis| {
                let values = || seen.iter().map(|at| at[axis]);
                let (low, high) = (values().fold(9e9, f64::min), values().fold(-9e9, f64::max));
                assert!(low >= 0.0 && high <= SIZE[axis], "{camera:?}: {low} to {high}");
                (high - low) / SIZE[axis]
            });
            assert!(spans[0].max(spans[1]) > 0.6, "{camera:?}: {spans:?}");
        }
    }

    #[test]
    fn numbers_that_are_no_numbers_are_replaced() {
        let camera = Camera {
            kind: ViewKind::Perspective,
            target_m: [f64::NAN, 1.0],
            azimuth_rad: f64::INFINITY,
            elevation_rad: 9.0,
            distance_m: -3.0,
        };
        let limited = camera.limited();
        assert_eq!(limited.target_m, [0.0, 1.0]);
        assert!(limited.azimuth_rad.is_finite() && limited.elevation_rad < FRAC_PI_2);
        assert_eq!(limited.distance_m, DISTANCES_M[0]);
    }
}
