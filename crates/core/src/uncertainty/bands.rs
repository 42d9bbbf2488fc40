//! Central bands of the force over time.
//!
//! For `F_x` and `F_y` the edges are quantiles of the exact normal mixture at each instant, to 1e-7
//! of the probability. For `|F|` the pair (F_x, F_y) of each component is represented by points on
//! a spiral that covers the bivariate normal distribution evenly, some 400 points for all
//! components; the quantiles of these points are correct to about half a percent of the
//! probability. No random numbers are used.

use serde::Serialize;

use crate::uncertainty::magnitude::magnitude_quantiles;
use crate::uncertainty::quantiles::QuantileSolver;
use crate::uncertainty::{CurveComponent, CurveMixture, MixtureError};

/// A central band over the instants of the time grid.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CurveBand {
    /// Probability that the force lies inside the band at an instant, 0 to 1.
    pub level: f64,
    /// Lower edge at each instant, N.
    pub lower_n: Vec<f64>,
    /// Upper edge at each instant, N.
    pub upper_n: Vec<f64>,
}

/// Bands of a force, one for each level in the order in which the levels were given.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CurveBands {
    /// Bands of the force along x.
    pub fx: Vec<CurveBand>,
    /// Bands of the force along y.
    pub fy: Vec<CurveBand>,
    /// Bands of the magnitude `|F|`.
    pub magnitude: Vec<CurveBand>,
}

impl CurveMixture {
    /// Central bands of F_x, F_y and `|F|` at every instant.
    ///
    /// - `levels`: probability that each band holds, strictly between 0 and 1.
    ///
    /// # Errors
    /// [`MixtureError::Level`] for a level outside this range.
    pub fn bands(&self, levels: &[f64]) -> Result<CurveBands, MixtureError> {
        if let Some(&level) = levels.iter().find(|level| !(0.0 < **level && **level < 1.0)) {
            return Err(MixtureError::Level { level });
        }
        let tails = levels.iter().flat_map(|level| [(1.0 - level) / 2.0, (1.0 + level) / 2.0]);
        let probabilities: Vec<f64> = tails.collect();
        let marginals = Marginals::from_mixture(self);
        let n = marginals.n_instants;
        let solver = QuantileSolver::new(&probabilities);
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
                Some(CurveBand { level, lower_n, upper_n })
            };
            levels.iter().filter_map(band).collect()
        };
        Ok(CurveBands { fx: bands(fx), fy: bands(fy), magnitude: bands(magnitude) })
    }
}

/// Means, standard deviations and covariances of the forces under each component.
pub(super) struct Marginals {
    pub n_instants: usize,
    pub weights: Vec<f64>,
    /// Mean forces, N, `[component][value]`, F_x at all instants followed by F_y.
    pub means: Vec<Vec<f64>>,
    pub stds: Vec<Vec<f64>>,
    /// Covariance of F_x and F_y, N², `[component][instant]`.
    pub covariances: Vec<Vec<f64>>,
}

impl Marginals {
    fn from_mixture(mixture: &CurveMixture) -> Self {
        let n = mixture.n_instants();
        let components = mixture.components();
        let forces = |mut row: Vec<f64>| {
            row.truncate(2 * n);
            row
        };
        let covariance = |component: &CurveComponent| {
            let mut sum = vec![0.0; n];
            for column in component.factors.column_iter() {
                let (x, y) = (column.iter(), column.iter().skip(n));
                for (sum, (x, y)) in sum.iter_mut().zip(x.zip(y)) {
                    *sum += x * y;
                }
            }
            sum
        };
        let std = |component: &CurveComponent| {
            forces(component.total_variance().into_iter().map(f64::sqrt).collect())
        };
        Self {
            n_instants: n,
            weights: components.iter().map(|component| component.weight).collect(),
            means: components.iter().map(|component| forces(component.mean.clone())).collect(),
            stds: components.iter().map(std).collect(),
            covariances: components.iter().map(covariance).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::numerics::quantile_of_sorted;
    use crate::uncertainty::CurveMixture;
    use crate::uncertainty::mixture::tests::example;

    const LEVELS: [f64; 4] = [0.5, 0.8, 0.9, 0.95];

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
