//! Density of a planar mixture on a grid, row by row.
//!
//! Along a row the exponent of a part is a quadratic in the column, so its values follow from two
//! multiplications each:
//!
//! ```text
//! v_i = c exp(−(a u_i² + d dy²)/2)      u_i = u_0 + i h      u = dx − k dy
//! v_{i+n} = v_i s_i                     s_{i+n} = s_i g      g = exp(−a n² h²)
//! ```
//!
//! n neighbours are computed at once. Both products start anew every [`N_BLOCKS`] blocks, before
//! rounding reaches 1e-10 of a value. Rows are independent, and a row adds the parts up in their
//! order: the same values for any number of threads.

use std::f64::consts::TAU;

use rayon::prelude::*;

use crate::uncertainty::{PlanarMixture, PlanarPart};

/// Beyond this many standard deviations a part adds nothing: e^(−8²/2) = 1e-14.
const REACH: f64 = 8.0;

/// Columns that are computed at once.
const LANES: usize = 8;

/// Blocks of columns until the products start anew.
const N_BLOCKS: usize = 64;

/// Points of a rectangle, row by row from the lowest y on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanarGrid {
    /// Lowest x and y of the points, m.
    pub low_m: [f64; 2],
    /// Between neighbouring points, m.
    pub step_m: [f64; 2],
    /// Points along x and y.
    pub size: [usize; 2],
}

/// A part as its density is computed: `c exp(−(a (dx − k dy)² + d dy²)/2)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanarKernel {
    /// Mean [x, y], m.
    pub mean: [f64; 2],
    /// k: how the mean of x given y moves with y.
    pub slope: f64,
    /// [a, d]: inverse variances of x given y, and of y, 1/m².
    pub precision: [f64; 2],
    /// c: weight over 2π √det P, 1/m².
    pub peak: f64,
}

impl PlanarGrid {
    /// About a rectangle, with points on its edges.
    pub fn over([low_m, high_m]: [[f64; 2]; 2], size: [usize; 2]) -> Self {
        let step = |axis: usize| {
            (high_m[axis] - low_m[axis]) / (size[axis].saturating_sub(1)).max(1) as f64
        };
        Self { low_m, step_m: [step(0), step(1)], size }
    }

    /// Area of a cell, m².
    pub fn cell_m2(&self) -> f64 {
        self.step_m[0] * self.step_m[1]
    }
}

impl PlanarMixture {
    /// Density at the points of a grid, 1/m², row by row. A part adds nothing beyond eight standard
    /// deviations, where it is below 1e-13 of its peak.
    pub fn density_on(&self, grid: &PlanarGrid) -> Vec<f64> {
        let [n_columns, n_rows] = grid.size;
        let parts: Vec<RowKernel> =
            self.kernels().into_iter().map(|kernel| RowKernel::new(kernel, grid)).collect();
        let mut values = vec![0.0; n_columns * n_rows];
        let fill = |sums: &mut Vec<f64>, (row_idx, row): (usize, &mut [f64])| {
            sums.clear();
            sums.resize(n_columns + LANES, 0.0);
            let y = grid.low_m[1] + row_idx as f64 * grid.step_m[1];
            parts.iter().for_each(|part| part.add_to_row(y, sums));
            row.copy_from_slice(&sums[..n_columns]);
        };
        values.par_chunks_mut(n_columns.max(1)).enumerate().for_each_init(Vec::new, fill);
        values
    }
}

impl PlanarKernel {
    /// Half width and half height of the rectangle outside of which it adds nothing, m.
    pub fn reach_m(&self) -> [f64; 2] {
        let [x_given_y, y] = self.precision.map(f64::recip);
        [x_given_y + self.slope * self.slope * y, y].map(|variance| REACH * variance.sqrt())
    }

    pub(super) fn of(part: &PlanarPart) -> Self {
        let [xx, xy, yy] = part.covariance;
        let determinant = xx * yy - xy * xy;
        Self {
            mean: part.mean,
            slope: xy / yy,
            precision: [yy / determinant, 1.0 / yy],
            peak: part.weight / (TAU * determinant.sqrt()),
        }
    }

    pub(super) fn density(&self, [x, y]: [f64; 2]) -> f64 {
        let dy = y - self.mean[1];
        self.at(x - self.mean[0] - self.slope * dy, dy)
    }

    /// - `u`: from the mean of x given y, m.
    /// - `dy`: from the mean of y, m.
    fn at(&self, u: f64, dy: f64) -> f64 {
        let [a, d] = self.precision;
        self.peak * (-0.5 * (a * u * u + d * dy * dy)).exp()
    }
}

/// A kernel, and how its values follow each other along the rows of a grid.
struct RowKernel {
    kernel: PlanarKernel,
    /// Lowest x of the row and between its points, m.
    low_m: f64,
    step_m: f64,
    /// v_l over v_0 r^l, where r = s_0 for neighbours (n = 1).
    start: [f64; LANES],
    /// s_l over r^n.
    ratio: [f64; LANES],
    /// g.
    bend: f64,
}

impl RowKernel {
    /// From neighbour to neighbour, the ratio of values falls by b = exp(−a h²). Hence
    ///
    /// ```text
    /// v_l = v_0 r^l b^(l(l−1)/2)      s_l = v_{l+n}/v_l = r^n b^(n l + n(n−1)/2)      g = b^(n²)
    /// ```
    fn new(kernel: PlanarKernel, grid: &PlanarGrid) -> Self {
        let (low_m, step_m) = (grid.low_m[0], grid.step_m[0]);
        let power = |n: usize| (-kernel.precision[0] * step_m * step_m * n as f64).exp();
        let of_lane = |lane: usize| power(LANES * lane + LANES * (LANES - 1) / 2);
        Self {
            start: std::array::from_fn(|lane| power(lane * lane.saturating_sub(1) / 2)),
            ratio: std::array::from_fn(of_lane),
            bend: power(LANES * LANES),
            kernel,
            low_m,
            step_m,
        }
    }

    /// - `sums`: of the row, and of `LANES` points beyond its end.
    fn add_to_row(&self, y: f64, sums: &mut [f64]) {
        let dy = y - self.kernel.mean[1];
        let [a, d] = self.kernel.precision;
        let left = REACH * REACH - d * dy * dy;
        if left < 0.0 {
            return;
        }
        let (centre, half) = (self.kernel.mean[0] + self.kernel.slope * dy, (left / a).sqrt());
        let n_columns = sums.len() - LANES;
        let column = |x: f64| ((x - self.low_m) / self.step_m).clamp(0.0, n_columns as f64).ceil();
        let (first, last) = (column(centre - half) as usize, column(centre + half) as usize);
        for from in (first..last).step_by(LANES * N_BLOCKS) {
            let n_blocks = (last - from).div_ceil(LANES).min(N_BLOCKS);
            let u = self.low_m + from as f64 * self.step_m - centre;
            self.add_to_blocks(u, dy, &mut sums[from..from + LANES * n_blocks]);
        }
    }

    /// At the first point the part is within its reach. So no product overflows: r^n is largest for
    /// points eight standard deviations apart, e^256.
    ///
    /// - `u`, `dy`: of the first point, as in [`PlanarKernel::at`].
    fn add_to_blocks(&self, u: f64, dy: f64, sums: &mut [f64]) {
        let a = self.kernel.precision[0];
        let step_ratio = (-a * self.step_m * (u + 0.5 * self.step_m)).exp();
        let (mut value, mut ratio, bend) = (self.start, self.ratio, self.bend);
        let mut power = 1.0;
        let first = self.kernel.at(u, dy);
        for start in &mut value {
            *start *= first * power;
            power *= step_ratio;
        }
        ratio.iter_mut().for_each(|ratio| *ratio *= power);
        pulp::Arch::new().dispatch(
            #[inline(always)]
            || {
                for block in sums.chunks_exact_mut(LANES) {
                    for lane in 0..LANES {
                        block[lane] += value[lane];
                        value[lane] *= ratio[lane];
                        ratio[lane] *= bend;
                    }
                }
            },
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Σ w N by the inverse of the covariance, 1/m².
    fn plain(mixture: &PlanarMixture, [x, y]: [f64; 2]) -> f64 {
        let density = |part: &PlanarPart| {
            let [xx, xy, yy] = part.covariance;
            let determinant = xx * yy - xy * xy;
            let (dx, dy) = (x - part.mean[0], y - part.mean[1]);
            let square = (yy * dx * dx - 2.0 * xy * dx * dy + xx * dy * dy) / determinant;
            part.weight * (-0.5 * square).exp() / (TAU * determinant.sqrt())
        };
        mixture.parts().iter().map(density).sum()
    }

    fn mixture(covariances: &[[f64; 3]]) -> PlanarMixture {
        let part = |(i, covariance): (usize, &[f64; 3])| PlanarPart {
            weight: 1.0 + i as f64,
            mean: [3.0 * i as f64, 2.0 - i as f64],
            covariance: *covariance,
        };
        PlanarMixture::new(covariances.iter().enumerate().map(part).collect())
    }

    #[test]
    fn a_grid_has_the_values_of_the_plain_formula() {
        let wide = [[400.0, 0.0, 300.0], [900.0, 500.0, 800.0]];
        let narrow = [[1e-4, 0.0, 1e-4], [4e-4, -1e-4, 1e-4]];
        let mixed = [[4.0, 1.0, 1.0], [0.5, -0.3, 2.0], [1e-2, 9e-3, 1e-2], [30.0, 0.0, 9.0]];
        let sizes = [[1, 1], [7, 3], [400, 30], [2000, 9]];
        let cases = [&wide[..], &narrow, &mixed];
        for (mixture, size) in cases.iter().flat_map(|c| sizes.map(|size| (mixture(c), size))) {
            let grid = PlanarGrid { low_m: [-2.0, -3.0], step_m: [0.01, 0.3], size };
            let at = |i: usize| {
                let (column, row) = ((i % size[0]) as f64, (i / size[0]) as f64);
                [grid.low_m[0] + column * grid.step_m[0], grid.low_m[1] + row * grid.step_m[1]]
            };
            let peaks: f64 = mixture.kernels().iter().map(|kernel| kernel.peak).sum();
            for (i, value) in mixture.density_on(&grid).into_iter().enumerate() {
                let plain = plain(&mixture, at(i));
                let error = (value - plain).abs();
                assert!(error < 1e-9 * plain + 1e-13 * peaks, "{size:?} {i}: {value}, {plain}");
            }
        }
    }

    #[test]
    fn coarse_grids_are_finite() {
        for (step, slant) in
            [1e-3, 0.1, 1.0, 8.0, 1e3, 1e8].map(|step| [(step, 0.0), (step, 0.9)]).concat()
        {
            let mixture = mixture(&[[1.0, slant, 1.0], [0.01, 0.0, 4.0]]);
            let low_m = [-7.99 + 0.3 * step, -1.0];
            let grid = PlanarGrid { low_m, step_m: [step, 0.1], size: [40, 20] };
            for (i, value) in mixture.density_on(&grid).into_iter().enumerate() {
                let column = low_m[0] + (i % 40) as f64 * step;
                let plain = plain(&mixture, [column, low_m[1] + (i / 40) as f64 * 0.1]);
                assert!((value - plain).abs() < 1e-9 * plain + 1e-12, "{step}: {value}, {plain}");
            }
        }
    }

    #[test]
    fn threads_change_no_bit() {
        let mixture = mixture(&[[4.0, 1.0, 1.0], [0.5, -0.3, 2.0], [1e-2, 9e-3, 1e-2]]);
        let grid = PlanarGrid::over([[-4.0, -5.0], [9.0, 6.0]], [301, 203]);
        let on = |n_threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads).build().unwrap();
            pool.install(|| mixture.density_on(&grid))
        };
        assert_eq!(on(1), on(3));
        assert!(mixture.density_on(&PlanarGrid { size: [0, 5], ..grid }).is_empty());
    }
}
