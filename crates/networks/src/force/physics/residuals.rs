//! Residuals of the physics: the differences between recorded cases and the predictions of a centre
//! that was fitted without them.
//!
//! Residuals of force and duration are scaled by the peak and the duration of the centre, so that
//! short hard and long soft collisions can be compared:
//!
//! ```text
//! r(u) = (F(t₀ + u T) − F_c(t₀ + u T)) / max |F_c|      r_Δ = (Δ − Δ_c) / T
//! T = 2 ∫ |F_c| dt / max |F_c|                          t₀: its first contact
//! r ≈ m + Σ_f b_f ξ_f + ε      ξ_f ~ N(0, 1), ε a first-order autoregressive process
//! ```
//!
//! m is the median and the b_f are principal components. The network's mixture starts from them.

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use crate::force::ForceCase;
use crate::force::physics::CentreCurve;
use crate::nn::{Expected, NnError, check_number, check_numbers};
use impactlab_core::numerics::median;
use impactlab_core::uncertainty::{CURVE_INTERVAL_S, CURVE_N_INSTANTS};

/// Unit of the duration among the values of a curve, s.
pub(crate) const DURATION_UNIT_S: f64 = 0.1;
/// Nodes of the scaled time for each duration of the centre. Three durations are covered.
const NODES_PER_DURATION: usize = 32;
const N_NODES: usize = 3 * NODES_PER_DURATION;
/// Number of values of a residual: forces along x, forces along y, duration.
const N_VALUES: usize = 2 * N_NODES + 1;
/// Weight of the duration in the principal components, since there are many more values of force.
const DURATION_WEIGHT: f64 = 4.0;
/// Smallest number of cases for each latent factor.
const CASES_PER_FACTOR: usize = 3;
/// Smallest variance of a force, in squared peaks, and of a duration, in squared T.
const LEAST_VARIANCE: [f64; 2] = [1e-6, 1e-4];
/// Largest correlation of neighbouring nodes, and largest number of nodes between two instants.
const MOST_CORRELATED: f64 = 0.98;
const LONGEST_STEP: f64 = 32.0;
/// Larger residuals, in peaks or durations, are clamped so that a single outlier does not become a
/// latent factor.
const LARGEST_RESIDUAL: f64 = 2.0;

/// Mean, latent factors and independent variance of residuals, `[2 N_NODES + 1]` each.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ResidualProfiles {
    mean: Vec<f64>,
    factors: Vec<Vec<f64>>,
    variance: Vec<f64>,
    /// Correlation of ε at neighbouring nodes.
    lag_correlation: f64,
}

/// Profiles of ordinary cases and of cases in which the vehicles hook.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ResidualModel {
    usual: ResidualProfiles,
    hooking: ResidualProfiles,
}

/// The profiles on the time grid of one case, `[F_x…, F_y…, duration]` in peaks and 0.1 s.
pub(crate) struct ResidualCurve {
    /// Mean m.
    pub mean: Vec<f64>,
    /// Latent factors b, row by row: `[values, q]`.
    pub factors: Vec<f64>,
    /// Variance of ε.
    pub variance: Vec<f64>,
    /// Correlation φ of ε at neighbouring instants.
    pub lag_correlation: f64,
}

impl ResidualModel {
    /// Fits the profiles to cases and to the curves of a centre that was fitted without them.
    ///
    /// - `n_factors`: latent factors of each profile; those for which there are too few cases are zero.
    pub(crate) fn fit(cases: &[ForceCase], centres: &[CentreCurve], n_factors: usize) -> Self {
        let rows = |choose: &dyn Fn(&ForceCase) -> bool| -> Vec<Vec<f64>> {
            let pairs = cases.iter().zip(centres).filter(|(case, _)| choose(case));
            pairs.map(|(case, centre)| residual(case, centre)).collect()
        };
        let plain = rows(&ForceCase::is_clean);
        let plain = if plain.len() < CASES_PER_FACTOR { rows(&|_| true) } else { plain };
        // The physics' own duration is nearer than one with the median residual added.
        let usual = ResidualProfiles::from_rows(&plain, n_factors, false);
        let hooked = rows(&|case| case.hooked);
        let mut hooking = if hooked.len() < CASES_PER_FACTOR {
            usual.clone()
        } else {
            ResidualProfiles::from_rows(&hooked, n_factors, true)
        };
        // A handful of cases leaves little over, but what plain cases leave is there as well.
        for (variance, of_usual) in hooking.variance.iter_mut().zip(&usual.variance) {
            *variance += of_usual;
        }
        Self { usual, hooking }
    }

    /// Checks the sizes read from a file against the number of latent factors of the network.
    ///
    /// # Errors
    /// [`NnError::WrongShape`].
    pub(crate) fn check(&self, n_factors: usize) -> Result<(), NnError> {
        let expected = vec![n_factors + 2, N_VALUES];
        for profiles in [&self.usual, &self.hooking] {
            let rows = [&profiles.mean, &profiles.variance].into_iter().chain(&profiles.factors);
            let (mut n_rows, mut width) = (0, N_VALUES);
            for row in rows {
                n_rows += 1;
                if row.len() != N_VALUES {
                    width = row.len();
                }
            }
            let got = vec![n_rows, width];
            if got != expected {
                return Err(NnError::WrongShape { name: "residuals".to_owned(), expected, got });
            }
        }
        for (name, profiles) in [("usual", &self.usual), ("hooking", &self.hooking)] {
            let variance = format!("residuals.{name}.variance");
            check_numbers(&variance, &profiles.variance, Expected::Positive)?;
            let correlation = format!("residuals.{name}.lag_correlation");
            check_number(&correlation, profiles.lag_correlation, Expected::Share)?;
        }
        Ok(())
    }

    /// The profiles of the hooking component or of the other components on the time grid of a case.
    pub(crate) fn curve(&self, centre: &CentreCurve, hooks: bool) -> ResidualCurve {
        let profiles = if hooks { &self.hooking } else { &self.usual };
        profiles.on_grid(centre)
    }
}

impl ResidualProfiles {
    fn from_rows(rows: &[Vec<f64>], n_factors: usize, shifts_duration: bool) -> Self {
        let n = rows.len();
        let data = DMatrix::from_fn(n, N_VALUES, |i, j| rows[i][j]);
        // The median: one odd case in ten must not move the other nine.
        let middle = |idx: usize| median(rows.iter().map(|row| row[idx])).unwrap_or(0.0);
        let mut mean: Vec<f64> = (0..N_VALUES).map(middle).collect();
        if !shifts_duration {
            mean[N_VALUES - 1] = 0.0;
        }
        let centred = DMatrix::from_fn(n, N_VALUES, |i, j| {
            let weight = if j + 1 == N_VALUES { DURATION_WEIGHT } else { 1.0 };
            weight * (data[(i, j)] - mean[j])
        });
        let total: Vec<f64> = centred.column_iter().map(|column| column.norm_squared()).collect();
        let n_backed = n_factors.min(n / CASES_PER_FACTOR);
        // Freedom that mean and factors have taken from the residuals.
        let freedom = (n.saturating_sub(1 + n_backed)).max(1) as f64;
        let svd = centred.clone().svd(false, true);
        let mut factors = vec![vec![0.0; N_VALUES]; n_factors];
        let mut left = total;
        if let Some(directions) = &svd.v_t {
            for (factor, f) in factors.iter_mut().zip(0..n_backed.min(directions.nrows())) {
                let size = svd.singular_values[f];
                for (j, value) in factor.iter_mut().enumerate() {
                    let along = size * directions[(f, j)];
                    left[j] -= along * along;
                    *value = along / ((n.max(2) - 1) as f64).sqrt();
                }
            }
        }
        let lag_correlation = lag_correlation(&left_over(&centred, &svd, n_backed));
        let last = N_VALUES - 1;
        for factor in &mut factors {
            factor[last] /= DURATION_WEIGHT;
        }
        let variance = left.iter().enumerate().map(|(j, left)| {
            let weight = if j == last { DURATION_WEIGHT } else { 1.0 };
            let least = LEAST_VARIANCE[usize::from(j == last)];
            (left / freedom / (weight * weight)).max(least)
        });
        Self { variance: variance.collect(), mean, factors, lag_correlation }
    }

    fn on_grid(&self, centre: &CentreCurve) -> ResidualCurve {
        let (onset_s, scale_s) = (centre.onset_s(), time_scale_s(centre));
        let last = scale_s / DURATION_UNIT_S;
        let nodes: Vec<f64> = (0..CURVE_N_INSTANTS)
            .map(|t| {
                let time_s = (t as f64 + 0.5) * CURVE_INTERVAL_S - onset_s;
                time_s / scale_s * NODES_PER_DURATION as f64
            })
            .collect();
        let curve = |row: &[f64], last: f64| -> Vec<f64> {
            let (along_x, rest) = row.split_at(N_NODES);
            let (along_y, duration) = rest.split_at(N_NODES);
            let forces = [along_x, along_y].into_iter();
            let forces = forces.flat_map(|axis| nodes.iter().map(|at| value_at(axis, *at)));
            forces.chain(duration.iter().map(|d| d * last)).collect()
        };
        let factors: Vec<Vec<f64>> = self.factors.iter().map(|row| curve(row, last)).collect();
        let n_values = 2 * CURVE_N_INSTANTS + 1;
        ResidualCurve {
            mean: curve(&self.mean, last),
            factors: (0..n_values).flat_map(|v| factors.iter().map(move |row| row[v])).collect(),
            variance: curve(&self.variance, last * last),
            // Neighbouring instants are that share of a node apart.
            lag_correlation: self
                .lag_correlation
                .clamp(0.0, MOST_CORRELATED)
                .powf((CURVE_INTERVAL_S / scale_s * NODES_PER_DURATION as f64).min(LONGEST_STEP)),
        }
    }
}

/// The part of the rows that the first factors do not explain.
fn left_over(
    rows: &DMatrix<f64>,
    svd: &nalgebra::SVD<f64, nalgebra::Dyn, nalgebra::Dyn>,
    n_factors: usize,
) -> DMatrix<f64> {
    let mut left = rows.clone();
    for direction in svd.v_t.iter().flat_map(|v_t| v_t.row_iter()).take(n_factors) {
        let along = &left * direction.transpose();
        left -= along * direction;
    }
    left
}

/// Correlation of neighbouring nodes over all rows and both axes.
fn lag_correlation(left: &DMatrix<f64>) -> f64 {
    let (mut product, mut square) = (0.0, 0.0);
    for row in left.row_iter() {
        for first in [0, N_NODES] {
            for node in first..first + N_NODES - 1 {
                product += row[node] * row[node + 1];
                square += 0.5 * (row[node].powi(2) + row[node + 1].powi(2));
            }
        }
    }
    if square > 0.0 { (product / square).clamp(0.0, MOST_CORRELATED) } else { 0.0 }
}

/// Difference of a case from its centre in force and duration, scaled.
fn residual(case: &ForceCase, centre: &CentreCurve) -> Vec<f64> {
    let (onset_s, scale_s) = (centre.onset_s(), time_scale_s(centre));
    let pairs = [(&case.curve.fx_n, &centre.curve.fx_n), (&case.curve.fy_n, &centre.curve.fy_n)];
    let forces = pairs.into_iter().flat_map(|(known, centre_n)| {
        let difference: Vec<f64> = known.iter().zip(centre_n).map(|(f, c)| f - c).collect();
        (0..N_NODES).map(move |node| {
            let time_s = onset_s + scale_s * node as f64 / NODES_PER_DURATION as f64;
            let at = time_s / CURVE_INTERVAL_S - 0.5;
            value_at(&difference, at) / centre.scale_n
        })
    });
    let duration = (case.curve.duration_s - centre.curve.duration_s) / scale_s;
    forces.chain([duration]).map(|r| r.clamp(-LARGEST_RESIDUAL, LARGEST_RESIDUAL)).collect()
}

/// T, the duration of a triangular pulse with the impulse and the peak of the centre, s.
fn time_scale_s(centre: &CentreCurve) -> f64 {
    let area: f64 = centre.curve.magnitude_n().iter().sum::<f64>() * CURVE_INTERVAL_S;
    (2.0 * area / centre.scale_n).max(CURVE_INTERVAL_S)
}

/// Linear interpolation between values; zero before the first and after the last.
fn value_at(values: &[f64], at: f64) -> f64 {
    if !(0.0..=values.len() as f64 - 1.0).contains(&at) {
        return 0.0;
    }
    let (below, share) = (at.floor() as usize, at.fract());
    let value = |i: usize| values.get(i).copied().unwrap_or(0.0);
    value(below) * (1.0 - share) + value(below + 1) * share
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::force::input::shipped;
    use crate::force::physics::haversine_centre;

    /// Cases whose residual is a bump along y of random height, and a duration that follows it.
    fn cases_of(heights: &[f64], centre: &CentreCurve) -> Vec<ForceCase> {
        let template = shipped("fea").swap_remove(0);
        let case = |height: &f64| {
            let mut case = ForceCase { hooked: false, separated: true, ..template.clone() };
            case.curve = centre.curve.clone();
            for (force, centre_n) in case.curve.fy_n.iter_mut().zip(&centre.curve.fy_n) {
                *force += height * centre_n;
            }
            case.curve.duration_s *= 1.0 + 0.5 * height;
            case
        };
        heights.iter().map(case).collect()
    }

    #[test]
    fn one_cause_is_one_factor_that_moves_force_and_duration() {
        let centre = haversine_centre(0.1, 40e3);
        let heights: Vec<f64> = (0..21).map(|i| (f64::from(i) - 10.0) / 50.0).collect();
        let cases = cases_of(&heights, &centre);
        let centres = vec![centre.clone(); cases.len()];
        let n = heights.len() as f64;
        let mean = heights.iter().sum::<f64>() / n;
        let std = (heights.iter().map(|h| (h - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt();
        let residuals = ResidualModel::fit(&cases, &centres, 2).curve(&centre, false);
        let peak_idx = CURVE_N_INSTANTS + 50;
        assert!((residuals.mean[peak_idx] - mean).abs() < 0.01);
        let factor = residuals.factors[2 * peak_idx].abs();
        assert!((factor - std).abs() < 0.05 * std, "{factor} {std}");
        assert!(residuals.factors[2 * peak_idx + 1].abs() < 0.01);
        let duration = residuals.factors[4 * CURVE_N_INSTANTS].abs() * DURATION_UNIT_S;
        assert!((duration - 0.5 * std * 0.1).abs() < 0.05 * std * 0.1, "{duration}");
        assert!(residuals.variance[peak_idx] < 1e-3 * std * std);
        // What all cases have in common is the mean; the duration stays that of the physics.
        let higher: Vec<f64> = heights.iter().map(|height| height + 0.1).collect();
        let higher = ResidualModel::fit(&cases_of(&higher, &centre), &centres, 2);
        let higher = higher.curve(&centre, false);
        assert!((higher.mean[peak_idx] - 0.1).abs() < 0.01, "{}", higher.mean[peak_idx]);
        assert_eq!(higher.mean[2 * CURVE_N_INSTANTS], 0.0);
        // Without factors all of it is independent.
        let alone = ResidualModel::fit(&cases, &centres, 0).curve(&centre, false);
        assert!((alone.variance[peak_idx].sqrt() - std).abs() < 0.05 * std);
    }

    #[test]
    fn few_hooked_cases_borrow_the_spread_of_plain_ones() {
        let centre = haversine_centre(0.1, 40e3);
        let cases = cases_of(&[-0.1, 0.0, 0.1, 0.05], &centre);
        let centres = vec![centre.clone(); cases.len()];
        let model = ResidualModel::fit(&cases, &centres, 3);
        assert!(model.check(3).is_ok() && model.check(2).is_err());
        let [usual, hooking] = [false, true].map(|hooks| model.curve(&centre, hooks));
        assert_eq!(usual.mean, hooking.mean);
        assert!(hooking.variance.iter().zip(&usual.variance).all(|(h, u)| h >= u));
    }
}
