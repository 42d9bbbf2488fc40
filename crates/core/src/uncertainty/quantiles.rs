//! Fast computation of quantiles of normal mixtures at many successive instants. The normal
//! distribution is interpolated in a table, and Halley's method starts from an extrapolation of the
//! quantiles at the two instants before.

use std::f64::consts::SQRT_2;
use std::ops::Range;

use statrs::function::erf::erfc;

use crate::numerics::{normal_density, normal_quantile};
use crate::uncertainty::bands::Marginals;

/// Largest number of steps of the search for a quantile; bisection gains one bit in each.
const MAX_STEPS: usize = 60;

/// Error of the probability below which a quantile is accepted.
const TOLERANCE: f64 = 1e-7;

/// Size of a step, in units of the smallest standard deviation of a component, after which no
/// further step is needed: the error that is left is of the order of its cube, which is below
/// [`TOLERANCE`].
const SMALL_STEP: f64 = 4e-3;

/// Computes the quantiles of normal mixtures at many instants for given probabilities.
pub(super) struct QuantileSolver<'a> {
    table: NormalTable,
    probabilities: &'a [f64],
}

/// A component of the mixture at one instant; `inverse` is 1 / `std`.
#[derive(Clone, Copy)]
struct Part {
    weight: f64,
    mean: f64,
    std: f64,
    inverse: f64,
}

impl<'a> QuantileSolver<'a> {
    pub(super) fn new(probabilities: &'a [f64]) -> Self {
        Self { table: NormalTable::new(), probabilities }
    }

    /// Quantiles of the values in a range of rows, `[probability][instant]`, in the unit of the
    /// values.
    ///
    /// - `values`: indices of the values, in the order of the instants.
    pub(super) fn quantiles(&self, marginals: &Marginals, values: Range<usize>) -> Vec<Vec<f64>> {
        let z: Vec<f64> = self.probabilities.iter().map(|&p| normal_quantile(p)).collect();
        let mut rows = vec![Vec::with_capacity(values.len()); z.len()];
        // Offsets of each quantile from the mean at the latest instant and at the one before, in
        // standard deviations. Their linear extrapolation is the first guess for the next instant.
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
                let value = self.quantile(&parts, probability, z, guess);
                past[i] = [(value - mean) / std, one];
                rows[i].push(value);
            }
        }
        rows
    }

    /// The value with the given probability below it, by Halley's method, which bisection keeps
    /// between the smallest and the largest quantile of the parts.
    ///
    /// - `probability`, `z`: the probability and its quantile of the standard normal distribution.
    /// - `guess`: start of the iteration.
    fn quantile(&self, parts: &[Part], probability: f64, z: f64, guess: f64) -> f64 {
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
            // Halley's step also uses the slope of the density.
            let step = excess * density / (density * density - excess * slope / 2.0);
            let next = value - step;
            let is_inside = next > low && next < high;
            value = if is_inside { next } else { (low + high) / 2.0 };
            // The error after such a step is of third order in the step.
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

/// The standard normal distribution Φ and its density φ between −8 and 8, by cubic Hermite
/// interpolation in a table. The error of Φ is below 1e-9.
struct NormalTable {
    /// Φ, and φ times the distance between knots, at each knot.
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

    /// Φ(z) and φ(z). The density is interpolated linearly, which suffices for the derivative of
    /// the iteration; outside of the table it is zero.
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
        // Cubic Hermite polynomial y0 + d0 u + (3Δ − 2d0 − d1) u² + (d0 + d1 − 2Δ) u³.
        let rise = y1 - y0;
        let cubic = d0 + d1 - 2.0 * rise;
        let square = rise - d0 - cubic;
        (y0 + u * (d0 + u * (square + u * cubic)), (d0 + u * (d1 - d0)) * Self::PER_UNIT)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::normal_cdf;

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
}
