//! Moves that leave prior times likelihood to the power of β as it is.
//!
//! Both kinds take their step from a mixture q of normals ([`Mixture`]), with respect to which they
//! are reversible, so that both are accepted with the same probability:
//!
//! ```text
//! local          z' = m_k + √(1 − ρ²) (z − m_k) + ρ L_k ξ      k with probability w_k N_k(z) / q(z)
//! independent    z' = m_k + L_k ξ                              k with probability w_k
//!
//! a = min(1, [p(z') L(z')^β / q(z')] / [p(z) L(z)^β / q(z)])
//! ```
//!
//! The local move is the preconditioned Crank–Nicolson step with the mixture in place of the prior:
//! `Σ_k w_k N_k(z) K_k(z, z')` is symmetric because each K_k is reversible with respect to N_k.
//! ρ follows the share of accepted moves, and the share of either kind follows the mean square of
//! the distance that its moves cover, [`FearnheadTaylor2013`](crate::bibliography::FearnheadTaylor2013).
//!
//! Source: [`Cotter2013`](crate::bibliography::Cotter2013) for one normal.

use rand::{Rng, RngExt};
use serde::{Deserialize, Serialize};

use super::mixture::{Mixture, standard_normals};

/// Share of accepted local moves that ρ is adapted to.
const ACCEPTANCE: f64 = 0.3;

/// Smallest step ρ.
const MIN_STEP: f64 = 0.01;

/// Smallest share of either kind of move.
const MIN_KIND_SHARE: f64 = 0.1;

/// Step and shares of the moves, adapted from temperature to temperature.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MoveSettings {
    /// Step ρ of the local moves, 0 to 1.
    pub step: f64,
    /// Share of independent moves, 0 to 1.
    pub independent_share: f64,
}

impl Default for MoveSettings {
    fn default() -> Self {
        Self { step: 0.5, independent_share: 0.5 }
    }
}

/// The kind of a move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum MoveKind {
    Local,
    Independent,
}

/// A proposed move.
#[derive(Debug, Clone)]
pub(super) struct Proposal {
    pub kind: MoveKind,
    pub z: Vec<f64>,
    /// `ln [p(z') / q(z')] − ln [p(z) / q(z)]`.
    pub ln_ratio: f64,
}

/// How many moves of one kind were made, and how far they led.
#[derive(Debug, Clone, Copy, Default)]
struct MoveCount {
    tried: f64,
    /// Sum of the probabilities to be accepted.
    accepted: f64,
    /// Sum of these probabilities times the square of the distance.
    distance_square: f64,
}

/// What the moves of a temperature have led to.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct MoveRecord([MoveCount; 2]);

impl MoveSettings {
    /// Proposes a move from z.
    pub fn propose(&self, mixture: &Mixture, z: &[f64], rng: &mut impl Rng) -> Proposal {
        let kind = match rng.random::<f64>() < self.independent_share {
            true => MoveKind::Independent,
            false => MoveKind::Local,
        };
        let moved = match kind {
            MoveKind::Independent => mixture.any_part(rng).place(&standard_normals(z.len(), rng)),
            MoveKind::Local => {
                let part = mixture.part_of(z, rng);
                let keep = (1.0 - self.step * self.step).sqrt();
                let noise = standard_normals(z.len(), rng);
                let u = part.whiten(z).into_iter().zip(noise);
                part.place(&u.map(|(u, xi)| keep * u + self.step * xi).collect::<Vec<f64>>())
            }
        };
        let ln_weight =
            |z: &[f64]| -z.iter().map(|z| z * z).sum::<f64>() / 2.0 - mixture.ln_density(z);
        Proposal { kind, ln_ratio: ln_weight(&moved) - ln_weight(z), z: moved }
    }

    /// Adapts step and shares to what the moves have led to.
    pub fn adapt(&mut self, record: &MoveRecord) {
        let [local, independent] = record.0;
        if local.tried > 0.0 {
            let difference = local.accepted / local.tried - ACCEPTANCE;
            self.step = (self.step * (2.0 * difference).exp()).clamp(MIN_STEP, 1.0);
        }
        let [local, independent] = [local, independent]
            .map(|count| if count.tried > 0.0 { count.distance_square / count.tried } else { 0.0 });
        if local + independent > 0.0 {
            let share = independent / (local + independent);
            self.independent_share = share.clamp(MIN_KIND_SHARE, 1.0 - MIN_KIND_SHARE);
        }
    }
}

impl MoveRecord {
    /// Adds a move with its probability to be accepted. The square of the distance counts up to that
    /// of two independent particles, twice over.
    pub fn add(&mut self, kind: MoveKind, probability: f64, distance_square: f64, dim: usize) {
        let count = &mut self.0[match kind {
            MoveKind::Local => 0,
            MoveKind::Independent => 1,
        }];
        count.tried += 1.0;
        count.accepted += probability;
        count.distance_square += probability * distance_square.min(4.0 * dim as f64);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nn::random_stream;
    use crate::reconstruct::sampler::mixture::Weighted;

    /// Both kinds of moves keep a standard normal distribution although the mixture is fitted to two
    /// other heaps: means, variances and the correlation of 4000 chains after 60 moves.
    #[test]
    fn moves_keep_the_prior_whatever_the_mixture() {
        let mut rng = random_stream(3, "heaps", 0);
        let heap = |rng: &mut _, idx: usize| {
            let u = standard_normals(2, rng);
            let at = if idx.is_multiple_of(2) { 1.5 } else { -1.0 };
            vec![at + 0.8 * u[0], 0.9 * u[1] + 0.3 * u[0]]
        };
        let points: Vec<Vec<f64>> = (0..600).map(|idx| heap(&mut rng, idx)).collect();
        let z: Vec<&[f64]> = points.iter().map(Vec::as_slice).collect();
        let mixture = Mixture::fit(Weighted { z: &z, weight: &[1.0 / 600.0; 600] });
        for share in [0.0, 0.5, 1.0] {
            let settings = MoveSettings { step: 0.7, independent_share: share };
            let mut ends = Vec::new();
            for _ in 0..4000 {
                let mut z = standard_normals(2, &mut rng);
                for _ in 0..60 {
                    let proposal = settings.propose(&mixture, &z, &mut rng);
                    if rng.random::<f64>().ln() < proposal.ln_ratio {
                        z = proposal.z;
                    }
                }
                ends.push(z);
            }
            let mean = |f: &dyn Fn(&[f64]) -> f64| ends.iter().map(|z| f(z)).sum::<f64>() / 4000.0;
            // Four standard errors: 4/√4000 for means and products, 4 √(2/4000) for squares.
            let (mean_error, square_error) = (0.064, 0.09);
            for j in 0..2 {
                assert!(mean(&|z| z[j]).abs() < mean_error, "share {share}: mean of {j}");
                assert!((mean(&|z| z[j] * z[j]) - 1.0).abs() < square_error, "share {share}: {j}");
            }
            assert!(mean(&|z| z[0] * z[1]).abs() < mean_error, "share {share}: correlation");
        }
    }

    #[test]
    fn steps_grow_when_all_is_accepted_and_shrink_when_nothing_is() {
        let adapted = |probability| {
            let (mut settings, mut record) = (MoveSettings::default(), MoveRecord::default());
            record.add(MoveKind::Local, probability, 1.0, 3);
            record.add(MoveKind::Independent, 0.5, 100.0, 3);
            settings.adapt(&record);
            settings
        };
        assert!(adapted(1.0).step > 0.9 && adapted(0.0).step < 0.3);
        // 0.5 · 12 against 1 · 1, where 12 is the largest square that counts.
        assert!((adapted(1.0).independent_share - 6.0 / 7.0).abs() < 1e-12);
    }
}
