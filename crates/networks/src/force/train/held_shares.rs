//! The share of observed values that the central intervals of predictions contain.

use crate::force::train::calibration::{CalibrationCase, VarianceFactors};
use impactlab_core::numerics::normal_cdf;
use impactlab_core::uncertainty::CURVE_INTERVAL_S;

/// Nominal share of the central intervals that are calibrated.
pub(super) const CALIBRATED_SHARE: f64 = 0.9;
/// Nominal shares of the intervals by which the factors of shapes and peaks are chosen: of few cases, one
/// share alone is held by factors as well that are far too large.
const SHARES: [f64; 2] = [0.5, CALIBRATED_SHARE];

/// The share of observed values inside the central intervals of each of [`SHARES`], as half a value more
/// inside and half a one more outside would have it: none and all are no certainty.
#[derive(Debug, Clone, Copy)]
pub(super) struct Held([f64; SHARES.len()]);

impl Held {
    /// Counts observed values by the predicted probability of a smaller one.
    pub(super) fn of(below: &[f64]) -> Self {
        Self(SHARES.map(|share| {
            let tail = (1.0 - share) / 2.0;
            let inside = below.iter().filter(|below| (tail..=1.0 - tail).contains(*below));
            (inside.count() as f64 + 0.5) / (below.len() as f64 + 1.0)
        }))
    }

    /// That of [`CALIBRATED_SHARE`].
    pub(super) fn calibrated(self) -> f64 {
        self.0[SHARES.len() - 1]
    }

    /// Sum of the squared differences from the nominal shares, in logarithms of the odds: from 90 %, 80 %
    /// are as far as 95.
    pub(super) fn off(self) -> f64 {
        let log_odds = |share: f64| (share / (1.0 - share)).ln();
        let off = |(held, share): (&f64, f64)| (log_odds(*held) - log_odds(share)).powi(2);
        self.0.iter().zip(SHARES).map(off).sum()
    }
}

/// The forces F_x and F_y during contact in their intervals.
pub(super) fn held_forces(cases: &[CalibrationCase<'_>], factors: VarianceFactors) -> Held {
    let below = cases.iter().flat_map(|CalibrationCase { case, mixture, .. }| {
        let mixture = factors.apply(mixture.clone());
        let observed = case.curve.to_values();
        let n_instants = observed.len() / 2;
        let last_s = case.onset_s + case.curve.duration_s;
        let n_contact = ((last_s / CURVE_INTERVAL_S).ceil() as usize).min(n_instants);
        // Every second instant is sufficient because neighbouring values are strongly correlated.
        let instants = (0..n_contact).step_by(2);
        let values: Vec<usize> = instants.flat_map(|t| [t, n_instants + t]).collect();
        let below = move |idx: usize| -> f64 {
            let below = mixture.components().iter().map(|component| {
                let row = component.factors.row(idx);
                let variance = row.norm_squared() + component.variance[idx];
                component.weight
                    * normal_cdf((observed[idx] - component.mean[idx]) / variance.sqrt())
            });
            below.sum()
        };
        values.into_iter().map(below).collect::<Vec<f64>>()
    });
    Held::of(&below.collect::<Vec<f64>>())
}

/// The impulses P_x and P_y in their intervals.
pub(super) fn held_impulses(cases: &[CalibrationCase<'_>], factors: VarianceFactors) -> Held {
    let below = cases.iter().flat_map(|CalibrationCase { case, mixture, .. }| {
        let mixture = factors.apply(mixture.clone());
        [0, 1].map(|axis| mixture.impulse(axis).cdf(case.impulse_n_s[axis]))
    });
    Held::of(&below.collect::<Vec<f64>>())
}

/// The durations in their intervals.
pub(super) fn held_durations(cases: &[CalibrationCase<'_>], factors: VarianceFactors) -> Held {
    let below = cases.iter().map(|CalibrationCase { case, mixture, .. }| {
        factors.apply(mixture.clone()).duration_s().cdf(case.curve.duration_s)
    });
    Held::of(&below.collect::<Vec<f64>>())
}
