//! Strengths of the effects beside the 4DOF model, from single steps.
//!
//! ```text
//! c = argmin Σ_rows h_δ((a − Σ_k c_k e_k)/u)/n + λ ‖c‖²/2
//! ```
//!
//! a: the residual acceleration that leads from one recorded state to the next, in units u; h_δ:
//! Huber's function, since a few instants (a wheel that lifts, a car that comes to rest) are off by
//! far more than the rest. Solved by iteratively reweighted least squares, the ridge λ holds the
//! strengths near none:
//!
//! ```text
//! λ ‖c‖²  →  λ cᵀ (I − s Σ_m d_m d_mᵀ) c
//! ```
//!
//! where strengths may change together along d_m: grip, balance, shares of the impulse.
//!
//! Source: P. J. Huber, Robust Statistics, 1981, section 7.8; A. E. Hoerl, R. W. Kennard, Ridge
//! Regression, Technometrics 12 (1970) 55–67.

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use crate::response::physics::effects::{Direction, direction};
use crate::response::{Effects, N_EFFECTS, N_RESIDUAL};

/// Rounds of reweighting.
const N_ROUNDS: usize = 8;
/// Strengths that change together.
const COMMON: [Direction; 4] =
    [Direction::Grip, Direction::Balance, Direction::YawImpulse, Direction::LateralImpulse];

/// The fit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct EffectsConfig {
    /// λ.
    pub ridge: f64,
    /// s, from 0 to below 1: how far the ridge lets strengths change together, as another grip, another
    /// balance or other shares of the impulse change them.
    pub common: f64,
    /// δ: residuals beyond it, in units of the network's output, count linearly.
    pub huber: f64,
}

impl Default for EffectsConfig {
    fn default() -> Self {
        Self { ridge: 1e-3, common: 0.0, huber: 0.3 }
    }
}

impl EffectsConfig {
    /// For about a hundred noisy instants: what they say of a tire at one slip angle counts at all
    /// others, rather than each strength by itself. Chosen on simulated scaled vehicles
    /// (`examples/scaled_log.rs`), among ridges from 0.03 to 1 with s of 0, 0.99 and 0.999.
    #[must_use]
    pub fn few_samples(self) -> Self {
        Self { ridge: 0.1, common: 0.99, ..self }
    }
}

/// The strengths that explain the targets best.
///
/// - `rows`: effects and residual acceleration of each instant;
/// - `unit`: u, m/s² and rad/s².
pub(crate) fn fit_strengths(
    rows: &[(&Effects<f64>, [f64; N_RESIDUAL])],
    unit: [f64; N_RESIDUAL],
    config: EffectsConfig,
) -> Vec<f64> {
    let mut strengths = DVector::zeros(N_EFFECTS);
    let n = (rows.len() * N_RESIDUAL).max(1) as f64;
    let prior = precision(config);
    for _ in 0..N_ROUNDS {
        let mut normal = prior.clone();
        let mut right = DVector::zeros(N_EFFECTS);
        let mut scaled = DMatrix::zeros(N_EFFECTS, N_RESIDUAL);
        for (effects, target) in rows {
            for axis in 0..N_RESIDUAL {
                let column = effects.iter().map(|effect| effect[axis] / unit[axis]);
                scaled.set_column(axis, &DVector::from_iterator(N_EFFECTS, column));
            }
            let off = DVector::from_fn(N_RESIDUAL, |axis, _| target[axis] / unit[axis])
                - scaled.tr_mul(&strengths);
            let mut weighted = scaled.clone();
            for axis in 0..N_RESIDUAL {
                let weight = (config.huber / off[axis].abs().max(config.huber)) / n;
                weighted.column_mut(axis).scale_mut(weight);
                right.axpy(target[axis] / unit[axis], &weighted.column(axis), 1.0);
            }
            normal.gemm(1.0, &weighted, &scaled.transpose(), 1.0);
        }
        match normal.cholesky() {
            Some(normal) => strengths = normal.solve(&right),
            // Only numbers that are not finite make the sum of squares and a ridge singular.
            None => return vec![0.0; N_EFFECTS],
        }
    }
    strengths.iter().copied().collect()
}

/// `λ (I − s Σ_m d_m d_mᵀ)`, d_m the named directions, of length one and at right angles.
fn precision(config: EffectsConfig) -> DMatrix<f64> {
    let mut precision = DMatrix::identity(N_EFFECTS, N_EFFECTS);
    for of in COMMON {
        let along = DVector::from_row_slice(&direction(of)).normalize();
        precision.ger(-config.common, &along, &along, 1.0);
    }
    precision * config.ridge
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::response::{combined, effects};
    use impactlab_core::vehicle::{Preset, VehicleInput, VehicleState};

    #[test]
    fn what_is_seen_at_one_slip_angle_counts_at_all_where_strengths_change_together() {
        let vehicle = Preset::ScaledStruck.parameters();
        let u = VehicleInput::released();
        let at = |vy_body_m_s: f64, yaw_rate_rad_s: f64| {
            let x = VehicleState {
                vx_body_m_s: 6.0,
                vy_body_m_s,
                yaw_rate_rad_s,
                ..VehicleState::default()
            };
            effects(&vehicle, &x, &vehicle.evaluate(&x, &u))
        };
        // Side force lower by a fifth of the friction; seen at small slip angles alone.
        let truth = direction(Direction::Grip).map(|strength| -0.2 * strength);
        let seen: Vec<Effects<f64>> =
            (1..80).map(|i| at(0.02 * f64::from(i), 0.3 * (0.7 * f64::from(i)).sin())).collect();
        let rows: Vec<_> =
            seen.iter().map(|effects| (effects, combined(effects, &truth))).collect();
        let unseen = at(6.0, 0.0);
        let error = |config: EffectsConfig| {
            let found = fit_strengths(&rows, [0.3, 0.3, 0.3, 1.0], config);
            let [got, expected] = [&found, &truth.to_vec()].map(|c| combined(&unseen, c)[1]);
            ((got - expected) / expected).abs()
        };
        let config = EffectsConfig { huber: 10.0, ..EffectsConfig::default().few_samples() };
        let (together, alone) = (error(config), error(EffectsConfig { common: 0.0, ..config }));
        assert!(together < 0.15 && alone > 0.5, "{together} {alone}");
    }

    #[test]
    fn known_strengths_are_found_though_some_instants_are_wrong() {
        let vehicle = Preset::Reference.parameters();
        let u = VehicleInput::released();
        let at = |i: usize| {
            let i = i as f64;
            let x = VehicleState {
                vx_body_m_s: 15.0 * (0.7 * i).cos() + 5.0,
                vy_body_m_s: 9.0 * (1.3 * i).sin(),
                yaw_rate_rad_s: 1.5 * (2.1 * i).sin(),
                roll_rad: 0.05 * (0.9 * i).sin(),
                roll_rate_rad_s: 0.3 * (1.7 * i).cos(),
                ..VehicleState::default()
            };
            effects(&vehicle, &x, &vehicle.evaluate(&x, &u))
        };
        let instants: Vec<Effects<f64>> = (0..2000).map(at).collect();
        let truth: Vec<f64> = (0..N_EFFECTS).map(|k| 0.3 * (1.1 * k as f64).sin()).collect();
        let unit = [0.3, 0.3, 0.3, 1.0];
        let rows: Vec<_> = instants
            .iter()
            .enumerate()
            .map(|(i, effects)| {
                let mut target = combined(effects, &truth);
                // Every twentieth is far off.
                target[i % 4] += if i % 20 == 0 { 8.0 } else { 0.0 };
                (effects, target)
            })
            .collect();
        let config = EffectsConfig { ridge: 1e-7, common: 0.0, huber: 0.05 };
        let found = fit_strengths(&rows, unit, config);
        let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
        for (effects, _) in rows.iter().skip(1).step_by(20) {
            let [a, b] = [&found, &truth].map(|strengths| combined(effects, strengths));
            for axis in 0..N_RESIDUAL {
                worst = worst.max((a[axis] - b[axis]).abs() / unit[axis]);
                largest = largest.max(b[axis].abs() / unit[axis]);
            }
        }
        assert!(worst < 0.05 * largest, "{worst} of {largest}");
    }
}
