//! Mixture of normal distributions of a position in the plane: its density, draws, and the regions
//! of highest density that hold the position with a given probability.
//!
//! ```text
//! p(x) = Σ_k w_k N(x; m_k, P_k)
//! region of level q: {x : p(x) ≥ c_q}   with   P(p(X) ≥ c_q) = q
//! ```
//!
//! A region of highest density is the smallest region of its probability. It has several separate
//! parts where the distribution has several modes.
//!
//! Source: R. J. Hyndman, Computing and Graphing Highest Density Regions, The American Statistician
//! 50 (1996) 120–126.

use pulp::{Simd, WithSimd};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;
use rayon::prelude::*;

use crate::numerics::{Packed, index_of_share};
use crate::uncertainty::PlanarKernel;

/// Number of draws from which the level of a density is estimated; the standard error of the level
/// is then about 1 %.
const N_DRAWS: usize = 2000;
/// Number of draws for the area of a region, which then has an error of some 2 %.
const N_REGION_DRAWS: usize = 10_000;
/// Positions whose densities one task computes.
const N_PER_TASK: usize = 1000;
/// Smallest variance relative to the larger one of a part, and smallest absolute variance, m².
const LEAST_RATIO: f64 = 1e-9;
const LEAST_VARIANCE_M2: f64 = 1e-8;

/// One normal distribution of a planar mixture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanarPart {
    /// Weight in the mixture, 0 to 1.
    pub weight: f64,
    /// Mean [x, y], m.
    pub mean: [f64; 2],
    /// Covariance [P_xx, P_xy, P_yy], m².
    pub covariance: [f64; 3],
}

/// The distribution `Σ_k w_k N(m_k, P_k)` of a position in the plane.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PlanarMixture {
    parts: Vec<PlanarPart>,
}

impl PlanarMixture {
    /// Makes a mixture of parts and scales their weights to sum to one. Where a covariance is not
    /// positive definite, variances that are too small are raised and the size of P_xy is limited
    /// until it is.
    pub fn new(mut parts: Vec<PlanarPart>) -> Self {
        let sum: f64 = parts.iter().map(|part| part.weight).sum();
        for part in &mut parts {
            part.weight /= sum;
            let [xx, xy, yy] = &mut part.covariance;
            let least = (LEAST_RATIO * xx.max(*yy)).max(LEAST_VARIANCE_M2);
            *xx = xx.max(least);
            *yy = yy.max(least);
            let limit = ((*xx - 0.5 * least) * (*yy - 0.5 * least)).max(0.0).sqrt();
            *xy = xy.clamp(-limit, limit);
        }
        Self { parts }
    }

    /// The mixture of several distributions, weighted equally if the weights of each sum to one.
    pub fn mixed<'a>(mixtures: impl IntoIterator<Item = &'a Self>) -> Self {
        Self::new(mixtures.into_iter().flat_map(|mixture| mixture.parts.clone()).collect())
    }

    /// The distribution of a position that is recorded to multiples of `resolution_m` in X and in Y: the error
    /// of rounding, of variance `resolution_m²/12`, comes on top.
    #[must_use]
    pub fn recorded_to(mut self, resolution_m: f64) -> Self {
        let variance_m2 = resolution_m * resolution_m / 12.0;
        for part in &mut self.parts {
            part.covariance[0] += variance_m2;
            part.covariance[2] += variance_m2;
        }
        self
    }

    /// The normal distributions of the mixture.
    pub fn parts(&self) -> &[PlanarPart] {
        &self.parts
    }

    /// The parts in the form in which their density is computed.
    pub fn kernels(&self) -> Vec<PlanarKernel> {
        self.parts.iter().map(PlanarKernel::from_part).collect()
    }

    /// Density at a point [x, y] in m, 1/m².
    pub fn density(&self, point: [f64; 2]) -> f64 {
        self.parts.iter().map(|part| PlanarKernel::from_part(part).density(point)).sum()
    }

    /// Draws `n` positions [x, y], m; NaN for a mixture without parts.
    ///
    /// - `seed`: seed of the random numbers.
    pub fn sample(&self, n: usize, seed: u64) -> Vec<[f64; 2]> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let draw = |_| {
            let share: f64 = rng.random();
            let place = index_of_share(self.parts.iter().map(|part| part.weight), share);
            let [a, b] = [(); 2].map(|()| rng.sample::<f64, _>(StandardNormal));
            self.parts.get(place).map_or([f64::NAN; 2], |part| {
                let [xx, xy, yy] = part.covariance;
                let first = xx.sqrt();
                let across = xy / first;
                let rest = (yy - across * across).max(0.0).sqrt();
                [part.mean[0] + first * a, part.mean[1] + across * a + rest * b]
            })
        };
        (0..n).map(draw).collect()
    }

    /// Level of the smallest region of highest density that holds a point: 0 at the highest
    /// density, 1 far away. The levels of points that are drawn from the mixture are distributed
    /// uniformly. Estimated from draws with a fixed seed.
    pub fn level_of(&self, point: [f64; 2]) -> f64 {
        let (densities, at) = (self.densities_of_draws(N_DRAWS), self.density(point));
        let n_below = densities.partition_point(|density| *density < at);
        1.0 - n_below as f64 / densities.len().max(1) as f64
    }

    /// Area of the smallest region that holds the position with probability `level`, m².
    ///
    /// ```text
    /// A = E[1/p(X); p(X) ≥ c]
    /// ```
    ///
    /// The expected value is estimated by the mean over draws X, with the threshold c exceeded by the
    /// share `level` of them.
    pub fn region_m2(&self, level: f64) -> f64 {
        let densities = self.densities_of_draws(N_REGION_DRAWS);
        let n_outside = ((1.0 - level) * densities.len() as f64).round() as usize;
        let inverse = densities.iter().skip(n_outside).map(|density| 1.0 / density);
        inverse.sum::<f64>() / densities.len().max(1) as f64
    }

    /// Densities at `n` positions drawn from the mixture with a fixed seed, in ascending order,
    /// 1/m².
    pub fn densities_of_draws(&self, n: usize) -> Vec<f64> {
        let (kernels, points) = (self.kernels(), self.sample(n, 0));
        let at = |points| pulp::Arch::new().dispatch(Densities { kernels: &kernels, points });
        let mut densities: Vec<f64> = points.par_chunks(N_PER_TASK).flat_map_iter(at).collect();
        densities.sort_by(f64::total_cmp);
        densities
    }

    /// The smallest rectangle `[low, high]` that holds all parts out to `reach` standard deviations
    /// along each axis, m; `None` for a mixture without parts.
    pub fn bounds(&self, reach: f64) -> Option<[[f64; 2]; 2]> {
        let second_moment = |part: &PlanarPart| {
            let [xx, _, yy] = part.covariance;
            let half = [reach * xx.sqrt(), reach * yy.sqrt()];
            [
                [part.mean[0] - half[0], part.mean[1] - half[1]],
                [part.mean[0] + half[0], part.mean[1] + half[1]],
            ]
        };
        self.parts.iter().map(second_moment).reduce(|[low, high], [l, h]| {
            [[low[0].min(l[0]), low[1].min(l[1])], [high[0].max(h[0]), high[1].max(h[1])]]
        })
    }
}

/// Densities of a mixture at points, several of them side by side.
struct Densities<'a> {
    kernels: &'a [PlanarKernel],
    points: &'a [[f64; 2]],
}

impl WithSimd for Densities<'_> {
    type Output = Vec<f64>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Vec<f64> {
        let mut densities = Vec::with_capacity(self.points.len());
        for points in self.points.chunks(Packed::<S>::N) {
            let point = Packed::columns(simd, points);
            let mut sum = Packed::splat(simd, 0.0);
            for kernel in self.kernels {
                sum += kernel.density(point);
            }
            densities.extend_from_slice(&sum.to_array()[..points.len()]);
        }
        densities
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::uncertainty::PlanarGrid;

    #[test]
    fn a_record_adds_the_variance_of_its_rounding() {
        let part = PlanarPart { weight: 1.0, mean: [1.0, 2.0], covariance: [0.04, 0.01, 0.09] };
        let recorded = PlanarMixture::new(vec![part]).recorded_to(0.6);
        let [xx, xy, yy] = recorded.parts()[0].covariance;
        assert!((xx - 0.07).abs() < 1e-12 && xy == 0.01 && (yy - 0.12).abs() < 1e-12);
    }

    #[test]
    fn densities_side_by_side_are_those_of_each_point() {
        let mixture = mixture();
        let normal = |part: &PlanarPart, [x, y]: [f64; 2]| {
            let [xx, xy, yy] = part.covariance;
            let (determinant, [dx, dy]) = (xx * yy - xy * xy, [x - part.mean[0], y - part.mean[1]]);
            let square = (yy * dx * dx - 2.0 * xy * dx * dy + xx * dy * dy) / determinant;
            part.weight * (-0.5 * square).exp() / (std::f64::consts::TAU * determinant.sqrt())
        };
        let at = |point: &[f64; 2]| mixture.parts().iter().map(|part| normal(part, *point)).sum();
        let mut expected: Vec<f64> = mixture.sample(2345, 0).iter().map(at).collect();
        expected.sort_by(f64::total_cmp);
        let densities = mixture.densities_of_draws(2345);
        assert_eq!(densities.len(), expected.len());
        for (density, expected) in densities.iter().zip(&expected) {
            assert!((density / expected - 1.0).abs() < 1e-11, "{density} {expected}");
        }
    }

    #[test]
    fn the_region_of_a_normal_distribution_is_an_ellipse() {
        let part = PlanarPart { weight: 1.0, mean: [0.0; 2], covariance: [4.0, 0.0, 1.0] };
        // The squared radius of the 90 % region is −2 ln 0.1 = 4.605, and its area π · 4.605 · 2 ·
        // 1.
        let area = PlanarMixture::new(vec![part]).region_m2(0.9);
        assert!((area / 28.93 - 1.0).abs() < 0.05, "{area}");
    }

    fn mixture() -> PlanarMixture {
        let part = |weight, mean, covariance| PlanarPart { weight, mean, covariance };
        PlanarMixture::new(vec![
            part(1.0, [10.0, 0.0], [4.0, 1.0, 1.0]),
            part(3.0, [-5.0, 3.0], [0.5, -0.3, 2.0]),
        ])
    }

    #[test]
    fn the_density_sums_to_one_on_a_grid() {
        let mixture = mixture();
        let bounds = mixture.bounds(6.0).unwrap();
        let grid = PlanarGrid::over(bounds, [400, 300]);
        let density = mixture.density_on(&grid);
        let sum: f64 = density.iter().sum::<f64>() * grid.cell_m2();
        assert!((sum - 1.0).abs() < 1e-3, "{sum}");
        let (i, j) = (123, 77);
        let x = grid.low_m[0] + i as f64 * grid.step_m[0];
        let y = grid.low_m[1] + j as f64 * grid.step_m[1];
        assert!((density[j * 400 + i] - mixture.density([x, y])).abs() < 1e-12);
    }

    #[test]
    fn draws_lie_in_their_regions_as_often_as_said() {
        let mixture = mixture();
        let draws = mixture.sample(400, 9);
        for level in [0.5, 0.9] {
            let inside = draws.iter().filter(|point| mixture.level_of(**point) <= level).count();
            let share = inside as f64 / draws.len() as f64;
            assert!((share - level).abs() < 0.06, "{share} of {level}");
        }
        assert!(mixture.level_of([-5.0, 3.0]) < 0.05 && mixture.level_of([40.0, 0.0]) > 0.999);
    }

    #[test]
    fn a_covariance_that_is_none_is_lifted() {
        let part = PlanarPart { weight: 1.0, mean: [0.0; 2], covariance: [1.0, 1.0, 1.0] };
        let mixture = PlanarMixture::new(vec![part]);
        assert!(mixture.density([0.0, 0.0]).is_finite());
        let part = PlanarPart { covariance: [0.0, 0.0, 0.0], ..part };
        assert!(PlanarMixture::new(vec![part]).density([0.0, 0.0]).is_finite());
    }
}
