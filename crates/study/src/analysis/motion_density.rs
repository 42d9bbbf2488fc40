//! Probability density of the position of a struck vehicle on a grid, at an instant or averaged
//! over a time window, with the regions that hold the position with given probabilities.
//!
//! Checked against the total probability of one and against the regions of a circular normal
//! distribution.

use std::sync::Arc;

use contour::ContourBuilder;

use crate::analysis::MOTION_BAND_LEVELS;
use impactlab_core::uncertainty::{PlanarGrid, PlanarMixture, PlanarPart};
use impactlab_networks::response::{MotionDistribution, STEP_S};

/// Number of grid points along the longer side of the rectangle.
const GRID_POINTS: usize = 256;
/// Distance, in standard deviations of every part, that the rectangle covers.
const REACH: f64 = 4.0;
/// Smallest side of the rectangle, m.
const LEAST_SIDE_M: f64 = 2.0;
/// Standard deviation of the blur that is applied to every part, in cells. A part that is narrower
/// than a cell would fall between the grid points or lie entirely in one cell. With the blur the
/// sum over the points is off by at most `4 exp(−2 π² 0.7²) = 0.03 %`.
const BLUR_CELLS: f64 = 0.7;

/// Number of cells added around the rectangle for the effect of the blur.
const MARGIN_CELLS: usize = 3;

/// Probability density of a position on a grid.
#[derive(Debug, Clone, PartialEq)]
pub struct DensityMap {
    /// Start and end of the time window, s; both are the same for an instant.
    pub window_s: [f64; 2],
    /// Grid of points at which the density is given.
    pub grid: PlanarGrid,
    /// Probability density, 1/m², row by row from the lowest Y upwards. For a window it is the mean
    /// over time.
    pub values: Arc<Vec<f64>>,
    /// The smallest regions that hold the position with the probabilities [`MOTION_BAND_LEVELS`].
    pub regions: Vec<Region>,
}

/// A region of highest density.
#[derive(Debug, Clone, PartialEq)]
pub struct Region {
    /// Probability that the position lies inside the region, 0 to 1.
    pub level: f64,
    /// Closed outlines of the separate parts of the region and of holes in them, points [x, y] in
    /// m.
    pub outlines: Vec<Vec<[f64; 2]>>,
}

/// Distribution of the position in a time window, in which all instants are equally likely, and a
/// grid around it. The density at the grid points is still to be computed.
#[derive(Debug, Clone, PartialEq)]
pub struct DensityTask {
    /// Start and end of the window, s, rounded to instants of the motion.
    pub window_s: [f64; 2],
    /// Distribution of the position, blurred as the grid requires.
    pub position: PlanarMixture,
    /// Grid of points at which the density is to be computed.
    pub grid: PlanarGrid,
}

impl DensityTask {
    /// Prepares the distribution and the grid for a time window.
    ///
    /// - `window_s`: start and end of the window, s; twice the same time for an instant. Times are
    ///   rounded to the instants of the motion and limited to its duration.
    pub fn new(motion: &MotionDistribution, window_s: [f64; 2]) -> Self {
        let last = motion.n_instants().saturating_sub(1);
        let instant = |time_s: f64| ((time_s.max(0.0) / STEP_S).round() as usize).min(last);
        let [from, to] = window_s.map(instant);
        let (from, to) = (from.min(to), from.max(to));
        let instants: Vec<PlanarMixture> = (from..=to).map(|at| motion.position(at)).collect();
        let position = PlanarMixture::mixed(&instants);
        let grid = grid_about(&position);
        let blur_m2 = grid.step_m.map(|step_m| (BLUR_CELLS * step_m).powi(2));
        let blurred = |part: &PlanarPart| {
            let [xx, xy, yy] = part.covariance;
            PlanarPart { covariance: [xx + blur_m2[0], xy, yy + blur_m2[1]], ..*part }
        };
        let position = PlanarMixture::new(position.parts().iter().map(blurred).collect());
        Self { window_s: [from, to].map(|at| at as f64 * STEP_S), position, grid }
    }

    /// Computes the density on the CPU.
    pub fn on_cpu(self) -> DensityMap {
        let values = self.position.density_on(&self.grid);
        self.with(values)
    }

    /// Makes the map from densities that were computed elsewhere, in the order of
    /// [`DensityMap::values`].
    pub fn with(self, values: Vec<f64>) -> DensityMap {
        let regions = regions(&self.grid, &values);
        DensityMap { window_s: self.window_s, grid: self.grid, values: Arc::new(values), regions }
    }
}

/// Regions of highest density: where the density exceeds the threshold above which the grid holds
/// the probability of each level.
fn regions(grid: &PlanarGrid, values: &[f64]) -> Vec<Region> {
    let mut falling = values.to_vec();
    falling.sort_unstable_by(|a, b| b.total_cmp(a));
    let total: f64 = falling.iter().sum();
    let threshold = |level: f64| {
        let mut inside = 0.0;
        let last = falling.iter().find(|value| {
            inside += **value;
            inside >= level * total
        });
        last.copied().unwrap_or(0.0)
    };
    let [width, height] = grid.size;
    // The contour builder places each value in the middle of its cell.
    let origin = [0, 1].map(|axis| grid.low_m[axis] - 0.5 * grid.step_m[axis]);
    let builder = ContourBuilder::new(width, height, true)
        .x_origin(origin[0])
        .y_origin(origin[1])
        .x_step(grid.step_m[0])
        .y_step(grid.step_m[1]);
    let region = |level: f64| {
        let lines = builder.lines(values, &[threshold(level)]).unwrap_or_default();
        let rings = lines.into_iter().flat_map(|line| line.into_inner().0);
        let outlines = rings.map(|ring| ring.into_iter().map(|at| [at.x, at.y]).collect());
        Region { level, outlines: outlines.collect() }
    };
    MOTION_BAND_LEVELS.map(region).to_vec()
}

/// A grid of square cells over a rectangle that holds nearly all of the distribution.
fn grid_about(position: &PlanarMixture) -> PlanarGrid {
    let mut bounds = position.bounds(REACH).unwrap_or([[0.0; 2]; 2]);
    let [low, high] = &mut bounds;
    for (low, high) in low.iter_mut().zip(high) {
        let missing = (LEAST_SIDE_M - (*high - *low)).max(0.0);
        *low -= 0.5 * missing;
        *high += 0.5 * missing;
    }
    let sides_m = [0, 1].map(|axis: usize| bounds[1][axis] - bounds[0][axis]);
    let step_m = sides_m[0].max(sides_m[1]) / (GRID_POINTS - 1 - 2 * MARGIN_CELLS) as f64;
    let cells = sides_m.map(|side_m| (side_m / step_m).ceil() as usize + 2 * MARGIN_CELLS);
    let low = bounds[0].map(|end| end - MARGIN_CELLS as f64 * step_m);
    let high = [0, 1].map(|axis: usize| low[axis] + cells[axis] as f64 * step_m);
    PlanarGrid::over([low, high], cells.map(|n| n + 1))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use impactlab_core::vehicle::VehicleState;

    /// Draws on a circle that goes along X at 10 m/s and grows to half a metre, too few for several groups:
    /// their distribution is a round one.
    fn motion() -> MotionDistribution {
        const N: usize = 12;
        let draw = |k: usize| -> Vec<VehicleState<f64>> {
            let (sin, cos) = (TAU * k as f64 / N as f64).sin_cos();
            let state = |i: usize| {
                let radius_m = 0.005 * i as f64;
                VehicleState {
                    x_m: i as f64 * STEP_S * 10.0 + radius_m * cos,
                    y_m: radius_m * sin,
                    ..VehicleState::default()
                }
            };
            (0..=100).map(state).collect()
        };
        MotionDistribution::new((0..N).map(draw).collect(), 101)
    }

    fn sum(map: &DensityMap) -> f64 {
        map.values.iter().sum::<f64>() * map.grid.cell_m2()
    }

    #[test]
    fn probabilities_sum_to_one_at_a_moment_and_over_a_window() {
        for window_s in [[1.0, 1.0], [0.0, 0.0], [0.0, 1.0], [0.6, 0.2]] {
            let map = DensityTask::new(&motion(), window_s).on_cpu();
            assert!((sum(&map) - 1.0).abs() < 2e-3, "{window_s:?}: {}", sum(&map));
        }
    }

    /// The squared radius of the region that holds q of a circular normal distribution is −2 ln(1 −
    /// q), in variances.
    #[test]
    fn regions_of_a_round_distribution_are_circles_about_its_mean() {
        let map = DensityTask::new(&motion(), [1.0, 1.0]).on_cpu();
        let position = motion().position(100);
        let [part] = position.parts() else { panic!("{} parts", position.parts().len()) };
        let std_m = part.covariance[0].sqrt();
        assert!((0.4..0.6).contains(&std_m), "{std_m}");
        for region in &map.regions {
            let expected_m = std_m * (-2.0 * (1.0 - region.level).ln()).sqrt();
            let [outline] = &region.outlines[..] else { panic!("{} parts", region.outlines.len()) };
            for [x_m, y_m] in outline {
                let radius_m = (x_m - 10.0).hypot(*y_m);
                assert!((radius_m / expected_m - 1.0).abs() < 0.02, "{radius_m} {expected_m}");
            }
        }
    }

    #[test]
    fn a_window_holds_the_way_and_a_moment_its_end() {
        let density = |window_s| DensityTask::new(&motion(), window_s).on_cpu();
        let (moment, window) = (density([1.0, 1.0]), density([0.0, 9.0]));
        assert_eq!(window.window_s, [0.0, 1.0]);
        let share_before_5_m = |map: &DensityMap| {
            let [width, _] = map.grid.size;
            let x_m = |i: usize| map.grid.low_m[0] + (i % width) as f64 * map.grid.step_m[0];
            let before = map.values.iter().enumerate().filter(|(i, _)| x_m(*i) < 5.0);
            before.map(|(_, value)| value).sum::<f64>() * map.grid.cell_m2()
        };
        assert!(share_before_5_m(&moment) < 1e-6);
        let share = share_before_5_m(&window);
        assert!((share - 0.5).abs() < 0.03, "{share}");
    }
}
