//! The ground under pixels that lie side by side, computed in vector registers.

use crate::scene::grid::Grid;
use crate::scene::row_map::RowMap;

/// Number of pixels of a span.
pub const SPAN: usize = 64;

/// What the ground is under some pixels of a row, number by number.
pub struct Span {
    x_m: [f32; SPAN],
    y_m: [f32; SPAN],
    fine: [f32; SPAN],
    coarse: [f32; SPAN],
    haze: [f32; SPAN],
    /// 1 in the sky, else 0.
    sky: [f32; SPAN],
}

/// What the ground is under a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundPixel {
    /// The place, off the point that is looked at, m.
    pub place: [f32; 2],
    /// How far fine and coarse lines of the grid cover it, 0 to 1.
    pub lines: [f32; 2],
    /// How far it has faded into the sky, 0 to 1.
    pub haze: f32,
    /// Whether it is above the horizon, so that nothing else counts.
    pub is_sky: bool,
}

impl Default for Span {
    fn default() -> Self {
        let [x_m, y_m, fine, coarse, haze, sky] = [[0.0; SPAN]; 6];
        Self { x_m, y_m, fine, coarse, haze, sky }
    }
}

impl Span {
    /// Looks at the ground under a row of pixels from a column on, in perspective.
    pub fn look(&mut self, map: &RowMap, grid: &Grid, from: usize) {
        pulp::Arch::new().dispatch(Look { span: self, map, grid, from: from as f32 });
    }

    /// Has the grid and no haze, as from above.
    ///
    /// - `columns`: how far lines across X cover each column;
    /// - `row`: how far lines across Y cover the row.
    pub fn set_parallel(&mut self, columns: &[[f32; 2]], row: [f32; 2]) {
        for ((fine, coarse), column) in self.fine.iter_mut().zip(&mut self.coarse).zip(columns) {
            [*fine, *coarse] = [0, 1].map(|line| column[line].max(row[line]));
        }
        self.haze = [0.0; SPAN];
    }

    /// The pixels, from the left.
    pub fn pixels(&self) -> impl Iterator<Item = GroundPixel> {
        (0..SPAN).map(|idx| GroundPixel {
            place: [self.x_m[idx], self.y_m[idx]],
            lines: [self.fine[idx], self.coarse[idx]],
            haze: self.haze[idx],
            is_sky: self.sky[idx] > 0.0,
        })
    }
}

/// Fills a span. A closure in its place would be a function of its own, compiled without the vector
/// instructions.
struct Look<'a> {
    span: &'a mut Span,
    map: &'a RowMap,
    grid: &'a Grid,
    from: f32,
}

impl pulp::NullaryFnOnce for Look<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { span, map, grid, from } = self;
        let Span { x_m, y_m, fine, coarse, haze, sky } = span;
        let ([eye_x, eye_y], [near_m, far_m]) = (grid.eye_m, grid.haze_m);
        for idx in 0..SPAN {
            let spot = map.spot(from + idx as i32 as f32 + 0.5);
            let (across_x, across_y) = (grid.cover(0, map, &spot), grid.cover(1, map, &spot));
            let (dx, dy) = (spot.place[0] - eye_x, spot.place[1] - eye_y);
            let away_m = (dx * dx + dy * dy).sqrt();
            haze[idx] = ((away_m - near_m) / (far_m - near_m)).clamp(0.0, 1.0);
            [x_m[idx], y_m[idx]] = spot.place;
            fine[idx] = across_x[0].max(across_y[0]);
            coarse[idx] = across_x[1].max(across_y[1]);
            sky[idx] = if spot.is_sky() { 1.0 } else { 0.0 };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_span_has_the_numbers_of_each_pixel() {
        let grid = Grid {
            map: [[-14.0, 0.02, 0.004], [30.0, 0.005, -0.02], [-0.2, 3e-6, 0.0011]],
            phase_m: [0.3, 1.7],
            steps_m: [0.4, 2.0],
            eye_m: [-12.0, -9.0],
            haze_m: [50.0, 240.0],
            density_m: None,
        };
        let (mut n_sky, mut n_lines, mut n_hazy) = (0, 0, 0);
        for (row, from) in (0..1080).flat_map(|row| [0, 64, 1856].map(|from| (row, from))) {
            let map = RowMap::new(grid.map, row as f32 + 0.5);
            let mut span = Span::default();
            span.look(&map, &grid, from);
            for (idx, pixel) in span.pixels().enumerate() {
                let Some(spot) = map.at(from + idx) else {
                    assert!(pixel.is_sky);
                    n_sky += 1;
                    continue;
                };
                let [x, y] = [0, 1].map(|axis| grid.cover(axis, &map, &spot));
                let lines = [0, 1].map(|line| x[line].max(y[line]));
                let [dx, dy] = [0, 1].map(|axis| spot.place[axis] - grid.eye_m[axis]);
                let far_m = (dx * dx + dy * dy).sqrt();
                let haze = match far_m > grid.haze_m[0] {
                    true => (far_m - grid.haze_m[0]) / (grid.haze_m[1] - grid.haze_m[0]),
                    false => 0.0,
                };
                let haze = haze.clamp(0.0, 1.0);
                assert_eq!(pixel, GroundPixel { place: spot.place, lines, haze, is_sky: false });
                n_lines += usize::from(lines[0] > 0.0);
                n_hazy += usize::from(haze > 0.0);
            }
        }
        assert!(n_sky > 1000 && n_lines > 1000 && n_hazy > 1000, "{n_sky} {n_lines} {n_hazy}");
    }

    #[test]
    fn from_above_the_columns_have_the_lines_across_x() {
        let mut span = Span { haze: [1.0; SPAN], ..Span::default() };
        span.set_parallel(&[[0.25, 0.0], [0.75, 0.5]], [0.5, 0.125]);
        let lines: Vec<_> = span.pixels().take(2).map(|pixel| pixel.lines).collect();
        assert_eq!(lines, [[0.5, 0.125], [0.75, 0.5]]);
        assert!(span.pixels().all(|pixel| pixel.haze == 0.0));
    }
}
