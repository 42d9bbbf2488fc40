//! Quantiles of the magnitude `|F|` of a force whose components F_x and F_y follow mixtures of
//! bivariate normal distributions. Each distribution is represented by points on a spiral instead
//! of random draws; their weighted histogram gives the quantiles.

use std::f64::consts::TAU;

use crate::uncertainty::bands::Marginals;

/// Number of points that all components share in proportion to their weights, and smallest number
/// of points of one component.
const SPIRAL_POINTS: (f64, usize) = (400.0, 8);

/// Number of cells of the histogram of `|F|` at an instant.
const N_CELLS: usize = 512;

/// Quantiles of `|F|`, N, `[probability][instant]`.
///
/// - `probabilities`: between 0 and 1.
pub(super) fn magnitude_quantiles(marginals: &Marginals, probabilities: &[f64]) -> Vec<Vec<f64>> {
    let n = marginals.n_instants;
    let spirals: Vec<Vec<[f64; 2]>> = marginals.weights.iter().map(|&w| spiral(w)).collect();
    let mut rows = vec![Vec::with_capacity(n); probabilities.len()];
    let mut magnitudes: Vec<f64> = Vec::new();
    let mut cells = vec![0.0; N_CELLS];
    for i in 0..n {
        magnitudes.clear();
        for (k, spiral) in spirals.iter().enumerate() {
            let (means, stds) = (&marginals.means[k], &marginals.stds[k]);
            let (mean_x, mean_y, std_x) = (means[i], means[n + i], stds[i]);
            // Lower Cholesky factor of the covariance of (F_x, F_y): [[std_x, 0], [shared, own]].
            let shared = marginals.covariances[k][i] / std_x;
            let own = (stds[n + i].powi(2) - shared * shared).max(0.0).sqrt();
            magnitudes.extend(spiral.iter().map(|[a, b]| {
                let (x, y) = (mean_x + std_x * a, mean_y + shared * a + own * b);
                (x * x + y * y).sqrt()
            }));
        }
        let largest = magnitudes.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        // The factor slightly below one keeps the largest value inside the last cell.
        let per_n = N_CELLS as f64 * (1.0 - 1e-12) / largest;
        cells.fill(0.0);
        let mut drawn = magnitudes.iter();
        for (spiral, weight) in spirals.iter().zip(&marginals.weights) {
            let share = weight / spiral.len() as f64;
            for magnitude in drawn.by_ref().take(spiral.len()) {
                cells[(magnitude * per_n) as usize] += share;
            }
        }
        for (row, &probability) in rows.iter_mut().zip(probabilities) {
            row.push(cell_quantile(&cells, probability) / per_n);
        }
    }
    rows
}

/// Position of a quantile in units of cells, with the share of each cell spread uniformly over it.
fn cell_quantile(cells: &[f64], probability: f64) -> f64 {
    let mut left = probability;
    for (idx, &share) in cells.iter().enumerate() {
        if share > 0.0 && left <= share {
            return idx as f64 + left / share;
        }
        left -= share;
    }
    cells.len() as f64
}

/// Points that cover the bivariate standard normal distribution evenly: the radii are at equal
/// steps of probability, and each point is rotated by the golden angle from the one before. They
/// are scaled so that the mean square of the radius is exactly 2, as in the distribution.
///
/// - `weight`: weight of the component, which determines the number of points.
fn spiral(weight: f64) -> Vec<[f64; 2]> {
    let (of_all, fewest) = SPIRAL_POINTS;
    let n = ((of_all * weight).round() as usize).max(fewest);
    let golden_angle = TAU * (1.0 - 2.0 / (1.0 + 5.0_f64.sqrt()));
    let square = |i: usize| -2.0 * (1.0 - (i as f64 + 0.5) / n as f64).ln();
    let scale = 2.0 * n as f64 / (0..n).map(square).sum::<f64>();
    let point = |i: usize| {
        let (radius, angle) = ((square(i) * scale).sqrt(), golden_angle * i as f64);
        [radius * angle.cos(), radius * angle.sin()]
    };
    (0..n).map(point).collect()
}
