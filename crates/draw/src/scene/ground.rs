//! What does not move: ground with its grid, density, and lines on the ground.

use egui::Color32;

use crate::scene::grid::Grid;
use crate::scene::lines::{Rows, Stroke, over};
use crate::scene::row_map::RowMap;
use crate::scene::shade::{grid_colors, ground_color, mixed, role_color, sky_color};
use crate::scene::span::{SPAN, Span};
use crate::scene::underlay::{Underlay, ground_strokes};
use crate::scene::{Projection, camera::NEAR_M};
use impactlab_document::figure::Dashes;
use impactlab_document::scene::{Scene, SceneDensity, SceneLine, SceneRole};

/// Opacity of the largest density.
pub const DENSITY_OPACITY: f32 = 0.72;
/// Least share of the largest density that is drawn.
pub const LEAST_DENSITY_SHARE: f32 = 0.003;
/// Share of the colour of a role in the pale part of a line: a path that is still to come.
const PALE: f32 = 0.45;
/// The same over a picture of the ground.
const PALE_OVER_PICTURE: f32 = 0.68;
/// Opacity of the grid over a picture of the ground.
const GRID_OVER_PICTURE: f32 = 0.3;
/// How far the edge of a line reaches over a picture of the ground, points, and its opacity, so that
/// lines of any colour are seen on any picture.
const CASING_POINTS: f64 = 1.1;
const CASING_OPACITY: f32 = 0.5;
/// Width from which a line has such an edge, points: the edges of many thin ones would hide the picture.
const LEAST_CASED: f64 = 1.0;
/// Shortest dash without its round ends, points.
const LEAST_DASH: f64 = 0.5;
/// Time between the heading ticks along a path, s, and their half length, m.
const TICK_INTERVAL_S: f64 = 0.5;
const TICK_HALF_M: f64 = 0.9;
/// Shortest piece of a line that is drawn by itself, pixels.
const LEAST_PIECE: f64 = 1.2;

/// What a picture of the ground is drawn with.
pub struct Ground<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// The camera.
    pub projection: &'a Projection,
    /// Whether the theme is dark.
    pub dark: bool,
    /// Pixels per point.
    pub points: f64,
}

impl Ground<'_> {
    /// Fills rows with ground, grid and density.
    pub fn fill(&self, rows: &mut Rows<'_>, underlay: &Underlay<'_>) {
        let grid = Grid::new(self);
        let (first, width) = (rows.first, rows.width.max(1));
        let columns = self.covered_columns(&grid, width);
        for (idx, row) in rows.pixels.chunks_mut(width).enumerate() {
            let py = (first + idx) as f32 + 0.5;
            let map = RowMap::new(grid.map, py);
            underlay.fill_row(row, py, &map, self.dark);
            self.fill_row(row, &map, &columns, &grid);
        }
    }

    /// How far the lines of the grid across X cover each column: from above, where that is the same in
    /// every row; else nothing.
    fn covered_columns(&self, grid: &Grid, width: usize) -> Vec<[f32; 2]> {
        if !self.projection.is_parallel() {
            return Vec::new();
        }
        let map = RowMap::new(grid.map, 0.5);
        let cover = |column| map.at(column).map_or([0.0; 2], |spot| grid.cover(0, &map, &spot));
        (0..width).map(cover).collect()
    }

    /// Draws grid, density, haze and sky over a row of ground.
    ///
    /// - `columns`: that of [`Ground::covered_columns`].
    fn fill_row(&self, row: &mut [Color32], map: &RowMap, columns: &[[f32; 2]], grid: &Grid) {
        let first = map.at(0).map_or([0.0; 2], |spot| grid.cover(1, map, &spot));
        let mut span = Span::default();
        for (idx, pixels) in row.chunks_mut(SPAN).enumerate() {
            let from = idx * SPAN;
            span.look(map, grid, from);
            if self.projection.is_parallel() {
                span.set_parallel(columns.get(from..).unwrap_or_default(), first);
            }
            self.fill_span(pixels, &span, grid);
        }
    }

    /// Draws grid, density, haze and sky over pixels that lie side by side.
    fn fill_span(&self, pixels: &mut [Color32], span: &Span, grid: &Grid) {
        let (sky, colors) = (sky_color(self.dark), grid_colors(self.dark));
        let role = role_color(SceneRole::Forecast, self.dark);
        let opacity = self.grid_opacity();
        for (pixel, ground) in pixels.iter_mut().zip(span.pixels()) {
            if ground.is_sky {
                *pixel = sky;
                continue;
            }
            let mut color = *pixel;
            for (line, share) in colors.into_iter().zip(ground.lines) {
                if share > 0.0 {
                    color = over(color, line, opacity * share);
                }
            }
            let [x, y] = ground.place;
            if let (Some(density), Some([low, high])) = (&self.scene.density, grid.density_m)
                && (low[0]..high[0]).contains(&x)
                && (low[1]..high[1]).contains(&y)
            {
                let share = density_share(density, [x - low[0], y - low[1]]);
                if share > LEAST_DENSITY_SHARE {
                    color = over(color, role, DENSITY_OPACITY * share);
                }
            }
            if ground.haze > 0.0 {
                color = over(color, sky, ground.haze);
            }
            *pixel = color;
        }
    }

    /// Opacity of the grid.
    pub fn grid_opacity(&self) -> f32 {
        if self.has_picture() { GRID_OVER_PICTURE } else { 1.0 }
    }

    /// Whether there is a picture of the ground.
    pub fn has_picture(&self) -> bool {
        self.scene.ground.as_ref().is_some_and(|site| site.has_picture())
    }

    /// The lines on the ground, in the order in which they are drawn.
    pub fn strokes(&self) -> Vec<Stroke> {
        let mut strokes = Vec::new();
        if let Some(site) = &self.scene.ground {
            ground_strokes(self, site, &mut strokes);
        }
        for path in &self.scene.paths {
            let color = role_color(path.role, self.dark);
            let share = match (path.role, self.has_picture()) {
                (SceneRole::Muted, _) => 0.75,
                (_, true) => PALE_OVER_PICTURE,
                (_, false) => PALE,
            };
            let color = mixed(ground_color(self.dark), color, share);
            let width = if path.role == SceneRole::Muted { 0.9 } else { 1.6 };
            let points: Vec<[f64; 2]> =
                path.motion.states().iter().map(|state| [state.pose.x_m, state.pose.y_m]).collect();
            let pen = Pen::dashed_if(path.is_dashed, path.role, color, width);
            self.line(&points, pen, &mut strokes);
            if path.has_ticks {
                self.ticks(path, color, &mut strokes);
            }
        }
        for line in self.scene.lines.iter().filter(|line| !line.is_above_cars) {
            self.scene_line(line, &mut strokes);
        }
        for point in &self.scene.points {
            let color = role_color(point.role, self.dark);
            self.line(&[point.at_m, point.at_m], Pen::solid(color, 6.0), &mut strokes);
        }
        for arrow in &self.scene.arrows {
            let pen = Pen::solid(role_color(arrow.role, self.dark), 2.6);
            for line in arrow_lines(arrow.ends_m) {
                self.line(&line, pen, &mut strokes);
            }
        }
        strokes
    }

    /// Adds a line of the scene.
    pub fn scene_line(&self, line: &SceneLine, strokes: &mut Vec<Stroke>) {
        let color = role_color(line.role, self.dark);
        // What has no name is help: where a car started.
        let (color, width) = match line.name.is_empty() {
            true => (mixed(ground_color(self.dark), color, 0.6), 1.1),
            false => (color, 1.8),
        };
        let pen = Pen::dashed_if(line.is_dashed, line.role, color, width);
        self.line(&line.points_m, pen, strokes);
    }

    fn ticks(
        &self,
        path: &impactlab_document::scene::ScenePath,
        color: Color32,
        strokes: &mut Vec<Stroke>,
    ) {
        let motion = &path.motion;
        let start_s = motion.time_s().first().copied().unwrap_or(0.0);
        let n_ticks = ((motion.end_s() - start_s) / TICK_INTERVAL_S).floor().clamp(0.0, 400.0);
        for tick in 1..=n_ticks as usize {
            let pose = motion.at(start_s + tick as f64 * TICK_INTERVAL_S).pose;
            let ends = [-TICK_HALF_M, TICK_HALF_M].map(|x| pose.world_from_body([x, 0.0]));
            // The front end is thicker.
            let front = [pose.world_from_body([0.45 * TICK_HALF_M, 0.0]), ends[1]];
            self.line(&ends, Pen::solid(color, 1.2), strokes);
            self.line(&front, Pen::solid(color, 3.0), strokes);
        }
    }

    /// Adds a line on the ground; over a picture, on a pale edge.
    pub fn line(&self, points_m: &[[f64; 2]], pen: Pen, strokes: &mut Vec<Stroke>) {
        let first = strokes.len();
        self.line_at(points_m, 0.0, pen, strokes);
        if self.has_picture() && pen.width >= LEAST_CASED {
            let edge = |stroke: &Stroke| Stroke {
                half_width: stroke.half_width + (CASING_POINTS * self.points) as f32,
                color: ground_color(self.dark),
                opacity: CASING_OPACITY,
                ..*stroke
            };
            let edges: Vec<Stroke> = strokes[first..].iter().map(edge).collect();
            strokes.splice(first..first, edges);
        }
    }

    /// Adds a level line at a height above the ground, m.
    pub fn line_at(
        &self,
        points_m: &[[f64; 2]],
        height_m: f64,
        pen: Pen,
        strokes: &mut Vec<Stroke>,
    ) {
        let half_width = (pen.width * self.points / 2.0) as f32;
        let mut push = |ends: [[f64; 2]; 2]| {
            let ends = ends.map(|end| end.map(|value| value as f32));
            strokes.push(Stroke { ends, half_width, color: pen.color, opacity: 1.0 });
        };
        let (mut along, mut held) = (0.0, None);
        for pair in points_m.windows(2) {
            let Some([from, to]) = self.piece([pair[0], pair[1]], height_m) else {
                held = None;
                continue;
            };
            let from: [f64; 2] = held.take().unwrap_or(from);
            let length = (to[0] - from[0]).hypot(to[1] - from[1]);
            let is_single = points_m.len() == 2;
            if length < LEAST_PIECE && !is_single {
                held = Some(from);
                continue;
            }
            let Some(dashes) = pen.dashes() else {
                push([from, to]);
                continue;
            };
            let [dash, gap] = dashes.map(|points| points * self.points);
            // What is far off the picture is not dashed.
            if length >= 1e5 {
                continue;
            }
            let mut done = 0.0;
            while done < length {
                let phase = along % (dash + gap);
                let is_drawn = phase < dash;
                let left = if is_drawn { dash - phase } else { dash + gap - phase };
                let next = (done + left.max(0.25)).min(length);
                if is_drawn {
                    let at = |way: f64| {
                        std::array::from_fn(|i| from[i] + (to[i] - from[i]) * way / length)
                    };
                    push([at(done), at(next)]);
                }
                (along, done) = (along + next - done, next);
            }
        }
    }

    /// A straight level piece in the picture, without what is behind the camera.
    pub fn piece(&self, ends_m: [[f64; 2]; 2], height_m: f64) -> Option<[[f64; 2]; 2]> {
        let in_camera = |[x, y]: [f64; 2]| self.projection.in_camera([x, y, height_m]);
        let [mut from, mut to] = ends_m.map(in_camera);
        if !self.projection.is_parallel() {
            let near = 2.0 * NEAR_M;
            if from[2] < near && to[2] < near {
                return None;
            }
            let cut = |inside: [f64; 3], outside: [f64; 3]| {
                let share = (inside[2] - near) / (inside[2] - outside[2]);
                std::array::from_fn(|i| inside[i] + (outside[i] - inside[i]) * share)
            };
            if from[2] < near {
                from = cut(to, from);
            } else if to[2] < near {
                to = cut(from, to);
            }
        }
        let [from, to] = [from, to].map(|point| self.projection.in_picture(point));
        let ends = [from?, to?].map(|[x, y, _]| [x, y]);
        ends.iter().flatten().all(|value| value.is_finite()).then_some(ends)
    }
}

/// With what a line is drawn.
#[derive(Debug, Clone, Copy)]
pub struct Pen {
    /// Colour.
    pub color: Color32,
    /// Width, points.
    pub width: f64,
    /// How it is dashed, if it is.
    pub dashes: Option<Dashes>,
}

impl Pen {
    /// A pen for a continuous line.
    pub fn solid(color: Color32, width: f64) -> Self {
        Self { color, width, dashes: None }
    }

    /// A pen for a line of a role that may be dashed.
    pub fn dashed_if(is_dashed: bool, role: SceneRole, color: Color32, width: f64) -> Self {
        Self { color, width, dashes: is_dashed.then(|| role.dashes()) }
    }

    /// Length and gap of its dashes between the middles of their round ends, points, so that they are seen as
    /// long as in a plan.
    fn dashes(&self) -> Option<[f64; 2]> {
        let dashes = self.dashes?;
        let [dash, gap] = [dashes.length, dashes.gap()].map(f64::from);
        let core = (dash - self.width).max(LEAST_DASH);
        Some([core, dash + gap - core])
    }
}

/// Shaft and head of an arrow on the ground.
pub fn arrow_lines([tail, tip]: [[f64; 2]; 2]) -> [[[f64; 2]; 2]; 3] {
    let way = [tip[0] - tail[0], tip[1] - tail[1]];
    let length = way[0].hypot(way[1]).max(1e-9);
    let (along, head) = (way.map(|v| v / length), (0.3 * length).min(0.8));
    let wing = |side: f64| {
        let across = [-along[1] * side, along[0] * side];
        std::array::from_fn(|i| tip[i] - head * along[i] + 0.45 * head * across[i])
    };
    [[tail, tip], [wing(1.0), tip], [wing(-1.0), tip]]
}

/// A density over its largest value.
///
/// - `off_m`: place off the lowest point of its grid, m, 0 or more; 0 beyond the grid.
fn density_share(density: &SceneDensity, off_m: [f32; 2]) -> f32 {
    let (grid, values) = (&density.map.grid, &density.map.values);
    let [nx, ny] = grid.size;
    let [x, y] = [0, 1].map(|axis| off_m[axis] / grid.step_m[axis] as f32);
    let (i, j) = (x as usize, y as usize);
    if i + 1 >= nx || j + 1 >= ny {
        return 0.0;
    }
    let (fx, fy) = (x - i as f32, y - j as f32);
    let value = |i: usize, j: usize| values.get(j * nx + i).copied().unwrap_or(0.0) as f32;
    let row = |j: usize| value(i, j) + (value(i + 1, j) - value(i, j)) * fx;
    let here = row(j) + (row(j + 1) - row(j)) * fy;
    (here / density.peak as f32).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_document::figure::N_VARIANT_COLORS;

    /// Paths of variants whose colour came again were the same.
    #[test]
    fn variants_of_one_colour_have_dashes_of_their_own_as_long_as_in_a_plan() {
        let width = 2.6;
        let roles = [0, N_VARIANT_COLORS].map(SceneRole::Variant);
        let [first, again] = roles.map(|role| {
            let pen = Pen::dashed_if(true, role, Color32::RED, width);
            let [dash, gap] = pen.dashes().unwrap();
            let plan = role.dashes();
            assert!((dash + width - f64::from(plan.length)).abs() < 1e-6, "{dash}, {plan:?}");
            assert!((gap - width - f64::from(plan.gap())).abs() < 1e-6, "{gap}, {plan:?}");
            [dash, gap]
        });
        assert_ne!(first, again);
        assert_eq!(Pen::solid(Color32::RED, width).dashes(), None);
    }
}
