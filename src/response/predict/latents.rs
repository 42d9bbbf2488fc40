//! What is uncertain along a whole motion: latent factors of the strengths of the effects, the same
//! from the impact to the end.
//!
//! ```text
//! c = c_j + Σ_m s_m z_m d_m          z_m ~ N(0, 1), drawn once
//! ```
//!
//! A tyre that grips less than the model says does so at every instant. Independent noise at each of
//! 400 steps would average out instead, and give bands that are too narrow. The directions d_m are
//! fixed and have a meaning, their scales s_m are calibrated on trajectories that a training has not
//! seen.
//!
//! The components of the mixture share out the latent that matters most: each takes an equal share of
//! its distribution, so that a car between recovering and spinning is not one wide normal
//! distribution but several narrow ones.

use serde::{Deserialize, Serialize};

use crate::nn::{Expected, NnError, check_number, check_numbers};
use crate::numerics::{normal_density, normal_quantile};
use crate::response::N_EFFECTS;
use crate::response::physics::effects::{Direction, direction};

/// Number of latent factors.
pub const N_LATENTS: usize = 4;

/// Their names, in order.
pub const LATENT_NAMES: [&str; N_LATENTS] = ["grip", "balance", "yaw impulse", "lateral impulse"];

/// How uncertain a model is along a motion.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LatentScales {
    /// s: standard deviation of the grip, of the balance between the axles (shares of the friction),
    /// of the yaw moment and of the lateral force of the collision (shares of either).
    pub scales: [f64; N_LATENTS],
    /// The latent factor that the components of the mixture share out.
    pub shared_out: usize,
    /// Factor on the standard deviation of each step's noise.
    pub step_noise: f64,
    /// Trajectories that the scales were calibrated on; 0 for a guess.
    pub n_calibrated: usize,
}

impl Default for LatentScales {
    /// A guess from before any calibration, on the wide side: dry roads differ by some percent, and so
    /// does what a record says of a collision.
    fn default() -> Self {
        Self { scales: [0.02, 0.01, 0.02, 0.02], shared_out: 0, step_noise: 0.1, n_calibrated: 0 }
    }
}

/// Mean and variance of a latent factor within a component.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LatentShare {
    pub mean: f64,
    pub variance: f64,
}

impl LatentScales {
    /// Checks scales from a file.
    ///
    /// # Errors
    /// [`NnError::StoredNumber`].
    pub(crate) fn check(&self) -> Result<(), NnError> {
        check_numbers("latents.scales", &self.scales, Expected::NotNegative)?;
        check_number("latents.step_noise", self.step_noise, Expected::NotNegative)?;
        let last = (N_LATENTS - 1) as f64;
        check_number("latents.shared_out", self.shared_out as f64, Expected::Magnitude(last))
    }

    /// All scales and the step noise, multiplied by a factor.
    #[must_use]
    pub fn widened(mut self, factor: f64) -> Self {
        self.scales = self.scales.map(|scale| scale * factor);
        self.step_noise *= factor;
        self
    }

    /// The wider of these scales and the usual ones, uncalibrated.
    #[must_use]
    pub fn at_least_usual(mut self) -> Self {
        let usual = Self::default();
        self.scales = std::array::from_fn(|m| self.scales[m].max(usual.scales[m]));
        self.step_noise = self.step_noise.max(usual.step_noise);
        self.n_calibrated = 0;
        self
    }

    /// Change of the strengths by one standard deviation of each latent.
    pub(crate) fn directions(&self) -> [[f64; N_EFFECTS]; N_LATENTS] {
        let of =
            [Direction::Grip, Direction::Balance, Direction::YawImpulse, Direction::LateralImpulse];
        std::array::from_fn(|m| direction(of[m]).map(|value| value * self.scales[m]))
    }

    /// The latent factors within component `j` of `n`: of the factor that is shared out, the component has
    /// the j-th of n equally likely parts of the standard normal distribution; of the others, the whole.
    pub(crate) fn of_component(&self, j: usize, n: usize) -> [LatentShare; N_LATENTS] {
        let whole = LatentShare { mean: 0.0, variance: 1.0 };
        let mut shares = [whole; N_LATENTS];
        if let Some(share) = shares.get_mut(self.shared_out) {
            *share = part_of_normal(j, n);
        }
        shares
    }
}

/// Mean and variance of the j-th of n equally likely parts of the standard normal distribution:
///
/// ```text
/// E = (φ(a) − φ(b)) n      E z² = 1 + (a φ(a) − b φ(b)) n      a, b: its ends
/// ```
fn part_of_normal(j: usize, n: usize) -> LatentShare {
    let n_parts = n.max(1) as f64;
    let end = |k: usize| match k {
        0 => None,
        k if k >= n => None,
        k => Some(normal_quantile(k as f64 / n_parts)),
    };
    let (low, high) = (end(j), end(j + 1));
    let density = |end: Option<f64>| end.map_or(0.0, normal_density);
    let first = |end: Option<f64>| end.map_or(0.0, |z| z * normal_density(z));
    let mean = (density(low) - density(high)) * n_parts;
    let square = 1.0 + (first(low) - first(high)) * n_parts;
    LatentShare { mean, variance: (square - mean * mean).max(0.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_parts_make_up_the_whole() {
        for n in [1, 2, 3, 5] {
            let parts: Vec<LatentShare> = (0..n).map(|j| part_of_normal(j, n)).collect();
            let mean: f64 = parts.iter().map(|part| part.mean).sum::<f64>() / n as f64;
            let square: f64 =
                parts.iter().map(|part| part.variance + part.mean.powi(2)).sum::<f64>() / n as f64;
            assert!(mean.abs() < 1e-12 && (square - 1.0).abs() < 1e-12, "{n}: {mean} {square}");
        }
        // E z given z > Φ⁻¹(2/3) = 3 φ(0.4307) = 1.0908
        assert!((part_of_normal(2, 3).mean - 1.0908).abs() < 1e-4);
    }

    #[test]
    fn directions_scale_with_their_scales() {
        let scales = LatentScales::default();
        let (once, twice) = (scales.directions(), scales.widened(2.0).directions());
        for (a, b) in once.iter().flatten().zip(twice.iter().flatten()) {
            assert!((2.0 * a - b).abs() < 1e-15);
        }
        assert!(once.iter().all(|direction| direction.iter().any(|value| *value != 0.0)));
    }
}
