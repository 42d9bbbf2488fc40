//! The ground itself: its picture, and surfaces and lines on it.

use egui::Color32;

use crate::scene::Projection;
use crate::scene::camera::NEAR_M;
use crate::scene::grid::{grid_step, line_cover};
use crate::scene::ground::Ground;
use crate::scene::lines::{Stroke, over};
use crate::scene::row_map::RowMap;
use crate::scene::shade::{ground_color, ground_line_color, lane_color, picture_wash, zone_color};
use impactlab_document::scene::{
    AreaKind, GroundArea, GroundLine, GroundLineKind, GroundPicture, SceneGround,
};

/// Opacity of the tint of a zone and of its hatching.
pub const TINT: f32 = 0.13;
pub const HATCH: f32 = 0.62;
/// Lines of the hatching between coarse lines of the grid.
const HATCH_PER_COARSE: f64 = 5.0;
/// Width of the border of a zone, points.
const BORDER_POINTS: f64 = 1.6;
/// Longest piece of a line that has the same width all along it in perspective, m.
const PIECE_M: f64 = 4.0;
/// Pieces of a straight line, at most.
const MAX_PIECES: f64 = 200.0;

/// What of the ground is prepared once for a picture.
#[derive(Default)]
pub struct Underlay<'a> {
    picture: Option<PlacedPicture<'a>>,
    areas: Vec<SeenArea>,
}

/// A picture of the ground as it is seen.
struct PlacedPicture<'a> {
    picture: &'a GroundPicture,
    /// Pixels of the picture per metre, and its pixel under the point that is looked at.
    per_m: [[f32; 2]; 2],
    target: [f32; 2],
    dark: bool,
}

/// A surface as it is seen.
pub struct SeenArea {
    /// Corners of its border in the picture, without what is behind the camera.
    pub corners: Vec<[f64; 2]>,
    /// First row, and the one after the last.
    rows: [f64; 2],
    /// Its colour.
    pub color: Color32,
    /// Lines on it.
    pub hatch: Option<Hatch>,
}

/// Parallel lines across X and Y.
pub struct Hatch {
    /// Their distance, m.
    pub step_m: f32,
    /// Sum of the coordinates of the point that is looked at within that distance, m.
    pub phase_m: f32,
}

impl<'a> Underlay<'a> {
    /// What is below the scene of a ground.
    pub fn new(ground: &Ground<'a>) -> Self {
        let Some(site) = ground.scene.ground.as_deref() else { return Self::default() };
        let picture = site.picture.as_deref();
        let picture = picture.map(|picture| PlacedPicture::new(picture, ground));
        Self { areas: seen_areas(ground), picture }
    }

    /// Fills a row with the ground.
    pub fn fill_row(&self, row: &mut [Color32], py: f32, map: &RowMap, dark: bool) {
        row.fill(ground_color(dark));
        if let Some(picture) = &self.picture {
            picture.fill_row(row, map);
        }
        for area in &self.areas {
            area.fill_row(row, f64::from(py), map);
        }
    }
}

impl<'a> PlacedPicture<'a> {
    fn new(picture: &'a GroundPicture, ground: &Ground<'_>) -> Self {
        let map = &picture.map;
        let columns = [map.pixels_along([1.0, 0.0]), map.pixels_along([0.0, 1.0])];
        Self {
            picture,
            per_m: columns.map(|column| column.map(|value| value as f32)),
            target: map.pixel(ground.projection.target_m()).map(|value| value as f32),
            dark: ground.dark,
        }
    }

    fn pixels(&self, [x, y]: [f32; 2]) -> [f32; 2] {
        let [along, across] = self.per_m;
        [x * along[0] + y * across[0], x * along[1] + y * across[1]]
    }

    fn fill_row(&self, row: &mut [Color32], map: &RowMap) {
        let (wash, under) = (picture_wash(self.dark), ground_color(self.dark));
        for (column, pixel) in row.iter_mut().enumerate() {
            let Some(spot) = map.at(column) else { continue };
            let [u, v] = self.pixels(spot.place);
            let middle = [u + self.target[0], v + self.target[1]];
            if !self.picture.holds(middle) {
                continue;
            }
            let (dx, dy) = (map.changes(&spot, 0), map.changes(&spot, 1));
            let [right, down] = [0, 1].map(|i| self.pixels([dx[i], dy[i]]));
            let [a, b] = [right, down].map(|[u, v]| (u * u + v * v).sqrt());
            let (along, width) = if a > b { (right, b) } else { (down, a) };
            let [red, green, blue, opacity] = self.picture.mean_along(middle, along, width);
            let [r, g, b] = [red, green, blue].map(|value| (value + 0.5) as u8);
            let seen = over(Color32::from_rgb(r, g, b), under, wash);
            *pixel = over(*pixel, seen, opacity / 255.0);
        }
    }
}

/// The surfaces on the ground that are in the picture: no lanes over a picture of the ground.
pub fn seen_areas(ground: &Ground<'_>) -> Vec<SeenArea> {
    let site = ground.scene.ground.as_deref();
    let is_seen = |area: &&GroundArea| !ground.has_picture() || area.kind != AreaKind::Lane;
    let areas = site.into_iter().flat_map(|site| &site.areas).filter(is_seen);
    areas.filter_map(|area| SeenArea::new(area, ground)).collect()
}

impl SeenArea {
    fn new(area: &GroundArea, ground: &Ground<'_>) -> Option<Self> {
        let corners = seen_corners(&area.border_m, ground.projection)?;
        let ys = corners.iter().map(|corner| corner[1]);
        let rows = ys.fold([f64::MAX, f64::MIN], |[l, h], y| [l.min(y), h.max(y)]);
        let hatch = (area.kind == AreaKind::FrictionZone).then(|| Hatch::new(ground));
        let color = match area.kind {
            AreaKind::Lane => lane_color(ground.dark),
            AreaKind::FrictionZone => zone_color(ground.dark),
        };
        Some(Self { corners, rows, color, hatch })
    }

    fn fill_row(&self, row: &mut [Color32], py: f64, map: &RowMap) {
        let [first, end] = self.rows;
        if !(first..end).contains(&py) {
            return;
        }
        let sides = self.corners.iter().zip(self.corners.iter().cycle().skip(1));
        let crossing = |(from, to): (&[f64; 2], &[f64; 2])| {
            ((from[1] > py) != (to[1] > py))
                .then(|| from[0] + (to[0] - from[0]) * (py - from[1]) / (to[1] - from[1]))
        };
        let mut xs: Vec<f64> = sides.filter_map(crossing).collect();
        xs.sort_by(f64::total_cmp);
        for span in xs.chunks_exact(2) {
            let limit = row.len() as f64;
            let (from, to) = (span[0].clamp(0.0, limit), span[1].clamp(0.0, limit));
            let columns = from as usize..(to.ceil() as usize).min(row.len());
            for column in columns {
                let left = (column as f64).max(from);
                let cover = ((column as f64 + 1.0).min(to) - left).clamp(0.0, 1.0) as f32;
                if let Some(pixel) = row.get_mut(column) {
                    *pixel = over(*pixel, self.color, cover * self.opacity(column, map));
                }
            }
        }
    }

    /// Opacity at a column, 0 to 1.
    fn opacity(&self, column: usize, map: &RowMap) -> f32 {
        let Some(hatch) = &self.hatch else { return 1.0 };
        let Some(spot) = map.at(column) else { return TINT };
        let [x, y] = spot.place;
        let change = map.change(&spot, 0).max(map.change(&spot, 1));
        let line = line_cover(x + y + hatch.phase_m, 1.4 * change, hatch.step_m);
        TINT + (HATCH - TINT) * line
    }
}

impl Hatch {
    /// The hatching of the zones of a scene.
    pub fn new(ground: &Ground<'_>) -> Self {
        let (_, step_m) = grid_step(ground.projection, ground.points, ground.scene.units);
        let step_m = step_m / HATCH_PER_COARSE;
        let [x, y] = ground.projection.target_m();
        let phase_m = (x.rem_euclid(step_m) + y.rem_euclid(step_m)).rem_euclid(step_m);
        Self { step_m: step_m as f32, phase_m: phase_m as f32 }
    }
}

/// The corners of a border in the picture; cut where it would be behind the camera. `None` if all of it is.
fn seen_corners(border_m: &[[f64; 2]], projection: &Projection) -> Option<Vec<[f64; 2]>> {
    let near = 2.0 * NEAR_M;
    let points: Vec<[f64; 3]> =
        border_m.iter().map(|[x, y]| projection.in_camera([*x, *y, 0.0])).collect();
    let mut clipped = Vec::with_capacity(points.len() + 2);
    for (from, to) in points.iter().zip(points.iter().cycle().skip(1)) {
        let is_seen = |point: &[f64; 3]| projection.is_parallel() || point[2] >= near;
        if is_seen(from) {
            clipped.push(*from);
        }
        if is_seen(from) != is_seen(to) {
            let share = (near - from[2]) / (to[2] - from[2]);
            clipped.push(std::array::from_fn(|i| from[i] + (to[i] - from[i]) * share));
        }
    }
    let seen =
        clipped.into_iter().map(|point| projection.in_picture(point).map(|[x, y, _]| [x, y]));
    let seen: Vec<[f64; 2]> = seen.collect::<Option<_>>()?;
    let is_finite = seen.iter().flatten().all(|value| value.is_finite());
    (seen.len() > 2 && is_finite).then_some(seen)
}

/// The lines on the ground, and the borders of zones.
pub fn ground_strokes(ground: &Ground<'_>, site: &SceneGround, strokes: &mut Vec<Stroke>) {
    for line in &site.lines {
        add_line(ground, line, strokes);
    }
    let zones = site.areas.iter().filter(|area| area.kind == AreaKind::FrictionZone);
    for zone in zones {
        let closed = zone.border_m.iter().chain(zone.border_m.first());
        let points: Vec<[f64; 2]> = closed.copied().collect();
        let half_width = (BORDER_POINTS * ground.points / 2.0) as f32;
        let color = zone_color(ground.dark);
        for pair in points.windows(2) {
            if let Some(ends) = ground.piece([pair[0], pair[1]], 0.0) {
                let ends = ends.map(|end| end.map(|value| value as f32));
                strokes.push(Stroke { ends, half_width, color, opacity: 1.0 });
            }
        }
    }
}

/// Adds a line with its width in metres; where that is less than can be seen, it is paler.
fn add_line(ground: &Ground<'_>, line: &GroundLine, strokes: &mut Vec<Stroke>) {
    let color = ground_line_color(line.kind, ground.dark);
    let is_thin = matches!(line.kind, GroundLineKind::Drawing | GroundLineKind::Surveyed);
    let least = if is_thin { 1.0 } else { 0.8 } * ground.points;
    for pair in line.points_m.windows(2) {
        let way = [pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]];
        let is_split = !ground.projection.is_parallel() && line.width_m > 0.0;
        let n = match is_split {
            true => (way[0].hypot(way[1]) / PIECE_M).ceil().clamp(1.0, MAX_PIECES),
            false => 1.0,
        };
        let at = |i: usize| [0, 1].map(|k| pair[0][k] + way[k] * i as f64 / n);
        for i in 0..n as usize {
            let ends_m = [at(i), at(i + 1)];
            let Some(ends) = ground.piece(ends_m, 0.0) else { continue };
            let middle = [0, 1].map(|k| (ends_m[0][k] + ends_m[1][k]) / 2.0);
            let width = line.width_m * ground.projection.pixels_per_m(middle);
            let opacity = if line.width_m > 0.0 { (width / least).min(1.0) } else { 1.0 };
            strokes.push(Stroke {
                ends: ends.map(|end| end.map(|value| value as f32)),
                half_width: (width.max(least) / 2.0) as f32,
                color,
                opacity: opacity as f32,
            });
        }
    }
}
