//! Probability density of a planar mixture on a rectangular grid, computed row by row.
//!
//! Along a row the exponent of a part is a quadratic function of the column, so that each value
//! follows from the one before by two multiplications:
//!
//! ```text
//! v_i = c exp(−(a u_i² + d dy²)/2)      u_i = u_0 + i h      u = dx − k dy
//! v_{i+n} = v_i s_i                     s_{i+n} = s_i g      g = exp(−a n² h²)
//! ```
//!
//! A block of n neighbouring columns is computed at once. After every [`N_BLOCKS`] blocks the
//! products are started again from the exponential function, before rounding errors reach 1e-10 of
//! a value. Rows are independent of each other, and within a row the parts are added in their
//! order, so that the values do not depend on the number of threads.
//!
//! Checked against the density by the inverse of each covariance.

use std::f64::consts::TAU;

use rayon::prelude::*;

use crate::numerics::Lanes;
use crate::uncertainty::{PlanarMixture, PlanarPart};

/// Distance from the mean, in standard deviations, beyond which a part is neglected: e^(−8²/2) =
/// 1e-14.
const REACH: f64 = 8.0;

/// Number n of columns that are computed at once.
const LANES: usize = 8;

/// Number of blocks of columns after which the products are started again.
const N_BLOCKS: usize = 64;

/// A rectangular grid of points, stored row by row from the lowest y upwards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanarGrid {
    /// Lowest x and y of the points, m.
    pub low_m: [f64; 2],
    /// Distance between neighbouring points along x and y, m.
    pub step_m: [f64; 2],
    /// Number of points along x and y.
    pub size: [usize; 2],
}

/// Weighted density of a part in the form in which it is computed:
/// `c exp(−(a (dx − k dy)² + d dy²)/2)` at the offset (dx, dy) from the mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanarKernel {
    /// Mean [x, y], m.
    pub mean: [f64; 2],
    /// k: change of the conditional mean of x for each metre of y.
    pub slope: f64,
    /// [a, d]: inverse of the conditional variance of x given y, and inverse of the variance of y,
    /// 1/m².
    pub precision: [f64; 2],
    /// c: density at the mean, the weight divided by 2π √det P, 1/m².
    pub peak: f64,
}

impl PlanarGrid {
    /// Grid over the rectangle `[low, high]`, m, with points on its edges.
    ///
    /// - `size`: number of points along x and y.
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
    /// Density at the points of a grid, 1/m², row by row. A part is neglected beyond eight standard
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
    /// Half width and half height of the rectangle outside of which the part is neglected, m.
    pub fn reach_m(&self) -> [f64; 2] {
        let [x_given_y, y] = self.precision.map(f64::recip);
        [x_given_y + self.slope * self.slope * y, y].map(|variance| REACH * variance.sqrt())
    }

    /// Kernel of a part.
    pub(super) fn from_part(part: &PlanarPart) -> Self {
        let [xx, xy, yy] = part.covariance;
        let determinant = xx * yy - xy * xy;
        Self {
            mean: part.mean,
            slope: xy / yy,
            precision: [yy / determinant, 1.0 / yy],
            peak: part.weight / (TAU * determinant.sqrt()),
        }
    }

    /// Density at a position [x, y] in m, 1/m².
    #[inline(always)]
    pub(super) fn density<T: Lanes>(&self, [x, y]: [T; 2]) -> T {
        let dy = y - self.mean[1];
        self.exponent(x - self.mean[0] - dy * self.slope, dy).exp() * self.peak
    }

    /// Density at an offset from the mean, 1/m².
    ///
    /// - `u`: distance of x from its conditional mean given y, m.
    /// - `dy`: distance of y from its mean, m.
    fn at(&self, u: f64, dy: f64) -> f64 {
        // Far away it is 0, which that of `Lanes` is not.
        self.peak * f64::exp(self.exponent(u, dy))
    }

    #[inline(always)]
    fn exponent<T: Lanes>(&self, u: T, dy: T) -> T {
        let [a, d] = self.precision;
        (u * a * u + dy * d * dy) * -0.5
    }
}

/// A kernel, with the factors by which its values follow from each other along the rows of a grid.
/// The symbols are those of [`RowKernel::new`].
struct RowKernel {
    kernel: PlanarKernel,
    /// Lowest x of the row, m, and distance between its points, m.
    low_m: f64,
    step_m: f64,
    /// v_l / (v_0 r^l) for lane l, where r = v_1 / v_0 is the ratio of the first two values.
    start: [f64; LANES],
    /// s_l / r^n for lane l.
    ratio: [f64; LANES],
    /// g: the factor by which s changes from one block to the next.
    bend: f64,
}

impl RowKernel {
    /// Computes the factors. From a point to its neighbour, the ratio of successive values falls by
    /// the factor b = exp(−a h²). Hence
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

    /// Adds the density of the part to the points of a row.
    ///
    /// - `y`: of the row, m.
    /// - `sums`: the values of the row, followed by `LANES` values beyond its end that are not
    ///   used.
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

    /// Adds the density of the part to consecutive blocks of a row. The first point must be within
    /// the reach of the part. Then no product overflows: r^n is largest, e^256, for points eight
    /// standard deviations apart.
    ///
    /// - `u`, `dy`: offset of the first point, as in [`PlanarKernel::at`].
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

    /// Density by the inverse of each covariance, Σ w N, 1/m².
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
