//! What is uncertain along a whole motion: latent factors of the strengths of the effects, the same
//! from the impact to the end.
//!
//! ```text
//! c = c_j + Σ_m s_m z_m d_m          z_m ~ N(0, 1), drawn once
//! ```
//!
//! A tire that grips less than the model says does so at every instant. Independent noise at each of
//! 400 steps would average out instead, and give bands that are too narrow. The directions d_m are
//! fixed and have a meaning, their scales s_m are calibrated on trajectories that a training has not
//! seen.
//!
//! The components of the mixture share out the latent that matters most: each takes an equal share of
//! its distribution, so that a car between recovering and spinning is not one wide normal
//! distribution but several narrow ones.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::nn::{Expected, NnError, check_number, check_numbers};
use crate::response::N_EFFECTS;
use crate::response::physics::effects::{Direction, direction};
use impactlab_core::numerics::{normal_density, normal_quantile};
use impactlab_core::vehicle::VehicleInput;

/// Number of latent factors of a motion: of the vehicle and its road, then of the collision.
pub const N_LATENTS: usize = 8;

/// How many of them are of the collision: they matter as long as a force acts.
pub(crate) const N_OF_COLLISION: usize = 2;

/// Number of latent factors that have a name.
pub const N_NAMED_LATENTS: usize = 4;

/// Their names, in order.
pub const LATENT_NAMES: [&str; N_NAMED_LATENTS] =
    ["grip", "balance", "yaw impulse", "lateral impulse"];

/// How far the 4DOF model by data sheet errs, as scales of the named latent factors, on the wide side:
/// over the cars of the fleet the strengths along them have root mean squares of 0.06, 0.02, 0.02 and
/// 0.07.
const BARE_SCALES: [f64; N_NAMED_LATENTS] = [0.10, 0.05, 0.10, 0.10];

/// Places of the named latent factors among all.
pub(super) const NAMED_PLACES: [usize; N_NAMED_LATENTS] = [0, 1, 6, 7];

/// Directions in the space of the strengths along which a prediction is uncertain.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Latents {
    /// s_m d_m: change of the strengths by one standard deviation of each latent factor; zero for one
    /// that a model does not use.
    pub directions: [[f64; N_EFFECTS]; N_LATENTS],
    /// The latent factor that the components of the mixture share out.
    pub shared_out: usize,
    /// Factor on the standard deviation of each step's noise.
    pub step_noise: f64,
    /// Ratio of the two widths of the distribution.
    pub tail_ratio: f64,
    /// Growth of all standard deviations with time, see [`Widths`].
    pub growth: f64,
    /// Factor on all standard deviations while a wheel is braked.
    pub braked: f64,
}

/// How uncertain a model is along a motion, by latent factors that have a name.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LatentScales {
    /// s: standard deviation of the grip, of the balance between the axles (shares of the friction),
    /// of the yaw moment and of the lateral force of the collision (shares of either).
    pub scales: [f64; N_NAMED_LATENTS],
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

/// How wide the distribution of a motion is, and how long its tails are.
///
/// What a model misses has longer tails than a normal distribution: most motions go as it says, a few
/// lie far off, as where a wheel lifts. With one width, either the regions of 90 % are too small or
/// those of 50 % too large. So the standard deviations have one of two widths, equally likely:
///
/// ```text
/// s = widening / √ratio   or   s = widening √ratio
/// ```
///
/// The longer a motion lasts, the further it leaves what was learned from, so that what is missed
/// grows beyond what a constant error of the strengths comes to:
///
/// ```text
/// s(t) = s (1 + growth t / 4 s)
/// ```
///
/// How a car comes to rest that is braked hangs on what brakes it more than on what its tires do sideways,
/// and is missed by another share. So there is a factor for the time in which a wheel is braked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Widths {
    /// Factor on all standard deviations: geometric mean of the two widths.
    pub widening: f64,
    /// Ratio of the wider to the narrower; 1 for a normal distribution.
    pub tail_ratio: f64,
    /// Growth of the standard deviations of the strengths within 4 s; 0 where they are constant.
    pub growth: f64,
    /// Factor on the standard deviations of the strengths while something brakes or locks a wheel.
    pub braked: f64,
}

/// Time of the growth of [`Widths`], s.
const GROWTH_S: f64 = 4.0;
/// Longest time that it is known for, s: no recording of a fleet is longer.
const GROWTH_END_S: f64 = 12.0;

impl Widths {
    /// A normal distribution with the deviations as they are.
    pub const NORMAL: Self = Self { widening: 1.0, tail_ratio: 1.0, growth: 0.0, braked: 1.0 };
}

/// The two widths about their geometric mean, the narrower first.
fn width_pair(tail_ratio: f64) -> [f64; 2] {
    let root = tail_ratio.max(1.0).sqrt();
    [1.0 / root, root]
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
        let last = (N_NAMED_LATENTS - 1) as f64;
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

    /// The scales of a model whose learned part has faded: towards how far the bare physics errs.
    ///
    /// - `share`: that is left of what was learned, 0 to 1; `beyond`: how far outside.
    pub(crate) fn faded(mut self, [share, beyond]: [f64; 2]) -> Self {
        let [learned, bare] = [share * share, (1.0 - share * share) * (1.0 + beyond).powi(2)];
        for (scale, of_physics) in self.scales.iter_mut().zip(BARE_SCALES) {
            *scale = (learned * *scale * *scale + bare * of_physics * of_physics).sqrt();
        }
        self
    }

    /// The directions.
    pub(crate) fn latents(&self) -> Latents {
        let named =
            [Direction::Grip, Direction::Balance, Direction::YawImpulse, Direction::LateralImpulse];
        let mut directions = [[0.0; N_EFFECTS]; N_LATENTS];
        for ((place, pattern), scale) in NAMED_PLACES.into_iter().zip(named).zip(self.scales) {
            directions[place] = direction(pattern).map(|value| value * scale);
        }
        let shared_out = NAMED_PLACES.get(self.shared_out).copied().unwrap_or(0);
        Latents {
            directions,
            shared_out,
            step_noise: self.step_noise,
            tail_ratio: Widths::NORMAL.tail_ratio,
            growth: Widths::NORMAL.growth,
            braked: Widths::NORMAL.braked,
        }
    }
}

impl Latents {
    /// Factor on the latent factors over a step.
    ///
    /// - `u`: its input.
    #[inline(always)]
    pub(crate) fn spread_at(&self, time_s: f64, u: &VehicleInput<f64>) -> f64 {
        let grown = 1.0 + self.growth * time_s.min(GROWTH_END_S) / GROWTH_S;
        if u.is_braked() { grown * self.braked } else { grown }
    }

    /// One of the two widths, which are equally likely.
    ///
    /// - `share`: a number from 0 to 1 that decides on it.
    pub(crate) fn width(&self, share: f64) -> f64 {
        let [narrow, wide] = width_pair(self.tail_ratio);
        if share < 0.5 { narrow } else { wide }
    }

    /// The latent factors within component `j` of `n`: of the factor that is shared out, the component has
    /// the j-th of n equally likely parts of the standard normal distribution; of the others, the whole.
    pub(crate) fn component_shares(&self, j: usize, n: usize) -> [LatentShare; N_LATENTS] {
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
///
/// The mean of the middle one is exactly zero.
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
    let mean = if 2 * j + 1 == n { 0.0 } else { (density(low) - density(high)) * n_parts };
    let square = 1.0 + (first(low) - first(high)) * n_parts;
    LatentShare { mean, variance: (square - mean * mean).max(0.0) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impactlab_core::vehicle::WheelEffort;

    #[test]
    fn the_parts_make_up_the_whole() {
        for n in [1, 2, 3, 5] {
            let parts: Vec<LatentShare> = (0..n).map(|j| part_of_normal(j, n)).collect();
            let mean: f64 = parts.iter().map(|part| part.mean).sum::<f64>() / n as f64;
            let square: f64 =
                parts.iter().map(|part| part.variance + part.mean.powi(2)).sum::<f64>() / n as f64;
            assert!(mean.abs() < 1e-12 && (square - 1.0).abs() < 1e-12, "{n}: {mean} {square}");
        }
        assert_eq!([part_of_normal(1, 3), part_of_normal(2, 5)].map(|part| part.mean), [0.0; 2]);
        // E z given z > Φ⁻¹(2/3) = 3 φ(0.4307) = 1.0908
        assert!((part_of_normal(2, 3).mean - 1.0908).abs() < 1e-4);
    }

    #[test]
    fn what_is_uncertain_is_wider_while_a_wheel_is_braked_and_grows_with_time() {
        let latents = Latents { growth: 0.5, braked: 1.4, ..LatentScales::default().latents() };
        let braked_n = |braking_n| VehicleInput {
            wheels: Some([WheelEffort { braking_n, ..WheelEffort::FREE }; 4]),
            ..VehicleInput::RELEASED
        };
        let at = |time_s, u| latents.spread_at(time_s, &u);
        assert_eq!(
            [0.0, 4.0, 50.0].map(|time_s| at(time_s, VehicleInput::RELEASED)),
            [1.0, 1.5, 2.5]
        );
        assert_eq!([0.0, 4.0].map(|time_s| at(time_s, braked_n(300.0))), [1.4, 1.5 * 1.4]);
        assert_eq!(at(4.0, braked_n(0.0)), 1.5, "wheels that roll freely");
        let locked = [WheelEffort { locked: 1.0, ..WheelEffort::FREE }; 4];
        assert_eq!(at(0.0, VehicleInput { wheels: Some(locked), ..VehicleInput::RELEASED }), 1.4);
    }

    #[test]
    fn directions_scale_with_their_scales() {
        let scales = LatentScales::default();
        let [once, twice] = [scales, scales.widened(2.0)].map(|scales| scales.latents().directions);
        for (a, b) in once.iter().flatten().zip(twice.iter().flatten()) {
            assert!((2.0 * a - b).abs() < 1e-15);
        }
        for place in NAMED_PLACES {
            assert!(once[place].iter().any(|value| *value != 0.0));
        }
    }
}
