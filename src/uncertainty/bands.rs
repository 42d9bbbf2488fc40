//! Bands of the force over time.
//!
//! `F_x` and `F_y`: quantiles of the exact mixture of normals at each instant, to 1e-7 of the
//! probability. `|F|`: each component's pair (F_x, F_y) is spread over points of a spiral that
//! covers the plane normal distribution evenly, and the quantile taken from some 400 of them; no
//! random numbers, about half a percent of the probability.

use std::f64::consts::{SQRT_2, TAU};

use serde::Serialize;
use statrs::function::erf::erfc;

use crate::numerics::{normal_density, normal_quantile};
use crate::uncertainty::{CurveMixture, MixtureError};

/// Points for `|F|` over all components, and the fewest for one.
const SPIRAL_POINTS: (f64, usize) = (400.0, 8);

/// Cells of the distribution of `|F|` at an instant.
const N_CELLS: usize = 512;

/// Newton steps for a quantile before it is taken as it is; bisection gains a bit in each.
const MAX_STEPS: usize = 60;

/// A step, in the smallest deviation of a component, after which none is needed: its cube is below
/// [`TOLERANCE`].
const SMALL_STEP: f64 = 4e-3;

/// Error of the probability at which a quantile is good.
const TOLERANCE: f64 = 1e-7;

/// A central band over the instants.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Band {
    /// Share that it holds at each instant, 0 to 1.
    pub level: f64,
    /// Its lower edge, N.
    pub lower_n: Vec<f64>,
    /// Its upper edge, N.
    pub upper_n: Vec<f64>,
}

/// Bands of a force, one a level, in the order that was asked for.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CurveBands {
    /// Of F_x.
    pub fx: Vec<Band>,
    /// Of F_y.
    pub fy: Vec<Band>,
    /// Of `|F|`.
    pub magnitude: Vec<Band>,
}

impl CurveMixture {
    /// Central bands of F_x, F_y and `|F|` at every instant.
    ///
    /// - `levels`: share that each holds, between 0 and 1.
    ///
    /// # Errors
    /// [`MixtureError::Level`].
    pub fn bands(&self, levels: &[f64]) -> Result<CurveBands, MixtureError> {
        if let Some(&level) = levels.iter().find(|level| !(0.0 < **level && **level < 1.0)) {
            return Err(MixtureError::Level { level });
        }
        let tails = levels.iter().flat_map(|level| [(1.0 - level) / 2.0, (1.0 + level) / 2.0]);
        let probabilities: Vec<f64> = tails.collect();
        let marginals = Marginals::of(self);
        let table = NormalTable::new();
        let n = marginals.n_instants;
        let solver = QuantileSolver { table, probabilities: &probabilities };
        let (magnitude, (fx, fy)) = rayon::join(
            || magnitude_quantiles(&marginals, &probabilities),
            || {
                let along = |axis: usize| solver.quantiles(&marginals, axis * n..(axis + 1) * n);
                rayon::join(|| along(0), || along(1))
            },
        );
        let bands = |rows: Vec<Vec<f64>>| {
            let mut rows = rows.into_iter();
            let band = |&level: &f64| {
                let (lower_n, upper_n) = (rows.next()?, rows.next()?);
                Some(Band { level, lower_n, upper_n })
            };
            levels.iter().filter_map(band).collect()
        };
        Ok(CurveBands { fx: bands(fx), fy: bands(fy), magnitude: bands(magnitude) })
    }
}

/// Moments of each force under each component.
struct Marginals {
    n_instants: usize,
    weights: Vec<f64>,
    /// `[component][value]`, forces only.
    means: Vec<Vec<f64>>,
    stds: Vec<Vec<f64>>,
    /// Covariance of F_x and F_y, `[component][instant]`.
    covariances: Vec<Vec<f64>>,
}

impl Marginals {
    fn of(mixture: &CurveMixture) -> Self {
        let n = mixture.n_instants();
        let components = mixture.components();
        let forces = |mut row: Vec<f64>| {
            row.truncate(2 * n);
            row
        };
        let covariance = |of: &crate::uncertainty::CurveComponent| {
            let mut sum = vec![0.0; n];
            for column in of.factors.column_iter() {
                let (x, y) = (column.iter(), column.iter().skip(n));
                for (sum, (x, y)) in sum.iter_mut().zip(x.zip(y)) {
                    *sum += x * y;
                }
            }
            sum
        };
        let std = |of: &crate::uncertainty::CurveComponent| {
            forces(of.total_variance().into_iter().map(f64::sqrt).collect())
        };
        Self {
            n_instants: n,
            weights: components.iter().map(|of| of.weight).collect(),
            means: components.iter().map(|of| forces(of.mean.clone())).collect(),
            stds: components.iter().map(std).collect(),
            covariances: components.iter().map(covariance).collect(),
        }
    }
}

/// Quantiles of a mixture of normals at many instants.
struct QuantileSolver<'a> {
    table: NormalTable,
    probabilities: &'a [f64],
}

/// A component at one instant.
#[derive(Clone, Copy)]
struct Part {
    weight: f64,
    mean: f64,
    std: f64,
    inverse: f64,
}

impl QuantileSolver<'_> {
    /// `[probability][instant]`.
    fn quantiles(&self, marginals: &Marginals, values: std::ops::Range<usize>) -> Vec<Vec<f64>> {
        let z: Vec<f64> = self.probabilities.iter().map(|&p| normal_quantile(p)).collect();
        let mut rows = vec![Vec::with_capacity(values.len()); z.len()];
        // Where each quantile lay one and two instants ago, in standard deviations: continued in a
        // straight line they are a good first guess.
        let mut past = z.iter().map(|&z| [z, z]).collect::<Vec<_>>();
        let mut parts: Vec<Part> = Vec::with_capacity(marginals.weights.len());
        for value_idx in values {
            parts.clear();
            let rows_of = marginals.weights.iter().zip(&marginals.means).zip(&marginals.stds);
            parts.extend(rows_of.map(|((&weight, means), stds)| {
                let (mean, std) = (means[value_idx], stds[value_idx]);
                Part { weight, mean, std, inverse: 1.0 / std }
            }));
            let mean: f64 = parts.iter().map(|part| part.weight * part.mean).sum();
            let spread = |p: &Part| p.weight * (p.std * p.std + (p.mean - mean).powi(2));
            let std = parts.iter().map(spread).sum::<f64>().sqrt();
            for (i, &z) in z.iter().enumerate() {
                let ([one, two], probability) = (past[i], self.probabilities[i]);
                let guess = mean + (2.0 * one - two) * std;
                let value = self.quantile(&parts, (probability, z), guess);
                past[i] = [(value - mean) / std, one];
                rows[i].push(value);
            }
        }
        rows
    }

    /// Newton's method kept between the smallest and the largest quantile of the parts.
    fn quantile(&self, parts: &[Part], (probability, z): (f64, f64), guess: f64) -> f64 {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut sharpest: f64 = 0.0;
        for &Part { mean, std, inverse, .. } in parts {
            let end = mean + z * std;
            (low, high, sharpest) = (low.min(end), high.max(end), sharpest.max(inverse));
        }
        let mut value = guess.clamp(low, high);
        if parts.len() == 1 {
            return value;
        }
        for _ in 0..MAX_STEPS {
            let (mut excess, mut density, mut slope) = (-probability, 0.0, 0.0);
            for &Part { weight, mean, inverse, .. } in parts {
                let z = (value - mean) * inverse;
                let (cumulative, height) = self.table.at(z);
                excess += weight * cumulative;
                let part = weight * height * inverse;
                density += part;
                slope -= part * z * inverse;
            }
            if excess.abs() < TOLERANCE {
                break;
            }
            if excess > 0.0 {
                high = value;
            } else {
                low = value;
            }
            // Halley's step, which uses the slope of the density.
            let step = excess * density / (density * density - excess * slope / 2.0);
            let next = value - step;
            let is_inside = next > low && next < high;
            value = if is_inside { next } else { (low + high) / 2.0 };
            // What is left after a small step is of the third order in it.
            if is_inside && step.abs() * sharpest < SMALL_STEP {
                break;
            }
            if high - low <= 1e-13 * (low.abs() + high.abs()) {
                break;
            }
        }
        value
    }
}

/// Φ and φ between −8 and 8 from a table, by cubic Hermite interpolation: error of Φ below 1e-9.
struct NormalTable {
    /// Φ and φ·step at the knots.
    knots: Vec<[f64; 2]>,
}

impl NormalTable {
    const END: f64 = 8.0;
    const PER_UNIT: f64 = 64.0;

    fn new() -> Self {
        let n = (2.0 * Self::END * Self::PER_UNIT) as usize;
        let knot = |i: usize| {
            let z = i as f64 / Self::PER_UNIT - Self::END;
            [erfc(-z / SQRT_2) / 2.0, normal_density(z) / Self::PER_UNIT]
        };
        Self { knots: (0..=n).map(knot).collect() }
    }

    /// (Φ(z), φ(z)); the density is linear between knots, good enough for a slope.
    fn at(&self, z: f64) -> (f64, f64) {
        let position = (z + Self::END) * Self::PER_UNIT;
        if !(0.0..2.0 * Self::END * Self::PER_UNIT).contains(&position) {
            return if z > 0.0 { (1.0, 0.0) } else { (0.0, 0.0) };
        }
        let idx = position as u32;
        let Some(&[[y0, d0], [y1, d1]]) = self.knots.get(idx as usize..idx as usize + 2) else {
            return (1.0, 0.0);
        };
        let u = position - f64::from(idx);
        // y0 + d0 u + (3Δ − 2d0 − d1) u² + (d0 + d1 − 2Δ) u³
        let rise = y1 - y0;
        let cubic = d0 + d1 - 2.0 * rise;
        let square = rise - d0 - cubic;
        (y0 + u * (d0 + u * (square + u * cubic)), (d0 + u * (d1 - d0)) * Self::PER_UNIT)
    }
}

/// `[probability][instant]` of `|F|`.
fn magnitude_quantiles(marginals: &Marginals, probabilities: &[f64]) -> Vec<Vec<f64>> {
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
            // Cholesky factor of the covariance of (F_x, F_y).
            let shared = marginals.covariances[k][i] / std_x;
            let own = (stds[n + i].powi(2) - shared * shared).max(0.0).sqrt();
            magnitudes.extend(spiral.iter().map(|[a, b]| {
                let (x, y) = (mean_x + std_x * a, mean_y + shared * a + own * b);
                (x * x + y * y).sqrt()
            }));
        }
        let largest = magnitudes.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        // A hair below one, so that the largest falls into the last cell.
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

/// Position in cells of a quantile, evenly spread inside each.
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

/// Points that cover the standard normal distribution of the plane evenly, with mean squares of
/// one: radii at equal steps of probability, each a golden angle further round.
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

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::numerics::{normal_cdf, quantile_of_sorted};
    use crate::uncertainty::CurveMixture;
    use crate::uncertainty::mixture::tests::example;

    const LEVELS: [f64; 4] = [0.5, 0.8, 0.9, 0.95];

    #[test]
    fn the_table_is_the_normal_distribution() {
        let table = NormalTable::new();
        let mut worst: f64 = 0.0;
        for i in -9_000..9_000 {
            let z = f64::from(i) / 1e3 + 3e-4;
            worst = worst.max((table.at(z).0 - normal_cdf(z)).abs());
        }
        assert!(worst < 1e-9, "{worst:e}");
        assert_eq!(table.at(f64::INFINITY), (1.0, 0.0));
        assert_eq!(table.at(f64::NEG_INFINITY), (0.0, 0.0));
    }

    #[test]
    fn edges_along_the_axes_are_the_exact_quantiles() {
        let mixture = example(5, 30);
        let bands = mixture.bands(&LEVELS).unwrap();
        for (axis, bands) in [(0, &bands.fx), (1, &bands.fy)] {
            for band in bands {
                for i in 0..30 {
                    let value = mixture.value(axis * 30 + i).unwrap();
                    for (edge, probability) in [
                        (band.lower_n[i], (1.0 - band.level) / 2.0),
                        (band.upper_n[i], (1.0 + band.level) / 2.0),
                    ] {
                        let off = value.cdf(edge) - probability;
                        assert!(off.abs() < 2e-7, "{axis} {} {i}: {off:e}", band.level);
                    }
                }
            }
        }
    }

    #[test]
    fn edges_of_the_magnitude_agree_with_draws() {
        for mixture in [example(1, 12), example(6, 12)] {
            let bands = mixture.bands(&LEVELS).unwrap();
            let drawn = mixture.sample(20_000, &mut ChaCha8Rng::seed_from_u64(5));
            for i in 0..12 {
                let mut of_draws: Vec<f64> =
                    drawn.iter().map(|curve| curve.fx_n[i].hypot(curve.fy_n[i])).collect();
                of_draws.sort_by(f64::total_cmp);
                for band in &bands.magnitude {
                    for (edge, probability) in [
                        (band.lower_n[i], (1.0 - band.level) / 2.0),
                        (band.upper_n[i], (1.0 + band.level) / 2.0),
                    ] {
                        let [below, above] = [-0.015, 0.015].map(|off: f64| {
                            let at = (probability + off).clamp(0.0, 1.0);
                            quantile_of_sorted(&of_draws, at).unwrap()
                        });
                        let name = format!("{} at {i}", band.level);
                        assert!(below <= edge && edge <= above, "{name}: {below} {edge} {above}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_single_component_and_far_components_have_bands() {
        let single = example(1, 4).bands(&[0.9]).unwrap();
        assert!(single.fx[0].lower_n.iter().zip(&single.fx[0].upper_n).all(|(l, u)| l < u));
        let mut far = example(2, 4).components().to_vec();
        for value in &mut far[1].mean {
            *value += 1e7;
        }
        let far = CurveMixture::new(far).unwrap();
        for (i, edge) in far.bands(&[0.5]).unwrap().fy[0].lower_n.iter().enumerate() {
            let off = far.value(4 + i).unwrap().cdf(*edge) - 0.25;
            assert!(off.abs() < 1e-6, "{i}: {off:e}");
        }
        assert!(matches!(far.bands(&[1.0]), Err(MixtureError::Level { .. })));
    }
}
