//! The mixture of normals from which particles are drawn.
//!
//! ```text
//! q(z) = Σ_k w_k [(1 − s) N(z; m_k, C_k) + s N(z; m_k, t² C_k)]      C_k = (n_k S_k + ν S) / (n_k + ν)
//! ```
//!
//! S_k is the covariance of the particles of part k and S the mean of the S_k; ν = 20 dim. A part of
//! few particles has nearly the covariance S: a covariance of its own would follow these particles
//! so closely that few draws reach the places between them. The share s of the draws is wider by t,
//! so that the tails of what the mixture is fitted to are reached, too.
//!
//! Parts are split as long as the Bayesian information criterion of a common covariance improves.
//! The start of a split is the best division of one coordinate into two, before and after whitening:
//! k-means in all coordinates misses two modes that differ in one of twenty.

use nalgebra::{DMatrix, DVector};
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use impactlab_core::numerics::{index_of_share, ln_sum_exp};

/// Largest number of parts.
const MAX_PARTS: usize = 6;

/// Number of steps of expectation and maximisation after each split.
const N_STEPS: usize = 8;

/// Weight ν of the common covariance, in particles for each dimension.
const SHARED_PARTICLES_PER_DIM: f64 = 20.0;

/// Variance that every part has at least, of the variance of the prior.
const MIN_VARIANCE: f64 = 1e-10;

/// Largest number of a file, far beyond any that is drawn or fitted.
const LARGEST_NUMBER: f64 = 1e9;

/// Smallest share of the particles on either side of a split.
const MIN_SHARE: f64 = 0.02;

/// Share s of the draws that are wider.
const WIDE_SHARE: f64 = 0.25;

/// How much wider they are, t.
const WIDE: f64 = 1.15;

/// One normal distribution of the mixture.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Part {
    ln_weight: f64,
    mean: Vec<f64>,
    /// Columns of the lower Cholesky factor L of the covariance `C = L Lᵀ`, each from its diagonal on.
    factor: Vec<Vec<f64>>,
    /// `−ln det L`.
    ln_scale: f64,
}

/// A mixture of normals.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Mixture {
    parts: Vec<Part>,
}

/// Particles with their weights, which sum to 1.
#[derive(Debug, Clone, Copy)]
pub(super) struct Weighted<'a> {
    pub z: &'a [&'a [f64]],
    pub weight: &'a [f64],
}

impl Part {
    /// A part with this covariance. Few particles say little of how coordinates depend on each
    /// other: below 3 dim of them the covariance goes over into its diagonal.
    fn new(weight: f64, mean: DVector<f64>, mut covariance: DMatrix<f64>, n: f64) -> Self {
        let diagonal = covariance.diagonal();
        covariance *= (n / (3 * mean.len()) as f64).min(1.0);
        covariance.set_diagonal(&diagonal);
        let mut least = MIN_VARIANCE;
        let dim = mean.len();
        // No variance that is added makes a factor of what is no number.
        if !covariance.iter().all(|entry| entry.is_finite()) {
            covariance = DMatrix::identity(dim, dim);
        }
        let lower = loop {
            let widened =
                &covariance + DMatrix::from_diagonal_element(mean.len(), mean.len(), least);
            match widened.cholesky() {
                Some(cholesky) => break cholesky.unpack(),
                None => least *= 10.0,
            }
        };
        let ln_scale = -lower.diagonal().iter().map(|scale| scale.ln()).sum::<f64>();
        let column = |j: usize| lower.column(j).iter().skip(j).copied().collect();
        let factor = (0..dim).map(column).collect();
        Self { ln_weight: weight.ln(), mean: mean.iter().copied().collect(), factor, ln_scale }
    }

    /// `u = L⁻¹ (z − m)`.
    pub fn whiten(&self, z: &[f64]) -> Vec<f64> {
        let mut u: Vec<f64> = z.iter().zip(&self.mean).map(|(z, mean)| z - mean).collect();
        for (j, column) in self.factor.iter().enumerate() {
            let (done, left) = u.split_at_mut(j + 1);
            done[j] /= column[0];
            let below = column[1..].iter();
            left.iter_mut().zip(below).for_each(|(u, factor)| *u -= factor * done[j]);
        }
        u
    }

    /// `z = m + L u`.
    pub fn place(&self, u: &[f64]) -> Vec<f64> {
        let mut z = self.mean.clone();
        for (j, column) in self.factor.iter().enumerate() {
            z[j..].iter_mut().zip(column).for_each(|(z, factor)| *z += factor * u[j]);
        }
        z
    }

    /// Logarithm of weight times density of the narrow normal, without the constant `−dim/2 ln 2π`.
    fn ln_density(&self, z: &[f64]) -> f64 {
        self.ln_weight + self.ln_scale - self.distance_square(z) / 2.0
    }

    /// Logarithm of weight times density of both normals, without that constant.
    fn ln_proposal_density(&self, z: &[f64]) -> f64 {
        let square = self.distance_square(z);
        let narrow = (1.0 - WIDE_SHARE).ln() - square / 2.0;
        let wide = WIDE_SHARE.ln() - z.len() as f64 * WIDE.ln() - square / (2.0 * WIDE * WIDE);
        self.ln_weight + self.ln_scale + ln_sum_exp(&[narrow, wide])
    }

    fn distance_square(&self, z: &[f64]) -> f64 {
        self.whiten(z).iter().map(|u| u * u).sum()
    }

    /// Whether all numbers are finite and belong to as many variables.
    fn is_of(&self, dim: usize) -> bool {
        let is_column = |(j, column): (usize, &Vec<f64>)| {
            column.len() == dim - j && column[0] > 0.0 && column.iter().all(is_plausible)
        };
        self.mean.len() == dim
            && self.factor.len() == dim
            && self.factor.iter().enumerate().all(is_column)
            && self.mean.iter().chain([&self.ln_weight, &self.ln_scale]).all(is_plausible)
    }
}

/// Whether a number that comes from a file may be one of standard normal variables or of their
/// distribution: sums of its square stay finite.
pub(super) fn is_plausible(number: &f64) -> bool {
    number.abs() <= LARGEST_NUMBER
}

impl Mixture {
    /// Fits a mixture to particles, of which there is at least one.
    pub fn fit(particles: Weighted<'_>) -> Self {
        let dim = particles.z.first().map_or(0, |z| z.len());
        let n = 1.0 / particles.weight.iter().map(|weight| weight * weight).sum::<f64>();
        let mut shares = vec![vec![1.0; particles.z.len()]];
        let mut mixture = Self::from_shares(particles, &shares, f64::INFINITY);
        let mut score = mixture.mean_ln_density(particles) * n;
        let penalty = (dim + 1) as f64 * n.ln() / 2.0;
        while mixture.parts.len() < MAX_PARTS {
            let Some(split) = mixture.best_split(particles, &shares) else { break };
            let split_score = split.0.mean_ln_density(particles) * n;
            if split_score - score <= penalty {
                break;
            }
            (score, mixture, shares) = (split_score, split.0, split.1);
        }
        Self::from_shares(particles, &shares, SHARED_PARTICLES_PER_DIM * dim as f64 / n)
    }

    /// Logarithm of the density q of the draws, without the constant `−dim/2 ln 2π`.
    pub fn ln_density(&self, z: &[f64]) -> f64 {
        let of_parts: Vec<f64> =
            self.parts.iter().map(|part| part.ln_proposal_density(z)).collect();
        ln_sum_exp(&of_parts)
    }

    /// Draws a point.
    pub fn draw(&self, rng: &mut impl Rng) -> Vec<f64> {
        let part = self.any_part(rng);
        let scale = if rng.random::<f64>() < WIDE_SHARE { WIDE } else { 1.0 };
        let mut u = standard_normals(part.mean.len(), rng);
        u.iter_mut().for_each(|u| *u *= scale);
        part.place(&u)
    }

    /// Whether it is a mixture in so many variables: for one that comes from a file.
    pub fn is_of(&self, dim: usize) -> bool {
        !self.parts.is_empty() && self.parts.iter().all(|part| part.is_of(dim))
    }

    /// The same with further variables, which are standard normal and independent of the others.
    ///
    /// - `dim`: number of all variables.
    pub fn extended_to(&self, dim: usize) -> Self {
        let of_part = |part: &Part| {
            let old = part.mean.len();
            let mut part = part.clone();
            part.mean.resize(dim, 0.0);
            for (j, column) in part.factor.iter_mut().enumerate() {
                column.resize(dim - j, 0.0);
            }
            for j in old..dim {
                let mut column = vec![0.0; dim - j];
                column[0] = 1.0;
                part.factor.push(column);
            }
            part
        };
        Self { parts: self.parts.iter().map(of_part).collect() }
    }

    /// Number of parts.
    #[cfg(test)]
    pub fn n_parts(&self) -> usize {
        self.parts.len()
    }

    fn ln_densities(&self, z: &[f64]) -> Vec<f64> {
        self.parts.iter().map(|part| part.ln_density(z)).collect()
    }

    /// A part, drawn with its weight.
    fn any_part(&self, rng: &mut impl Rng) -> &Part {
        let ln_weights: Vec<f64> = self.parts.iter().map(|part| part.ln_weight).collect();
        let total = ln_sum_exp(&ln_weights);
        let weights = ln_weights.iter().map(|ln_weight| (ln_weight - total).exp());
        &self.parts[index_of_share(weights, rng.random())]
    }

    fn mean_ln_density(&self, particles: Weighted<'_>) -> f64 {
        let pairs = particles.z.par_iter().zip(particles.weight);
        pairs
            .map(|(z, weight)| weight * ln_sum_exp(&self.ln_densities(z)))
            .collect::<Vec<_>>()
            .iter()
            .sum()
    }

    /// The mixture with the given shares of the particles in its parts, `[n_parts][n]`.
    ///
    /// - `shared`: `ν / n`, infinite for a common covariance.
    fn from_shares(particles: Weighted<'_>, shares: &[Vec<f64>], shared: f64) -> Self {
        let moments: Vec<Moments> =
            shares.par_iter().map(|share| Moments::new(particles, share)).collect();
        let mut common = moments[0].covariance.clone() * moments[0].weight;
        for moments in &moments[1..] {
            common += &moments.covariance * moments.weight;
        }
        let n: f64 = moments.iter().map(|moments| moments.n).sum();
        let part = |moments: Moments| {
            let share = moments.weight / (moments.weight + shared);
            let covariance = moments.covariance * share + &common * (1.0 - share);
            Part::new(moments.weight, moments.mean, covariance, n)
        };
        Self { parts: moments.into_iter().map(part).collect() }
    }

    /// The mixture in which the part that divides best is divided, after some steps of expectation
    /// and maximisation; `None` if a part became too small.
    fn best_split(
        &self,
        particles: Weighted<'_>,
        shares: &[Vec<f64>],
    ) -> Option<(Self, Vec<Vec<f64>>)> {
        let dim = particles.z.first()?.len();
        let divisions = self.parts.par_iter().zip(shares);
        let divisions: Vec<Division> =
            divisions.map(|(part, share)| division(particles, share, part)).collect();
        let best = divisions.into_iter().enumerate().max_by(|a, b| a.1.gain.total_cmp(&b.1.gain));
        let (divided, division) = best?;
        let mut shares = shares.to_vec();
        let mut other = shares[divided].clone();
        for (idx, below) in division.below.iter().enumerate() {
            *(if *below { &mut other } else { &mut shares[divided] }).get_mut(idx)? = 0.0;
        }
        shares.push(other);
        let too_small = |share: &Vec<f64>| Moments::n_of(particles, share) <= dim as f64;
        for _ in 0..N_STEPS {
            if shares.iter().any(too_small) {
                return None;
            }
            let mixture = Self::from_shares(particles, &shares, f64::INFINITY);
            let of_particles: Vec<Vec<f64>> =
                particles.z.par_iter().map(|z| mixture.ln_densities(z)).collect();
            for (idx, densities) in of_particles.into_iter().enumerate() {
                let total = ln_sum_exp(&densities);
                for (share, density) in shares.iter_mut().zip(densities) {
                    share[idx] = (density - total).exp();
                }
            }
        }
        let is_bad = shares.iter().any(too_small);
        (!is_bad).then(|| (Self::from_shares(particles, &shares, f64::INFINITY), shares))
    }
}

/// Weight, mean and covariance of a share of the particles.
struct Moments {
    weight: f64,
    /// Effective number of particles.
    n: f64,
    mean: DVector<f64>,
    covariance: DMatrix<f64>,
}

impl Moments {
    fn n_of(particles: Weighted<'_>, share: &[f64]) -> f64 {
        let weights = particles.weight.iter().zip(share).map(|(weight, share)| weight * share);
        let (sum, square) =
            weights.fold((0.0, 0.0), |(s, q), weight| (s + weight, q + weight * weight));
        if square > 0.0 { sum * sum / square } else { 0.0 }
    }

    fn new(particles: Weighted<'_>, share: &[f64]) -> Self {
        let dim = particles.z.first().map_or(0, |z| z.len());
        let weights: Vec<f64> = particles.weight.iter().zip(share).map(|(w, s)| w * s).collect();
        let weight: f64 = weights.iter().sum();
        let mut mean = DVector::zeros(dim);
        for (z, own) in particles.z.iter().zip(&weights) {
            for (mean, z) in mean.iter_mut().zip(*z) {
                *mean += own / weight * z;
            }
        }
        let mut covariance = DMatrix::zeros(dim, dim);
        let mut off = vec![0.0; dim];
        for (z, own) in particles.z.iter().zip(&weights).filter(|(_, own)| **own > 0.0) {
            off.iter_mut().zip(*z).zip(&mean).for_each(|((off, z), mean)| *off = z - mean);
            for (j, mut column) in covariance.column_iter_mut().enumerate() {
                let scaled = own / weight * off[j];
                let below = column.as_mut_slice()[j..].iter_mut();
                below.zip(&off[j..]).for_each(|(sum, off)| *sum += scaled * off);
            }
        }
        covariance.fill_upper_triangle_with_lower_triangle();
        Self { weight, n: Self::n_of(particles, share), mean, covariance }
    }
}

/// A division of a part into two by one coordinate.
struct Division {
    /// Share of the variance of the coordinate that lies between both sides, 0 to 1.
    gain: f64,
    /// Whether each particle is on the lower side.
    below: Vec<bool>,
}

fn division(particles: Weighted<'_>, share: &[f64], part: &Part) -> Division {
    let dim = part.mean.len();
    let white: Vec<Vec<f64>> = particles.z.par_iter().map(|z| part.whiten(z)).collect();
    let column = |j: usize| white.iter().map(|u| u[j]).collect();
    let raw = |j: usize| particles.z.iter().map(|z| z[j]).collect();
    let columns: Vec<Vec<f64>> = (0..dim).map(column).chain((0..dim).map(raw)).collect();
    let of_column = |column: Vec<f64>| {
        let weighted = column.into_iter().enumerate();
        let mut sorted: Vec<(f64, f64, usize)> =
            weighted.map(|(idx, value)| (value, particles.weight[idx] * share[idx], idx)).collect();
        sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (gain, n_below) = best_cut(&sorted);
        let mut below = vec![false; sorted.len()];
        sorted[..n_below].iter().for_each(|(_, _, idx)| below[*idx] = true);
        Division { gain, below }
    };
    let divisions: Vec<Division> = columns.into_par_iter().map(of_column).collect();
    let none = Division { gain: 0.0, below: vec![false; particles.z.len()] };
    divisions.into_iter().fold(none, |best, next| if next.gain > best.gain { next } else { best })
}

/// The cut of sorted values into two groups that has the largest variance between them, as a share
/// of the whole variance, and the number of values below it.
fn best_cut(sorted: &[(f64, f64, usize)]) -> (f64, usize) {
    let [weight, sum, square] = sorted.iter().fold([0.0; 3], |[w, s, q], (value, own, _)| {
        [w + own, s + own * value, q + own * value * value]
    });
    let total = square - sum * sum / weight;
    let (mut below, mut below_sum, mut best) = (0.0, 0.0, (0.0, 0));
    for (idx, (value, own, _)) in sorted.iter().enumerate() {
        below += own;
        below_sum += own * value;
        if below < MIN_SHARE * weight || below > (1.0 - MIN_SHARE) * weight {
            continue;
        }
        let above_sum = sum - below_sum;
        let between = below_sum * below_sum / below + above_sum * above_sum / (weight - below)
            - sum * sum / weight;
        if between / total > best.0 {
            best = (between / total, idx + 1);
        }
    }
    best
}

/// Independent standard normal numbers.
pub(crate) fn standard_normals(n: usize, rng: &mut impl Rng) -> Vec<f64> {
    (0..n).map(|_| rng.sample(StandardNormal)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::numerics::random_stream;

    /// Points of two normals in six dimensions that differ in the first by `distance` standard
    /// deviations; three of four are of the first.
    fn points(distance: f64) -> Vec<Vec<f64>> {
        let mut rng = random_stream(1, "points", 0);
        let shifted = |idx: usize, mut z: Vec<f64>| {
            z[0] = 0.1 * (z[0] + if idx.is_multiple_of(4) { distance } else { 0.0 });
            z
        };
        (0..800).map(|idx| shifted(idx, standard_normals(6, &mut rng))).collect()
    }

    fn fit(points: &[Vec<f64>]) -> Mixture {
        let z: Vec<&[f64]> = points.iter().map(Vec::as_slice).collect();
        Mixture::fit(Weighted { z: &z, weight: &vec![1.0 / z.len() as f64; z.len()] })
    }

    #[test]
    fn points_whose_squares_overflow_are_fitted_and_not_read_from_a_file() {
        let mut points = points(0.0);
        points[3][2] = 1e300;
        let mixture = fit(&points);
        assert!(!mixture.is_of(6) && mixture.n_parts() >= 1);
        points[3][2] = 1e8;
        assert!(fit(&points).is_of(6));
    }

    #[test]
    fn two_modes_that_differ_in_one_coordinate_are_two_parts() {
        assert_eq!(fit(&points(0.0)).n_parts(), 1);
        let two = fit(&points(10.0));
        assert_eq!(two.n_parts(), 2);
        let mut parts: Vec<(f64, f64)> =
            two.parts.iter().map(|part| (part.mean[0], part.ln_weight.exp())).collect();
        parts.sort_by(|a, b| a.0.total_cmp(&b.0));
        assert!((parts[0].0).abs() < 0.02 && (parts[0].1 - 0.75).abs() < 1e-3, "{parts:?}");
        assert!((parts[1].0 - 1.0).abs() < 0.03 && (parts[1].1 - 0.25).abs() < 1e-3, "{parts:?}");
    }

    #[test]
    fn whitening_is_undone_by_placing() {
        let mixture = fit(&points(3.0));
        let z = [0.3, -1.0, 2.0, 0.1, 0.0, 0.7];
        for part in &mixture.parts {
            let back = part.place(&part.whiten(&z));
            assert!(back.iter().zip(z).all(|(a, b)| (a - b).abs() < 1e-12), "{back:?}");
        }
    }

    /// Mean over draws of the density of a normal over that of the draws: 1 for any mixture.
    #[test]
    fn draws_have_the_density_that_they_are_said_to_have() {
        let mixture = fit(&points(3.0));
        let mut rng = random_stream(2, "draws", 0);
        let n = 20_000;
        let scales = [0.08, 0.9, 0.9, 0.9, 0.9, 0.9];
        let ratio = |z: &[f64]| {
            let of_each = z.iter().zip(scales).map(|(z, s)| -(z / s).powi(2) / 2.0 - f64::ln(s));
            (of_each.sum::<f64>() - mixture.ln_density(z)).exp()
        };
        let ratios: Vec<f64> = (0..n).map(|_| ratio(&mixture.draw(&mut rng))).collect();
        let mean = ratios.iter().sum::<f64>() / f64::from(n);
        let square = ratios.iter().map(|ratio| (ratio - mean).powi(2)).sum::<f64>();
        let error = square.sqrt() / f64::from(n);
        assert!(error < 0.03 && (mean - 1.0).abs() < 5.0 * error, "{mean} ± {error}");
    }

    #[test]
    fn one_point_and_equal_points_have_a_narrow_normal() {
        for n in [1, 5] {
            let density = fit(&vec![vec![0.5, 2.0]; n]).ln_density(&[0.5, 2.0]);
            assert!(density.is_finite() && density > 10.0, "{n} points: {density}");
        }
    }
}
